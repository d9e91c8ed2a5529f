"""What joints on a curve share: where on it they are, and the distance of a point from it.

p is the point of body j in the axes of the curve, which are fixed in body i, and v its rate there;
c, c' the curve (laws/curves.py) at the footpoint u of p, n the normal there towards the point:

    c' . (p - c) = 0                                 u, from the one at the last accepted point
    u'  = c' . v / (c' . c' - c'' . (p - c))
    Phi = n . (p - c) - r                            r: how far from the curve the point stays
    J   : the force n on body j at p, -n on body i at the same place
    Phi'' = n . p'' - (n . c'') (c' . v / |c'|)^2 / (c' . c' - c'' . (p - c))

The rate of n is along c', across p - c, and so is that of c; thus J has no part of them, and the
last term, with p'' as seen from body i, is all that the curvature adds.  A step is so short that
the tangent turns by less than a right angle in it: solve/march/turns.py knows u as it knows angles.
"""

from math import sqrt
from typing import Any

from trsim.elements.contract import Channel, Element, Limit, Reach, Turning, compiled
from trsim.elements.curve import Sampled, nearest
from trsim.elements.frames import Along, along_row, arm, carried, dot, plus, scaled, separation
from trsim.elements.joint import Joint
from trsim.elements.rows import ARC, Axes, JointRow, constraint_of
from trsim.errors import ScenarioError
from trsim.fields import direction
from trsim.kernels.columns import V3
from trsim.kernels.lazy import internal
from trsim.kernels.signatures import A1, i8, void
from trsim.laws.curves import dot2, footpoint, length, length_of, place, touch

SIDE = 1e-3  # of the radius of a roller: a centre nearer to the curve is on no side
OFF = 0.1  # of the size of a curve: how far beside it a point may be drawn


LENGTH = Channel("arc", "m", "length along the curve from its beginning, over all turns")


class OnCurve(Joint):
    """A joint of the second body on a curve of the first."""

    @property
    def points(self) -> tuple[Any, Any]:
        """Where it holds its bodies, as drawn: the origin of the curve, and the point on it."""
        return self.curve.at, self.at  # type: ignore[attr-defined]


# --- packing -----------------------------------------------------------------------------


def frames(spec: Any, at: Any) -> dict[str, Any]:
    """The columns of Axes of a joint on a curve: the axes of the curve in body i, its point in j;
    and those of the second body that coincide with them as drawn."""
    i, j = at.bodies(spec.bodies, spec.curve.at, spec.at)
    own, points = spec.curve.frame, {}
    points["p_i"], points["p_j"] = at.local(i, own.at), at.local(j, spec.at)
    axes = {"u_i": at.axes(i, own.x), "w_i": at.axes(i, own.y), "a_i": at.axes(i, own.z)}
    of_j = {"u_j": at.axes(j, own.x), "a_j": at.axes(j, own.z)}
    return {"i": i, "j": j, "coordinate": -1, "drawn": 0.0} | points | axes | of_j


def inside(spec: Any, p: Any) -> tuple[float, float]:
    """A point of the drawing in the coordinates of the curve."""
    own = spec.curve.frame
    x, y, _ = own.inside(tuple(a - b for a, b in zip(p, own.at, strict=True)))
    return x, y


def stored(curve: Sampled, spec: Any, at: Any) -> int:
    """Where in tab the numbers of a curve begin; its corners count for the size of a mechanism."""
    offset = len(at.tab)
    at.tab.extend(curve.numbers)
    body = at.body(spec.bodies[0], "bodies", 0, near=spec.curve.at)
    for x, y in (curve.place.min(axis=0), curve.place.max(axis=0)):
        at.local(body, spec.curve.frame.moved((float(x), float(y), 0.0)))
    return offset


