"""Makes the machine code that comes with the package (carried.py).

    python -m trsim.kernels.carry FOLDER [TARGET ...]

compiles every function of the package for every target, and writes FOLDER/TARGET.code.  What is
done stands below FOLDER/parts: the same command goes on where it was ended.  `make wheel` puts the
files into a wheel.
"""

import os
import pkgutil
import sys
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
    return list({carried.key(one.python, one.signature): one for one in ours}.values())


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
    path = folder / target / f"{carried.name(function.python)}-{function.key}{carried.ENDING}"
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
    keys = {carried.key(one.python, one.signature): carried.name(one.python) for one in wanted}
    files = []
    for target in targets:
        files.append(folder / f"{target}{carried.ENDING}")
        carried.written(files[-1], carried.made_for(target), keys, pieces[target])
    return files


def main() -> None:
    """Make what the command line names."""
    if len(sys.argv) < 2 or not set(sys.argv[2:]) <= set(carried.TARGETS):
        sys.exit(f"wanted: FOLDER [TARGET ...], targets are {' '.join(carried.TARGETS)}")
    if fingerprint.settings():
        sys.exit("variables of numba are set: what is carried is made without")
    targets = tuple(sys.argv[2:]) or tuple(carried.TARGETS)
    for path in carry(functions(), targets, Path(sys.argv[1])):
        print(f"{path} {path.stat().st_size / 1e6:.1f} MB")


if __name__ == "__main__":
    main()
