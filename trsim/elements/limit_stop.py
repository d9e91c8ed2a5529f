"""Limit stop: one-sided contact of a point with a wall, or of a joint coordinate with a limit.

    F = max(0, k d + c smoothstep(d / ramp) d')          d > 0: penetration

Point against wall: d = -(p - w) . n, with n, towards the allowed side, fixed in the body of the
wall.  F n acts at the point, and -F n on the body of the wall at the same position.  Joint: d =
max(lower - x, x - upper).  F acts along the axis of the joint; for a point on a curve, on the point
along the tangent; for the bend of a joint, about the axis about which it bends (bend.py).  The
damping fades in over the ramp, so the force does not jump at the touch and does not depend on the
impact speed.  Soft impacts are correct, unlike with Lankarani-Nikravesh.  During contact the law of
the spring is continued to d < 0, where no accepted step ever ends.  The end of the ramp and the
point beyond which the force would pull are corners of the law, located like a touch.  With a
restitution, an impact faster than the slowest impact takes no time (solve/march/impacts.py), and
this force acts only when the contact no longer bounces.
"""

from math import pi
from typing import Annotated, ClassVar

from annotated_types import Ge, Gt, Interval
from pydantic import model_validator

from trsim.elements.bend import Bent, bend
from trsim.elements.bend import turning as turning_bend
from trsim.elements.contract import (
    CONTACT,
    CONTACTS,
    FLIGHT,
    IMPACTS,
    WHOLE,
    Channel,
    Contact,
    Element,
    Impact,
    Reach,
    Row,
    Turning,
    kernel,
    measured,
)
from trsim.elements.coordinates import ANY, BEND, called, of_joint, split
from trsim.elements.frames import (
    arm,
    at_both,
    carried,
    dot,
    impulse,
    minus,
    on_joint,
    points,
    push_apart,
    scaled,
    twist_apart,
)
from trsim.elements.frames import point as place
from trsim.elements.on_curve import NO_CURVE, AlongCurve, along_curve, tangent
from trsim.elements.rows import ARC, COORDINATES, slides
from trsim.errors import ScenarioError
from trsim.fields import Spec, Unit, direction, point, vector
from trsim.kernels.columns import f8, i8
from trsim.kernels.lazy import internal
from trsim.laws.contact import (
    ramped_beyond,
    ramped_branch_of,
    ramped_damping,
    ramped_neighbour,
    ramped_on_branch,
)


class BodyPoint(Spec):
    """A point of a body.

    body  the body
    at    the point, as drawn
    """

    body: str
    at: point("m")


class Wall(Spec):
    """A plane of a body.

    body    the body
    at      a point of the plane, as drawn
    normal  normal towards the allowed side, as drawn; turns with the body
    """

    body: str
    at: point("m")
    normal: vector("-")


