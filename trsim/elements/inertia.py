"""Inertia as it is written, and as a tensor.

one number       about z, of a planar scene: nothing is known of the other directions
three            principal ones, about x, y and z
six              Ixx, Iyy, Izz, Ixy, Ixz, Iyz; products with the sign of the tensor's entries
"""

from typing import Annotated, Any

from annotated_types import Ge

from trsim.fields import Unit

KG_M2 = Unit("kg*m^2")
MOMENT = Annotated[float, Ge(0), KG_M2]
PRODUCT = Annotated[float, KG_M2]
Inertia = (
    MOMENT
    | tuple[MOMENT, MOMENT, MOMENT]
    | tuple[MOMENT, MOMENT, MOMENT, PRODUCT, PRODUCT, PRODUCT]
)
ENTRIES = ((0, 0), (1, 1), (2, 2), (0, 1), (0, 2), (1, 2))
ROUNDED = 1e-14  # of the trace of a tensor


def tensor_of(inertia: Any) -> tuple[tuple[float, ...], bool]:
    """The 3 x 3 tensor, row by row, and whether it is known in all directions."""
    if isinstance(inertia, float):
        return (0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, inertia), False
    xx, yy, zz, xy, xz, yz = (*inertia, 0.0, 0.0, 0.0)[:6]
    return (xx, xy, xz, xy, yy, yz, xz, yz, zz), True


def written(matrix: Any) -> tuple[float, ...]:
    """A tensor (3, 3) as six numbers, without products that are rounding."""
    xx, yy, zz, *products = (float(matrix[a, b]) for a, b in ENTRIES)
    least = ROUNDED * (xx + yy + zz)
    return (xx, yy, zz, *(0.0 if abs(product) < least else product for product in products))
