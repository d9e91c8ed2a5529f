"""The truth about a scene: read by rules of its own, integrated by engine.py, told as channels."""

from collections.abc import Callable, Iterator
from dataclasses import dataclass, field, replace
from typing import Any

import numpy as np
from scipy.interpolate import Akima1DInterpolator

from . import engine as e
from .grips import numbers_of
from .scene import (
    FORCE,
    LENGTH,
    MOMENT,
    NONE,
    SPEED,
    Bar,
    Bushing,
    Drive,
    Event,
    Fn,
    Limit,
    Load,
    Scene,
    Seal,
    Spring,
    Torsion,
    Touch,
    Wall,
    plus,
)
from .vectors import crossed

RATE, ACCELERATION, TURNING = (0, 0, -1), (1, 0, -2), (0, 0, -2)
ENERGY = (2, 1, -2)
KINDS = {
    "constant": e.CONSTANT, "sine": e.SINE, "cubic": e.CUBIC, "ramp": e.RAMP, "area": e.RAMP,
    "box": e.BOX, "tent": e.TENT, "bell": e.BELL, "table": e.TABLE, "pulses": e.PULSES,
}  # fmt: skip
LADDER = ((1e-12, 3e-11), (1e-10, 1e-9), (1e-9, 1e-8))  # rtol of the truth and beside it
PARTS = (1.0, 0.4, 0.12)  # of the time a row may be off by
LEAST_PIVOT = 1e-13
APART = 1e-7  # perturbation of the second run
ROOM = 20000  # ends of steps
CHANGES = 8  # of a run that is changed on the way
MARGIN = 1e-3  # of 1: nearer turning points are told as grazing


class Unfit(Exception):
    """The reference cannot judge this scene: it says why."""


@dataclass
class Stage:
    """What events have done so far."""

    released: set[str] = field(default_factory=set)
    locked: dict[str, float] = field(default_factory=dict)
    motion: dict[str, tuple[Fn, float, float]] = field(default_factory=dict)  # fn, since, offset


def basis(a: Any) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """A unit vector and two across it."""
    a = unit(a)
    u = crossed(a, np.eye(3)[np.argmin(np.abs(a))])
    u /= np.linalg.norm(u)
    return a, u, crossed(a, u)


def unit(a: Any) -> np.ndarray:
    a = np.asarray(a, float)
    return a / np.linalg.norm(a)


