"""Rope: a line of constant length through points of bodies, over wheels, and onto drums.

    Phi = sum_j (l_j - rho_j alpha_j) - s_1 r_1 phi_1 + s_n r_n phi_n - const = 0

Part j runs from guide a to guide b, whose centres are D apart, along the unit vector e; its normal
n points to the left of e.  A guide (a point, eye, wheel or drum) has a radius r, zero for a point
or an eye, and a side s: 1 if the rope goes round it to the left, counterclockwise, and -1 if to the
right:

    n . D = rho = s_b r_b - s_a r_a        l = e . D = (D . D - rho^2)^(1/2)

    alpha    angle of e, unwrapped; the rope touches a wheel over the length r s (alpha' - alpha),
             of the parts after and before it
    phi      angle of a drum, which is a wheel at an end; the rope wound on it turns with it

As e turns by d alpha, l changes by e . dD + rho d alpha, so

    Phi'  = sum e . D' - s_1 r_1 phi_1' + s_n r_n phi_n'
    Phi'' = sum (e . D'' + (D' . D' - (e . D')^2) / l) + ...

Each part pulls at the centres; on a drum it also exerts the torque tension times radius.  A wheel
between the ends is not turned by the rope, because there is no friction; for a wheel with inertia
use two ropes that end on the same drum.  tension is the multiplier, positive in tension; the row
acts in both directions, so the rope can also push.  A rope through points and eyes alone may lie in
space; wheels need a scene in the x-y plane.
"""

from itertools import pairwise
from math import atan2, pi, sqrt
from typing import Annotated, ClassVar, Literal

from annotated_types import Ge, Gt

from trsim.elements.contract import Channel, Element, Limit, Pair, Row, Turning, kernel, measured
from trsim.elements.frames import arm, centripetal, cross, dot, minus, point, velocity
from trsim.elements.frames import nearest_branch as unwrapped
from trsim.elements.transmission import add
from trsim.errors import ScenarioError
from trsim.fields import Spec, Unit
from trsim.fields import point as of_place
from trsim.kernels.columns import constraint_row, f8, i8, run
from trsim.kernels.lazy import internal

WHERE, TERM = 2, 4  # numbers of a place in `where` and in `terms`
LEAST = 1e-9  # of the longest part: one so short has no direction
WRAP = 1e-9  # rad: a wheel that is touched by less is not touched
NEXT_TO = 1e-3  # of the radius of a wheel: a part so short has all but run up to it
SLACK = 1e-6  # of the largest tension: what is none


class Place(Spec):
    """What a rope goes through, or over.

    body    the body it is on, or `ground`
    at      the eye, or the centre of the wheel, as drawn
    radius  radius to the middle of the rope, of a wheel, or of a drum at an end; 0: an eye or a
            point
    turn    which way the rope goes round it, seen against the z direction: left is counterclockwise
    """

    type: ClassVar[str] = "place"
    body: str
    at: of_place("m")
    radius: Annotated[float, Ge(0), Unit("m")] = 0.0
    turn: Literal["left", "right"] | None = None

    @property
    def bend(self):
        """Radius, positive to the left."""
        return -self.radius if self.turn == "right" else self.radius


class Rope(Spec):
    """A massless rope that does not stretch; it slides through eyes and over wheels.

    through  two or more points, eyes or wheels, in order; the first and the last are its ends,
             fixed there or wound on a drum
    length   length between the ends, without what is wound on drums; as drawn unless given
    """

    # it has no two bodies and no place of its own
    bodies: ClassVar[tuple] = ()
    at: ClassVar[None] = None
    type: ClassVar[str] = "rope"
    through: tuple[Place, ...]
    length: Annotated[float, Gt(0), Unit("m")] | None = None

    @property
    def goes_slack(self):
        """The channel that falls through a value where it goes slack, and the value."""
        return "tension", 0.0


