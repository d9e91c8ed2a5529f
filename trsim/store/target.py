"""What a command may write over: nothing but a file of the kind it writes itself.

A name that is a link stands for the file it leads to.  All but result files of runs are written
under another name beside the target, which takes its place when it is complete.
"""

import csv
import errno
import json
import os
import re
import stat
from collections.abc import Callable, Iterable, Iterator
from contextlib import contextmanager, suppress
from itertools import count
from pathlib import Path
from tempfile import TemporaryFile
from typing import NamedTuple

from trsim import system
from trsim.errors import FileError, UsageError, what_it_is
from trsim.store.plain import SIGNATURE, SIZE

BEGINNING = 1 << 20  # bytes a file is recognised by
ELSEWHERE = "Name another file with -o."
HEADER = 4096  # bytes of a result file with the names of its first attributes


class Kind(NamedTuple):
    """A kind of file, and how it is told from others."""

    name: str
    fits: Callable[[bytes], bool]  # the beginning of a file
    at_end: bool = False  # ... or the last bytes of it


def _is_result(start: bytes) -> bool:
    return start.startswith(SIGNATURE) and b"format_version" in start[:HEADER]


def _is_part(start: bytes) -> bool:
    """Whether it begins like a part file, which may have been killed early: empty, zeros, or a
    superblock with no object behind it."""
    first = start.startswith(SIGNATURE) and not any(start[SIZE:])
    return _is_result(start) or first or not any(start)


def _is_table(start: bytes) -> bool:
    """Titles with units, and numbers written in full, as `export` writes them."""
    titles, *rows = start.split(b"\r\n")
    between = b"\t" if titles.startswith(b"time [s]\t") else b","
    if not titles.startswith((b"time [s]" + between, b"time [s]")) or not rows:
        return False
    if any(not title.strip(b'"').endswith(b"]") for title in titles.split(between)):
        return False
    try:
        return not rows[0] or all(repr(float(x)) == x.decode() for x in rows[0].split(between))
    except ValueError:
        return False


def _is_schema(start: bytes) -> bool:
    try:
        found = json.loads(start)
    except ValueError:
        return False
    return isinstance(found, dict) and str(found.get("title", "")).startswith("trsim ")


def _is_figure(start: bytes) -> bool:
    return start.startswith(b"\x89PNG") and b"Software\0trsim" in start[:HEADER]


def _is_pdf(end: bytes) -> bool:
    return b"/Creator (trsim)" in end and b"%%EOF" in end


def _is_svg(start: bytes) -> bool:
    return start.startswith(b"<?xml") and b"<dc:title>trsim</dc:title>" in start[:HEADER]


def headed(*titles: str) -> Kind:
    """Tables that begin with these titles, in whatever units; an empty one stands for any."""
    wanted = [_bare(title) for title in titles]

    def fits(start: bytes) -> bool:
        line, ended, _ = start.partition(b"\r\n")
        try:
            found = next(csv.reader([line.decode()]))
        except (csv.Error, UnicodeDecodeError, StopIteration):
            return False
        pairs = zip(wanted, map(_bare, found), strict=False)
        return bool(ended) and len(found) >= len(wanted) and all(a in ("", b) for a, b in pairs)

    return Kind("table of trsim", fits)


def _bare(title: str) -> str:
    """A title without its unit."""
    return re.sub(r" \[[^\[\]]*\]$", "", title)


def _is_checkpoint(start: bytes) -> bool:
    """Whether it begins like a checkpoint: an archive behind a line, which may be damaged."""
    return start.startswith(b"trsim checkpoint ") or start[84:88] == b"PK\3\4" or not start


def _is_lock(start: bytes) -> bool:
    """The number of a process, or nothing yet."""
    return len(start) <= len(b"18446744073709551615\n") and not start.strip(b"0123456789\n")


RESULT = Kind("result file", _is_result)
PART = Kind("part of a result file", _is_part)
CHECKPOINT = Kind("checkpoint of trsim", _is_checkpoint)
LOCK = Kind("lock of trsim", _is_lock)
TABLE = Kind("table that `trsim export` wrote", _is_table)
SCHEMA = Kind("schema of trsim", _is_schema)
FIGURE = Kind("figure of trsim", _is_figure)
FIGURES = {
    "png": FIGURE,
    "pdf": Kind("figure of trsim", _is_pdf, at_end=True),
    "svg": Kind("figure of trsim", _is_svg),
}

