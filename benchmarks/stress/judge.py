"""One case by all methods: run, compare with the truth, and say what became of each.

The truth of a cell is another method at a tolerance 100 times tighter.  A run and a twin of it, at
a fifth of its tolerance and with another first step (0.93 of the step, for rk4), part where they
are no longer predictable, in the path of a journal or in the largest forces; before that *horizon*
the largest force of every contact is compared.  Where impacts have made the first difference large
two runs may agree by chance: before a cell is called wrong the twin's own twin must agree too.
"""

from dataclasses import asdict, dataclass, replace
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from benchmarks.stress.cells import SYSTEMS, Case
from trsim.analyse.trajectory import Setting, changed, marched, own_first_step, varied
from trsim.assemble.assemble import assemble
from trsim.errors import TrsimError
from trsim.solve.diagnose.doubts import of_books

Array = NDArray[np.float64]

TIGHTER = 100.0
PART = 5e-3  # of a journal's path: two runs that differ by more have parted
TWIN = 0.2  # tolerance of a twin over that of the run
SOONER = 0.7  # how much sooner the next horizon tried is
PEAKS, ENERGY = 0.02, 1e-3  # what a run that says nothing must keep to
MOST, MOST_OF_TRUTH = 150_000, 1_500_000  # steps
MOST_OF = {"generalized_alpha": 600_000}  # of second order, and its steps are cheap
CONVERGED, REFUSED, SAID_SO, WRONG, UNJUDGED = (
    "converged", "refused", "said so", "WRONG", "unjudged",
)  # fmt: skip


class Ran(NamedTuple):
    """A run, or why there is none."""

    rows: Array | None
    peaks: dict[str, float]
    outcome: Any
    refused: str = ""


@dataclass(frozen=True)
class Verdict:
    """What became of a cell."""

    case: str
    system: str
    clearance: float
    restitution: float
    friction: float
    speed: float
    stiffness: float
    method: str
    setting: float  # tolerance, or step in s
    verdict: str
    reason: str
    peak_error: float = float("nan")
    path_error: float = float("nan")  # of a journal's path, before the horizon
    energy: float = float("nan")
    horizon: float = float("nan")  # of the run, 1 for beyond its end
    truth: str = ""
    cpu: float = float("nan")


class Bench:
    """The runs of one case."""

    def __init__(self, case: Case) -> None:
        self.case, self.refused = case, ""
        try:
            self.scenario = changed(case.scenario(), "solver", force=False)
            self.mechanism = assemble(self.scenario)
        except TrsimError as error:
            self.refused = error.show()
            return
        columns = {c.name: c.start for c in self.mechanism.columns}
        pins = SYSTEMS[case.system]
        self.path = [columns[f"{p}.eccentricity_{a}"] for p in pins for a in "xy"]
        names = [self.mechanism.instances[e].name for e in self.mechanism.model.contact]
        forces = ("normal_force", "contact_force", "force")
        self.force = {
            n: columns[next(f"{n}.{k}" for k in forces if f"{n}.{k}" in columns)] for n in names
        }
        self.truths: dict[str, Ran] = {}
        self.end = self.scenario.solver.end

    def run(self, setting: Setting, end: float, first: float | None, most: int) -> Ran:
        """A run to `end`."""
        scenario = varied(self.scenario, setting, first)
        scenario = changed(scenario, "solver", end=end, max_steps=most, force=False)
        try:
            rows, outcome = marched(scenario, self.mechanism)
        except TrsimError as error:
            return Ran(None, {}, None, error.show())
        peaks = {name: float(outcome.peaks[column, 0]) for name, column in self.force.items()}
        return Ran(rows, peaks, outcome)

    def truth(self, setting: Setting) -> tuple[str, Setting, Ran]:
        """Another method, 100 times tighter; `auto` where that one does not get through."""
        tolerance = (setting.tolerance or 1e-6) / TIGHTER
        others = (
            ("dop853", "auto")
            if setting.method in ("radau", "generalized_alpha")
            else ("radau", "dop853")
        )
        for method in others:
            tight = Setting(method, tolerance)
            key = f"{method} {tolerance:.0e}"
            if key not in self.truths:
                self.truths[key] = self.run(tight, self.end, None, MOST_OF_TRUTH)
            if done(self.truths[key]):
                break
        return key, tight, self.truths[key]

    def parted(self, a: Ran, b: Ran) -> int:
        """Row at which two runs part, or the number of rows."""
        assert a.rows is not None and b.rows is not None
        n = min(len(a.rows), len(b.rows))
        columns = [1 + c for c in self.path]
        scale = np.max(np.abs(b.rows[:n, columns]))
        apart = np.abs(a.rows[:n, columns] - b.rows[:n, columns]).max(axis=1) > PART * scale
        return int(np.argmax(apart)) if apart.any() else n


