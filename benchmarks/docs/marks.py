"""Markers round what is measured on a page.  They say what made it, and from which sources.

    <!-- made: NAME; by: COMMAND; from: DIGEST; at: COMMIT -->
    a table, a picture, a paragraph
    <!-- end -->

NAME is that of an entry of made.py; NAME:2 is the second table that its command prints.  DIGEST is
that of the sources of the entry when it was made; where they have another one, what stands there
is stale.  COMMIT is the one it was measured at, where that is known.  None of this is rendered.
"""

import ast
import hashlib
import re
import subprocess
import tempfile
import tokenize
from collections.abc import Iterator
from functools import cache
from io import StringIO
from pathlib import Path
from typing import NamedTuple

from benchmarks.docs.made import MADE, Made
from benchmarks.trees import unpack

ROOT = Path(__file__).parents[2]
DOCS = ROOT / "docs"
MARK = re.compile(
    r"^ *<!-- made: (?P<name>[\w/]+)(:(?P<table>\d+))?; by: (?P<command>[^;]+)"
    r"; from: (?P<digest>\w+)(; at: (?P<commit>\w+))? -->$"
)
END = "<!-- end -->"
DOCUMENTED = ast.Module, ast.ClassDef, ast.FunctionDef, ast.AsyncFunctionDef
EMPTY = b'""'
READ = (".py", ".yaml", ".csv", ".toml")  # what of a folder is a source
TABLE = re.compile(r"(?:^ *\|.*\n?)+", re.MULTILINE)


class Marked(NamedTuple):
    """What stands between two markers: text.splitlines()[first:last]."""

    page: Path
    line: int  # of the marker, from 1
    name: str
    table: int  # which of those that the command prints; 0: it has but one, or writes a page
    command: str
    digest: str
    commit: str
    first: int
    last: int

    @property
    def whole(self) -> str:
        return f"{self.name}:{self.table}" if self.table else self.name


def pages() -> list[Path]:
    """README and all pages of docs."""
    return [ROOT / "README.md", *sorted(DOCS.glob("*.md"))]


def marked(page: Path, text: str | None = None) -> list[Marked]:
    """All marked pieces of a page; raises ValueError where markers do not fit together."""
    lines = (page.read_text(encoding="utf-8") if text is None else text).splitlines()
    found: list[Marked] = []
    begun: tuple[int, re.Match[str]] | None = None
    for k, line in enumerate(lines):
        if match := MARK.match(line):
            if begun:
                raise ValueError(f"{page.name}:{begun[0] + 1}: has no end before line {k + 1}")
            begun = k, match
        elif line.strip() == END:
            if not begun:
                raise ValueError(f"{page.name}:{k + 1}: ends what has not begun")
            at, of = begun
            table = int(of["table"] or 0)
            found.append(Marked(page, at + 1, of["name"], table, of["command"], of["digest"],
                                of["commit"] or "", at + 1, k))  # fmt: skip
            begun = None
        elif "<!-- made" in line and "`" not in line:
            raise ValueError(f"{page.name}:{k + 1}: this marker cannot be read")
    if begun:
        raise ValueError(f"{page.name}:{begun[0] + 1}: has no end")
    return found


def opening(whole: str, digest: str, commit: str = "") -> str:
    """The first marker of a piece."""
    command = MADE[whole.partition(":")[0]].command
    at = f"; at: {commit}" if commit else ""
    return f"<!-- made: {whole}; by: {command}; from: {digest}{at} -->"


def files(root: Path, of: tuple[str, ...]) -> Iterator[Path]:
    """The sources an entry depends on; what is gone, or was not there yet, counts as empty."""
    for name in of:
        path = root / name
        if path.is_dir():
            yield from sorted(one for one in path.rglob("*") if one.suffix in READ)
        elif path.exists():
            yield path


def digest(of: tuple[str, ...], root: Path = ROOT, words: bool = True) -> str:
    """Of the sources, without what only people read: docstrings, lines of comment, empty lines and
    markers; without `words` also without sentences, which make no number."""
    found = hashlib.sha256()
    for path in files(root, of):
        text = path.read_text(encoding="utf-8")
        told = statements(text, words) if path.suffix == ".py" else lines_of(text)
        found.update(f"\n{path.relative_to(root).as_posix()}\n{told}".encode())
    return found.hexdigest()[:12]


def digest_of(made: Made, root: Path = ROOT) -> str:
    """That of the sources of an entry."""
    return digest(made.of, root, made.words)


@cache
def statements(text: str, words: bool = True) -> str:
    """The lines of a Python source without docstrings; without `words` each statement in one line,
    with nothing in place of its sentences."""
    if not words:
        return in_lines(without_sentences(text))
    lines = text.splitlines()
    for node in ast.walk(ast.parse(text)):
        if isinstance(node, DOCUMENTED) and ast.get_docstring(node, clean=False) is not None:
            said = node.body[0]
            count = (said.end_lineno or said.lineno) - said.lineno + 1
            lines[said.lineno - 1 : said.lineno - 1 + count] = [""] * count
    return lines_of("\n".join(lines))


