"""Wrench: three forces at a point of a body and three moments on it, each a function of its own.

    F = f_x e_x + f_y e_y + f_z e_z        at the point p of the body
    M = m_x e_x + m_y e_y + m_z e_z        about p
    P = F . v_p + M . omega                its power, counted under loads in the energy balance

f and m are numbers, expressions or tables of t and sensors, or the six columns of one table
(components.py).  The axes e are those of the world, or of the frame of the file or instance if it
has one; or those of a body or a named point, with which they turn.  The same wrench at another
point q of the body has M_q = M + (p - q) x F.
"""

from typing import Annotated, Any, ClassVar

from pydantic import BeforeValidator, WithJsonSchema, model_validator

from trsim.elements.components import TITLES, Components
from trsim.elements.contract import (
    LOADS,
    Channel,
    Element,
    Memory,
    Reach,
    Row,
    Turning,
    kernel,
    measured,
)
from trsim.elements.frames import arm, dot, plus, push, scaled, spin, twist, velocity
from trsim.elements.loads import Load
from trsim.errors import ScenarioError
from trsim.fields import point
from trsim.kernels.columns import V3, i8
from trsim.kernels.lazy import internal
from trsim.laws.functions import value
from trsim.varying import Function, FunctionSpec

UNIT_VECTORS = ((1.0, 0.0, 0.0), (0.0, 1.0, 0.0), (0.0, 0.0, 1.0))


def _three(given: Any) -> Any:
    """A third component where two are given."""
    return [*given, 0.0] if isinstance(given, list | tuple) and len(given) == 2 else given


def three_functions(*units: str) -> Any:
    """The type of three functions; two in a plane."""
    of: Any = Function(*units)
    one = {"anyOf": [{"type": word} for word in ("number", "string", "object")]}
    schema = {"type": "array", "prefixItems": [one] * 3, "minItems": 2, "maxItems": 3}
    return Annotated[tuple[of, of, of], BeforeValidator(_three), WithJsonSchema(schema)]


NOTHING = (FunctionSpec("constant"),) * 3


class Wrench(Load):
    """Six components of a load at a point of a body.

    body        the body it acts on
    at          point at which it acts, as drawn; the point named by `frame`, or the centre of mass,
                unless given
    frame       axes of the components: `world`, or those of a body or a named point
    force       forces along x, y, z: three functions, or two in a plane
    moment      moments about x, y, z
    components  all six in one table, instead of `force` and `moment`
    """

    type: ClassVar[str] = "wrench"
    body: str
    at: point("m") | None = None
    frame: str = "world"
    force: three_functions("N") | None = None
    moment: three_functions("N*m") | None = None
    components: Components | None = None

    @model_validator(mode="after")
    def something(self):
        if self.components is not None:
            if self.force is not None or self.moment is not None:
                what = "give `components`, or `force` and `moment`"
                raise ScenarioError(what, "the table has all six", ("components",))
            six = self.components.functions
            self.__dict__.update(force=six[:3], moment=six[3:])
        if not any(map(varies, (*(self.force or ()), *(self.moment or ())))):
            what = "all six components are zero"
            raise ScenarioError(what, "give `force` or `moment`, three functions each")
        return self


def varies(f):
    """Whether a component is anything but zero."""
    return f.kind != "constant" or f.value != 0.0


class Own(Memory):
    """Of one instance."""

    body: i8  # or the node of a bar
    frame: i8  # with which the axes turn
    f_x: i8  # in tab
    f_y: i8
    f_z: i8
    m_x: i8
    m_y: i8
    m_z: i8
    point: V3  # m, in the axes of the body
    x: V3  # the axes, in those of the frame
    y: V3
    z: V3
    acts: V3  # 1 of each force that is not zero, and
    turns: V3  # of each moment


def pack(name, spec, at):
    frame, axes, origin = axes_of(spec, at)
    place = origin if spec.at is None else spec.at
    i = at.body(spec.body, "body", near=place)
    place = at.centre(i) if place is None else place
    given = {"force": spec.force or NOTHING, "moment": spec.moment or NOTHING}
    parts = {
        f"{key[0]}_{axis}": at.function(f, *told(spec, key, k))
        for key, functions in given.items()
        for k, (axis, f) in enumerate(zip("xyz", functions, strict=True))
    }
    own = Own.packed(
        body=i, frame=frame, **parts, point=at.local(i, place),
        **dict(zip("xyz", axes, strict=True)),
        acts=tuple(map(float, map(varies, given["force"]))),
        turns=tuple(map(float, map(varies, given["moment"]))),
    )  # fmt: skip
    reads = frozenset().union(*(f.sensors for functions in given.values() for f in functions))
    return Row(*own, reads=reads)


