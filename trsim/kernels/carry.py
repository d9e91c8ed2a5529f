"""Makes the machine code that comes with the package (carried.py).

    python -m trsim.kernels.carry FOLDER [TARGET ...]

compiles every function of the package for every target, and writes FOLDER/TARGET.code.  What is
done stands below FOLDER/parts: the same command goes on where it was ended.

    python -m trsim.kernels.carry --keys FOLDER

run by another version of Python, lets that version use the same files: machine code depends on
sources alone, but its key on the bytecode that each version makes of them.  `make wheel` does both.
"""

import hashlib
import os
import pkgutil
import sys
import zlib
from contextlib import suppress
from functools import cache
from importlib import import_module
from pathlib import Path
from typing import Any

from trsim.kernels import carried, fingerprint, machine
from trsim.kernels.machine import Compiled

PACKAGE = Path(__file__).parents[1]
ROOMS = ("laws", "elements", "assemble", "solve")  # those that have compiled functions


def functions() -> list[Compiled]:
    """All functions of the package that are compiled, each once."""
    for room in ROOMS:
        for module in pkgutil.walk_packages([str(PACKAGE / room)], f"trsim.{room}."):
            import_module(module.name)
    ours = (one for one in machine.made if one.python.__module__.startswith("trsim."))
    return list({_key(one): one for one in ours}.values())


def _key(one: Compiled) -> str:
    return carried.key(one.python, one.signature)


def _mark(one: Compiled) -> str:
    return fingerprint.mark(one.python, one.signature)


def sources() -> str:
    """A digest of all of the package's sources."""
    told = hashlib.sha256()
    for path in sorted(PACKAGE.rglob("*.py")):
        told.update(f"{path.relative_to(PACKAGE).as_posix()}\n".encode() + path.read_bytes())
    return told.hexdigest()


@cache
def processor(target: str) -> Any:
    """LLVM's target machine for a target, as numba makes that of this processor."""
    import llvmlite.binding as llvm

    llvm.initialize_native_target()
    llvm.initialize_native_asmprinter()
    return llvm.Target.from_default_triple().create_target_machine(
        cpu="x86-64", features=",".join(f"+{name}" for name in carried.TARGETS[target]),
        opt=3, reloc="static", codemodel="jitdefault", jit=True,
    )  # fmt: skip


def part(function: Compiled, target: str, folder: Path) -> bytes:
    """The code of one function for a target: as it was made before, or made now."""
    name = f"{carried.name(function.python)}-{function.key}{carried.ENDING}"
    path = folder / target / name
    with suppress(OSError):
        content = path.read_bytes()
        if carried.opened(content):
            return content
    content = carried.sealed(*function.translated(processor(target)))
    path.parent.mkdir(parents=True, exist_ok=True)
    beside = path.with_name(f"{path.name}.{os.getpid()}")
    beside.write_bytes(content)
    os.replace(beside, path)
    return content


def carry(wanted: list[Compiled], targets: tuple[str, ...], folder: Path) -> list[Path]:
    """Write the machine code of functions for targets; the files, one for each target."""
    pieces: dict[str, list[bytes]] = {target: [] for target in targets}
    for k, function in enumerate(wanted, 1):
        for target in targets:
            pieces[target].append(part(function, target, folder / "parts"))
        print(f"\r{k} of {len(wanted)}", end="", file=sys.stderr, flush=True)
    print(file=sys.stderr)
    told = {
        "sources": sources(),
        "keys": {carried.python(): {_key(one): k for k, one in enumerate(wanted)}},
        "names": [carried.name(one.python) for one in wanted],
        "marks": [_mark(one) for one in wanted],
    }
    files = []
    for target in targets:
        places, packed, at = list[Any](), [zlib.compress(piece, 9) for piece in pieces[target]], 0
        for piece, small in zip(pieces[target], packed, strict=True):
            places.append((at, len(small), piece.split(b"\n", 1)[0].decode()))
            at += len(small)
        files.append(folder / f"{target}{carried.ENDING}")
        own = {"for": carried.made_for(target), "places": places}
        carried.write(files[-1], told | own, b"".join(packed))
    return files


def add_keys(wanted: list[Compiled], path: Path) -> None:
    """Let this version of Python use a file.  Raises ValueError where it was made of others."""
    told, begin = carried.index(path)
    at = {mark: k for k, mark in enumerate(told["marks"])}
    marks = [_mark(one) for one in wanted]
    if told["sources"] != sources() or set(marks) != at.keys() or len(at) != len(told["marks"]):
        raise ValueError(f"{path} was made of other sources: make it again first")
    own = {_key(one): at[mark] for one, mark in zip(wanted, marks, strict=True)}
    code = path.read_bytes()[begin:]
    carried.write(path, told | {"keys": told["keys"] | {carried.python(): own}}, code)


def main() -> None:
    """Make what the command line names."""
    if fingerprint.settings():
        sys.exit("variables of numba are set: what is carried is made without")
    if len(sys.argv) == 3 and sys.argv[1] == "--keys":
        for path in sorted(Path(sys.argv[2]).glob(f"*{carried.ENDING}")):
            add_keys(functions(), path)
        return
    if len(sys.argv) < 2 or not set(sys.argv[2:]) <= set(carried.TARGETS):
        sys.exit(f"wanted: FOLDER [TARGET ...], targets are {' '.join(carried.TARGETS)}")
    targets = tuple(sys.argv[2:]) or tuple(carried.TARGETS)
    for path in carry(functions(), targets, Path(sys.argv[1])):
        print(f"{path} {path.stat().st_size / 1e6:.1f} MB")


if __name__ == "__main__":
    main()