def without_sentences(text: str) -> str:
    """A Python source with empty texts in place of those that hold a space."""
    data, spans = text.encode(), set()
    starts = [0, *(at.end() for at in re.finditer(rb"\n", data))]
    for node in ast.walk(ast.parse(text)):
        parts = node.values if isinstance(node, ast.JoinedStr) else [node]
        said = (p.value for p in parts if isinstance(p, ast.Constant) and isinstance(p.value, str))
        if isinstance(node, ast.expr) and any(" " in one for one in said):
            last = starts[(node.end_lineno or node.lineno) - 1] + (node.end_col_offset or 0)
            spans.add((starts[node.lineno - 1] + node.col_offset, last))
    for first, last in sorted(spans, reverse=True):
        if not any(a <= first and last <= b and (a, b) != (first, last) for a, b in spans):
            data = data[:first] + EMPTY + data[last:]
    return data.decode()


def in_lines(text: str) -> str:
    """A Python source with every statement in one line, without comments and sentences alone."""
    found, lines, first = [], text.splitlines(), 0
    for token in tokenize.generate_tokens(StringIO(text).readline):
        row, column = token.start
        if token.type == tokenize.COMMENT:
            lines[row - 1] = lines[row - 1][:column].rstrip()
        elif token.type == tokenize.NEWLINE:
            parts = [line for line in lines[first:row] if line.strip()]
            joined = " ".join([parts[0].rstrip(), *(part.strip() for part in parts[1:])])
            found.append(re.sub(r",? (?=[\])}])", "", re.sub(r"(?<=[\[({]) ", "", joined)))
            first = row
    return "\n".join(line for line in found if line.strip() != EMPTY.decode())


def lines_of(text: str) -> str:
    """The lines that are not empty, comments or markers."""
    kept = (
        line.rstrip() for line in text.splitlines()
        if line.strip() and not line.lstrip().startswith("#") and not MARK.match(line)
    )  # fmt: skip
    return "\n".join(kept)


def digest_at(made: Made, commit: str) -> str:
    """The same of the tree of a commit."""
    listed = (
        printed(["git", "-C", str(ROOT), "ls-tree", "-r", "--name-only", commit])
        .decode()
        .splitlines()
    )
    there = [name for name in made.of if any(f"{one}/".startswith(f"{name}/") for one in listed)]
    if not there:
        return digest(())
    with tempfile.TemporaryDirectory() as folder:
        unpack(commit, Path(folder), *there)
        return digest_of(made, Path(folder))


def printed(command: list[str]) -> bytes:
    """What a command says on its standard output."""
    return subprocess.run(command, check=True, stdout=subprocess.PIPE, cwd=ROOT).stdout  # noqa: S603


def stale(one: Marked) -> str:
    """Why a piece is to be made again; empty if it is not."""
    known = MADE.get(one.name)
    if known is None:
        return "benchmarks/docs/made.py does not know it"
    if one.command != known.command:
        return f"is made by {known.command} now"
    if one.digest != digest_of(known):
        return "its sources have changed" + (f" since {one.commit}" if one.commit else "")
    return ""


def unmarked(page: Path, lists: tuple[str, ...], text: str | None = None) -> list[str]:
    """Tables with numbers and pictures that stand between no markers; tables with a head that is
    one of `lists` are not measured."""
    text = page.read_text(encoding="utf-8") if text is None else text
    held = [(one.first, one.last) for one in marked(page, text)]
    lines, code, found, before = text.splitlines(), False, [], False
    for k, line in enumerate(lines):
        code ^= line.lstrip().startswith("```")
        table = line.lstrip().startswith("|") and not code
        picture = line.startswith("![") and not code
        if not any(first <= k < last for first, last in held):
            if table and not before and line.strip() not in lists and numbers(lines[k:]):
                found.append(f"{page.name}:{k + 1}: {line.strip()}")
            elif picture:
                found.append(f"{page.name}:{k + 1}: {line}")
        before = table
    return found


def numbers(lines: list[str]) -> bool:
    """Is there a number in the table these lines begin with, apart from words of code?"""
    match = TABLE.match("\n".join(lines))
    return bool(match and re.search(r"\d", re.sub(r"`[^`]*`|\[[^]]*\]\([^)]*\)", "", match[0])))


def replaced(text: str, one: Marked, body: str, commit: str = "") -> str:
    """The page with another body between these markers, made from the sources as they are."""
    lines = text.splitlines()
    before = lines[one.line - 1]
    indent = before[: len(before) - len(before.lstrip())]
    head = indent + opening(one.whole, digest_of(MADE[one.name]), commit)
    return "\n".join([*lines[: one.first - 1], head, *body.splitlines(), *lines[one.last :]]) + "\n"