class Builder:
    """From a scene to the arrays of engine.py."""

    def __init__(self, scene: Scene, stage: Stage | None = None) -> None:
        self.s, self.stage = scene, stage or Stage()
        self.number = {"ground": 0} | {b.name: k + 1 for k, b in enumerate(scene.bodies)}
        self.centre = [np.zeros(3)] + [np.asarray(b.at, float) for b in scene.bodies]
        self.rows: list[tuple[list[int], list[float]]] = []
        self.of_row: list[str] = []
        self.forces: list[tuple[list[int], list[float]]] = []
        self.of_force: list[str] = []
        self.functions: list[tuple[list[int], list[float]]] = []
        self.tables: list[list[float]] = []
        self.watch: list[tuple[list[int], list[float]]] = []
        self.of_watch: list[Any] = []
        self.coordinates: list[tuple[list[int], list[float]]] = []
        self.coordinate: dict[str, int] = {}
        self.bristles: list[float] = []  # how far each bends at most
        self.reach: dict[str, set[str]] = {}
        for joint in scene.joints:
            self.add_coordinate(joint)
        for joint in scene.joints:
            if joint.name not in self.stage.released:
                self.add_joint(joint)
        for drive in scene.drives:
            self.add_drive(drive)
        for name, value in self.stage.locked.items():
            self.hold(name, value)
        for force in scene.forces:
            self.add_force(force)
        for joint in scene.joints:
            if joint.clearance is not None:
                self.add_clearance(joint)
        for event in scene.events:
            acts = event.end or event.release or event.lock or event.unlock or event.set
            self.add_watch(event, event.when, event.value, bool(acts), event.crosses)
        for section in scene.sections:
            if section.when is not None:
                self.add_watch(section, section.when, 0.0, False, section.crosses, section.rate)
        self.arrays = self.packed()

    def local(self, body: str, point: Any) -> list[float]:
        return [float(c) for c in np.asarray(point, float) - self.centre[self.number[body]]]

    def add_coordinate(self, joint: Any) -> None:
        if joint.type not in ("revolute", "prismatic"):
            return
        a = basis(joint.axis)[0]
        arms = self.local(joint.i, joint.at), self.local(joint.j, joint.at)
        kind = e.SLIDE if joint.slides else e.TURN
        self.coordinate[joint.name] = len(self.coordinates)
        i, j = self.number[joint.i], self.number[joint.j]
        self.coordinates.append(([kind, i, j], [*arms[0], *arms[1], *a, 0.0]))

    def row(self, name: str, kind: int, i: int, j: int, k: int, par: Any, g: int = -1) -> None:
        self.rows.append(([kind, i, j, k, g], [*par, *[0.0] * (10 - len(par))]))
        self.of_row.append(name)

    def add_joint(self, joint: Any) -> None:
        name, flat = joint.name, self.s.flat
        i, j = self.number[joint.i], self.number[joint.j]
        arms = (*self.local(joint.i, joint.at), *self.local(joint.j, joint.at))
        if joint.type == "prismatic":
            a, u, w = basis(joint.axis)
            if flat:
                z = np.array([0.0, 0.0, 1.0])
                u = np.cross(z, a)
                self.row(name, e.ALONG, i, j, 0, (*arms, *u))
                self.row(name, e.ACROSS, i, j, 0, (*u, *a))
                return
            for d in (u, w):
                self.row(name, e.ALONG, i, j, 0, (*arms, *d))
            for d, c in ((u, a), (w, a), (w, u)):
                self.row(name, e.ACROSS, i, j, 0, (*d, *c))
            return
        if joint.clearance is None:
            for k in range(2 if flat else 3):
                self.row(name, e.POINT, i, j, k, arms)
        if joint.type == "revolute":
            a, u, w = basis(joint.axis)
            if not flat:
                if joint.clearance is not None:
                    self.row(name, e.ALONG, i, j, 0, (*arms, *a))
                for d in (u, w):
                    self.row(name, e.ACROSS, i, j, 0, (*d, *a))
        elif joint.type == "universal":
            a, b = basis(joint.axis)[0], basis(joint.second_axis)[0]
            self.row(name, e.ACROSS, i, j, 0, (*a, *b))
        elif joint.type == "fixed":
            x, y, z = np.eye(3)
            for d, c in ((x, y),) if flat else ((x, y), (y, z), (z, x)):
                self.row(name, e.ACROSS, i, j, 0, (*d, *c))

    def function(self, fn: Fn, since: float = 0.0) -> int:
        of, p = -1, [*fn.p, *[0.0] * (5 - len(fn.p)), since]
        scale, shift = 1.0, 0.0
        if fn.of != "t":
            sensor = next(x for x in self.s.sensors if x.name == fn.of)
            of = self.coordinate[sensor.joint]
            scale, shift = float(sensor.sign), sensor.at_start
        first, a, b = len(self.watch), 0, 0
        values: list[float] = []
        if fn.kind == "box":
            values = [p[1], p[2]]
        elif fn.kind == "tent":
            values = [p[1] - p[2], p[1], p[1] + p[2]]
        elif fn.kind == "bell":  # smooth, but nothing to a step that begins and ends beside it
            values = [p[1] + k * p[2] for k in (-6.0, -2.0, 0.0, 2.0, 6.0)]
        elif fn.kind == "area":
            p[3] = 1.0
        elif fn.kind == "pulses":
            self.watch.append(([e.W_PULSE, of, 0, 0], [p[2], scale, shift, p[1]]))
            self.of_watch.append(None)
        elif fn.kind == "table":
            x, y = np.array(fn.points).T
            curve = Akima1DInterpolator(x, y)
            a, b = len(self.tables), len(self.tables) + len(x) - 1
            for k in range(len(x) - 1):
                self.tables.append([x[k], *curve.c[::-1, k]])
            p[0] = y[-1]
            values = list(x)
        # a sensor rises with its coordinate or falls: what is watched is the sensor
        for value in values:
            kind = e.W_TIME if of < 0 else e.W_PLACE
            self.watch.append(([kind, of, 0, 0], [value, scale, shift, 0.0]))
            self.of_watch.append(None)
        self.functions.append(([KINDS[fn.kind], of, first, a, b], p))
        return len(self.functions) - 1

    def add_drive(self, drive: Drive) -> None:
        fn, since, offset = self.stage.motion.get(drive.name, (drive.fn, 0.0, 0.0))
        g = self.function(fn, since)
        if drive.name in self.stage.released:
            return
        if drive.points is not None:
            names = drive.bodies or ("", "")
            arms = [c for b, p in zip(names, drive.points, strict=True) for c in self.local(b, p)]
            i, j = (self.number[b] for b in names)
            length = float(np.linalg.norm(drive.points[1] - drive.points[0]))
            if drive.k is None:
                par = (*arms, 0.0, 0.0, 0.0, length + offset)
                self.row(drive.name, e.DISTANCE, i, j, 0, par, g)
            else:
                par = (*arms, drive.k, drive.c, length + offset)
                self.force(drive.name, e.SOFT_LINE, i, j, -1, g, par)
            return
        k = self.coordinate[drive.joint or ""]
        (kind, i, j), par = self.coordinates[k]
        if drive.k is not None:
            self.force(drive.name, e.SOFT_DRIVE, i, j, k, g, (drive.k, drive.c, offset))
        elif not self.gone(drive.joint or ""):
            row = e.ALONG if kind == e.SLIDE else e.ANGLE
            self.row(drive.name, row, i, j, k, (*par[:9], offset), g)

    def beyond(self, joint: str) -> set[str]:
        """The bodies that go along where a joint of an open chain is moved."""
        if joint not in self.reach:
            found, grown = {self.s.joint(joint).j}, True
            while grown:
                more = {x.j for x in self.s.joints if x.i in found and x.name != joint} - found
                found, grown = found | more, bool(more)
            self.reach[joint] = found
        return self.reach[joint]

    def gone(self, joint: str) -> bool:
        """Whether a joint has no coordinate to hold: a hinge in space that is apart."""
        k = self.coordinate[joint]
        apart = joint in self.stage.released and not self.s.flat
        return apart and self.coordinates[k][0][0] == e.TURN

    def hold(self, joint: str, value: float) -> None:
        if self.gone(joint):
            return
        k = self.coordinate[joint]
        (kind, i, j), par = self.coordinates[k]
        g = self.function(Fn("constant", (value,)))
        row = e.ALONG if kind == e.SLIDE else e.ANGLE
        self.row(f"{joint}.lock", row, i, j, k, (*par[:9], 0.0), g)

    def force(
        self, name: str, kind: int, i: int, j: int, k: int, g: int, par: Any, w: int = -1
    ) -> None:
        self.forces.append(([kind, i, j, k, g, w], [*par, *[0.0] * (44 - len(par))]))
        self.of_force.append(name)

    def one_sided(self, name: str, kind: int, i: int, j: int, k: int, par: Any) -> None:
        self.watch.append(([e.W_GAP, len(self.forces), 0, 0], [0.0, 0.0, 0.0, 0.0]))
        self.of_watch.append(name)
        self.force(name, kind, i, j, k, -1, par, len(self.watch) - 1)
        if kind in (
            e.WALL,
            e.LIMIT,
        ):  # its kinks: where the damper is fully there, and where it pulls
            for corner in (e.W_RAMP, e.W_PUSH):
                self.watch.append(([corner, len(self.forces) - 1, 0, 0], [0.0] * 4))
                self.of_watch.append(None)

    def add_force(self, f: Any) -> None:
        n = self.number
        if isinstance(f, Load):
            at = self.centre[n[f.body]] if f.at is None else f.at
            i = 0 if f.frame == "world" else n[f.frame]
            kind = e.TORQUE if f.torque else e.FORCE
            scale, shift = 1.0, 0.0
            if f.fn.of != "t":
                sensor = next(x for x in self.s.sensors if x.name == f.fn.of)
                scale, shift = float(sensor.sign), sensor.at_start
            par = (*self.local(f.body, at), *basis(f.direction)[0], scale, shift)
            self.force(f.name, kind, i, n[f.body], -1, self.function(f.fn), par)
        elif isinstance(f, Spring):
            free = float(np.linalg.norm(f.p_j - f.p_i)) if f.free is None else f.free
            par = (*self.local(f.i, f.p_i), *self.local(f.j, f.p_j), f.k, f.c, free, f.preload)
            self.force(f.name, e.SPRING, n[f.i], n[f.j], -1, -1, par)
        elif isinstance(f, Torsion):
            k = self.coordinate[f.joint]
            self.force(f.name, e.TORSION, 0, 0, k, -1, (f.k, f.c, f.preload))
        elif isinstance(f, Bushing):
            arms = (*self.local(f.i, f.at), *self.local(f.j, f.at))
            par = (*arms, *np.asarray(f.axes).ravel(), *f.k, *f.c, *f.kr, *f.cr)
            self.force(f.name, e.BUSHING, n[f.i], n[f.j], -1, -1, par)
        elif isinstance(f, (Touch, Seal)):
            self.add_contact(f)
        elif isinstance(f, Wall):
            arms = (*self.local(f.i, f.wall), *self.local(f.j, f.point))
            par = (*arms, *basis(f.normal)[0], f.k, f.c, f.ramp)
            self.one_sided(f.name, e.WALL, n[f.i], n[f.j], -1, par)
        elif isinstance(f, Limit):
            k = self.coordinate[f.joint]
            for value, sign in ((f.lower, -1.0), (f.upper, 1.0)):
                if value is not None:
                    self.one_sided(f.name, e.LIMIT, 0, 0, k, (f.k, f.c, f.ramp, value, sign))

    def add_contact(self, f: Any) -> None:
        """Of a ball with a surface, or of a seal with a plane; and its kinks."""
        i, j = self.number[f.i], self.number[f.j]
        par, kinks, bent = numbers_of(self.s, f, len(self.tables), len(self.bristles))
        self.tables += [[*point, 0.0, 0.0, 0.0] for point in f.core()]
        self.bristles += [bent] * 2 if bent else []
        arms = (*self.local(f.i, f.at), *self.local(f.j, f.centre))
        kind = e.SEAL if isinstance(f, Seal) else e.TOUCH
        self.one_sided(f.name, kind, i, j, -1, (*arms, *par))
        for kink, value in kinks:
            self.watch.append(([kink, len(self.forces) - 1, 0, 0], [value, 0.0, 0.0, 0.0]))
            self.of_watch.append(None)

    def add_clearance(self, joint: Any) -> None:
        law = next(x for x in self.s.laws if x.name == joint.law)
        arms = (*self.local(joint.i, joint.at), *self.local(joint.j, joint.at))
        par = (*arms, *basis(joint.axis)[0], joint.clearance)
        par += (law.K, law.exponent, law.restitution, law.slowest)
        i, j = self.number[joint.i], self.number[joint.j]
        self.one_sided(joint.name, e.CLEARANCE, i, j, self.coordinate[joint.name], par)

    def add_watch(
        self, what: Any, when: str, value: float, ends: bool, crosses: str, rate: bool = False
    ) -> None:
        sense = {"up": 1, "down": -1, "both": 0}[crosses]
        if when == "t":
            self.watch.append(([e.W_TIME, -1, int(ends), sense], [value, 1.0, 0.0, 0.0]))
        else:
            sensor = next(x for x in self.s.sensors if x.name == when)
            k = self.coordinate[sensor.joint]
            scale, shift = float(sensor.sign), (0.0 if rate else sensor.at_start)
            kind = e.W_RATE if rate else e.W_PLACE
            self.watch.append(([kind, k, int(ends), sense], [value, scale, shift, 0.0]))
        self.of_watch.append(what)

    def packed(self) -> e.Arrays:
        def table(rows: list[Any], n: int, kind: Any) -> np.ndarray:
            return np.array(rows, kind).reshape(len(rows), n)

        inertia = np.array([np.eye(3)] + [b.inertia for b in self.s.bodies])
        inverse = np.array([np.zeros((3, 3))] + [np.linalg.inv(b.inertia) for b in self.s.bodies])
        return e.Arrays(
            np.array([0.0] + [1.0 / b.mass for b in self.s.bodies]),
            np.ascontiguousarray(inertia),
            np.ascontiguousarray(inverse),
            np.asarray(self.s.gravity, float),
            table([a for a, _ in self.rows], 5, np.int64),
            table([b for _, b in self.rows], 10, float),
            table([a for a, _ in self.coordinates], 3, np.int64),
            table([b for _, b in self.coordinates], 10, float),
            table([a for a, _ in self.forces], 6, np.int64),
            table([b for _, b in self.forces], 44, float),
            table([a for a, _ in self.functions], 5, np.int64),
            table([b for _, b in self.functions], 6, float),
            table(self.tables, 5, float),
            table([a for a, _ in self.watch], 4, np.int64),
            table([b for _, b in self.watch], 4, float),
        )


