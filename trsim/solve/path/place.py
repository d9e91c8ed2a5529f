"""Places of a static path: solved for by Newton's method, with what leads on from there.

    [ K  G ] [ dq   ]   [ g    ]         A of balance.py
    [ J  0 ] [ dlam ] = [ -Phi ]

Contacts are held in or out, functions on their pieces, and what rubs in the direction of the way
from a place before, the anchor: all of it is smooth, and whoever follows the path looks for what
changes.  The matrix of a place serves for the next one, as long as it converges.
"""

from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from trsim.assemble.dense import least_squares, length
from trsim.assemble.equations import largest_wrench, poses
from trsim.assemble.mechanism import Mechanism
from trsim.assemble.projection import move_all
from trsim.elements.contract import (
    CONTACT,
    FIRST_ROW,
    FLIGHT,
    IMPACT_SPEED,
    PHASE,
    Load,
    Memory,
)
from trsim.elements.prescribed import AnyDrive, rates_along
from trsim.elements.scene import Scene, scene
from trsim.laws.friction import CODES
from trsim.solve.path.balance import (
    BY_SPEED,
    LOADS,
    ROOM,
    SLOWNESS,
    STATE,
    TIME,
    system,
    travel,
    unbalanced,
)
from trsim.solve.path.touching import Touching

Array = NDArray[np.float64]

SLOW = 1e-12  # of the way: what velocities are while forces are asked for
RAMP = 1e-9  # of the mechanism's size: sliding over more is full sliding
STEP = 1e-7  # of the mechanism's size, rad: differences
IN_RAMP = 1e-6  # the same of sliding, of its ramp
ENOUGH = 0.2  # and of the way: what rounding makes of a difference of speeds is a millionth
IN_GAP = 1e-4  # and of a clearance
ALONE = 1e-10  # relative size of a row that is not independent
LOAD = 1e-6  # and of multipliers, of the largest
CLOSE = 1e-13  # of the mechanism's size, rad: the last step of Newton's method
EPS = 4e-16
ROUNDING = 1e-15  # of coordinates: what they are off by
NEARLY = 1e-9  # the same, where rounding lets it come no nearer
BALANCED = 1e-6  # of the largest force: what rounding makes of a stiff contact is less
EXACT = 1e-10  # the same, of a matrix that may be none of the place
ITERATIONS = 25
CHORD = 0.2  # what a step must be of the one before, or the matrix is made anew
TURN = 0.3  # rad, or of the size: a step of Newton's method goes no further
SURFACES = ("surface", "edge")  # travel of what is touched in any direction
KINETIC = 1  # of the bristles of a law that sticks: which number is the coefficient of sliding
# what a quadrature of five points is made of, on 0..1
NODE, WEIGHT = (part / 2.0 for part in np.polynomial.legendre.leggauss(5))
NODE = NODE + 0.5


@dataclass
class Place:
    """A place of a path, in balance."""

    t: float
    y: Array  # its velocities are those that directions were taken from
    lam: Array
    A: Array
    inverse: Array
    v: Array  # velocities along the path
    lam_rate: Array
    anchor: Array | None = None  # where directions were taken from
    came: tuple[float, Array] | None = None  # time and way from the place before, on a smooth piece


def sliding(mechanism: Mechanism) -> Any:
    """The model whose friction is full as soon as something slides, in either direction, without
    dampers of drives; and whether anything rubs."""
    model = mechanism.model
    con, par = model.con.copy(), model.par.copy()
    found = False
    for e, instance in enumerate(mechanism.instances):
        if instance.section == "drives":  # whose motion has a rate, other than what it moves
            par[e, AnyDrive.columns["damping"].at] = 0.0
        if not instance.element.slides:
            continue
        law, first = instance.element.slides
        code = int(con[e, law])
        if code == CODES["none"]:
            continue
        found = True
        mu = par[e, first + (KINETIC if code == CODES["sticking"] else 0)]
        con[e, law] = CODES["modified_coulomb"]
        par[e, first : first + 3] = mu, 0.0, SLOW * RAMP * model.size
    return model.replaced(con=con, par=par, shared_out=0, plain=0), found


