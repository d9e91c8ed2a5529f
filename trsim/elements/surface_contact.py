"""Surface contact: a ball, a roller or a point of body j against a surface of body i.

    s, n              how far the centre is from the surface, and the way from it   laws/surfaces.py
    d   = r - s       penetration; r is the radius of the ball, 0 of a point
    d'  = -n . v      v: the centre's velocity against body i at the same place, which turns n too
    F_n = f(d, d')    normal force on body j, along n                                laws/contact.py
    F_t               friction on body j, against v_t                               laws/friction.py
    v_t = v_j - v_i - n (n . (v_j - v_i))     at c, the centre less s n, of both bodies

Both forces act at c, on both bodies alike, so that the pair adds no moment.  Bristles bend in two
directions across n: one in the plane of the profile, t = n x z, and z.  Rolling and spinning are
slowed by moments on both bodies, b_r and b_s the levers of the law, w = omega_j - omega_i:

    M = -F_n (b_r g(r |w_t|) w_t / |w_t| + b_s g(r |w_n|) sign(w_n) n),     w_n = w . n

g is the friction law's part of full friction at a speed.  In flight there is no force whatever the
gap; a touch is located and latches the approach speed, as in a clearance joint.
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
    OnSurface,
    arm,
    at_both,
    carried,
    cross,
    dot,
    minus,
    plus,
    points,
    push_apart,
    relative_spin,
    scaled,
    twist_apart,
    velocity,
)
from trsim.elements.surface import Surface, fits_behind, shape_of, thickness
from trsim.errors import ScenarioError
from trsim.fields import Spec, Unit, point
from trsim.kernels.columns import V3, f8, i8, run
from trsim.kernels.lazy import internal
from trsim.laws.contact import elastic, impact_force, normal_force, stored
from trsim.laws.friction import (
    CODES,
    N_PARAMETERS,
    beyond,
    branch_of,
    friction_force,
    neighbour,
    on_branch,
    part_of_bristle,
)
from trsim.laws.surfaces import PLANE, PROFILE, SPHERE, away, beside

CORNERED, STICKING = CODES["modified_coulomb"], CODES["sticking"]
DEEP = 0.2  # of the radius of a ball: deeper than that it is no longer one that touches a surface


class Ball(Spec):
    """A ball of a body, or a roller whose axis is the z axis of the surface, or a point.

    body    the body
    at      its centre, as drawn; a place, or the name of a point
    radius  0 of a point
    """

    type: ClassVar[str] = "ball"
    body: str
    at: point("m")
    radius: Annotated[float, Ge(0), Unit("m")] = 0.0


class SurfaceContact(Spec):
    """A ball, a roller or a point that meets a surface.

    surface             what it meets
    ball                what meets it
    contact             entry of contact_laws; may be left out where there is only one
    rolling_resistance  lever of the normal force against rolling
    spinning_friction   lever of the normal force against turning about the normal
    """

    type: ClassVar[str] = "surface_contact"
    surface: Surface
    ball: Ball
    contact: str | None = None
    rolling_resistance: Annotated[float, Ge(0), Unit("m")] = 0.0
    spinning_friction: Annotated[float, Ge(0), Unit("m")] = 0.0


class Own(OnSurface):
    """Of one instance."""

    u_i: V3  # axes of the surface in those of body i
    w_i: V3
    a_i: V3
    shape: i8
    closed: i8  # 1 of a closed profile
    profile: i8  # its offset in tab
    state: i8  # of z: the deflection of bristles along t, that along z behind it; or -1
    friction_law: i8
    form: i8  # of the elastic law: that of Hertz
    radius: f8  # of the surface, m
    free: f8  # 1, or -1: inside
    clearance: f8  # read by other forms
    stiffness: f8
    exponent: f8
    chi: f8
    damping: f8
    ramp: f8  # 0 of laws that know the impact
    slowest_impact: f8
    rolling: f8  # levers, m
    spinning: f8
    friction: run(f8, N_PARAMETERS)


# --- packing -----------------------------------------------------------------------------


def pack(name, spec, at):
    surface, ball = spec.surface, spec.ball
    if surface.body == ball.body:
        what = f"surface and ball are both on '{ball.body}'"
        raise ScenarioError(what, "name two different bodies", ("ball", "body"))
    law = at.contact_law(spec.contact)
    i = at.body(surface.body, "surface", "body", near=surface.at, off=1.0)
    j = at.body(ball.body, "ball", "body", near=ball.at)
    frame = surface.frame
    shaped, curvature = shape_of(spec, at, frame.inside(minus(ball.at, surface.at)))
    normal = law.on_surface(ball.radius, curvature)
    code, friction = law.friction.numbers
    state = bristles(spec, law.friction, friction, at)
    if spec.rolling_resistance or spec.spinning_friction:
        check_levers(spec, code, friction)
    own = Own.packed(
        normal, **points(at, i, j, surface.at, ball.at), **shaped,
        u_i=at.axes(i, frame.x), w_i=at.axes(i, frame.y), a_i=at.axes(i, frame.z),
        ball=ball.radius, state=state, friction_law=code, friction=friction, form=0, clearance=0.0,
        slowest_impact=law.slowest_impact, rolling=spec.rolling_resistance,
        spinning=spec.spinning_friction,
    )  # fmt: skip
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
        states=2,
    )
    states = () if state < 0 else (state, state + 1)
    return Row(*own, contact, states=states, travel="surface")


def check_levers(spec, code, friction):
    """Refuse resistance to rolling and spinning where it has no meaning."""
    if code != CORNERED or friction[0] == 0.0:
        what = "resistance to rolling and spinning comes in with speed as sliding friction does"
        hint = "take `modified_coulomb`, with `v0`, `v1` and a `coefficient` above 0"
        raise ScenarioError(what, hint, ("contact",))
    if spec.ball.radius == 0.0:
        what = "a point neither rolls nor spins"
        raise ScenarioError(what, "give the ball a radius, or no levers", ("ball", "radius"))


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


@internal
def touch(scene, e):
    """Arms of the centre on both bodies, s, n in world axes, penetration and its rate."""
    own, X = Own(scene, e), scene.X
    r_i, p_j, d, v = carried(scene, e)
    x, y, z = arm(X, own.i, own.u_i), arm(X, own.i, own.w_i), arm(X, own.i, own.a_i)
    s, m = away(scene.tab, own, (dot(x, d), dot(y, d), dot(z, d)))
    n = plus(plus(scaled(m[0], x), scaled(m[1], y)), scaled(m[2], z))
    return r_i, p_j, s, n, own.ball - s, -dot(n, v)


@internal
def slides(scene, e):
    """The place of contact seen from both centres of mass, n, d, d', v_t and its size."""
    V, own = scene.V, Own(scene, e)
    r_i, p_j, s, n, depth, rate = touch(scene, e)
    c_i, c_j = minus(r_i, scaled(s, n)), minus(p_j, scaled(s, n))
    v = minus(velocity(V, own.j, c_j), velocity(V, own.i, c_i))
    v_t = minus(v, scaled(dot(n, v), n))
    return c_i, c_j, n, depth, rate, v_t, sqrt(dot(v_t, v_t))


