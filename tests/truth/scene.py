"""A scene in units near one and in the axes it was thought in; its text in any others.

The text is written with lengths, masses and times of another scale and with everything turned, so
that trsim sees numbers of any size and axes of any direction while the truth is computed once.
Dimensions are exponents (length, mass, time).
"""

from dataclasses import dataclass, field
from typing import Any

import numpy as np
import yaml

MANY = 240  # places of an ellipse that is written as a spline
FORCE, MOMENT = (1, 1, -2), (2, 1, -2)
NONE, LENGTH, SPEED = (0, 0, 0), (1, 0, 0), (1, 0, -1)
PLANE = np.diag([1.0, 1.0, 1.0])


@dataclass
class Fn:
    """A function of t or of a sensor: what it is, its numbers, what it depends on.

    constant p0;  sine p0 + p1 sin(p2 x + p3) + p4 x;  cubic p0 + p1 x + p2 x^2 + p3 x^3;
    ramp p0 smoothstep((x - p1)/p2);  box p0 between p1 and p2;  tent p0 max(0, 1 - |x - p1|/p2);
    bell p0 exp(-((x - p1)/p2)^2);  table (Akima) through points;  pulses p0 where sin(p1 x) > p2
    """

    kind: str
    p: tuple[float, ...] = ()
    of: str = "t"
    points: list[tuple[float, float]] = field(default_factory=list)
    style: int = 0  # how it is written

    def scaled(self, f: float, s: float) -> "Fn":
        """The same with values times f and arguments times s."""
        p = self.p
        if self.kind == "constant":
            q: tuple[float, ...] = (p[0] * f,)
        elif self.kind == "sine":
            q = (p[0] * f, p[1] * f, p[2] / s, p[3], p[4] * f / s)
        elif self.kind == "cubic":
            q = tuple(c * f / s**k for k, c in enumerate(p))
        elif self.kind in ("ramp", "tent", "bell", "box"):
            q = (p[0] * f, p[1] * s, p[2] * s)
        elif self.kind == "pulses":
            q = (p[0] * f, p[1] / s, p[2])
        else:
            q = ()
        return Fn(self.kind, q, self.of, [(x * s, y * f) for x, y in self.points], self.style)

    def text(self) -> Any:
        """As it is written in a scenario."""
        p, x = [repr(float(c)) for c in self.p], self.of
        if self.kind == "constant":
            return float(self.p[0])
        if self.kind == "sine":
            return f"({p[0]}) + ({p[1]})*sin(({p[2]})*{x} + ({p[3]})) + ({p[4]})*{x}"
        if self.kind == "cubic":
            return f"({p[0]}) + {x}*(({p[1]}) + {x}*(({p[2]}) + {x}*({p[3]})))"
        if self.kind == "ramp":
            if self.style == 1:
                end = repr(self.p[1] + self.p[2])
                return f"step({x}, {p[1]}, 0, {end}, {p[0]})"
            return f"({p[0]})*smoothstep(({x} - ({p[1]}))/({p[2]}))"
        if self.kind == "box":
            if self.style == 1:
                return f"({p[0]})*(({x} - ({p[1]}))*(({p[2]}) - {x}) > 0)"
            return f"({p[0]})*({x} > {p[1]})*({x} < {p[2]})"
        if self.kind == "tent":
            return f"({p[0]})*max(0, 1 - abs({x} - ({p[1]}))/({p[2]}))"
        if self.kind == "bell":
            return f"({p[0]})*exp(-(({x} - ({p[1]}))/({p[2]}))**2)"
        if self.kind == "pulses":
            return f"({p[0]})*(sin(({p[1]})*{x}) > {p[2]})"
        return {"table": [[float(a), float(b)] for a, b in self.points], "of": x, "ends": "hold"}

    def rate(self) -> "Fn":
        """Its derivative, of what a drive may follow."""
        p = self.p
        if self.kind == "constant":
            return Fn("constant", (0.0,))
        if self.kind == "sine":
            return Fn("sine", (p[4], p[1] * p[2], p[2], p[3] + np.pi / 2, 0.0))
        if self.kind == "cubic":
            return Fn("cubic", (p[1], 2 * p[2], 3 * p[3], 0.0))
        if self.kind == "area":
            return Fn("ramp", p, style=self.style)
        raise ValueError(self.kind)


