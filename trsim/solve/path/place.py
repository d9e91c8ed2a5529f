"""Places of a static path: solved for by Newton's method, with what leads on from there.

Contacts are held in or out, functions on their pieces, and what rubs in the direction of the way
from a place before, the anchor: all of it is smooth, and whoever follows the path looks for what
changes.  The matrix of a place serves for the next one, as long as it converges (newton.py).
"""

from collections import deque
from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import dataclass, field
from typing import Any

import numpy as np
from numpy.typing import NDArray

from trsim.assemble.dense import least_squares, length
from trsim.assemble.equations import corners, largest_wrench, poses
from trsim.assemble.mechanism import Mechanism
from trsim.assemble.projection import move_all
from trsim.elements.contract import (
    BRANCH,
    CONTACT,
    FIRST_ROW,
    FLIGHT,
    IMPACT_SPEED,
    PHASE,
    WHOLE,
    Memory,
)
from trsim.elements.prescribed import AnyDrive, rates_along, write_rates
from trsim.elements.scene import Scene, scene
from trsim.laws.friction import CODES, FULL
from trsim.solve.diagnose.linearised import mass_matrix
from trsim.solve.path.balance import BY_PLACE, ROOM, SLOW, Balance, system, unbalanced
from trsim.solve.path.newton import (
    FORCING,
    INVERSE,
    LEAD,
    LEFT,
    MATRIX,
    NODES,
    RAMP,
    WEIGHTS,
    ask,
    passes_over,
    solve,
    went,
)
from trsim.solve.path.touching import Touching

Array = NDArray[np.float64]

STEP = 1e-7  # of the mechanism's size, rad: differences
IN_GAP = 1e-4  # and of a clearance
KEPT = 3  # ways from place to place
ALONE = 1e-10  # relative size of a row that is not independent
SURFACE, LINE = "surface", "edge"  # travel of what is touched in any direction
NONE = CODES["none"]
KINETIC = 1  # of the bristles of a law that sticks: which number is the coefficient of sliding


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
    sign: float = 0.0  # of the determinant of A
    anchor: Array | None = None  # where directions were taken from
    came: tuple[float, Array] | None = None  # time and way from the place before, on a smooth piece
    lowest: float | None = field(default=None, init=False)  # eigenvalue, once it was asked for


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


def rough_lines(mechanism: Mechanism, w: Scene) -> list[int]:
    """Seals that rub: their rows."""
    return [
        e for e, i in enumerate(mechanism.instances)
        if i.row.travel == LINE and i.element.slides and w.con[e, i.element.slides[0]] != NONE
    ]  # fmt: skip


