"""Thousands of cases of which numbers are kept: the reverser with play, and P1.

Whole commands on all processors.  Efficiency: CPU time over wall time times processors.
"""

import json
import time
from collections.abc import Sequence
from functools import partial
from pathlib import Path
from statistics import median
from tempfile import TemporaryDirectory
from typing import Any, NamedTuple

from benchmarks.measure import SCENARIOS
from benchmarks.sweeps import SCENARIO, A, B
from benchmarks.tables import head, row
from benchmarks.trees import HERE, Refused, Tree
from benchmarks.trees.turns import commands, turns
from trsim.system import processors

AGAIN = 3  # the same command is given so often when all is done


class Sweep(NamedTuple):
    """Cases of a scenario: ranges and how many values of each."""

    name: str
    scenario: str
    sets: tuple[str, ...]
    varied: dict[str, tuple[str, int]]

    @property
    def cases(self) -> int:
        (_, n), (_, m) = self.varied.values()
        return n * m

    def part(self, of: int) -> "Sweep":
        """One with so many fewer values of what is varied first."""
        first, *others = self.varied.items()
        key, (between, n) = first
        return self._replace(varied={key: (between, n // of), **dict(others)})

    def words(self, tree: Tree, folder: Path) -> list[str]:
        """The command of a tree, without its program."""
        given = [f"{key}=lin({between}, {n})" for key, (between, n) in self.varied.items()]
        sets = [word for one in (*self.sets, *given) for word in ("--set", one)]
        keep = ("--keep", "summary") if keeps(tree) else ()
        out = ("-o", str(folder), "--json", "-q")
        return ["sweep", self.scenario, *sets, *keep, *out]


REVERSER = Sweep(
    "of the reverser, 1 s", SCENARIO, (),
    {A: ("0.25 mm, 0.35 mm", 40), B: ("0.25 mm, 0.35 mm", 25)},
)  # fmt: skip
CRANK = Sweep(
    "of P1 with friction, 3 ms",
    str(SCENARIOS / "validation" / "slider_crank_friction.yaml"),
    ("solver.end=3 ms",),
    {"joints.pin.clearance": ("0.3 mm, 0.7 mm", 100),
     "contact_laws.steel.restitution": ("0.8, 0.95", 100)},
)  # fmt: skip


class Swept(NamedTuple):
    """What a sweep of a tree took."""

    wall: float  # s
    cpu: float  # s, of a case
    efficiency: float
    size: float  # MB
    again: list[float]  # s of wall time, each time


def keeps(tree: Tree) -> bool:
    """Does a sweep of it keep numbers?  Older ones keep result files."""
    return "--keep" in tree.said("sweep", "--help")


def swept(sweep: Sweep, trees: Sequence[Tree]) -> list[Swept]:
    """A sweep by each tree, in turn, and the same again."""
    with TemporaryDirectory() as name:
        each = [(tree, Path(name) / str(k)) for k, tree in enumerate(trees)]
        for tree, folder in each:  # two cases: what is compiled once is so after this
            first = sweep.words(tree, folder.with_name(f"{folder.name}_first"))
            tree.said(*first, "--shard", f"1/{sweep.cases // 2}")
        done = commands([(tree, tree.trsim(*sweep.words(tree, at))) for tree, at in each])
        for command in done:
            checked(sweep, command.tree, json.loads(command.said))
        again = turns([partial(repeated, sweep, *one) for one in each], AGAIN)
        return [
            Swept(command.wall, command.cpu / sweep.cases,
                  command.cpu / (processors() * command.wall), megabytes(folder), walls)
            for command, (_, folder), walls in zip(done, each, again, strict=True)
        ]  # fmt: skip


def checked(sweep: Sweep, tree: Tree, told: dict[str, Any]) -> None:
    """Were all cases run, and did all succeed?"""
    if told["counts"] != {"done": sweep.cases}:
        raise Refused(tree, f"{sweep.name}: {told['counts']}")


def repeated(sweep: Sweep, tree: Tree, folder: Path) -> float:
    """Wall time of the command where all is done."""
    began = time.perf_counter()
    told = json.loads(tree.said(*sweep.words(tree, folder)))
    if told["ran"]:
        raise Refused(tree, f"{sweep.name}: {told['ran']} ran again")
    return time.perf_counter() - began


def megabytes(folder: Path) -> float:
    return sum(path.stat().st_size for path in folder.rglob("*") if path.is_file()) / 1e6


def main() -> None:
    """Print the table."""
    head("cases", "wall time, s", "CPU time of a case, ms", "efficiency", "MB",
         "the same again, s")  # fmt: skip
    for sweep in (REVERSER, CRANK):
        (of,) = swept(sweep, [HERE])
        row(f"{sweep.cases:,} {sweep.name}", f"{of.wall:.0f}", f"{1e3 * of.cpu:.0f}",
            f"{of.efficiency:.2f}", f"{of.size:.0f}", f"{median(of.again):.1f}")  # fmt: skip
