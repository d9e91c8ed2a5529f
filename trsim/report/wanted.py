"""What a report is made of, and what to name in place of something else."""

import os
from collections.abc import Sequence
from os import PathLike
from pathlib import Path

from trsim.errors import FileError

PLAN = "plan.json"  # of the folder of a sweep
NAMED = 3  # result files that are told
WANTED = "A report is made of result files, runs/NAME.h5, or of the folder of a sweep."


def check_given(paths: Sequence[str | PathLike]) -> None:
    """Refuse, with FileError, what cannot be reported, and say what was probably meant."""
    for path in map(Path, paths):
        if os.path.isdir(path):
            if not os.path.exists(path / PLAN):
                what = f"{path}: not the folder of a sweep"
                raise FileError(what, instead(path), file=str(path))
        elif path.suffix in (".yaml", ".yml") and os.path.exists(path):
            hint = f"`trsim run {path}` makes runs/{path.stem}.h5, which can be reported."
            raise FileError(f"{path} is not a result file", hint, file=str(path))
        elif not os.path.exists(path) and not os.path.exists(f"{path}.part"):
            raise FileError(f"{path}: no such file", beside(path), file=str(path))


def instead(folder: Path) -> str:
    """What to name in place of a folder that is no sweep."""
    if os.path.exists(folder.parent / PLAN):
        return f"It belongs to the sweep {folder.parent}: `trsim report {folder.parent}`."
    runs = sorted(path for path in folder.glob("*.h5") if path.is_file())
    sweeps = sorted(path.parent for path in folder.glob(f"*/{PLAN}"))
    inner = sorted(path for path in folder.glob("*/*.h5") if path.is_file())
    told = [f"It holds result files, name some: {listed(runs)}."] if runs else []
    told += [f"It holds sweeps, name one: {listed(sweeps)}."] if sweeps else []
    told += [f"There are result files below it: {listed(inner)}."] if inner and not runs else []
    return "  ".join(told) or WANTED


def beside(path: Path) -> str:
    """The result file that was meant by a name without its folder or its ending, if it is there."""
    guesses = [Path(f"{path}.h5"), Path("runs") / path.name, Path("runs") / f"{path.name}.h5"]
    there = [guess for guess in guesses if os.path.isfile(guess) or os.path.isfile(guess / PLAN)]
    return f"There is {there[0]}." if there else ""


def listed(paths: Sequence[Path]) -> str:
    more = f" and {len(paths) - NAMED} more" if len(paths) > NAMED else ""
    return ", ".join(map(str, paths[:NAMED])) + more
