"""Functions that have no value, or grow without bound, in words: which, where, when."""

from typing import Any

import numpy as np

from trsim.assemble.mechanism import Mechanism
from trsim.assemble.poles import AT, DRIVE, KIND, OF, POLE
from trsim.elements.contract import compiled
from trsim.elements.prescribed import began
from trsim.kernels.signatures import A1, A2, f8, i8, void
from trsim.laws.functions import value_and_rate
from trsim.solve.march.record import Record
from trsim.solve.start.angles import posed

NEAR = (1e-6, 1e-3)  # of the run: how far ahead of a failure a pole, an end is looked for
BEFORE, GROWS = 0.9, 1.5  # of the way there: a function that is by so much larger has a pole
BEHIND, HALVINGS = 1.1, 50  # of the way there: one that ends there has no number
HINT = (
    "no motion goes on behind that: keep it away from there, as max(u, 0) and u/(u**2 + 1e-6) do, "
    "or end the run before"
)


@compiled(void(A1, i8, f8, A2, A1))
def write_value(tab, offset, t, sensors, out):
    """out = a function of tab and its rate."""
    out[0], out[1] = value_and_rate(tab, offset, t, sensors)


def at_pole(scenario: Any, mechanism: Mechanism, k: int, t: float) -> str:
    """What happens to which function at t, row k of `pole`."""
    guard = mechanism.guards[k]
    name = next(f.name for f in mechanism.functions if f.offset == guard.of)
    place = scenario.place(tuple(name.split(".")))
    there = f" ({place.show()})" if place else ""
    return f"{name}{there}: at t = {t:.9g} s {guard.text}: {HINT}"


def pole_near(scenario: Any, mechanism: Mechanism, r: Record) -> str:
    """The same where a run could not go on, if its record is just beside such a place."""
    model, solver, t = mechanism.model, scenario.solver, float(r.t)
    if not len(model.pole) or not np.all(np.isfinite(r.y)):
        return ""
    w = posed(model, r.y)
    for k, row in enumerate(model.pole):
        since = began.python(w, int(row[DRIVE]), row[OF])
        own_t = t - since if since >= 0.0 else np.nan
        u, rate = value_at(w, row[AT], own_t, 0.0)
        reach = max(NEAR[row[KIND]] * solver.end, solver.step or 0.0)
        if rate * u >= 0.0 > u or not abs(u) <= abs(rate) * reach:
            continue
        ahead = -u / rate if rate else 0.0
        if row[KIND] == POLE:
            f, nearer = (value_at(w, row[OF], own_t, on)[0] for on in (0.0, BEFORE * ahead))
            found = ahead if not abs(nearer) <= GROWS * abs(f) else -1.0
        else:
            found = ends(w, row[OF], own_t, BEHIND * ahead + 1e-3 * NEAR[POLE] * solver.end)
        if found >= 0.0:
            return at_pole(scenario, mechanism, k, t + found)
    return ""


def ends(w: Any, offset: int, t: float, on: float) -> float:
    """How long from t on a function has a number, where it has none `on` later; else -1."""
    low, high = 0.0, on
    if np.isfinite(value_at(w, offset, t, on)[0]):
        return -1.0
    for _ in range(HALVINGS):
        middle = 0.5 * (low + high)
        if np.isfinite(value_at(w, offset, t, middle)[0]):
            low = middle
        else:
            high = middle
    return high


def value_at(w: Any, offset: int, t: float, on: float) -> tuple[float, float]:
    """A function of tab and its rate `on` after t, when the scene shows its sensors."""
    out, there = np.zeros(2), w.S.copy()
    there[:, 0] += on * there[:, 1]
    write_value(w.tab, int(offset), t + on, there, out)
    return float(out[0]), float(out[1])
