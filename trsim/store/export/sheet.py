"""A workbook of one sheet (Office Open XML), written block by block, numbers in full.

The same rows give the same bytes.  A number that is missing is an empty cell, one that is infinite
the error #NUM!.  openpyxl and XlsxWriter write 16 digits of a number, and 17 are needed to read the
same one again; so this small part of the format is written here.
"""

import math
from html import escape
from typing import IO
from zipfile import ZIP_DEFLATED, ZIP_STORED, ZipFile, ZipInfo

from trsim.errors import UsageError
from trsim.store.export.columns import Columns

MOST_ROWS, MOST_COLUMNS = 1_048_576, 16_384  # of a sheet
OFFICE = "http://schemas.openxmlformats.org"
MAIN = f"{OFFICE}/spreadsheetml/2006/main"
HEAD = '<?xml version="1.0" encoding="UTF-8" standalone="yes"?>\n'
OF = "application/vnd.openxmlformats-officedocument"

# the first one tells whose file it is, and is not compressed
ABOUT = (
    f'<Properties xmlns="{OFFICE}/officeDocument/2006/extended-properties">'
    "<Application>trsim</Application></Properties>"
)
TYPES = (
    f'<Types xmlns="{OFFICE}/package/2006/content-types">'
    '<Default Extension="rels" ContentType="application/vnd.openxmlformats-package.relationships'
    '+xml"/><Default Extension="xml" ContentType="application/xml"/>'
    f'<Override PartName="/docProps/app.xml" ContentType="{OF}.extended-properties+xml"/>'
    f'<Override PartName="/xl/workbook.xml" ContentType="{OF}.spreadsheetml.sheet.main+xml"/>'
    '<Override PartName="/xl/worksheets/sheet1.xml" '
    f'ContentType="{OF}.spreadsheetml.worksheet+xml"/></Types>'
)
TARGETS = (
    ("officeDocument", "xl/workbook.xml"),
    ("extended-properties", "docProps/app.xml"),
)
BOOK = (
    f'<workbook xmlns="{MAIN}" xmlns:r="{OFFICE}/officeDocument/2006/relationships">'
    '<sheets><sheet name="channels" sheetId="1" r:id="rId1"/></sheets></workbook>'
)
# titles stay in sight
BEGIN = (
    f'<worksheet xmlns="{MAIN}"><sheetViews><sheetView workbookViewId="0">'
    '<pane xSplit="1" ySplit="1" topLeftCell="B2" activePane="bottomRight" state="frozen"/>'
    "</sheetView></sheetViews><sheetData>"
)
END = "</sheetData></worksheet>"


def write(columns: Columns, out: IO[bytes]) -> None:
    """Raises UsageError where a sheet cannot hold the rows or the columns."""
    check_room(columns)
    with ZipFile(out, "w") as book:
        entry(book, "docProps/app.xml", ABOUT, ZIP_STORED)
        entry(book, "[Content_Types].xml", TYPES)
        entry(book, "_rels/.rels", relations(TARGETS))
        entry(book, "xl/workbook.xml", BOOK)
        entry(
            book, "xl/_rels/workbook.xml.rels", relations((("worksheet", "worksheets/sheet1.xml"),))
        )
        with book.open(told("xl/worksheets/sheet1.xml"), "w") as sheet:
            titles = "".join(map(text, columns.titles))
            sheet.write(f"{HEAD}{BEGIN}<row>{titles}</row>".encode())
            for block in columns.blocks():
                rows = (f"<row>{''.join(map(cell, row))}</row>" for row in block.tolist())
                sheet.write("".join(rows).encode())
            sheet.write(END.encode())


def check_room(columns: Columns) -> None:
    rows, width = columns.run.rows, len(columns.names)
    if rows >= MOST_ROWS:
        what = f"{rows} rows are too many for a sheet, which holds {MOST_ROWS - 1} below the titles"
        raise UsageError(what, "Write .parquet or .csv.")
    if width > MOST_COLUMNS:
        what = f"{width} columns are too many for a sheet, which holds {MOST_COLUMNS}"
        raise UsageError(what, "Choose some with --channels, or write .parquet or .csv.")


def text(title: str) -> str:
    return f'<c t="inlineStr"><is><t xml:space="preserve">{escape(title)}</t></is></c>'


def cell(x: float) -> str:
    if math.isfinite(x):
        return f"<c><v>{x!r}</v></c>"
    return "<c/>" if math.isnan(x) else '<c t="e"><v>#NUM!</v></c>'


def relations(targets: tuple[tuple[str, str], ...]) -> str:
    """What a part of the package is made of."""
    inner = "".join(
        f'<Relationship Id="rId{k}" Type="{OFFICE}/officeDocument/2006/relationships/{kind}" '
        f'Target="{target}"/>'
        for k, (kind, target) in enumerate(targets, 1)
    )
    return f'<Relationships xmlns="{OFFICE}/package/2006/relationships">{inner}</Relationships>'


def entry(book: ZipFile, name: str, inner: str, how: int = ZIP_DEFLATED) -> None:
    book.writestr(told(name, how), HEAD + inner)


def told(name: str, how: int = ZIP_DEFLATED) -> ZipInfo:
    """An entry without the day it was written on."""
    info = ZipInfo(name)
    info.compress_type = how
    return info
