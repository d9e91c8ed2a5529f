"""Actuator: a ball-ended strut of prescribed length between two bodies, rigid or compliant.

    e = l - l_0                                         stroke; l is the distance of its ends
    rigid       Phi = e - f(t) = 0,  P = -lambda
    compliant   P = -k (e - u) - c (e' - u')            thrust: pushes the ends apart
    u = f, or with a compliant supply
    m u'' = -k_s (u - f) - c_s (u' - f') - P + G        piston; G from a shaft, see sync_shaft.py

f is the prescribed stroke or, if a speed is prescribed, its integral from the initial stroke (a
state of the element; u and u' - f' are two more).  With ball joints at both ends it transmits no
moment, so the force on body j is P n, with n from end i to end j; it is not a number if l_0 + u is
not positive.  In the energy balance the kinetic energy of the piston counts with the springs.  For
the rigid one, l'' = n . d'' + (d' . d' - l'^2) / l, with d from end i to end j.
[Featherstone2008]
"""

from math import nan
from typing import Annotated, ClassVar, Literal

from annotated_types import Ge, Gt
from pydantic import model_validator

from trsim.elements.between import drawn_length, reach, stretched
from trsim.elements.contract import (
    DAMPERS,
    DRIVES,
    SPRINGS,
    Channel,
    Element,
    Limit,
    Row,
    kernel,
    measured,
)
from trsim.elements.frames import (
    at_both,
    between_points,
    distance_row,
    line,
    points,
    push_apart,
    scaled,
)
from trsim.elements.prescribed import AnyDrive, holds, prescribed
from trsim.errors import ScenarioError
from trsim.fields import Spec, Unit, point
from trsim.kernels.columns import f8, i8
from trsim.kernels.lazy import internal
from trsim.varying import Function


class Supply(Spec):
    """What lies between the prescribed motion and the piston, such as a column of oil.

    stiffness  stiffness of the supply
    damping    damping of the supply
    mass       mass that moves with the piston: its own, and the inertia of a gear times the square
               of its ratio
    """

    stiffness: Annotated[float, Gt(0), Unit("N/m")]
    damping: Annotated[float, Ge(0), Unit("N*s/m")] = 0.0
    mass: Annotated[float, Gt(0), Unit("kg")]


class Actuator(Spec):
    """A straight actuator with a ball joint at each end and a prescribed stroke or speed.

    bodies     the two bodies
    points     its ends, on the first and on the second body, as drawn
    velocity   prescribed rate of the stroke
    position   prescribed stroke, 0 as drawn; give either this or the velocity
    stiffness  stiffness between the piston and the second body, or of the whole actuator; rigid
               without it
    damping    damping, at the same point as the stiffness
    supply     spring and damper between the prescribed motion and the piston; for a piston that a
               shaft can move
    stall      largest force, of either sign, that its source can give (the supply, if there is
               one); beyond it the run ends as `jammed`
    sign       sign of the channel `force`: 1, positive when it pushes its ends apart; -1, positive
               when it holds them together
    """

    type: ClassVar[str] = "actuator"
    bodies: tuple[str, str]
    points: tuple[point("m"), point("m")]
    velocity: Function("m/s") | None = None
    position: Function("m") | None = None
    stiffness: Annotated[float, Gt(0), Unit("N/m")] | None = None
    damping: Annotated[float, Ge(0), Unit("N*s/m")] = 0.0
    supply: Supply | None = None
    stall: Annotated[float, Gt(0), Unit("N")] | None = None
    sign: Literal[1, -1] = 1

    @model_validator(mode="after")
    def consistent(self):
        if (self.position is None) == (self.velocity is None):
            raise ValueError("give either `position` or `velocity`")
        for key in ("supply", "stall", "damping"):
            if getattr(self, key) and self.stiffness is None:
                raise ScenarioError(
                    f"a rigid actuator has no {key}", "Give it a `stiffness`.", (key,)
                )
        return self

    def at_rest(self):
        """One spring without the damper, which would push a body at rest along with it."""
        k = self.stiffness
        if self.supply is not None:
            k = k * self.supply.stiffness / (k + self.supply.stiffness)
        return self.model_copy(update={"stiffness": k, "damping": 0.0, "supply": None})


