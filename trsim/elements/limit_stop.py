"""Limit stop: one-sided contact of a point with a wall, or of a joint coordinate with a limit.

    F = max(0, k d + c smoothstep(d / ramp) d')          d > 0: penetration

Point on wall: d = -(p - w) . n with n the allowed side, fixed in the wall's body; F n acts at the
point, -F n on the wall's body at the same place.  Joint: d = max(lower - x, x - upper), F acts
along the axis of the joint.  The damping fades in over the ramp, so there is no jump at the touch
and no memory of the impact speed; soft impacts are right, where Lankarani-Nikravesh is not.  In the
phase of contact the spring is drawn on to d < 0, where no accepted step ever is.  The end of the
ramp and the place from which the force would pull are corners, located like a touch.
"""

from typing import Annotated, ClassVar

from annotated_types import Ge, Gt
from pydantic import model_validator

from trsim.elements.contract import (
    BRANCH,
    CONTACT,
    CONTACTS,
    FLIGHT,
    IMPACTS,
    PHASE,
    WHOLE,
    Channel,
    Contact,
    Element,
    Reach,
    Row,
    Turning,
    kernel,
)
from trsim.elements.frames import (
    arm,
    dot,
    helper,
    push,
    separation,
    twist,
    two_points,
    velocity,
)
from trsim.errors import ScenarioError
from trsim.fields import Spec, Unit, direction, point, vector
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
    normal  to the allowed side, as drawn; turns with the body
    """

    body: str
    at: point("m")
    normal: vector("-")


class LimitStop(Spec):
    """A stop: `point` against `wall`, or the coordinate of `joint` between `lower` and `upper`.

    point      what touches the wall
    wall       what it touches
    joint      joint whose coordinate is limited
    lower      least coordinate
    upper      largest coordinate
    stiffness  of the contact
    damping    of the contact, where the ramp is over
    ramp       penetration over which the damping fades in
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
        return self

    def pressed(self, joints):
        """The two bodies it pushes apart, and the joint along whose coordinate it does."""
        if self.joint is None:
            return (self.point.body, self.wall.body), None
        joint = joints.get(self.joint)
        return (joint.bodies if joint else ()), joint


UNITS = (
    ("lower", "rad", "m"),
    ("upper", "rad", "m"),
    ("ramp", "rad", "m"),
    ("stiffness", "N*m/rad", "N/m"),
    ("damping", "N*m*s/rad", "N*s/m"),
)
ON_WALL, ON_ANGLE, ON_STROKE = 0, 1, 2
UNBOUNDED = 1e300


def pack(name, spec, at):
    law = (spec.stiffness, spec.damping, spec.ramp)
    contact = Contact(spec.stiffness, 1.0, float("inf"), 0.0, 0.0)
    if spec.joint is None:
        if spec.wall.body == spec.point.body:
            raise ScenarioError(
                f"point and wall are both on '{spec.wall.body}'",
                "name two different bodies",
                ("point", "body"),
            )
        for key, turning, sliding in UNITS:
            at.check_unit("wall", turning, sliding, "forces", name, key)
        # on a flexible bar the wall belongs to the node that is nearest to it
        i = at.body(spec.wall.body, "wall", "body", near=spec.wall.at, off=1.0)
        j = at.body(spec.point.body, "point", "body", near=spec.point.at)
        n = at.axes(i, direction(spec.wall.normal))
        places = (*at.local(i, spec.wall.at), *at.local(j, spec.point.at))
        return Row((i, j, -1, ON_WALL), (*places, *n, *law, 0.0, 0.0), contact, travel="stroke")
    x = at.coordinate(spec.joint)
    for key, turning, sliding in UNITS:
        at.check_unit(x.kind, turning, sliding, "forces", name, key)
    kind = ON_ANGLE if x.kind == "angle" else ON_STROKE
    low = -UNBOUNDED if spec.lower is None else spec.lower
    high = UNBOUNDED if spec.upper is None else spec.upper
    par = (*x.s_i, *x.s_j, *x.axis_i, *law, low, high)
    con, turns = (x.i, x.j, x.entry, kind), kind == ON_ANGLE
    return Row(con, par, contact, turns=turns, travel=x.kind, kink=0.5 * (high - low))


@helper
def touch(X, V, S, con, par, e):
    """Penetration, its rate, and the direction of the force on body j (world, or + - axis)."""
    i, j = con[e, 0], con[e, 1]
    n = arm(X, i, par[e, 6], par[e, 7], par[e, 8])
    if con[e, 3] != ON_WALL:
        s = con[e, 2]
        low, high = par[e, 12] - S[s, 0], S[s, 0] - par[e, 13]
        if low > high:
            return low, -S[s, 1], n
        return high, S[s, 1], (-n[0], -n[1], -n[2])
    _, p_i, _, p_j = two_points(X, con, par, e)
    d = separation(X, i, p_i, j, p_j)
    # the wall turns: the speed of its body under the point counts
    v_i = velocity(V, i, (p_i[0] + d[0], p_i[1] + d[1], p_i[2] + d[2]))
    v_j = velocity(V, j, p_j)
    rate = -dot(n, (v_j[0] - v_i[0], v_j[1] - v_i[1], v_j[2] - v_i[2]))
    return -dot(n, d), rate, n


