"""Ropes: where their straight parts touch wheels, and what they lie along of these.

Part k goes from place a to place b, whose centres are D apart, along e, with n to the left of e:

    n . D = rho = s_b r_b - s_a r_a        l = e . D = (D . D - rho^2)^(1/2)

It begins at C_a - s_a r_a n and ends at C_b - s_b r_b n.
"""

from collections.abc import Sequence
from typing import NamedTuple

import numpy as np

from trsim import elements
from trsim.report.animation.drawing import Array, Drawing, Place, Rope

STRAND = "strand"  # picture
Z = np.array([0.0, 0.0, 1.0])


def ropes(drawn: Drawing) -> tuple[Rope, ...]:
    """The ropes whose bodies are all drawn."""
    found = []
    for name, spec in drawn.scenario.joints.items():
        if elements.load(spec.type).picture != STRAND:
            continue
        if all(drawn.has(place.body) for place in spec.through):
            places = tuple(Place(p.body, np.array(p.at), p.bend) for p in spec.through)
            found.append(Rope(name, places))
    return tuple(found)


class Part(NamedTuple):
    """A straight part over the frames."""

    begin: Array  # (n, 3) m
    end: Array  # (n, 3) m
    angle: Array  # (n) rad, of its direction in the x-y plane, unwrapped


def parts(bends: Sequence[float], centres: Sequence[Array]) -> list[Part]:
    """The straight parts between places; centres: (n, 3) of each."""
    found = []
    for k in range(len(bends) - 1):
        first, second = bends[k], bends[k + 1]
        d, rho = centres[k + 1] - centres[k], second - first
        square = np.sum(d**2, axis=1)
        length = np.sqrt(np.maximum(square - rho**2, 0.0))
        if rho == 0.0 and first == 0.0:
            e, n = d, np.zeros_like(d)
        else:
            across = np.cross(Z, d)
            e = (length[:, None] * d - rho * across) / square[:, None]
            n = np.cross(Z, e)
        angle = np.unwrap(np.arctan2(e[:, 1], e[:, 0]))
        found.append(Part(centres[k] - first * n, centres[k + 1] - second * n, angle))
    return found


def wraps(bends: Sequence[float], found: Sequence[Part]) -> list[Array]:
    """What the rope lies along of each place between the ends, (n) rad; of eyes nothing.

    Between nothing and a turn at the first frame, and from there without a jump.
    """
    angles = []
    for k in range(1, len(bends) - 1):
        if bends[k] == 0.0:
            angles.append(np.zeros(len(found[k].angle)))
            continue
        wrap = np.sign(bends[k]) * (found[k].angle - found[k - 1].angle)
        angles.append(wrap - 2.0 * np.pi * np.floor(wrap[0] / (2.0 * np.pi)))
    return angles
