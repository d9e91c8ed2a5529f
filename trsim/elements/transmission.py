"""What all transmissions share: one linear relation between coordinates of joints.

    Phi = sum_k c_k (x_k - x_k,0) = 0          x_k,0 as drawn

    angle    x_k' = a . (omega_j - omega_i)                 a the axis, which turns with body i
    stroke   x_k' = a . (v_j - v_i) + (omega_i x a) . d     d between the points of the joint

Bodies i and j are those of joint k, so the row names as many frames as its joints have bodies.  The
multiplier is a torque -lambda c_k, or a force, on body j of joint k along its coordinate, and the
opposite on body i: together they do no work.  They are what channels tell.  Forces of teeth on
bearings are not among them: wheels act on each other and on their carrier by torques alone.
"""

from typing import Any, ClassVar, NamedTuple

from trsim.elements.contract import Channel, Element, Pair, Reach, Row, kernel, measured
from trsim.elements.frames import (
    arm,
    centripetal,
    cross,
    dot,
    minus,
    plus,
    relative_spin,
    separation,
    spin,
    velocity,
)
from trsim.errors import ScenarioError, described
from trsim.fields import Spec
from trsim.kernels.columns import constraint_row, f8, i8, run
from trsim.kernels.lazy import internal

PARALLEL = 1e-6  # sine of an angle, or a part of a distance, that is none
TOUCH = 1e-3  # of a radius: how far wheels as drawn may be from touching

WHERE, TERM = 6, 11  # numbers of a term in `where` and in `terms`


class Own(Pair):
    """Of one instance; i and j are those of its first joint."""

    relation: constraint_row
    number: i8  # of terms
    where: run(i8)  # of each: frames i and j, their lines of J, coordinate, whether it turns
    terms: run(f8)  # and its coefficient, value as drawn, points on i and j, axis


class Transmission(Spec):
    """A relation of coordinates of joints.

    joints  whose coordinates they are; of a joint with several say which: `shaft.angle`
    """

    # it has no bodies of its own and no place: those of its joints
    bodies: ClassVar[tuple] = ()
    at: ClassVar[None] = None
    joints: tuple[str, ...]


# --- which joints, and what they share -------------------------------------------------------


class Carried(NamedTuple):
    """Two joints on one carrier; of each 1 where the carrier is its first body, else -1."""

    x: Any
    y: Any
    of_x: float
    of_y: float


def carried(spec: Any, kinds: tuple[str, str], at: Any) -> Carried:
    """The coordinates of two joints that share one body."""
    x, y = (
        at.coordinate(joint, kind, ("joints", k))
        for k, (joint, kind) in enumerate(zip(spec.joints, kinds, strict=True))
    )
    what = f"'{x.joint}' and '{y.joint}'"
    if x.joint == y.joint:
        raise ScenarioError(f"names '{x.joint}' twice", "name two joints", ("joints",))
    common = {x.i, x.j} & {y.i, y.j}
    if len(common) == 2:
        raise ScenarioError(
            f"{what} join the same two bodies",
            "one of the two bodies is the carrier, and each has a part of its own on it",
            ("joints",),
        )
    bars = {at.owners[x.i], at.owners[x.j]} & {at.owners[y.i], at.owners[y.j]}
    if not common and bars:
        raise ScenarioError(
            f"{what} hold on to different places of '{min(bars)}', a flexible bar, and a carrier "
            "is rigid",
            "make the bar rigid, or use a `coupler` of the two coordinates",
            ("joints",),
        )
    if not common:
        raise ScenarioError(
            f"{what} share no carrier: {joined(x, at)}, and {joined(y, at)}",
            "name the joints that hold the two parts on one body, or use a `coupler`, which needs "
            "none",
            ("joints",),
        )
    (carrier,) = common
    for one in (x, y):
        if one.from_drawing and one.i != carrier:
            raise ScenarioError(
                f"the axis of '{one.name}' does not turn with the carrier "
                f"'{at.owners[carrier]}', and the wheel on it would not stay in its place",
                "put a hinge there, or use a `coupler` of the two coordinates",
                ("joints",),
            )
    return Carried(x, y, *(1.0 if one.i == carrier else -1.0 for one in (x, y)))


