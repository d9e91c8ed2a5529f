"""Checkpoints: X.h5.checkpoint beside X.h5.part, all that a dead run needs to go on.

    trsim checkpoint 1 SHA256\\n    of everything after this line
    an archive of numpy             state/NAME     of the solver, see solve/march/checkpoint.py
                                    extremes/NAME  of the writer, kept while blocks pass by
                                    tail/DATASET   rows of the last chunk, if it is not full
                                    about          the rest as JSON

Chunks of the part file that are full are never written again, and are on the disk before the
checkpoint is: whatever happens to the run later, it leaves them as they are.
"""

import hashlib
import io
import json
import os
import platform
import shlex
import zipfile
import zlib
from collections.abc import Mapping
from contextlib import suppress
from dataclasses import dataclass
from functools import cache
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from trsim.errors import FileError, some
from trsim.store import own
from trsim.store.disk import synced
from trsim.store.target import CHECKPOINT
from trsim.version import __version__

MAGIC = "trsim checkpoint 1"
ENDING = ".checkpoint"
ANEW = "Without --resume the run starts anew."
SHOWN = 5  # differences in a message
OUTSIDE = {
    "cli",
    "report",
    "analyse",
    "studies",
    "sweeps",
    "api",
}  # packages that have no part in a run
DAMAGED = (ValueError, LookupError, TypeError, AttributeError, EOFError, OSError, MemoryError,
           RuntimeError, NotImplementedError, zipfile.BadZipFile, zlib.error)  # fmt: skip
Arrays = dict[str, NDArray[Any]]


@dataclass(frozen=True)
class Checkpoint:
    """A run between two blocks."""

    time: float  # s simulated
    keys: dict[str, Any]  # what must be the same to go on
    rows: dict[str, int]  # group -> rows in the part file
    resumed: list[str]  # when the run was resumed until then
    state: Arrays
    extremes: Arrays
    tail: Arrays


def beside(final: Path) -> Path:
    """The checkpoint that goes with a result file."""
    return final.with_name(final.name + ENDING)


def waiting(final: Path) -> bool:
    """Whether there is a run to go on with: not where one was killed when it had just ended."""
    part = final.with_name(final.name + ".part")
    return beside(final).is_file() and (part.exists() or not final.exists())


def left(part: Path, path: Path, time: float, again: str) -> str:
    """What a run that was broken off left, and the commands that use it; again: goes on."""
    text = f"{part} holds the run until t = {time:g} s; "
    text += f"`{shlex.join(['trsim', 'recover', str(part)])}` makes it a result file"
    if path.exists() and again:
        text += f", `{again}` goes on with the run"
    return f"{text}."


# --- what must be the same -------------------------------------------------------------------


def keys(scenario: Any) -> dict[str, Any]:
    """All that has an influence on the last bit of a run."""
    return {"scenario": json.loads(json.dumps(scenario.resolved)), **_surroundings()}


@cache
def _surroundings() -> dict[str, str]:
    from importlib.metadata import version

    from llvmlite.binding import get_host_cpu_name

    found = {
        "trsim": __version__,
        "sources": sources(Path(__file__).parents[1]),
        "python": platform.python_version(),
        "machine": platform.machine(),
        "processor": get_host_cpu_name(),
        "libc": " ".join(platform.libc_ver()),
    }
    return found | {name: version(name) for name in ("numpy", "numba", "llvmlite")}


def sources(package: Path) -> str:
    """A hash of the code that makes results: kernels called by address belong to it as well."""
    digest = hashlib.sha256()
    for path in sorted(package.rglob("*.py")):
        inside = path.relative_to(package)
        if inside.parts[0] not in OUTSIDE:
            digest.update(f"{inside.as_posix()}\n".encode() + path.read_bytes())
    return digest.hexdigest()


def differences(kept: Checkpoint, scenario: Any) -> str:
    """What is not as it was when a checkpoint was written, in words; nothing if all is."""
    was, now = leaves(kept.keys), leaves(keys(scenario))
    told = [
        f"{n.removeprefix('scenario.')} is {_short(now.get(n))}, was {_short(was.get(n))}"
        for n in differing(was, now)
    ]
    return some(told, SHOWN, "; {} more", "; ")


def leaves(tree: Any, path: str = "") -> dict[str, str]:
    """Dotted path -> JSON of everything in a tree of mappings that is not a mapping itself."""
    if not isinstance(tree, dict):
        return {path: json.dumps(tree)}
    found: dict[str, str] = {}
    for name, inner in tree.items():
        found |= leaves(inner, f"{path}.{name}" if path else name)
    return found


