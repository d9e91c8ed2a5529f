"""The section `totals`: what several bodies weigh together, where one of them takes the rest."""

from typing import Annotated, ClassVar

from annotated_types import Gt, MinLen

from trsim.elements.inertia import Inertia
from trsim.fields import Spec, Unit, point


class Total(Spec):
    """Mass, centre and inertia of several bodies together.

    bodies     which they are, the remainder among them; all unless given
    mass       of all of them
    at         their common centre of mass, as drawn; the remainder stays where it is unless given
    inertia    of all of them about that centre, along the axes in which the scenario is drawn:
               one about z, three without products or Ixx, Iyy, Izz, Ixy, Ixz, Iyz; the remainder
               keeps its own unless given
    remainder  the body whose own numbers are replaced, so that the total is as it says
    """

    type: ClassVar[str] = "total"
    bodies: Annotated[tuple[str, ...], MinLen(2)] | None = None
    mass: Annotated[float, Gt(0), Unit("kg")]
    at: point("m") | None = None  # type: ignore[valid-type]
    inertia: Inertia | None = None
    remainder: str