def rough_surfaces(mechanism: Mechanism, w: Scene) -> list[tuple[float, int, int]]:
    """Surfaces that rub, in any direction: coefficient, columns of load and friction."""
    columns = {c.name: c.start for c in mechanism.columns}
    found = []
    for e, instance in enumerate(mechanism.instances):
        if instance.row.travel == SURFACE and instance.element.slides:
            law, first = instance.element.slides
            if w.con[e, law] != NONE and f"{instance.name}.friction_force" in columns:
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
        self.M = mass_matrix(w)
        w.mem[:], w.branch[:] = begun.mem, begun.branch
        self.n, self.m = w.n_v, w.m
        gaps = [g for g in w.contact_par[:, 3].tolist() if np.isfinite(g)]
        self.unit = np.tile([w.size, w.size, 1.0] if w.d == 3 else [w.size] * 3 + [1.0] * 3,
                            w.n_r - 1)  # fmt: skip
        self.states = self.driven()  # see at_time
        self.record = self.recorded(begun.y, min([STEP, *(IN_GAP * g / w.size for g in gaps)]))
        self.anchor = begun.y.copy()
        self.close: Array | None = None  # the same for places close ahead, see headings.py
        # surfaces that slide in several ways at once, whose direction turns
        self.surfaces = rough_surfaces(mechanism, w)
        self.sleeves = any(i.row.rubs and len(i.row.states) > 1 for i in mechanism.instances)
        self.touching = Touching(mechanism, w)
        self.lines = np.array(rough_lines(mechanism, w), np.int64)
        # nothing else rubs, which might stick
        self.only_lines = len(self.lines) > 0 and not self.surfaces and not len(w.rubbing)
        self.turning = self.sleeves or (w.d == 6 and len(self.surfaces) + len(self.lines) > 0)
        # ways that were asked for last, which are asked for again
        self.known: deque[tuple[Array, Array, Array, float]] = deque(maxlen=KEPT)
        poses(w, begun.y)
        self.load = float(largest_wrench(w, 0.0)) or 1.0

    def recorded(self, y: Array, step: float) -> Balance:
        """What compiled functions work with."""
        w, all_rows = self.work, self.n + self.m
        steps = np.zeros(3)
        steps[BY_PLACE] = step
        return Balance(
            None,
            {"y": y.shape, "lam": (self.m,), "anchor": y.shape, "A": (all_rows, all_rows),
             "inverse": (all_rows, all_rows), "g": (all_rows,), "x": (all_rows,),
             "body": (10,), "slip": (len(w.rubbing),), "room": (ROOM, max(len(y), all_rows)),
             "rates": (len(NODES), 3), "times": (len(NODES),)},
            unit=self.unit, pressing=pressing(w), steps=steps, order=np.zeros(all_rows, np.int64),
            moving=np.array([one[:2] for one in self.states], np.int64).reshape(-1, 2),
            since=np.array([one[2] for one in self.states]),
            ask=ask.address(), system=system.address(), unbalanced=unbalanced.address(),
            write_rates=write_rates.address(), rubs=int(self.rubs),
            timed=int(self.mechanism.timed),
        )  # fmt: skip

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

    @property
    def load(self) -> float:
        """The largest force met, N."""
        return float(self.record.load)

    @load.setter
    def load(self, force: float) -> None:
        self.record.load = force

    @property
    def small(self) -> float:
        """Of differences against t, s."""
        return float(self.record.small)

    @small.setter
    def small(self, dt: float) -> None:
        self.record.small = dt

    @contextmanager
    def frozen(self) -> Iterator[None]:
        """Velocities of a state are as they are."""
        self.record.frozen = 1.0
        try:
            yield
        finally:
            self.record.frozen = 0.0

    def at_time(self, y: Array, t0: float, t: float) -> Array:
        """y with the places of drives that a velocity prescribes as they are at t."""
        y, first = y.copy(), self.work.n_q + self.work.n_v
        for state, motion, since in self.states:
            times = t0 - since + np.array(NODES) * (t - t0)
            rates = rates_along(self.work.tab, motion, times)[:, 0]
            y[first + state] += (t - t0) * float(np.array(WEIGHTS) @ rates)
        return y

    def moved(self, y: Array, dx: Array) -> Array:
        y = y.copy()
        move_all(self.work, y, np.ascontiguousarray(dx))
        return y

    def ways(self, before: Array, y: Array) -> tuple[Array, float]:
        """The ways of all bodies from one state to another, along the velocities of the solve, and
        the furthest of them, rad or of the mechanism's size."""
        for first, last, way, far in self.known:
            if first is before and last is y:
                return way, far
        way = np.zeros(self.n)
        far = went(self.work, self.record, before, y, way)
        self.known.appendleft((before, y, way, far))
        return way, far

    def asked(self, t: float, y: Array, lam: Array, task: int) -> bool:
        """Do a task at a state; what it gives is in the record."""
        b = self.record
        b.y[:], b.lam[:], b.anchor[:] = y, lam, self.anchor
        return bool(ask(self.work, b, t, task))

    def left(self, t: float, y: Array, lam: Array) -> Array:
        """g and Phi; sets the velocities of y."""
        self.asked(t, y, lam, LEFT)
        y[:] = self.record.y
        return np.array(self.record.g)

    def matrix(self, t: float, y: Array, lam: Array) -> Array:
        """A of balance.py."""
        self.asked(t, y, lam, MATRIX)
        return self.record.A.copy()

    def inverse(self, A: Array) -> Array | None:
        """The inverse, rows of joints weighed like stiffnesses; None where there is none."""
        b = self.record
        b.A[:] = A
        return b.inverse.copy() if ask(self.work, b, 0.0, INVERSE) else None

    def solved(
        self, t: float, y: Array, lam: Array, inverse: Array | None
    ) -> tuple[Array, Array] | None:
        """y and lam in balance at t; None where it is not found."""
        b, known = self.record, 0
        b.y[:], b.lam[:], b.anchor[:] = y, lam, self.anchor
        if inverse is not None:
            b.inverse[:], known = inverse, 1
        return (b.y.copy(), b.lam.copy()) if solve(self.work, b, t, known) else None

    def passes_over(self, t0: float, t1: float, y: Array, lam: Array) -> bool:
        """Whether what is asked for goes much further between two times than at both; y, lam: of
        the second."""
        b = self.record
        b.y[:], b.lam[:], b.anchor[:] = y, lam, self.anchor
        return bool(passes_over(self.work, b, t0, t1))

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

    def lines_slide(self, y: Array) -> bool:
        """Whether seals rub in full all along at the velocities of y."""
        if not len(self.lines):
            return True
        w, at = self.work, self.lines
        poses(w, y)
        before = w.mem[at, BRANCH].copy()
        w.mem[at, BRANCH], w.corner[at, 1] = WHOLE, FULL
        corners(w, 0.0)
        w.mem[at, BRANCH] = before
        return bool(np.all(w.corner[at, 1] == FULL))

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

    def place(self, t: float, y: Array, lam: Array) -> Place | None:
        """What leads on from a balance: how it moves with t."""
        b, n = self.record, self.n
        if not self.asked(t, y, lam, LEAD):
            return None
        return Place(t, y, lam, b.A.copy(), b.inverse.copy(), b.x[:n].copy(), b.x[n:].copy(),
                     float(b.sign), self.anchor)  # fmt: skip

    def along_itself(self, place: Place, dt: float) -> Place:
        """A place with friction against its own velocities, not against its way in a time dt."""
        y, w = place.y.copy(), self.work
        y[w.n_q : w.n_q + self.n] = SLOW * dt * place.v
        with self.frozen():
            found = self.solved(place.t, y, place.lam, place.inverse)
            there = self.place(place.t, *found) if found is not None else None
        return there or place

    def forcing(self, t: float, y: Array, lam: Array) -> Array:
        """dg/dt at one place, and -Phi_t."""
        self.asked(t, y, lam, FORCING)
        return np.array(self.record.g)

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
