"""Gear mesh: two wheels with elastic teeth and backlash.

    x = c_1 (phi_1 - phi_1,0) + c_2 (phi_2 - phi_2,0)        along the pitch line; c as in gear.py
    T = max(0, k d + c s(d/ramp) x')       d = x - b/2 > 0        one flank
        min(0, k d + c s(-d/ramp) x')      d = x + b/2 < 0        the other one
        0                                  between                the teeth are free
    -c_k T     torque on the second body of joint k about its axis; the opposite on the first

x is how far the first wheel is ahead, and b the backlash; as drawn, the teeth are in the middle of
it.  With backlash the teeth never pull; without it (b = 0), T = k x + c x' on both flanks.  s is
the smoothstep: the damping fades in, so that the force does not jump at a touch.  Steps end where
teeth touch and separate.  The instants at which T reaches zero while the teeth still touch are not
located; the error estimate covers them.
"""

from typing import Annotated, ClassVar

from annotated_types import Ge, Gt

from trsim.elements.contract import (
    DAMPERS,
    SPRINGS,
    Channel,
    Element,
    Reach,
    Row,
    kernel,
    measured,
)
from trsim.elements.frames import TwoAngles, arm, scaled, twist_apart
from trsim.elements.gear import sense
from trsim.elements.transmission import carried
from trsim.fields import Flag, Spec, Unit
from trsim.kernels.columns import V3, f8, i8
from trsim.kernels.lazy import internal
from trsim.laws.functions import value
from trsim.laws.tables import smoothstep
from trsim.varying import FunctionSpec

X = "stretch"  # the word for x in functions
Length = Annotated[float, Gt(0), Unit("m")]


class GearMesh(Spec):
    """Two wheels in mesh, each on a hinge of one carrier, with elastic teeth and backlash.

    joints     the hinges of the first and the second wheel; they share the carrier, which may be
               the ground
    radii      radii of the pitch circles
    internal   whether one wheel is inside the other
    stiffness  stiffness of the teeth along the pitch line
    damping    damping of the teeth along the pitch line, while they touch
    backlash   play along the pitch line, from one flank to the other
    ramp       penetration over which the damping fades in, if there is play
    """

    type: ClassVar[str] = "gear_mesh"
    joints: tuple[str, str]
    radii: tuple[Length, Length]
    internal: Flag = False
    stiffness: Annotated[float, Gt(0), Unit("N/m")]
    damping: Annotated[float, Ge(0), Unit("N*s/m")] = 0.0
    backlash: Annotated[float, Ge(0), Unit("m")] = 0.0
    ramp: Length = 1e-5


class Own(TwoAngles):
    """Of one instance; i and j are those of the first joint, the coordinate is x."""

    angle_1: i8  # in S
    angle_2: i8
    flanks: i8  # k times how far the teeth are pressed in, in tab
    whole: i8  # the same, which no run holds on a piece: for the energy
    axis_1: V3  # in the axes of i
    axis_2: V3
    drawn: f8  # m, c_1 phi_1 + c_2 phi_2 as drawn
    stiffness: f8
    damping: f8
    half: f8  # m, of the backlash
    ramp: f8
    p_1i: V3  # m, the joints' places on their bodies
    p_1j: V3
    p_2i: V3
    p_2j: V3


def pack(name, spec, at):
    found = carried(spec, ("angle", "angle"), at)
    x, y = found.x, found.y
    first, second = spec.radii
    c_1, c_2 = found.of_x * first, -sense(x, y, spec) * found.of_y * second
    entry = at.entry()
    law, local = pressed_in(spec), {X: (entry, "m")}
    flanks = at.function(law, "backlash", wanted="N", local=local)
    whole = at.function(law, "backlash", wanted="N", local=local, free=True)
    own = Own.packed(
        spec, i=x.i, j=x.j, i_2=y.i, j_2=y.j, angle_1=x.entry, angle_2=y.entry, coordinate=entry,
        flanks=flanks, whole=whole, axis_1=x.axis_i, axis_2=y.axis_i, c_1=c_1, c_2=c_2,
        drawn=c_1 * x.drawn + c_2 * y.drawn, half=0.5 * spec.backlash,
        p_1i=x.s_i, p_1j=x.s_j, p_2i=y.s_i, p_2j=y.s_j,
    )  # fmt: skip
    return Row(*own, travel="train")


