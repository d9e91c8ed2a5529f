"""Where friction along a static path takes its directions from: the way from a place before.

Where a path has a corner, or something turns round, directions are those of the way from there.
What comes to rest there goes nowhere, and keeps the direction in which it came.
"""

import numpy as np
from numpy.typing import NDArray

from trsim.solve.path.balance import travel
from trsim.solve.path.place import RAMP, SLOW, Equations, Place

Array = NDArray[np.float64]

FIRST = 1e-4  # of the time between rows: how far ahead the direction of the start is taken
SURE = 100.0  # times what full sliding takes, or further
FASTER = 1e4  # times the way: what slides that much slower than the rest slides in full, too
MOVED = SURE * RAMP  # of the size: way after which directions are taken from a new place
ONCE = 1.001  # times that way: what rested before has not gone further
BRIEF = 1e-6  # of the size: the first step behind a corner


def way(eq: Equations, y: Array, y1: Array) -> float:
    """The furthest way of a body, rad or of the mechanism's size."""
    return float(np.abs(ways(eq, y, y1) / eq.unit).max(initial=0.0))


def ways(eq: Equations, y: Array, y1: Array) -> Array:
    """The ways of all bodies from one state to another, along the velocities of the solve."""
    there = y1.copy()
    travel(eq.work, y, there, 1.0)
    return np.asarray(there[eq.work.n_q : eq.work.n_q + eq.n])


def directed(eq: Equations, place: Place, every: float) -> Place:
    """The start with friction against the way it is going to go."""
    if not eq.rubs:
        return place
    first, h = slice(eq.work.n_q, eq.work.n_q + eq.n), FIRST * every
    while True:
        there = eq.at_time(place.y, place.t, place.t + h)
        found = eq.solved(place.t + h, there, place.lam, None)
        if found is None:
            return place
        ahead = found[0].copy()
        travel(eq.work, place.y, ahead, SLOW)
        if h >= every or np.abs(ahead[first] / eq.unit).max() > SLOW * MOVED:
            break
        h *= 10.0
    y = place.y.copy()
    y[first] = FASTER * ahead[first]
    eq.frozen = True
    again = eq.solved(place.t, y, found[1], None)
    at_start = eq.place(place.t, *again) if again is not None else None
    eq.frozen = False
    return at_start or place


def anchored(eq: Equations, place: Place, every: float, least: float = MOVED) -> None:
    """Take directions from here on, unless that would be from next to nothing.

    What came here and rests counts as having begun a little before, in whatever steps others go
    on.
    """
    came = ways(eq, eq.anchor, place.y)
    went = np.abs(came / eq.unit)
    if went.max(initial=0.0) <= least:
        return
    eq.anchor = place.y.copy()
    rests = np.abs(place.v / eq.unit) * every <= RAMP
    if eq.rubs and np.any(rests & (went > RAMP)):
        stops = rests & (went > ONCE * MOVED)
        most = went[stops].max(initial=MOVED)
        eq.anchor = eq.moved(
            place.y, -np.where(rests, came, 0.0) * np.where(stops, MOVED / most, 1.0)
        )


def brief_step(eq: Equations, place: Place, every: float) -> float:
    """How long a step behind a corner is at whose end all friction of what slides from there on is
    full; 0 where nothing moves."""
    speed = float(np.abs(place.v / eq.unit).max(initial=0.0))
    return BRIEF / speed if speed * every > BRIEF else 0.0
