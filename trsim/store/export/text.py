"""Comma-separated and tab-separated values: titles with units, then numbers in full."""

from typing import IO

from trsim.store.export.columns import Columns


def csv(columns: Columns, out: IO[bytes]) -> None:
    titles = (f'"{title}"' if "," in title else title for title in columns.titles)
    write(columns, out, ",".join(titles), ",")


def tsv(columns: Columns, out: IO[bytes]) -> None:
    write(columns, out, "\t".join(columns.titles), "\t")


def write(columns: Columns, out: IO[bytes], head: str, between: str) -> None:
    out.write(f"{head}\r\n".encode())
    for table in columns.blocks():
        text = "".join(between.join(map(repr, row)) + "\r\n" for row in table.tolist())
        out.write(text.encode())
