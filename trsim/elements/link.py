"""Link: a massless rod with a ball joint at each end keeps two points at a constant distance.

    Phi = |d| - l = 0          d from the point on i to the point on j      [Nikravesh1988]

force is the axial force lambda, positive in tension.  reaction on body j is -force d/|d| at its
point.  A rod between two ball joints transmits no moment, so reaction_moment is zero.
"""

from math import sqrt
from typing import Annotated, ClassVar

from annotated_types import Gt

from trsim.elements.contract import Channel, Element, Row, kernel, measured
from trsim.elements.frames import TwoPoints, at_both, between_points, distance_row, points
from trsim.errors import ScenarioError
from trsim.fields import Spec, Unit, point
from trsim.kernels.columns import constraint_row, f8

LEAST = 1e-12  # of the distance of its ends from the origin: less is rounding and no direction


class Link(Spec):
    """A massless rod between a point of each body, with a ball joint at each end.

    bodies  the two bodies; reactions are those acting on the second one
    points  its ends, on the first and on the second body, as drawn
    length  length of the rod; as drawn unless given. If it differs, the bodies are moved at the
            start so that it fits
    """

    type: ClassVar[str] = "link"
    bodies: tuple[str, str]
    points: tuple[point("m"), point("m")]
    length: Annotated[float, Gt(0), Unit("m")] | None = None


class Own(TwoPoints):
    """Of one instance."""

    row: constraint_row
    length: f8


def pack(name, spec, at):
    p, q = spec.points
    i, j = at.bodies(spec.bodies, p, q)
    drawn = sqrt(sum((b - a) ** 2 for a, b in zip(p, q, strict=True)))
    if drawn <= LEAST * max(map(abs, (*p, *q))):
        hint = "draw them apart, or join the bodies by `spherical`"
        raise ScenarioError("its ends coincide as drawn: it has no direction", hint, ("points",))
    length = drawn if spec.length is None else spec.length
    return Row(*Own.packed(**points(at, i, j, p, q), length=length))


@kernel
def constraint(t, scene, e):
    own = Own(scene, e)
    k = own.row
    if k >= 0:
        distance_row(scene, e, k)
        scene.phi[k] -= own.length


@measured
def measure(t, scene, e, o):
    own = Own(scene, e)
    scene.out[o] = scene.lam[own.row] if own.row >= 0 else 0.0


ELEMENT = Element(
    key="link",
    section="joints",
    spec=Link,
    pack=pack,
    acts_at=at_both,
    rows=("length",),
    channels=(Channel("force", "N", "axial force of the rod, positive in tension"),),
    loads={"force": "force"},
    turning=between_points,
    holds_twist=False,
    picture="rod",
    kernels={"constraint": constraint, "measure": measure},
    example="""
bodies:
  bob: {mass: 2 kg, inertia: 0.01 kg*m^2, at: [0.5, 0]}
joints:
  rod: {type: link, bodies: [ground, bob], points: [[0, 0], [0.5, 0]]}
gravity: [0, -9.81, 0]
solver: {end: 1 s}
""",
)