def start_state(b: Builder) -> np.ndarray:
    """As drawn, with the velocities that are given; joints at their initial values."""
    s, m = b.s, b.arrays
    y = np.zeros(13 * len(s.bodies) + len(b.coordinates) + len(b.bristles) + e.N_WORK)
    for k, body in enumerate(s.bodies):
        c = 13 * k
        y[c : c + 3], y[c + 3] = body.at, 1.0
        if body.velocity is not None:
            y[c + 7 : c + 10] = body.velocity
        if body.spin is not None:
            y[c + 10 : c + 13] = body.spin
    for name, value in s.initial.items():
        moved(b, y, name, value)
    for name, k in b.coordinate.items():
        if m.coordinate[k, 0] == e.TURN:
            y[13 * len(s.bodies) + k] = s.initial.get(name, 0.0)
    return y


def moved(b: Builder, y: np.ndarray, name: str, value: float) -> None:
    """Bring a joint of an open chain to a value: all beyond it goes along."""
    joint = b.s.joint(name)
    i = b.number[joint.i]
    R = e.rotations(y, len(b.centre))
    at = np.asarray(joint.at, float)
    origin = (y[13 * (i - 1) : 13 * (i - 1) + 3] + R[i] @ (at - b.centre[i])) if i else at
    a = R[i] @ unit(joint.axis)
    for body in b.beyond(name):
        c = 13 * (b.number[body] - 1)
        if joint.slides:
            y[c : c + 3] += value * a
            continue
        q = np.array([np.cos(value / 2), *(np.sin(value / 2) * a)])
        T = np.empty((3, 3))
        e.rotation((q[0], q[1], q[2], q[3]), T)
        y[c : c + 3] = origin + T @ (y[c : c + 3] - origin)
        p = y[c + 3 : c + 7].copy()
        y[c + 3] = q[0] * p[0] - q[1:] @ p[1:]
        y[c + 4 : c + 7] = q[0] * p[1:] + p[0] * q[1:] + crossed(q[1:], p[1:])


