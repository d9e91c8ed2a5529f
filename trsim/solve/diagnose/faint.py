"""Vibrations too small for the tolerance to be seen, with accelerations that are not small.

An amplitude A beside a motion of the size L at w times its rate has w^2 A/L of the accelerations.
With A below the tolerance and w in the thousands steps are not held to them (accelerations.py),
since rounding would make them; the largest estimate of such a step is told here instead, or the
sum over the run of what was more than its share, or of what rounding makes of places where
something is stiff (both of DOP853, which alone knows).
"""

from collections.abc import Iterator
from math import pi
from typing import Any

from trsim.assemble.mechanism import Mechanism
from trsim.solve.march.accelerations import ALLOWED, RUN, furthest, unknown
from trsim.solve.outcome import Outcome

TOLD = 1.1 * ALLOWED  # tolerances, of the largest acceleration
SUM = 5.0 * RUN  # tolerances, of all steps together: estimates are a few times too large
ADDS = 0.1  # of the tolerance that leaves ALLOWED in one step: errors add up
NOTHING = 1e-9  # of what the speed expected takes on the mechanism's size: at rest
ROUNDS = 3.0 * ALLOWED  # tolerances, of each evaluation by the rounding of places: it adds up
FINEST = 1e-11  # tolerance: less leaves what rounding makes of such accelerations


def of_vibrations(scenario: Any, mechanism: Mechanism, outcome: Outcome) -> Iterator[str]:
    """What a step leaves in accelerations, how fast that turns, and the tolerance it takes.

    Nothing where all of them are nothing; no more than their size where rounding is told of.
    """
    r = outcome.record
    off, total, w = float(r.blurred), float(r.blurred_sum), float(r.blurred_w)
    largest = float(r.top_acceleration)
    tolerance = scenario.solver.tolerance
    natural = outcome.start.speed**2 / mechanism.model.size
    far = furthest.python(mechanism.model, r.y, mechanism.model.size)
    rounding = float(unknown.python(r, far))
    one = tolerance * largest
    in_one, in_all = off > TOLD * one, total > SUM * one or rounding > ROUNDS * one
    if largest < NOTHING * natural or not (in_one or in_all):
        return
    if not in_one:
        total = max(total, rounding)
        yield (
            "solver.tolerance: accelerations, and with them forces, may be off by "
            f"{min(total / largest, 1.0):.1g} of the largest over the run: something vibrates "
            "with so small an amplitude that rounding shows in its accelerations, and adds up; "
            "soften or damp it (`stiffness`, `compliance`, `damping`), or run it by itself"
        )
        return
    known = (
        "solver.tolerance: accelerations, and with them forces, may be off by "
        f"{min(off / largest, 1.0):.1g} of the largest in a single step"
    )
    if outcome.statistics.get("rounding_of_tolerance", 0.0) > 1.0:
        yield f"{known}, and no tolerance changes that: the digits of a number end there"
        return
    finer = ADDS * tolerance * ALLOWED * tolerance * largest / off
    what = f"something vibrates{f' at about {w / (2.0 * pi):.2g} Hz' if w > 0.0 else ''}"
    cure = (
        "soften or damp what vibrates (`stiffness`, `compliance`, `damping`), or run it by itself"
    )
    if mechanism.mobility == 0:
        what = "what is driven changes its acceleration within steps"
        cure = "drives and curves of fewer or smoother pieces do"
    rubs = [i for i in mechanism.instances if i.row.rubs]
    if rubs:
        entry = f"{rubs[0].section}.{rubs[0].name}"
        what = f"the friction of {entry} turns round within steps, or {what}"
    remedy = (
        f"`tolerance: {finer:.0e}` holds them"
        if finer >= FINEST
        else f"no tolerance holds them, since rounding is next; {cure}"
    )
    yield (
        f"{known}, and by more over many: {what}, too little for a tolerance of "
        f"{tolerance:g} to follow, but its accelerations are not small; {remedy}"
    )
