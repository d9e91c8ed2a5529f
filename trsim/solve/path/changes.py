"""What changes along a static path: contacts, pieces of functions, directions, events, stability.

A step of a path is smooth: contacts are held in or out, and functions on the pieces they are on.
Whatever of it does not hold at its end any more has changed inside, and the path is cut there.
"""

from dataclasses import dataclass
from math import inf
from typing import Any

import numpy as np
from numpy.typing import NDArray

from trsim.assemble.dense import length
from trsim.assemble.equations import gaps, poses
from trsim.assemble.features import HELD_FROM, HELD_TO, OFFSET, SENSED, hold_all
from trsim.assemble.switches import CHANNEL, LIMITS, TIME
from trsim.elements.contract import Load
from trsim.laws.functions import (
    BY_SENSORS,
    BY_TIME,
    FREE,
    HELD_OF_TABLE,
    OF_TABLE,
    POINTS,
    TABLE,
    VARIABLE,
)
from trsim.solve.path.balance import unbalanced
from trsim.solve.path.place import Equations, Place

Array = NDArray[np.float64]

SAME = 1e-13  # of the path: where a change is, and whether it has been reached
AT_REST = 1e-6  # of the mechanism's size in the time of the path: a slower sliding is none
FLAT = 1e-9  # of the largest eigenvalue: one that is rounding
NEARLY = 0.01  # of an arch that a gap makes in a step: what its cubic may be wrong by
FLATTEST = 1e-12  # of the mechanism's size: an arch that is rounding
CONTACT, PIECE, RIM, RUB, WATCH, SENSE = "contact", "piece", "rim", "rub", "watch", "sense"


@dataclass(frozen=True)
class Change:
    """Something that changes, and to what."""

    kind: str
    which: int
    to: float
    rate: float = 0.0  # of a gap, or of what is watched


