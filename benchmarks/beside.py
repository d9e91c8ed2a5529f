"""This tree beside the state before: sweeps, four pins, decays, P1 by hand, the reverser in space.

    python -m benchmarks beside [WHAT ...] [--before COMMIT] [--rounds 16] [--part 10]

The state before is a commit that is taken from git into runs/before (benchmarks/trees), or that in
the folder of another tree.  What of either tree is compiled, or loaded once, is so before times
count.  Then both work in turn: short runs each first in every other round, whole sweeps for two
seconds each while the other stands still, so that whatever else the machine does meets both alike.
What is told are medians over the rounds, CPU time unless it says wall time; the ratio is that of
this tree over the one before, with the bounds of its 95 % interval where there is one.

`auto` is told in ms, and over Radau; P1 in ms at the loosest tolerance whose error is that small, a
mean over five first steps, and over the program by hand (benchmarks/minimal.py).
"""

import argparse
import sys
from collections.abc import Callable, Iterator, Sequence
from functools import partial
from pathlib import Path
from statistics import median
from tempfile import TemporaryDirectory
from typing import Any, NamedTuple

from benchmarks import thousands
from benchmarks.measure import SCENARIOS
from benchmarks.problems import GOVERNOR, VALIDATION
from benchmarks.slider_crank import (
    BOUNDS,
    CHANNEL,
    END,
    FIRST_STEPS,
    FRICTION,
    ROWS,
    SPEED,
    TOLERANCES,
    by_hand,
    reference,
)
from benchmarks.startup import took
from benchmarks.tables import head, power, row
from benchmarks.trees import BEFORE, HERE, Refused, Tree, there
from benchmarks.trees.turns import Task, measured, ratio, turns, worker
from benchmarks.work_precision import cheapest, first_steps
from trsim.system import processors

REVERSER = SCENARIOS / "thrust_reverser"
QUIET = ("output.every=20 s", "output.channels=[]")  # runs that write no rows
DECAYS = ("1e-4", "1e-6", "1e-8")  # tolerances
ROUNDS = 16
Trees = Sequence[Tree]


class Line(NamedTuple):
    """A row of the table: cells of each tree, and what they took, round by round."""

    what: str
    asked: str
    cells: list[str]
    took: list[list[float]]

    def told(self) -> None:
        """Print it."""
        before, now = ["", *self.cells][-2:]
        off = ""
        if len(self.took) > 1:
            middle, around = ratio(*self.took)
            off = f"{middle} ({around})" if around else middle
        row(self.what, self.asked, before, now, off)


def swept(sweep: thousands.Sweep, aim: str, trees: Trees, part: int) -> Iterator[Line]:
    """A sweep of so many cases, whole or a part of it."""
    sweep = sweep.part(part) if part > 1 else sweep
    each = thousands.swept(sweep, trees)
    what = f"{sweep.cases:,} cases {sweep.name}"
    files = "" if all(map(thousands.keeps, trees)) else " (before: result files)"
    yield Line(f"{what}: wall time", "" if part > 1 else aim, [f"{of.wall:.1f} s" for of in each],
               [[of.wall] for of in each])  # fmt: skip
    for told, form, number in (
        ("CPU time of a case", "{:.1f} ms", lambda of: 1e3 * of.cpu),
        (f"on disk{files}", "{:.1f} MB", lambda of: of.size),
        ("efficiency", "{:.2f}", lambda of: of.efficiency),
    ):
        numbers = [number(of) for of in each]
        yield Line(f"{what}: {told}", "", [form.format(one) for one in numbers],
                   [[one] for one in numbers])  # fmt: skip
    yield Line(f"{what}: the same again, wall time", "",
               [f"{median(of.again):.2f} s" for of in each], [of.again for of in each])  # fmt: skip


