"""Revolute joint with clearance: a journal of body j moves freely in a bearing of body i.

    e   = D - (a . D) a          eccentricity: journal centre from bearing centre, D = P_j - P_i
    d   = |e| - c                penetration; c is the radial clearance
    F_n = f(d, d')               normal force on the journal, along -e / |e|     laws/contact.py
    F_t = -f_t(F_n, v_t)         friction on the journal, along t = a x n        laws/friction.py

a is the axis, fixed in the bearing.  Both forces act at the contact point, at R_B + d from the
centre of the bearing, on the journal and, in the opposite direction, on the bearing.  So friction
turns both bodies, and the pair adds no moment.  Three rows remain: axial (a . D = 0) and both
tilts; the mobility grows by two.    [Flores2008]

In free flight the force is zero at any gap.  The solver locates the touch, switches to contact
there and stores the approach speed d'_0, never below `slowest_impact`.  Eccentricity is reported in
the axes of the body of the bearing.
"""

from math import sqrt
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
    kernel,
    measured,
    moving,
)
from trsim.elements.frames import (
    arm,
    at_both,
    carried,
    cross,
    dot,
    minus,
    plus,
    points,
    push_apart,
    scaled,
    velocity,
)
from trsim.elements.joint import triads
from trsim.elements.revolute import Revolute
from trsim.elements.rows import TILTS, Axes, along, constraint_of, coordinate_of
from trsim.errors import ScenarioError
from trsim.fields import Unit
from trsim.kernels.columns import constraint_row, f8, i8, run
from trsim.kernels.lazy import internal
from trsim.laws.contact import elastic, normal_force, stored
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


class ClearanceJoint(Revolute):
    """A hinge with play: a revolute with the key `clearance`.

    clearance  radial clearance; with 0 the joint is an ideal revolute
    contact    name of an entry of contact_laws; may be omitted if there is only one
    """

    clearance: Annotated[float, Ge(0), Unit("m")]
    contact: str | None = None

    type: ClassVar[str] = "clearance_joint"


class Own(Axes):
    """Of one instance."""

    axial: constraint_row
    tilt_1: constraint_row
    tilt_2: constraint_row
    state: i8  # of z: the deflection of bristles, or -1
    friction_law: i8  # one of CODES
    bearing_radius: f8
    clearance: f8
    stiffness: f8
    exponent: f8
    form: i8  # of the elastic law
    chi: f8
    slowest_impact: f8
    friction: run(f8, N_PARAMETERS)


CORNERED = CODES["modified_coulomb"]  # its parameters are mu, v0, v1
ROWS = (along("a", "axial"), *TILTS)


def pack(name, spec, at):
    i, j = at.bodies(spec.bodies, spec.at)
    law = at.contact_law(spec.contact)
    if law.bearing_radius is None:
        raise ScenarioError(
            "the contact law of a clearance joint needs `bearing_radius`",
            "friction acts at that radius",
            ("contact",),
        )
    if spec.clearance >= law.bearing_radius:
        raise ScenarioError(
            f"a radial clearance of {spec.clearance:g} m leaves no journal in a bearing of radius "
            f"{law.bearing_radius:g} m",
            "the usual size is some tenths of a millimetre",
            ("clearance",),
        )
    K, exponent, form, chi, light = law.normal_numbers(spec.clearance)
    code, friction = law.friction.numbers
    sticks = law.friction.law == "sticking"
    # w settles at +-mu / sigma0: that is its size in the error norm
    state = at.state(friction[1] / friction[3]) if sticks else -1
    own = Own.packed(
        law, **points(at, i, j, spec.at, spec.at), **triads(i, j, spec.axis, at, spec.drawn_in),
        clearance=spec.clearance, stiffness=K, exponent=exponent, form=form, chi=chi, state=state,
        friction_law=code, friction=friction,
    )  # fmt: skip
    jump = Own.columns["friction"].at if law.friction.jumps else -1
    contact = Contact(
        light, exponent, spec.clearance, law.slowest_impact, chi, state,
        law.friction.slope, jump, law.bearing_radius, ramp=law.friction.ramp,
    )  # fmt: skip
    return Row(*own, contact, states=(state,), travel="distance")