def drawn_at(curve: Sampled, spec: Any, radius: float = 0.0) -> tuple[float, float, float]:
    """u and length at the footpoint of a point as drawn, and how far left of the curve it is.

    Raises ScenarioError for a point that is far from where it must be.
    """
    p = inside(spec, spec.at)
    u, along, c, c1 = settled(curve, nearest(curve, p)[0], p, 0)
    aside = (c1[0] * (p[1] - c[1]) - c1[1] * (p[0] - c[0])) / sqrt(c1[0] ** 2 + c1[1] ** 2)
    if abs(aside) <= SIDE * radius and radius > 0.0:
        what = "the centre of the roller is drawn on the curve, so nobody knows on which side it is"
        raise ScenarioError(what, "draw it a radius away from the curve", ("at",))
    off = abs(abs(aside) - radius)
    if off > OFF * curve.size:
        left = direction((-c1[1], c1[0])) if aside >= 0.0 else direction((c1[1], -c1[0]))
        x, y = (a + radius * b for a, b in zip(c, left, strict=True))
        there = spec.curve.frame.moved((x, y, 0.0))
        raise ScenarioError(
            f"is drawn {off:.3g} m away from where its curve holds it",
            f"the nearest such place is [{', '.join(f'{a:.6g}' for a in there)}]",
            ("at",),
        )
    return u, along, aside


@compiled(void(A1, i8, A1))
def write_settled(tab, line, out):
    """out = u, length, c, c' near u = out[0] of a point, or of a line by its normal, out[1:3]."""
    at = (out[1], out[2])
    u = touch(tab, 0, out[0], at) if line == 1 else footpoint(tab, 0, out[0], at)
    c, c1, _ = place(tab, 0, u)
    out[0], out[1] = u, length(tab, 0, u)
    out[2], out[3], out[4], out[5] = c[0], c[1], c1[0], c1[1]


def settled(curve: Sampled, u: float, p: Any, line: int) -> tuple[float, float, Any, Any]:
    """u near a given one, length, place and tangent, at the footpoint of a point or the touch of a
    line of normal p."""
    import numpy as np

    out = np.array([u, *p, 0.0, 0.0, 0.0])
    write_settled(np.array(curve.numbers), line, out)
    found = out.tolist()
    return found[0], found[1], found[2:4], found[4:6]


def ends_of(curve: Sampled) -> tuple[Limit, ...]:
    """What ends a run at the ends of an open curve."""
    if curve.closed:
        return ()
    return (Limit("end", curve.length, "m", "jammed", "came to an end of its curve, of length"),)


def reach(row: Any) -> Reach:
    """In the plane of the curve, where its point goes and is pushed."""
    own = Axes.of(row)
    return Reach(slides=((own.i, own.u_i), (own.i, own.w_i)))


def turning(row: Any) -> Turning:
    """Of the point of body j, in the axes of the curve."""
    own = Axes.of(row)
    return Turning(points=((own.j, own.p_j),), axes=((own.i, own.u_i), (own.i, own.w_i)))


def on_curve(rows: tuple[JointRow, ...], kernels: dict[str, Any], **other: Any) -> Element:
    """The element that rows of a joint on a curve make.

    other: fields of Element, also those that follow where they are to differ.
    """
    follows: dict[str, Any] = {
        "coordinates": (ARC,),
        "reach": reach,
        "turning": turning,
        "holds_twist": False,
        "meets": True,
    }
    return Element(
        section="joints",
        rows=tuple(row.name for row in rows),
        holds=tuple(row.holds for row in rows),
        kernels={"constraint": constraint_of(rows)} | kernels,
        **(follows | other),
    )


# --- what acts along a curve, or tells of it -------------------------------------------------


class AlongCurve(Along):
    """Of an element on a coordinate of a joint, which may be a length along a curve: its axis is
    that of the coordinate, or the x axis of the curve."""

    curve: i8  # in tab, or -1
    parameter: i8  # entry of S with u
    other: V3  # y axis of the curve


NO_CURVE = {"curve": -1, "parameter": -1, "other": (0.0, 0.0, 0.0)}