def four_pins(trees: Trees, rounds: int) -> Iterator[Line]:
    """A whole run in a process that has made one."""
    sets = ["solver.tolerance=1e-3", *QUIET]
    of = {"source": str(REVERSER / "clearance_abpq_0.1mm.yaml"), "sets": sets}
    found = seconds(measured(trees, [[("whole", of)]] * len(trees), rounds))
    took = [tree[0] for tree in found]
    yield Line("four pins, 1e-3: a run, process warm", "0.25 s",
               [f"{median(one):.3f} s" for one in took], took)  # fmt: skip


def over_radau(
    what: tuple[str, str], source: str, tolerances: Sequence[str], trees: Trees, rounds: int
) -> Iterator[Line]:
    """`auto` and Radau at some tolerances.  what: with how many times Radau is asked for."""
    name, asked = what
    tasks = [integrated(source, [[*QUIET, f"solver.tolerance={one}", f"solver.method={method}"]])
             for one in tolerances for method in ("auto", "radau")]  # fmt: skip
    found = seconds(measured(trees, [tasks] * len(trees), rounds))
    for k, tolerance in enumerate(tolerances):
        autos = [tree[2 * k] for tree in found]
        radaus = [tree[2 * k + 1] for tree in found]
        cells = [beside(*pair) for pair in zip(autos, radaus, strict=True)]
        yield Line(f"{name}, {tolerance}: `auto`, over Radau", asked, cells, autos)


def beside(ours: list[float], theirs: list[float], runs: int = 1) -> str:
    """What a run takes, and how many times what it is compared with."""
    times = median(a / b for a, b in zip(ours, theirs, strict=True))
    return f"{1e3 * median(ours) / runs:.2f} ms, {times:.2f}"


def slider_cranks(trees: Trees, rounds: int) -> Iterator[Line]:
    """P1 to some errors: what it takes at the tolerance each tree needs for it."""
    tasks: list[list[Task]] = [[] for _ in trees]
    names, hands = [], []
    for variant, mu in FRICTION.items():
        source = str(VALIDATION / f"slider_crank_{variant}.yaml")
        known = reference(variant)
        hand, runs = by_hand(known, mu), drawn(source)
        errors = [errors_of(tree, source, runs, known) for tree in trees]
        for bound in BOUNDS:
            names.append(f"P1 {variant}, error {power(bound, 0)}: CPU, over by hand")
            best = cheapest(hand, bound)
            if best is None:
                raise RuntimeError(f"by hand nothing is as exact as {bound}")
            hands.append(partial(by_hand_took, best.tolerance, mu))
            for of_tree, found in zip(tasks, errors, strict=True):
                least = min((p for p in found if p[0] <= bound), key=lambda p: p[1])
                of_tree.append(integrated(source, [[*QUIET, *one] for one in runs[least[2]]]))
    found = seconds(measured(trees, tasks, rounds, [lambda k, times: (hands[k](times), {})]))
    *ours, theirs = found
    for k, name in enumerate(names):
        took = [tree[k] for tree in ours]
        cells = [beside(one, theirs[k], len(FIRST_STEPS)) for one in took]
        yield Line(name, "6", cells, took)


def drawn(source: str) -> list[list[list[str]]]:
    """Of each tolerance: what is set in five runs that differ in their first steps."""
    from trsim.assemble.assemble import assemble
    from trsim.scenario.load import load

    scenario = load(Path(source), [END, *QUIET])
    mechanism, found = assemble(scenario), []
    for tolerance in TOLERANCES:
        sets = [END, f"solver.tolerance={tolerance!r}"]
        steps = first_steps(scenario, mechanism, tolerance)
        found.append([[*sets, *([f"solver.first_step={h!r}"] if h else [])] for h in steps])
    return found


def errors_of(tree: Tree, source: str, runs: list, known: Any) -> list[tuple[float, float, int]]:
    """Median error and evaluations at each tolerance, with its place."""
    tasks: list[Task] = [
        ("off", {"source": source, "runs": [[*ROWS, *one] for one in of_tolerance],
                 "channel": CHANNEL, "known": [list(known["t"]), list(known["slider_v"])]})
        for of_tolerance in runs
    ]  # fmt: skip
    with worker(tree, tasks) as ask:
        answers = [list(zip(*ask(k, 1), strict=True)) for k in range(len(tasks))]
    return [(median(off) / SPEED, median(n), k) for k, (off, n) in enumerate(answers)]