def joined(x: Any, at: Any) -> str:
    """In words what a joint joins."""
    return f"'{x.joint}' joins '{at.owners[x.i]}' and '{at.owners[x.j]}'"


def one_of(spec: Any, *keys: str) -> None:
    """Refuse a spec that has none of some keys, or several.  Raises ValueError."""
    given = [key for key in keys if getattr(spec, key) is not None]
    if len(given) != 1:
        found = f"got {' and '.join(given)}" if given else "got none"
        raise ValueError(f"give {', '.join(keys[:-1])} or {keys[-1]}: one of them; {found}")


def not_zero(ratio: float | None) -> None:
    """Refuse a ratio that holds one of its joints fast."""
    if ratio == 0.0:
        raise ScenarioError(
            "a ratio must not be zero", "it would hold a joint; use `fixed`", ("ratio",)
        )


def whole(teeth: tuple[float, float] | None) -> None:
    """Refuse a part of a tooth."""
    for k, number in enumerate(teeth or ()):
        if number != round(number):
            what = f"must be a whole number of teeth, got {described(number)}"
            raise ScenarioError(what, "give a `ratio` where it is none of teeth", ("teeth", k))


# --- the drawing -----------------------------------------------------------------------------


def product(a: Any, b: Any) -> float:
    """a . b of numbers."""
    return float(sum(p * q for p, q in zip(a, b, strict=True)))


def apart(x: Any, y: Any) -> tuple[float, ...]:
    """From the place of one joint to that of another, as drawn."""
    return tuple(q - p for p, q in zip(x.place, y.place, strict=True))


def size(v: Any) -> float:
    """Length of a vector of numbers."""
    return float(product(v, v) ** 0.5)


def aside(x: Any, y: Any) -> tuple[float, float]:
    """How far the place of joint y lies from the axis of x, and from its place, as drawn."""
    d = apart(x, y)
    along = product(d, x.axis)
    return size(tuple(p - along * q for p, q in zip(d, x.axis, strict=True))), size(d)


# --- the row ---------------------------------------------------------------------------------


def relation(coordinates: Any, coefficients: Any) -> Row:
    """The row sum_k c_k (x_k - x_k,0) = 0; in rad where all are angles, else in m."""
    angles = [x.kind == "angle" for x in coordinates]
    turns = all(angles)
    # by the largest coefficient, of a stroke where there is one
    unit = max(abs(c) for c, angle in zip(coefficients, angles, strict=True) if turns or not angle)
    named = tuple(dict.fromkeys(f for x in coordinates for f in (x.i, x.j)))
    where, terms, channels = [], [], []
    for k, (x, c, angle) in enumerate(zip(coordinates, coefficients, angles, strict=True)):
        where += [x.i, x.j, named.index(x.i), named.index(x.j), x.entry, int(angle)]
        terms += [c / unit, x.drawn, *x.s_i, *x.s_j, *x.axis_i]
        channels.append(channel(k, "N*m" if angle else "N"))
    first = coordinates[0]
    own = Own.packed(
        i=first.i, j=first.j, coordinate=-1, number=len(coordinates), where=where, terms=terms
    )
    entries = tuple(x.entry for x in coordinates)
    return Row(*own, channels=tuple(channels), turns=turns, relates=entries, named=(named,))


def channel(k: int, unit: str) -> Channel:
    """What the relation puts on the second body of the k-th joint."""
    word, way = ("torque", "about") if unit == "N*m" else ("force", "along")
    return Channel(
        f"{word}_{k + 1}", unit, f"{word} on the second body of joint {k + 1}, {way} its axis"
    )


@internal
def add(J, line, c, f, m):
    """A line of J += the force c f and the moment c m."""
    for a in range(3):
        J[line, a] += c * f[a]
        J[line, 3 + a] += c * m[a]