def independent(b: Builder, y: np.ndarray) -> list[int]:
    """Rows that do not depend on others here, by pivots of the weighted Jacobian."""
    m = b.arrays
    n = len(m.row)
    if n == 0:
        return []
    Ji, Jj = np.empty((n, 6)), np.empty((n, 6))
    three = [np.empty(n) for _ in range(3)]
    R = e.rotations(y, len(m.mass))
    r, v, w = e.places(y, len(m.mass))
    q, _ = e.coordinates(m, y, r, v, w, R)
    side = np.ones(max(1, len(m.watch)))
    e.rows(m, 0.0, side, r, v, w, R, q, Ji, Jj, *three)
    J = np.zeros((n, 6 * len(m.mass)))
    for a in range(n):
        i, j = m.row[a, 1], m.row[a, 2]
        J[a, 6 * i : 6 * i + 6] += Ji[a]
        J[a, 6 * j : 6 * j + 6] += Jj[a]
    J = J[:, 6:]
    kept: list[int] = []
    left, size = J.copy(), np.linalg.norm(J, axis=1)
    # prescribed rows first: their multipliers are compared
    for group in (m.row[:, 4] >= 0, m.row[:, 4] < 0):
        while True:
            far = np.where(group, np.linalg.norm(left, axis=1) / size, 0.0)
            far[kept] = 0.0
            a = int(np.argmax(far))
            if far[a] < 1e-8:
                break
            d = left[a] / np.linalg.norm(left[a])
            for _ in range(2):
                left -= np.outer(left @ d, d)
            kept.append(a)
    return sorted(kept)


def least_pivot(m: e.Arrays, y: np.ndarray, side: np.ndarray, mem: np.ndarray) -> float:
    yd, lam, told = np.zeros(len(y)), np.zeros(len(m.row)), np.zeros((len(m.force), 4))
    return float(e.derivative(m, 0.0, y, side, mem, yd, lam, told))


@dataclass
class Channel:
    values: np.ndarray  # (n_t, k), base units
    dims: tuple[int, ...]
    vector: bool  # turns with the scene
    kind: str  # what it is compared with: place, angle, speed, spin, force ...


@dataclass
class Smooth:
    """Channels where nothing changes its equations."""

    times: np.ndarray
    values: dict[str, np.ndarray]  # (n, k) each


@dataclass
class Crossing:
    name: str
    time: float
    sense: int
    rate: float  # of the sensor or gap
    depth: float  # least of how far it goes on either side
    values: dict[str, float]  # of sensors


@dataclass
class Truth:
    """Channels at the times of the rows, crossings, and how sure all is."""

    times: np.ndarray
    channels: dict[str, Channel]
    crossings: list[Crossing]
    grazing: list[tuple[str, float, float]]
    ended: float | None = None
    # times at which a contact in clearance opens for an instant or nearly so, and by how much
    openings: list[tuple[float, float]] = field(default_factory=list)
    until: float = np.inf  # nothing is judged from then on
    folded: bool = False  # a constant-velocity joint bends by nearly half a turn: no motion is true
    sure: np.ndarray = field(default_factory=lambda: np.zeros(0))  # at each row, of the scales
    growth: np.ndarray = field(default_factory=lambda: np.ones(0))  # of a small change at the start
    felt: dict[str, np.ndarray] = field(default_factory=dict)  # the same of every channel and row
    about: list[dict[str, Channel]] = field(default_factory=list)  # a little before and after
    steps: int = 0
    smooth: list[Smooth] | None = None  # between the rows, for extremes
    # the same of a run that began a little apart, made when it is asked for
    beside: Callable[[], list[Smooth] | None] = lambda: None
    # channels at any time, and as long before and after it as a row may be off by
    there: Callable[[float], dict[str, np.ndarray]] = lambda _: {}
    size: float = 1.0
    mass: float = 0.0  # of the lightest body
    gravity: float = 0.0
    end: float = 1.0
    top: dict[str, float] = field(default_factory=dict)  # of each kind of channel, see scales