@internal
def normal_of(own, depth, rate):
    """F_n."""
    if own.ramp > 0.0:
        return impact_force(depth, rate, own)
    first = own.impact_speed
    if first == 0.0:  # not latched yet (UNLOCATED): this approach is the impact
        first = max(rate, own.slowest_impact)
    return normal_force(depth, rate, first, own)


@internal
def part_of(own, F_n, speed):
    """Friction at a speed, N, positive against it; bristles aside."""
    f = own.friction
    if own.friction_law == CORNERED and own.branch != WHOLE:
        return -on_branch(own.branch, F_n, speed, f[0], f[1], f[2])
    F_t, _ = friction_force(own.friction_law, F_n, speed, 0.0, f)
    return -F_t


@internal
def friction_of(scene, e, F_n, n, v_t, speed):
    """Friction on body j, world axes, and the rates of both bristles."""
    own = Own(scene, e)
    if own.friction_law != STICKING:  # along a static path what sticks slides
        by = -part_of(own, F_n, speed) / speed if speed > 0.0 else 0.0
        return scaled(by, v_t), 0.0, 0.0
    f, z = own.friction, arm(scene.X, own.i, own.a_i)
    t = cross(n, z)
    if own.shape == PLANE:
        t = arm(scene.X, own.i, own.u_i)
    w_t, w_z = scene.z[own.state], scene.z[own.state + 1]
    F_1, rate_1 = part_of_bristle(F_n, dot(t, v_t), speed, w_t, f)
    F_2, rate_2 = part_of_bristle(F_n, dot(z, v_t), speed, w_z, f)
    return plus(scaled(F_1, t), scaled(F_2, z)), rate_1, rate_2


@internal
def resistance(scene, e, F_n, n):
    """Moment on body j against rolling and spinning, world axes, and its power."""
    own = Own(scene, e)
    f, w = own.friction, relative_spin(scene.V, own.i, own.j)
    spin = dot(n, w)
    roll = minus(w, scaled(spin, n))
    size, code = sqrt(dot(roll, roll)), own.friction_law
    by_roll, _ = friction_force(code, F_n, own.ball * size, 0.0, f)
    by_spin, _ = friction_force(code, F_n, own.ball * spin, 0.0, f)
    share = own.rolling * by_roll / (f[0] * size) if size > 0.0 else 0.0
    m = plus(scaled(share, roll), scaled(own.spinning * by_spin / f[0], n))
    return m, dot(m, w)


@internal
def is_behind(scene, e):
    """Whether the ball is on the side of an open profile on which it was not drawn: its right."""
    own = Own(scene, e)
    if own.shape != PROFILE or own.closed == 1:
        return False
    _, _, d, _ = carried(scene, e)
    x, y = dot(arm(scene.X, own.i, own.u_i), d), dot(arm(scene.X, own.i, own.w_i), d)
    side, _ = beside(scene.tab, own.profile, 1, x, y)
    return side < 0.0