@internal
def angle_term(scene, e, q, k):
    """What the q-th coordinate of instance e, an angle, adds to row k."""
    own, first = Own(scene, e), scene.row_start[k]
    where, p, n, o = own.where, own.terms, WHERE * q, TERM * q
    i, j, c, none = where[n], where[n + 1], p[o], (0.0, 0.0, 0.0)
    axis = arm(scene.X, i, (p[o + 8], p[o + 9], p[o + 10]))
    add(scene.J, first + where[n + 2], -c, none, axis)
    add(scene.J, first + where[n + 3], c, none, axis)
    turning = cross(spin(scene.V, i), axis)
    scene.gamma[k] -= c * dot(turning, relative_spin(scene.V, i, j))


@internal
def stroke_term(scene, e, q, k):
    """The same of a stroke."""
    X, V, own, first = scene.X, scene.V, Own(scene, e), scene.row_start[k]
    where, p, n, o = own.where, own.terms, WHERE * q, TERM * q
    i, j, c = where[n], where[n + 1], p[o]
    axis = arm(X, i, (p[o + 8], p[o + 9], p[o + 10]))
    p_i = arm(X, i, (p[o + 2], p[o + 3], p[o + 4]))
    p_j = arm(X, j, (p[o + 5], p[o + 6], p[o + 7]))
    d = separation(X, i, p_i, j, p_j)
    # the axis turns with body i, so its lever there reaches to the point on j
    add(scene.J, first + where[n + 2], -c, axis, cross(plus(p_i, d), axis))
    add(scene.J, first + where[n + 3], c, axis, cross(p_j, axis))
    d_dot = minus(velocity(V, j, p_j), velocity(V, i, p_i))
    inward = minus(centripetal(V, j, p_j), centripetal(V, i, p_i))
    scene.gamma[k] -= c * (
        dot(axis, inward)
        + dot(centripetal(V, i, axis), d)
        + 2.0 * dot(cross(spin(V, i), axis), d_dot)
    )


@kernel
def constraint(t, scene, e):
    J, own = scene.J, Own(scene, e)
    k = own.relation
    if k < 0:
        return
    where, terms = own.where, own.terms
    scene.phi[k], scene.phi_t[k], scene.gamma[k] = 0.0, 0.0, 0.0
    for line in range(scene.row_start[k], scene.row_start[k + 1]):
        for c in range(6):
            J[line, c] = 0.0
    for q in range(own.number):
        x = scene.S[where[WHERE * q + 4], 0]
        scene.phi[k] += terms[TERM * q] * (x - terms[TERM * q + 1])
        if where[WHERE * q + 5] == 1:
            angle_term(scene, e, q, k)
        else:
            stroke_term(scene, e, q, k)


@measured
def measure(t, scene, e, o):
    own = Own(scene, e)
    k, terms = own.relation, own.terms
    for q in range(own.number):
        scene.out[o + q] = -scene.lam[k] * terms[TERM * q] if k >= 0 else 0.0


def acts_at(row):
    """Where its joints are."""
    own, found = Own.of(row), []
    for q in range(own.number):
        points = own.terms[TERM * q + 2 : TERM * q + 8]
        i, j = own.where[WHERE * q : WHERE * q + 2]
        found += [(i, points[:3]), (j, points[3:])]
    return tuple(found)


def reach(row):
    """Its torques are about the axes of hinges, its forces along those of slides."""
    own, hinges, slides = Own.of(row), [], []
    for q in range(own.number):
        i, turns = own.where[WHERE * q], own.where[WHERE * q + 5]
        axis = own.terms[TERM * q + 8 : TERM * (q + 1)]
        (hinges if turns else slides).append((i, axis))
    return Reach(hinges=tuple(hinges), slides=tuple(slides))


def transmission(
    key: str, spec: type, pack: Any, units: tuple[str, ...], example: str, picture: str = ""
) -> Element:
    """The element of a relation; units: of its channels, for explanations."""
    return Element(
        key=key,
        section="joints",
        spec=spec,
        pack=pack,
        rows=("relation",),
        bears=False,
        channels=tuple(channel(k, unit) for k, unit in enumerate(units)),
        acts_at=acts_at,
        reach=reach,
        picture=picture,
        kernels={"constraint": constraint, "measure": measure},
        example=example,
    )