class Own(AnyDrive):
    """Of one instance; with a supply it has states u and u' - f', else -1."""

    place: i8
    slip: i8
    length: f8  # l_0
    supply: f8
    supply_damping: f8
    mass: f8
    stall: f8


def pack(name, spec, at):
    p, q = spec.points
    i, j = at.bodies(spec.bodies, p, q)
    drawn = drawn_length(spec)
    if drawn == 0.0:
        raise ScenarioError("its ends coincide as drawn", "the line has no direction", ("points",))
    entry = at.entry()
    by_velocity = spec.position is None
    word = "velocity" if by_velocity else "position"
    f = at.function(getattr(spec, word), word, time_only=True)
    states = (at.state("stroke", follows=entry) if by_velocity else -1, -1, -1)
    supply, supply_damping, mass = 0.0, 0.0, 0.0
    if spec.supply is not None:
        states = (states[0], at.state("stroke", follows=entry), at.state("speed"))
        supply, supply_damping = spec.supply.stiffness, spec.supply.damping
        mass = spec.supply.mass
    limits = (Limit("stall", spec.stall, "N", "jammed", STALLED),) if spec.stall else ()
    channels = None if spec.supply is None else (*CHANNELS, *WITH_SUPPLY)
    state, piston, slip = states
    own = Own.packed(
        spec, **points(at, i, j, p, q, entry), axis=(0.0, 0.0, 0.0), state=state, rotates=False,
        motion=f, stiffness=spec.stiffness or 0.0, place=piston, slip=slip, length=drawn,
        supply=supply, supply_damping=supply_damping, mass=mass, stall=spec.stall or 0.0,
    )  # fmt: skip
    return Row(*own, None, channels, spec.stiffness is not None, states, limits,
               piston=piston, slip=slip, length=drawn)  # fmt: skip


STALLED = "reached its stall force"


@kernel
def coordinate(t, scene, e):
    own = Own(scene, e)
    stretched(scene, e, own.coordinate, own.length)


@kernel
def constraint(t, scene, e):
    own = Own(scene, e)
    k = own.row
    if k < 0:
        return
    f, f_dot, f_ddot = prescribed(t, scene, e)
    distance_row(scene, e, k)
    scene.phi[k] -= own.length + f
    scene.phi_t[k] = -f_dot
    scene.gamma[k] += f_ddot


@internal
def state_of(t, scene, e):
    """Thrust, force of the supply on the piston, piston u and u', f, f' and f'' of instance e.

    Reads the stroke and its rate from S.  Without a supply the piston is where f puts it, and once
    it is released f where the stroke is; a supply goes on driving a piston that was released.
    """
    S, z, own = scene.S, scene.z, Own(scene, e)
    f, f_dot, f_ddot = prescribed(t, scene, e)
    s = own.coordinate
    if own.place < 0 and not holds(scene, e):
        f, f_dot, f_ddot = S[s, 0], S[s, 1], 0.0
    u, u_dot = f, f_dot
    if own.place >= 0:
        u, u_dot = z[own.place], f_dot + z[own.slip]
    if own.length + u <= 0.0:
        u = nan  # no line has such a length: the run ends here, and says whose it is
    P = -own.stiffness * (S[s, 0] - u) - own.damping * (S[s, 1] - u_dot)
    behind = -own.supply * (u - f) - own.supply_damping * (u_dot - f_dot)
    if own.place < 0:
        behind = P
    return P, behind, u, u_dot, f, f_dot, f_ddot