class Looks:
    """What holds now, and what of it does not at another place."""

    def __init__(self, equations: Equations, end: float) -> None:
        self.eq, self.work = equations, equations.work
        w = self.work
        self.closed = {int(e): False for e in w.contact}
        self.rub_rows = w.rubbing[:, 0].tolist()
        self.direction = dict.fromkeys(self.rub_rows, 0.0)
        self.heading: dict[int, Array] = {}  # of what touches: its last sliding velocity
        self.came: dict[int, Any] = {}  # both as they were at the place before
        self.slow = AT_REST * w.size / end
        self.events = equations.mechanism.stages.switches.events
        self.side = dict.fromkeys(range(len(self.events)), 0.0)
        self.left = [float(event.most) for event in self.events]
        self.value = [event.value for event in self.events]
        self.columns = {c.name: c.start for c in equations.mechanism.columns}
        self.places = watched_places(w, bent_tables(equations.mechanism))
        self.rims = rimmed_tables(w, equations.mechanism)
        self.over = [0.0] * len(self.rims)
        self.sense = 0.0

    def gaps(self, place: Place) -> dict[int, tuple[float, float]]:
        """Penetration of every contact, and its rate along the path."""
        if not self.closed:
            return {}
        poses(self.work, self.moving(place))
        gaps(self.work, place.t)
        return {e: tuple(self.work.gap[e].tolist()) for e in self.closed}  # type: ignore[misc]

    def moving(self, place: Place) -> Array:
        """Its state with the velocities along the path."""
        y = place.y.copy()
        y[self.work.n_q : self.work.n_q + self.work.n_v] = place.v
        return y

    def slips(self, place: Place) -> Array:
        """Sliding speeds of what rubs, along the path."""
        w = self.work
        if not len(w.rubbing):
            return np.zeros(0)
        unbalanced(w, place.t, self.moving(place), place.lam, np.zeros(self.eq.n + self.eq.m))
        return np.array(w.loads[w.rubbing[:, 0], Load.columns["slip"].at])

    def touching(self, place: Place) -> list[tuple[int, Array]]:
        """Sliding velocities of what touches and does not stick, along the path."""
        if not self.eq.touching.kernels:
            return []
        stuck = self.eq.stuck(place.y)
        return [
            (e, v) for e, v in self.eq.sliding(place) if e not in stuck and length(v) > self.slow
        ]

    def slides(self, place: Place, e: int) -> bool:
        """Whether something that rubs slides, and does not stick."""
        if e in self.direction:
            return bool(abs(self.slips(place)[self.rub_rows.index(e)]) > self.slow)
        return any(one == e for one, _ in self.touching(place))

    def put_back(self, e: int, direction: Any) -> None:
        """Take the direction in which something slid before it came to rest."""
        which: dict[int, Any] = self.direction if e in self.direction else self.heading
        which[e] = direction

    def all_slide(self, place: Place) -> bool:
        """Whether nothing that rubs sticks."""
        return bool(np.all(np.abs(self.slips(place)) > self.slow))

    def values(self, place: Place, out: Array | None) -> list[tuple[float, float]]:
        """What user events watch, less its value, and its rate where it is known."""
        if not self.events:
            return []
        w, found = self.work, []
        poses(w, self.moving(place))
        gaps(w, place.t)
        for event, value in zip(self.events, self.value, strict=True):
            if event.kind == CHANNEL and out is not None:
                found.append((float(out[column_of(self.columns, event.when)]) - value, inf))
            elif event.entry <= LIMITS:
                found.append((float(w.gap[LIMITS - event.entry, 0]), inf))
            elif event.entry == TIME:
                found.append((place.t - value, inf))
            else:
                x, rate = w.S[event.entry].tolist()
                found.append((x - value, rate))
        return found

    @property
    def waiting(self) -> list[int]:
        """Events that wait for a channel."""
        waits = enumerate(zip(self.events, self.left, strict=True))
        return [k for k, (event, left) in waits if event.kind == CHANNEL and left > 0]

    def hold(self, t: float, which: int) -> None:
        """Hold functions on the pieces they are on just after t; smooth tables that sensors read on
        none: their second derivatives jump, which Newton's method does not mind."""
        w = self.work
        if len(w.feature):
            hold_all(w, t, which)
            if which == BY_SENSORS:
                w.tab[self.free_places] = FREE

    @property
    def free_places(self) -> NDArray[np.int64]:
        return np.setdiff1d(self.work.held[sensed_ones(self.work)], self.places)

    def pieces(self, place: Place) -> Array:
        """What functions would be held on at a place."""
        w = self.work
        if not len(self.places):
            return np.zeros(0)
        before = w.tab[w.held].copy()
        poses(w, place.y)
        self.hold(place.t, BY_SENSORS)
        found = w.tab[self.places].copy()
        w.tab[w.held] = before
        return np.asarray(found)

    def outside(self) -> list[float]:
        """Of smooth tables that hold their end values, at the poses of the scene: -1 below their
        first point, 1 above the last, 0 between."""
        tab, found = self.work.tab, []
        for o in self.rims:
            x, n = float(self.work.S[int(tab[o + VARIABLE]), 0]), int(tab[o + POINTS])
            first, last = tab[o + OF_TABLE + 1], tab[o + OF_TABLE + n]
            found.append(-1.0 if x < first else 1.0 if x > last else 0.0)
        return found

    def take(self, place: Place, out: Array | None) -> None:
        """Hold what is so at a place where a path begins."""
        for e, (g, _) in self.gaps(place).items():
            self.closed[e] = g > 0.0
        self.eq.set_phases(self.closed)
        self.hold_all(place)
        self.sides(place, out)

    def sides(self, place: Place, out: Array | None) -> None:
        """Take the sides on which what user events watch is."""
        for k, (x, _) in enumerate(self.values(place, out)):
            self.side[k] = float(np.sign(x))

    def hold_all(self, place: Place) -> None:
        """Hold functions where they go on along the path."""
        poses(self.work, self.moving(place))
        self.over = self.outside()
        self.hold(place.t, BY_TIME)
        self.hold(place.t, BY_SENSORS)

    def changes(self, place: Place, out: Array | None, sense: float) -> list[Change]:
        """What is otherwise at a place than it is held."""
        found = []
        for e, (g, rate) in self.gaps(place).items():
            if (g > 0.0) != self.closed[e] and (g != 0.0 or self.closed[e]):
                found.append(Change(CONTACT, e, float(g > 0.0), rate))
        now = self.pieces(place)
        for k in np.flatnonzero(now != self.work.tab[self.places]).tolist():
            if now[k] != FREE and self.work.tab[self.places[k]] != FREE:
                found.append(Change(PIECE, int(k), float(now[k])))
        if self.rims:
            poses(self.work, place.y)
            for k, side in enumerate(self.outside()):
                if side != self.over[k]:
                    found.append(Change(RIM, k, side))
        for e, slip in zip(self.rub_rows, self.slips(place).tolist(), strict=True):
            if abs(slip) > self.slow and np.sign(slip) == -self.direction[e]:
                found.append(Change(RUB, e, float(np.sign(slip)), slip))
        for e, v in self.touching(place):
            if e in self.heading and v @ self.heading[e] < 0.0:
                found.append(Change(RUB, e, -1.0, float(np.linalg.norm(v))))
        for k, (x, rate) in enumerate(self.values(place, out)):
            if self.left[k] > 0 and self.side[k] != 0.0 and x * self.side[k] <= 0.0:
                found.append(Change(WATCH, k, -self.side[k], rate))
        if self.sense != 0.0 and sense != self.sense:
            found.append(Change(SENSE, 0, sense))
        return found

    def directions(self, place: Place) -> None:
        """Take directions of sliding, and pieces of functions, where there was none."""
        now, held = self.pieces(place), self.work.tab[self.places]
        self.work.tab[self.places] = np.where(held == FREE, now, held)
        self.came = self.direction | self.heading
        for e, slip in zip(self.rub_rows, self.slips(place).tolist(), strict=True):
            if abs(slip) > self.slow:
                self.direction[e] = float(np.sign(slip))
        self.heading = {e: v for e, v in self.heading.items() if self.closed[e]}
        self.heading |= self.touching(place)

    def hidden(self, a: Place, b: Place) -> bool:
        """Whether a contact may close and open again inside a step, or the other way round, or a
        sensor pass what an event watches it for and come back."""
        h, first, last = b.t - a.t, self.gaps(a), self.gaps(b)
        ends = [(first[e], last[e], inside) for e, inside in self.closed.items()]
        watched = zip(self.values(a, None), self.values(b, None), strict=True)
        for k, (x, y) in enumerate(watched):
            if np.isfinite(x[1]) and self.left[k] > 0 and self.side[k] != 0.0:
                ends.append((x, y, self.side[k] > 0.0))
        return any(
            turns_through(x, y, h, -1.0 if inside else 1.0, self.work.size) for x, y, inside in ends
        )

    def passed_over(self, a: Place, b: Place) -> bool:
        """Whether what drives and loads ask for goes much further inside a step than at its ends,
        as of one that is back at every row, or a drive goes back in it, so that what rubs turns."""
        return self.eq.mechanism.timed and self.eq.passes_over(a.t, b.t, b.y, b.lam)

    def whose(self, place: int) -> int:
        """The instance that has the function of a piece, held at this place; -1 of none."""
        w, mechanism = self.work, self.eq.mechanism
        for row in w.feature:
            if place in w.held[row[HELD_FROM] : row[HELD_TO]]:
                name = next((f.name for f in mechanism.functions if f.offset == row[OFFSET]), "")
                section, _, rest = name.partition(".")
                for e, instance in enumerate(mechanism.instances):
                    if instance.section == section and rest.startswith(f"{instance.name}."):
                        return e
        return -1


