"""Spring, damper or rope between two points, with user-defined laws.

    x = l - l_0                     stretch; l is the distance between the points
    T = f(x) + w d(x')              tension along the line, pulling body j toward body i
    T = max(0, f + w d) for x > 0   if it can only pull, as a rope does; 0 while it is slack

f is the elastic force, d the damper (sprung.py).  l_0 is the length as drawn unless given.  At
l = 0 the line has no direction and the force is zero.
"""

from typing import Annotated, ClassVar

from annotated_types import Ge

from trsim.elements.between import free_length, reach_always, stretched
from trsim.elements.contract import DAMPERS, Channel, Element, Row, kernel, measured
from trsim.elements.frames import at_both, between_points, line, points, push_apart, scaled
from trsim.elements.sprung import (
    RATE,
    Law,
    Sprung,
    X,
    jump_at_zero,
    packed_law,
    store,
    tension,
)
from trsim.fields import Flag, Unit, point
from trsim.kernels.columns import f8
from trsim.varying import Function


class Spring(Sprung):
    """A spring, a damper or a rope between a point of each body, with laws given as functions.

    bodies        the two bodies
    points        its ends, on the first and on the second body, as drawn
    elastic       elastic tension, a function of `stretch`
    damper        tension of the damper, a function of `rate`, with its sign
    free_length   length at which the stretch is 0; the distance as drawn unless given
    tension_only  true: it never pushes, and is slack below its free length
    """

    type: ClassVar[str] = "spring"
    bodies: tuple[str, str]
    points: tuple[point("m"), point("m")]
    elastic: Function("N", of=X) | None = None
    damper: Function("N", of=RATE) | None = None
    free_length: Annotated[float, Ge(0), Unit("m")] | None = None
    tension_only: Flag = False

    @property
    def goes_slack(self):
        """The channel that falls through a value where it goes slack, and the value."""
        return ("length", free_length(self)) if self.tension_only else None


class Own(Law):
    """Of one instance."""

    free_length: f8


def pack(name, spec, at):
    p, q = spec.points
    i, j = at.bodies(spec.bodies, p, q)
    law = packed_law(spec, at, at.entry(), turns=False, pulls=spec.tension_only)
    along = points(at, i, j, p, q) | law | {"axis": (0.0, 0.0, 0.0)}
    leaps = jump_at_zero(spec) if spec.tension_only else 0.0
    return Row(
        *Own.packed(spec, **along, free_length=free_length(spec)), travel="distance", leaps=leaps
    )


@kernel
def coordinate(t, scene, e):
    own = Own(scene, e)
    stretched(scene, e, own.coordinate, own.free_length)


@kernel
def force(t, scene, e):
    own = Own(scene, e)
    p_i, p_j, n, _, rate = line(scene, e)
    T, elastic = tension(t, scene, e)
    push_apart(scene.F, own.i, p_i, own.j, p_j, scaled(-T, n))
    scene.zd[DAMPERS] -= (T - elastic) * rate


@kernel
def energy(t, scene, e):
    store(scene, e)


@measured
def measure(t, scene, e, o):
    own = Own(scene, e)
    T, elastic = tension(t, scene, e)
    if own.pulls == 1:  # where it becomes slack rounding may leave less than nothing
        T = max(T, 0.0)
    scene.out[o], scene.out[o + 1] = T, elastic
    scene.out[o + 2] = scene.S[own.coordinate, 0] + own.free_length


ELEMENT = Element(
    key="spring",
    section="forces",
    spec=Spring,
    pack=pack,
    acts_at=at_both,
    reach=reach_always,
    channels=(
        Channel("force", "N", "tension"),
        Channel("elastic", "N", "elastic part of the force"),
        Channel("length", "m", "distance between the two points"),
    ),
    turning=between_points,
    picture="coil",
    loads={"force": "force"},
    kernels={"coordinate": coordinate, "force": force, "energy": energy, "measure": measure},
    example="""
bodies:
  jumper: {mass: 80 kg, inertia: 5 kg*m^2, at: [0, -1 m]}
forces:
  rope: {type: spring, bodies: [ground, jumper], points: [[0, 0], [0, -1 m]], free_length: 12 m,
         elastic: "150*stretch + 2*stretch**3", damper: "40*rate", tension_only: true}
gravity: [0, -9.81, 0]
solver: {end: 1 s}
""",
)
