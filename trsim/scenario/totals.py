"""The section `totals`: the total mass of several bodies, where one of them takes the rest."""

from typing import Annotated, ClassVar

from annotated_types import Gt, MinLen

from trsim.elements.inertia import Inertia
from trsim.fields import Spec, Unit, point


class Total(Spec):
    """Mass, centre and inertia of several bodies together.

    bodies     the bodies, including the remainder; all bodies unless given
    mass       total mass of these bodies
    at         common centre of mass of these bodies, as drawn; unless given, the remainder keeps
               its position
    inertia    total inertia of these bodies about this centre, along the axes of the drawing: one
               about z, three without products, or Ixx, Iyy, Izz, Ixy, Ixz, Iyz; unless given, the
               remainder keeps its own
    remainder  the body whose own numbers are replaced, so that the total is right
    """

    type: ClassVar[str] = "total"
    bodies: Annotated[tuple[str, ...], MinLen(2)] | None = None
    mass: Annotated[float, Gt(0), Unit("kg")]
    at: point("m") | None = None  # type: ignore[valid-type]
    inertia: Inertia | None = None
    remainder: str