def along_curve(x: Any) -> dict[str, Any]:
    """These columns, of the coordinate of a joint."""
    curve, parameter, _ = x.curve
    return {"curve": curve, "parameter": parameter, "other": x.other_i}


def stays_on(x: Any) -> bool:
    """Whether its point is on the curve itself, and not beside it."""
    return bool(x.curve and x.curve[2])


@internal
def tangent(scene, own):
    """By how much the length along the curve grows with the point, world axes."""
    X, i, j = scene.X, own.i, own.j
    c, c1, c2 = place(scene.tab, own.curve, scene.S[own.parameter, 0])
    u, w = arm(X, i, own.axis), arm(X, i, own.other)
    d = separation(X, i, arm(X, i, own.p_i), j, arm(X, j, own.p_j))
    fall = dot2(c1, c1) - dot2(c2, (dot(u, d) - c[0], dot(w, d) - c[1]))
    size = sqrt(dot2(c1, c1)) / fall
    return plus(scaled(size * c1[0], u), scaled(size * c1[1], w))


# --- kernels -----------------------------------------------------------------------------


@internal
def seen(scene, e, own):
    """The point of body j and its velocity, in the axes of the curve."""
    _, _, d, v = carried(scene, e)
    u, w = arm(scene.X, own.i, own.u_i), arm(scene.X, own.i, own.w_i)
    return (dot(u, d), dot(w, d)), (dot(u, v), dot(w, v))


@internal
def write_place(scene, own, u, c1, rate):
    """u and the length of the curve there, with their rates."""
    S = scene.S
    S[own.parameter, 0], S[own.parameter, 1] = u, rate
    if own.coordinate >= 0:
        S[own.coordinate, 0] = length(scene.tab, own.curve, u)
        S[own.coordinate, 1] = sqrt(dot2(c1, c1)) * rate


@internal
def stay(scene, own):
    """What has come off its curve is at no place along it: it is told where it left."""
    u = scene.S[own.parameter, 0]
    write_place(scene, own, u, place(scene.tab, own.curve, u)[1], 0.0)


@internal
def follow(scene, e, own):
    """The footpoint of the point of body j."""
    p, v = seen(scene, e, own)
    u = footpoint(scene.tab, own.curve, scene.S[own.parameter, 0], p)
    c, c1, c2 = place(scene.tab, own.curve, u)
    fall = dot2(c1, c1) - dot2(c2, (p[0] - c[0], p[1] - c[1]))
    write_place(scene, own, u, c1, dot2(c1, v) / fall)


@internal
def distance_row(scene, e, own, k, side, radius):
    """n . (p - c) - r as row k; side: 1 where n points left of the curve, -1 to the right."""
    u = scene.S[own.parameter, 0]
    c, c1, c2 = place(scene.tab, own.curve, u)
    p, v = seen(scene, e, own)
    size = sqrt(dot2(c1, c1))
    n = (-side * c1[1] / size, side * c1[0] / size)
    x, y = arm(scene.X, own.i, own.u_i), arm(scene.X, own.i, own.w_i)
    along_row(scene, e, plus(scaled(n[0], x), scaled(n[1], y)), k)
    fall = dot2(c1, c1) - dot2(c2, (p[0] - c[0], p[1] - c[1]))
    along = dot2(c1, v) / size
    scene.phi[k] -= dot2(n, c) + radius
    scene.gamma[k] += dot2(n, c2) * along * along / fall


@internal
def end_gap(scene, e, own, row):
    """How far the place on an open curve is beyond its nearer end, m, and its rate."""
    s, rate = scene.S[own.coordinate, 0], scene.S[own.coordinate, 1]
    whole = length_of(scene.tab, own.curve)
    if row < 0:  # it has come apart
        scene.gap[e, 0], scene.gap[e, 1] = -whole, 0.0
    elif s > 0.5 * whole:
        scene.gap[e, 0], scene.gap[e, 1] = s - whole, rate
    else:
        scene.gap[e, 0], scene.gap[e, 1] = -s, -rate
