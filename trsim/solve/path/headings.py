"""Where friction along a static path takes its directions from: the way from a place before.

Where a path has a corner, or something turns round, directions are those of the way from there.
What comes to rest there goes nowhere, and keeps the direction in which it came.
"""

from itertools import pairwise
from typing import Any

import numpy as np
from numpy.typing import NDArray

from trsim.solve.path.balance import SLOW
from trsim.solve.path.newton import RAMP
from trsim.solve.path.place import Equations, Place

Array = NDArray[np.float64]

FIRST = 1e-4  # of the time between rows: how far ahead the direction of the start is taken
SURE = 100.0  # times what full sliding takes, or further
FASTER = 1e4  # times the way: what slides that much slower than the rest slides in full, too
STUCK = 1e-3  # of full friction: less is none
MOVED = SURE * RAMP  # of the size: way after which directions are taken from a new place
ONCE = 1.001  # times that way: what rested before has not gone further
CLOSE_AHEAD = 10.0 * MOVED  # a place so near tells no direction
KINK = 0.1  # of what the rates at both ends of a step make of it: off by more, and they jump inside
LEAST = 1e-5  # of the size: a shorter step is not looked at for bends
LOST = 1e-13  # of the size: ways that are rounding
BRIEF = 1e-6  # of the size: the first step behind a corner


def directed(eq: Equations, place: Place, every: float) -> Place:
    """The start with friction against the way it is going to go."""
    if not eq.directed:
        return place
    h = FIRST * every
    while True:
        t = place.t + h
        found = eq.solved(t, eq.at_time(place.y, place.t, t), place.lam, None)
        if found is None:  # what touches may roll
            there = eq.at_time(eq.moved(place.y, h * place.v), place.t, t)
            found = eq.solved_sticking(t, there, place.lam, place, 0.0)
        if found is not None:
            came, far = eq.ways(place.y, found[0])
            at_start = against(eq, place, came, found) if h >= every or far > MOVED else None
            if at_start is not None:
                return at_start
            if far > MOVED and not eq.only_lines:  # it sticks
                return place
        elif not eq.only_lines:
            return place
        if h >= every:
            return place
        h *= 10.0


def against(eq: Equations, place: Place, came: Array, found: Any) -> Place | None:
    """A place with friction against the way to another one, where that is found."""
    first = slice(eq.work.n_q, eq.work.n_q + eq.n)
    ahead = found[0].copy()
    ahead[first] = SLOW * came
    y = place.y.copy()
    rolls = max(eq.stuck(ahead).values(), default=0.0) > STUCK / FASTER
    y[first] = ahead[first] * (1.0 if rolls else FASTER)
    with eq.frozen():
        again = eq.solved(place.t, y, found[1], None)
        return eq.place(place.t, *again) if again is not None else None


def anchored(
    eq: Equations, place: Place, every: float, smooth: bool = False, least: float = MOVED
) -> None:
    """Take directions from here on, unless that would be from next to nothing.

    What came here and rests counts as having begun a little before, in whatever steps others go
    on.  smooth: so may all the rest, for a place so close ahead that it tells no direction.
    """
    came, most = eq.ways(eq.anchor, place.y)
    if most <= least:
        return
    went = np.abs(came / eq.unit)
    still = np.abs(place.v / eq.unit) * every <= RAMP
    rests = still & (went > RAMP)
    d = eq.work.d
    turns = ~still.reshape(-1, d)[:, 2 if d == 3 else 3 :].all(axis=1)  # then it slides by that
    rests.reshape(-1, d)[turns, : 2 if d == 3 else 3] = False
    stops = rests & (went > ONCE * MOVED)
    kept = np.where(rests, 1.0, 0.0)
    kept[stops] = MOVED / went[stops].max(initial=MOVED)
    eq.anchor, eq.close = place.y.copy(), None
    if eq.rubs:
        eq.anchor = eq.moved(place.y, -kept * came)
        close = np.where(rests, kept, MOVED / most)
        eq.close = eq.moved(place.y, -close * came) if smooth else None


def came_by(eq: Equations, place: Place, there: Place) -> tuple[float, Array] | None:
    """Time and way from a place to the next; None of a way that tells no direction."""
    went, far = eq.ways(place.y, there.y)
    return (there.t - place.t, went) if far > MOVED else None


def second_order(eq: Equations, place: Place, h: float) -> Array:
    """Where the directions at the end of a step are taken from where friction turns: with ways d

        v(t + h) ~ d(t, t + h) - r^2/(1 + 2 r) d(t - h/r, t)

    the backward difference of second order, steps in the ratio r [HairerNorsettWanner1993, III.5].
    """
    before, came = place.came or (h, 0.0 * place.v)
    r = h / before
    return eq.moved(place.y, r * r / (1.0 + 2.0 * r) * came)


def brief_step(eq: Equations, place: Place, every: float) -> float:
    """How long a step behind a corner is at whose end all friction of what slides from there on is
    full; 0 where nothing moves."""
    speed = float(np.abs(place.v / eq.unit).max(initial=0.0))
    return BRIEF / speed if speed * every > BRIEF else 0.0


def bend(eq: Equations, place: Place, trial: Place) -> float:
    """How far a step is off what the rates at both its ends make of it, in its way, of the size,
    and in the forces of joints and drives, of the largest: much where a touch has passed from one
    piece of a shape to another inside, or something went up and down again."""
    if eq.sleeves:  # whose friction turns, which rates of forces know nothing of
        return 0.0
    half, (way, far) = 0.5 * (trial.t - place.t), eq.ways(place.y, trial.y)
    if far <= LEAST:
        return 0.0
    off = np.abs(way - half * (place.v + trial.v)) / eq.unit
    force = np.abs(trial.lam - place.lam - half * (place.lam_rate + trial.lam_rate))
    force *= np.asarray(eq.work.row_unit)[: eq.m] / (eq.work.size * eq.load)
    return float(max(off.max(initial=0.0), force.max(initial=0.0)))


def by_rates(off: list[float]) -> bool:
    """Whether it is the rates that are wrong, and not the step bent, by what it and its halves are
    off: always half as much."""
    halves = [b / a for a, b in pairwise(off)]
    return len(halves) > 2 and all(0.4 < x < 0.6 for x in halves)


def kinked(eq: Equations, place: Place, after: Place) -> bool:
    """Whether rates jump between two places, as where what stuck begins to slide."""
    half = 0.5 * (after.t - place.t)
    off = np.abs(eq.ways(place.y, after.y)[0] - half * (place.v + after.v)) / eq.unit
    told = half * (np.abs(place.v) + np.abs(after.v)) / eq.unit
    return bool(np.any(off > KINK * told + LOST))