class Own(Pair):
    """Of one instance; i and j are two of its bodies."""

    length: constraint_row
    number: i8  # of places
    angle: i8  # entry of S with alpha of the first part, the others behind it, then phi; or -1
    where: run(i8)  # of each place: its frame, and its line of J
    constant: f8  # m
    terms: run(f8)  # of each place: its point in the axes of its body, and s r


# --- packing -----------------------------------------------------------------------------


def pack(name, spec, at):
    places = spec.through
    if len(places) < 2:
        hint = "the first and the last place are its ends"
        raise ScenarioError("a rope goes through two places or more", hint, ("through",))
    check_turns(places)
    frames = [at.body(p.body, "through", k, "body", near=p.at) for k, p in enumerate(places)]
    named = tuple(dict.fromkeys(frames))
    if len(named) < 2:
        what = f"all its places are on '{places[0].body}'"
        raise ScenarioError(what, "a rope joins two bodies or more", ("through",))
    parts = [part(places, k) for k in range(len(places) - 1)]
    wheels = any(p.radius for p in places)
    angles = turned(places, parts) if wheels else []
    laid = sum(
        p.radius * wrap for p, wrap in zip(places[1:-1], wraps(places, angles), strict=False)
    )
    drawn = sum(length for length, _ in parts) + laid
    ends = [drawn_turn(at, frames[k]) for k in (0, -1)]
    whole = sum(length for length, _ in parts)
    for k, alpha in enumerate(angles):
        whole -= (places[k + 1].bend - places[k].bend) * alpha
    whole += places[-1].bend * ends[1] - places[0].bend * ends[0]
    entries = [at.wound(f"{name} {k}", x) for k, x in enumerate([*angles, *ends] if wheels else ())]
    where, terms = [], []
    for p, f in zip(places, frames, strict=True):
        where += [f, named.index(f)]
        terms += [*at.local(f, p.at), p.bend]
    own = Own.packed(
        i=named[0], j=named[1], coordinate=-1, number=len(places), where=where, terms=terms,
        angle=entries[0] if wheels else -1,
        constant=whole + (0.0 if spec.length is None else spec.length - drawn),
    )  # fmt: skip
    limits = (Limit("wheel", 0.0, "m", "jammed", CAME_OFF),) if wheels else ()
    return Row(*own, limits=limits, named=(named,))


CAME_OFF = "came off one of its wheels, or ran up to one, and has nothing left there"


def drawn_turn(at, f):
    """The angle about z of the axes of a body as drawn."""
    return atan2(at.rotation[f][1, 0], at.rotation[f][0, 0])


def check_turns(places):
    """Refuse wheels without a side, sides without a wheel, and wheels out of the plane."""
    for k, p in enumerate(places):
        if (p.radius > 0.0) != (p.turn is not None):
            what = "a wheel needs `turn`" if p.radius else "`turn` is that of a wheel with a radius"
            hint = "left where the rope goes round it counterclockwise, else right"
            raise ScenarioError(what, hint, ("through", k, "turn"))
        if any(q.radius for q in places) and p.at[2] != places[0].at[2]:
            what = "wheels and the places between them lie in one plane, z alike"
            raise ScenarioError(what, "correct z of this place", ("through", k, "at"))


def part(places, k):
    """Length and angle of the k-th part as drawn."""
    p, q = places[k], places[k + 1]
    d = tuple(b - a for a, b in zip(p.at, q.at, strict=True))
    square, rho = sum(c * c for c in d), q.bend - p.bend
    largest = max(abs(c) for one in places for c in (*one.at, one.radius))
    if square - rho * rho <= (LEAST * largest) ** 2:
        what = "these two places coincide" if square == 0.0 else "the wheels overlap"
        hint = "there is no straight part of the rope from the one to the other"
        raise ScenarioError(f"{what} as drawn", hint, ("through", k + 1))
    length = sqrt(square - rho * rho)
    return length, atan2(length * d[1] - rho * d[0], length * d[0] + rho * d[1])


