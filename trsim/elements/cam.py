"""Cam: a roller, or a flat face, of body j stays in touch with a curve of body i.

    roller   Phi = n . (p - c) - r = 0      n, c at the footpoint of its centre p, see on_curve.py
    face     Phi = m . (q - c) = 0          c where c' . m = 0

m is the normal of the face, fixed in body j, from the cam to the follower, and q a point of the
face.  For a face, with w the velocity of body j relative to body i where they touch, and omega
their relative angular velocity,

    u'    = -c' . (omega x m) / (c'' . m)
    J     : the force m on body j where they touch, -m on body i there
    Phi'' = J V' + (omega_j x m) . w + m . (omega_j x a') - m . (omega_i x rho'),
            a' = -w + omega_j x a + c' u',  rho' = omega_i x rho + c' u'

with rho and a from the centres of body i and of body j to the point of contact.  This point moves
along c', perpendicular to m, so u' does not appear in J.  The follower cannot lift off:
normal_force is positive while the follower is pressed on, and negative where it would lift off,
which a run reports at its end.  There is no friction.  A roller turns freely; reaction acts at its
centre, or at q.
"""

from math import sqrt
from typing import Annotated, ClassVar

from annotated_types import Gt
from pydantic import model_validator

from trsim.elements.contract import Channel, Row, kernel, measured
from trsim.elements.curve import Curve, furthest, named, sampled, sharpest
from trsim.elements.frames import (
    arm,
    cross,
    dot,
    lines,
    minus,
    plus,
    point,
    relative_spin,
    scaled,
    spin,
    velocity,
)
from trsim.elements.on_curve import (
    LENGTH,
    OFF,
    OnCurve,
    distance_row,
    drawn_at,
    end_gap,
    ends_of,
    follow,
    frames,
    inside,
    on_curve,
    settled,
    stay,
    stored,
    write_place,
)
from trsim.elements.on_curve import turning as in_plane
from trsim.elements.rows import Axes, JointRow
from trsim.errors import ScenarioError
from trsim.fields import Unit, direction, vector
from trsim.fields import point as of_place
from trsim.kernels.columns import V3, constraint_row, f8, i8
from trsim.kernels.lazy import internal
from trsim.laws.curves import dot2, place, touch

ROLLER, FACE = 0, 1
FITS = 1e-3  # of its radius: what a roller may lack of room
STRAIGHT = 1e-4  # of the largest curvature: a flat face would touch there along a line
OUT = 1e-6  # of the normal of a face: what may point out of the plane of the curve
LIFTS = 1e-6  # of the largest force: what is none


class Cam(OnCurve):
    """A roller or a flat face of the second body that stays on a curve of the first.

    curve   the profile of the cam, which moves with the first body
    at      centre of the roller, or a point of the flat face, as drawn
    radius  radius of the roller, which runs on that side of the curve on which its centre is drawn
    face    normal of a flat face, instead of a roller: from the cam to the follower, as drawn
    """

    type: ClassVar[str] = "cam"
    curve: Curve
    at: of_place("m")
    radius: Annotated[float, Gt(0), Unit("m")] | None = None
    face: vector("-") | None = None

    @model_validator(mode="after")
    def one_follower(self):
        if (self.radius is None) == (self.face is None):
            what = "give the `radius` of a roller, or the normal of a flat `face`: one of them"
            raise ScenarioError(what, "a pin without a radius is a `point_on_curve`")
        return self


class Own(Axes):
    """Of one instance; its first point is the origin of the curve."""

    contact: constraint_row
    curve: i8  # in tab
    parameter: i8  # entry of S with u
    follower: i8  # ROLLER or FACE
    side: f8  # 1: a roller left of the curve, -1: right of it
    radius: f8
    m_j: V3  # normal of a face, in the axes of body j


def pack(name, spec, at):
    curve = sampled(spec.curve)
    own = roller(curve, spec) if spec.radius else face(curve, spec)
    u, length, side = own
    found = frames(spec, at) | {"curve": stored(curve, spec, at), "side": side}
    found |= {"follower": ROLLER if spec.radius else FACE, "radius": spec.radius or 0.0}
    found["m_j"] = at.axes(found["j"], direction(spec.face)) if spec.face else (0.0, 0.0, 0.0)
    own = Own.of(Row(*Own.packed(parameter=-1, **found)))
    _, parameter = at.on_curve(name, own, (length, u), "beside" if spec.radius else "")
    return Row(*Own.packed(parameter=parameter, **found), limits=ends_of(curve))


# --- what a follower needs of a curve --------------------------------------------------------


