"""A report as one HTML page that stands alone: no script, no network, figures inside it."""

import base64
import html
import math
from collections.abc import Sequence
from pathlib import Path
from typing import NamedTuple

from trsim.store.target import HEADER, Kind, file_errors, fresh

GENERATOR = '<meta name="generator" content="trsim">'
STRIP = 150  # pixels, the width of a strip of dots
PAGE = Kind("page of trsim", lambda start: GENERATOR.encode() in start[:HEADER])

CSS = """
:root { color-scheme: light; }
body { font: 15px/1.5 "DejaVu Sans", Verdana, Helvetica, Arial, sans-serif; color: #1a1a1a;
  background: #fff; margin: 2rem auto; padding: 0 1rem; max-width: 74rem; }
h1 { font-size: 1.6rem; line-height: 1.25; margin: 0 0 .5rem; }
h2 { font-size: 1.2rem; margin: 2.5rem 0 .6rem; border-bottom: 1px solid #bbb; }
p, li { max-width: 46rem; }
a { color: #0050a0; }
nav a { margin-right: 1rem; white-space: nowrap; }
figure { margin: 1.5rem 0 2rem; }
figure img { max-width: 100%; height: auto; }
figcaption { font-size: .9rem; max-width: 46rem; }
.wide { overflow-x: auto; }
table { border-collapse: collapse; font-size: .8rem; line-height: 1.35; width: 100%; }
th, td { text-align: left; vertical-align: top; padding: .3rem .5rem; border-top: 1px solid #ddd; }
th { border-top: 0; border-bottom: 1.5px solid #555; }
tr.first td { border-top: 1px solid #888; }
tr:target, figure:target { background: #fff6d6; }
.confirmed { color: #00664a; font-weight: bold; }
.contradicted { color: #a83800; font-weight: bold; }
.undetermined { color: #555; font-weight: bold; }
.aside { color: #666; }
td div { white-space: nowrap; }
svg { display: block; margin: 0 0 .25rem; }
svg circle { fill: #0072b2; fill-opacity: .45; }
svg line { stroke: #ccc; } svg line.mean { stroke: #000; }
@media print { body { font-size: 9.5pt; margin: 0; max-width: none; }
  table { font-size: 7pt; } figure, tr { break-inside: avoid; } nav { display: none; } }
"""


class Text(NamedTuple):
    """A paragraph of plain text."""

    text: str


class Points(NamedTuple):
    """A list of plain texts."""

    texts: Sequence[str]


class Picture(NamedTuple):
    """A figure, PNG or SVG, with its caption, and where it is spoken of: (text, anchor)."""

    anchor: str
    file: Path
    caption: str
    links: Sequence[tuple[str, str]] = ()
    data: bytes | None = None  # a PNG in place of the file, which a browser would not show


class Cell(NamedTuple):
    """A cell of a table; a link where there is an anchor, after it a text in grey."""

    text: str
    anchor: str = ""
    kind: str = ""  # a class of the style sheet
    aside: str = ""


class Ensembles(NamedTuple):
    """A cell of ensembles below one another, each told and drawn, all on one scale."""

    texts: Sequence[str]
    values: Sequence[Sequence[float]]


class Line(NamedTuple):
    """A line of a table."""

    cells: Sequence[Cell | Ensembles]
    anchor: str = ""
    first: bool = False  # of a group


class Table(NamedTuple):
    """A table; its numbers belong in a CSV file, too."""

    head: Sequence[str]
    lines: Sequence[Line]


class Markup(NamedTuple):
    """HTML of another part of the report, as it is: an animation."""

    html: str


Block = Text | Points | Picture | Table | Markup


class Section(NamedTuple):
    """A heading and what stands below it."""

    anchor: str
    title: str
    blocks: Sequence[Block]


def write(path: Path, title: str, lead: Sequence[str], sections: Sequence[Section]) -> Path:
    """Write the page.  Raises FileError where it cannot be written."""
    text = page(title, lead, sections)
    with file_errors(path), fresh(path, PAGE) as unfinished:
        unfinished.write_text(text, encoding="utf-8", newline="\n")
    return path


