"""A profile as pieces of laws/surfaces.py: corners rounded, and how large a ball fits everywhere.

Where a line turns by the angle 2 a an arc of radius R takes the place of R tan a on both sides of
the corner.  It is round where the line turns away from the free side, hollow where it turns to it.
"""

from math import acos, ceil, cos, inf, log2, pi, tan
from typing import Any, NamedTuple

from trsim.laws.fitting import LEVEL, NEXT, fits
from trsim.laws.surfaces import EDGE, HEAD, HOLLOW, ROUND, STRAIGHT

SAME = 1e-9  # of the size of a profile: places that are one
PLAIN = 1e-7  # rad: what turns by less goes straight on
BACK = 1e-6  # rad: what turns by so little less than half a turn turns back on itself
SAMPLES, LEAST = 1000, 8  # places along a profile, for its reach, and along each piece
SURE = 0.8  # of the ball that fits as those places tell: such a one fits indeed
FEW = 16  # pieces: they are looked at one by one
EACH = 4  # of more: pieces of a leaf, at most
MOST = 20_000  # pieces of a spline
STILL = 1e-9  # of the rate along a spline by its chords: it stands still there
FLAT = 1e-7  # rad: an arc that turns by less is straight


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
    pieces: list[tuple[float, ...]]  # in their order, without edges
    edges: list["Edge"]  # of an open one its beginning and its end are the last two
    inward: tuple[int, ...] = ()  # pieces behind which it turns to the free side without an arc


class Edge(NamedTuple):
    """A place where two pieces meet at an angle, or where an open profile ends."""

    place: Any
    before: Any  # the direction in which the line comes there; None where it begins
    after: Any  # and goes on; None where it ends
    piece: int = -1  # the one in front of it