def roller(curve, spec):
    """u, length and side of a roller as drawn."""
    u, length, aside = drawn_at(curve, spec, spec.radius)
    side = 1.0 if aside > 0.0 else -1.0
    least, where = sharpest(curve, side)
    if least <= spec.radius:
        raise ScenarioError(
            f"the curve turns with a radius of {least:.6g} m at {named(where)} of its coordinates, "
            f"and a roller of radius {spec.radius:.6g} m does not come down to it (undercutting)",
            "take a smaller roller, or a curve that turns less sharply there",
            ("radius",),
        )
    check_room(curve, side, spec.radius)
    return u, length, side


def check_room(curve, side, radius):
    """Refuse a roller that meets another piece of the curve."""
    import numpy as np

    step = max(1, len(curve.u) // 1000)
    x, y = np.ascontiguousarray(curve.place.T)
    places, tangents = curve.place[::step], curve.tangent[::step].tolist()
    for where, (t_x, t_y) in zip(places, tangents, strict=True):
        away = (x - (where[0] - side * radius * t_y)) ** 2
        away += (y - (where[1] + side * radius * t_x)) ** 2
        k = int(np.argmin(away))
        if away[k] < ((1.0 - FITS) * radius) ** 2:
            raise ScenarioError(
                f"a roller of radius {radius:.6g} m that touches the curve at {named(where)} of "
                f"its coordinates meets it again at {named(curve.place[k])} (undercutting)",
                "take a smaller roller, or another curve",
                ("radius",),
            )


def face(curve, spec):
    """u and length where a flat face touches as drawn; its curve must bend one way."""
    import numpy as np

    if not any(spec.face):
        raise ScenarioError("a normal must not be zero", "for example [0, 1, 0]", ("face",))
    plane = spec.curve.frame
    m = plane.inside(direction(spec.face))
    if abs(m[2]) > OUT:
        raise ScenarioError(
            "the normal of the face points out of the plane of the curve",
            "draw the cam and its follower in one plane",
            ("face",),
        )
    least, most = float(curve.bend.min()), float(curve.bend.max())
    way = 1.0 if most > -least else -1.0
    k = int(np.argmin(way * curve.bend))
    if way * curve.bend[k] <= STRAIGHT * max(most, -least):
        raise ScenarioError(
            f"a flat face needs a curve that bends one way, and this one is straight or hollow at "
            f"{named(curve.place[k])} of its coordinates",
            "take a roller, or a convex curve; an open one through points needs `tangents`",
            ("curve",),
        )
    u = furthest(curve, m[:2])
    u, length, c, _ = settled(curve, u, m[:2], 1)
    if not curve.closed and not 0.0 < u < curve.u[-1]:
        raise ScenarioError(
            "as drawn the face touches the curve nowhere between its ends",
            "turn the cam or the face, or make the curve longer",
            ("face",),
        )
    q = inside(spec, spec.at)
    off = abs(sum(a * (b - d) for a, b, d in zip(m, q, c, strict=False)))
    if off > OFF * curve.size:
        there = plane.moved((c[0], c[1], 0.0))
        raise ScenarioError(
            f"the face is drawn {off:.3g} m away from the curve",
            f"it must go through [{', '.join(f'{a:.6g}' for a in there)}]",
            ("at",),
        )
    return u, length, 1.0


# --- kernels -----------------------------------------------------------------------------


@internal
def normal_of_face(scene, own):
    """The normal of a face, world axes, and in those of the curve."""
    X = scene.X
    m = arm(X, own.j, own.m_j)
    return m, (dot(arm(X, own.i, own.u_i), m), dot(arm(X, own.i, own.w_i), m))


@internal
def in_world(scene, own, v):
    """A vector of the plane of the curve, in world axes."""
    X = scene.X
    return plus(scaled(v[0], arm(X, own.i, own.u_i)), scaled(v[1], arm(X, own.i, own.w_i)))


@internal
def rate_at(scene, own, m, c1, c2, flat):
    """u' of the touch of a face; flat: its normal in the axes of the curve."""
    turning = cross(relative_spin(scene.V, own.i, own.j), m)
    return -dot(in_world(scene, own, c1), turning) / dot2(c2, flat)


@internal
def follow_face(scene, e):
    """Where the face touches."""
    own = Own(scene, e)
    m, flat = normal_of_face(scene, own)
    u = touch(scene.tab, own.curve, scene.S[own.parameter, 0], flat)
    _, c1, c2 = place(scene.tab, own.curve, u)
    write_place(scene, own, u, c1, rate_at(scene, own, m, c1, c2, flat))


@internal
def face_row(scene, e, k):
    """m . (q - c) as row k."""
    X, V, own = scene.X, scene.V, Own(scene, e)
    i, j = own.i, own.j
    m, flat = normal_of_face(scene, own)
    c, c1, c2 = place(scene.tab, own.curve, scene.S[own.parameter, 0])
    rho = plus(arm(X, i, own.p_i), in_world(scene, own, c))
    there = point(X, i, rho)
    a = minus(there, (X[j, 0], X[j, 1], X[j, 2]))
    q = arm(X, j, own.p_j)
    scene.phi[k], scene.phi_t[k] = dot(m, minus(q, a)), 0.0
    lines(scene, k, m, cross(rho, m), cross(a, m))
    o_i, o_j = spin(V, i), spin(V, j)
    w = minus(velocity(V, j, a), velocity(V, i, rho))
    slip = scaled(rate_at(scene, own, m, c1, c2, flat), in_world(scene, own, c1))
    a_dot = plus(minus(cross(o_j, a), w), slip)
    rho_dot = plus(cross(o_i, rho), slip)
    scene.gamma[k] = dot(m, cross(o_i, rho_dot)) - dot(m, cross(o_j, a_dot)) - dot(cross(o_j, m), w)


@internal
def contact(scene, e, k):
    own = Own(scene, e)
    if own.follower == FACE:
        face_row(scene, e, k)
    else:
        distance_row(scene, e, own, k, own.side, own.radius)


@kernel
def coordinate(t, scene, e):
    own = Own(scene, e)
    if own.contact < 0:
        stay(scene, own)
    elif own.follower == FACE:
        follow_face(scene, e)
    else:
        follow(scene, e, own)


@kernel
def gap(t, scene, e):
    own = Own(scene, e)
    end_gap(scene, e, own, own.contact)


@measured
def measure(t, scene, e, o):
    out, own = scene.out, Own(scene, e)
    c, c1, c2 = place(scene.tab, own.curve, scene.S[own.parameter, 0])
    out[o] = -scene.lam[own.contact] if own.contact >= 0 else 0.0
    out[o + 1] = max(0.0, -out[o])
    out[o + 2] = (c1[0] * c2[1] - c1[1] * c2[0]) / sqrt(dot2(c1, c1)) ** 3
    there = point(scene.X, own.i, plus(arm(scene.X, own.i, own.p_i), in_world(scene, own, c)))
    for k in range(3):
        out[o + 3 + k] = there[k]
    out[o + 6] = scene.S[own.coordinate, 0]


def doubts(name, spec, largest):
    """A follower that is held where it would lift off."""
    pull, when = largest(f"{name}.pull")
    pressed, _ = largest(f"{name}.normal_force")
    if pull > LIFTS * abs(pressed):
        yield (
            f"joints.{name}: the follower is pulled by {pull:.4g} N at {when:.4g} s, where it "
            "would lift off a cam that only presses: right for a cam that holds both ways, a "
            "groove; else press it on by a spring or its weight, or go slower"
        )


def turning(row):
    own, found = Own.of(row), in_plane(row)
    face = ((own.j, own.m_j),) if own.follower == FACE else ()
    return found._replace(axes=(*found.axes, *face))


ELEMENT = on_curve(
    key="cam",
    spec=Cam,
    pack=pack,
    rows=(JointRow("contact", "n", fill=contact),),
    channels=(
        Channel(
            "normal_force",
            "N",
            "normal force between cam and follower, positive while they are pressed together",
        ),
        Channel("pull", "N", "force that holds the follower where it would lift off", least=0.0),
        Channel(
            "curvature",
            "1/m",
            "curvature of the curve at the point of contact, positive to its left",
        ),
        Channel("place", "m", "point of contact, world axes", 3),
        LENGTH,
    ),
    loads={"normal_force": "contact force"},
    judged=lambda _: True,
    doubts=doubts,
    turning=turning,
    picture="lobe",
    kernels={"coordinate": coordinate, "gaps": gap, "measure": measure},
    example="""
bodies:
  wheel: {mass: 2 kg, inertia: 0.01 kg*m^2, at: [0, 0]}
  tappet: {mass: 0.5 kg, inertia: 0.001 kg*m^2, at: [0, 0.1]}
joints:
  shaft: {type: revolute, bodies: [ground, wheel], at: [0, 0]}
  guide: {type: prismatic, bodies: [ground, tappet], axis: [0, 1]}
  lobe:
    type: cam
    bodies: [wheel, tappet]
    at: [0, 0.05]
    radius: 10 mm
    curve: {x: 0.04*cos(s), y: 0.03*sin(s) + 0.01, range: [0, 2*pi], closed: true}
drives:
  turning: {joint: shaft, velocity: 10 rad/s}
gravity: [0, -9.81, 0]
solver: {end: 1 s}
""",
)
