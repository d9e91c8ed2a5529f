"""Machine code that comes with the package, for common processors, made by carry.py.

A first run then compiles nothing and does not import numba.  There is one file for each processor:

    digest of the next line
    index: what the code was made for, the key of each function, where its code stands, its digest
    code of one function after another, packed

Of a file nothing is used unless it was made for this system, for a processor that has no more than
this one, by the same files of this package, for this version of Python, and called as the numba
that is here calls.  Of a function nothing is used unless its key is the same: its bytecode, that of
all it reaches, the constants they read, and the layout of what it works on (fingerprint.py).  What
is not used is compiled.  The code itself asks for nothing but the C library: which numba made it,
of those known here, makes no difference.
"""

import hashlib
import json
import os
import sys
import zlib
from collections.abc import Callable
from contextlib import suppress
from functools import cache
from pathlib import Path
from typing import Any, NamedTuple

from trsim.kernels import fingerprint
from trsim.kernels.signatures import KNOWN, Signature

FOLDER = Path(__file__).parents[1] / "carried"
ENDING = ".code"
V2 = ("cx16", "popcnt", "sahf", "sse3", "sse4.1", "sse4.2", "ssse3")
V3 = (*V2, "avx", "avx2", "bmi", "bmi2", "f16c", "fma", "lzcnt", "movbe")
# what code may ask of a processor beyond the first of its kind, in LLVM's words; the best first
TARGETS = {"x86-64-v3": V3, "x86-64-v2": V2, "x86-64": ()}
DAMAGED = (OSError, ValueError, LookupError, TypeError, zlib.error)
_told: list[str] = []  # why what was carried was not used


class Set(NamedTuple):
    """What is carried for a processor."""

    path: Path
    keys: dict[str, int]  # of functions: which of the places
    names: list[str]  # of the functions
    places: list[tuple[int, int, str]]  # in the file: first byte, and how many; digest
    begin: int  # of the first one


def made_for(target: str) -> dict[str, Any]:
    """What code of this process, compiled for a target, depends on beside its functions."""
    import llvmlite.binding as llvm

    return {
        "system": f"{llvm.get_process_triple().split('-')[0]} {sys.platform}",
        "features": list(TARGETS[target]),
        "files of trsim that make code": fingerprint.how(),
        "variables of numba": [list(one) for one in fingerprint.settings()],
    }


def python() -> str:
    """The version of Python, as far as bytecode depends on it."""
    return f"{sys.implementation.name} {sys.version_info[0]}.{sys.version_info[1]}"


def key(function: Callable, signature: Signature) -> str:
    """What is carried of a function is found by this."""
    return fingerprint.of(function, signature, python())


def name(function: Callable) -> str:
    """What files call a function."""
    return f"{function.__module__.removeprefix('trsim.')}.{function.__name__}"


def code(function: Callable, signature: Signature) -> tuple[str, bytes] | None:
    """Symbol and object file of a function; None where none is carried that can be used here."""
    there, _ = _chosen(FOLDER)
    if there is None:
        return None
    at = there.keys.get(key(function, signature))
    if at is None:
        if name(function) in there.names:
            _told.append(f"{name(function)} was changed since")
        return None
    found = None
    with suppress(*DAMAGED), open(there.path, "rb") as file:
        begin, size, digest = there.places[at]
        file.seek(there.begin + begin)
        content = zlib.decompress(file.read(size))
        found = opened(content) if content.startswith(digest.encode()) else None
    if found is None:
        _told.append(f"{there.path.name} is damaged")
    return found


def tell() -> None:
    """Say once why what is carried is not used, where there is any."""
    why = _chosen(FOLDER)[1] or (_told[0] if _told else "")
    if why and "" not in _told:
        _told.append("")
        line = f"trsim: machine code that came with it is not used, it compiles instead: {why}"
        print(line, file=sys.stderr)


# --- files ---------------------------------------------------------------------------------------


def sealed(symbol: str, objects: bytes) -> bytes:
    """Code of one function with its digest."""
    name = symbol.encode()
    return b"\n".join((_digest(name + b"\n" + objects), name, objects))


def opened(content: bytes) -> tuple[str, bytes] | None:
    """The code in it; None where it is damaged."""
    digest, _, rest = content.partition(b"\n")
    symbol, ends, objects = rest.partition(b"\n")
    return (symbol.decode(), objects) if ends and _digest(rest) == digest else None


def index(path: Path) -> tuple[dict[str, Any], int]:
    """What a file says of itself, and where its code begins.  Raises one of DAMAGED."""
    with open(path, "rb") as file:
        digest, line = file.readline().strip(), file.readline()[:-1]
        if _digest(line) != digest:
            raise ValueError
        return json.loads(line), file.tell()


def write(path: Path, told: dict[str, Any], code: bytes) -> None:
    """Write a file: what it says of itself, and its code."""
    line, part = json.dumps(told).encode(), path.with_name(f"{path.name}.{os.getpid()}")
    part.write_bytes(b"\n".join((_digest(line), line, code)))
    os.replace(part, path)


def _digest(content: bytes) -> bytes:
    return hashlib.sha256(content).hexdigest().encode()


# --- which of them -------------------------------------------------------------------------------


@cache
def _chosen(folder: Path) -> tuple[Set | None, str]:
    """The set for the most able processor that this one can stand for, and why there is none."""
    why = ""
    for target in TARGETS:
        path = folder / f"{target}{ENDING}"
        if path.exists():
            found, why = _looked_at(path, target)
            if found is not None:
                return found, ""
    return None, why


def _looked_at(path: Path, target: str) -> tuple[Set | None, str]:
    """A set that can be used here, or why not."""
    try:
        told, begin = index(path)
        keys = told["keys"].get(python())
        why = unfit(told["for"], target)
        if not why and keys is None:
            why = f"it is for {' and '.join(told['keys'])}, this is {python()}"
        found = Set(path, keys, told["names"], told["places"], begin)
    except DAMAGED:
        return None, f"{path.name} is damaged"
    return (None, why) if why else (found, "")


def unfit(made: dict[str, Any], target: str) -> str:
    """Why code that was made so cannot be used here; empty where it can."""
    here = made_for(target)
    for what in here.keys() | made.keys():
        theirs, ours = made.get(what), here.get(what)
        if theirs != ours:
            return f"{what}: {_few(theirs)} there, {_few(ours)} here"
    lacking = set(TARGETS[target]) - processor()
    if lacking:
        return f"this processor lacks {' '.join(sorted(lacking))}"
    if (version := numba()) not in {f"0.{minor}" for minor in KNOWN}:
        return f"numba {version} is not among the versions known here"
    return ""


def _few(value: Any) -> str:
    """Something of an index, shortly."""
    listed = value if isinstance(value, list) else [value]
    return " ".join(str(one)[:40] for one in listed) or "none"


def processor() -> set[str]:
    """What this processor can do, in LLVM's words."""
    import llvmlite.binding as llvm

    return {name for name, has in llvm.get_host_cpu_features().items() if has}


def numba() -> str:
    """Version of the numba that is installed, as far as calls depend on it."""
    from importlib.metadata import PackageNotFoundError, version

    try:
        return ".".join(version("numba").split(".")[:2])
    except PackageNotFoundError:
        return "(none)"