def done(ran: Ran) -> bool:
    return ran.outcome is not None and ran.outcome.status == "done"


def verdicts(case: Case) -> list[dict[str, Any]]:
    """What became of every cell of a case."""
    bench = Bench(case)
    return [asdict(verdict(bench, case, method, value)) for method, value in case.settings]


def verdict(bench: Bench, case: Case, method: str, value: float) -> Verdict:
    """What became of one cell."""
    about = Verdict(
        case.name, case.system, case.clearance, case.restitution, case.friction, case.speed,
        case.stiffness, method, value, REFUSED, bench.refused,
    )  # fmt: skip
    if bench.refused:
        return about
    setting = Setting(method, None, value) if method == "rk4" else Setting(method, value)
    ran = bench.run(setting, bench.end, None, most_of(method))
    if ran.refused:
        return replace(about, reason=ran.refused)
    numbers = ran.outcome.statistics
    energy = numbers["energy_residual_relative"]
    about = replace(about, energy=energy, cpu=numbers["integration_cpu"])
    if ran.outcome.status != "done":
        return replace(about, verdict=SAID_SO, reason=ran.outcome.reason)
    if not energy < ENERGY:
        return replace(about, verdict=SAID_SO, reason=f"energy book open by {energy:.1e}")
    return compared(bench, about, setting, ran)


def compared(bench: Bench, about: Verdict, setting: Setting, ran: Ran) -> Verdict:
    """A run that says it is done, against the truth before the horizon."""
    whole = ran
    key, tight, truth = bench.truth(setting)
    if not done(truth):
        why = truth.refused or truth.outcome.reason
        return replace(about, verdict=UNJUDGED, reason=f"no truth: {why}")
    other = twin_of(setting)
    first = 0.6 * own_first_step(ran.outcome, setting.tolerance or 1e-6, bench.end)
    twin = bench.run(other, bench.end, first if setting.step is None else None, MOST_OF_TRUTH)
    rows, end = len(ran.rows), bench.end
    horizon = bench.parted(ran, twin) if done(twin) else rows
    if horizon < rows:
        end = max(0.98 * float(ran.rows[horizon, 0]), float(ran.rows[1, 0]))
    while True:
        if end < bench.end:  # once more up to there, for the peaks
            most = most_of(setting.method)
            runs = (bench.run(setting, end, None, most), bench.run(other, end, None, MOST_OF_TRUTH))
            ran, twin, truth = *runs, bench.run(tight, end, None, MOST_OF_TRUTH)
            if not (done(ran) and done(twin) and done(truth)):
                return replace(about, verdict=UNJUDGED, reason="a run to the horizon did not end")
        error = peak_error(ran, truth)
        # forces part before paths do: what the twin does not repeat cannot be predicted either
        if error <= PEAKS or not done(twin):
            break
        if peak_error(ran, twin) < 0.5 * PEAKS:
            third = bench.run(twin_of(other), end, None, MOST_OF_TRUTH)
            if not done(third) or peak_error(ran, third) < 0.5 * PEAKS:
                break
        end *= SOONER
    columns = [1 + c for c in bench.path]
    n = min(len(ran.rows), len(truth.rows))
    scale = float(np.max(np.abs(truth.rows[:n, columns])))
    path = float(np.max(np.abs(ran.rows[:n, columns] - truth.rows[:n, columns]))) / scale
    told = [*of_books(bench.scenario, bench.mechanism, whole.outcome)]
    if error > PEAKS and told:
        return replace(about, verdict=SAID_SO, reason=told[0])
    return replace(
        about, verdict=CONVERGED if error <= PEAKS else WRONG, peak_error=error, path_error=path,
        horizon=end / bench.end, truth=key,
    )  # fmt: skip


def most_of(method: str) -> int:
    """Steps that a run may take."""
    return MOST_OF.get(method, MOST)


def twin_of(setting: Setting) -> Setting:
    """Nearly the same setting: its errors are about as large, and others."""
    if setting.step:
        return setting._replace(step=0.93 * setting.step)
    return setting._replace(tolerance=TWIN * (setting.tolerance or 1e-6))


def peak_error(a: Ran, b: Ran) -> float:
    """Largest relative difference of a contact's largest force; those without any left out."""
    largest = max(b.peaks.values(), default=0.0)
    return max(
        (abs(a.peaks[n] - b.peaks[n]) / max(b.peaks[n], 1e-3 * largest, 1e-300) for n in b.peaks),
        default=0.0,
    )
