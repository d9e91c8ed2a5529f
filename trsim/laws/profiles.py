"""A profile as pieces of laws/surfaces.py: corners rounded, and how large a ball fits everywhere.

Where a line turns by the angle 2 a an arc of radius R takes the place of R tan a on both sides of
the corner.  It is round where the line turns away from the free side, hollow where it turns to it.

The ball through p and q that has the normal n of the line at p has the radius

    |q - p|^2 / (2 n . (q - p))

The least of them over all p and q is the largest ball that touches no second place.
"""

from math import acos, cos, inf, pi, tan
from typing import Any, NamedTuple

from trsim.laws.surfaces import EDGE, HOLLOW, ROUND, STRAIGHT

SAME = 1e-9  # of the size of a profile: places that are one
PLAIN = 1e-7  # rad: what turns by less goes straight on
BACK = 1e-6  # rad: what turns by so little less than half a turn turns back on itself
SAMPLES, LEAST = 1000, 8  # places along a profile, for its reach, and along each piece
NEXT = 1e-6  # of its size: where one piece ends and the next begins
LEVEL = 1e-6  # of a distance: what rises so little above the tangent is on it


class Flaw(ValueError):
    """What is wrong with a profile, what helps, and at which of its points."""

    def __init__(self, what: str, hint: str, point: int | None = None) -> None:
        super().__init__(what)
        self.what, self.hint, self.point = what, hint, point


class Profile(NamedTuple):
    """A profile as numbers for `tab`, and what bounds how its distance bends."""

    numbers: list[float]
    sharp: float  # m, least radius of what is round towards the free side: 0 of an edge
    reach: float  # m, of the largest ball that touches one place only
    outline: Any  # (n, 2) places along it, m


def profile(points: Any, radius: float, closed: bool, side: int) -> Profile:
    """The pieces of a line through points whose corners are rounded.

    points : (n, 2)      m
    radius               of its corners, m; 0: edges
    closed               whether it goes on from the last point to the first
    side                 1: the free side of an open one is on its left, of a closed one outside;
                         -1: on its right, or inside

    The pieces of a closed one go clockwise, so that outside is on their left.  Raises Flaw.
    """
    import numpy as np

    p = np.array(points, float)
    size = float(np.linalg.norm(np.ptp(p, axis=0))) if len(p) else 0.0
    if closed and len(p) > 1 and np.linalg.norm(p[-1] - p[0]) <= SAME * size:
        p = p[:-1]
    if len(p) < (3 if closed else 2):
        raise Flaw(f"{len(p)} points are no profile", "a closed one needs 3, an open one 2")
    order = np.arange(len(p))
    if closed:
        if meets_itself(p):
            raise Flaw("the profile crosses itself", "give its points in their order round it")
        if area(p) > 0.0:
            order = order[::-1]
    return put_together(p[order], order, radius, closed, side)


def area(p: Any) -> float:
    """Twice the area inside a closed line, positive where it goes anticlockwise."""
    import numpy as np

    q = np.roll(p, -1, axis=0)
    return float(np.sum(p[:, 0] * q[:, 1] - p[:, 1] * q[:, 0]))


def meets_itself(p: Any) -> bool:
    """Whether two sides of a closed line that are no neighbours cross or touch."""
    import numpy as np

    q, n, near = np.roll(p, -1, axis=0), len(p), SAME * float(np.linalg.norm(np.ptp(p, axis=0)))

    def left(u: Any, v: Any, w: Any) -> Any:
        return (v - u)[..., 0] * (w - u)[..., 1] - (v - u)[..., 1] * (w - u)[..., 0]

    def far(u: Any, v: Any, w: Any) -> Any:
        """Of the places w from the sides u to v."""
        d = v - u
        along = np.sum((w - u) * d, axis=-1) / np.sum(d * d, axis=-1)
        return np.linalg.norm(w - u - np.clip(along, 0.0, 1.0)[..., None] * d, axis=-1)

    for k in range(n):
        others = [m for m in range(n) if (m - k) % n not in (0, 1, n - 1)]
        if not others:
            continue
        a, b, c, d = p[k], q[k], p[others], q[others]
        cross = (left(a, b, c) * left(a, b, d) < 0.0) & (left(c, d, a) * left(c, d, b) < 0.0)
        if cross.any() or (far(a, b, c) <= near).any() or (far(c, d, a) <= near).any():
            return True
    return False


