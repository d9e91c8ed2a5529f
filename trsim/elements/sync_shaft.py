"""Synchronising shaft: a flexible shaft between actuators, joined to each piston by a worm gear.

    M_k = g k (u_{k+1} - u_k) + g c (u'_{k+1} - u'_k)     torque in the segment behind station k
    G_k = g (M_k - M_{k-1})                               ideal force of the gear on piston k

g is the rotation of the shaft per stroke (rad/m).  So a segment acts like a spring of g^2 k (N/m)
between two pistons, which pulls the one that lags and holds back the one that leads.  Of the ideal
force the gear loses

    (1 - eta) |G|           where the shaft moves the piston (G u' > 0)
    (1 / eta_b - 1) |G|     where the piston moves the shaft, eta_b = 2 - 1 / eta      [Shigley2015]

to friction, which opposes the motion.  It is multiplied by u' / sqrt(u'^2 + v_t^2), so that it
changes direction smoothly over the speed v_t, `turning_speed`, and is full only well above it.
With eta <= 1/2 a piston cannot turn the shaft at all: the gear is self-locking.  A piston that
leads is then held with eta_b = LOCKED, a hundred times harder than by an ideal gear, so that almost
nothing of its lead remains.

The shaft can move a piston only if its actuator has a `supply`.  Without one the motion of the
piston is prescribed: then the shaft changes nothing, and its torque is only reported.
"""

from math import sqrt
from typing import Annotated, ClassVar

from annotated_types import Ge, Gt, Le
from pydantic import model_validator

from trsim.elements.actuator import Own as Actuator
from trsim.elements.contract import (
    DAMPERS,
    DRIVES,
    FRICTION,
    SPRINGS,
    Channel,
    Element,
    Limit,
    Memory,
    Row,
    kernel,
    measured,
)
from trsim.errors import ScenarioError
from trsim.fields import Flag, Spec, Unit
from trsim.kernels.columns import f8, i8, run
from trsim.kernels.lazy import internal


class SyncShaft(Spec):
    """A shaft that synchronises actuators.

    actuators      the actuators in their order along the shaft, each driven by a `velocity`
    stiffness      torsional stiffness of a segment between two neighbours
    damping        torsional damping of a segment
    ratio          rotation of the shaft per stroke
    efficiency     efficiency of the worm gears when the shaft moves a piston
    self_locking   whether the gears are self-locking, so that no piston can turn the shaft; unless
                   given, they are up to an efficiency of 0.5
    turning_speed  speed of a piston over which the friction of its gear changes direction
    lost_at        difference between the strokes of neighbours at which synchronism counts as lost
                   and the run ends as `jammed`; for a shaft of strength M it is M / (stiffness
                   ratio)
    """

    type: ClassVar[str] = "sync_shaft"
    actuators: tuple[str, ...]
    stiffness: Annotated[float, Ge(0), Unit("N*m/rad")]
    damping: Annotated[float, Ge(0), Unit("N*m*s/rad")] = 0.0
    ratio: Annotated[float, Gt(0), Unit("rad/m")]
    efficiency: Annotated[float, Gt(0), Le(1), Unit("-")] = 1.0
    self_locking: Flag | None = None
    turning_speed: Annotated[float, Gt(0), Unit("m/s")] = 1e-3
    lost_at: Annotated[float, Gt(0), Unit("m")] | None = None

    @model_validator(mode="after")
    def a_gear(self):
        if self.efficiency <= 0.5 and self.self_locking is False:
            raise ScenarioError(
                f"a worm gear of efficiency {self.efficiency:g} is self-locking",
                "Leave `self_locking` out, or give an efficiency above 0.5.",
                ("self_locking",),
            )
        return self


class Own(Memory):
    """Of one instance."""

    i: i8  # the ground, as all it acts on are states
    j: i8
    count: i8  # how many pistons
    stations: run(i8)  # of each its place and its slip in z, or -1
    stiffness: f8
    damping: f8
    ratio: f8
    loss: f8  # of the ideal force, where the shaft moves the piston
    loss_back: f8  # and where the piston moves the shaft
    lost_at: f8
    turning_speed: f8
    masses: run(f8)  # of the pistons


