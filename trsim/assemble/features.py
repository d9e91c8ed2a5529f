"""Functions with corners: where they are, when the time alone meets them, and what holds them.

    feature   0 offset in tab, 1 row of the drive whose time counts, or -1, 2 first of its instants,
              3 behind the last, 4 first of its entries of `held`, 5 whether sensors meet corners,
              6 state of z with the rate of a piston against the motion of its supply, or -1
    instant   0, then the instants of a function in rising order, then the end of the run
    jump      by how much the place and the rate of a motion jump there        jumps.py
    held      places in tab of what each corner is held on (laws/functions.py)

A function that is held on the pieces it is on is smooth: a step never sees a corner, and ends
where one is met (solve/features.py).  Unless a run holds them, functions are evaluated as written.
"""

from typing import Any, NamedTuple

import numpy as np

from trsim.assemble.jumps import NOBODY, driven
from trsim.elements.calls import caller
from trsim.elements.contract import SCENE, SINCE, compiled
from trsim.elements.prescribed import MOTION
from trsim.elements.signatures import f8, i8, void
from trsim.elements.vectors import internal
from trsim.instants import distinct, instants
from trsim.laws.functions import (
    BY_SENSORS,
    BY_TIME,
    HEAD,
    HELD,
    HELD_OF_TABLE,
    UNWATCHED,
    WATCHED,
    WIDTH,
    hold,
)

OFFSET, DRIVE, FIRST, BEHIND, HELD_FROM, SENSED, PISTON, N_FEATURE = range(8)
PLACE_JUMP, RATE_JUMP = range(2)  # columns of `jump`
SAME = 0.5e-12  # of the run: an instant so near has been reached


class Cornered(NamedTuple):
    """A function with corners."""

    offset: int
    instants: list[float]  # in rising order, inside the run
    held: list[int]  # places in tab
    sensed: bool  # whether sensors meet some of them
    end: float


def cornered(spec: Any, code: list[float], offset: int, end: float) -> list[Cornered]:
    """A function, if it has corners.  Raises ScenarioError where they cannot be told."""
    if spec.kind == "constant":
        return []
    if spec.kind == "table":
        of_t = spec.of == "t"
        times = distinct(list(spec.x), end) if of_t else []
        return [Cornered(offset, times, [offset + HELD_OF_TABLE], not of_t, end)]
    places = range(HEAD + int(code[1]), HEAD + int(code[1]) + WIDTH * int(code[2]), WIDTH)
    watched = [p for p in places if code[p + WATCHED] != UNWATCHED]
    sensed = any(code[p + WATCHED] == BY_SENSORS for p in watched)
    held = [offset + p + HELD for p in watched]
    return [Cornered(offset, instants(spec.node, end), held, sensed, end)] if held else []


def features(at: Any, instances: list[Any]) -> dict[str, Any]:
    """The tables of a model; empty where no function has corners."""
    own = driven(at, instances) if at.functions else {}
    rows: list[tuple[int, ...]] = []
    times: list[float] = []
    jumps: list[Any] = [np.zeros((0, 2))]
    held: list[int] = []
    for f in at.functions:
        first = len(times)
        times += [0.0, *f.instants, f.end]
        drive = own.get(f.offset, NOBODY)
        jumps.append(at.jumped.get(f.offset, np.zeros((len(times) - first, 2))))
        rows.append((f.offset, drive.e, first, len(times), len(held), int(f.sensed), drive.slip))
        held += f.held
    return {
        "feature": np.array(rows, np.int64).reshape(-1, N_FEATURE),
        "instant": np.array(times, float),
        "jump": np.vstack(jumps),
        "held": np.array(held, np.int64),
        "on_features": np.array([hold_all.address()] if rows else [0], np.int64),
    }


HOLD = void(SCENE, f8, i8)
call_hold = caller(HOLD)


@internal
def passed(s, n, t):
    """How many instants of feature n lie at or before t; 0 where it is not in force."""
    e, first = s.feature[n, DRIVE], s.feature[n, FIRST]
    low, high = first, s.feature[n, BEHIND]
    if e >= 0:
        if s.con[e, MOTION] != s.feature[n, OFFSET]:
            return 0
        t -= s.mem[e, SINCE]
    reached = t + SAME * s.instant[high - 1]
    while low < high:
        middle = (low + high) // 2
        if s.instant[middle] <= reached:
            low = middle + 1
        else:
            high = middle
    return low - first


@internal
def between(s, n, k):
    """A time of feature n between its k-th instant, counted from 1, and the next."""
    first = s.feature[n, FIRST]
    last = s.feature[n, BEHIND] - first
    if k <= 0:
        return s.instant[first]
    if k >= last:
        return s.instant[first + last - 1]
    return 0.5 * (s.instant[first + k - 1] + s.instant[first + k])


@compiled(HOLD)
def hold_all(s, t, which):
    """Hold all functions on the pieces they are on just after t, at the poses of the scene.

    which: BY_TIME or BY_SENSORS, the corners to look at.
    """
    for n in range(s.feature.shape[0]):
        at = t
        if s.feature[n, DRIVE] >= 0:
            at = t - s.mem[s.feature[n, DRIVE], SINCE]
        if which == BY_TIME:
            at = between(s, n, passed(s, n, t))
        hold(s.tab, s.feature[n, OFFSET], at, s.S, which)