def put_together(p: Any, order: Any, radius: float, closed: bool, side: int) -> Profile:
    """The pieces of a line whose points are in the right order; `order`: which of those given."""
    import numpy as np

    n, size = len(p), float(np.linalg.norm(np.ptp(p, axis=0)))
    ahead = np.roll(p, -1, axis=0) - p if closed else np.diff(p, axis=0)
    lengths = np.linalg.norm(ahead, axis=1)
    if not lengths.min() > SAME * size:
        k = int(np.argmin(lengths))
        raise Flaw("two neighbours are one place", "leave one of them out", int(order[k]))
    way = ahead / lengths[:, None]
    cuts, arcs, edges, sharp = np.zeros(n), {}, [], inf
    for k in range(n) if closed else range(1, n - 1):
        cross = float(way[k - 1][0] * way[k][1] - way[k - 1][1] * way[k][0])
        angle = acos(min(max(float(way[k - 1] @ way[k]), -1.0), 1.0))
        if angle < PLAIN:
            continue
        if angle > pi - BACK:
            hint = "make it two profiles, or wider there"
            raise Flaw("the profile turns back on itself", hint, int(order[k]))
        round_outside = cross < 0.0
        if round_outside == (side > 0):
            sharp = min(sharp, radius)
        elif radius == 0.0:
            what = "the profile turns inwards there, and a ball would touch both of its sides"
            hint = "give `corner_radius`, more than the ball's, or a contact for each side"
            raise Flaw(what, hint, int(order[k]))
        if radius == 0.0:
            edges.append(p[k])
            continue
        cuts[k] = radius * tan(0.5 * angle)
        inwards = (way[k] - way[k - 1]) / np.linalg.norm(way[k] - way[k - 1])
        centre = p[k] + inwards * (radius / cos(0.5 * angle))
        arcs[k] = (ROUND if round_outside else HOLLOW, *centre, radius, *-inwards, cos(0.5 * angle))
    pieces: list[tuple[float, ...]] = []
    for k in range(len(way)):
        left = float(lengths[k] - cuts[k] - cuts[(k + 1) % n])
        if left < -SAME * size:
            what = f"no side is left between two corners rounded by {radius:g} m"
            raise Flaw(what, "take a smaller `corner_radius`", int(order[k]))
        if k in arcs:
            pieces.append(arcs[k])
        if left > SAME * size:
            pieces.append((STRAIGHT, *(p[k] + cuts[k] * way[k]), *way[k], left, 0.0))
    if not closed:
        edges += [p[0], p[-1]]
        sharp = 0.0
    places, normals = sampled(pieces)
    reach = fits(places, side * normals)
    pieces += [(EDGE, *place, 0.0, 0.0, 0.0, 0.0) for place in edges]
    numbers = [float(len(pieces)), *(float(c) for piece in pieces for c in piece)]
    return Profile(numbers, sharp, reach, places)


def sampled(pieces: list[tuple[float, ...]]) -> tuple[Any, Any]:
    """Places along the pieces, and the normals there that have the line on their right."""
    import numpy as np

    lengths = [one[5] if one[0] == STRAIGHT else 2.0 * one[3] * acos(one[6]) for one in pieces]
    places, normals = [], []
    for (kind, x, y, a, b, c, d), length in zip(pieces, lengths, strict=True):
        part = np.linspace(0.0, 1.0, max(int(SAMPLES * length / sum(lengths)), LEAST))
        if kind == STRAIGHT:
            places.append(np.array([x, y]) + part[:, None] * length * np.array([a, b]))
            normals.append(np.tile([-b, a], (len(part), 1)))
            continue
        out = 1.0 if kind == ROUND else -1.0
        turns = np.arctan2(c, b) + out * acos(d) * (1.0 - 2.0 * part)
        ray = np.column_stack([np.cos(turns), np.sin(turns)])
        places.append(np.array([x, y]) + a * ray)
        normals.append(out * ray)
    return np.vstack(places), np.vstack(normals)


def fits(places: Any, normals: Any) -> float:
    """Radius of the largest ball that touches a profile in one place only, wherever it does."""
    import numpy as np

    least, size = inf, float(np.linalg.norm(np.ptp(places, axis=0)))
    for place, normal in zip(places, normals, strict=True):
        d = places - place
        square = np.einsum("ij,ij->i", d, d)
        above = d @ normal
        seen = (above > LEVEL * np.sqrt(square)) & (square > (NEXT * size) ** 2)
        if seen.any():
            least = min(least, float((square[seen] / (2.0 * above[seen])).min()))
    return least
