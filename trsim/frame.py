"""Where a part of a scenario is drawn: an origin and three axes, seen from the world.

p_world = at + x p_x + y p_y + z p_z          points
v_world =      x v_x + y v_y + z v_z          directions, velocities: free vectors
"""

from math import atan2, sqrt
from typing import Any, NamedTuple

Vector = tuple[float, float, float]

FLAT = 1e-12  # 1 minus the cosine of a tilt that is none


def across(a: Any, b: Any) -> Vector:
    """a x b of numbers; `cross` of elements/frames.py is for compiled code, and slow to call."""
    return (
        a[1] * b[2] - a[2] * b[1],
        a[2] * b[0] - a[0] * b[2],
        a[0] * b[1] - a[1] * b[0],
    )


class Frame(NamedTuple):
    """An origin and orthonormal right-handed axes, all in world axes.

    at  the origin, m
    x   unit vectors
    y   across x
    z   x cross y
    """

    at: Vector
    x: Vector
    y: Vector
    z: Vector

    def turned(self, v: Vector) -> Vector:
        """A free vector of the frame, in world axes."""
        return tuple(  # type: ignore[return-value]
            self.x[c] * v[0] + self.y[c] * v[1] + self.z[c] * v[2] for c in range(3)
        )

    def moved(self, v: Vector) -> Vector:
        """A point of the frame, in world axes."""
        x, y, z = self.turned(v)
        return (self.at[0] + x, self.at[1] + y, self.at[2] + z)

    def inside(self, v: Vector) -> Vector:
        """A free vector in world axes, in those of the frame."""
        return tuple(  # type: ignore[return-value]
            axis[0] * v[0] + axis[1] * v[1] + axis[2] * v[2] for axis in (self.x, self.y, self.z)
        )

    @property
    def flat(self) -> bool:
        """Whether it is turned about the world's z axis only."""
        return self.z[2] > 1.0 - FLAT

    @property
    def about_z(self) -> float:
        """The angle of a flat frame, rad."""
        return atan2(self.x[1], self.x[0])

    @property
    def quaternion(self) -> tuple[float, float, float, float]:
        """The quaternion of its axes, the scalar first, from its largest component."""
        (xx, yx, zx), (xy, yy, zy), (xz, yz, zz) = self.x, self.y, self.z
        squares = (1 + xx + yy + zz, 1 + xx - yy - zz, 1 - xx + yy - zz, 1 - xx - yy + zz)
        rows = (  # 4 q_k (q_0, q_1, q_2, q_3)
            (squares[0], zy - yz, xz - zx, yx - xy),
            (zy - yz, squares[1], xy + yx, xz + zx),
            (xz - zx, xy + yx, squares[2], yz + zy),
            (yx - xy, xz + zx, yz + zy, squares[3]),
        )
        row = rows[max(range(4), key=lambda k: squares[k])]
        size = sqrt(sum(c * c for c in row))
        return (row[0] / size, row[1] / size, row[2] / size, row[3] / size)