def told(spec, key, k):
    """Where a component is written."""
    if spec.components is None:
        return key, k
    return "components", TITLES[k if key == "force" else 3 + k]


def axes_of(spec, at):
    """The frame with which the axes turn, they in its own, and the point it is named by or None."""
    points = at.scenario.points
    if spec.frame == "world":
        drawn = spec.drawn_in
        return 0, (drawn.x, drawn.y, drawn.z) if drawn else UNIT_VECTORS, None
    if spec.frame in points:
        marker = points[spec.frame]
        i, drawn = at.body(marker.body, "frame", near=marker.at), marker.frame
        return i, tuple(at.axes(i, e) for e in (drawn.x, drawn.y, drawn.z)), marker.at
    i = at.body(spec.frame, "frame", near=spec.at, off=1.0)
    return i, UNIT_VECTORS, None


@internal
def load(t, scene, e):
    """Force and moment, world axes."""
    own, tab, S, X = Own(scene, e), scene.tab, scene.S, scene.X
    x, y, z = arm(X, own.frame, own.x), arm(X, own.frame, own.y), arm(X, own.frame, own.z)
    f = (value(tab, own.f_x, t, S), value(tab, own.f_y, t, S), value(tab, own.f_z, t, S))
    m = (value(tab, own.m_x, t, S), value(tab, own.m_y, t, S), value(tab, own.m_z, t, S))
    F = plus(plus(scaled(f[0], x), scaled(f[1], y)), scaled(f[2], z))
    M = plus(plus(scaled(m[0], x), scaled(m[1], y)), scaled(m[2], z))
    return F, M


@kernel
def force(t, scene, e):
    own = Own(scene, e)
    i = own.body
    F, M = load(t, scene, e)
    p = arm(scene.X, i, own.point)
    push(scene.F, i, p, F)
    twist(scene.F, i, M)
    scene.zd[LOADS] += dot(F, velocity(scene.V, i, p)) + dot(M, spin(scene.V, i))


@measured
def measure(t, scene, e, o):
    F, M = load(t, scene, e)
    for c in range(3):
        scene.out[o + c], scene.out[o + 3 + c] = F[c], M[c]


def _along(own, which):
    """The axes along which it has a component."""
    axes = zip((own.x, own.y, own.z), which, strict=True)
    return tuple((own.frame, axis) for axis, there in axes if there)


def reach(row):
    own = Own.of(row)
    forces = _along(own, own.acts)
    places = ((own.body, own.point, (own.body,)),) if forces else ()
    return Reach(forces=forces, torques=_along(own, own.turns), places=places)


def acts_at(row):
    """Of moments without a point of their own nobody knows where."""
    own = Own.of(row)
    return ((own.body, own.point if any(own.acts) or any(own.point) else None),)


def turning(row):
    own = Own.of(row)
    forces, moments = _along(own, own.acts), _along(own, own.turns)
    return Turning(
        (own.body, own.frame) if moments else (),
        points=((own.body, own.point),) if forces else (),
        axes=forces,
        torques=tuple((own.body, frame, axis) for frame, axis in moments),
    )


ELEMENT = Element(
    key="wrench",
    section="forces",
    spec=Wrench,
    pack=pack,
    acts_at=acts_at,
    reach=reach,
    channels=(
        Channel("force", "N", "force at its point, world axes", 3),
        Channel("moment", "N*m", "moment about its point, world axes", 3),
    ),
    turning=turning,
    loads={"force": "load", "moment": "moment of the load"},
    kernels={"force": force, "measure": measure},
    example="""
bodies:
  door: {mass: 30 kg, inertia: [4, 6, 2], at: [0.4, 0, 0]}
joints:
  hinge: {type: revolute, bodies: [ground, door], at: [0, 0, 0]}
sensors:
  angle: {joint: hinge}
forces:
  air: {type: wrench, body: door, at: [0.3, 0, 0.1], frame: door,
        force: ["5*angle", {table: [[0, 0], [0.5, -20], [1, -30], [2, -35]], of: angle}, 2],
        moment: [0, 0, "-3*angle.rate"]}
solver: {end: 1 s}
""",
)
