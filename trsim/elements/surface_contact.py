"""Surface contact: a ball, a roller or a point of body j against a surface of body i.

    s, n              distance from surface to centre, and its direction   laws/surfaces.py
    d   = r - s       penetration; r is the radius of the ball, 0 for a point
    d'  = -n . v      v: the centre's velocity against body i at the same place, which turns n too
    F_n = f(d, d')    normal force on body j, along n                                laws/contact.py
    F_t               friction on body j, against v_t                               laws/friction.py
    v_t = v_j - v_i - n (n . (v_j - v_i))     at c, the centre less s n, of both bodies

Both forces act at c, with opposite signs on the two bodies, so that the pair adds no moment.
Bristles bend in two directions perpendicular to n: one in the plane of the profile, t = n x z, and
z.  Rolling and spinning are slowed by moments on both bodies, with lever arms b_r and b_s and w =
omega_j - omega_i:

    M = -F_n (b_r g(r |w_t|) w_t / |w_t| + b_s g(r |w_n|) sign(w_n) n),     w_n = w . n

g is the fraction of full friction that the friction law gives at a speed.  In flight there is no
force at any gap; a touch is located and the approach speed stored, as in a clearance joint.

For an outline with a rounded edge (outlines.py), the centre is its point nearest to the surface.
If several points touch at once (laws/touches.py, corners on a plane), each has a row of its own,
and a row before them represents the whole: it has no force itself and reports their sum.
"""

from math import inf, sqrt
from typing import Annotated, ClassVar

from annotated_types import Ge

from trsim.elements.contract import (
    CONTACT,
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
    arm,
    at_both,
    dot,
    impulses,
    minus,
    plus,
    points,
    push_apart,
    scaled,
    turned_round,
    twist_apart,
)
from trsim.elements.outlines import outlined
from trsim.elements.surface import Ball, Surface, check_levers, fits_behind, shapes_of, thickness
from trsim.elements.touching import (
    CORNERED,
    Own,
    acting,
    is_behind,
    on_seam,
    resistance,
    rolls,
    slides,
    touch,
)
from trsim.errors import ScenarioError
from trsim.fields import Spec, Unit
from trsim.kernels.lazy import internal
from trsim.laws.contact import HERTZ, TABLE, stored
from trsim.laws.force_tables import (
    PIECE,
    beyond_piece,
    next_piece,
    piece_at,
    piece_of,
    rising,
    rub_of,
    stored_in,
)
from trsim.laws.friction import FULL, beyond, branch_of, neighbour
from trsim.laws.surfaces import PLANE, SPHERE

DEEP = 0.2  # of the radius of a ball: deeper than that it is no longer one that touches a surface
LOSSES = ("damping_loss", "friction_loss")


class SurfaceContact(Spec):
    """A ball, a roller, a point or an outline that touches a surface.

    surface             the surface that is touched
    ball                the ball, roller, point or outline that touches it
    contact             name of an entry of contact_laws; may be omitted if there is only one
    rolling_resistance  lever arm of the normal force that resists rolling
    spinning_friction   lever arm of the normal force that resists spinning about the normal
    """

    type: ClassVar[str] = "surface_contact"
    surface: Surface
    ball: Ball
    contact: str | None = None
    rolling_resistance: Annotated[float, Ge(0), Unit("m")] = 0.0
    spinning_friction: Annotated[float, Ge(0), Unit("m")] = 0.0


# --- packing -----------------------------------------------------------------------------