@internal
def play(scene, e):
    """Arms of the journal's centre on both bodies, unit normal and tangent, penetration and its
    rate."""
    own = Own(scene, e)
    axis = arm(scene.X, own.i, own.a_i)
    # v: against the bearing's body moving with the journal centre, as n turns with it
    r_i, p_j, d, v = carried(scene, e)
    e_r = minus(d, scaled(dot(axis, d), axis))
    size = sqrt(dot(e_r, e_r))
    if size == 0.0:  # centred: the normal is arbitrary and nothing touches
        n = arm(scene.X, own.i, own.u_i)
    else:
        n = (e_r[0] / size, e_r[1] / size, e_r[2] / size)
    return r_i, p_j, n, cross(axis, n), size - own.clearance, dot(n, v)


@internal
def sliding(scene, e):
    """The contact point seen from both centres of mass, the same of `play`, the sliding speed of
    the journal against the bearing there, m/s.

    It lies a bearing radius outside the circle of the journal centre, at the end of the bearing's
    radius plus the penetration: as far as the journal's radius from its centre.
    """
    V, own = scene.V, Own(scene, e)
    r_i, p_j, n, tangent, depth, rate = play(scene, e)
    reach = scaled(own.bearing_radius - own.clearance, n)
    c_i, c_j = plus(r_i, reach), plus(p_j, reach)
    v_t = dot(tangent, minus(velocity(V, own.j, c_j), velocity(V, own.i, c_i)))
    return c_i, c_j, n, tangent, depth, rate, v_t


@internal
def contact_forces(scene, e):
    """Normal force, friction on the journal along t, sliding speed, bristle rate, arms, n, t."""
    own = Own(scene, e)
    c_i, c_j, n, tangent, depth, rate, v_t = sliding(scene, e)
    if own.phase == FLIGHT or depth <= 0.0:
        # at the touch itself nothing presses yet, and the journal slides as it will right behind it
        v_t, w_dot = v_t if own.phase == CONTACT else 0.0, 0.0
        if own.phase == CONTACT and own.state >= 0:  # whatever rounding makes of no depth
            w = scene.z[own.state]
            _, w_dot = part_of_bristle(0.0, v_t, abs(v_t), w, own.friction)
        return 0.0, 0.0, v_t, w_dot, c_i, c_j, n, tangent, depth, rate
    first = own.impact_speed
    if first == 0.0:  # not latched yet (UNLOCATED): this approach is the impact
        first = max(rate, own.slowest_impact)
    F_n = normal_force(depth, rate, first, own)
    w = scene.z[own.state] if own.state >= 0 else 0.0
    f = own.friction
    if own.friction_law == CORNERED and own.branch != WHOLE:
        F_t, w_dot = on_branch(own.branch, F_n, v_t, f[0], f[1], f[2]), 0.0
    else:
        F_t, w_dot = friction_force(own.friction_law, F_n, v_t, w, f)
    return F_n, F_t, v_t, w_dot, c_i, c_j, n, tangent, depth, rate


@internal
def on_journal(F_n, F_t, n, tangent):
    """The force on the journal."""
    return plus(scaled(-F_n, n), scaled(F_t, tangent))


@kernel
def force(t, scene, e):
    zd, left, own = scene.zd, scene.left, Own(scene, e)
    if own.phase == FLIGHT:
        return
    F_n, F_t, v_t, w_dot, c_i, c_j, n, tangent, depth, rate = contact_forces(scene, e)
    if own.friction_law == CORNERED and own.branch != WHOLE:
        left[e] = max(left[e], beyond(own.branch, v_t, own.friction[1], own.friction[2]))
    if own.state >= 0:
        zd[own.state] = w_dot
    if depth <= 0.0:
        return
    push_apart(scene.F, own.i, c_i, own.j, c_j, on_journal(F_n, F_t, n, tangent))
    zd[IMPACTS] -= (F_n - elastic(depth, own)) * rate
    zd[FRICTION] += F_t * v_t


@kernel
def gap(t, scene, e):
    _, _, _, _, scene.gap[e, 0], scene.gap[e, 1] = play(scene, e)


@kernel
def slip(t, scene, e):
    blow = scene.blow
    _, _, _, tangent, _, _, v_t = sliding(scene, e)
    blow[0, 0], blow[0, 1], blow[0, 2] = scaled(v_t, tangent)


