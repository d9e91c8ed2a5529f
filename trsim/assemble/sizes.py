"""How large a mechanism is as drawn."""

from __future__ import annotations

from collections.abc import Iterable
from math import sqrt
from typing import NamedTuple

from trsim.assemble.dense import turned
from trsim.assemble.places import Places
from trsim.errors import ModelError

Point = tuple[float, float, float]

LARGEST = 1e12  # m, distances of a mechanism


class Sizes(NamedTuple):
    """Those of the centres of mass of its bodies and of the points fixed to them."""

    whole: float  # m, the diagonal of the box around all of them; 1 where they coincide
    apart: float  # m, that of the box around those that move; 0 without any
    arms: list[float]  # (n) m, largest of every frame; 0: nothing is fixed away from its centre

    @classmethod
    def of(cls, at: Places) -> Sizes:
        """Raises ModelError for places that are too far away to be solved for."""
        fixed = [(i, in_world(at, i, s)) for i, s in at.points]
        moved = at.centres[1:]
        # the origin is none of its points, unless something is joined to the ground there
        corners = [*(moved or at.centres[:1]), *(place for _, place in fixed)]
        check_far(at, corners)
        arms = [0.0] * len(at.frames)
        for i, s in at.points:
            arms[i] = max(arms[i], length(s))
        for beam in at.beams.values():
            arms[beam.first : beam.first + beam.nodes] = [beam.whole] * beam.nodes
        moving = [*moved, *(place for i, place in fixed if i > 0)]
        return cls(diagonal(corners) or 1.0, diagonal(moving), arms)

    def levers(self, alone: float) -> list[float]:
        """Largest arm of every frame; `alone` where nothing is fixed away from its centre, m."""
        return [a if a > 0.0 else alone for a in self.arms]


def in_world(at: Places, i: int, s: Iterable[float]) -> Point:
    """A point of a frame in world axes, as drawn."""
    (a, b, c), (x, y, z) = at.centres[i], turned(at.turns[i], tuple(s))
    return a + x, b + y, c + z


def check_far(at: Places, corners: list[Point]) -> None:
    """Refuse the farthest of the corners of `Sizes.of` if it is beyond LARGEST."""
    far = [max(map(abs, corner)) for corner in corners]
    worst = far.index(max(far))
    if far[worst] > LARGEST:
        frames = [*range(1, len(at.frames)), *(i for i, _ in at.points)]
        name = at.owners[frames[worst]]
        raise ModelError(
            f"a point of '{name}' lies {far[worst]:.3g} m from the origin",
            f"a mechanism of at most {LARGEST:g} m can be solved; check the units",
            ("bodies", name) if name in at.scenario.bodies else ("joints",),
        )


def diagonal(corners: list[Point]) -> float:
    """That of the box around some points; 0 around none."""
    if not corners:
        return 0.0
    xs, ys, zs = zip(*corners, strict=True)
    return length((max(xs) - min(xs), max(ys) - min(ys), max(zs) - min(zs)))


def length(v: Iterable[float]) -> float:
    """The length of a vector in space."""
    x, y, z = v
    return sqrt(x * x + y * y + z * z)
