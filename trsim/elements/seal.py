"""Seal: a soft strip along a line of body j that is pressed against a plane of body i.

    h(u) = n . (r_j + R_j (a + u (b - a)) - r_i - p_i)      height of the line over the plane
    x    = height - h                                       compression, 0 <= u <= 1
    q    = q_0 (x / x_0)^e                                  load per length, N/m, where x > 0
    F_n  = L (integral of q du) n                           on body j, at the centre of pressure
    F_d = L sum w q max(c x', -1) n,   F_t = -L sum w q mu g(|v_t|) v_t / |v_t|

The elastic load is integrated exactly over the part of the line that is compressed.  It depends on
the length of that part alone, however the contact breaks into patches.  Damping and friction are
integrated by Gauss's rule on pieces of that part: sliding changes linearly along the line,

    v_t(u) = v_0 + u d,    u* = -v_0 . d / |d|^2,    m = |v_t(u*)|

so friction is smooth in z, u = u* + m / |d| sinh z, where it is full, and in u where it is not:
where a line pivots about one of its points, the pieces are cut there (laws/seal.py), and where
c x' = -1, as a seal that is let go of does not pull.  With `springs`, all loads are summed over
equal pieces of the line.  Forces act at the projections of the points of the line onto the plane,
with opposite signs on the two bodies.

Steps end where the slowest point of that part reaches the speed `full_from`; of an integrated seal
no other corner of friction remains inside them.  Beyond the ends of a branch friction goes on as on
it: it stays full, FULL being so along the whole line, or grows with the speed of the slowest point.
"""

from math import sqrt
from typing import Annotated, ClassVar

from annotated_types import Ge, Gt, Le
from pydantic import model_validator

from trsim.elements.contract import (
    CONTACTS,
    FLIGHT,
    FRICTION,
    IMPACTS,
    WHOLE,
    Channel,
    Contact,
    Element,
    Reach,
    Row,
    Turning,
    kernel,
    measured,
)
from trsim.elements.frames import (
    Edge,
    arm,
    dot,
    minus,
    plus,
    point,
    points,
    push_apart,
    scaled,
    turned_round,
    velocity,
)
from trsim.errors import ScenarioError
from trsim.fields import Spec, Unit, direction, vector
from trsim.fields import point as place
from trsim.kernels.columns import V3, f8, i8, run
from trsim.kernels.lazy import internal
from trsim.laws.friction import CODES, FULL, N_PARAMETERS, ON_RAMP, friction_force
from trsim.laws.seal import (
    NODES,
    PIECES,
    cuts,
    least_speed,
    line_load,
    node,
    panels,
    pressed_part,
)

MOST = 1000  # springs


class SealLine(Spec):
    """A straight line of a body.

    body   the body
    start  one end, as drawn
    end    the other end, as drawn
    """

    type: ClassVar[str] = "line"
    body: str
    start: place("m")
    end: place("m")


class SealPlane(Spec):
    """A plane of a body.

    body    the body
    at      a point of the plane, as drawn
    normal  normal towards the seal, as drawn; turns with the body
    """

    type: ClassVar[str] = "plane"
    body: str
    at: place("m")
    normal: vector("-")


class Seal(Spec):
    """A seal along a line that is pressed against a plane.

    line         the line along which it lies
    against      the plane it is pressed against
    height       height of the seal above its line when it is not compressed
    load         load per length at the compression `at`
    at           compression at which it has that load
    exponent     exponent of the compression
    damping      fraction by which the load increases per speed of compression
    friction     coefficient of friction
    full_from    sliding speed from which friction is full
    springs      number of equal springs that replace it; without it the load is integrated along
                 the line
    """

    type: ClassVar[str] = "seal"
    line: SealLine
    against: SealPlane
    height: Annotated[float, Ge(0), Unit("m")] = 0.0
    load: Annotated[float, Gt(0), Unit("N/m")]
    at: Annotated[float, Gt(0), Unit("m")]
    exponent: Annotated[float, Ge(1), Le(5), Unit("-")] = 1.0
    damping: Annotated[float, Ge(0), Unit("s/m")] = 0.0
    friction: Annotated[float, Ge(0), Unit("-")] = 0.0
    full_from: Annotated[float, Gt(0), Unit("m/s")] = 1e-3
    springs: Annotated[int, Gt(0), Le(MOST)] | None = None

    @model_validator(mode="after")
    def some_line(self):
        if self.line.start == self.line.end:
            raise ScenarioError("the line has no length", "give two ends", ("line", "end"))
        if not any(self.against.normal):
            raise ScenarioError("`normal` must not be zero", "", ("against", "normal"))
        return self


