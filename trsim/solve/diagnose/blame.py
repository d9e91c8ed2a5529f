"""Which element gives a value that is no number: each is evaluated alone, at one state."""

from typing import Any

import numpy as np
from numpy.typing import NDArray

from trsim.assemble.equations import constraints, forces, poses
from trsim.assemble.features import HELD_FROM, HELD_TO, OFFSET, SENSED
from trsim.assemble.instances import Instance
from trsim.assemble.mechanism import Mechanism
from trsim.elements.contract import Pair
from trsim.elements.prescribed import AnyDrive
from trsim.elements.scene import workspace
from trsim.errors import ModelError
from trsim.laws.functions import FREE
from trsim.solve.diagnose.locked import locked
from trsim.solve.diagnose.poles import pole_near
from trsim.solve.diagnose.singular import singular
from trsim.solve.diagnose.strained import ALMOST, NEARLY, collapsed
from trsim.solve.march.record import Record
from trsim.solve.start.angles import posed

Array = NDArray[np.float64]

ON = 1e-6  # of the mechanism's size: so near to a jump a spring swings about it
SHORT = 0.01  # of its length as drawn: an actuator that ends at nothing
AHEAD = (1e-12, 1e-9, 1e-6, 1e-3)  # of the run: how far beyond a failure to look
PLACES = ("F", "zd", "phi", "phi_t", "gamma")
RANGE = "log or sqrt of something negative, asin or acos beyond 1, 1/0, a table that ends"
RESTS = (
    "what it depends on rests at a corner; where it jumps there, as sign, floor and comparisons "
    "do, what is held by less than the jump is driven back from both sides, in ever shorter steps: "
    "let it rise in a short way, as step(x, x0, f0, x1, f1) does"
)


def blamed(mechanism: Mechanism, t: float, y: Array, mem: Array) -> Instance | None:
    """The first element whose force or prescribed motion is not finite at (t, y)."""
    w = workspace(mechanism.model)
    w.mem[:] = mem
    poses(w, y)
    for place in PLACES:
        getattr(w, place)[:] = 0.0
    forces(w, t)
    constraints(w, t)
    if all_finite(w):  # together, as nearly always: then each of them is
        return None
    for e, instance in enumerate(mechanism.instances):
        for place in PLACES:
            getattr(w, place)[:] = 0.0
        for word in ("force", "constraint"):
            kernel, table = instance.element.kernels.get(word), getattr(w, word)
            if kernel and np.any((table[:, 1] <= e) & (e < table[:, 2])):  # not of what rests
                kernel(t, w, e, e + 1)
        if not all_finite(w):
            return instance
    return None


def all_finite(w: Any) -> bool:
    """Whether all that kernels of forces and of constraints have written are numbers."""
    return all(np.isfinite(getattr(w, place)).all() for place in PLACES)


def refuse_no_number(mechanism: Mechanism, y: Array, mem: Array) -> None:
    """Raises ModelError for an element whose force or motion is not finite at t = 0."""
    found = blamed(mechanism, 0.0, y, mem)
    if found is None:
        return
    what = "its force is" if found.section == "forces" else "its motion or acceleration is"
    raise ModelError(
        f"{what} not a finite number at t = 0",
        f"is an expression outside its range: {RANGE}?",
        (found.section, found.name),
    )


def undecided(mechanism: Mechanism, w: Any) -> tuple[Instance | None, str]:
    """Whose friction had no solution in the last evaluation, or several, and that in words."""
    if not w.status[7]:
        return None, ""
    instance = mechanism.instances[int(w.status[7]) - 1]
    return instance, (
        f"no friction, or more than one, goes with the reaction of '{instance.row.rubs}' that it "
        "makes (Painleve): the mechanism jams or leaps, and rigid bodies do not tell which"
    )


def end_of_law(scenario: Any, mechanism: Mechanism, r: Record) -> str:
    """Why a run cannot go on, where the law of an element ends just ahead; else empty."""
    if not np.all(np.isfinite(r.y)):
        return ""
    t, step = float(r.t), scenario.solver.step or 0.0
    rates = np.where(np.isfinite(r.yd), r.yd, 0.0)  # accelerations may be no numbers already
    for ahead in (0.0, *(share * scenario.solver.end for share in AHEAD), step):
        found = blamed(mechanism, t + ahead, r.y + ahead * rates, r.mem)
        if found is not None and found.section:
            if found.row.length and (short := drawn_in(scenario, mechanism, r.y)):
                return short
            entry = scenario.entry(found.section, found.name)
            return f"{entry} is not a finite number beyond t = {t:.6g} s: {RANGE}?"
    return ""


def on_a_jump(scenario: Any, mechanism: Mechanism, y: Array) -> str:
    """Which spring is just where its force jumps, in words; empty where none is."""
    w = posed(mechanism.model, y)
    for instance in mechanism.instances:
        if not instance.row.leaps:
            continue
        stretch = float(w.S[Pair.of(instance.row).coordinate, 0])
        if abs(stretch) < ON * mechanism.model.size:
            return (
                f"{scenario.entry(instance.section, instance.name)}: where it becomes taut, at a "
                f"stretch of 0, its force jumps from 0 to {instance.row.leaps:.4g} N; what is held "
                "there by less is driven back to the jump from both sides, in ever shorter steps: "
                "let `elastic` be 0 at a stretch of 0 and rise in a short way, as "
                f"{instance.row.leaps:.4g}*step(stretch, 0, 0, 0.001, 1) does"
            )
    return ""


def on_a_corner(mechanism: Mechanism, w: Any) -> str:
    """Which function is left free on a corner, in words; empty where none is."""
    for row in w.feature:  # of those that have corners
        places = w.held[row[HELD_FROM] : row[HELD_TO]]
        if row[SENSED] and np.any(w.tab[places] == FREE):
            name = next((f.name for f in mechanism.functions if f.offset == row[OFFSET]), "a load")
            return f"{name}: {RESTS}"
    return ""


def drawn_in(scenario: Any, mechanism: Mechanism, y: Array) -> str:
    """Which actuator has next to no length left, in words; empty where none is so short."""
    w = posed(mechanism.model, y)
    for instance in mechanism.instances:
        length = instance.row.length
        if length == 0.0:
            continue
        stroke = float(w.S[AnyDrive.of(instance.row).coordinate, 0])
        if length + stroke < SHORT * length:
            return (
                f"{scenario.entry(instance.section, instance.name)}: a stroke of {stroke:.4g} m "
                f"leaves a line of {length:.4g} m no length; limit its motion"
            )
    return ""


def why(scenario: Any, mechanism: Mechanism, r: Record) -> str:
    """Why a run cannot go on from its record, in words; empty where nothing is found."""
    t = float(r.t)
    return (
        collapsed(scenario, mechanism, t, r.y, NEARLY, ALMOST)
        or pole_near(scenario, mechanism, r)
        or on_a_jump(scenario, mechanism, r.y)
        or end_of_law(scenario, mechanism, r)
        or drawn_in(scenario, mechanism, r.y)
        or (singular(mechanism, r) if r.driven else locked(mechanism, t, r.y))
    )
