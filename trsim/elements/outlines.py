"""An outline that touches a surface: straight sides between corners, with a round edge all along.

On a plane each corner touches for itself, as a ball.  What is round outside meets the outline in
one place, on a side or at a corner; laws/outlines.py finds it.
"""

from math import atan2, hypot

from trsim.elements.surface import FINE, pieces_of, shapes_of
from trsim.errors import ScenarioError
from trsim.laws.profiles import length_of
from trsim.laws.surfaces import HOLLOW, STRAIGHT

MOST = 8  # corners
UNSEEN = 1e-3  # of the size of a profile: how long a straight piece of it may be
FLAT = 1e-9  # of the square of its size: three corners in one line


def outlined(spec, at, j):
    """The columns of each touch of an outline of frame j; as `shapes_of` has them."""
    surface, ball = spec.surface, spec.ball
    check(ball, at, j)
    frame = surface.frame
    places = [
        tuple(p + x * u + y * w for p, u, w in zip(ball.at, frame.x, frame.y, strict=True))
        for x, y in ball.corners
    ]
    corners = [at.local(j, place) for place in places]
    if surface.shape == "plane":
        (plane,), _ = shapes_of(spec, at, (0.0, 0.0, 0.0))
        return [{**plane, "p_j": corner} for corner in corners]
    wide, bulge = roundness(surface)
    (shaped,), _ = shapes_of(spec, at, (0.0, 0.0, 0.0))
    middle = at.local(j, ball.at)
    offset = len(at.tab)
    at.tab.append(float(len(corners)))
    at.tab.extend(c - m for corner in corners for c, m in zip(corner, middle, strict=True))
    span = max(hypot(x, y) for x, y in ball.corners)
    return [{**shaped, "outline": offset, "span": span, "wide": wide, "bulge": bulge}]


def check(ball, at, j):
    """Refuse outlines that are none, or that could touch in two places of what is round."""
    corners, path = ball.corners, ("ball", "corners")
    if ball.radius == 0.0:
        what = "the edge of an outline is round"
        raise ScenarioError(what, "give `radius`, a small one of a sharp edge", ("ball", "radius"))
    if not 2 <= len(corners) <= MOST:
        what = f"an outline of {len(corners)} corners"
        raise ScenarioError(what, f"two (a straight face) to {MOST}", path)
    if at.is_node(j):
        what = f"'{ball.body}' is a flexible bar, which has no outline that stays as it is"
        raise ScenarioError(what, "take a `ball` at a node of it", ("ball", "body"))
    n = len(corners)
    sides = [(corners[k - 1], corners[k]) for k in range(n)]
    ways = [(b[0] - a[0], b[1] - a[1]) for a, b in sides]
    size = max(hypot(*way) for way in ways)
    if min(hypot(*way) for way in ways) <= FLAT * size:
        raise ScenarioError("two corners are one place", "leave one of them out", path)
    turns = [
        ways[k - 1][0] * ways[k][1] - ways[k - 1][1] * ways[k][0] for k in range(n if n > 2 else 0)
    ]
    square = FLAT * size * size
    once_round = n == 2 or abs(turned(ways)) < 7.0
    if not once_round or (any(c <= square for c in turns) and any(c >= -square for c in turns)):
        what = "the outline is not convex: two of its places could touch at once"
        raise ScenarioError(what, "make it several, each convex", path)


def turned(ways):
    """By how much a closed line turns from side to side, rad."""
    total = 0.0
    for k in range(len(ways)):
        (a, b), (c, d) = ways[k - 1], ways[k]
        total += atan2(a * d - b * c, a * c + b * d)
    return total


def roundness(surface):
    """How far places of a surface are from its origin, and the largest radius of its arcs, where
    they matter; refuses what is not round outside."""
    if surface.shape == "sphere":
        what = "an outline meets a plane, a cylinder or a profile"
        raise ScenarioError(what, "in a plane a cylinder is the same", ("surface", "shape"))
    if surface.hollow or (surface.shape == "profile" and not surface.closed):
        what = "an outline meets a plane, or what is round outside"
        hint = "take a ball in each corner that touches"
        raise ScenarioError(what, hint, ("surface", "hollow" if surface.hollow else "closed"))
    if surface.shape != "profile":
        return 0.0, 0.0
    found = pieces_of(surface, 1, inward=True, spline=FINE)
    size = float(max(hypot(*place) for place in found.outline.tolist()))
    for piece in found.pieces:
        if piece[0] == HOLLOW:
            what = "the profile turns inwards, and a straight side would touch it twice there"
            hint = "take a ball as follower, or a profile that is round all along"
            raise ScenarioError(what, hint, ("surface", "points"))
        if piece[0] == STRAIGHT and length_of(piece) > UNSEEN * size:
            what = "the profile has straight sides, on which those of an outline would lie"
            hint = "take a ball in each corner that touches, or `smooth: true`"
            raise ScenarioError(what, hint, ("surface", "points"))
    return size, max(piece[3] for piece in found.pieces if piece[0] != STRAIGHT)
