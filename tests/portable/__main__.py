"""python -m tests.portable: the numerical part of the suite under every arithmetic at hand.

Goes on where it was ended: an arithmetic that passed is not tried again with the same sources.
"""

import argparse
import hashlib
import subprocess
import sys
import time
from pathlib import Path

from .arithmetics import ARITHMETICS, Arithmetic
from .part import PART

ROOT = Path(__file__).parents[2]
SOURCES = ("trsim", "tests", "scenarios", "pyproject.toml")


def main() -> None:
    read = argparse.ArgumentParser(prog="python -m tests.portable", description=__doc__)
    read.add_argument("--only", metavar="NAME", help="arithmetics with this in their name")
    read.add_argument("--processes", default="auto", help="of pytest, for each arithmetic")
    read.add_argument("--again", action="store_true", help="also what passed before")
    a = read.parse_args()
    results = [
        tried(one, a.processes, a.again) for one in ARITHMETICS if (a.only or "") in one.name
    ]
    sys.exit(1 if "failed" in results else 0)


def tried(one: Arithmetic, processes: str, again: bool) -> str:
    """What became of an arithmetic, printed too."""
    passed = folder() / one.name.replace(" ", "_")
    begin = time.monotonic()
    if one.missing:
        result = f"not here, the processor lacks {one.missing}"
    elif passed.exists() and not again:
        result = "passed before"
    else:
        command = [sys.executable, "-m", "pytest", "--numprocesses", processes,
                   "--dist", "worksteal", *PART]  # fmt: skip
        done = subprocess.run(command, cwd=ROOT, env=one.surroundings())  # noqa: S603
        result = "failed" if done.returncode else "passed"
        if result == "passed":
            passed.touch()
    print(f"{one.name}: {result} ({time.monotonic() - begin:.0f} s)", flush=True)
    return result


def folder() -> Path:
    """Where is kept what passed with these sources."""
    told = hashlib.sha256(sys.version.encode())
    for name in SOURCES:
        place = ROOT / name
        for path in sorted(place.rglob("*")) if place.is_dir() else [place]:
            if path.suffix in (".py", ".yaml", ".csv", ".json", ".toml"):
                told.update(path.relative_to(ROOT).as_posix().encode() + path.read_bytes())
    made = ROOT / "runs" / "portable" / told.hexdigest()[:16]
    made.mkdir(parents=True, exist_ok=True)
    return made


if __name__ == "__main__":
    main()