@kernel
def force(t, scene, e):
    zd, left, own = scene.zd, scene.left, Own(scene, e)
    if own.phase == FLIGHT:
        return
    c_i, c_j, n, depth, rate, v_t, speed = slides(scene, e)
    if own.friction_law == CORNERED and own.branch != WHOLE:
        left[e] = max(left[e], beyond(own.branch, speed, own.friction[1], own.friction[2]))
    if depth <= 0.0 and own.phase != CONTACT:
        return
    # in contact bristles bend whatever rounding makes of a depth of nothing
    F_n = normal_of(own, depth, rate)
    F_t, rate_t, rate_z = friction_of(scene, e, F_n, n, v_t, speed)
    push_apart(scene.F, own.i, c_i, own.j, c_j, plus(scaled(F_n, n), F_t))
    zd[IMPACTS] -= (F_n - elastic(depth, own)) * rate
    zd[FRICTION] += dot(F_t, v_t)
    if own.state >= 0:
        zd[own.state], zd[own.state + 1] = rate_t, rate_z
    if own.rolling > 0.0 or own.spinning > 0.0:
        m, power = resistance(scene, e, F_n, n)
        twist_apart(scene.F, own.i, own.j, m)
        zd[FRICTION] += power


@kernel
def gap(t, scene, e):
    _, _, _, _, scene.gap[e, 0], scene.gap[e, 1] = touch(scene, e)


@kernel
def corners(t, scene, e):
    out, own = scene.corner, Own(scene, e)
    out[e, 0] = -1.0
    if own.friction_law != CORNERED or own.phase != CONTACT:
        return
    _, _, _, _, _, _, speed = slides(scene, e)
    v0, v1, branch = own.friction[1], own.friction[2], own.branch
    if branch == WHOLE:
        out[e, 1] = branch_of(speed, v0, v1)
    else:
        out[e, 0], out[e, 1] = beyond(branch, speed, v0, v1), neighbour(branch, speed, v0, v1)


@kernel
def energy(t, scene, e):
    own = Own(scene, e)
    if own.phase == FLIGHT:
        return
    _, _, _, _, depth, _ = touch(scene, e)
    scene.E[CONTACTS] += stored(depth, own)


@measured
def measure(t, scene, e, o):
    out, own = scene.out, Own(scene, e)
    c_i, _, n, depth, rate, v_t, speed = slides(scene, e)
    F_n, F_t = 0.0, (0.0, 0.0, 0.0)
    if own.phase != FLIGHT and depth > 0.0:
        F_n = normal_of(own, depth, rate)
        F_t, _, _ = friction_of(scene, e, F_n, n, v_t, speed)
    f = plus(scaled(F_n, n), F_t)
    d = minus(c_i, arm(scene.X, own.i, own.p_i))
    out[o], out[o + 1] = F_n, sqrt(dot(F_t, F_t))
    out[o + 2], out[o + 3] = sqrt(dot(f, f)), depth
    out[o + 4], out[o + 5] = rate, speed if own.phase == CONTACT else 0.0
    out[o + 6] = F_n if F_n > 0.0 and is_behind(scene, e) else 0.0
    out[o + 7] = dot(arm(scene.X, own.i, own.u_i), d)
    out[o + 8] = dot(arm(scene.X, own.i, own.w_i), d)
    out[o + 9] = dot(arm(scene.X, own.i, own.a_i), d)
    for c in range(3):
        out[o + 10 + c] = f[c]


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
    limit = DEEP * r if r > 0.0 else inf
    if depth > min(limit, thickness(surface)):
        into = f"a ball of radius {r:.3g} m" if r > 0.0 else "a surface so thin"
        yield (
            f"forces.{name}: a penetration of {depth:.3g} m at {when:.4g} s is too deep for "
            f"{into}: the contact is too soft, or the impact too fast, for its law to mean "
            "anything; take a larger `stiffness`"
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
    channels=(
        Channel("normal_force", "N", "normal contact force; never negative", least=0.0),
        Channel("friction_force", "N", "size of the friction", least=0.0),
        Channel("contact_force", "N", "resultant of normal force and friction", least=0.0),
        Channel("penetration", "m", "positive in contact, minus the free gap otherwise"),
        Channel("penetration_rate", "m/s", "positive while approaching"),
        Channel("sliding_speed", "m/s", "of the ball on the surface; 0 in flight", least=0.0),
        Channel(
            "force_behind", "N", "normal force of an open profile on its other side", least=0.0
        ),
        Channel("place", "m", "nearest place on the surface, in its axes", 3),
        Channel("force", "N", "contact force on the body of the ball, world axes", 3),
    ),
    turning=turning,
    slides=(Own.columns["friction_law"].at, Own.columns["friction"].at),
    picture="touch",
    loads={"contact_force": "contact force"},
    kernels={
        "force": force,
        "gaps": gap,
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
  rubber: {normal: impact, stiffness: 1e6, damping: 20 N*s/m, ramp: 0.1 mm,
           friction: {law: modified_coulomb, coefficient: 0.4, v0: 1e-4 m/s, v1: 1e-3 m/s}}
gravity: [0, -9.81, 0]
solver: {end: 0.2 s}
""",
)