def pack(name, spec, at):
    """The row of a touch; of several one that stands for them, and theirs as its parts."""
    surface, ball = spec.surface, spec.ball
    if surface.body == ball.body:
        what = f"surface and ball are both on '{ball.body}'"
        raise ScenarioError(what, "name two different bodies", ("ball", "body"))
    i = at.body(surface.body, "surface", "body", near=surface.at, off=1.0)
    j = at.body(ball.body, "ball", "body", near=ball.at)
    frame = surface.frame
    if ball.corners is None:
        shapes, curvature = shapes_of(spec, at, frame.inside(minus(ball.at, surface.at)))
    else:
        shapes, curvature = outlined(spec, at, j), None
    law = at.contact_law(spec.contact)
    normal = law.on_surface(ball.radius, curvature)
    offset = len(at.tab)
    if law.table is not None:
        at.tab.extend(rising(*law.columns)[0])
    patch = 0.0
    if law.stiffness == "hertz":
        patch = 1.0 / (1.0 / ball.radius + curvature)
    if spec.rolling_resistance or spec.spinning_friction:
        check_levers(spec, *law.friction.numbers)
    own = dict(
        **points(at, i, j, surface.at, ball.at),
        u_i=at.axes(i, frame.x), w_i=at.axes(i, frame.y), a_i=at.axes(i, frame.z),
        ball=ball.radius, form=HERTZ if law.table is None else TABLE, table=offset, clearance=0.0,
        slowest_impact=law.slowest_impact, touches=0,
        rolling=spec.rolling_resistance, spinning=spec.spinning_friction, patch=patch,
    )  # fmt: skip
    several = len(shapes) > 1
    rows = [
        row_of(f"{name}.{k}" if several else name, spec, at, law, normal, {**own, **shaped})
        for k, shaped in enumerate(shapes, start=1)
    ]
    if not several:
        return rows[0]
    whole = Own.packed(
        normal, **{**own, **shapes[0], "touches": len(rows), "rolling": 0.0, "spinning": 0.0},
        state=-1, lost=-1, friction_law=0, friction=law.friction.numbers[1],
    )  # fmt: skip
    return Row(*whole, channels=OF_SEVERAL, parts=tuple(rows))


def row_of(name, spec, at, law, normal, numbers):
    """The row of one touch."""
    code, friction = law.friction.numbers
    state = bristles(spec, law.friction, friction, at)
    lost = -1
    if any(at.asks(f"{name}.{channel}") for channel in LOSSES):
        lost = at.state(0.0)
        at.state(0.0)
    own = Own.packed(
        normal, **numbers, state=state, lost=lost, friction_law=code, friction=friction
    )
    channels = CHANNELS
    if numbers["patch"] > 0.0:
        channels = (*channels, PATCH)
    if lost >= 0:
        channels = (*channels, *LOST)
    jump = Own.columns["friction"].at if law.friction.jumps else -1
    contact = Contact(
        normal.stiffness,
        normal.exponent,
        inf,
        law.slowest_impact,
        normal.chi,
        state,
        law.friction.slope,
        jump,
        impact=law.impact,
        states=2,
        known_to=inf if law.table is None else law.table[-1][0],
        lost=lost,
        ramp=law.friction.ramp,
    )
    states = tuple(k for first in (state, lost) if first >= 0 for k in (first, first + 1))
    travel = "surface" if numbers["outline"] < 0 else "outline"
    return Row(*own, contact, channels, states=states, travel=travel)


def bristles(spec, law, numbers, at):
    """Entries of z with the deflection of bristles, the first of two; -1 where there are none."""
    if law.law != "sticking":
        return -1
    if spec.surface.shape == "sphere":
        what = "bristles bend along directions of the surface, of which a sphere has none"
        hint = "let the ball be a part of the other body, or take another friction law"
        raise ScenarioError(what, hint, ("contact",))
    size = numbers[1] / numbers[3]
    first = at.state(size)
    at.state(size)
    return first


# --- kernels -----------------------------------------------------------------------------


