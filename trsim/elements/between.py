"""What acts along the line between two points shares: its length as drawn, and where it leads."""

from math import sqrt

from trsim.elements.contract import Reach
from trsim.elements.frames import TwoPoints, line
from trsim.kernels.lazy import internal


def drawn_length(spec):
    """The distance of the points of a spec."""
    p, q = spec.points
    return sqrt(sum((b - a) ** 2 for a, b in zip(p, q, strict=True)))


def free_length(spec):
    """The length at which nothing is stretched: the one as drawn unless given."""
    return drawn_length(spec) if spec.free_length is None else spec.free_length


@internal
def stretched(scene, e, s, free):
    """How much longer the line is than `free`, and its rate, as entry s of S."""
    _, _, _, length, rate = line(scene, e)
    scene.S[s, 0], scene.S[s, 1] = length - free, rate


def reach(row):
    """A force along its line, that acts on both bodies at the first point."""
    own = TwoPoints.of(row)
    along, place = (own.i, own.p_i, own.j, own.p_j), (own.i, own.p_i, (own.i, own.j))
    return Reach(lines=(along,), places=(place,))


def reach_always(row):
    """The same of what acts at any time and place."""
    return reach(row)._replace(always=True)