def differing(was: dict[str, str], now: dict[str, str]) -> list[str]:
    """The paths of two trees that do not have the same in both."""
    return [name for name in sorted(was | now) if was.get(name) != now.get(name)]


def _short(value: str | None) -> str:
    return "absent" if value is None else value if len(value) < 40 else f"{value[:30]}..."


# --- on the disk -----------------------------------------------------------------------------


def store(path: Path, kept: Checkpoint) -> None:
    """Write a checkpoint in one go: at any time there is the old one or the new one."""
    about = {name: getattr(kept, name) for name in ("time", "keys", "rows", "resumed")}
    archive = {"about": np.array(json.dumps(about))}
    for part in ("state", "extremes", "tail"):
        archive |= {f"{part}/{name}": array for name, array in getattr(kept, part).items()}
    body = io.BytesIO()
    np.savez(body, **archive)  # type: ignore[arg-type]
    digest = hashlib.sha256(body.getbuffer()).hexdigest()
    fresh = path.with_name(path.name + ".new")
    try:
        own.exists(path, CHECKPOINT)
        with open(own.made(fresh, CHECKPOINT), "wb") as file:
            file.write(f"{MAGIC} {digest}\n".encode())
            file.write(body.getbuffer())
            file.flush()
            os.fsync(file.fileno())
        os.replace(fresh, path)
        synced(path.parent)
    except OSError as error:
        with suppress(OSError, FileError):
            own.remove(fresh, CHECKPOINT)
        raise FileError(f"{path}: cannot be written: {error.strerror}", file=str(path)) from None


def forget(path: Path) -> None:
    """Remove a checkpoint that nothing goes on from any more, and one that a kill left half made.

    Raises FileError where something else has its name.
    """
    with suppress(FileError):  # the name is that of a file of somebody else's
        own.remove(path.with_name(path.name + ".new"), CHECKPOINT)
    own.remove(path, CHECKPOINT)


def load(path: Path) -> Checkpoint:
    """Read a checkpoint.  Raises FileError unless every byte is as it was written."""
    try:
        content = path.read_bytes()
    except OSError as error:
        raise FileError(f"{path}: {error.strerror}", ANEW) from None
    first, _, body = content.partition(b"\n")
    if not first.startswith(MAGIC.encode()):
        raise FileError(f"{path} is not a checkpoint of this trsim", ANEW)
    if first.decode(errors="replace").split()[-1] != hashlib.sha256(body).hexdigest():
        raise FileError(f"{path} is damaged: its checksum is wrong", ANEW)
    try:
        kept = _parsed(body)
    except DAMAGED as error:
        what = f"{path} is damaged: {type(error).__name__} while it was read"
        raise FileError(what, ANEW, file=str(path)) from None
    if wrong := _wrong(kept):
        raise FileError(f"{path} is damaged: its {wrong}", ANEW, file=str(path))
    return kept


def _parsed(body: bytes) -> Checkpoint:
    parts: dict[str, Any] = {"state": {}, "extremes": {}, "tail": {}}
    with np.load(io.BytesIO(body), allow_pickle=False) as archive:
        about = json.loads(archive["about"].item())
        for name in archive.files:
            part, _, inner = name.partition("/")
            if inner:
                parts[part][inner] = archive[name]
    return Checkpoint(**about, **parts)


def _wrong(kept: Checkpoint) -> str:
    """What in a checkpoint is not of its kind."""
    if isinstance(kept.time, bool) or not isinstance(kept.time, int | float):
        return "time is no number"
    if not isinstance(kept.keys, dict):
        return "keys are no mapping"
    counts = kept.rows.values() if isinstance(kept.rows, dict) else [None]
    if not all(isinstance(n, int) and not isinstance(n, bool) and n >= 0 for n in counts):
        return "rows are no counts"
    if not isinstance(kept.resumed, list) or not all(isinstance(t, str) for t in kept.resumed):
        return "times of resuming are no texts"
    return ""


def check_like(path: Path, arrays: Arrays, wanted: Mapping[str, NDArray[Any]], rows: bool) -> None:
    """Check that arrays of a checkpoint are those that are wanted.

    rows: their length may be another.  Raises FileError.
    """
    for name, like in wanted.items():
        found = arrays.get(name)
        if found is None or (found.dtype.kind, found.ndim, found.shape[rows:]) != (
            like.dtype.kind, like.ndim, like.shape[rows:],
        ):  # fmt: skip
            what = f"{path} does not fit this run: {name} is not as it should be"
            raise FileError(what, ANEW, file=str(path))