_waiting: list[dict[Path, Path]] = []  # name -> finished file without it, of `together`


def replaceable(target: Path, kind: Kind, given: Iterable[str | os.PathLike] = ()) -> Path:
    """The file to write for a target, links followed.

    given: what the command reads.  Raises UsageError where the target is one of these or anything
    but a file of its kind, FileError where it may not be written or cannot be looked at.
    """
    with file_errors(target):
        try:
            found = target.stat()
        except FileNotFoundError:
            return _followed(target)
        if not stat.S_ISREG(found.st_mode):
            raise UsageError(f"{target} is {what_it_is(found.st_mode)}, not a file", ELSEWHERE)
        # the superuser may write anything: what is marked as not to be written is left alone
        if not found.st_mode & 0o222 or not os.access(target, os.W_OK):
            raise FileError(f"{target} is write-protected", ELSEWHERE)
        fits = _fits(target, kind)
    if not fits:
        raise UsageError(f"{target} exists and is not a {kind.name}", ELSEWHERE)
    if any(os.path.exists(one) and os.path.samefile(one, target) for one in given):
        raise UsageError(f"{target} would be replaced by what is made of it", ELSEWHERE)
    return _followed(target)


def _fits(path: Path, kind: Kind) -> bool:
    """Whether a file is of a kind, or empty."""
    with path.open("rb") as file:
        if kind.at_end:
            file.seek(max(os.fstat(file.fileno()).st_size - BEGINNING, 0))
        part = file.read(BEGINNING)
    return not part or kind.fits(part)


def _followed(target: Path) -> Path:
    return Path(os.path.realpath(target)) if target.is_symlink() else target


@contextmanager
def file_errors(target: Path) -> Iterator[None]:
    """Errors of the file system, told of the file that is written."""
    try:
        yield
    except OSError as error:
        reason = error.strerror or error
        raise FileError(f"{target}: cannot be written: {reason}", file=str(target)) from None


@contextmanager
def fresh(target: Path, kind: Kind, given: Iterable[str | os.PathLike] = ()) -> Iterator[Path]:
    """An empty file to write; it takes the name of the target at the end, and is gone after an
    error."""
    with file_errors(target):
        make(target.parent)
    final = replaceable(target, kind, given)
    waiting = _waiting[-1] if _waiting else None
    if waiting and final in waiting and not _fits(waiting[final], kind):
        raise UsageError(f"{target} would be written twice", "Ask for one thing after the other.")
    with file_errors(target):
        unfinished = _empty(final)
    kept = False
    try:
        yield unfinished
        if waiting is None:
            with file_errors(target):
                os.replace(unfinished, final)
        else:
            if final in waiting:
                waiting[final].unlink()
            waiting[final], kept = unfinished, True
    finally:
        if not kept:
            with suppress(OSError):
                unfinished.unlink()


@contextmanager
def together() -> Iterator[None]:
    """What is written inside takes its names at the end: all files or, after an error, none.

    So one that may not be replaced leaves no other one beside older files it does not go with.
    """
    waiting: dict[Path, Path] = {}
    _waiting.append(waiting)
    try:
        yield
        for final, unfinished in waiting.items():
            with file_errors(final):
                os.replace(unfinished, final)
    finally:
        _waiting.pop()
        for unfinished in waiting.values():
            with suppress(OSError):
                unfinished.unlink()


def _empty(final: Path) -> Path:
    """A new file beside another; what has its name already, or a link of it, stays as it is."""
    for k in count():
        path = final.with_name(f"{final.name}.{os.getpid()}{f'-{k}' if k else ''}")
        with suppress(FileExistsError):
            os.close(system.opened(path, os.O_WRONLY | os.O_CREAT | os.O_EXCL))
            return path
    raise AssertionError


def make(folder: Path) -> None:
    """Make a folder, unless it is there."""
    try:
        folder.mkdir(parents=True, exist_ok=True)
    except FileExistsError:
        raise NotADirectoryError(errno.ENOTDIR, os.strerror(errno.ENOTDIR)) from None


def check_writable(folder: Path) -> None:
    """Check that files can be made in a folder, which is made where it is not there."""
    with file_errors(folder):
        make(folder)
        with TemporaryFile(dir=folder) as trial:
            trial.write(b"trial")
            trial.flush()