def turned(places, parts):
    """The angles of all parts, those of neighbours by what the rope lies along of a wheel."""
    angles = [parts[0][1]]
    for k, (_, angle) in enumerate(parts[1:], start=1):
        side = 1.0 if places[k].bend >= 0.0 else -1.0
        wrap = side * (angle - angles[-1]) % (2.0 * pi)
        if places[k].radius == 0.0:  # of an eye: what counts is that it goes on
            wrap = (wrap + pi) % (2.0 * pi) - pi
        elif not WRAP < wrap < 2.0 * pi - WRAP:
            what = "the rope goes straight past this wheel as drawn"
            raise ScenarioError(what, "leave it out, or draw it so that it bends", ("through", k))
        angles.append(angles[-1] + side * wrap)
    return angles


def wraps(places, angles):
    """What the rope lies along of each wheel between its ends, rad; of eyes something."""
    pairs = pairwise(angles)
    sides = (1.0 if p.bend >= 0.0 else -1.0 for p in places[1:-1])
    return [side * (after - before) for side, (before, after) in zip(sides, pairs, strict=False)]


# --- kernels -----------------------------------------------------------------------------


@internal
def centre(scene, own, k):
    """Frame of the k-th place, arm of its centre, and s r."""
    p, o = own.terms, TERM * k
    f = own.where[WHERE * k]
    return f, arm(scene.X, f, (p[o], p[o + 1], p[o + 2])), p[o + 3]


@internal
def straight(scene, own, k):
    """Unit vector along the k-th part, its length, and rho."""
    f, p, first = centre(scene, own, k)
    g, q, second = centre(scene, own, k + 1)
    d, rho = minus(point(scene.X, g, q), point(scene.X, f, p)), second - first
    square = dot(d, d)
    length = sqrt(square - rho * rho)
    if rho == 0.0:
        return (d[0] / length, d[1] / length, d[2] / length), length, rho
    e = ((length * d[0] + rho * d[1]) / square, (length * d[1] - rho * d[0]) / square, 0.0)
    return e, length, rho


@kernel
def coordinate(t, scene, e):
    X, V, S, own = scene.X, scene.V, scene.S, Own(scene, e)
    first, parts = own.angle, own.number - 1
    if first < 0:
        return
    for k in range(parts):
        along, length, _ = straight(scene, own, k)
        (f, p, _), (g, q, _) = centre(scene, own, k), centre(scene, own, k + 1)
        v = minus(velocity(V, g, q), velocity(V, f, p))
        S[first + k, 0] = unwrapped(atan2(along[1], along[0]), S[first + k, 0])
        S[first + k, 1] = (along[0] * v[1] - along[1] * v[0]) / length
    for k in range(2):
        s, f = first + parts + k, own.where[WHERE * parts * k]
        S[s, 0] = unwrapped(atan2(X[f, 6], X[f, 3]), S[s, 0])
        S[s, 1] = V[f, 5]


@kernel
def constraint(t, scene, e):
    V, J, S, own = scene.V, scene.J, scene.S, Own(scene, e)
    row, parts, angle = own.length, own.number - 1, own.angle
    if row < 0:
        return
    first = scene.row_start[row]
    for line in range(first, scene.row_start[row + 1]):
        for c in range(6):
            J[line, c] = 0.0
    phi, gamma = -own.constant, 0.0
    for k in range(parts):
        along, length, rho = straight(scene, own, k)
        (f, p, _), (g, q, _) = centre(scene, own, k), centre(scene, own, k + 1)
        v = minus(velocity(V, g, q), velocity(V, f, p))
        rate = dot(along, v)
        inward = minus(centripetal(V, g, q), centripetal(V, f, p))
        phi += length
        if angle >= 0:
            phi -= rho * S[angle + k, 0]
        gamma -= dot(along, inward) + (dot(v, v) - rate * rate) / length
        add(J, first + own.where[WHERE * k + 1], -1.0, along, cross(p, along))
        add(J, first + own.where[WHERE * k + 3], 1.0, along, cross(q, along))
    if angle >= 0:
        for k in range(2):  # drums
            place, sign = parts * k, 2.0 * k - 1.0
            bend = own.terms[TERM * place + 3]
            phi += sign * bend * S[angle + parts + k, 0]
            J[first + own.where[WHERE * place + 1], 5] += sign * bend
    scene.phi[row], scene.phi_t[row], scene.gamma[row] = phi, 0.0, gamma


