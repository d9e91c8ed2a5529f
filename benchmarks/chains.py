"""N chains of three bodies on one body, in space: cost per chain and evaluation, and per step."""

import time
from collections.abc import Callable
from itertools import pairwise
from statistics import median
from typing import Any, NamedTuple

import numpy as np

from benchmarks.measure import run
from benchmarks.problems import hung_chains
from benchmarks.tables import head, row
from trsim.assemble.equations import constraints, evaluate, forces, poses
from trsim.assemble.linear import factorise, solve
from trsim.assemble.schur import rows
from trsim.elements.contract import SCENE, compiled
from trsim.kernels.signatures import A1, i8, void

SIZES = (1, 5, 20, 40)
ROUNDS = 7
REPEATED = void(SCENE, A1, A1, i8)


@compiled(REPEATED)
def whole(s, y, yd, times):
    """The equations of motion, again and again."""
    for _ in range(times):
        evaluate(s, 0.0, y, yd)


@compiled(REPEATED)
def elements(s, y, yd, times):
    """Poses, loads and constraint rows of the elements."""
    for _ in range(times):
        poses(s, y)
        forces(s, 0.0)
        constraints(s, 0.0)


@compiled(REPEATED)
def filled(s, y, yd, times):
    """The matrix of the multipliers."""
    for _ in range(times):
        rows(s)


@compiled(REPEATED)
def factorised(s, y, yd, times):
    """The matrix and its factors."""
    for _ in range(times):
        rows(s)
        factorise(s)


@compiled(REPEATED)
def solved(s, y, yd, times):
    """Multipliers with the factors at hand."""
    for _ in range(times):
        solve(s, s.x)


class Costs(NamedTuple):
    """CPU times, us: of an evaluation in a run with all else a step does, of a step, and of the
    equations of motion by themselves, whole and in parts."""

    evaluation: float
    step: float
    equations: float
    elements: float
    matrix: float
    factors: float
    solution: float


def each(repeated: Any, work: Any, y: Any) -> float:
    """CPU time of one of the functions above, us a time."""
    yd, times = np.zeros_like(y), 20_000 // work.n
    start = time.process_time()
    repeated(work, y, yd, times)
    return 1e6 * (time.process_time() - start) / times


def costs(scenario: Any, mechanism: Any, method: str) -> Costs:
    """One round of measurements."""
    from trsim.analyse.trajectory import changed
    from trsim.elements.scene import scene

    numbers = run(changed(scenario, "solver", method=method), mechanism).outcome.statistics
    cpu = 1e6 * numbers["integration_cpu"]
    work, y = scene(mechanism.model), mechanism.y0.copy()
    equations, of_elements = each(whole, work, y), each(elements, work, y)
    matrix = each(filled, work, y)
    factors = each(factorised, work, y) - matrix
    return Costs(cpu / numbers["evaluations"], cpu / numbers["steps"],
                 equations, of_elements, matrix, factors, each(solved, work, y))  # fmt: skip


def compared(text: Callable[[int], str], sizes: tuple[int, ...], method: str) -> None:
    """Print the medians for each size, and how they grow.

    The sizes are run in turn, so that a busy minute of the machine meets all of them.
    """
    from trsim.assemble.assemble import assemble
    from trsim.scenario.load import loads

    read, models, built = {}, {}, {}
    found: dict[int, list[Costs]] = {n: [] for n in sizes}
    for n in sizes:
        read[n] = loads(text(n))
        start = time.process_time()
        models[n] = assemble(read[n])
        built[n] = time.process_time() - start
    for _ in range(1 + ROUNDS):
        for n in sizes:
            found[n].append(costs(read[n], models[n], method))
    head("chains, rows", "step", "per chain", "evaluation", "per chain", "equations alone",
         "elements", "matrix", "factors", "solution", "assembled s")  # fmt: skip
    middle = {n: Costs(*map(median, zip(*found[n][1:], strict=True))) for n in sizes}
    for n, c in middle.items():
        parts = (c.equations, c.elements, c.matrix, c.factors, c.solution)
        row(f"{n}, {models[n].model.m}", f"{c.step:.0f}", f"{c.step / n:.1f}",
            f"{c.evaluation:.2f}", f"{c.evaluation / n:.2f}", *(f"{x:.2f}" for x in parts),
            f"{built[n]:.2f}")  # fmt: skip
    for few, many in pairwise(sizes):
        growth = middle[many].step / middle[few].step
        print(f"  {many} chains over {few}: {growth:.2f} times the cost of a step")


def main() -> None:
    print("  dop853")
    compared(hung_chains, SIZES, "dop853")


if __name__ == "__main__":
    main()
