"""What kind of quantity each gap and each watched value is, so that its way in a step is bounded.

Rows follow those of the tables of gaps: contacts, then user events.
"""

from math import inf
from typing import Any

import numpy as np

from trsim.assemble.instances import Instance
from trsim.assemble.switches import CHANNEL, LIMITS, TIME, Switches

# UNKNOWN: what depends on more than places has no bound; CLOCK: the time
# TWIST: an angle about axes that may lean apart; TRAIN: two angles, each times a radius; SURFACE:
# the distance from a surface; EDGE: the larger of the strokes of both ends of a line; OUTLINE: that
# of an outline from a surface; BEND: the angle between an axis of either frame; SWING: that of the
# whole turn of one against the other, whose rate is the size of the angular velocity
UNKNOWN, CLOCK, ANGLE, STROKE, DISTANCE, TWIST, TRAIN, SURFACE, EDGE, OUTLINE, BEND, SWING = range(
    12
)
RATE_OF = 12  # added to a kind: the rate of such a quantity
KINDS = {
    "": UNKNOWN,
    "arc": UNKNOWN,
    "angle": ANGLE,
    "stroke": STROKE,
    "distance": DISTANCE,
    "twist": TWIST,
    "train": TRAIN,
    "surface": SURFACE,
    "edge": EDGE,
    "outline": OUTLINE,
    "bend": BEND,
    "swing": SWING,
}
ANGLES = (ANGLE, TWIST, BEND, SWING)  # in rad
UNBOUNDED = (UNKNOWN, TWIST, TRAIN, SURFACE, EDGE, OUTLINE, BEND)  # kinds whose rates have no bound


def travels(instances: list[Instance], contacts: list[int], switches: Switches) -> dict[str, Any]:
    """travel and kink of the model.

    travel  (n_contacts + n_w, 2) the kind, and the instance whose frames and points it lies between
    kink    (n_contacts + n_w) |gap| from which on it may be on another branch
    """
    owner = {i.name: e for e, i in enumerate(instances) if i.section == "sensors"}
    found = [of_instance(instances, e) for e in contacts]
    for event in switches.events:
        if event.kind == CHANNEL:
            found.append((UNKNOWN, -1, inf))
        elif event.entry == TIME:
            found.append((CLOCK, -1, inf))
        elif event.entry <= LIMITS:
            found.append((UNKNOWN, LIMITS - event.entry, inf))
        else:
            found.append(of_instance(instances, owner[event.when]))
    return {
        "travel": np.array([row[:2] for row in found], np.int64).reshape(-1, 2),
        "kink": np.array([row[2] for row in found], float),
    }


def of_instance(instances: list[Instance], e: int) -> tuple[int, int, float]:
    """Kind, instance and kink of the gap or coordinate of an instance."""
    row = instances[e].row
    return KINDS[row.travel], e, row.kink


def of_rate(instances: list[Instance], e: int) -> tuple[int, int]:
    """Kind and instance of the rate of the coordinate of an instance."""
    kind, _, _ = of_instance(instances, e)
    return (UNKNOWN if kind in UNBOUNDED else RATE_OF + kind), e
