"""Work against precision: what each method costs, and how wrong it is, on one scenario.

    error = max |x - x_ref| / (max x_ref - min x_ref)     over the rows, largest of the quantities
    peak error = |P - P_ref| / P_ref                      largest of the contacts

The reference is a run at a much tighter tolerance; a second one, by another method, says how far
it can be trusted: an error smaller than their difference is marked.  From where the two are apart
(apart.py) on, pointwise errors mean nothing (impacts multiply any difference); they are then taken
over the rows before, and peaks are what remains to be compared.

One run's error is ragged by factors of several, so each is the median over slightly different
first steps; so is the CPU time, that of the integration alone, without rows.
"""

from collections.abc import Sequence
from dataclasses import dataclass, field
from statistics import median

import numpy as np

from trsim.analyse.apart import APART, resting, windows
from trsim.analyse.trajectory import (
    Look,
    Problem,
    Setting,
    Trajectory,
    own_first_step,
    trajectory,
    unwatched,
    work,
)
from trsim.errors import SolverError, UsageError
from trsim.scenario.methods import METHODS, REFERENCES

TOLERANCES = tuple(10.0**-k for k in range(3, 9))
FIRST_STEPS = (1.0, 0.8, 1.25)  # times about the solver's own
FIXED = (1000, 3000, 10_000, 30_000)  # fixed steps in a run
TIGHTER, TIGHTEST, LOOSEST = 100.0, 1e-14, 1e-1  # tolerances: of a reference; that there are


@dataclass(frozen=True)
class Reference:
    """What errors are taken against.

    second_method     of another run, at the same tolerance
    second_failed     why that one did not reach its end, or ""
    uncertainty       error of the second run
    peak_uncertainty  peak error of the second run; null without contacts
    apart             s; from here on the two differ by more than 1 % of a range, and errors are
                      taken over the rows before; null where they never do
    ranges            quantity -> its largest less its smallest value, SI
    still             quantities that do not move, and are left out
    """

    setting: Setting
    run: Trajectory
    rows: int  # compared: those before `apart`
    second_method: str
    second_failed: str
    uncertainty: float  # nan where the second one failed
    peak_uncertainty: float
    apart: float | None
    ranges: dict[str, float]
    still: tuple[str, ...]


@dataclass(frozen=True)
class Point:
    """One method at one setting.

    reason           why it failed, or ""
    error            largest difference to the reference over the range, of all quantities; median
                     over first steps
    worst            of the first steps
    peak_error       largest relative difference of a contact's largest force; none without any
    unresolved       whether the error is not above the uncertainty of the reference
    peak_unresolved  the same of the peak error
    cpu              s, of the integration without output rows; median
    steps            accepted, median
    evaluations      right-hand sides, median
    errors           quantity -> error
    """

    setting: Setting
    error: float = np.nan
    worst: float = np.nan
    peak_error: float = np.nan
    errors: dict[str, float] = field(default_factory=dict)
    cpu: float = np.nan
    steps: int = 0
    evaluations: int = 0
    unresolved: bool = False
    peak_unresolved: bool = False
    reason: str = ""


@dataclass(frozen=True)
class Study:
    """All that was measured."""

    title: str
    reference: Reference
    points: tuple[Point, ...]
    slopes: dict[str, float]  # method -> of log error over log tolerance, or step; see `slopes`


def plan(
    methods: Sequence[str], tolerances: Sequence[float], steps: Sequence[float]
) -> list[Setting]:
    """What is to be measured: methods of fixed steps with steps, all others with tolerances."""
    found = []
    for method in methods:
        if METHODS[method].adaptive:
            found += [Setting(method, value) for value in tolerances]
        else:
            found += [Setting(method, None, value) for value in steps]
    return found


def reference_setting(methods: Sequence[str], tolerances: Sequence[float]) -> Setting:
    """The first of REFERENCES, or the second where that alone is measured, 100 times tighter than
    the tightest."""
    method = REFERENCES[set(methods) == {REFERENCES[0]}]
    return Setting(method, max(min(tolerances, default=1e-8) / TIGHTER, TIGHTEST))