LOCKED = 0.01  # eta_b of a self-locking gear
WHOLE = 10.0  # turning speeds: from here on friction is whole to half a per cent


def pack(name, spec, at):
    if len(spec.actuators) < 2:
        raise ScenarioError("joins two or more actuators", "", ("actuators",))
    stations, masses = [], []
    for k, one in enumerate(spec.actuators):
        found = at.packed("drives", one, ("actuators", k))
        if one in spec.actuators[:k]:
            raise ScenarioError(f"'{one}' stands there twice", "", ("actuators", k))
        driven = Actuator.of(found.row) if found.element.key == "actuator" else None
        if driven is None or driven.state < 0:
            raise ScenarioError(
                f"'{one}' is no actuator with a velocity",
                "a shaft joins elements of `type: actuator`, each driven by its `velocity`",
                ("actuators", k),
            )
        stations += [driven.state if driven.place < 0 else driven.place, driven.slip]
        masses.append(driven.mass)
    if not any(masses):
        at.notes.append(
            "actuators: their speeds are prescribed, so the shaft changes nothing and "
            "its torque is told (a `supply` lets a piston give way)"
        )
    locks = spec.self_locking or spec.efficiency <= 0.5
    back = LOCKED if locks else max(2.0 - 1.0 / spec.efficiency, LOCKED)
    n = len(spec.actuators)
    losses = {"loss": 1.0 - spec.efficiency, "loss_back": 1.0 / back - 1.0}
    own = Own.packed(
        spec, i=0, j=0, count=n, stations=stations, **losses, lost_at=spec.lost_at or 0.0,
        masses=masses,
    )  # fmt: skip
    said = "synchronism was lost: the strokes of two neighbours differ too much"
    limits = (Limit("lost", spec.lost_at, "m", "jammed", said),) if spec.lost_at else ()
    states = tuple(s for s in stations if s >= 0)
    return Row(*own, None, channels(n), states=states, limits=limits)


def channels(n):
    """The channels of a shaft between n actuators."""
    return (
        *(
            Channel(
                f"torque_{k}", "N*m", f"torque in segment {k}, positive if the later actuator leads"
            )
            for k in range(1, n)
        ),
        *(
            Channel(f"force_{k}", "N", f"force of the gear on piston {k}, along its stroke")
            for k in range(1, n + 1)
        ),
        Channel("difference", "m", "largest difference between the strokes of neighbours"),
    )


@internal
def place(scene, e, k):
    """Stroke of piston k and its rate, which its actuator left in zd."""
    s = Own(scene, e).stations[2 * k]
    return scene.z[s], scene.zd[s]


@internal
def torque(scene, e, k):
    """Torque in segment k between pistons k and k + 1; zero beyond the ends."""
    own = Own(scene, e)
    if k < 0 or k >= own.count - 1:
        return 0.0
    u, u_dot = place(scene, e, k)
    v, v_dot = place(scene, e, k + 1)
    return own.ratio * (own.stiffness * (v - u) + own.damping * (v_dot - u_dot))


@internal
def gear(scene, e, k):
    """Ideal and real force on piston k, and its speed."""
    own = Own(scene, e)
    ideal = own.ratio * (torque(scene, e, k) - torque(scene, e, k - 1))
    _, speed = place(scene, e, k)
    way = speed / sqrt(speed * speed + own.turning_speed * own.turning_speed)
    loss = own.loss if ideal * speed > 0.0 else own.loss_back
    return ideal, ideal - loss * abs(ideal) * way, speed