@kernel
def gap(t, scene, e):
    """How far it has come off the wheel it lies on least, or up to one, m."""
    S, V, own, g = scene.S, scene.V, Own(scene, e), scene.gap
    g[e, 0], g[e, 1] = -1e300, 0.0
    if own.length < 0 or own.angle < 0:
        return
    for k in range(1, own.number - 1):
        bend, s = own.terms[TERM * k + 3], own.angle + k
        along = bend * (S[s, 0] - S[s - 1, 0])
        if bend != 0.0 and -along > g[e, 0]:
            g[e, 0], g[e, 1] = -along, -bend * (S[s, 1] - S[s - 1, 1])
    for k in range(own.number - 1):
        along, length, rho = straight(scene, own, k)
        (f, p, first), (h, q, second) = centre(scene, own, k), centre(scene, own, k + 1)
        least = NEXT_TO * max(abs(first), abs(second))
        if least > 0.0 and least - length > g[e, 0]:
            v = minus(velocity(V, h, q), velocity(V, f, p))
            g[e, 0], g[e, 1] = least - length, -dot(along, v) - rho * S[own.angle + k, 1]


@measured
def measure(t, scene, e, o):
    own = Own(scene, e)
    scene.out[o] = scene.lam[own.length] if own.length >= 0 else 0.0
    scene.out[o + 1] = max(0.0, -scene.out[o])


def doubts(name, spec, largest):
    """A rope that pushes."""
    push, when = largest(f"{name}.push")
    pull, _ = largest(f"{name}.tension")
    if push > SLACK * abs(pull):
        yield (
            f"joints.{name}: the rope pushes by {push:.4g} N at {when:.4g} s, where a real one "
            "would be slack: load it more, or go slower; what follows is that of a rod"
        )


def turning(row):
    """It holds points, and turns drums."""
    own = Own.of(row)
    places = range(own.number)
    points = tuple((own.where[WHERE * k], own.terms[TERM * k : TERM * k + 3]) for k in places)
    ends = [k for k in (0, own.number - 1) if own.terms[TERM * k + 3]]
    return Turning(points=points, frames=tuple(own.where[WHERE * k] for k in ends))


ELEMENT = Element(
    key="rope",
    section="joints",
    spec=Rope,
    pack=pack,
    rows=("length",),
    bears=False,
    channels=(
        Channel(
            "tension",
            "N",
            "tension of the rope, the same along its length; negative where "
            "the rope would be slack",
        ),
        Channel("push", "N", "force with which it pushes where it would be slack", least=0.0),
    ),
    loads={"tension": "force"},
    judged=lambda _: True,
    doubts=doubts,
    turning=turning,
    holds_twist=False,
    in_plane=lambda row: Own.of(row).angle >= 0,
    picture="strand",
    kernels={
        "constraint": constraint,
        "coordinate": coordinate,
        "gaps": gap,
        "measure": measure,
    },
    example="""
bodies:
  left: {mass: 3 kg, inertia: 0.01 kg*m^2, at: [-0.1, -1]}
  right: {mass: 2 kg, inertia: 0.01 kg*m^2, at: [0.5, -1]}
joints:
  rail: {type: prismatic, bodies: [ground, left], axis: [0, 1]}
  other: {type: prismatic, bodies: [ground, right], axis: [0, 1]}
  line:
    type: rope
    through:
      - {body: left, at: [-0.1, -1]}
      - {body: ground, at: [0, 0], radius: 10 cm, turn: right}
      - {body: ground, at: [0.4, 0], radius: 10 cm, turn: right}
      - {body: right, at: [0.5, -1]}
gravity: [0, -9.81, 0]
solver: {end: 0.5 s}
""",
)