class LimitStop(Spec):
    """A stop: `point` against `wall`, or the coordinate of `joint` between `lower` and `upper`.

    point           what touches the wall
    wall            what it touches
    joint           joint whose coordinate is limited. For a point on a curve, the length along the
                    curve; NAME.bend is the angle between shafts, or between the axes of a ball
                    joint, measured from straight
    lower           smallest allowed coordinate
    upper           largest allowed coordinate
    stiffness       stiffness of the contact
    damping         damping of the contact, once the ramp is over
    ramp            penetration over which the damping fades in
    restitution     rate after an impact divided by rate before; with it an impact takes no time
    slowest_impact  rate below which nothing bounces, if there is a restitution
    """

    type: ClassVar[str] = "limit_stop"
    point: BodyPoint | None = None
    wall: Wall | None = None
    joint: str | None = None
    lower: Annotated[float, Unit("m", "rad")] | None = None
    upper: Annotated[float, Unit("m", "rad")] | None = None
    stiffness: Annotated[float, Gt(0), Unit("N/m", "N*m/rad")]
    damping: Annotated[float, Ge(0), Unit("N*s/m", "N*m*s/rad")] = 0.0
    ramp: Annotated[float, Gt(0), Unit("m", "rad")] = 1e-4
    restitution: Annotated[float, Interval(ge=0, le=1), Unit("-")] | None = None
    slowest_impact: Annotated[float, Gt(0), Unit("m/s", "rad/s")] = 0.01

    @model_validator(mode="after")
    def one_kind(self):
        on_wall = self.point is not None and self.wall is not None
        on_joint = self.joint is not None
        if on_wall == on_joint or (on_joint and (self.point or self.wall)):
            raise ValueError("give `point` and `wall`, or `joint` with `lower` and/or `upper`")
        if on_joint and self.lower is None and self.upper is None:
            raise ValueError("give `lower`, `upper` or both")
        if self.lower is not None and self.upper is not None and self.lower >= self.upper:
            raise ValueError(f"lower must be < upper, got {self.lower:g} and {self.upper:g}")
        if self.wall is not None and not any(self.wall.normal):
            raise ValueError("`normal` must not be zero")
        if self.restitution is not None and self.damping == 0.0:
            raise ValueError(
                "with `restitution` give a `damping` above 0: with it what no longer bounces comes "
                "to rest on the spring"
            )
        if self.restitution is None and "slowest_impact" in self.model_fields_set:
            raise ValueError("`slowest_impact` is the end of bounces: give `restitution` too")
        return self

    def pressed(self, joints):
        """The two bodies it pushes apart, and the hinge about whose axis it does."""
        if self.joint is None:
            return (self.point.body, self.wall.body), None
        name, which = split(self.joint, joints)
        if name not in joints or which == BEND:  # nobody knows about which axis it bends
            return (), None
        own, hinge = of_joint(name, joints).get(called(self.joint, joints), ""), joints[name]
        if own and COORDINATES[own].of == "j":
            hinge = hinge.model_copy(update={"axis": hinge.second_axis})
        return hinge.bodies, None if own and slides((own,)) else hinge


WITH_UNITS = ("lower", "upper", "ramp", "stiffness", "damping", "slowest_impact")
ON_WALL, ON_ANGLE, ON_STROKE, ON_ARC, ON_BEND = range(5)
KINDS = {"angle": ON_ANGLE, "stroke": ON_STROKE, ARC: ON_ARC, BEND: ON_BEND}
UNBOUNDED = 1e300
ACROSS = 1e-9  # of an axis: in a plane one across it bends nowhere


class Own(AlongCurve):
    """Of one instance; its axis is the normal of the wall, or that of the joint."""

    kind: i8  # ON_WALL, ON_ANGLE, ON_STROKE, ON_ARC or ON_BEND
    stiffness: f8
    damping: f8
    ramp: f8
    lower: f8
    upper: f8
    on_second: f8  # 1; -1 of a joint's coordinate whose body j is the first one of the joint


def pack(name, spec, at):
    strikes = spec.restitution is not None
    contact = Contact(
        spec.stiffness, 1.0, float("inf"), spec.slowest_impact if strikes else 0.0, 0.0,
        impact=Impact("newton", spec.restitution) if strikes else None,
    )  # fmt: skip
    if spec.joint is None:
        if spec.wall.body == spec.point.body:
            raise ScenarioError(
                f"point and wall are both on '{spec.wall.body}'",
                "name two different bodies",
                ("point", "body"),
            )
        at.check_units("wall", LimitStop, WITH_UNITS, "forces", name)
        # on a flexible bar the wall belongs to the node that is nearest to it
        i = at.body(spec.wall.body, "wall", "body", near=spec.wall.at, off=1.0)
        j = at.body(spec.point.body, "point", "body", near=spec.point.at)
        n = at.axes(i, direction(spec.wall.normal))
        places = points(at, i, j, spec.wall.at, spec.point.at)
        own = Own.packed(spec, **places, kind=ON_WALL, axis=n, lower=0.0, upper=0.0,
                         on_second=1.0, **NO_CURVE)  # fmt: skip
        return Row(*own, contact, travel="stroke")
    x = bent(spec, at) or at.coordinate(spec.joint, ANY)
    kind = KINDS[x.kind]
    turns = kind in (ON_ANGLE, ON_BEND)
    at.check_units("angle" if turns else x.kind, LimitStop, WITH_UNITS, "forces", name)
    curve = NO_CURVE if kind != ON_ARC else stopped(x)
    if kind == ON_BEND:
        curve = NO_CURVE | {"other": x.other_i}
    low = -UNBOUNDED if spec.lower is None else spec.lower
    high = UNBOUNDED if spec.upper is None else spec.upper
    on_second = -1.0 if x.turned else 1.0
    own = Own.packed(
        spec, **on_joint(x), kind=kind, lower=low, upper=high, on_second=on_second, **curve
    )
    return Row(*own, contact, turns=turns, travel=x.kind, kink=0.5 * (high - low))


