"""What a dead run left, copied into a result file that can be read.

The copy is made by a process of its own, within a time limit: damaged files may stop HDF5, or the
process it runs in.  Of tables whose datasets differ in length the common rows are taken; they end
where time does not rise, where a chunk cannot be read, or where rows were never written (NaN).
"""

import errno
import json
import os
import signal
import subprocess
import sys
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Any

import h5py

from trsim import child
from trsim.errors import FileError, unreadable
from trsim.store import describe, points
from trsim.store.content import content_hash
from trsim.store.disk import check_can_grow, check_room, let_go, synced
from trsim.store.lock import refuse_if_written, writing
from trsim.store.plain import SIGNATURE, Plain
from trsim.store.salvage import Salvage
from trsim.store.target import RESULT, file_errors, fresh, replaceable
from trsim.system import end_with_parent
from trsim.version import __version__

PATIENCE = 30.0  # s for any file
PACE = 10e6  # bytes/s
NOT_WRITTEN = 7  # exit code of the second process: the new file is at fault, not the old one
FULL = (errno.ENOSPC, errno.EDQUOT, errno.EFBIG, errno.EROFS)


def recover(part: Path, target: Path, patience: float = PATIENCE) -> dict[str, Any]:
    """Copy the readable part of a file to `target`; what was found.

    Raises FileError, also where a process is still writing the part file or the target, and
    UsageError where the target is no result file that may be replaced.
    """
    if (missing := unreadable(part)) is not None:
        raise missing
    with part.open("rb") as file:
        if file.read(8) != SIGNATURE:
            what = f"{part} is not a result file"
            raise FileError(what, "There is nothing to recover.", file=str(part))
    if part.name.endswith(".part"):
        refuse_if_written(part.with_name(part.name.removesuffix(".part")))
    final = replaceable(target, RESULT, [part])
    with writing(final), fresh(final, RESULT, [part]) as unfinished:
        check_room(final)
        found = _copied(part, unfinished, final, patience)
    return {"file": str(target), "part": str(part), **found}


def _copied(part: Path, unfinished: Path, final: Path, patience: float) -> dict[str, Any]:
    """What another process found and copied."""
    limit = patience + part.stat().st_size / PACE
    command = child.command("trsim.store.recover", str(part), str(unfinished))
    try:
        done = subprocess.run(  # noqa: S603
            command,
            capture_output=True,
            encoding="utf-8",
            errors="replace",
            timeout=limit,
        )
    except subprocess.TimeoutExpired:
        what = f"{part}: HDF5 could not read it within {limit:.0f} s"
        raise FileError(what, file=str(part)) from None
    if done.returncode == 0:
        found: dict[str, Any] = json.loads(done.stdout)
        return found
    reason = (done.stderr.strip().splitlines() or ["unknown"])[-1][:200]
    if done.returncode == NOT_WRITTEN:
        raise FileError(f"{final}: cannot be written: {reason}", file=str(final))
    with file_errors(final):  # where it cannot write HDF5 may end the process, too
        check_can_grow(unfinished)
    if done.returncode < 0:
        name = signal.Signals(-done.returncode).name
        what = f"{part} is damaged: HDF5 was ended by {name} while reading it"
        raise FileError(what, file=str(part))
    what = f"{part} cannot be recovered: {reason}"
    raise FileError(what, "Run the scenario again.", file=str(part))


def copy(part: Path, unfinished: Path) -> dict[str, Any]:
    """Find and copy, in this process."""
    with h5py.File(Plain(part), "r") as source, _made(unfinished) as file:
        salvage = Salvage(source, file)
        salvage.copy()
        was = str(source.attrs.get("status", "?"))
        planned = _planned(source)
        points.declare(salvage.book, planned)
        points.complete(salvage.book, planned)
        found = salvage.summary()
        found |= {"status": "recovered", "reason": f"recovered from a file with status '{was}'"}
        describe.summarised(salvage.book, found)
        file["provenance"].attrs.update({"recovered_from": str(part), "recovered_by": __version__})
        found["content_sha256"] = file.attrs["content_sha256"] = content_hash(file)
    synced(unfinished)
    return {"was": was, **found}


@contextmanager
def _made(path: Path) -> Iterator[h5py.File]:
    """A new file; after an error HDF5 is not to try again what it could not write."""
    file = h5py.File(path, "w", libver="v110")
    try:
        yield file
        file.close()
    except BaseException:
        let_go(file)
        raise


def _of_writing(error: Exception) -> bool:
    """Whether HDF5 failed to write; the file it reads has no errors of this kind."""
    text = str(error)
    return any(os.strerror(number) in text for number in FULL) or "write failed" in text


def _planned(source: h5py.File) -> points.Plan:
    """The portraits a file was to have; the points of sections are copied."""
    portraits = [
        points.Portrait(name, str(group.attrs["x"]), str(group.attrs["y"]))
        for name, group in source["phase"].items()
    ]
    return points.Plan(tuple(portraits), (), frozenset())


if __name__ == "__main__":
    try:
        end_with_parent()
        print(json.dumps(copy(Path(sys.argv[1]), Path(sys.argv[2]))))
    except (OSError, RuntimeError, KeyError, ValueError) as error:
        print(describe.cause(error), file=sys.stderr)
        sys.exit(NOT_WRITTEN if _of_writing(error) else 1)