@kernel
def force(t, scene, e):
    zd = scene.zd
    own = Own(scene, e)
    n = own.count
    for k in range(n - 1):
        _, u_dot = place(scene, e, k)
        _, v_dot = place(scene, e, k + 1)
        twist = own.ratio * (v_dot - u_dot)
        zd[DAMPERS] -= own.damping * twist * twist
    for k in range(n):
        ideal, G, speed = gear(scene, e, k)
        zd[FRICTION] += (G - ideal) * speed
        slip = own.stations[2 * k + 1]
        if slip >= 0:
            zd[slip] += G / own.masses[k]
        else:
            zd[DRIVES] -= G * speed  # whoever prescribes the motion takes the force


@internal
def largest_difference(scene, e):
    """The largest difference of the strokes of neighbours, and its rate."""
    largest, rate = -1.0, 0.0
    for k in range(Own(scene, e).count - 1):
        u, u_dot = place(scene, e, k)
        v, v_dot = place(scene, e, k + 1)
        if abs(v - u) > largest:
            largest = abs(v - u)
            rate = v_dot - u_dot if v > u else u_dot - v_dot
    return largest, rate


@kernel
def gap(t, scene, e):
    # the rate is that of the last evaluation: near enough to see whether it turns
    difference, rate = largest_difference(scene, e)
    scene.gap[e, 0] = difference - Own(scene, e).lost_at
    scene.gap[e, 1] = rate


@kernel
def energy(t, scene, e):
    own = Own(scene, e)
    for k in range(own.count - 1):
        u, _ = place(scene, e, k)
        v, _ = place(scene, e, k + 1)
        twist = own.ratio * (v - u)
        scene.E[SPRINGS] += 0.5 * own.stiffness * twist * twist


@measured
def measure(t, scene, e, o):
    out = scene.out
    n = Own(scene, e).count
    for k in range(n - 1):
        out[o + k] = torque(scene, e, k)
    for k in range(n):
        _, G, _ = gear(scene, e, k)
        out[o + n - 1 + k] = G
    difference, _ = largest_difference(scene, e)
    out[o + 2 * n - 1] = difference


def doubts(name, spec, largest):
    """Pistons that are slow beside the speed over which the friction of their gears turns round."""
    fastest = max(largest(f"{one}.velocity")[0] for one in spec.actuators)
    if spec.efficiency < 1.0 and 0.0 < fastest < WHOLE * spec.turning_speed:
        yield (
            f"forces.{name}.turning_speed: its actuators move with at most {fastest:.3g} m/s, "
            f"and friction of its gears turns round over {spec.turning_speed:g} m/s: it is "
            f"not whole below {WHOLE:g} times that; give a smaller one"
        )


def no_frames(row):
    """None: it acts on pistons only, which are states."""
    return frozenset()


ELEMENT = Element(
    key="sync_shaft",
    section="forces",
    spec=SyncShaft,
    pack=pack,
    channels=channels(2),  # and so on for more actuators
    acts_on=no_frames,
    doubts=doubts,
    kernels={"force": force, "gaps": gap, "energy": energy, "measure": measure},
    example="""
bodies:
  left: {mass: 2 kg, inertia: 0.01 kg*m^2}
  right: {mass: 2 kg, inertia: 0.01 kg*m^2, at: [0, 0.1]}
joints:
  upper: {type: prismatic, bodies: [ground, left], axis: [1, 0, 0]}
  lower: {type: prismatic, bodies: [ground, right], axis: [1, 0, 0]}
drives:
  one: {type: actuator, bodies: [ground, left], points: [[-0.3, 0], [0, 0]], velocity: 0.1 m/s,
        stiffness: 1e5 N/m, supply: {stiffness: 1e5 N/m, damping: 200 N*s/m, mass: 1 kg}}
  two: {type: actuator, bodies: [ground, right], points: [[-0.3, 0.1], [0, 0.1]],
        velocity: 0.11 m/s, stiffness: 1e5 N/m,
        supply: {stiffness: 1e5 N/m, damping: 200 N*s/m, mass: 1 kg}}
forces:
  shaft: {type: sync_shaft, actuators: [one, two], stiffness: 0.1 N*m/rad, ratio: 700 rad/m}
solver: {end: 0.1 s}
""",
)