def pressed_in(spec):
    """The elastic force as a function of x: its corners are where teeth meet and part."""
    k, half, zero = ("number", spec.stiffness), ("number", 0.5 * spec.backlash), ("number", 0.0)
    x = ("name", X)
    if spec.backlash == 0.0:
        return FunctionSpec("expression", node=("binary", "*", k, x))
    one = ("call", "max", (("binary", "-", x, half), zero))
    other = ("call", "min", (("binary", "+", x, half), zero))
    return FunctionSpec("expression", node=("binary", "*", k, ("binary", "+", one, other)))


@internal
def teeth(t, scene, e):
    """T, and what of it is elastic."""
    own = Own(scene, e)
    pushed = value(scene.tab, own.flanks, t, scene.S)
    if pushed == 0.0 and own.half > 0.0:
        return 0.0, 0.0
    faded = 1.0
    if own.half > 0.0:
        faded = smoothstep(abs(pushed) / (own.stiffness * own.ramp))
    T = pushed + faded * own.damping * scene.S[own.coordinate, 1]
    if own.half > 0.0 and T * pushed < 0.0:  # teeth never pull
        return 0.0, pushed
    return T, pushed


@kernel
def coordinate(t, scene, e):
    S, own = scene.S, Own(scene, e)
    k = own.coordinate
    S[k, 0] = own.c_1 * S[own.angle_1, 0] + own.c_2 * S[own.angle_2, 0] - own.drawn
    S[k, 1] = own.c_1 * S[own.angle_1, 1] + own.c_2 * S[own.angle_2, 1]


@kernel
def force(t, scene, e):
    S, X, own = scene.S, scene.X, Own(scene, e)
    T, elastic = teeth(t, scene, e)
    for_1 = scaled(-own.c_1 * T, arm(X, own.i, own.axis_1))
    for_2 = scaled(-own.c_2 * T, arm(X, own.i_2, own.axis_2))
    twist_apart(scene.F, own.i, own.j, for_1)
    twist_apart(scene.F, own.i_2, own.j_2, for_2)
    scene.zd[DAMPERS] -= (T - elastic) * S[own.coordinate, 1]


@kernel
def energy(t, scene, e):
    own = Own(scene, e)
    pushed = value(scene.tab, own.whole, t, scene.S)
    scene.E[SPRINGS] += 0.5 * pushed * pushed / own.stiffness


@measured
def measure(t, scene, e, o):
    own, out = Own(scene, e), scene.out
    T, _ = teeth(t, scene, e)
    out[o], out[o + 1] = T, scene.S[own.coordinate, 0]
    out[o + 2], out[o + 3] = -own.c_1 * T, -own.c_2 * T


def reach(row):
    own = Own.of(row)
    return Reach(hinges=((own.i, own.axis_1), (own.i_2, own.axis_2)))


def acts_at(row):
    """Where its joints are."""
    own = Own.of(row)
    first = (own.i, own.p_1i), (own.j, own.p_1j)
    return (*first, (own.i_2, own.p_2i), (own.j_2, own.p_2j))


def acts_on(row):
    own = Own.of(row)
    return frozenset((own.i, own.j, own.i_2, own.j_2))


ELEMENT = Element(
    key="gear_mesh",
    section="forces",
    spec=GearMesh,
    pack=pack,
    acts_on=acts_on,
    acts_at=acts_at,
    reach=reach,
    channels=(
        Channel(
            "force", "N", "force of the teeth along the pitch line, positive on the first flank"
        ),
        Channel(
            "play",
            "m",
            "how far the first wheel is ahead, measured from the middle of the backlash",
        ),
        Channel("torque_1", "N*m", "torque on the second body of joint 1, about its axis"),
        Channel("torque_2", "N*m", "torque on the second body of joint 2, about its axis"),
    ),
    loads={"force": "force"},
    picture="wheels",
    kernels={"coordinate": coordinate, "force": force, "energy": energy, "measure": measure},
    example="""
bodies:
  pinion: {mass: 1 kg, inertia: 0.002 kg*m^2, at: [0, 0], angular_velocity: [0, 0, 5]}
  wheel: {mass: 3 kg, inertia: 0.02 kg*m^2, at: [0.15, 0]}
joints:
  first: {type: revolute, bodies: [ground, pinion], at: [0, 0]}
  second: {type: revolute, bodies: [ground, wheel], at: [0.15, 0]}
forces:
  teeth: {type: gear_mesh, joints: [first, second], radii: [50 mm, 100 mm],
          stiffness: 1e6 N/m, damping: 20 N*s/m, backlash: 0.1 mm}
solver: {end: 0.2 s}
""",
)
