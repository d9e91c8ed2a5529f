"""Forces and stiffness of many cable elements at once, for what is asked of a state now and then.

As laws/cable.py and cable_tangent.py with the assumed stretch.  The stiffness is that of the
elements under an axial strain that is given: Newton's method from a shape that is not balanced
goes wrong with the forces of that shape where a bar hardly stretches.
"""

from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from trsim.laws.cable import BEFORE, BEHIND, EXACT, MIDDLE, PAPER
from trsim.laws.cable_matrices import bends, slopes
from trsim.laws.cable_stretch import ENGINEERING, GREEN, INNER, INSIDE, OUTER
from trsim.laws.cable_tangent import bend_again

Array = NDArray[np.float64]

LOBATTO = (-0.5, -INSIDE, INSIDE, 0.5)


def assumed_weights() -> Array:
    """U / (EA l) of the assumed strain as a form of those at Lobatto's four points."""
    mean = np.array([OUTER, INNER, INNER, OUTER])
    skew = np.array([-1.0, 0.0, 0.0, 1.0])
    curved = np.array([0.5, 0.0, 0.0, 0.5]) - mean
    return np.outer(mean, mean) + np.outer(skew, skew) / 12.0 + np.outer(curved, curved) / 5.0


WEIGHTS = assumed_weights()


class Law(NamedTuple):
    """A bar as its elements see it."""

    EA: float
    EI: float
    strain: int
    curvature: int


def assumed(e: Array, l: float, law: Law) -> Array:
    """Strain of elements, (m, 3): s of s_0 + s_1 n + s_2 n^2 from that of their ends and mean."""
    rows = [np.array(slopes.python(n, 1.0 / l)) for n in LOBATTO]
    a = np.array([np.square(np.einsum("k,nkd->nd", c, e)).sum(axis=1) for c in rows])
    eps, _ = stretched(a, law.strain)
    mean = np.array([OUTER, INNER, INNER, OUTER]) @ eps
    curved = 6.0 * (0.5 * (eps[0] + eps[3]) - mean)
    return np.stack([mean - curved / 12.0, eps[3] - eps[0], curved], axis=1)


def system(e: Array, l: float, law: Law, strain: Array) -> tuple[Array, Array]:
    """dU/de of elements (m, 4, width), and d2U/de2 as if they were under other strains (m, 3).

    As `cable` and `cable_tangent`, for many at once.
    """
    m, width = len(e), e.shape[2]
    F, K = np.zeros((m, 4, width)), np.zeros((m, 4, width, 4, width))
    add_stretch(e, l, law, strain, F, K)
    for point in (BEFORE, MIDDLE, BEHIND):
        add_bend(e, point, l, law, F, K)
    return F.reshape(m, -1), K.reshape(m, 4 * width, 4 * width)


def add_stretch(e: Array, l: float, law: Law, strain: Array, F: Array, K: Array) -> None:
    """F += dU/de, K += d2U/de2 of the stretch."""
    weights, unit = law.EA * l * WEIGHTS, np.eye(e.shape[2])
    rows = [np.array(slopes.python(n, 1.0 / l)) for n in LOBATTO]
    r1 = [np.einsum("k,nkd->nd", c, e) for c in rows]
    a = np.array([np.einsum("nd,nd->n", r, r) for r in r1])
    eps, turn = stretched(a, law.strain)
    G = np.array(
        [t[:, None, None] * c[:, None] * r[:, None] for t, c, r in zip(turn, rows, r1, strict=True)]
    )
    F += np.einsum("pn,pnkd->nkd", weights @ eps, G)
    K += np.einsum("pnkd,pnmf->nkdmf", np.tensordot(weights, G, axes=1), G)
    f = weights @ np.array([strain @ (1.0, n, n * n) for n in LOBATTO])
    less = turn if law.strain == ENGINEERING else 0.0 * turn
    for p, c in enumerate(rows):
        K += np.einsum("n,km,df->nkdmf", f[p] * turn[p], np.outer(c, c), unit)
        K -= np.einsum("n,nkd,nmf->nkdmf", f[p] * less[p], G[p], G[p])


def stretched(a: Array, strain: int) -> tuple[Array, Array]:
    """Strain of a = r'.r' and 2 d eps / da, as `cable_stretch.stretch`."""
    if strain == GREEN:
        return 0.5 * (a - 1.0), np.ones_like(a)
    s = np.sqrt(a)
    return s - 1.0, 1.0 / s


def add_bend(e: Array, point: tuple[float, float], l: float, law: Law, F: Array, K: Array) -> None:
    """F += dU/de, K += d2U/de2 of the bend at a Gauss point."""
    n, weight = point
    u, unit = 1.0 / l, np.eye(e.shape[2])
    c, d = np.array(slopes.python(n, u)), np.array(bends.python(n, u))
    r1, r2 = np.einsum("k,nkd->nd", c, e), np.einsum("k,nkd->nd", d, e)
    a, b, q = (np.einsum("nd,nd->n", x, y) for x, y in ((r1, r1), (r1, r2), (r2, r2)))
    ones = weight * l * law.EI * np.ones_like(a)
    x, y = c[:, None] * r1[:, None], d[:, None] * r2[:, None]
    gradients = 2.0 * x, c[:, None] * r2[:, None] + d[:, None] * r1[:, None], 2.0 * y
    cd = np.outer(c, d)
    constant = 2.0 * np.outer(c, c), cd + cd.T, 2.0 * np.outer(d, d)
    for k, g, outer in zip(bent(a, b, q, law.curvature), gradients, constant, strict=True):
        F += (k * ones)[:, None, None] * g
        K += np.einsum("n,km,df->nkdmf", k * ones, outer, unit)
    aa, ab, ac, bb = bend_again.python(a, b, q, law.curvature)
    for k, i, j in ((aa, 0, 0), (ab, 0, 1), (ab, 1, 0), (ac, 0, 2), (ac, 2, 0), (bb, 1, 1)):
        K += np.einsum("n,nkd,nmf->nkdmf", k * ones, gradients[i], gradients[j])


def bent(a: Array, b: Array, c: Array, curvature: int) -> tuple[Any, Any, Any]:
    """Derivatives of kappa^2 / 2 in a, b and c, as `cable.bend`."""
    if curvature == PAPER:
        return 0.0, 0.0, 0.5
    q, y = (2.0, 1.0 / a) if curvature == EXACT else (1.0, 1.0 / a)
    weight, s = y**q, b * y
    across = np.maximum(c - b * s, 0.0)
    return 0.5 * weight * (s * s - q * across * y), -weight * s, 0.5 * weight