def reference(of: Problem, setting: Setting, look: Look = unwatched) -> Reference:
    """The reference and how far it can be trusted.

    Raises SolverError where it does not reach its end, UsageError where nothing moves.
    """
    try:
        run = trajectory(of, setting, look=look)
    except SolverError as error:
        what = f"the reference, {setting.method} at {setting.tolerance:g}, failed: {error.what}"
        raise SolverError(what, "Choose another one: --reference METHOD:TOLERANCE.") from None
    ranges, rests = resting(run.values, {q.name: q.unit for q in of.quantities})
    ranges = {name: value for name, value in ranges.items() if name not in rests}
    if not ranges:
        raise UsageError("none of the quantities moves", "Name others with --quantity CHANNEL.")
    other = REFERENCES[setting.method != REFERENCES[1]]
    rows, apart, reason = len(run.time), None, ""
    uncertainty = peak_uncertainty = np.nan
    try:
        second = trajectory(of, setting._replace(method=other), look=look)
        difference = np.max([np.max(np.abs(second.values[n] - run.values[n]), axis=1) / ranges[n]
                             for n in ranges], axis=0)  # fmt: skip
        if parted := windows(difference > APART):
            rows = parted[0].begin
            apart = float(run.time[rows])
        uncertainty = float(np.max(difference[:rows], initial=0.0))
        peak_uncertainty = peak_error(second, run)
    except SolverError as error:
        reason = error.what
    unmoved = tuple(q.name for q in of.quantities if q.name in rests)
    return Reference(setting, run, rows, other, reason, uncertainty, peak_uncertainty, apart,
                     ranges, unmoved)  # fmt: skip


def errors(run: Trajectory, to: Reference) -> dict[str, float]:
    """The error of every quantity that moves, over the rows that mean something."""
    n = to.rows
    return {
        name: float(np.max(np.abs(run.values[name][:n] - to.run.values[name][:n]), initial=0.0))
        / size
        for name, size in to.ranges.items()
    }


def peak_error(run: Trajectory, to: Trajectory) -> float:
    """Largest relative difference of the contacts' largest forces; nan without contacts.

    Of a contact that the reference never closes it is 1 if the run does.
    """
    found = [abs(run.peaks[name] - peak) / (abs(peak) or abs(run.peaks[name]) or 1.0)
             for name, peak in to.peaks.items()]  # fmt: skip
    return max(found, default=np.nan)


def first_steps(of: Problem, to: Reference, setting: Setting) -> list[float | None]:
    """The first steps (s) with which a setting is tried; fixed steps have none."""
    if setting.tolerance is None:
        return [None]
    solver = of.full[0].solver
    own = solver.first_step or own_first_step(to.run.outcome, setting.tolerance, solver.end)
    return [min(factor * own, solver.end) for factor in FIRST_STEPS]


def point(
    of: Problem, to: Reference, setting: Setting, repeats: int = 3, look: Look = unwatched
) -> Point:
    """Error and CPU time of one setting; one that fails says why."""
    starts = first_steps(of, to, setting)
    try:
        runs = [trajectory(of, setting, first, look) for first in starts]
        lean = [work(of, setting, first, look) for _ in range(repeats) for first in starts]
    except SolverError as error:
        return Point(setting, reason=error.what)
    found = [errors(run, to) for run in runs]
    error = median(max(each.values()) for each in found)
    peak = median(peak_error(run, to.run) for run in runs)
    return Point(
        setting,
        error,
        max(max(each.values()) for each in found),
        peak,
        {name: median(each[name] for each in found) for name in to.ranges},
        median(numbers["integration_cpu"] for numbers in lean),
        int(median(numbers["steps"] for numbers in lean)),
        int(median(numbers["evaluations"] for numbers in lean)),
        error <= to.uncertainty,
        peak <= to.peak_uncertainty,
    )


def slope(x: Sequence[float], error: Sequence[float]) -> float:
    """The slope of log error over log x, 1 where ten times x makes ten times the error; nan of
    fewer than two points."""
    if len(set(x)) < 2:
        return np.nan
    return float(np.polyfit(np.log(x), np.log(np.maximum(error, 1e-300)), 1)[0])


def slopes(found: Sequence[Point], to: Reference) -> dict[str, float]:
    """The slope of every method, over its points whose error is resolved.

    Where the references part, of the peak error: pointwise errors before that are saturated.
    """
    peaks = to.apart is not None
    fitted = {}
    for method in dict.fromkeys(p.setting.method for p in found):
        mine = [p for p in found if p.setting.method == method and not p.reason]
        good = [p for p in mine if not (p.peak_unresolved if peaks else p.unresolved)]
        good = [p for p in good if not (peaks and np.isnan(p.peak_error))]
        x = [p.setting.tolerance or p.setting.step or np.nan for p in good]
        fitted[method] = slope(x, [p.peak_error if peaks else p.error for p in good])
    return fitted