@kernel
def force(t, scene, e):
    zd, own = scene.zd, Own(scene, e)
    P, behind, _, u_dot, _, f_dot, f_ddot = state_of(t, scene, e)
    if own.state >= 0:
        zd[own.state] = f_dot
    if own.place >= 0:
        slip = u_dot - f_dot
        zd[own.place] = u_dot
        zd[own.slip] = (behind - P) / own.mass - f_ddot
        zd[DAMPERS] -= own.supply_damping * slip * slip
        zd[DRIVES] += behind * f_dot
    if own.stiffness > 0.0:
        stretch = scene.S[own.coordinate, 1] - u_dot
        zd[DAMPERS] -= own.damping * stretch * stretch
        p_i, p_j, n, _, _ = line(scene, e)
        push_apart(scene.F, own.i, p_i, own.j, p_j, scaled(P, n))
        if own.place < 0:
            zd[DRIVES] += behind * f_dot


@kernel
def gap(t, scene, e):
    g = scene.gap
    own = Own(scene, e)
    _, behind, _, u_dot, _, f_dot, _ = state_of(t, scene, e)
    sign = 1.0 if behind > 0.0 else -1.0
    g[e, 0] = sign * behind - own.stall
    # of the spring alone: that of the damper takes accelerations
    g[e, 1] = -sign * own.stiffness * (scene.S[own.coordinate, 1] - u_dot)
    if own.place >= 0:
        g[e, 1] = -sign * own.supply * (u_dot - f_dot)


@kernel
def energy(t, scene, e):
    own = Own(scene, e)
    if own.stiffness == 0.0 and own.place < 0:
        return
    f, f_dot, _ = prescribed(t, scene, e)
    u = f
    if own.place >= 0:
        u, u_dot = scene.z[own.place], f_dot + scene.z[own.slip]
        scene.E[SPRINGS] += 0.5 * own.supply * (u - f) ** 2 + 0.5 * own.mass * u_dot**2
    scene.E[SPRINGS] += 0.5 * own.stiffness * (scene.S[own.coordinate, 0] - u) ** 2


@measured
def measure(t, scene, e, o):
    S, out = scene.S, scene.out
    own = Own(scene, e)
    P, behind, u, _, f, f_dot, _ = state_of(t, scene, e)
    if own.row >= 0:
        P = -scene.lam[own.row]
        behind = P
    _, _, n, _, _ = line(scene, e)
    out[o] = own.sign * P
    for c in range(3):
        out[o + 1 + c] = P * n[c]
    out[o + 4], out[o + 5] = S[own.coordinate, 0], S[own.coordinate, 1]
    out[o + 6], out[o + 7], out[o + 8] = f, f_dot, behind * f_dot
    if own.place >= 0:
        out[o + 9], out[o + 10] = u, own.sign * behind


CHANNELS = (
    Channel("force", "N", "sign times the thrust along its line"),
    Channel("reaction", "N", "force on the second body, world axes", 3),
    Channel("stroke", "m", "increase in length from the drawn state"),
    Channel("stroke_rate", "m/s", "its rate"),
    Channel("position", "m", "prescribed stroke; its own once released"),
    Channel("velocity", "m/s", "its rate"),
    Channel("power", "W", "power given to the mechanism"),
)
WITH_SUPPLY = (
    Channel("piston", "m", "stroke of the piston"),
    Channel("supply_force", "N", "sign times the force of the supply on the piston"),
)


ELEMENT = Element(
    key="actuator",
    section="drives",
    spec=Actuator,
    pack=pack,
    acts_at=at_both,
    reach=reach,
    rows=("length",),
    channels=CHANNELS,
    turning=between_points,
    picture="cylinder",
    loads={"force": "force"},
    kernels={
        "coordinate": coordinate,
        "constraint": constraint,
        "force": force,
        "gaps": gap,
        "energy": energy,
        "measure": measure,
    },
    example="""
bodies:
  block: {mass: 2 kg, inertia: 0.01 kg*m^2}
joints:
  slide: {type: prismatic, bodies: [ground, block], axis: [1, 0, 0]}
drives:
  jack: {type: actuator, bodies: [ground, block], points: [[-0.3, 0], [0, 0]],
         velocity: "0.1*smoothstep(t/0.2)", stiffness: 1e5 N/m, damping: 100 N*s/m}
solver: {end: 0.5 s}
""",
)