def turns_through(
    first: tuple[float, float], last: tuple[float, float], h: float, side: float, size: float
) -> bool:
    """Whether the cubic through a gap and its rates at both ends of a step passes zero inside.

    side: 1 of what is open, whose gap is below zero."""
    g0, r0, g1, r1 = side * first[0], side * h * first[1], side * last[0], side * h * last[1]
    if g0 > 0.0 or g1 > 0.0 or r0 <= 0.0 or r1 >= 0.0:
        return False
    # g0 + x (r0 + x (a + x b)), at the roots of its slope
    a, b = 3.0 * (g1 - g0) - 2.0 * r0 - r1, 2.0 * (g0 - g1) + r0 + r1
    root = np.sqrt(a * a - 3.0 * b * r0)  # the slope changes its sign inside: there is one
    x = r0 / (root - a) if a <= 0.0 else (a + root) / (-3.0 * b)  # neither cancels
    top = g0 + x * (r0 + x * (a + x * b))
    arch = top - max(g0, g1)
    return bool(arch > FLATTEST * size and top > -NEARLY * arch)


def bottoms(
    times: list[float], values: list[dict[int, float]], side: dict[int, float]
) -> list[float]:
    """Where what is watched comes nearest to its value, of what is nearer at the second of three
    times than at both others: the bottoms of parabolas."""
    t0, t1, t2 = times
    found = []
    for k in values[0]:
        x0, x1, x2 = (side[k] * one[k] for one in values)
        if 0.0 < x1 < min(x0, x2):
            back, ahead = (x1 - x0) / (t1 - t0), (x2 - x1) / (t2 - t1)
            middle = (back * (t2 - t1) + ahead * (t1 - t0)) / (t2 - t0)  # the rate at t1
            found.append(t1 - middle * (t2 - t0) / (2.0 * (ahead - back)))
    return found