def by_hand_took(tolerance: float, mu: float, times: int) -> float:
    """CPU s of the program by hand, five runs together."""
    import numpy as np

    from benchmarks.minimal import run

    none = np.zeros(0)
    return sum(run(tolerance, mu, none, h).cpu for _ in range(times) for h in FIRST_STEPS) / times


def spatial(trees: Trees, rounds: int) -> Iterator[Line]:
    """The reverser in space as a whole command."""
    with TemporaryDirectory() as folder:
        source, out = str(REVERSER / "spatial_synchronous.yaml"), str(Path(folder) / "run.h5")

        def once(tree: Tree) -> float:
            try:
                return took(tree.trsim("run", source, "-q", "-o", out), **tree.variables).cpu
            except AssertionError as error:
                raise Refused(tree, str(error)) from error

        calls = [partial(once, tree) for tree in trees]
        turns(calls, 1)
        found = turns(calls, rounds)
    cells = [f"{median(one):.2f} s" for one in found]
    yield Line("the reverser in space, whole command", "1 s", cells, found)


def integrated(source: str, runs: list[list[str]]) -> Task:
    return "integrated", {"source": source, "runs": runs}


def seconds(found: list[list[list[Any]]]) -> list[list[list[float]]]:
    """Without what tasks tell besides."""
    return [[[cpu for cpu, _ in of_task] for of_task in of_tree] for of_tree in found]


def measurements(rounds: int, part: int) -> dict[str, Callable[[Trees], Iterator[Line]]]:
    """What is measured, by its name."""
    spin_up = str(VALIDATION / "beam_spin_up.yaml")
    return {
        "reverser": lambda trees: swept(thousands.REVERSER, "100 s", trees, part),
        "crank": lambda trees: swept(thousands.CRANK, "60 s", trees, part),
        "four pins": lambda trees: four_pins(trees, rounds),
        "governor": lambda trees: over_radau(
            ("governor on dampers", "1.5"), GOVERNOR, DECAYS, trees, rounds
        ),
        "spin-up": lambda trees: over_radau(
            ("spin-up of a bar", "2"), spin_up, ["1e-4"], trees, rounds
        ),
        "P1": lambda trees: slider_cranks(trees, rounds),
        "spatial": lambda trees: spatial(trees, rounds),
    }


def trees_of(asked: str) -> list[Tree]:
    """The one before, if it is to be had, and this one."""
    try:
        before = there(asked)
    except LookupError as error:
        print(f"{error.args[0]}: only this tree is measured.\n")
        return [HERE]
    print(f"The state before is {before.name}.  Processors: {processors()}.\n")
    return [before, HERE]


def main(words: Sequence[str] = ()) -> None:
    """Print the table."""
    read = argparse.ArgumentParser(prog="python -m benchmarks beside")
    read.add_argument(
        "what", nargs="*", help=f"of {', '.join(measurements(1, 1))}; all unless given"
    )
    read.add_argument("--before", default=BEFORE, help="a revision, or the folder of a tree")
    read.add_argument("--rounds", type=int, default=ROUNDS, help="of short runs")
    read.add_argument("--part", type=int, default=1, help="sweeps of so many times fewer cases")
    asked = read.parse_intermixed_args(list(words))
    known = measurements(asked.rounds, asked.part)
    if wrong := [one for one in asked.what if one not in known]:
        read.error(f"no measurement {wrong[0]}; known: {', '.join(known)}")
    trees = trees_of(asked.before)
    head("what", "asked", "before", "now", "ratio")
    for name in asked.what or known:
        try:
            lines = list(known[name](trees))
        except Refused as error:
            if error.tree is HERE:
                raise
            print(f"{name} is measured here only: {error}", file=sys.stderr)
            lines = list(known[name]([HERE]))
        for line in lines:
            line.told()


if __name__ == "__main__":
    main(sys.argv[1:])
