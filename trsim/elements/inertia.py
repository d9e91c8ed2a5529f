"""Inertia: how the tensor of a body, or of a part of one, is given."""

from typing import Annotated

from annotated_types import Ge

from trsim.fields import Unit

KG_M2 = Unit("kg*m^2")
MOMENT = Annotated[float, Ge(0), KG_M2]
PRODUCT = Annotated[float, KG_M2]
# one about z; three principal ones; or Ixx, Iyy, Izz, Ixy, Ixz, Iyz
Inertia = (
    MOMENT
    | tuple[MOMENT, MOMENT, MOMENT]
    | tuple[MOMENT, MOMENT, MOMENT, PRODUCT, PRODUCT, PRODUCT]
)


def tensor_of(inertia):
    """The 3 x 3 inertia tensor, row by row, and whether it is known in all directions."""
    if isinstance(inertia, float):
        return (0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, inertia), False
    xx, yy, zz, xy, xz, yz = (*inertia, 0.0, 0.0, 0.0)[:6]
    return (xx, xy, xz, xy, yy, yz, xz, yz, zz), True