class Own(Edge):
    """Of one instance; the line begins at p_j."""

    axis: V3  # n in the axes of body i
    along: V3  # from one end to the other, in the axes of body j
    springs: i8  # 0: integrated
    height: f8
    load: f8  # N/m
    at: f8
    exponent: f8
    damping: f8
    friction_law: i8  # one of CODES: none or modified_coulomb
    friction: run(f8, N_PARAMETERS)


def pack(name, spec, at):
    line, plane = spec.line, spec.against
    if line.body == plane.body:
        what = f"line and plane are both on '{line.body}'"
        raise ScenarioError(what, "name two different bodies", ("line", "body"))
    i = at.body(plane.body, "against", "body", near=plane.at, off=1.0)
    j = at.body(line.body, "line", "body", near=line.start, off=1.0)
    across = tuple(q - p for p, q in zip(line.start, line.end, strict=True))
    length = sqrt(sum(c * c for c in across))
    at.local(j, line.end)
    rubs = "modified_coulomb" if spec.friction > 0.0 else "none"
    own = Own.packed(
        spec, friction_law=CODES[rubs],
        friction=(spec.friction, 0.0, spec.full_from, *[0.0] * (N_PARAMETERS - 3)),
        **points(at, i, j, plane.at, line.start), axis=at.axes(i, direction(plane.normal)),
        along=at.axes(j, across), length=length, springs=spec.springs or 0,
    )  # fmt: skip
    stiffness = spec.load * length / spec.at**spec.exponent
    ramp = spec.full_from if spec.friction > 0.0 else 0.0
    contact = Contact(stiffness, spec.exponent, float("inf"), 0.0, 0.0, ramp=ramp)
    return Row(*own, contact, travel="edge")


# --- kernels -----------------------------------------------------------------------------


@internal
def ends(scene, e):
    """n, the arm of the line's beginning on body j, the line, both in world axes, and compression
    at both ends."""
    X, own = scene.X, Own(scene, e)
    n, p_j, along = arm(X, own.i, own.axis), arm(X, own.j, own.p_j), arm(X, own.j, own.along)
    d = minus(point(X, own.j, p_j), point(X, own.i, arm(X, own.i, own.p_i)))
    x_0 = own.height - dot(n, d)
    return n, p_j, along, x_0, x_0 - dot(n, along)


@internal
def meets(scene, e, n, p_j, compression):
    """A place of the line, of arm p_j, as seen on the plane: its arms on both bodies, the speed of
    compression and the sliding velocity there."""
    X, V, own = scene.X, scene.V, Own(scene, e)
    c_j = minus(p_j, scaled(own.height - compression, n))
    c_i = minus(point(X, own.j, c_j), (X[own.i, 0], X[own.i, 1], X[own.i, 2]))
    v = minus(velocity(V, own.j, c_j), velocity(V, own.i, c_i))
    rate = -dot(n, v)
    return c_i, c_j, rate, plus(v, scaled(rate, n))


@internal
def drawn_on(own, slowest):
    """What friction on its branch is at least, a part of the full one, and how many times what the
    law makes of it."""
    if own.branch == FULL:
        return 1.0, 1.0
    if own.branch == ON_RAMP:
        return 0.0, max(slowest / own.friction[2], 1.0)
    return 0.0, 1.0


@internal
def lossy(own, q, rate, v_t, n, branch):
    """Damping and friction on body j of a load q, N, and their power; branch: see `drawn_on`."""
    speed, (least, times) = sqrt(dot(v_t, v_t)), branch
    slow, _ = friction_force(own.friction_law, q, speed, 0.0, own.friction)
    slow = times * min(slow, -least * own.friction[0] * q)
    damp = max(q * own.damping * rate, -q)
    f = scaled(damp, n)
    if speed > 0.0:
        f = plus(f, scaled(slow / speed, v_t))
    return f, -damp * rate, slow * speed


@internal
def load_at(own, x):
    """Load per length, N/m."""
    return own.load * (x / own.at) ** own.exponent if x > 0.0 else 0.0


@internal
def lump(scene, e, u, weight, branch):
    """Arms, force on body j, its power as damping and as friction, of the part `weight` of the line
    at u; with its elastic force where that is a sum."""
    own = Own(scene, e)
    n, p_j, along, x_0, x_1 = ends(scene, e)
    x = x_0 + u * (x_1 - x_0)
    q = own.length * weight * load_at(own, x)
    c_i, c_j, rate, v_t = meets(scene, e, n, plus(p_j, scaled(u, along)), x)
    f, damped, rubbed = lossy(own, q, rate, v_t, n, branch)
    if own.springs > 0:
        f = plus(f, scaled(q, n))
    return c_i, c_j, f, damped, rubbed


