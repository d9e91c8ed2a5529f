"""The records of cases whose rows a sweep does not keep: one growing file for the whole sweep.

summaries.jsonl.gz, or with shards one file each, summaries-1of3.jsonl.gz: a record is a line of
JSON, compressed by itself and put behind the others, so `zcat` shows them.  Where a record is, its
line in the ledger says:  FILE:BEGIN:LENGTH:WORDS.  A record that was cut short by a dead process
has no line in the ledger, and stays where it is: what lies behind it is read all the same.
"""

import hashlib
import os
import re
from collections.abc import Iterable
from contextlib import suppress
from pathlib import Path
from typing import Any, BinaryIO, NamedTuple

from trsim import system
from trsim.errors import FileError
from trsim.store.own import exists
from trsim.store.target import Kind
from trsim.sweeps.summary import EVERY, received, unpacked

NAME = re.compile(r"summaries(-\d+of\d+)?\.jsonl\.gz")
PLACE = re.compile(rf"({NAME.pattern}):(\d+):(\d+):([0-9a-f]+)")
GZIP = b"\x1f\x8b"
RECORDS = Kind("file of a sweep's summaries", lambda start: start[:2] in (b"", GZIP))


class Place(NamedTuple):
    """Where a record is."""

    file: str
    begin: int  # bytes
    length: int
    words: str  # digest of the numbers that were asked for

    def __str__(self) -> str:
        return f"{self.file}:{self.begin}:{self.length}:{self.words}"


def place(text: str) -> Place | None:
    """The place a line of the ledger tells; None of anything else."""
    match = PLACE.fullmatch(text)
    return Place(match[1], int(match[3]), int(match[4]), match[5]) if match else None


def words_digest(words: Iterable[str]) -> str:
    """Of the numbers of a record: those of every one, and those that are asked for."""
    text = "\n".join([*EVERY, *sorted(words)])
    return hashlib.sha256(text.encode()).hexdigest()[:12]


class Records:
    """The file of one process, open for adding records; it is made with the first of them."""

    def __init__(self, folder: Path, shard: str, words: Iterable[str]) -> None:
        self.path = folder / f"summaries{shard and '-'}{shard}.jsonl.gz"
        self.words = words_digest(words)
        self.file: BinaryIO | None = None

    def add(self, text: str) -> str:
        """Put a record, as it was sent, behind the others; its place."""
        return self.put(received(text), self.words)

    def put(self, data: bytes, words: str) -> str:
        """The same of a record as it is stored; words: digest of what was asked for."""
        if self.file is None:
            exists(self.path, RECORDS)  # whatever else has this name is left alone
            flags = os.O_WRONLY | os.O_CREAT | os.O_APPEND | system.O_NONBLOCK
            self.file = open(system.opened(self.path, flags), "ab")  # noqa: SIM115 - see close
        begin = self.file.seek(0, os.SEEK_END)
        self.file.write(data)
        self.file.flush()
        return str(Place(self.path.name, begin, len(data), words))

    def close(self) -> None:
        if self.file is not None:
            with suppress(OSError):
                os.fsync(self.file.fileno())
            self.file.close()


class Sizes:
    """Whether records can be where the ledger says; the files are asked once."""

    def __init__(self, folder: Path) -> None:
        self.folder, self.of = folder, dict[str, int]()

    def has(self, at: Place) -> bool:
        if at.file not in self.of:
            path = self.folder / at.file
            self.of[at.file] = path.stat().st_size if path.is_file() else 0
        return at.begin + at.length <= self.of[at.file]


def stored(folder: Path, at: Place, sha: str) -> dict[str, Any]:
    """A record.  Raises FileError where it is not there, or is not what it was."""
    return _read(folder, at, sha)[1]


def raw(folder: Path, at: Place, sha: str) -> bytes:
    """The same as it is stored."""
    return _read(folder, at, sha)[0]


def _read(folder: Path, at: Place, sha: str) -> tuple[bytes, dict[str, Any]]:
    path = folder / at.file
    try:
        with path.open("rb") as file:
            file.seek(at.begin)
            data = file.read(at.length)
    except OSError as error:
        raise FileError(f"{path}: {error.strerror}", file=str(path)) from None
    found = unpacked(data, sha)
    if found is None:
        what = f"{path} is damaged from byte {at.begin} on"
        raise FileError(what, f"Remove {path.name}, and run the sweep again.", file=str(path))
    return data, found
