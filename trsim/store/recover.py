"""What a dead run left, copied into a result file that can be read.

The copy is made by a process of its own, within a time limit: damaged files may stop HDF5, or the
process it runs in.  Of tables whose datasets differ in length the common rows are taken; they end
where time does not rise, where a chunk cannot be read, or where rows were never written (NaN).
"""

import json
import os
import signal
import subprocess
import sys
from pathlib import Path
from typing import Any

import h5py

from trsim.errors import FileError
from trsim.store import describe, points
from trsim.store.content import content_hash
from trsim.store.plain import SIGNATURE, Plain
from trsim.store.salvage import Salvage
from trsim.version import __version__

PATIENCE = 30.0  # s for any file
PACE = 10e6  # bytes/s


def recover(part: Path, target: Path, patience: float = PATIENCE) -> dict[str, Any]:
    """Copy the readable part of a file to `target`; what was found."""
    if not part.is_file():
        raise FileError(f"{part}: no such file")
    with part.open("rb") as file:
        if file.read(8) != SIGNATURE:
            raise FileError(f"{part} is not a result file", "There is nothing to recover.")
    try:
        target.parent.mkdir(parents=True, exist_ok=True)
    except OSError as error:
        raise FileError(f"{target}: {error.strerror}") from None
    limit = patience + part.stat().st_size / PACE
    command = [sys.executable, "-m", "trsim.store.recover", str(part), str(target)]
    unfinished = target.with_name(target.name + ".part")
    try:
        done = subprocess.run(command, capture_output=True, text=True, timeout=limit)  # noqa: S603
    except subprocess.TimeoutExpired:
        unfinished.unlink(missing_ok=True)
        raise FileError(f"{part}: HDF5 could not read it within {limit:.0f} s") from None
    if done.returncode == 0:
        told: dict[str, Any] = json.loads(done.stdout)
        return told
    unfinished.unlink(missing_ok=True)
    if done.returncode < 0:
        name = signal.Signals(-done.returncode).name
        raise FileError(f"{part} is damaged: HDF5 was ended by {name} while reading it")
    reason = (done.stderr.strip().splitlines() or ["unknown"])[-1]
    raise FileError(f"{part} cannot be recovered: {reason[:200]}", "Run the scenario again.")


def copy(part: Path, target: Path) -> dict[str, Any]:
    """The same, in this process."""
    unfinished = target.with_name(target.name + ".part")
    with h5py.File(Plain(part), "r") as source, h5py.File(unfinished, "w", libver="v110") as file:
        salvage = Salvage(source, file)
        salvage.copy()
        was = str(source.attrs.get("status", "?"))
        planned = _planned(source)
        points.declare(file, planned)
        points.complete(file, planned)
        told = salvage.summary()
        told |= {"status": "recovered", "reason": f"recovered from a file with status '{was}'"}
        describe.summarised(file, told)
        file["provenance"].attrs.update({"recovered_from": str(part), "recovered_by": __version__})
        told["content_sha256"] = file.attrs["content_sha256"] = content_hash(file)
    with unfinished.open("rb") as done:
        os.fsync(done.fileno())
    os.replace(unfinished, target)
    return {"file": str(target), "part": str(part), "was": was, **told}


def _planned(source: h5py.File) -> points.Plan:
    """The portraits and sections a file was to have."""
    portraits, sections = [], []
    for name, group in source["phase"].items():
        portraits.append(points.Portrait(name, str(group.attrs["x"]), str(group.attrs["y"])))
    for group in source["poincare"].values():
        words = [str(group.attrs[name]) for name in points.Section._fields]
        sections.append(points.Section(*words))
    return points.Plan(tuple(portraits), tuple(sections), frozenset())


if __name__ == "__main__":
    try:
        print(json.dumps(copy(Path(sys.argv[1]), Path(sys.argv[2]))))
    except (OSError, RuntimeError, KeyError, ValueError) as error:
        sys.exit(f"{describe.cause(error)}")