@kernel
def force(t, scene, e):
    zd, left, own = scene.zd, scene.left, Own(scene, e)
    if own.phase == FLIGHT or own.touches > 0:
        return
    c_i, c_j, n, depth, rate, v_t, speed = slides(scene, e)
    if own.branch != WHOLE:
        left[e] = max(left[e], beyond_branch(scene, own, depth, speed))
        if turned_round(scene, e, v_t):
            left[e] = max(left[e], own.friction[2])
    if depth <= 0.0 and own.phase != CONTACT:
        return
    # in contact bristles bend whatever rounding makes of a depth of nothing
    F_n, F_t, bends, (taken, rubbed) = acting(scene, e, (n, depth, rate, v_t, speed))
    push_apart(scene.F, own.i, c_i, own.j, c_j, plus(scaled(F_n, n), F_t))
    if own.state >= 0:
        zd[own.state], zd[own.state + 1] = bends
    if own.rolling > 0.0 or own.spinning > 0.0:
        m, power = resistance(scene, e, F_n, n)
        twist_apart(scene.F, own.i, own.j, m)
        rubbed += power
    zd[IMPACTS] += taken
    zd[FRICTION] += rubbed
    if own.lost >= 0:
        zd[own.lost], zd[own.lost + 1] = -taken, -rubbed


@kernel
def gap(t, scene, e):
    _, _, _, _, scene.gap[e, 0], scene.gap[e, 1] = touch(scene, e)


@kernel
def strike(t, scene, e):
    blow, own = scene.blow, Own(scene, e)
    c_i, c_j, n, _, _, _, _ = slides(scene, e)
    # across n: along the profile and z, or any two directions
    z, x = arm(scene.X, own.i, own.a_i), arm(scene.X, own.i, own.u_i)
    impulses(blow, c_i, c_j, n, z, x)


@kernel
def slip(t, scene, e):
    blow = scene.blow
    _, _, _, _, _, v_t, _ = slides(scene, e)
    blow[0, 0], blow[0, 1], blow[0, 2] = v_t


@internal
def beyond_rub(own, speed):
    """How far friction has left its branch, m/s; -1 where it has none."""
    if own.friction_law != CORNERED:
        return -1.0
    return beyond(rub_of(own.branch), speed, own.friction[1], own.friction[2])


@internal
def beyond_branch(scene, own, depth, speed):
    """How far friction or the piece of a table has been left."""
    found = beyond_rub(own, speed)
    if own.form == TABLE:
        found = max(found, beyond_piece(scene.tab, own.table, piece_of(own.branch), depth))
    return found


@kernel
def corners(t, scene, e):
    out, slid, own = scene.corner, scene.slid, Own(scene, e)
    out[e, 0], slid[e, 0], slid[e, 1], slid[e, 2] = -1.0, 0.0, 0.0, 0.0
    rubs, tabled = own.friction_law == CORNERED, own.form == TABLE
    if own.phase != CONTACT or not (rubs or tabled):
        return
    _, _, _, depth, _, v_t, speed = slides(scene, e)
    tab, o, v0, v1 = scene.tab, own.table, own.friction[1], own.friction[2]
    if own.branch == WHOLE:
        rub = branch_of(speed, v0, v1) if rubs else 0.0
        out[e, 1] = rub + (PIECE * piece_at(tab, o, depth) if tabled else 0.0)
        return
    k, rub, by_rub = piece_of(own.branch), rub_of(own.branch), beyond_rub(own, speed)
    if rub == FULL:
        slid[e, 0], slid[e, 1], slid[e, 2] = v_t
    out[e, 0] = beyond_branch(scene, own, depth, speed)
    if tabled and not by_rub > beyond_piece(tab, o, k, depth):
        k = next_piece(tab, o, k, depth)
    else:
        rub = neighbour(rub, speed, v0, v1)
    out[e, 1] = rub + PIECE * k


@kernel
def energy(t, scene, e):
    own = Own(scene, e)
    if own.phase == FLIGHT or own.touches > 0:
        return
    _, _, _, _, depth, _ = touch(scene, e)
    if own.form == TABLE:
        scene.E[CONTACTS] += stored_in(scene.tab, own.table, depth)
    else:
        scene.E[CONTACTS] += stored(depth, own)