def page(title: str, lead: Sequence[str], sections: Sequence[Section]) -> str:
    """The page as text."""
    links = "".join(f'<a href="#{s.anchor}">{escaped(s.title)}</a>\n' for s in sections)
    parts = [
        '<!DOCTYPE html>\n<html lang="en">\n<head>\n<meta charset="utf-8">\n',
        f"{GENERATOR}\n",
        '<meta name="viewport" content="width=device-width, initial-scale=1">\n',
        f"<title>{escaped(title)}</title>\n<style>{CSS}</style>\n</head>\n<body>\n",
        f"<h1>{escaped(title)}</h1>\n",
        *(f"<p>{escaped(text)}</p>\n" for text in lead),
        f"<nav>{links}</nav>\n",
    ]
    for section in sections:
        parts.append(f'<h2 id="{section.anchor}">{escaped(section.title)}</h2>\n')
        parts += [markup(block) for block in section.blocks]
    return "".join([*parts, "</body>\n</html>\n"])


def markup(block: Block) -> str:
    """One block as HTML."""
    if isinstance(block, Text):
        return f"<p>{escaped(block.text)}</p>\n"
    if isinstance(block, Points):
        return "<ul>\n" + "".join(f"<li>{escaped(t)}</li>\n" for t in block.texts) + "</ul>\n"
    if isinstance(block, Picture):
        return picture(block)
    if isinstance(block, Markup):
        return block.html
    head = "".join(f"<th>{escaped(text)}</th>" for text in block.head)
    lines = "".join(line(one) for one in block.lines)
    return f'<div class="wide"><table>\n<tr>{head}</tr>\n{lines}</table></div>\n'


def picture(block: Picture) -> str:
    read = block.data or block.file.read_bytes()
    kind = "svg+xml" if block.file.suffix == ".svg" and not block.data else "png"
    data = base64.b64encode(read).decode("ascii")
    links = ", ".join(f'<a href="#{anchor}">{escaped(text)}</a>' for text, anchor in block.links)
    about = f' <span class="aside">Claims: {links}</span>' if links else ""
    alt = escaped(block.caption)
    return (
        f'<figure id="{block.anchor}"><img alt="{alt}" src="data:image/{kind};base64,{data}">\n'
        f"<figcaption>{alt}{about}</figcaption></figure>\n"
    )


def line(one: Line) -> str:
    anchor = f' id="{one.anchor}"' if one.anchor else ""
    first = ' class="first"' if one.first else ""
    return f"<tr{anchor}{first}>{''.join(cell(c) for c in one.cells)}</tr>\n"


def cell(one: Cell | Ensembles) -> str:
    if isinstance(one, Ensembles):
        return f"<td>{ensembles(one)}</td>"
    text = escaped(one.text)
    text = f'<a href="#{one.anchor}">{text}</a>' if one.anchor else text
    kind = f' class="{one.kind}"' if one.kind else ""
    aside = f'<br><span class="aside">{escaped(one.aside)}</span>' if one.aside else ""
    return f"<td{kind}>{text}{aside}</td>"


def ensembles(one: Ensembles) -> str:
    """Texts with strips of dots: a dot for each value, a tick at the mean."""
    finite = [v for values in one.values for v in values if math.isfinite(v)]
    low, high = min(finite, default=0.0), max(finite, default=0.0)
    drawn = high - low > 1e-12 * abs(high)
    parts = []
    for text, values in zip(one.texts, one.values, strict=True):
        at = [STRIP * (0.04 + 0.92 * (v - low) / (high - low)) for v in values] if drawn else []
        parts.append(f"<div>{escaped(text)}{strip(at)}</div>")
    return "".join(parts)


def strip(at: Sequence[float]) -> str:
    """Dots at some places, as a picture of its own line."""
    if not at or not all(map(math.isfinite, at)):
        return ""
    dots = "".join(f'<circle cx="{x:.1f}" cy="5" r="1.8"/>' for x in at)
    mean = sum(at) / len(at)
    return (
        f'<svg viewBox="0 0 {STRIP} 10" width="{STRIP}" height="10" role="presentation">'
        f'<line x1="0" y1="5" x2="{STRIP}" y2="5"/>{dots}'
        f'<line class="mean" x1="{mean:.1f}" y1="0" x2="{mean:.1f}" y2="10"/></svg>'
    )


def escaped(text: str) -> str:
    return html.escape(text, quote=True)