@internal
def place_of(own, cuts, piece, k):
    """The k-th place of a sum along a piece of the line, and its weight."""
    if own.springs > 0:
        return (k + 0.5) / own.springs, 1.0 / own.springs
    return node(cuts, piece, k // len(NODES), k % len(NODES))


@internal
def pieces(own):
    """Of a sum along the line."""
    return 1 if own.springs > 0 else PIECES


@internal
def places(own, cuts, piece):
    """How many there are in a sum along a piece."""
    return own.springs if own.springs > 0 else panels(cuts, piece) * len(NODES)


@internal
def cuts_of(scene, e, slides, full):
    """Where the pieces of the pressed part end; full: whether all of it is drawn as rubbing
    fully.  Damping has a kink where the line is let go of faster than the load follows."""
    own = Own(scene, e)
    n, p_j, along, x_0, x_1 = ends(scene, e)
    low, high = pressed_part(x_0, x_1)
    clip = low
    if own.damping > 0.0:
        _, _, first, _ = meets(scene, e, n, p_j, x_0)
        _, _, last, _ = meets(scene, e, n, plus(p_j, along), x_1)
        if first != last:
            clip = (-1.0 / own.damping - first) / (last - first)
    v_1 = 0.0 if full or own.friction_law == 0 else own.friction[2]
    if own.friction_law == 0:
        slides = (n, (0.0, 0.0, 0.0))
    return cuts((low, high), slides, v_1, clip, (x_0 <= 0.0, x_1 <= 0.0))


@kernel
def force(t, scene, e):
    own = Own(scene, e)
    if own.phase == FLIGHT:
        return
    n, p_j, along, x_0, x_1 = ends(scene, e)
    low, high = pressed_part(x_0, x_1)
    if low == high:
        return
    branch, slides = (0.0, 1.0), sliding(scene, e)
    if own.friction_law != 0 and own.branch != WHOLE:
        left, slowest = scene.left, least_speed((low, high), slides[0], slides[1])
        branch = drawn_on(own, slowest)
        left[e] = max(left[e], full_beyond(own, slowest))
        if turned_round(scene, e, middle_of(low, high, slides)):
            left[e] = max(left[e], own.friction[2])
    if own.springs == 0:
        whole, first, _ = line_load(x_0 / own.at, x_1 / own.at, own.exponent)
        u = first / whole if whole > 0.0 else 0.0
        c_i, c_j, _, _ = meets(scene, e, n, plus(p_j, scaled(u, along)), x_0 + u * (x_1 - x_0))
        push_apart(scene.F, own.i, c_i, own.j, c_j, scaled(own.load * own.length * whole, n))
        if own.damping == 0.0 and own.friction_law == 0:
            return
    at = cuts_of(scene, e, slides, branch[0] > 0.0)
    for piece in range(pieces(own)):
        for k in range(places(own, at, piece)):
            u, weight = place_of(own, at, piece, k)
            c_i, c_j, f, damped, rubbed = lump(scene, e, u, weight, branch)
            push_apart(scene.F, own.i, c_i, own.j, c_j, f)
            scene.zd[IMPACTS] += damped
            scene.zd[FRICTION] += rubbed


@kernel
def gap(t, scene, e):
    n, p_j, along, x_0, x_1 = ends(scene, e)
    u, x = (0.0, x_0) if x_0 >= x_1 else (1.0, x_1)
    _, _, rate, _ = meets(scene, e, n, plus(p_j, scaled(u, along)), x)
    scene.gap[e, 0], scene.gap[e, 1] = x, rate


@internal
def full_beyond(own, slowest):
    """How far friction has left its branch, m/s: full along the whole line, or on its ramp."""
    late = own.friction[2] - slowest
    return late if own.branch == FULL else -late


@internal
def sliding(scene, e):
    """How the beginning of the line slides, and how much else its end does: linear in between."""
    n, p_j, along, x_0, x_1 = ends(scene, e)
    _, _, _, first = meets(scene, e, n, p_j, x_0)
    _, _, _, last = meets(scene, e, n, plus(p_j, along), x_1)
    return first, minus(last, first)


@internal
def middle_of(low, high, slides):
    """How the middle of a part slides."""
    return plus(slides[0], scaled(0.5 * (low + high), slides[1]))


@kernel
def corners(t, scene, e):
    out, slid, own = scene.corner, scene.slid, Own(scene, e)
    out[e, 0], slid[e, 0], slid[e, 1], slid[e, 2] = -1.0, 0.0, 0.0, 0.0
    if own.phase == FLIGHT or own.friction_law == 0:
        return
    _, _, _, x_0, x_1 = ends(scene, e)
    (low, high), slides = pressed_part(x_0, x_1), sliding(scene, e)
    if low == high:
        return
    slowest = least_speed((low, high), slides[0], slides[1])
    if own.branch == FULL:
        slid[e, 0], slid[e, 1], slid[e, 2] = middle_of(low, high, slides)
    if own.branch == WHOLE:
        out[e, 1] = FULL if slowest > own.friction[2] else ON_RAMP
        return
    out[e, 0] = full_beyond(own, slowest)
    out[e, 1] = ON_RAMP if own.branch == FULL else FULL


@kernel
def energy(t, scene, e):
    own = Own(scene, e)
    if own.phase == FLIGHT:
        return
    _, _, _, x_0, x_1 = ends(scene, e)
    if own.springs == 0:
        _, _, stored = line_load(x_0 / own.at, x_1 / own.at, own.exponent)
        scene.E[CONTACTS] += own.load * own.length * own.at * stored
        return
    for k in range(own.springs):
        u = (k + 0.5) / own.springs
        x = x_0 + u * (x_1 - x_0)
        scene.E[CONTACTS] += (
            own.length / own.springs * load_at(own, x) * max(x, 0.0) / (own.exponent + 1.0)
        )


@measured
def measure(t, scene, e, o):
    out, own = scene.out, Own(scene, e)
    n, _, _, x_0, x_1 = ends(scene, e)
    low, high = pressed_part(x_0, x_1)
    total, branch = scaled(0.0, n), (0.0, 1.0)
    if own.phase != FLIGHT and high > low:
        slides = sliding(scene, e)
        if own.friction_law != 0 and own.branch != WHOLE:
            branch = drawn_on(own, least_speed((low, high), slides[0], slides[1]))
        if own.springs == 0:
            whole, _, _ = line_load(x_0 / own.at, x_1 / own.at, own.exponent)
            total = scaled(own.load * own.length * whole, n)
        at = cuts_of(scene, e, slides, branch[0] > 0.0)
        for piece in range(pieces(own)):
            for k in range(places(own, at, piece)):
                u, weight = place_of(own, at, piece, k)
                _, _, f, _, _ = lump(scene, e, u, weight, branch)
                total = plus(total, f)
    f_n = dot(n, total)
    f_t = minus(total, scaled(f_n, n))
    out[o], out[o + 1] = f_n, sqrt(dot(f_t, f_t))
    out[o + 2], out[o + 3] = max(x_0, x_1), (high - low) * own.length
    for c in range(3):
        out[o + 4 + c] = total[c]


# --- what others ask -----------------------------------------------------------------------


def both_ends(row):
    """The places where it may push body j; of body i none is known before."""
    own = Own.of(row)
    end = plus(own.p_j, own.along)
    return (own.i, None), (own.j, own.p_j), (own.j, end)


def reach(row):
    own = Own.of(row)
    pair = (own.i, own.j)
    middle = plus(own.p_j, scaled(0.5, own.along))  # the whole line lies as its middle does
    return Reach(forces=((own.i, own.axis),), places=((own.j, middle, pair),))


def turning(row):
    """The plane is carried along by its body, the line by its own."""
    own = Own.of(row)
    return Turning(frames=(own.i, own.j))


def doubts(name, spec, largest):
    """A seal pressed in further than it stands out."""
    pressed, when = largest(f"{name}.compression", signed=True)
    if pressed > spec.height > 0.0:
        yield (
            f"forces.{name}: the seal was compressed by {pressed:.3g} m at {when:.4g} s and is "
            f"{spec.height:.3g} m high, so its line went through the plane: a stop is missing, or "
            "its `load` is too small"
        )


ELEMENT = Element(
    key="seal",
    section="forces",
    spec=Seal,
    pack=pack,
    acts_at=both_ends,
    reach=reach,
    channels=(
        Channel(
            "normal_force", "N", "normal to the plane, damping included; never negative", least=0
        ),
        Channel("friction_force", "N", "magnitude of the friction", least=0.0),
        Channel(
            "compression", "m", "largest compression along the line; without contact, minus the gap"
        ),
        Channel("contact_length", "m", "length of the line that is compressed", least=0.0),
        Channel("force", "N", "force on the body of the line, world axes", 3),
    ),
    turning=turning,
    judged=lambda row: Own.of(row).height > 0.0,
    doubts=doubts,
    slides=(Own.columns["friction_law"].at, Own.columns["friction"].at),
    loads={"normal_force": "contact force"},
    kernels={"force": force, "gaps": gap, "corners": corners, "energy": energy, "measure": measure},
    example="""
planar: false
bodies:
  door: {mass: 20 kg, inertia: [2, 2, 4], at: [0.4, 0, 1], velocity: [0, -0.2, 0]}
joints:
  rail: {type: prismatic, bodies: [ground, door], at: [0.4, 0, 1], axis: [0, 1, 0]}
forces:
  edge:
    type: seal
    line: {body: door, start: [0.8, 0, 0.1], end: [0.8, 0, 1.9]}
    against: {body: ground, at: [0, -10 mm, 0], normal: [0, 1, 0]}
    height: 4 mm
    load: 130 N/m
    at: 4 mm
    exponent: 1.2
solver: {end: 0.2 s}
""",
)
