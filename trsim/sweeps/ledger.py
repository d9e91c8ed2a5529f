"""What became of every case: one line of JSON for each end, in ledger.jsonl of the sweep's folder.

A line is written when its case has ended, and none is ever changed: of several the last counts.
With shards each writes lines of its own, ledger-1of3.jsonl.  A line cut short by a dead process
is left out; the result file it was about is found by what the file says of itself.  Every line
ends with a check sum of itself (crc32): one that was changed is left out too.
"""

import json
import os
import zlib
from collections import Counter
from collections.abc import Iterable
from contextlib import suppress
from pathlib import Path
from typing import Any, NamedTuple

from trsim import system
from trsim.errors import FileError
from trsim.statuses import ILL, STATUSES

DIGEST = "case_sha256"  # attribute of /provenance in a result file
AGAIN = ("crashed", "over time", "over memory", "no file")  # chance or limits: tried again
REFUSED = "refused"  # no scenario, or no mechanism: there is no result file
FAILED = (*AGAIN, REFUSED, *ILL)
LARGEST = 2**62  # of a number in a line
NUMBER = (int, float)
WORD = (str, int, float, type(None))  # of the summary in a line
CHECK = b', "check": '  # before the check sum at the end of a line


class Entry(NamedTuple):
    """How a case ended."""

    case: str
    digest: str
    engine: str
    status: str  # of the result file, or one of FAILED
    reason: str
    attempts: int
    content: str  # sha256 of the results; "" without a file
    size: int  # bytes of the file
    changed: int  # ns, when it was written
    at: float  # s since 1970
    wall: float  # s
    summary: dict[str, Any]
    kept: str = ""  # where its record is, see records.py; "" of a case with a result file

    @property
    def failed(self) -> bool:
        return self.status in FAILED


KINDS: dict[str, Any] = {
    name: {int: int, float: (int, float)}.get(kind, kind if isinstance(kind, type) else dict)
    for name, kind in Entry.__annotations__.items()
}


class Ledger:
    """The ledger of one process, open for adding lines."""

    def __init__(self, folder: Path, shard: str = "") -> None:
        self.path = folder / f"ledger{f'-{shard}' if shard else ''}.jsonl"
        flags = os.O_WRONLY | os.O_CREAT | os.O_APPEND | system.O_NONBLOCK
        self.file = open(system.opened(self.path, flags), "ab")  # noqa: SIM115 - see close
        if self.file.tell() and not _ends_a_line(self.path):
            self.file.write(b"\n")

    def add(self, entry: Entry) -> None:
        self.file.write(line_of(entry) + b"\n")
        self.file.flush()

    def close(self) -> None:
        with suppress(OSError):
            os.fsync(self.file.fileno())
        self.file.close()


def _ends_a_line(path: Path) -> bool:
    with path.open("rb") as file:
        file.seek(-1, os.SEEK_END)
        return file.read(1) == b"\n"


def entries(folder: Path) -> dict[str, Entry]:
    """The last entry of every case: of one process its last line, of several shards the latest."""
    found: dict[str, Entry] = {}
    for path in filter(Path.is_file, sorted(folder.glob("ledger*.jsonl"))):
        own = {entry.case: entry for entry in map(entry_of, _lines(path)) if entry}
        for name, entry in own.items():  # a clock may have been set back since a line before
            if name not in found or entry.at >= found[name].at:
                found[name] = entry
    return found


def _lines(path: Path) -> list[bytes]:
    try:
        return path.read_bytes().splitlines()
    except OSError as error:
        raise FileError(f"{path}: {error.strerror}", file=str(path)) from None


def line_of(entry: Entry) -> bytes:
    """The line of an entry."""
    told = json.dumps(entry._asdict()).encode()
    return b"%s%s%d}" % (told[:-1], CHECK, zlib.crc32(told))


def _checked(line: bytes) -> bytes | None:
    """A line without its check sum; None where that is another one.  Lines of older versions have
    none."""
    told, mark, check = line.rpartition(CHECK)
    if not mark:
        return line
    whole = told + b"}"
    return whole if check == b"%d}" % zlib.crc32(whole) else None


def entry_of(line: bytes) -> Entry | None:
    """The entry in a line; None of a line that holds something else, whatever it is."""
    checked = _checked(line)
    if checked is None:
        return None
    try:
        told = json.loads(checked.decode())
    except (ValueError, RecursionError):
        return None
    if not isinstance(told, dict) or told.keys() | {"kept"} != KINDS.keys():
        return None
    told.setdefault("kept", "")
    for name, kind in KINDS.items():  # of thousands of lines
        value = told[name]
        if not isinstance(value, kind) or isinstance(value, bool):
            return None
        if isinstance(value, NUMBER) and not abs(value) < LARGEST:
            return None
    for word in told["summary"].values():
        if not isinstance(word, WORD):
            return None
    if told["status"] not in STATUSES and told["status"] not in FAILED:
        return None
    if b"\\ud" in line.lower() and not _is_text(told):
        return None
    return Entry(**told)


def _is_text(told: dict[str, Any]) -> bool:
    """Whether all of it can be written: half of a pair of surrogates cannot."""
    try:
        json.dumps(told, ensure_ascii=False).encode()
    except UnicodeEncodeError:
        return False
    return True


def stamp(file: Path) -> tuple[int, int]:
    """Size and time of change of a file; zeros where there is none."""
    try:
        told = file.stat()
    except OSError:
        return 0, 0
    return told.st_size, told.st_mtime_ns


def in_a_line(reason: str) -> str:
    """A message of several lines as one, without its excerpt."""
    lines = [line for line in reason.splitlines() if not line.startswith("    ")]
    return "  ".join(" ".join(line.split()) for line in lines if line.strip())


def counts(statuses: Iterable[str]) -> dict[str, int]:
    """How many cases there are of each status."""
    return dict(Counter(statuses).most_common())