def bent(spec, at):
    """The bend that it stops, if it is one.  Refuses limits that none ever comes to."""
    x = at.bend(spec.joint)
    for key, beyond in (("upper", 0.0), ("lower", pi)) if x else ():
        limit = getattr(spec, key)
        if limit is not None and (limit <= beyond if key == "upper" else limit >= beyond):
            what = f"a bend is between 0 and half a turn, and `{key}` is {limit:g} rad"
            raise ScenarioError(what, "it is counted from where the axes are straight", (key,))
    return x


def stopped(x):
    """The columns of a stop on a curve."""
    if not x.curve:
        raise ScenarioError(
            f"'{x.joint}' has no point that stays on its curve, so nothing stops it there",
            "stop one of its bodies, by the joint that guides it",
            ("joint",),
        )
    return along_curve(x)


@internal
def nearer(own, x, rate):
    """The penetration of the nearer limit, and its rate."""
    low, high = own.lower - x, x - own.upper
    return (low, -rate) if low > high else (high, rate)


@internal
def depth(scene, e):
    """Penetration and its rate."""
    S, own = scene.S, Own(scene, e)
    if own.kind == ON_BEND:
        x, rate, _ = bend(scene, Bent(scene, e))
        return nearer(own, x, rate)
    if own.kind != ON_WALL:
        return nearer(own, S[own.coordinate, 0], S[own.coordinate, 1])
    # the wall turns: the speed of its body under the point counts
    n = arm(scene.X, own.i, own.axis)
    _, _, d, v = carried(scene, e)
    return -dot(n, d), -dot(n, v)


@internal
def direction_on(scene, e):
    """The direction of the force on body j (world, or + - axis)."""
    S, own = scene.S, Own(scene, e)
    n = arm(scene.X, own.i, own.axis)
    if own.kind == ON_WALL:
        return n
    if own.kind == ON_ARC:
        n = tangent(scene, own)
    if own.kind == ON_BEND:
        x, _, n = bend(scene, Bent(scene, e))
    else:
        x = S[own.coordinate, 0]
    if own.lower - x > x - own.upper:
        return n
    return (-n[0], -n[1], -n[2])


@kernel
def force(t, scene, e):
    X, left = scene.X, scene.left
    own = Own(scene, e)
    if own.phase == FLIGHT:
        return
    d, d_dot = depth(scene, e)
    if d <= 0.0 and own.phase != CONTACT:
        return
    n = direction_on(scene, e)
    i, j, branch = own.i, own.j, own.branch
    k, c, ramp = own.stiffness, own.damping, own.ramp
    if own.phase == CONTACT and c > 0.0 and branch != WHOLE:
        left[e] = max(left[e], ramped_beyond(branch, d, d_dot, k, c, ramp))
        f = ramped_on_branch(branch, d, d_dot, k, c, ramp)
    else:
        # a trial step past the separation goes on smoothly; it is cut at the root of d
        f = k * d if d <= 0.0 else ramped_damping(d, d_dot, k, c, ramp)
    if own.kind == ON_ANGLE or own.kind == ON_BEND:
        twist_apart(scene.F, i, j, scaled(f, n))
    else:
        p_j = arm(X, j, own.p_j)
        r_i = minus(place(X, j, p_j), (X[i, 0], X[i, 1], X[i, 2]))
        push_apart(scene.F, i, r_i, j, p_j, scaled(f, n))
    scene.zd[IMPACTS] -= (f - k * d) * d_dot