@dataclass
class Body:
    name: str
    mass: float
    inertia: np.ndarray  # (3, 3)
    at: np.ndarray
    velocity: np.ndarray | None = None
    spin: np.ndarray | None = None


@dataclass
class Bar:
    """A flexible bar, round."""

    name: str
    start: np.ndarray
    end: np.ndarray
    elements: int
    E: float
    density: float
    diameter: float


@dataclass
class Joint:
    name: str
    type: str
    i: str
    j: str
    at: np.ndarray
    axis: np.ndarray | None = None
    second_axis: np.ndarray | None = None
    clearance: float | None = None
    law: str | None = None
    x_axis: np.ndarray | None = None
    pitch: float | None = None  # of a screw
    points: tuple[np.ndarray, np.ndarray] | None = None  # ends of a link

    @property
    def slides(self) -> bool:
        return self.type == "prismatic"


@dataclass
class Gear:
    """A relation of coordinates of joints."""

    name: str
    type: str
    joints: tuple[str, ...]
    teeth: tuple[int, int] | None = None
    radii: tuple[float, float] | None = None
    radius: float | None = None
    ratio: float | None = None
    coefficients: tuple[float, ...] | None = None
    internal: bool = False
    hand: str | None = None
    # where both parts have one speed against their carrier, along `way`; not written
    touch: np.ndarray | None = None
    way: np.ndarray | None = None


@dataclass
class Drive:
    """Of a joint; of a line between two points where `points` are given."""

    name: str
    joint: str | None
    fn: Fn  # prescribed coordinate, 0 at t = 0 where its rate is written
    by_rate: bool = False
    k: float | None = None
    c: float = 0.0
    bodies: tuple[str, str] | None = None
    points: tuple[np.ndarray, np.ndarray] | None = None


@dataclass
class Sensor:
    name: str
    joint: str
    sign: int = 1
    at_start: float = 0.0


@dataclass
class Load:
    name: str
    body: str
    direction: np.ndarray
    fn: Fn
    frame: str = "world"
    at: np.ndarray | None = None
    torque: bool = False


@dataclass
class Spring:
    name: str
    i: str
    j: str
    p_i: np.ndarray
    p_j: np.ndarray
    k: float
    c: float = 0.0
    free: float | None = None
    preload: float = 0.0


@dataclass
class Torsion:
    name: str
    joint: str
    k: float
    c: float = 0.0
    preload: float = 0.0


@dataclass
class Bushing:
    name: str
    i: str
    j: str
    at: np.ndarray
    axes: np.ndarray  # (3, 3) rows
    k: np.ndarray
    c: np.ndarray
    kr: np.ndarray
    cr: np.ndarray


@dataclass
class Wall:
    name: str
    i: str  # has the wall
    j: str  # has the point
    wall: np.ndarray
    point: np.ndarray
    normal: np.ndarray
    k: float
    c: float = 0.0
    ramp: float = 1e-4


@dataclass
class Limit:
    name: str
    joint: str
    lower: float | None
    upper: float | None
    k: float
    c: float = 0.0
    ramp: float = 1e-4


@dataclass
class Touch:
    """A ball of body j that meets a surface of body i."""

    name: str
    i: str
    j: str
    at: np.ndarray  # origin of the surface
    axes: np.ndarray  # (3, 3) rows x, y, z of the surface
    centre: np.ndarray
    ball: float
    law: str
    shape: str = "plane"  # sphere, cylinder, polygon, line, ellipse
    radius: float = 0.0  # of a sphere or a cylinder, of the corners of a polygon
    other: tuple[float, float] = (0.0, 0.0)  # half axes of an ellipse
    points: list[tuple[float, float]] = field(default_factory=list)  # corners
    hollow: bool = False
    rolling: float = 0.0
    spinning: float = 0.0

    def core(self) -> list[tuple[float, float]]:
        """Corners of a polygon whose sides are moved inwards by the radius; places of a line."""
        if self.shape != "polygon":
            return self.points
        p = np.array(self.points)
        ahead = np.roll(p, -1, axis=0) - p
        ahead /= np.linalg.norm(ahead, axis=1)[:, None]
        behind = np.roll(ahead, 1, axis=0)
        sine = behind[:, 0] * ahead[:, 1] - behind[:, 1] * ahead[:, 0]
        # anticlockwise: inwards is to the left of each side
        inner = p + (self.radius / sine)[:, None] * (ahead - behind)
        return [(float(x), float(y)) for x, y in inner]


