"""python -m tests.truth: draw and judge scenes, show one, write the page."""

import argparse
from pathlib import Path

from . import ledger
from .phased import FAMILIES


def show(family: str, seed: int) -> None:
    from .trial import made, verdict

    print(made(family, seed).scene.text())
    v = verdict(family, seed)
    print(f"{v.verdict}: exit {v.exit}, worst error over its bound {v.ratio:.3g}: {v.what}{v.why}")
    print(f"reference: {v.truth}; judged {100 * v.reach:.0f} % of the rows; grazing: {v.grazing}")
    for text in v.warnings:
        print(f"said: {text}")


def main() -> None:
    read = argparse.ArgumentParser(prog="python -m tests.truth", description=__doc__)
    read.add_argument("family", nargs="?", choices=list(FAMILIES), metavar="FAMILY")
    read.add_argument("seed", nargs="?", type=int)
    read.add_argument("--show", action="store_true", help="print the scene and its judgement")
    read.add_argument("--count", type=int, default=106, help="scenes of each family")
    read.add_argument("--workers", type=int, default=2)
    read.add_argument("--commit", help="draw the scenes of another commit")
    read.add_argument("--table", action="store_true", help="write docs/truth.md of a ledger")
    read.add_argument("--ledger", type=Path, help="that of the newest run unless given")
    a = read.parse_args()
    if a.family and a.seed is not None:
        show(a.family, a.seed)
        return
    if a.table:
        from .table import write

        files = sorted(ledger.FOLDER.glob("*.jsonl"), key=lambda f: f.stat().st_mtime)
        print(write(a.ledger or files[-1]))
        return
    ledger.run(a.count, a.workers, a.commit, (a.family,) if a.family else ())


if __name__ == "__main__":
    main()
