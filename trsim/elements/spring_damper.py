"""Spring and damper between two points.

    T = T_0 + k (l - l_0) + c l'        tension along the line, pulling body j toward body i

l is the distance between the points, l_0 the free length (as drawn unless given).  At l = 0 the
line has no direction and the force is zero.
"""

from typing import Annotated, ClassVar

from annotated_types import Ge

from trsim.elements.between import free_length, reach_always
from trsim.elements.contract import (
    DAMPERS,
    SPRINGS,
    Channel,
    Element,
    Row,
    kernel,
    measured,
)
from trsim.elements.frames import (
    TwoPoints,
    at_both,
    between_points,
    line,
    points,
    push_apart,
    scaled,
)
from trsim.fields import Spec, Unit, point
from trsim.kernels.columns import f8


class SpringDamper(Spec):
    """A linear spring and damper between a point of each body.

    bodies       the two bodies
    points       its ends, on the first and on the second body, as drawn
    stiffness    stiffness of the spring
    damping      damping of the damper
    free_length  length at which the spring has its preload; the distance as drawn unless given
    preload      tension at the free length
    """

    type: ClassVar[str] = "spring_damper"
    bodies: tuple[str, str]
    points: tuple[point("m"), point("m")]
    stiffness: Annotated[float, Ge(0), Unit("N/m")]
    damping: Annotated[float, Ge(0), Unit("N*s/m")] = 0.0
    free_length: Annotated[float, Ge(0), Unit("m")] | None = None
    preload: Annotated[float, Unit("N")] = 0.0


class Own(TwoPoints):
    """Of one instance."""

    preload: f8
    stiffness: f8
    damping: f8
    free_length: f8


def pack(name, spec, at):
    p, q = spec.points
    i, j = at.bodies(spec.bodies, p, q)
    return Row(*Own.packed(spec, **points(at, i, j, p, q), free_length=free_length(spec)))


@kernel
def force(t, scene, e):
    own = Own(scene, e)
    p_i, p_j, n, length, rate = line(scene, e)
    damping = own.damping * rate
    T = own.preload + own.stiffness * (length - own.free_length) + damping
    push_apart(scene.F, own.i, p_i, own.j, p_j, scaled(-T, n))
    scene.zd[DAMPERS] -= damping * rate


@kernel
def energy(t, scene, e):
    own = Own(scene, e)
    _, _, _, length, _ = line(scene, e)
    x = length - own.free_length
    scene.E[SPRINGS] += 0.5 * own.stiffness * x * x + own.preload * x


@measured
def measure(t, scene, e, o):
    own = Own(scene, e)
    _, _, _, length, rate = line(scene, e)
    spring = own.preload + own.stiffness * (length - own.free_length)
    scene.out[o] = spring + own.damping * rate
    scene.out[o + 1] = length


ELEMENT = Element(
    key="spring_damper",
    section="forces",
    spec=SpringDamper,
    pack=pack,
    acts_at=at_both,
    reach=reach_always,
    channels=(
        Channel("force", "N", "tension"),
        Channel("length", "m", "distance between the two points"),
    ),
    turning=between_points,
    picture="coil",
    loads={"force": "force"},
    kernels={"force": force, "energy": energy, "measure": measure},
    example="""
bodies:
  block: {mass: 2 kg, inertia: 0.01 kg*m^2}
joints:
  slide: {type: prismatic, bodies: [ground, block], axis: [1, 0, 0]}
forces:
  spring: {type: spring_damper, bodies: [ground, block], points: [[-0.2, 0], [0, 0]],
           stiffness: 500 N/m, damping: 2 N*s/m, preload: 10 N}
solver: {end: 1 s}
""",
)
