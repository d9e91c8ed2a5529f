"""Spring and damper between two points.

    T = T_0 + k (l - l_0) + c l'        tension along the line, pulling body j toward body i

l is the distance of the points, l_0 the length as drawn unless given.  At l = 0 the line has no
direction and the force is zero.
"""

from math import sqrt
from typing import Annotated, ClassVar

from annotated_types import Ge

from trsim.elements.contract import (
    DAMPERS,
    SPRINGS,
    Channel,
    Element,
    Reach,
    Row,
    between_points,
    kernel,
)
from trsim.elements.frames import line, push
from trsim.fields import Spec, Unit, point


class SpringDamper(Spec):
    """A linear spring and damper between a point of each body.

    bodies       the two bodies
    points       on the first and on the second body, as drawn
    stiffness    of the spring
    damping      of the damper
    free_length  where the spring has its preload; the distance as drawn unless given
    preload      tension at the free length
    """

    type: ClassVar[str] = "spring_damper"
    bodies: tuple[str, str]
    points: tuple[point("m"), point("m")]
    stiffness: Annotated[float, Ge(0), Unit("N/m")]
    damping: Annotated[float, Ge(0), Unit("N*s/m")] = 0.0
    free_length: Annotated[float, Ge(0), Unit("m")] | None = None
    preload: Annotated[float, Unit("N")] = 0.0


def pack(name, spec, at):
    p, q = spec.points
    i, j = at.bodies(spec.bodies, p, q)
    drawn = sqrt(sum((b - a) ** 2 for a, b in zip(p, q, strict=True)))
    free = drawn if spec.free_length is None else spec.free_length
    return Row(
        (i, j, -1),
        (*at.local(i, p), *at.local(j, q), spec.preload, spec.stiffness, spec.damping, free),
    )


@kernel
def force(t, scene, a, b):
    X, V, con, par, F, zd = scene.X, scene.V, scene.con, scene.par, scene.F, scene.zd
    for e in range(a, b):
        p_i, p_j, n, length, rate = line(X, V, con, par, e)
        damping = par[e, 8] * rate
        T = par[e, 6] + par[e, 7] * (length - par[e, 9]) + damping
        push(F, con[e, 0], p_i, (T * n[0], T * n[1], T * n[2]))
        push(F, con[e, 1], p_j, (-T * n[0], -T * n[1], -T * n[2]))
        zd[DAMPERS] -= damping * rate


@kernel
def energy(t, scene, a, b):
    X, con, par, E = scene.X, scene.con, scene.par, scene.E
    for e in range(a, b):
        # the length needs no velocity: X stands in for V, its rate is not used
        _, _, _, length, _ = line(X, X, con, par, e)
        x = length - par[e, 9]
        E[SPRINGS] += 0.5 * par[e, 7] * x * x + par[e, 6] * x


@kernel
def measure(t, scene, a, b):
    X, V, con, par, col, out = scene.X, scene.V, scene.con, scene.par, scene.wanted, scene.out
    for e in range(a, b):
        if col[e] < 0:
            continue
        _, _, _, length, rate = line(X, V, con, par, e)
        out[col[e]] = par[e, 6] + par[e, 7] * (length - par[e, 9]) + par[e, 8] * rate
        out[col[e] + 1] = length


def reach(row):
    i, j = row.con[:2]
    p, q = row.par[:3], row.par[3:6]
    return Reach(lines=((i, p, j, q),), places=((i, p, (i, j)),), always=True)


ELEMENT = Element(
    key="spring_damper",
    section="forces",
    spec=SpringDamper,
    pack=pack,
    reach=reach,
    channels=(
        Channel("force", "N", "tension"),
        Channel("length", "m", "distance of the two points"),
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
