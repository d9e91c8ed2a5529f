"""The rows of a dead run, up to a checkpoint, in a fresh part file.

They are read by a process of its own, within a time limit, as in recover.py: damaged files may stop
HDF5, or the process it runs in.  It sends the bytes of the full chunks; the rows after them are in
the checkpoint.
"""

import json
import signal
import subprocess
import sys
import threading
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Any, BinaryIO

import h5py
import numpy as np

from trsim import child
from trsim.errors import FileError
from trsim.store.checkpoint import ANEW, Checkpoint, check_like
from trsim.store.checkpoint import beside as checkpoint_of
from trsim.store.describe import cause
from trsim.store.grow import Growing
from trsim.store.plain import Plain
from trsim.store.recover import PACE, PATIENCE
from trsim.system import end_with_parent

ROWS = 1 << 14  # rows handled together, whole chunks


def refill(part: Path, tables: list[Growing], kept: Checkpoint) -> None:
    """Fill empty tables with the rows that a part file had at a checkpoint.

    Raises FileError where they are not all there any more.
    """
    if not part.is_file():
        raise FileError(f"{part}: no such file, although its checkpoint is there", ANEW)
    check_there(part, tables, kept)
    wanted = [(d.name, t.full(kept.rows[t.name])) for t in tables for d in t.datasets]
    with sender(part, wanted) as rows:
        for table in tables:
            n, full = kept.rows[table.name], table.full(kept.rows[table.name])
            for dataset in table.datasets:
                dataset.resize(n, axis=0)
                for k in range(0, full, ROWS):
                    dataset[k : min(k + ROWS, full)] = _taken(rows, dataset, min(ROWS, full - k))
                dataset[full:] = kept.tail[dataset.name]
            table.n = n


def check_there(part: Path, tables: list[Growing], kept: Checkpoint) -> None:
    """Check that a checkpoint tells of all tables, and has the rows of their last chunks."""
    like = {d.name: np.empty((0, *d.shape[1:]), d.dtype) for t in tables for d in t.datasets}
    if {t.name for t in tables} != {*kept.rows}:
        raise FileError(f"{beside(part)} does not fit this run: other tables", ANEW)
    check_like(beside(part), kept.tail, like, rows=True)
    for table in tables:
        n = kept.rows[table.name] - table.full(kept.rows[table.name])
        if any(len(kept.tail[dataset.name]) != n for dataset in table.datasets):
            raise FileError(f"{beside(part)} does not fit this run: rows of {table.name}", ANEW)


def beside(part: Path) -> Path:
    """The checkpoint of a part file."""
    return checkpoint_of(part.with_name(part.name.removesuffix(".new").removesuffix(".part")))


def _taken(rows: BinaryIO, like: h5py.Dataset, n: int) -> Any:
    """The next n rows of a dataset.  Raises EOFError where there are fewer."""
    shape = (n, *like.shape[1:])
    piece = rows.read(int(np.prod(shape)) * like.dtype.itemsize)
    if len(piece) < int(np.prod(shape)) * like.dtype.itemsize:
        raise EOFError
    return np.frombuffer(piece, like.dtype).reshape(shape)


@contextmanager
def sender(part: Path, wanted: list[tuple[str, int]]) -> Iterator[BinaryIO]:
    """The bytes of the first rows of some datasets, one after the other, from another process."""
    limit = PATIENCE + part.stat().st_size / PACE
    command = child.command("trsim.store.resume", str(part))
    pipe = subprocess.PIPE
    process = subprocess.Popen(command, stdin=pipe, stdout=pipe, stderr=pipe)  # noqa: S603
    assert process.stdin and process.stdout and process.stderr  # noqa: S101
    late = threading.Event()

    def end() -> None:
        late.set()
        process.kill()

    watch = threading.Timer(limit, end)
    watch.start()
    try:
        process.stdin.write(json.dumps(wanted).encode())
        process.stdin.close()
        yield process.stdout
    except (EOFError, BrokenPipeError):
        code, said = process.wait(), process.stderr.read().decode(errors="replace")
        reason = (said.strip().splitlines() or ["nothing was sent"])[-1]
        if code < 0:
            reason = f"HDF5 was ended by {signal.Signals(-code).name} while reading it"
        if late.is_set():
            reason = f"HDF5 could not read it within {limit:.0f} s"
        raise FileError(f"{part} cannot be resumed: {reason[:200]}", ANEW) from None
    finally:
        watch.cancel()
        process.kill()
        process.wait()
        process.stdout.close()
        process.stderr.close()


def send(part: Path, wanted: list[tuple[str, int]], out: BinaryIO) -> None:
    """Write the bytes of the first rows of datasets; ValueError where they are not all there."""
    with h5py.File(Plain(part), "r") as file:
        for name, n in wanted:
            item = file[name]
            # a chunk that was never written has no place in the file
            written = min(len(item), item.id.get_num_chunks() * item.chunks[0])
            if written < n:
                raise ValueError(f"{name} has {written} rows, {n} at the checkpoint")
        for name, n in wanted:
            for k in range(0, n, ROWS):
                out.write(file[name][k : min(k + ROWS, n)].tobytes())
    out.flush()


if __name__ == "__main__":
    try:
        end_with_parent()
        send(Path(sys.argv[1]), json.load(sys.stdin), sys.stdout.buffer)
    except (OSError, RuntimeError, KeyError, ValueError) as error:
        sys.exit(cause(error))