def profile(points: Any, radius: float, closed: bool, side: int, inward: bool = False) -> Profile:
    """The pieces of a line through points whose corners are rounded.

    points : (n, 2)      m
    radius               of its corners, m; 0: edges
    closed               whether it goes on from the last point to the first
    side                 1: the free side of an open one is on its left, of a closed one outside;
                         -1: on its right, or inside
    inward               whether it may turn to the free side without an arc: its reach is then 0

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
    return put_together(p[order], order, radius, closed, side, inward)


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

    low, high = np.minimum(p, q) - near, np.maximum(p, q) + near
    for k in range(n - 2):  # each pair once; the last side is a neighbour of the first
        those = slice(k + 2, n if k else n - 1)
        beside = np.all((low[those] <= high[k]) & (high[those] >= low[k]), axis=1)
        others = k + 2 + np.flatnonzero(beside)  # far from the rest: their boxes are apart
        if not len(others):
            continue
        a, b, c, d = p[k], q[k], p[others], q[others]
        cross = (left(a, b, c) * left(a, b, d) < 0.0) & (left(c, d, a) * left(c, d, b) < 0.0)
        if cross.any() or (far(a, b, c) <= near).any() or (far(c, d, a) <= near).any():
            return True
    return False


def put_together(
    p: Any, order: Any, radius: float, closed: bool, side: int, inward: bool
) -> Profile:
    """The pieces of a line whose points are in the right order; `order`: which of those given."""
    import numpy as np

    n, size = len(p), float(np.linalg.norm(np.ptp(p, axis=0)))
    ahead = np.roll(p, -1, axis=0) - p if closed else np.diff(p, axis=0)
    lengths = np.linalg.norm(ahead, axis=1)
    if not lengths.min() > SAME * size:
        k = int(np.argmin(lengths))
        raise Flaw("two neighbours are one place", "leave one of them out", int(order[k]))
    way = ahead / lengths[:, None]
    cuts, arcs, edges, sharp, inner = np.zeros(n), {}, [], inf, []
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
        elif radius == 0.0 and inward:
            inner.append((k or n) - 1)
            continue
        elif radius == 0.0:
            what = "the profile turns inwards there, and a ball would touch both of its sides"
            hint = "give `corner_radius`, more than the ball's, or a contact for each side"
            raise Flaw(what, hint, int(order[k]))
        if radius == 0.0:
            edges.append(Edge(p[k], way[k - 1], way[k], (k or n) - 1))  # no arcs: a piece a side
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
        edges += [Edge(p[0], None, way[0]), Edge(p[-1], way[-1], None, len(pieces) - 1)]
        sharp = 0.0
    return finished(pieces, edges, sharp, side, tuple(inner))


def finished(
    pieces: list[tuple[float, ...]],
    edges: list[Edge],
    sharp: float,
    side: int,
    inward: tuple[int, ...] = (),
) -> Profile:
    """The profile of pieces one behind the other, and of places where they meet at an angle."""
    places, normals = sampled(pieces)
    if inward:
        reach = 0.0
    elif not edges and all(
        piece[0] in (STRAIGHT, ROUND if side > 0 else HOLLOW) for piece in pieces
    ):
        reach = inf  # outside of what is convex
    else:
        reach = min(fits(places, side * normals), fits_on_edges(edges, places))
    numbers = numbers_of(pieces, edges, side * SURE * reach)
    return Profile(numbers, sharp, reach, places, pieces, edges, inward)


def numbers_of(
    pieces: list[tuple[float, ...]], edges: list[Edge], sure: float = 0.0
) -> list[float]:
    """The numbers of laws/surfaces.py of pieces and edges; sure: of a ball that fits."""
    lone = [(EDGE, *map(float, edge.place), 0.0, 0.0, 0.0, 0.0) for edge in edges]
    every, depth = [*pieces, *lone], 0
    if len(every) > FEW:
        every, depth = in_their_places(pieces, lone), ceil(log2(len(every) / EACH))
    nodes = tree(every, depth)
    numbers = [float(c) for piece in every for c in piece]
    return [float(len(every)), float(depth), float(HEAD + len(nodes)), sure, *nodes, *numbers]


def in_their_places(
    pieces: list[tuple[float, ...]], lone: list[tuple[float, ...]]
) -> list[tuple[float, ...]]:
    """Pieces in their order, each edge behind the nearest of them, so that leaves are small."""
    import numpy as np

    places = corners_of(pieces)
    behind: list[list[tuple[float, ...]]] = [[] for _ in pieces]
    for one in lone:
        off = np.linalg.norm(places - np.array(one[1:3]), axis=2).min(axis=1)
        behind[int(np.argmin(off))].append(one)
    return [one for k, piece in enumerate(pieces) for one in (piece, *behind[k])]


def tree(pieces: list[tuple[float, ...]], depth: int) -> list[float]:
    """The numbers of the nodes of a tree that has the pieces in its leaves.

    The axis of a node is the tangent where its second child begins: points on its two sides are
    beside pieces on the two sides.  Boxes are NEXT of their size larger than they must be.
    """
    import numpy as np

    corners, many, nodes = corners_of(pieces), len(pieces), list[Any]()
    starts, ways = (np.array(c) for c in zip(*map(beginning, pieces), strict=True))
    for level in range(depth + 1):
        first = (np.arange(1 << level) * many) >> level
        second = (np.arange(1, 2 << level, 2) * many) >> level + 1
        axis, split = ways[second], np.sum(ways[second] * starts[second], axis=1)
        u, v = np.repeat(axis, np.diff(first, append=many), axis=0).T[:, :, None]
        x, y = corners[:, :, 0], corners[:, :, 1]
        box = []
        for places in (u * x + v * y, u * y - v * x):
            box.append(np.minimum.reduceat(places.min(axis=1), first))
            box.append(np.maximum.reduceat(places.max(axis=1), first))
        more = NEXT * (box[1] - box[0] + box[3] - box[2])
        bounds = (
            side + sign * more for side, sign in zip(box, (-1.0, 1.0, -1.0, 1.0), strict=True)
        )
        nodes.append(np.column_stack([axis, split, *bounds]))
    return [float(c) for c in np.vstack(nodes).ravel()]


def corners_of(pieces: list[tuple[float, ...]]) -> Any:
    """(n, 4, 2) places that each of the pieces lies between."""
    import numpy as np

    ends = [ends_of(piece) for piece in pieces]
    return np.array([[*of, *of[-1:] * (4 - len(of))] for of in ends])


def ends_of(piece: tuple[float, ...]) -> list[Any]:
    """Places that a piece lies between: its ends, of an arc the corners of a box around it."""
    import numpy as np

    kind, x, y, a, b, c, d = piece
    at = np.array([x, y])
    if kind == EDGE:
        return [at]
    if kind == STRAIGHT:
        return [at, at + c * np.array([a, b])]
    ray, across = np.array([b, c]), np.array([-c, b])
    aside = np.sqrt(max(1.0 - d * d, 0.0)) if d > 0.0 else 1.0
    return [at + a * (u * ray + v * aside * across) for u in (d, 1.0) for v in (-1.0, 1.0)]


def fits_on_edges(edges: list[Edge], places: Any) -> float:
    """The same of balls that touch an edge, whose normals are a fan: half the way to what lies in
    it."""
    import numpy as np

    least, all_places = inf, np.vstack([places, *(edge.place for edge in edges)])
    size = float(np.linalg.norm(np.ptp(all_places, axis=0)))
    for place, before, after, _ in edges:
        d = all_places - place
        far = np.linalg.norm(d, axis=1)
        seen = far > NEXT * size
        if after is not None:
            seen &= d @ after <= LEVEL * far
        if before is not None:
            seen &= d @ before >= -LEVEL * far
        if seen.any():
            least = min(least, 0.5 * float(far[seen].min()))
    return least


def smooth(points: Any, closed: bool, side: int, tolerance: float) -> Profile:
    """The pieces of a cubic spline through points, natural at the ends of an open one: pairs of
    arcs that have its places and tangents at their ends and are nowhere further away from it than
    the tolerance, of its size.  Its parameter is the length of the chords.  Raises Flaw.
    """
    import numpy as np
    from scipy.interpolate import CubicSpline

    p = np.array(points, float)
    size = float(np.linalg.norm(np.ptp(p, axis=0))) if len(p) else 0.0
    if closed and len(p) > 1 and np.linalg.norm(p[-1] - p[0]) <= SAME * size:
        p = p[:-1]
    if len(p) < 3:
        raise Flaw(f"{len(p)} points are no smooth profile", "it needs 3")
    if closed and area(p) > 0.0:
        p = p[::-1]
    line = np.vstack([p, p[:1]]) if closed else p
    chords = np.linalg.norm(np.diff(line, axis=0), axis=1)
    if not chords.min() > SAME * size:
        raise Flaw("two neighbours are one place", "leave one of them out")
    nodes = np.append(0.0, np.cumsum(chords))
    spline = CubicSpline(nodes, line, bc_type="periodic" if closed else "natural")
    pieces: list[tuple[float, ...]] = []
    waiting = [(float(a), float(b)) for a, b in zip(nodes[-2::-1], nodes[:0:-1], strict=True)]
    while waiting:
        a, b = waiting.pop()
        pair = two_arcs(*(spline(u, k) for u in (a, b) for k in (0, 1)))
        inner = spline(np.linspace(a, b, 9)[1:-1])
        if off_pieces(pair, inner) <= tolerance * size:
            pieces += pair
            continue
        if len(pieces) + len(waiting) > MOST or b - a < NEXT * nodes[-1]:
            place = spline(a)
            what = f"turns too sharply at [{place[0]:.6g}, {place[1]:.6g}]"
            raise Flaw(what, "smooth the points, or give straight sides and `corner_radius`")
        waiting += [(0.5 * (a + b), b), (a, 0.5 * (a + b))]
    if closed and meets_itself(np.array([piece[1:3] for piece in pieces_as_lines(pieces)])):
        raise Flaw("the profile crosses itself", "give its points in their order round it")
    rounds = [one[3] for one in pieces if one[0] == (ROUND if side > 0 else HOLLOW)]
    ends = [spline(u, 1) / np.linalg.norm(spline(u, 1)) for u in (nodes[0], nodes[-1])]
    last = len(pieces) - 1
    edges = [] if closed else [Edge(p[0], None, ends[0]), Edge(p[-1], ends[1], None, last)]
    return finished(pieces, edges, min(rounds, default=inf) if closed else 0.0, side)


def pieces_as_lines(pieces: list[tuple[float, ...]]) -> list[tuple[float, ...]]:
    """A straight piece for each, between where it begins and where the next one does."""
    starts = [start_of(piece) for piece in pieces]
    return [(STRAIGHT, float(start[0]), float(start[1])) for start in starts]


def start_of(piece: tuple[float, ...]) -> Any:
    """Where a piece begins."""
    return beginning(piece)[0]


def beginning(piece: tuple[float, ...]) -> tuple[Any, Any]:
    """Where a piece begins, and in which direction it goes on; that of an edge is x."""
    import numpy as np

    kind, x, y, a, b, c, d = piece
    at = np.array([x, y])
    if kind == STRAIGHT:
        return at, np.array([a, b])
    if kind == EDGE:
        return at, np.array([1.0, 0.0])
    out = 1.0 if kind == ROUND else -1.0
    angle = np.arctan2(c, b) + out * acos(d)
    ray = np.array([np.cos(angle), np.sin(angle)])
    return at + a * ray, out * np.array([ray[1], -ray[0]])


def two_arcs(p: Any, d: Any, q: Any, e: Any) -> list[tuple[float, ...]]:
    """Two arcs, one behind the other, from p with the tangent d to q with the tangent e.

    With unit tangents their common end is (p + k d + q - k e) / 2, where both arcs have tangents
    of the length k:  2 k^2 (1 - d.e) + 2 k v.(d + e) - v.v = 0,  v = q - p      [Bolton1975]
    """
    import numpy as np

    speeds = float(np.linalg.norm(d)), float(np.linalg.norm(e))
    if not min(speeds) > STILL:
        raise Flaw("the profile turns back on itself", "its points are in one line, there and back")
    d, e, v = d / speeds[0], e / speeds[1], q - p
    a, b, c = 2.0 * (1.0 - float(d @ e)), float(v @ (d + e)), float(v @ v)
    below = b + np.sqrt(b * b + a * c)
    if not below > STILL * np.sqrt(c):
        raise Flaw("the profile turns back on itself", "its points are in one line, there and back")
    k = c / below  # the positive root of a k^2 + 2 b k - c = 0
    middle = 0.5 * (p + k * d + q - k * e)
    ray = middle - p
    if not float(ray @ ray) > 0.0:
        raise Flaw("the profile turns back on itself", "its points are in one line, there and back")
    tangent = 2.0 * ray * float(ray @ d) / float(ray @ ray) - d
    return [arc(p, d, middle), arc(middle, tangent / np.linalg.norm(tangent), q)]


def arc(p: Any, d: Any, q: Any) -> tuple[float, ...]:
    """The piece from p with the unit tangent d to q."""
    import numpy as np

    v, left = q - p, np.array([-d[1], d[0]])
    square = float(v @ v)
    if not square > 0.0:
        raise Flaw("the profile turns back on itself", "its points are in one line, there and back")
    bend = 2.0 * float(left @ v) / square  # 1/R, positive where it turns left
    if abs(bend) * np.sqrt(square) < FLAT:
        along = v / np.sqrt(square)
        return (STRAIGHT, *p, *along, float(np.sqrt(square)), 0.0)
    R = 1.0 / abs(bend)
    centre = p + left / bend
    out = (p - centre) / R + (q - centre) / R
    out /= np.linalg.norm(out)
    half = np.sqrt(square) / (2.0 * R)
    return (ROUND if bend < 0.0 else HOLLOW, *centre, R, *out, float(np.sqrt(1.0 - half * half)))


def off_pieces(pieces: list[tuple[float, ...]], places: Any) -> float:
    """How far places are from the nearest of some pieces, the largest."""
    import numpy as np

    away = []
    for kind, x, y, a, b, *_ in pieces:
        v = places - np.array([x, y])
        if kind == STRAIGHT:
            away.append(np.abs(a * v[:, 1] - b * v[:, 0]))
        else:
            away.append(np.abs(np.linalg.norm(v, axis=1) - a))
    return float(np.min(away, axis=0).max())


def sampled(pieces: list[tuple[float, ...]]) -> tuple[Any, Any]:
    """Places along the pieces, and the normals there that have the line on their right."""
    import numpy as np

    places, normals = zip(*blocks(pieces), strict=True)
    return np.vstack(places), np.vstack(normals)


def blocks(pieces: list[tuple[float, ...]], step: float = 0.0) -> list[tuple[Any, Any]]:
    """The same of each piece, from its beginning to its end; step: how far apart, m."""
    import numpy as np

    lengths, found = [length_of(piece) for piece in pieces], []
    whole = sum(lengths)
    for (kind, x, y, a, b, c, d), length in zip(pieces, lengths, strict=True):
        many = length / step if step else SAMPLES * length / whole
        part = np.linspace(0.0, 1.0, max(int(many), LEAST))
        if kind == STRAIGHT:
            places = np.array([x, y]) + part[:, None] * length * np.array([a, b])
            found.append((places, np.tile([-b, a], (len(part), 1))))
            continue
        out = 1.0 if kind == ROUND else -1.0
        turns = np.arctan2(c, b) + out * acos(d) * (1.0 - 2.0 * part)
        ray = np.column_stack([np.cos(turns), np.sin(turns)])
        found.append((np.array([x, y]) + a * ray, out * ray))
    return found


def length_of(piece: tuple[float, ...]) -> float:
    """How long a piece is, m."""
    return piece[5] if piece[0] == STRAIGHT else 2.0 * piece[3] * acos(piece[6])