@measured
def measure(t, scene, e, o):
    out, own = scene.out, Own(scene, e)
    if own.touches > 0:
        together(scene, e, o)
        return
    c_i, _, n, depth, rate, v_t, speed = slides(scene, e)
    F_n, F_t, rolling = 0.0, (0.0, 0.0, 0.0), 0.0
    if own.phase != FLIGHT and depth > 0.0:
        F_n, F_t, _, _ = acting(scene, e, (n, depth, rate, v_t, speed))
        v = rolls(scene, e)
        rolling = sqrt(dot(v, v))
    f = plus(scaled(F_n, n), F_t)
    d = minus(c_i, arm(scene.X, own.i, own.p_i))
    x, y = dot(arm(scene.X, own.i, own.u_i), d), dot(arm(scene.X, own.i, own.w_i), d)
    out[o], out[o + 1] = F_n, sqrt(dot(F_t, F_t))
    out[o + 2], out[o + 3] = sqrt(dot(f, f)), depth
    out[o + 4], out[o + 5] = rate, speed if own.phase == CONTACT else 0.0
    out[o + 6] = rolling
    out[o + 7] = F_n if F_n > 0.0 and is_behind(scene, e) else 0.0
    out[o + 8] = F_n if F_n > 0.0 and on_seam(scene, own, x, y) else 0.0
    out[o + 9], out[o + 10] = x, y
    out[o + 11] = dot(arm(scene.X, own.i, own.a_i), d)
    for c in range(3):
        out[o + 12 + c] = f[c]
    more = o + 15
    if own.patch > 0.0:
        out[more] = sqrt(own.patch * max(depth, 0.0))
        more += 1
    if own.lost >= 0:
        out[more], out[more + 1] = scene.z[own.lost], scene.z[own.lost + 1]


@internal
def together(scene, e, o):
    """The channels of a row that stands for several touches."""
    out, own = scene.out, Own(scene, e)
    f, deepest, many = (0.0, 0.0, 0.0), -inf, 0
    for k in range(e + 1, e + 1 + own.touches):
        _, _, n, depth, rate, v_t, speed = slides(scene, k)
        deepest = max(deepest, depth)
        if Own(scene, k).phase != FLIGHT and depth > 0.0:
            F_n, F_t, _, _ = acting(scene, k, (n, depth, rate, v_t, speed))
            f, many = plus(f, plus(scaled(F_n, n), F_t)), many + 1
    out[o], out[o + 1], out[o + 2] = sqrt(dot(f, f)), deepest, many
    for c in range(3):
        out[o + 3 + c] = f[c]


# --- what others ask -----------------------------------------------------------------------


def reach(row):
    own = Own.of(row)
    if own.shape == SPHERE:
        return Reach(lines=((own.i, own.p_i, own.j, own.p_j),))
    forces = ((own.i, own.w_i),) if own.shape == PLANE else ((own.i, own.u_i), (own.i, own.w_i))
    return Reach(forces=forces, places=((own.j, own.p_j, (own.i, own.j)),))


def turning(row):
    """The surface is carried along by its body; friction turns that of the ball."""
    own = Own.of(row)
    return Turning(frames=(own.j,), points=((own.i, own.p_i),), axes=((own.i, own.a_i),))