@kernel
def force(t, scene, a, b):
    X, V, S, con = scene.X, scene.V, scene.S, scene.con
    par, mem, F, zd, left = scene.par, scene.mem, scene.F, scene.zd, scene.left
    for e in range(a, b):
        if mem[e, PHASE] == FLIGHT:
            continue
        d, d_dot, n = touch(X, V, S, con, par, e)
        if d <= 0.0 and mem[e, PHASE] != CONTACT:
            continue
        i, j, k, c, ramp, branch = (
            con[e, 0], con[e, 1], par[e, 9], par[e, 10], par[e, 11], mem[e, BRANCH]
        )  # fmt: skip
        if mem[e, PHASE] == CONTACT and c > 0.0 and branch != WHOLE:
            left[e] = max(left[e], ramped_beyond(branch, d, d_dot, k, c, ramp))
            f = ramped_on_branch(branch, d, d_dot, k, c, ramp)
        else:
            # a trial step past the separation goes on smoothly; it is cut at the root of d
            f = k * d if d <= 0.0 else ramped_damping(d, d_dot, k, c, ramp)
        on_j, on_i = (f * n[0], f * n[1], f * n[2]), (-f * n[0], -f * n[1], -f * n[2])
        if con[e, 3] == ON_ANGLE:
            twist(F, j, on_j)
            twist(F, i, on_i)
        else:
            p_j = arm(X, j, par[e, 3], par[e, 4], par[e, 5])
            push(F, j, p_j, on_j)
            r_i = (X[j, 0] + p_j[0] - X[i, 0], X[j, 1] + p_j[1] - X[i, 1],
                   X[j, 2] + p_j[2] - X[i, 2])  # fmt: skip
            push(F, i, r_i, on_i)
        zd[IMPACTS] -= (f - k * d) * d_dot


@kernel
def gap(t, scene, a, b):
    X, V, S, con, par, g = scene.X, scene.V, scene.S, scene.con, scene.par, scene.gap
    for e in range(a, b):
        d, d_dot, _ = touch(X, V, S, con, par, e)
        g[e, 0] = d
        g[e, 1] = d_dot


@kernel
def corners(t, scene, a, b):
    X, V, S, con = scene.X, scene.V, scene.S, scene.con
    par, mem, out = scene.par, scene.mem, scene.corner
    for e in range(a, b):
        out[e, 0] = -1.0
        k, c, ramp, branch = par[e, 9], par[e, 10], par[e, 11], mem[e, BRANCH]
        if c == 0.0 or mem[e, PHASE] != CONTACT:
            continue
        d, d_dot, _ = touch(X, V, S, con, par, e)
        if branch == WHOLE:
            out[e, 1] = ramped_branch_of(d, d_dot, k, c, ramp)
        else:
            out[e, 0] = ramped_beyond(branch, d, d_dot, k, c, ramp)
            out[e, 1] = ramped_neighbour(branch, d, d_dot, k, c, ramp)


@kernel
def energy(t, scene, a, b):
    X, S, con, par, mem, E = scene.X, scene.S, scene.con, scene.par, scene.mem, scene.E
    for e in range(a, b):
        if mem[e, PHASE] == FLIGHT:
            continue
        # the penetration needs no velocity: X stands in for V, its rate is not used
        d, _, _ = touch(X, X, S, con, par, e)
        if d > 0.0:
            E[CONTACTS] += 0.5 * par[e, 9] * d * d


@kernel
def measure(t, scene, a, b):
    X, V, S, con = scene.X, scene.V, scene.S, scene.con
    par, mem, col, out = scene.par, scene.mem, scene.wanted, scene.out
    for e in range(a, b):
        o = col[e]
        if o < 0:
            continue
        d, d_dot, n = touch(X, V, S, con, par, e)
        f = 0.0
        if mem[e, PHASE] != FLIGHT and d > 0.0:
            f = ramped_damping(d, d_dot, par[e, 9], par[e, 10], par[e, 11])
        out[o] = f
        out[o + 1] = d
        out[o + 2] = f * n[0]
        out[o + 3] = f * n[1]
        out[o + 4] = f * n[2]


def reach(row):
    i, j, _, kind = row.con
    if kind != ON_WALL:  # along the coordinate of a joint
        return Reach()
    return Reach(forces=((i, row.par[6:9]),), places=((j, row.par[3:6], (i, j)),))


def turning(row):
    """The wall is carried along by its body."""
    if row.con[3] != ON_WALL:
        return Turning(frames=row.con[:2])
    return Turning(points=((row.con[1], row.par[3:6]),), axes=((row.con[0], row.par[6:9]),))


ELEMENT = Element(
    key="limit_stop",
    section="forces",
    spec=LimitStop,
    pack=pack,
    reach=reach,
    channels=(
        Channel("normal_force", "drive", "contact force or torque; never negative", least=0.0),
        Channel("penetration", "coordinate", "positive in contact, minus the free gap otherwise"),
        Channel("force", "drive", "force (on an angle: torque) on the second body, world axes", 3),
    ),
    turning=turning,
    picture="stop",
    loads={"normal_force": "contact force"},
    kernels={
        "force": force,
        "gaps": gap,
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