@kernel
def corners(t, scene, e):
    out = scene.corner
    own = Own(scene, e)
    out[e, 0] = -1.0
    if own.friction_law != CORNERED or own.phase != CONTACT:
        return
    _, _, _, _, _, _, v_t = sliding(scene, e)
    v0, v1, branch = own.friction[1], own.friction[2], own.branch
    if branch == WHOLE:
        out[e, 1] = branch_of(v_t, v0, v1)
    else:
        out[e, 0], out[e, 1] = beyond(branch, v_t, v0, v1), neighbour(branch, v_t, v0, v1)


@kernel
def energy(t, scene, e):
    own = Own(scene, e)
    if own.phase == FLIGHT:
        return
    _, _, _, _, depth, _ = play(scene, e)
    scene.E[CONTACTS] += stored(depth, own)


@measured
def measure(t, scene, e, o):
    out, own = scene.out, Own(scene, e)
    F_n, F_t, v_t, _, _, _, n, tangent, depth, rate = contact_forces(scene, e)
    _, _, d, v = carried(scene, e)
    u, w = arm(scene.X, own.i, own.u_i), arm(scene.X, own.i, own.w_i)
    out[o], out[o + 1], out[o + 2] = F_n, F_t, sqrt(F_n * F_n + F_t * F_t)
    out[o + 3], out[o + 4], out[o + 5] = depth, rate, v_t
    out[o + 6], out[o + 7] = dot(u, d), dot(w, d)
    out[o + 8], out[o + 9] = dot(u, v), dot(w, v)
    out[o + 10], out[o + 11], out[o + 12] = on_journal(F_n, F_t, n, tangent)


def reach(row):
    own = Own.of(row)
    return Reach(hinges=((own.i, own.a_i),), places=((own.i, own.p_i, (own.i, own.j)),))


ELEMENT = Element(
    key="clearance_joint",
    section="joints",
    spec=ClearanceJoint,
    pack=pack,
    acts_at=at_both,
    reach=reach,
    rows=tuple(row.name for row in ROWS),
    holds=tuple(row.holds for row in ROWS),
    coordinates=("angle",),
    channels=(
        Channel("normal_force", "N", "normal contact force; never negative", least=0.0),
        Channel("friction_force", "N", "friction on the journal, along axis x normal"),
        Channel("contact_force", "N", "resultant of normal force and friction", least=0.0),
        moving("penetration", "m", "penetration, positive in contact; in flight, minus the gap"),
        moving("penetration_rate", "m/s", "rate of the penetration, positive while approaching"),
        Channel(
            "sliding_speed",
            "m/s",
            "speed of the journal relative to the bearing at the contact point; 0 in flight",
        ),
        moving("eccentricity_x", "m", "journal centre relative to bearing centre, bearing axes"),
        moving("eccentricity_y", "m", "journal centre relative to bearing centre, bearing axes"),
        moving("eccentricity_x_rate", "m/s", "rate of the eccentricity, bearing axes"),
        moving("eccentricity_y_rate", "m/s", "rate of the eccentricity, bearing axes"),
        Channel("force", "N", "contact force on the journal's body, world axes", 3),
    ),
    meets=True,
    ideal="revolute",
    picture="journal",
    loads={"contact_force": "contact force"},
    slides=(Own.columns["friction_law"].at, Own.columns["friction"].at),
    kernels={
        "constraint": constraint_of(ROWS),
        "coordinate": coordinate_of(("angle",), len(ROWS)),
        "force": force,
        "gaps": gap,
        "slip": slip,
        "corners": corners,
        "energy": energy,
        "measure": measure,
    },
    example="""
bodies:
  rod: {mass: 2 kg, inertia: 0.05 kg*m^2, at: [0.2, 0]}
joints:
  pin: {type: revolute, bodies: [ground, rod], at: [0, 0], clearance: 0.1 mm, contact: steel}
contact_laws:
  steel: {normal: lankarani_nikravesh, bearing_radius: 10 mm, youngs_modulus: 207 GPa,
          poisson: 0.3, restitution: 0.9}
gravity: [0, -9.81, 0]
solver: {end: 0.02 s}
""",
)