def column_of(columns: dict[str, int], channel: str) -> int:
    """The column of a channel, or of a component of it."""
    if channel in columns:
        return columns[channel]
    return columns[channel[:-2]] + "xyz".index(channel[-1])


def sensed_ones(w: Any) -> NDArray[np.int64]:
    """Entries of `held` of functions that sensors meet corners of."""
    rows = [range(int(r[HELD_FROM]), int(r[HELD_TO])) for r in w.feature if r[SENSED] > 0]
    return np.array([k for row in rows for k in row], np.int64)


def bent_tables(mechanism: Any) -> set[int]:
    """Offsets of tables with straight lines from point to point."""
    return {
        one.offset
        for one in mechanism.functions
        if one.spec.kind == "table" and one.spec.interpolation == "linear"
    }


def rimmed_tables(w: Any, mechanism: Any) -> list[int]:
    """Offsets of smooth tables of sensors that hold their end values: they are bent there."""
    smooth = [
        one.offset
        for one in mechanism.functions
        if one.spec.kind == "table"
        and one.spec.interpolation != "linear"
        and one.spec.ends == "hold"
    ]
    return [o for o in smooth if w.tab[o] == TABLE and w.tab[o + VARIABLE] >= 0]


def watched_places(w: Any, bent: set[int]) -> NDArray[np.int64]:
    """Places in tab of what corners are held on that are told: of operations, and of tables that
    are bent at their points."""
    found = []
    for row in w.feature:
        if row[SENSED] == 0:
            continue
        o = int(row[OFFSET])
        for place in w.held[row[HELD_FROM] : row[HELD_TO]].tolist():
            if o in bent or not (w.tab[o] == TABLE and place == o + HELD_OF_TABLE):
                found.append(int(place))
    return np.array(found, np.int64)


def stability(eq: Equations, place: Place) -> tuple[float, float]:
    """The sign of the determinant; the lowest eigenvalue of the stiffness against the mass, 1/s^2,
    inf where nothing is free."""
    if place.lowest is None:
        place.lowest = inf if eq.n == eq.m else lowest(eq, place)
    return place.sign, place.lowest


def lowest(eq: Equations, place: Place) -> float:
    """The lowest eigenvalue of what is free to move.

    With one freedom its inverse is the trace of C M, C the compliance: the upper left of A^-1.
    """
    n, m, A = eq.n, eq.m, place.A
    if n == m + 1:
        with np.errstate(divide="ignore"):
            return float(1.0 / np.sum(place.inverse[:n, :n] * eq.M))
    Z = null_space(A[n:, :n] * eq.unit, n - m) * eq.unit[:, None]
    W = null_space(A[:n, n:].T * eq.unit, n - m) * eq.unit[:, None]
    values = np.linalg.eigvals(np.linalg.solve(W.T @ eq.M @ Z, W.T @ A[:n, :n] @ Z))
    value = float(values.real.min())
    return 0.0 if abs(value) < FLAT * np.abs(values).max() else value


def side_of(sign: float, value: float) -> float:
    """On which side of a change of stability a place is, by what `stability` finds there."""
    if not np.isfinite(value):
        return 2.0 * sign
    return 1.0 if value > 0.0 else -1.0


def null_space(J: Array, free: int) -> Array:
    """Columns that span what J does not see."""
    if not len(J):
        return np.eye(J.shape[1])
    q, _ = np.linalg.qr(J.T, mode="complete")
    return np.asarray(q[:, q.shape[1] - free :])