@dataclass
class Seal:
    """A strip of body j along a line, pressed against a plane of body i."""

    name: str
    i: str
    j: str
    at: np.ndarray  # a place of the plane
    normal: np.ndarray
    centre: np.ndarray  # where the line begins
    last: np.ndarray  # and where it ends
    height: float
    load: float
    depth: float
    exponent: float
    damping: float = 0.0
    friction: float = 0.0
    full: float = 1e-3
    springs: int | None = None

    def core(self) -> list[tuple[float, float]]:
        return []


@dataclass
class Grip:
    """Of the law of a contact with a surface: what is lost and what rubs."""

    name: str
    K: float
    exponent: float
    normal: str = "impact"
    restitution: float = 1.0
    damping: float = 0.0
    ramp: float = 0.0
    slowest: float = 1e-6
    friction: str = "none"  # modified_coulomb, sticking
    mu: float = 0.0
    v0: float = 0.0
    v1: float = 1.0
    mu_s: float = 0.0
    v_s: float = 1.0
    sigma0: float = 0.0
    sigma1: float = 0.0


@dataclass
class Law:
    name: str
    K: float
    exponent: float
    restitution: float
    radius: float
    slowest: float = 1e-6


@dataclass
class Event:
    """At what, and what is done: record, end, release, lock, unlock, set (a drive, a function)."""

    name: str
    when: str
    value: float
    crosses: str = "both"
    times: int | None = None
    record: bool = False
    end: bool = False
    release: tuple[str, ...] = ()
    lock: tuple[str, ...] = ()
    unlock: tuple[str, ...] = ()
    set: tuple[str, Fn, bool] | None = None


@dataclass
class Section:
    """Where a sensor or its rate passes zero; `every` is stroboscopic."""

    name: str
    when: str | None
    crosses: str
    plot: tuple[str, str]
    rate: bool = False
    every: float | None = None
    after: float = 0.0


@dataclass
class Scene:
    """All of it, in units near one."""

    end: float
    rows: int = 24
    bodies: list[Body] = field(default_factory=list)
    joints: list[Joint] = field(default_factory=list)
    gears: list[Gear] = field(default_factory=list)
    drives: list[Drive] = field(default_factory=list)
    sensors: list[Sensor] = field(default_factory=list)
    forces: list[Any] = field(default_factory=list)
    laws: list[Any] = field(default_factory=list)
    events: list[Event] = field(default_factory=list)
    sections: list[Section] = field(default_factory=list)
    gravity: np.ndarray = field(default_factory=lambda: np.zeros(3))
    flat: bool = False  # everything is and stays in the x-y plane
    planar: bool | None = None  # what the text says of it
    method: str = "auto"
    tolerance: float = 1e-6
    step: float | None = None
    rates: tuple[float, float] | None = None  # alpha and beta of Baumgarte's stabilisation, 1/s
    settings: dict[str, Any] = field(default_factory=dict)
    initial: dict[str, float] = field(default_factory=dict)
    scale: tuple[float, float, float] = (1.0, 1.0, 1.0)
    turned: np.ndarray = field(default_factory=lambda: np.eye(3))
    moved: np.ndarray = field(default_factory=lambda: np.zeros(3))
    extra: dict[str, Any] = field(default_factory=dict)  # of the text, as it is written
    note: str = ""

    def body(self, name: str) -> Body:
        return next(b for b in self.bodies if b.name == name)

    def joint(self, name: str) -> Joint:
        return next(j for j in self.joints if j.name == name)

    def unit(self, dims: tuple[int, int, int]) -> float:
        """What a number of this dimension is multiplied by in the text."""
        return float(np.prod([s**d for s, d in zip(self.scale, dims, strict=False)]))

    def of_joint(self, name: str) -> tuple[int, int, int]:
        """Dimension of a joint's coordinate, by the name of the joint or its own."""
        joint, _, own = name.partition(".")
        if own:
            return NONE if own == "angle" else LENGTH
        return LENGTH if self.joint(joint).slides else NONE

    def of_sensor(self, name: str) -> tuple[int, int, int]:
        if name == "t":
            return (0, 0, 1)
        return self.of_joint(next(s.joint for s in self.sensors if s.name == name))

    def document(self) -> dict[str, Any]:
        """The scenario as a mapping."""
        return Writer(self).document()

    def text(self) -> str:
        """The scenario as it is written."""
        note = "".join(f"# {line}\n" for line in self.note.splitlines())
        return note + yaml.safe_dump(self.document(), sort_keys=False, default_flow_style=None)


