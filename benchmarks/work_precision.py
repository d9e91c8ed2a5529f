"""Work against precision: error and CPU time over tolerances, as medians over perturbed starts.

A single run's error is ragged by factors of several, so every point is the median over first steps
that differ by a factor of three, and says its worst.  CPU time is that of the integration alone, of
runs that write no rows and no channels; evaluations and steps are of those runs too.
"""

from collections.abc import Callable, Iterator, Sequence
from functools import partial
from pathlib import Path
from statistics import median
from typing import Any, NamedTuple

from benchmarks.measure import Run, run
from trsim.analyse.precision import slope as of_errors
from trsim.analyse.trajectory import changed, own_first_step

TOLERANCES = tuple(10.0**-k for k in range(2, 11))
FIRST_STEPS = (None, 0.6, 0.8, 1.25, 1.7)  # times the solver's own


class Problem(NamedTuple):
    """A scenario and how wrong a run of it is."""

    source: Callable[[Sequence[str]], Any]  # --set words -> scenario
    error: Callable[[Run], float]
    rows: tuple[str, ...] = ()  # --set words of the runs whose error is taken
    other: Callable[[Run], float] | None = None  # a second error


class Point(NamedTuple):
    """Medians at one tolerance."""

    tolerance: float
    error: float
    worst: float
    cpu: float  # s
    steps: int
    evaluations: int
    other: float  # median of the second error

    @property
    def each(self) -> float:
        """CPU time per evaluation, s: everything a step does included."""
        return self.cpu / self.evaluations


def of_file(path: Path, *sets: str) -> Callable[[Sequence[str]], Any]:
    """The scenario of a file, as a source."""
    from trsim.scenario.load import load

    return lambda more: load(path, [*sets, *more])


def of_text(text: str) -> Callable[[Sequence[str]], Any]:
    """The scenario of a text, as a source."""
    from trsim.scenario.load import loads

    return partial(loads, text)


def points(
    problem: Problem,
    tolerances: Sequence[float] = TOLERANCES,
    repeats: int = 3,
    starts: Sequence[float | None] = FIRST_STEPS,
) -> Iterator[Point]:
    """A point for each tolerance."""
    from trsim.assemble.assemble import assemble

    full = problem.source(problem.rows)
    end = full.solver.end
    lean = problem.source([f"output.every={end!r}", "output.channels=[]"])
    of_full, of_lean = assemble(full), assemble(lean)
    run(lean, of_lean)  # what is compiled or loaded once
    for tolerance in tolerances:
        errors, others, cpu, counts = [], [], [], []
        for h in first_steps(full, of_full, tolerance, starts):
            r = run(varied(full, tolerance, h), of_full)
            errors.append(problem.error(r))
            others.append(problem.other(r) if problem.other else 0.0)
            for _ in range(repeats):
                numbers = run(varied(lean, tolerance, h), of_lean).outcome.statistics
                cpu.append(numbers["integration_cpu"])
            counts.append((numbers["steps"], numbers["evaluations"]))
        steps, evaluations = (int(median(column)) for column in zip(*counts, strict=True))
        yield Point(tolerance, median(errors), max(errors), median(cpu), steps, evaluations,
                    median(others))  # fmt: skip


def first_steps(
    scenario: Any, mechanism: Any, tolerance: float, factors: Sequence[float | None] = FIRST_STEPS
) -> list[float | None]:
    """Of runs that differ by nothing else, s; None is the solver's own."""
    begun, end = run(varied(scenario, tolerance), mechanism).outcome, scenario.solver.end
    own = own_first_step(begun, tolerance, end)
    return [None if factor is None else min(factor * own, end) for factor in factors]


def varied(scenario: Any, tolerance: float, first: float | None = None) -> Any:
    """The scenario at another tolerance and with another first step."""
    return changed(scenario, "solver", tolerance=tolerance, first_step=first)


def slope(found: Sequence[Point], low: float, high: float) -> float:
    """Of log error against log tolerance between two tolerances; 1 is error as asked for."""
    inside = [p for p in found if low <= p.tolerance * 1.0001 and p.tolerance <= high * 1.0001]
    return of_errors([p.tolerance for p in inside], [p.error for p in inside])


def cheapest(found: Sequence[Point], bound: float) -> Point | None:
    """The cheapest point whose median error is not above the bound."""
    good = [p for p in found if p.error <= bound]
    return min(good, key=lambda p: p.cpu, default=None)


def table(problem: Problem, unit: str, other: str = "", **options: Any) -> list[Point]:
    """Print the points as they are found, then the slopes.  other: heading of the second error."""
    print(
        f"  tolerance   error {unit:7s} worst     CPU ms   steps   evaluations   us each   {other}"
    )
    found = []
    for p in points(problem, **options):
        found.append(p)
        print(f"  {p.tolerance:9.0e}   {p.error:11.1e}   {p.worst:7.1e} {1e3 * p.cpu:8.3f} "
              f"{p.steps:7d} {p.evaluations:13d} {1e6 * p.each:9.2f}"
              + (f"   {p.other:.1e}" if other else ""), flush=True)  # fmt: skip
    low, high = found[-1].tolerance, found[0].tolerance
    least = max(low, 1e-9)
    most = 1e6 * least
    print(f"  slope of error: {slope(found, low, high):.2f} over all tolerances, "
          f"{slope(found, least, most):.2f} over {least:.0e}..{most:.0e}")  # fmt: skip
    return found


def at_bounds(found: Sequence[Point], bounds: Sequence[float], unit: str) -> None:
    """Print the CPU time at which trsim is at least so exact."""
    for bound in bounds:
        p = cheapest(found, bound)
        said = f"{1e3 * p.cpu:.3f} ms, tolerance {p.tolerance:.0e}" if p else "not reached"
        print(f"  error <= {bound:.1e} {unit}: {said}")