def doubts(name, spec, largest):
    """A ball that was pressed in so deep that it might come out on the other side."""
    depth, when = largest(f"{name}.penetration", signed=True)
    surface, r = spec.surface, spec.ball.radius
    behind, _ = largest(f"{name}.force_behind")
    if behind > 0.0 and not fits_behind(surface, r):
        yield (
            f"forces.{name}: the ball met the profile from the side on which it is not drawn, with "
            f"up to {behind:.3g} N, and is too large to touch it there in one place only; give a "
            "contact for each side of its corners, or a closed profile with `corner_radius`"
        )
    seam, when_there = largest(f"{name}.force_at_seam")
    if seam > 0.0:
        yield (
            f"forces.{name}: at {when_there:.4g} s the ball was where two touches of the profile "
            f"meet and was felt by both, with up to {seam:.3g} N each; make the profile two, open "
            "ones of which each is met where it is drawn"
        )
    limit = DEEP * r if r > 0.0 else inf
    if depth > min(limit, thickness(surface)):
        round_ = "a ball" if spec.ball.corners is None else "an edge"
        into = f"{round_} of radius {r:.3g} m" if r > 0.0 else "a surface so thin"
        yield (
            f"forces.{name}: a penetration of {depth:.3g} m at {when:.4g} s is too deep for "
            f"{into}: the contact is too soft, or the impact too fast, for its law to mean "
            "anything; take a larger `stiffness`"
        )


CHANNELS = (
    Channel("normal_force", "N", "normal contact force; never negative", least=0.0),
    Channel("friction_force", "N", "magnitude of the friction", least=0.0),
    Channel("contact_force", "N", "resultant of normal force and friction", least=0.0),
    Channel("penetration", "m", "penetration, positive in contact; in flight, minus the gap"),
    Channel("penetration_rate", "m/s", "rate of the penetration, positive while approaching"),
    Channel(
        "sliding_speed", "m/s", "sliding speed of the ball on the surface; 0 in flight", least=0.0
    ),
    Channel(
        "rolling_speed",
        "m/s",
        "mean speed of the point of contact along surface and ball; 0 in flight",
        least=0.0,
    ),
    Channel("force_behind", "N", "normal force on the other side of an open profile", least=0.0),
    Channel(
        "force_at_seam", "N", "normal force where two contact points of a profile meet", least=0.0
    ),
    Channel("place", "m", "nearest point of the surface, in its axes", 3),
    Channel("force", "N", "contact force on the body of the ball, world axes", 3),
)
PATCH = Channel("patch_radius", "m", "radius of the contact circle, by Hertz", least=0.0)
LOST = (
    Channel("damping_loss", "J", "energy dissipated by damping normal to the surface"),
    Channel("friction_loss", "J", "energy dissipated by friction and rolling resistance"),
)
OF_SEVERAL = (
    Channel("contact_force", "N", "resultant of all its touches", least=0.0),
    Channel("penetration", "m", "the largest of its touches; minus the free gap otherwise"),
    Channel("touching", "-", "in how many places it touches", least=0.0),
    Channel("force", "N", "resultant on the body of the ball, world axes", 3),
)

ELEMENT = Element(
    key="surface_contact",
    section="forces",
    spec=SurfaceContact,
    pack=pack,
    acts_at=at_both,
    reach=reach,
    judged=lambda _: True,
    doubts=doubts,
    channels=(*CHANNELS, PATCH, *LOST),
    turning=turning,
    slides=(Own.columns["friction_law"].at, Own.columns["friction"].at),
    picture="touch",
    loads={"contact_force": "contact force"},
    kernels={
        "force": force,
        "gaps": gap,
        "strike": strike,
        "slip": slip,
        "corners": corners,
        "energy": energy,
        "measure": measure,
    },
    example="""
bodies:
  ball: {mass: 0.1 kg, inertia: 1.6e-5 kg*m^2, at: [0, 25 mm], velocity: [1 m/s, 0]}
forces:
  floor:
    type: surface_contact
    surface: {body: ground, shape: plane}
    ball: {body: ball, at: [0, 25 mm], radius: 20 mm}
contact_laws:
  rubber: {normal: impact, stiffness: hertz, youngs_modulus: 5 MPa, poisson: 0.49,
           damping: 20 N*s/m, ramp: 0.1 mm,
           friction: {law: modified_coulomb, coefficient: 0.4, v0: 1e-4 m/s, v1: 1e-3 m/s}}
gravity: [0, -9.81, 0]
solver: {end: 0.2 s}
""",
)