def begun(b: Builder, m: e.Arrays, y: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Sides and memories at the start."""
    g = np.zeros(len(m.watch))
    e.watched(m, 0.0, y, g)
    g += 1e-300
    side = np.where(g > 0, 1.0, -1.0)
    mem = np.array([max(p[13], 1e-300) for p in m.force_par]) if len(m.force_par) else np.zeros(0)
    return side, mem


class Course:
    """One run of the reference."""

    def __init__(
        self, scene: Scene, times: np.ndarray, rtol: float, apart: float = 0.0, turn: float = 0.12,
        speeds: Any = 0.0, parts: int = 1, room: int = 0, begin: Any = None,
    ) -> None:  # fmt: skip
        """apart, speeds: a change of the start; parts: into which the run is cut by others;
        room: for ends of steps, which are kept for extremes; begin: time, state and stage, where
        that is not the start."""
        self.s, self.times = scene, times
        self.begin = begin
        self.stage = Stage() if begin is None else begin[2]
        self.parts: list[tuple[Builder, list[int], np.ndarray, Any]] = []
        self.crossings: list[tuple[Any, np.ndarray, float]] = []
        self.grazing: list[tuple[str, float, float]] = []
        self.openings: list[tuple[float, float]] = []
        self.ended: float | None = None
        self.steps, self.room = 0, room
        self.ends: list[tuple[Builder, list[int], Any]] = []
        self.go(rtol, apart, turn, speeds, parts)

    def go(self, rtol: float, apart: float, turn: float, speeds: Any, parts: int) -> None:
        b = Builder(self.s, self.stage)
        t, y = (
            (0.0, start_state(b)) if self.begin is None else (self.begin[0], self.begin[1].copy())
        )
        kept = independent(b, y)
        m = restricted(b.arrays, kept)
        side, mem = begun(b, m, y)
        for _ in range(2):
            e.projected(m, t, y, side)
        rng = np.random.default_rng(7)
        if apart:
            self.change(m, t, y, side, apart * speeds, rng)
        stops = sorted({-(-k * len(self.times) // parts) for k in range(1, parts + 1)})
        at, fired = 0, dict.fromkeys((v.name for v in self.s.events), 0)
        deep = np.zeros(len(m.watch))
        h_max = self.s.end / 40
        pivot = least_pivot(m, y, side, mem)
        redundant = len(kept) < len(b.rows)
        floor = 1e-2 * pivot if redundant else LEAST_PIVOT
        size = np.full(len(y), 0.1)
        size[13 * len(self.s.bodies) :] = 1.0
        size[len(y) - e.N_WORK - len(b.bristles) : len(y) - e.N_WORK] = b.bristles
        while True:
            found = e.march(
                m, t, y, side, mem, deep, self.times[at : stops[0]], h_max, turn, rtol, size, 20000,
                floor, self.room,
            )  # fmt: skip
            rows, crossed, grazed, opening, (t, n, status, steps, worst, _), y, ends = found
            self.ends.append((b, kept, ends))
            self.steps += steps
            if status in (e.STUCK, e.TOO_MANY) or (status == e.SINGULAR and floor == LEAST_PIVOT):
                raise Unfit(f"the reference stopped at {t:g} with {status}")
            if worst > 1e-6:
                raise Unfit(f"rows of the reference open by {worst:.1e}")
            self.parts.append((b, kept, np.arange(at, at + n), tuple(x[:n] for x in rows)))
            for line in crossed:
                self.crossings.append((b.of_watch[int(line[1])], line, int(line[1])))
            for line in grazed:
                what = b.of_watch[int(line[1])]
                if what is not None:
                    self.grazing.append((getattr(what, "name", what), line[0], line[2]))
            self.openings += [(line[0], line[2]) for line in opening]
            at += n
            if status == e.DONE:
                stops.pop(0)
                if not stops:
                    break
                self.change(m, t, y, side, apart * speeds, rng)
                continue
            if status == e.SINGULAR:  # other rows say the same, and better
                before = least_pivot(m, y, side, mem)
                kept = independent(b, y)
                m = restricted(b.arrays, kept)
                pivot = least_pivot(m, y, side, mem)
                floor = 1e-2 * pivot if pivot > 3 * before else LEAST_PIVOT
                continue
            event = b.of_watch[int(crossed[-1, 1])]
            fired[event.name] += 1
            if event.times is not None and fired[event.name] > event.times:
                continue
            if event.end:
                self.ended = t
                break
            self.act(b, event, t, y)
            b = Builder(self.s, self.stage)
            y = y.copy()
            kept = independent(b, y)
            m = restricted(b.arrays, kept)
            side = np.concatenate([side, np.ones(max(0, len(m.watch) - len(side)))])
            pivot = least_pivot(m, y, side, mem)
            floor = 1e-2 * pivot if len(kept) < len(b.rows) else LEAST_PIVOT
            e.projected(m, t, y, side)
            g = np.zeros(len(m.watch))
            e.watched(m, t, y, g)
            k = int(crossed[-1, 1])
            for c in range(len(g)):
                if c != k and g[c] * side[c] < 0:
                    side[c] = -side[c]
        self.deep = deep

    def change(self, m: Any, t: float, y: np.ndarray, side: np.ndarray, by: Any, rng: Any) -> None:
        """Change the speeds of all bodies a little, each to some side."""
        for k in range(len(self.s.bodies)):
            c = 13 * k + 7
            y[c : c + 6] += by * rng.uniform(-1, 1, 6) * self.in_plane()
        e.projected(m, t, y, side)

    def in_plane(self) -> np.ndarray:
        return np.array([1, 1, 0, 0, 0, 1.0]) if self.s.flat else np.ones(6)

    def act(self, b: Builder, event: Event, t: float, y: np.ndarray) -> None:
        stage, m = self.stage, b.arrays
        R = e.rotations(y, len(m.mass))
        r, v, w = e.places(y, len(m.mass))
        q, _ = e.coordinates(m, y, r, v, w, R)
        if event.set:
            name, fn, by_rate = event.set
            old, since, offset = stage.motion.get(
                name, (next(d.fn for d in self.s.drives if d.name == name), 0.0, 0.0)
            )
            one = Builder(replace(self.s, forces=[], joints=[], drives=[], events=[], sections=[]))
            g = one.function(old, since)
            at = float(e.evaluated(one.packed(), g, t, np.ones(9))[0]) + offset if by_rate else 0.0
            stage.motion[name] = (fn, t, at)
        stage.released |= set(event.release)
        for name in event.lock:
            stage.locked[name] = float(q[b.coordinate[name]])
        for name in event.unlock:
            stage.locked.pop(name, None)

    def smooth(self) -> list[Smooth] | None:
        """All channels at the ends of steps, a stretch between crossings each; None where there
        was no room for all."""
        found = []
        for b, kept, ends in self.ends:
            if len(ends[0]) == self.room:
                return None
            values = {name: c for name, c, *_ in told(self.s, b, kept, ends[0], ends[1:])}
            t, number = ends[0].T
            for k in np.unique(number):
                part = number == k
                found.append(Smooth(t[part], {name: c[part] for name, c in values.items()}))
        return found

    def channels(self) -> dict[str, Channel]:
        """All channels at the times, from the parts."""
        found: dict[str, Channel] = {}
        n = sum(len(rows) for _, _, rows, _ in self.parts)
        for part in self.parts:
            for name, values, dims, vector, kind in told(self.s, *part):
                if name not in found:
                    full = np.full((n, values.shape[1]), np.nan)
                    found[name] = Channel(full, dims, vector, kind)
                found[name].values[part[2]] = values
        return found


def restricted(m: e.Arrays, kept: list[int]) -> e.Arrays:
    return m._replace(
        row=np.ascontiguousarray(m.row[kept]), row_par=np.ascontiguousarray(m.row_par[kept])
    )


def told(
    s: Scene, b: Builder, kept: list[int], _: np.ndarray, rows: Any
) -> Iterator[tuple[str, np.ndarray, tuple[int, ...], bool, str]]:
    """Channels of one part: name, values, dimension, whether it turns, what it is."""
    Y, YD, LAM, F = rows
    n, n_b = len(Y), len(s.bodies)
    if n == 0:
        return
    R = np.array([e.rotations(y, n_b + 1) for y in Y])
    for k, body in enumerate(s.bodies):
        c = 13 * k
        yield f"{body.name}.position", Y[:, c : c + 3], LENGTH, True, "place"
        yield f"{body.name}.velocity", Y[:, c + 7 : c + 10], SPEED, True, "speed"
        yield f"{body.name}.angular_velocity", Y[:, c + 10 : c + 13], RATE, True, "spin"
        yield f"{body.name}.acceleration", YD[:, c + 7 : c + 10], ACCELERATION, True, "gain"
        yield (
            f"{body.name}.angular_acceleration", YD[:, c + 10 : c + 13], TURNING, True, "twist",
        )  # fmt: skip
        yield f"{body.name}.rotation", R[:, k + 1].reshape(n, 9), NONE, False, "matrix"
    m = b.arrays
    Q = np.empty((n, 2, len(m.coordinate)))
    for k, y in enumerate(Y):
        r, v, w = e.places(y, n_b + 1)
        Q[k] = e.coordinates(m, y, r, v, w, R[k])
    for x in s.sensors:
        k, dims = b.coordinate[x.joint], s.of_joint(x.joint)
        slides = dims == LENGTH
        value = x.sign * Q[:, :1, k] + x.at_start
        yield x.name, value, dims, False, "place" if slides else "angle"
        rate = x.sign * Q[:, 1:, k]
        yield f"{x.name}.rate", rate, plus(dims, RATE), False, "speed" if slides else "spin"
    full = np.zeros((n, len(m.row)))
    full[:, kept] = LAM
    complete = len(kept) == len(m.row)
    for joint in s.joints:
        force, moment = np.zeros((n, 3)), np.zeros((n, 3))
        for a, name in enumerate(b.of_row):
            if name == joint.name:
                one, other = reaction(m, a, R, full[:, a])
                force += one
                moment += other
        if complete:
            yield f"{joint.name}.reaction", force, FORCE, True, "force"
            if joint.type != "spherical" and not s.flat:
                yield f"{joint.name}.reaction_moment", moment, MOMENT, True, "moment"
    for drive in s.drives:
        dims = LENGTH if drive.points is not None else s.of_joint(drive.joint or "")
        unit, kind = (FORCE, "force") if dims == LENGTH else (MOMENT, "moment")
        if drive.name in b.of_row:
            yield f"{drive.name}.force", full[:, [b.of_row.index(drive.name)]], unit, False, kind
        elif drive.name in b.of_force:
            sign = -1.0 if drive.points is not None else 1.0
            value = sign * F[:, b.of_force.index(drive.name), :1]
            yield f"{drive.name}.force", value, unit, False, kind
        else:
            yield f"{drive.name}.force", np.zeros((n, 1)), unit, False, kind
    for f in s.forces:
        if isinstance(f, Load):
            unit, kind = (MOMENT, "moment") if f.torque else (FORCE, "force")
            yield f"{f.name}.load", F[:, b.of_force.index(f.name), 1:], unit, True, kind
        elif isinstance(f, (Wall, Limit)):
            which = [k for k, name in enumerate(b.of_force) if name == f.name]
            turns = isinstance(f, Limit) and s.of_joint(f.joint) == NONE
            unit, kind = (MOMENT, "moment") if turns else (FORCE, "force")
            value = F[:, which, 0].sum(axis=1)[:, None]
            yield f"{f.name}.normal_force", value, unit, False, kind
    for f in s.forces:
        if isinstance(f, (Touch, Seal)):
            yield from of_contact(b, b.of_force.index(f.name), f, Y, F, R)
    for joint in s.joints:
        if joint.clearance is not None:
            value = F[:, b.of_force.index(joint.name), :1]
            yield f"{joint.name}.normal_force", value, FORCE, False, "force"
    work = Y[:, -e.N_WORK :]
    yield "energy.work.loads", work[:, [e.LOADS]], ENERGY, False, "energy"
    yield "energy.work.drives", work[:, [e.DRIVES]], ENERGY, False, "energy"
    yield "energy.work.dampers", -work[:, [e.DAMPERS]], ENERGY, False, "energy"
    yield "energy.work.impacts", -work[:, [e.IMPACTS]], ENERGY, False, "energy"
    yield "energy.work.friction", -work[:, [e.FRICTION]], ENERGY, False, "energy"
    kinetic = np.zeros((n, 1))
    for k, body in enumerate(s.bodies):
        v, w = Y[:, 13 * k + 7 : 13 * k + 10], Y[:, 13 * k + 10 : 13 * k + 13]
        local = np.einsum("nji,nj->ni", R[:, k + 1], w)
        kinetic[:, 0] += 0.5 * body.mass * np.sum(v * v, axis=1)
        kinetic[:, 0] += 0.5 * np.einsum("ni,ij,nj->n", local, body.inertia, local)
    yield "energy.kinetic", kinetic, ENERGY, False, "energy"


def of_contact(b: Builder, k: int, f: Any, Y: Any, F: Any, R: Any) -> Iterator[Any]:
    """Channels of a contact with a surface, or of a seal."""
    m, name = b.arrays, f.name
    yield f"{name}.normal_force", F[:, k, :1], FORCE, False, "force"
    yield f"{name}.force", F[:, k, 1:], FORCE, True, "force"
    none = np.zeros(0)
    depth, n = np.empty((len(Y), 2)), np.empty((len(Y), 3))
    for row, y in enumerate(Y):
        r, v, w = e.places(y, len(m.mass))
        *depth[row], n[row] = e.gap(m, k, r, v, w, R[row], none, none)
    if isinstance(f, Seal):
        yield f"{name}.compression", depth[:, :1], LENGTH, False, "place"
    else:
        yield f"{name}.penetration", depth[:, :1], LENGTH, False, "place"
        yield f"{name}.penetration_rate", depth[:, 1:], SPEED, False, "speed"
    across = F[:, k, 1:] - np.sum(F[:, k, 1:] * n, axis=1)[:, None] * n
    rub = np.linalg.norm(across, axis=1)[:, None]
    rub[rub < 1e-13 * F[:, k, :1]] = 0.0
    yield f"{name}.friction_force", rub, FORCE, False, "force"


def reaction(m: e.Arrays, a: int, R: Any, lam: Any) -> tuple[np.ndarray, np.ndarray]:
    """Force and moment of one row on its second body, at its point."""
    kind, i, j, k, _ = m.row[a]
    p, none = m.row_par[a], np.zeros((len(lam), 3))
    if kind == e.POINT:
        return lam[:, None] * np.eye(3)[k], none
    if kind == e.ALONG:
        return lam[:, None] * (R[:, i] @ p[6:9]), none
    return none, -lam[:, None] * np.cross(R[:, i] @ p[0:3], R[:, j] @ p[3:6])


def truth(scene: Scene, bound: float) -> Truth:
    """What is true of a scene, as tight as its inertias let accelerations be above rounding."""
    for tight, loose in LADDER[:-1]:
        try:
            return truth_at(scene, bound, tight, loose)
        except Unfit:
            pass
    return truth_at(scene, bound, *LADDER[-1])


def truth_at(scene: Scene, bound: float, tight: float, loose: float, begin: Any = None) -> Truth:
    """At the rows and, by what `bound` means in time, before and after each.

    begin: time, state and stage where that is not the start.
    """
    rows = np.arange(scene.rows + 1) * scene.end / scene.rows
    first = 0.0 if begin is None else begin[0]
    rows = rows[rows >= first]
    other = Course(scene, rows, loose, turn=0.19, begin=begin)
    g = float(np.linalg.norm(scene.gravity))
    rough = Truth(rows, other.channels(), [], [], size=size(scene), mass=lightest(scene), gravity=g)
    top = scales(rough)
    dt = min(0.3 * scene.end / scene.rows, bound * min(scene.end, rough.size / top["speed"]))
    dt = max(dt, 1e-9 * scene.end)
    shifts = [sign * part * dt for part in PARTS for sign in (-1, 1)]
    every = [np.clip(rows + x, first, scene.end) for x in shifts]
    times = np.unique(np.concatenate([rows, *every]))
    main = Course(scene, times, tight, room=ROOM, begin=begin)
    apart = Course(
        scene, rows, loose, apart=APART, speeds=np.repeat([top["speed"], top["spin"]], 3),
        room=ROOM, begin=begin,
    )  # fmt: skip
    all_of = main.channels()
    n = sum(len(part[2]) for part in main.parts)

    def picked(wanted: np.ndarray) -> dict[str, Channel]:
        k = np.minimum(np.searchsorted(times, wanted - 1e-12 * scene.end), n - 1)
        return {x: replace(c, values=c.values[k]) for x, c in all_of.items()}

    kept = rows if main.ended is None else rows[rows <= main.ended]
    t = Truth(kept, picked(kept), [], main.grazing, main.ended, steps=main.steps)
    t.about = [picked(np.clip(kept + x, first, scene.end)) for x in shifts]
    t.size, t.mass, t.gravity, t.end = rough.size, rough.mass, g, scene.end
    t.smooth, t.beside = main.smooth(), apart.smooth
    t.top = scales(replace(t, channels=all_of))
    t.sure, t.growth = spread(t, other, 1.0), spread(t, apart, APART)
    t.felt = felt(t, apart, APART)
    t.crossings = list(listed(scene, main))
    t.openings = main.openings

    def there(when: float) -> dict[str, np.ndarray]:
        wanted = np.clip([when, *(when + x for x in shifts)], first, scene.end)
        every = np.unique(np.concatenate([rows, wanted]))
        found = Course(scene, every, tight, begin=begin).channels()
        k = np.searchsorted(every, wanted)
        return {name: c.values[k[k < len(c.values)]] for name, c in found.items()}

    t.there = there
    return t


def growth_of_later(scene: Scene, t: Truth) -> np.ndarray:
    """What small changes grow by that are made on the way as well, (n), never less than t.growth.

    A mechanism that starts slowly next to where it could stand still, and comes by there again, has
    forgotten little changes of its start, but not those made while it was fast.
    """
    for _, loose in LADDER:
        try:
            apart = Course(
                scene, t.times, loose, apart=APART,
                speeds=np.repeat([t.top["speed"], t.top["spin"]], 3), parts=CHANGES,
            )  # fmt: skip
            return np.fmax(t.growth, spread(t, apart, APART))
        except Unfit:
            pass
    return t.growth


def size(scene: Scene) -> float:
    """Of the mechanism: the longest distance of two of its points, or how far its mass reaches."""
    bars = [b for b in scene.bodies if isinstance(b, Bar)]
    bodies = [b for b in scene.bodies if not isinstance(b, Bar)]
    points = [b.at for b in bodies] + [j.at for j in scene.joints]
    points += [p for b in bars for p in (b.start, b.end)]
    at = np.array(points, float)
    far = float(np.linalg.norm(at[:, None] - at[None], axis=2).max())
    reach = max(float(np.sqrt(np.trace(b.inertia) / 2 / b.mass)) for b in bodies) if bodies else 0.0
    return max(far, reach)


def lightest(scene: Scene) -> float:
    return min(b.mass for b in scene.bodies)


def spread(t: Truth, other: Course, by: float) -> np.ndarray:
    """How far another run is from the truth at every row so far, over scales, over `by`."""
    channels = other.channels()
    sizes = t.top
    n = len(t.times)
    worst = np.zeros(n)
    for name, c in t.channels.items():
        if c.kind not in ("place", "speed", "spin", "angle", "matrix") or name not in channels:
            continue
        values = channels[name].values[:n]
        k = min(len(values), n)
        d = np.abs(values[:k] - c.values[:k]).max(axis=1, initial=0.0) / sizes[c.kind]
        worst[:k] = np.fmax(worst[:k], d)
        worst[k:] = np.inf
    return np.maximum.accumulate(worst) / by


def felt(t: Truth, other: Course, by: float) -> dict[str, np.ndarray]:
    """How far another run is from every channel at every row, over `by`; 0 where it has ended."""
    out = {}
    for name, c in other.channels().items():
        if name not in t.channels:
            continue
        want = t.channels[name].values
        k = min(len(c.values), len(want))
        out[name] = np.zeros_like(want)
        out[name][:k] = np.nan_to_num(np.abs(c.values[:k] - want[:k]) / by)
    return out


def scales(t: Truth) -> dict[str, float]:
    """The largest of each kind in the whole scene: what an error is relative to.

    Of speeds between the rows too (starts 2652043375 is at rest again by its second row); not of
    forces, which in a touch between rows are far larger than what rows have.
    """
    top: dict[str, float] = {}
    for name, c in t.channels.items():
        value = float(np.nanmax(np.abs(c.values), initial=0.0))
        if c.kind in ("speed", "spin"):
            for part in t.smooth or ():
                if name in part.values:
                    value = max(value, float(np.nanmax(np.abs(part.values[name]), initial=0.0)))
        if c.kind == "place" and c.vector:
            value = float(np.nanmax(np.abs(c.values - c.values[0]), initial=0.0))
        top[c.kind] = max(top.get(c.kind, 0.0), value)
    size, mass, g = t.size, t.mass, t.gravity
    v = max(top.get("speed", 0.0), top.get("spin", 0.0) * size, 1e-9)
    if v < 1e-6 * np.sqrt(g * size):  # at rest: what is next to nothing beside a fall
        v = float(np.sqrt(g * size))
    gain = max(top.get("gain", 0.0), top.get("twist", 0.0) * size, v * v / size)
    force = max(top.get("force", 0.0), top.get("moment", 0.0) / size, mass * gain)
    return {
        "place": max(top.get("place", 0.0), size),
        "speed": v,
        "spin": max(top.get("spin", 0.0), v / size),
        "angle": max(1.0, top.get("angle", 0.0)),
        "matrix": 1.0,
        "gain": gain,
        "twist": max(top.get("twist", 0.0), gain / size),
        "force": force,
        "moment": force * size,
        "energy": max(top.get("energy", 0.0), 1e-2 * mass * max(v * v, g * size)),
    }


def listed(scene: Scene, course: Course) -> Iterator[Crossing]:
    """Crossings of what the scene names, in time, with how far each goes on either side."""
    for k, (what, line, number) in enumerate(course.crossings):
        if what is None:
            continue
        after = next((one[4] for _, one, w in course.crossings[k + 1 :] if w == number), None)
        after = course.deep[number] if after is None else after
        n = (len(line) - 5) // 2
        builder = course.parts[0][0]
        values = {}
        for x in scene.sensors:
            c = builder.coordinate[x.joint]
            values[x.name] = x.sign * line[5 + c] + x.at_start
            values[f"{x.name}.rate"] = x.sign * line[5 + n + c]
        yield Crossing(
            getattr(what, "name", what), line[0], int(line[3]), line[2],
            min(line[4], after), values,
        )  # fmt: skip
