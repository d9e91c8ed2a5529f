"""The places of a profile that a ball too large for it touches at once, as parts of the profile.

The ball that touches the profile at p with the normal n, and q too, has the radius

    rho(p, n, q) = |q - p|^2 / (2 n . (q - p))

Where the least of them over q is below the ball's the ball never comes.  What is left are
stretches.  Each goes on a little further than the ball comes, since it is pressed in: to where rho
is KEEP of its radius, and along a straight side to the corner.  One that the ball touches in two
places is cut in its middle, a seam: what passes that touches both parts there.

Stretches that no ball of this size touches at once share one touch.
"""

from math import acos, atan2, cos, inf, sin
from typing import Any, NamedTuple

from trsim.laws.profiles import (
    LEVEL,
    NEXT,
    Edge,
    Flaw,
    Profile,
    blocks,
    fits_on_edges,
    length_of,
    numbers_of,
)
from trsim.laws.surfaces import HOLLOW, STRAIGHT

KEEP = 0.8  # of its radius: to the places that a ball touches when it is pressed in by a fifth
MOST = 8  # touches of one pair
CLOSE = 0.05  # of the radius of a ball: places that are looked at are so far apart
MANY = 50_000  # of them
WITHIN = 3.0  # radii: places further apart are touched by much larger balls only
CORNER = -2  # in place of an edge: a corner that turns to the free side
FAN = 0.05  # rad between the normals of an edge that are looked at
SHALLOW = 0.08  # rad: two touches whose normals differ by less are felt as one, twice
FEWEST = 20  # places of a stretch that is cut
DEEPEST = 4  # times it is cut


class Sample(NamedTuple):
    """A place of a profile, and a direction in which a ball lies that touches it there."""

    place: Any
    normal: Any
    piece: int  # whose it is
    part: float  # of its length
    edge: int  # or -1: of a piece


class Stretch(NamedTuple):
    """Part of a profile that a ball touches in one place at a time."""

    pieces: list[tuple[float, ...]]
    edges: list[Edge]  # its ends among them
    places: Any
    normals: Any
    sharp: float
    seams: list[Any]


class Touch(NamedTuple):
    """What one touch is of: as `Profile` has it, and its seams."""

    numbers: list[float]
    sharp: float
    reach: float
    seams: list[Any]


def touches(found: Profile, closed: bool, side: int, r: float) -> list[Touch]:
    """What a ball of radius r touches at once, one for each touch.  Raises Flaw."""
    import numpy as np

    if sum(map(length_of, found.pieces)) > MANY * CLOSE * r:
        what = f"a ball of radius {r:g} m is too small for all of this profile to be looked at"
        raise Flaw(what, "round its hollows by more than that, or make it several profiles")
    samples = along(found, closed, side, CLOSE * r)
    places, normals = (np.array([s[k] for s in samples]) for k in (0, 1))
    corner = np.array([s.edge == CORNER for s in samples])
    comes = (least_balls(places, normals, WITHIN * r) >= KEEP * r) & ~corner
    groups = [
        widened(group, samples, comes.tolist(), found, closed)
        for group in runs(comes.tolist(), corner.tolist(), closed)
    ]
    if not groups:
        raise Flaw(f"a ball of radius {r:g} m fits nowhere on this profile", "take a smaller one")
    stretches: list[Stretch] = []
    for group in groups:
        stretches += cut([samples[k] for k in group], found, side, r)
    ends = [(samples[group[0]].normal, samples[group[-1]].normal) for group in groups]
    apart = [
        acos(min(max(float(ends[k - 1][1] @ ends[k][0]), -1.0), 1.0))
        for k in range(0 if closed and not comes.all() else 1, len(ends))
    ]
    if min(apart, default=inf) < SHALLOW:
        raise nearly_one(found, r)
    return shared(stretches, r)


def nearly_one(found: Profile, r: float) -> Flaw:
    """What is said of two touches that merge."""
    what = f"a ball of radius {r:g} m touches this profile in two places that are nearly one"
    hint = "make its hollow clearly wider than the ball, or clearly narrower"
    if found.reach > 0.0:
        hint = f"smaller than {found.reach:.4g} m it touches one; or {hint}"
    return Flaw(what, hint)


# --- what a ball comes to ------------------------------------------------------------------