def plus(a: tuple[int, ...], b: tuple[int, ...]) -> tuple[int, ...]:
    return tuple(p + q for p, q in zip(a, b, strict=True))


class Writer:
    """From a scene to the mapping that trsim reads."""

    def __init__(self, scene: Scene) -> None:
        self.s = scene

    def n(self, value: float, *dims: int) -> float:
        return float(value) * self.s.unit(dims)

    def vector(self, v: Any, *dims: int) -> list[float]:
        return [float(c) for c in self.s.turned @ np.asarray(v, float) * self.s.unit(dims)]

    def point(self, v: Any) -> list[float]:
        return self.vector(np.asarray(v, float) + self.s.moved, *LENGTH)

    def fn(self, fn: Fn, dims: tuple[int, ...]) -> Any:
        return fn.scaled(self.s.unit(dims), self.s.unit(self.s.of_sensor(fn.of))).text()

    def document(self) -> dict[str, Any]:
        s = self.s
        d: dict[str, Any] = {}
        if s.planar is not None:
            d["planar"] = s.planar
        if np.any(s.gravity):
            d["gravity"] = self.vector(s.gravity, 1, 0, -2)
        d["bodies"] = {b.name: self.body(b) for b in s.bodies}
        for key, members, write in (
            ("joints", s.joints, self.joint),
            ("drives", s.drives, self.drive),
            ("sensors", s.sensors, self.sensor),
            ("forces", s.forces, self.force),
            ("contact_laws", s.laws, self.law),
            ("events", s.events, self.event),
            ("poincare", s.sections, self.section),
        ):
            if members:
                d[key] = {member.name: write(member) for member in members}
        for gear in s.gears:
            d["joints"][gear.name] = self.gear(gear)
        if s.initial:
            d["initial"] = {k: self.n(v, *s.of_joint(k)) for k, v in s.initial.items()}
        solver: dict[str, Any] = {"method": s.method, "end": self.n(s.end, 0, 0, 1)}
        if s.step is not None:
            solver["step"] = self.n(s.step, 0, 0, 1)
        else:
            solver["tolerance"] = s.tolerance
        if s.rates is not None:
            alpha, beta = (self.n(rate, 0, 0, -1) for rate in s.rates)
            solver["stabilisation"] = "baumgarte"
            solver["baumgarte"] = {"alpha": alpha, "beta": beta}
        for key, value in s.settings.items():
            timed = key in ("max_step", "first_step")
            solver[key] = self.n(value, 0, 0, 1) if timed else value
        d["solver"] = solver
        turns = ["*.rotation"] if any(isinstance(b, Body) for b in s.bodies) else []
        d["output"] = {"every": self.n(s.end, 0, 0, 1) / s.rows, "channels": ["*", *turns]}
        for key, value in s.extra.items():
            d[key] = {**d[key], **value} if isinstance(d.get(key), dict) else value
        return d

    def bar(self, b: Bar) -> dict[str, Any]:
        return {
            "type": "ancf_cable",
            "start": self.point(b.start),
            "end": self.point(b.end),
            "elements": b.elements,
            "section": {"diameter": self.n(b.diameter, *LENGTH)},
            "youngs_modulus": self.n(b.E, -1, 1, -2),
            "density": self.n(b.density, -3, 1, 0),
        }

    def body(self, b: Any) -> dict[str, Any]:
        if isinstance(b, Bar):
            return self.bar(b)
        I = self.s.turned @ b.inertia @ self.s.turned.T * self.s.unit((2, 1, 0))
        six = [I[0, 0], I[1, 1], I[2, 2], I[0, 1], I[0, 2], I[1, 2]]
        straight = max(abs(c) for c in six[3:]) < 1e-15 * max(six[:3])
        d: dict[str, Any] = {
            "mass": self.n(b.mass, 0, 1, 0),
            "inertia": [float(c) for c in (six[:3] if straight else six)],
            "at": self.point(b.at),
        }
        if b.velocity is not None:
            d["velocity"] = self.vector(b.velocity, *SPEED)
        if b.spin is not None:
            d["angular_velocity"] = self.vector(b.spin, 0, 0, -1)
        return d

    def joint(self, j: Joint) -> dict[str, Any]:
        d: dict[str, Any] = {"type": j.type, "bodies": [j.i, j.j]}
        if j.points is not None:
            return d | {"points": [self.point(p) for p in j.points]}
        d["at"] = self.point(j.at)
        if j.pitch is not None:
            d["pitch"] = self.n(j.pitch, *LENGTH)
        for key in ("axis", "second_axis", "x_axis"):
            if getattr(j, key) is not None:
                d[key] = self.vector(getattr(j, key))
        if j.clearance is not None:
            d["clearance"], d["contact"] = self.n(j.clearance, *LENGTH), j.law
        return d

    def gear(self, g: Gear) -> dict[str, Any]:
        d: dict[str, Any] = {"type": g.type, "joints": list(g.joints)}
        slides = [self.s.of_joint(name) == LENGTH for name in g.joints]
        if g.teeth is not None:
            d["teeth"] = list(g.teeth)
        if g.radii is not None:
            d["radii"] = [self.n(r, *LENGTH) for r in g.radii]
        if g.radius is not None:
            d["radius"] = self.n(g.radius, *LENGTH)
        if g.ratio is not None:
            d["ratio"] = self.n(g.ratio, *(LENGTH if any(slides) else NONE))
        if g.coefficients is not None:
            # of an angle beside strokes: m/rad
            d["coefficients"] = [
                self.n(c, *(LENGTH if any(slides) and not one else NONE))
                for c, one in zip(g.coefficients, slides, strict=True)
            ]
        if g.internal:
            d["internal"] = True
        if g.hand is not None:
            d["hand"] = g.hand
        return d

    def drive(self, drive: Drive) -> dict[str, Any]:
        if drive.points is not None:
            dims: tuple[int, ...] = LENGTH
            d: dict[str, Any] = {"type": "actuator", "bodies": list(drive.bodies or ())}
            d["points"] = [self.point(p) for p in drive.points]
        else:
            dims = self.s.of_joint(drive.joint or "")
            d = {"joint": drive.joint}
        if drive.by_rate:
            d["velocity"] = self.fn(drive.fn.rate(), plus(dims, (0, 0, -1)))
        else:
            d["position"] = self.fn(drive.fn, dims)
        if drive.k is not None:
            turning = drive.points is None and dims == NONE
            m = 2 if turning else 0
            k, c = self.n(drive.k, m, 1, -2), self.n(drive.c, m, 1, -1)
            if drive.points is not None:
                d["stiffness"], d["damping"] = k, c
            else:
                d["compliance"] = {"stiffness": k, "damping": c}
        return d

    def sensor(self, x: Sensor) -> dict[str, Any]:
        d: dict[str, Any] = {"joint": x.joint}
        if x.sign != 1:
            d["sign"] = x.sign
        if x.at_start:
            d["at_start"] = self.n(x.at_start, *self.s.of_joint(x.joint))
        return d

    def force(self, f: Any) -> dict[str, Any]:
        n = self.n
        if isinstance(f, Load):
            d = {"type": "applied_load", "body": f.body, "direction": self.vector(f.direction)}
            if f.frame != "world":
                d["frame"] = f.frame
            if f.at is not None:
                d["at"] = self.point(f.at)
            key = "torque" if f.torque else "force"
            d[key] = self.fn(f.fn, MOMENT if f.torque else FORCE)
            return d
        if isinstance(f, Spring):
            d = {"type": "spring_damper", "bodies": [f.i, f.j]}
            d["points"] = [self.point(f.p_i), self.point(f.p_j)]
            d |= {"stiffness": n(f.k, 0, 1, -2), "damping": n(f.c, 0, 1, -1)}
            if f.free is not None:
                d["free_length"] = n(f.free, *LENGTH)
            if f.preload:
                d["preload"] = n(f.preload, *FORCE)
            return d
        if isinstance(f, Torsion):
            m = 0 if self.s.of_joint(f.joint) == LENGTH else 2
            d = {"type": "torsion_spring", "joint": f.joint, "stiffness": n(f.k, m, 1, -2)}
            preload = n(f.preload, *(FORCE if m == 0 else MOMENT))
            return d | {"damping": n(f.c, m, 1, -1), "preload": preload}
        if isinstance(f, Bushing):
            d = {"type": "bushing", "bodies": [f.i, f.j], "at": self.point(f.at)}
            d |= {"x_axis": self.vector(f.axes[0]), "y_axis": self.vector(f.axes[1])}
            for key, v, dims in (
                ("stiffness", f.k, (0, 1, -2)),
                ("damping", f.c, (0, 1, -1)),
                ("rotational_stiffness", f.kr, MOMENT),
                ("rotational_damping", f.cr, (2, 1, -1)),
            ):
                d[key] = [n(c, *dims) for c in v]
            return d
        if isinstance(f, Touch):
            return self.touch(f)
        if isinstance(f, Seal):
            return self.seal(f)
        d = {"type": "limit_stop"}
        if isinstance(f, Wall):
            d["point"] = {"body": f.j, "at": self.point(f.point)}
            d["wall"] = {"body": f.i, "at": self.point(f.wall), "normal": self.vector(f.normal)}
            dims, m = LENGTH, 0
        else:
            d["joint"] = f.joint
            dims = self.s.of_joint(f.joint)
            m = 0 if dims == LENGTH else 2
            for key in ("lower", "upper"):
                if getattr(f, key) is not None:
                    d[key] = n(getattr(f, key), *dims)
        d |= {"stiffness": n(f.k, m, 1, -2), "damping": n(f.c, m, 1, -1), "ramp": n(f.ramp, *dims)}
        return d

    def touch(self, f: Touch) -> dict[str, Any]:
        """A contact with a surface; an ellipse is written as a spline through many places."""
        n = self.n
        d: dict[str, Any] = {"body": f.i, "at": self.point(f.at)}
        d |= {"x_axis": self.vector(f.axes[0]), "y_axis": self.vector(f.axes[1])}
        points = f.points
        if f.shape == "ellipse":
            turn = np.arange(MANY) * 2 * np.pi / MANY
            points = [(f.other[0] * np.cos(u), f.other[1] * np.sin(u)) for u in turn]
        d["shape"] = "profile" if points else f.shape
        if points:
            d["points"] = [[n(c, *LENGTH) for c in p] for p in points]
            d["closed"] = f.shape != "line"
            if f.shape == "ellipse":
                d["smooth"] = True
            elif f.radius:
                d["corner_radius"] = n(f.radius, *LENGTH)
        elif f.radius:
            d["radius"] = n(f.radius, *LENGTH)
        if f.hollow:
            d["hollow"] = True
        ball = {"body": f.j, "at": self.point(f.centre), "radius": n(f.ball, *LENGTH)}
        whole = {"type": "surface_contact", "surface": d, "ball": ball, "contact": f.law}
        for key, lever in (("rolling_resistance", f.rolling), ("spinning_friction", f.spinning)):
            if lever:
                whole[key] = n(lever, *LENGTH)
        return whole

    def seal(self, f: Seal) -> dict[str, Any]:
        n = self.n
        d: dict[str, Any] = {
            "type": "seal",
            "line": {"body": f.j, "start": self.point(f.centre), "end": self.point(f.last)},
            "against": {"body": f.i, "at": self.point(f.at), "normal": self.vector(f.normal)},
            "height": n(f.height, *LENGTH), "load": n(f.load, 0, 1, -2), "at": n(f.depth, *LENGTH),
            "exponent": f.exponent, "damping": n(f.damping, -1, 0, 1), "friction": f.friction,
            "full_from": n(f.full, *SPEED),
        }  # fmt: skip
        return d | ({"springs": f.springs} if f.springs else {})

    def grip(self, law: Grip) -> dict[str, Any]:
        L, M, T = self.s.scale
        K = law.K * M * L / T**2 / L**law.exponent
        d: dict[str, Any] = {"normal": law.normal, "stiffness": K, "exponent": law.exponent}
        if law.normal == "impact":
            d |= {"damping": self.n(law.damping, 0, 1, -1), "ramp": self.n(law.ramp, *LENGTH)}
        else:
            d |= {"restitution": law.restitution, "slowest_impact": self.n(law.slowest, *SPEED)}
        rub: dict[str, Any] = {"law": law.friction}
        if law.friction != "none":
            rub["coefficient"] = law.mu
        if law.friction == "modified_coulomb":
            rub |= {"v0": self.n(law.v0, *SPEED), "v1": self.n(law.v1, *SPEED)}
        if law.friction == "sticking":
            rub |= {"static_coefficient": law.mu_s, "stribeck_speed": self.n(law.v_s, *SPEED)}
            rub["bristle_stiffness"] = self.n(law.sigma0, -1, 0, 0)
            rub["bristle_damping"] = self.n(law.sigma1, -1, 0, 1)
        return d | {"friction": rub}

    def law(self, law: Any) -> dict[str, Any]:
        if isinstance(law, Grip):
            return self.grip(law)
        # K in N/m^exponent
        L, M, T = self.s.scale
        return {
            "normal": "lankarani_nikravesh",
            "stiffness": law.K * M * L / T**2 / L**law.exponent,
            "exponent": law.exponent,
            "restitution": law.restitution,
            "bearing_radius": self.n(law.radius, *LENGTH),
            "slowest_impact": self.n(law.slowest, *SPEED),
            "friction": {"law": "none"},
        }

    def event(self, e: Event) -> dict[str, Any]:
        d: dict[str, Any] = {"when": e.when, "value": self.n(e.value, *self.s.of_sensor(e.when))}
        d["crosses"] = e.crosses
        if e.times is not None:
            d["times"] = e.times
        do: dict[str, Any] = {}
        for key in ("record", "end"):
            if getattr(e, key):
                do[key] = True
        for key in ("release", "lock", "unlock"):
            if getattr(e, key):
                do[key] = list(getattr(e, key))
        if e.set:
            name, fn, by_rate = e.set
            drive = next(x for x in self.s.drives if x.name == name)
            dims = LENGTH if drive.points is not None else self.s.of_joint(drive.joint or "")
            key = "velocity" if by_rate else "position"
            rate = plus(dims, (0, 0, -1))
            do["set"] = {name: {key: self.fn(fn.rate(), rate) if by_rate else self.fn(fn, dims)}}
        d["do"] = do
        return d

    def section(self, x: Section) -> dict[str, Any]:
        d: dict[str, Any] = {"plot": list(x.plot)}
        if x.every is not None:
            d["every"] = self.n(x.every, 0, 0, 1)
        else:
            d["when"], d["crosses"] = f"{x.when}.rate" if x.rate else x.when, x.crosses
        if x.after:
            d["after"] = self.n(x.after, 0, 0, 1)
        return d
