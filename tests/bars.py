"""What laws of cable elements take for a bar, without an element."""

from typing import NamedTuple


class Bar(NamedTuple):
    length: float  # of an element
    EA: float
    EI: float
    beta: float
    strain: int
    curvature: int
    stretching: int
