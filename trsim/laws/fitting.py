"""The largest ball that touches a line in one place only.

    r(p, q) = d.d / (2 d.n),   d = q - p,   d.n > 0

is the radius of the ball that touches the line at p, where its normal is n, and meets it at q.  The
least of them over all p and q is that of the largest ball that touches no second place.  Pairs are
looked at by runs of neighbours, beginning with those that could have the smallest balls, until the
others cannot have a smaller one.
"""

from math import inf
from typing import Any

NEXT = 1e-6  # of the size of a profile: where one piece ends and the next begins
LEVEL = 1e-6  # of a distance: what rises so little above the tangent is on it
TOGETHER = 32  # neighbours of a run, at least
AT_ONCE = 200_000  # pairs of places: as many as a cache holds
RUNS = 1000  # at most: their pairs are listed


def fits(places: Any, normals: Any) -> float:
    """Radius of the largest ball that touches a profile in one place only, wherever it does."""
    import numpy as np

    size, most = np.linalg.norm(np.ptp(places, axis=0)), max(TOGETHER, -(-len(places) // RUNS))
    # runs of neighbours, all of one length: the last place again fills up the last of them
    of = np.minimum(np.arange(most * -(-len(places) // most)), len(places) - 1).reshape(-1, most)
    p, n = places[of], normals[of]
    least, best = smallest_of_runs(p, n), inf
    begin, other = np.nonzero(least < inf)
    order = np.argsort(least[begin, other], kind="stable")
    many = max(1, AT_ONCE // most**2)
    for k in range(0, len(order), many):
        a, b = begin[order[k : k + many]], other[order[k : k + many]]
        if (1.0 - NEXT) * least[a[0], b[0]] >= best:
            break
        d = p[b][:, None, :, :] - p[a][:, :, None, :]
        square = d[..., 0] * d[..., 0] + d[..., 1] * d[..., 1]
        above = d[..., 0] * n[a][:, :, None, 0] + d[..., 1] * n[a][:, :, None, 1]
        seen = (above > LEVEL * np.sqrt(square)) & (square > (NEXT * size) ** 2)
        if seen.any():
            best = min(best, float((square[seen] / (2.0 * above[seen])).min()))
    return best


def smallest_of_runs(p: Any, n: Any) -> Any:
    """No ball at one of these runs of places that meets one of those is smaller: (runs, runs), m.

    p, n : (runs, places, 2)      places, m, and their unit normals
    d.d / (2 d.n) is at least |d| / 2, and where d.n < 0 no ball meets q.
    """
    import numpy as np

    middle, normal = p.mean(axis=1), n.mean(axis=1)
    wide = np.linalg.norm(p - middle[:, None], axis=2).max(axis=1)
    turned = np.linalg.norm(n - normal[:, None], axis=2).max(axis=1)
    d = middle - middle[:, None]
    far, more = np.linalg.norm(d, axis=2), wide[:, None] + wide
    above = np.sum(d * normal[:, None], axis=2) + turned[:, None] * (far + more) + more
    near = np.maximum(far - more, 0.0)
    with np.errstate(divide="ignore", invalid="ignore"):
        least = np.maximum(0.5 * near, near * near / (2.0 * above))
    return np.where(above > 0.0, least, inf)