def least_balls(places: Any, normals: Any, within: float) -> Any:
    """Radius of the ball that touches a second place, of each place in the direction of its normal;
    of places that are further apart, half of that."""
    import numpy as np
    from scipy.spatial import cKDTree

    found = np.full(len(places), 0.5 * within)
    i, j = cKDTree(places).query_pairs(within, output_type="ndarray").T
    size = float(np.linalg.norm(np.ptp(places, axis=0)))
    for one, other in ((i, j), (j, i)):
        d = places[other] - places[one]
        far = np.sqrt(np.einsum("ij,ij->i", d, d))
        above = np.einsum("ij,ij->i", d, normals[one])
        seen = (above > LEVEL * far) & (far > NEXT * size)
        np.minimum.at(found, one[seen], far[seen] ** 2 / (2.0 * above[seen]))
    return found


def along(found: Profile, closed: bool, side: int, step: float) -> list[Sample]:
    """Places along a profile in their order; of an edge the fan of its normals."""
    import numpy as np

    after: dict[int, list[int]] = {}
    for e, edge in enumerate(found.edges):
        after.setdefault(edge.piece, []).append(e)
    last = len(found.pieces) - 1
    samples = [] if closed else fans(found, after.get(-1, []), 0, 0.0, side)
    for k, (places, normals) in enumerate(blocks(found.pieces, step)):
        n = len(places) - 1
        samples += [Sample(places[m], side * normals[m], k, m / n, -1) for m in range(n + 1)]
        samples += fans(found, after.get(k, []), min(k, last), 1.0, side)
        if k in found.inward:
            samples.append(Sample(places[n], np.zeros(2), k, 1.0, CORNER))
    return samples


def fans(found: Profile, edges: list[int], k: int, part: float, side: int) -> list[Sample]:
    """Edges with the normals they have, from that of the line that comes to that of the next; at
    an end up to the direction of the line."""
    import numpy as np

    samples = []
    for e in edges:
        place, before, after, _ = found.edges[e]
        turn = 0.5 * np.pi
        if before is not None and after is not None:
            turn = acos(min(max(float(before @ after), -1.0), 1.0))
        way = after if before is None else before
        start = atan2(side * way[0], -side * way[1])
        if before is None:
            start += side * turn
        many = max(int(turn / FAN), 2)
        for m in range(many + 1):
            a = start - side * turn * m / many
            samples.append(Sample(place, np.array([cos(a), sin(a)]), k, part, e))
    return samples


def runs(comes: list[bool], corner: list[bool], closed: bool) -> list[list[int]]:
    """The stretches of places that a ball comes to, in their order, each with one more place to
    either side, unless that is a corner; of a closed line one goes on past its beginning."""
    n = len(comes)
    if all(comes):
        return [[*range(n)]]
    start = next(k for k in range(n) if not comes[k]) if closed else 0
    found: list[list[int]] = []
    for m in range(1 if closed else 0, n):
        k = (start + m) % n
        before = (k - 1) % n if closed or k > 0 else -1
        if comes[k] and before >= 0 and comes[before]:
            found[-1].append(k)
        elif comes[k]:
            found.append([before, k] if before >= 0 and not corner[before] else [k])
        elif before >= 0 and comes[before] and not corner[k]:
            found[-1].append(k)
    if closed and comes[start - 1] and not corner[start]:
        found[-1].append(start)
    return [one for one in found if len(one) > 2]


def widened(
    group: list[int], samples: list[Sample], comes: list[bool], found: Profile, closed: bool
) -> list[int]:
    """A stretch with all of the straight sides that it ends on, up to corners that turn to the free
    side and to hollow arcs; not where another one begins before."""
    n = len(samples)
    for end, step in ((-1, 1), (0, -1)):
        last, more = samples[group[end]], list[int]()
        if last.edge != -1 or found.pieces[last.piece][0] != STRAIGHT:
            continue
        k = group[end] + step
        while closed or 0 <= k < n:
            one = samples[k % n]
            if one.edge != -1 or one.piece != last.piece or comes[k % n]:
                hollow = one.edge == -1 and found.pieces[one.piece][0] != STRAIGHT
                if comes[k % n] or not (one.edge == CORNER or hollow):
                    more = []
                break
            more.append(k % n)
            k += step
        group = group + more if step > 0 else more[::-1] + group
    return group


# --- stretches -----------------------------------------------------------------------------


def cut(own: list[Sample], found: Profile, side: int, r: float, times: int = 0) -> list[Stretch]:
    """The stretch of samples, or its halves where a ball touches it twice."""
    one = stretch(own, found, side)
    if reach_of([one], r) > r:
        return [one]
    middle = len(own) // 2
    while middle < len(own) and own[middle].edge >= 0:
        middle += 1
    if times == DEEPEST or not FEWEST < middle < len(own) - FEWEST:
        raise nearly_one(found, r)
    seam, halves = own[middle].place, (own[: middle + 1], own[middle:])
    parts = [part for half in halves for part in cut(half, found, side, r, times + 1)]
    return [
        part._replace(seams=[*part.seams, seam]) if ends_at(part, seam) else part for part in parts
    ]


