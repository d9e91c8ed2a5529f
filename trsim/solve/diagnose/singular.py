"""Singular positions of mechanisms that are driven in all their freedoms, in words."""

from trsim.assemble.mechanism import Mechanism
from trsim.elements.prescribed import AnyDrive
from trsim.errors import ModelError, some
from trsim.solve.diagnose.locked import NEARLY, dependent
from trsim.solve.march.record import Record
from trsim.solve.start.angles import posed

SHOWN = 6  # names of a list
DYNAMIC = "or leave out `method: kinematic`: others integrate the motion"


def singular_start(mechanism: Mechanism, r: Record) -> ModelError:
    """The refusal of a start in a singular position."""
    names, _ = dependent(mechanism, 0.0, r.y)
    return ModelError(
        f"the rows of {', '.join(names)} depend on each other where the run begins, "
        f"{driven_to(mechanism, r)}: a singular position, in which the drives do not decide how "
        "the mechanism moves",
        f"start beside it, {DYNAMIC}",
        ("solver", "method"),
    )


def singular(mechanism: Mechanism, r: Record) -> str:
    """Why a kinematic run could not go on, in words: the singular position it came to; empty where
    it is at none."""
    names, smallest = dependent(mechanism, float(r.t), r.y)
    if smallest > NEARLY:
        return ""
    return (
        f"a singular position, {driven_to(mechanism, r)}: the rows of {', '.join(names)} depend on "
        "each other there.  Behind it there is no position (a turning point), or branches of the "
        "motion meet and the drives do not say which one goes on; drive another joint, end "
        f"before, {DYNAMIC}"
    )


def crossed(mechanism: Mechanism, r: Record) -> str:
    """Why a kinematic run ends that went on along another branch, in words."""
    return (
        f"at t = {r.crossed_t:.6g} s it went on along another branch of the motion, past a place "
        f"where branches come close, {driven_to(mechanism, r)} by now: the drives do not say which "
        f"one it is on; drive another joint, draw lengths to more digits, {DYNAMIC}"
    )


def driven_to(mechanism: Mechanism, r: Record) -> str:
    """Where the drives are, in words."""
    w = posed(mechanism.model, r.y)
    told = []
    for instance in mechanism.instances:
        if instance.section == "drives":
            unit = "rad" if instance.row.turns else "m"
            place = float(w.S[AnyDrive.of(instance.row).coordinate, 0])
            told.append(f"'{instance.name}' at {place:.9g} {unit}")
    return some(tuple(told), SHOWN) if told else "without a drive"