@kernel
def gap(t, scene, e):
    scene.gap[e, 0], scene.gap[e, 1] = depth(scene, e)


@kernel
def strike(t, scene, e):
    blow, own, X = scene.blow, Own(scene, e), scene.X
    n = direction_on(scene, e)
    p_j = arm(X, own.j, own.p_j)
    r_i = minus(place(X, own.j, p_j), (X[own.i, 0], X[own.i, 1], X[own.i, 2]))
    impulse(blow, 0, r_i, p_j, n)
    if own.kind == ON_ANGLE or own.kind == ON_BEND:
        for c in range(3):
            blow[0, c] = blow[0, 6 + c] = 0.0
            blow[0, 3 + c], blow[0, 9 + c] = n[c], -n[c]
    for k in range(1, 3):
        for c in range(12):
            blow[k, c] = 0.0


@kernel
def corners(t, scene, e):
    out = scene.corner
    own = Own(scene, e)
    out[e, 0] = -1.0
    k, c, ramp, branch = own.stiffness, own.damping, own.ramp, own.branch
    if c == 0.0 or own.phase != CONTACT:
        return
    d, d_dot = depth(scene, e)
    if branch == WHOLE:
        out[e, 1] = ramped_branch_of(d, d_dot, k, c, ramp)
    else:
        out[e, 0] = ramped_beyond(branch, d, d_dot, k, c, ramp)
        out[e, 1] = ramped_neighbour(branch, d, d_dot, k, c, ramp)


@kernel
def energy(t, scene, e):
    own = Own(scene, e)
    if own.phase == FLIGHT:
        return
    d, _ = depth(scene, e)
    if d > 0.0:
        scene.E[CONTACTS] += 0.5 * own.stiffness * d * d


@measured
def measure(t, scene, e, o):
    out = scene.out
    own = Own(scene, e)
    (d, d_dot), n = depth(scene, e), direction_on(scene, e)
    f = 0.0
    if own.phase != FLIGHT and d > 0.0:
        f = ramped_damping(d, d_dot, own.stiffness, own.damping, own.ramp)
    out[o], out[o + 1] = f, d
    for c in range(3):
        out[o + 2 + c] = own.on_second * f * n[c]


def reach(row):
    own = Own.of(row)
    if own.kind == ON_BEND and max(map(abs, (*own.axis[:2], *own.other[:2]))) > ACROSS:
        return Reach(forces=((own.i, own.axis), (own.j, own.other)))  # about what is across both
    if own.kind != ON_WALL:  # along the coordinate of a joint
        return Reach()
    return Reach(forces=((own.i, own.axis),), places=((own.j, own.p_j, (own.i, own.j)),))


def turning(row):
    """The wall is carried along by its body."""
    own = Own.of(row)
    if own.kind == ON_BEND:
        return turning_bend(row)
    if own.kind != ON_WALL:
        return Turning(frames=(own.i, own.j))
    return Turning(points=((own.j, own.p_j),), axes=((own.i, own.axis),))


ELEMENT = Element(
    key="limit_stop",
    section="forces",
    spec=LimitStop,
    pack=pack,
    acts_at=at_both,
    reach=reach,
    channels=(
        Channel("normal_force", "drive", "contact force or torque; never negative", least=0.0),
        Channel(
            "penetration",
            "coordinate",
            "penetration, positive in contact; in flight, minus the gap",
        ),
        Channel("force", "drive", "force (on an angle: torque) on the second body, world axes", 3),
    ),
    turning=turning,
    picture="stop",
    loads={"normal_force": "contact force"},
    kernels={
        "force": force,
        "gaps": gap,
        "strike": strike,
        "corners": corners,
        "energy": energy,
        "measure": measure,
    },
    example="""
bodies:
  block: {mass: 2 kg, inertia: 0.01 kg*m^2, velocity: [0.5 m/s, 0]}
joints:
  slide: {type: prismatic, bodies: [ground, block], axis: [1, 0, 0]}
forces:
  bumper: {type: limit_stop, joint: slide, upper: 20 mm, stiffness: 1e6 N/m, damping: 400 N*s/m}
solver: {end: 0.1 s}
""",
)