def rough_surfaces(mechanism: Mechanism, w: Scene) -> list[tuple[float, int, int]]:
    """Surfaces and seals that rub, in any direction: coefficient, columns of load and friction."""
    columns = {c.name: c.start for c in mechanism.columns}
    found = []
    for e, instance in enumerate(mechanism.instances):
        if instance.row.travel in SURFACES and instance.element.slides:
            law, first = instance.element.slides
            if w.con[e, law] != CODES["none"] and f"{instance.name}.friction_force" in columns:
                load, rub = (f"{instance.name}.{word}_force" for word in ("normal", "friction"))
                found.append((float(w.par[e, first]), columns[load], columns[rub]))
    return found


class Equations:
    """The balance of a mechanism: what is held, and Newton's method."""

    def __init__(self, mechanism: Mechanism, begun: Any) -> None:
        self.mechanism = mechanism
        model, self.rubs = sliding(mechanism)
        # what is a function of rates may ask for their signs alone, as friction does
        self.directed = self.rubs or len(model.rated) > 0
        self.work: Scene = scene(model)
        w = self.work
        w.mem[:], w.branch[:] = begun.mem, begun.branch
        self.n, self.m = w.n_v, w.m
        self.pressing = pressing(w)
        gaps = [g for g in w.contact_par[:, 3].tolist() if np.isfinite(g)]
        self.steps = np.zeros(5)
        self.steps[:3] = STEP, IN_RAMP * SLOW * RAMP * w.size if self.rubs else 0.0, LOAD
        self.steps[SLOWNESS] = SLOW
        if gaps:
            self.steps[0] = min(STEP, IN_GAP * min(gaps) / w.size)
        wide = max(len(begun.y), self.n + self.m)
        self.room = np.zeros((ROOM, wide))
        self.unit = np.tile([w.size, w.size, 1.0] if w.d == 3 else [w.size] * 3 + [1.0] * 3,
                            w.n_r - 1)  # fmt: skip
        self.anchor = begun.y.copy()
        self.close: Array | None = None  # the same for places close ahead, see headings.py
        # surfaces that slide in several ways at once, whose direction turns
        self.surfaces = rough_surfaces(mechanism, w)
        self.sleeves = any(i.row.rubs and len(i.row.states) > 1 for i in mechanism.instances)
        self.touching = Touching(mechanism, w)
        self.turning = self.sleeves or (w.d == 6 and len(self.surfaces) > 0)
        self.stiffest = 0.0  # N*m, of the matrix made last
        self.frozen = False  # velocities of a state are as they are
        self.states = self.driven()  # see at_time
        poses(w, begun.y)
        self.load = float(largest_wrench(w, 0.0)) or 1.0  # the largest force met

    def driven(self) -> list[tuple[int, int, float]]:
        """States that hold the place of a drive with a velocity, its function, when that began."""
        found = []
        for e, instance in enumerate(self.mechanism.instances):
            if instance.section == "drives":
                own = AnyDrive(self.work, e)
                if own.state >= 0:
                    since = float(Memory(self.work, e).since)
                    found.append((int(own.state), int(own.motion), since))
        return found

    def at_time(self, y: Array, t0: float, t: float) -> Array:
        """y with the places of drives that a velocity prescribes as they are at t."""
        y, first = y.copy(), self.work.n_q + self.work.n_v
        for state, motion, since in self.states:
            times = t0 - since + NODE * (t - t0)
            rates = rates_along(self.work.tab, motion, times)[:, 0]
            y[first + state] += (t - t0) * float(WEIGHT @ rates)
        return y

    def moved(self, y: Array, dx: Array) -> Array:
        y = y.copy()
        move_all(self.work, y, np.ascontiguousarray(dx))
        return y

    def left(self, t: float, y: Array, lam: Array) -> Array:
        """g and Phi; sets the velocities of y."""
        if not self.frozen:
            travel(self.work, self.anchor, y, SLOW)
        g = np.zeros(self.n + self.m)
        unbalanced(self.work, t, y, lam, g)
        return g

    def matrix(self, t: float, y: Array, lam: Array) -> Array:
        A = np.zeros((self.n + self.m, self.n + self.m))
        self.steps[2] = LOAD * max(float(np.abs(lam).max(initial=0.0)), 1e-3 * self.load)
        self.steps[TIME] = t
        if self.rubs:
            rates = y[self.work.n_q : self.work.n_q + self.n]
            far = float(np.abs(rates / self.unit).max(initial=0.0)) / SLOW
            part = min(max(IN_RAMP, ENOUGH * far), 0.1)
            self.steps[BY_SPEED] = part * SLOW * RAMP * self.work.size
        self.room[STATE, : len(y)], self.room[LOADS, : len(lam)] = y, lam
        system(self.work, self.pressing, self.steps, self.room, A)
        return A

    def inverse(self, A: Array) -> Array | None:
        """The inverse, rows of joints weighed like stiffnesses; None where there is none."""
        n = self.n
        scale = np.ones(n + self.m)
        K = float(np.abs(A[:n, :n] * self.unit[:, None] * self.unit).max(initial=0.0))
        scale[:n], self.stiffest = self.unit, K
        J = float(np.abs(A[n:, :n] * self.unit).max(initial=0.0))
        scale[n:] = max(K, 1e-300) / max(J, 1e-300) if K > 0.0 else 1.0 / max(J, 1e-300)
        try:
            found = np.linalg.inv(A * scale[:, None] * scale)
        except np.linalg.LinAlgError:
            return None
        if not np.all(np.isfinite(found)):
            return None
        return np.asarray(found * scale[:, None] * scale)

    def solved(self, t: float, y: Array, lam: Array, inverse: Array | None) -> Any:
        """(y, lam, way of the last step) in balance at t; None where it is not found."""
        n, before, last, fresh = self.n, np.inf, np.inf, False
        before_left = np.inf
        places = float(np.abs(y[: self.work.n_q]).max(initial=0.0)) / self.work.size
        near = max(CLOSE, ROUNDING * places)
        for _ in range(ITERATIONS):
            g = self.left(t, y, lam)
            left = self.relative(g)
            if not np.isfinite(left):
                return None
            if inverse is None:
                inverse, fresh = self.inverse(self.matrix(t, y, lam)), True
                if inverse is None:
                    return None
            g[n:] *= -1.0
            x = inverse @ g
            far = float(np.abs(x[:n] / self.unit).max(initial=0.0))
            if not np.isfinite(far):
                return None
            close = far < near or (far < NEARLY and far > 0.5 * last)
            if not fresh and (left > EXACT if close else far > CHORD * before):
                inverse, before = None, np.inf
                continue
            x[:n] *= min(1.0, TURN / max(far, TURN))
            part = self.stopped(t, y, lam, x) if len(self.work.rubbing) else 1.0
            y, lam = self.moved(y, part * x[:n]), lam + part * x[n:]
            noise = EPS * max(1.0, places) * self.stiffest / (self.work.size * self.load)
            if close and (left < max(EXACT, noise) or 0.5 * before_left < left < BALANCED):
                self.left(t, y, lam)
                self.load = max(self.load, float(np.abs(lam).max(initial=0.0)))
                return y, lam
            before_left = left if close else np.inf
            before, last, fresh = (far, far, False) if part == 1.0 else (np.inf, np.inf, False)
            inverse = inverse if part == 1.0 else None
        return None

    def solved_sticking(self, t: float, y: Array, lam: Array, place: Place, slow: float) -> Any:
        """As `solved`, where what touches without sliding at a place before goes on to stick."""
        sticks = {*self.stuck(place.y)} | {e for e, v in self.sliding(place) if length(v) <= slow}
        sticks -= self.touching.tables
        if not sticks:
            return None
        with self.touching.on_ramps(sticks):
            found = self.solved(t, y, lam, place.inverse)
        if found is None:
            return None
        y, lam = found
        return self.solved(t, y, lam, None)

    def stuck(self, y: Array) -> dict[int, float]:
        """What touches with friction that is not full at the velocities of y, and its part."""
        poses(self.work, y)
        full = SLOW * RAMP * self.work.size
        return {e: length(v) / full for e, v in self.touching.slips() if length(v) < full}

    def sliding(self, place: Place) -> list[tuple[int, Array]]:
        """Sliding velocities of what touches, along the path."""
        w, y = self.work, place.y.copy()
        y[w.n_q : w.n_q + self.n] = place.v
        poses(w, y)
        return list(self.touching.slips())

    def multipliers(self, t: float, y: Array) -> Array:
        """Those that come nearest to a balance at y, without the friction that they make."""
        lam = np.zeros(self.m)
        J = self.matrix(t, y, lam)[self.n :, : self.n]
        return least_squares((J * self.unit).T, self.left(t, y, lam)[: self.n] * self.unit, ALONE)

    def relative(self, g: Array) -> float:
        """The largest force, or moment by the size, that is left, of the largest there is."""
        n, size = self.n, self.work.size
        return float(np.abs(g[:n] * self.unit).max(initial=0.0)) / (size * self.load)

    def stopped(self, t: float, y: Array, lam: Array, x: Array) -> float:
        """How much of a step to take: what would turn round stops first, where it may stick."""
        w, n = self.work, self.n
        rows, slip = w.rubbing[:, 0], Load.columns["slip"].at
        first = w.loads[rows, slip].copy()
        self.left(t, self.moved(y, x[:n]), lam + x[n:])
        last, least = w.loads[rows, slip], SLOW * RAMP * w.size
        turned = (first * last < 0.0) & (np.minimum(np.abs(first), np.abs(last)) > least)
        return float(np.min(first[turned] / (first - last)[turned], initial=1.0))

    def place(self, t: float, y: Array, lam: Array) -> Place | None:
        """What leads on from a balance: how it moves with t."""
        w, n = self.work, self.n
        A = self.matrix(t, y, lam)
        inverse = self.inverse(A)
        if inverse is None:
            return None
        x = inverse @ self.forcing(t, y, lam)
        return Place(t, y, lam, A, inverse, x[:n], x[n:], self.anchor) if w.n_v == n else None

    def along_itself(self, place: Place, dt: float) -> Place:
        """A place with friction against its own velocities, not against its way in a time dt."""
        y, w = place.y.copy(), self.work
        y[w.n_q : w.n_q + self.n] = SLOW * dt * place.v
        self.frozen = True
        found = self.solved(place.t, y, place.lam, place.inverse)
        there = self.place(place.t, *found) if found is not None else None
        self.frozen = False
        return there or place

    def forcing(self, t: float, y: Array, lam: Array) -> Array:
        """dg/dt at one place, and -Phi_t."""
        w, n = self.work, self.n
        found = np.zeros(n + self.m)
        g = np.zeros((2, n + self.m))
        if self.mechanism.timed or self.states:
            h = self.small
            for k, dt in enumerate((h, -h)):
                near = self.at_time(y, t, t + dt)
                unbalanced(w, t + dt, near, lam, g[k])
            found[:n] = (g[0] - g[1])[:n] / (2.0 * h)
        unbalanced(w, t, y, lam, g[0])
        found[n:] = -np.asarray(w.phi_t[: self.m])
        return found

    small = 1e-9  # s, of differences against t

    # --- what is held --------------------------------------------------------------------------

    def set_phases(self, closed: dict[int, bool]) -> None:
        for e, inside in closed.items():
            self.work.mem[e, PHASE] = CONTACT if inside else FLIGHT
            self.work.mem[e, IMPACT_SPEED] = 1.0  # what comes to rest has none


def pressing(w: Scene) -> NDArray[np.int64]:
    """Rows of joints whose reactions make friction."""
    found = []
    for _, e, _, number, *_ in w.rubbing.tolist():
        found += [int(k) for k in w.con[e, FIRST_ROW : FIRST_ROW + number] if k >= 0]
    return np.array(sorted(set(found)), np.int64)