def ends_at(one: Stretch, place: Any) -> bool:
    """Whether a stretch begins or ends at a place."""
    return any(bool((edge.place == place).all()) for edge in one.edges)


def stretch(own: list[Sample], found: Profile, side: int) -> Stretch:
    """The part of a profile along samples that follow each other."""
    import numpy as np

    pieces, first = [], 0
    for k in range(1, len(own) + 1):
        if k < len(own) and own[k].piece == own[first].piece and own[k].part >= own[first].part:
            continue
        a, b = own[first].part, own[k - 1].part
        if b > a:
            pieces.append(part_of(found.pieces[own[first].piece], a, b))
        first = k
    there = dict.fromkeys(s.edge for s in own if s.edge >= 0)
    edges = [found.edges[e] for e in there]
    for end, begins in ((own[0], True), (own[-1], False)):
        if end.edge < 0:
            way = side * np.array([end.normal[1], -end.normal[0]])
            edges.append(Edge(end.place, None, way) if begins else Edge(end.place, way, None))
    places, normals = np.array([s.place for s in own]), np.array([s.normal for s in own])
    return Stretch(pieces, edges, places, normals, 0.0, [])


def part_of(piece: tuple[float, ...], a: float, b: float) -> tuple[float, ...]:
    """The part of a piece from a to b of its length."""
    kind, x, y, u, v, w, d = piece
    if kind == STRAIGHT:
        return (kind, x + a * w * u, y + a * w * v, u, v, (b - a) * w, d)
    half, out = acos(d), -1.0 if kind == HOLLOW else 1.0
    middle = atan2(w, v) + out * half * (1.0 - a - b)
    return (kind, x, y, u, cos(middle), sin(middle), cos(half * (b - a)))


def reach_of(group: list[Stretch], r: float) -> float:
    """Of the largest ball that touches a group of stretches in one place only."""
    import numpy as np

    places = np.vstack([one.places for one in group])
    normals = np.vstack([one.normals for one in group])
    edges = [edge for one in group for edge in one.edges]
    least = float(least_balls(places, normals, WITHIN * r).min())
    return min(least, fits_on_edges(edges, places))


# --- touches -------------------------------------------------------------------------------


def shared(stretches: list[Stretch], r: float) -> list[Touch]:
    """The touches of stretches: each takes those that a ball touches one at a time."""
    groups: list[list[Stretch]] = []
    for one in stretches:
        for group in groups:
            near = [other for other in group if boxes(one, other) < 2.0 * r]
            if not near or reach_of([one, *near], r) > r:
                group.append(one)
                break
        else:
            groups.append([one])
    if len(groups) > MOST:
        what = f"a ball of radius {r:g} m may touch this profile in {len(groups)} places at once"
        raise Flaw(what, f"at most {MOST} can be told apart; make it several profiles")
    return [touch(group, r) for group in groups]


def boxes(one: Stretch, other: Stretch) -> float:
    """How far apart two stretches are at least, m."""
    import numpy as np

    a, b = (np.vstack([s.places, *(edge.place for edge in s.edges)]) for s in (one, other))
    gap = np.maximum(a.min(axis=0) - b.max(axis=0), b.min(axis=0) - a.max(axis=0))
    return float(np.linalg.norm(np.maximum(gap, 0.0)))


def touch(group: list[Stretch], r: float) -> Touch:
    """The numbers of stretches that share a touch."""
    reach = min(reach_of([one], r) for one in group)
    for k, one in enumerate(group):
        for other in group[:k]:
            near = boxes(one, other)
            reach = min(reach, reach_of([one, other], r) if near < 2.0 * r else 0.5 * near)
    pieces = [piece for one in group for piece in one.pieces]
    edges = distinct([edge for one in group for edge in one.edges])
    seams = [seam for one in group for seam in one.seams]
    return Touch(numbers_of(pieces, edges), 0.0, reach, seams)


def distinct(edges: list[Edge]) -> list[Edge]:
    """Each place once."""
    found: dict[tuple[float, float], Edge] = {}
    for edge in edges:
        found.setdefault((float(edge.place[0]), float(edge.place[1])), edge)
    return list(found.values())
