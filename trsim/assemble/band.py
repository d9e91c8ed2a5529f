"""The mass matrices of beams: bands of scalars, factorised once.                assemble/beams.py

Node by node, place and slope, M is a band four wide, times the unit matrix of two or three
directions: that of one element is `mass` of laws/cable_section.py.
"""

from typing import Any

import numpy as np
from numpy.typing import NDArray

from trsim.assemble.members import Beam
from trsim.assemble.pattern import Rows, slots
from trsim.laws.cable_section import mass

Array = NDArray[np.float64]

WIDTH = 4  # diagonal and three entries below it


def scalar_mass(beam: Beam) -> Array:
    """M of a beam against place and slope of its nodes in one direction (2 nodes, 2 nodes)."""
    M = np.zeros((2 * beam.nodes, 2 * beam.nodes))
    element = np.array(mass.python(beam.length, beam.per_length))
    for k in range(beam.nodes - 1):
        M[2 * k : 2 * k + 4, 2 * k : 2 * k + 4] += element
    return M


def banded(M: Array) -> Array:
    """Diagonal and the three entries below it of every column."""
    band = np.zeros((len(M), WIDTH))
    for p in range(WIDTH):
        band[: len(M) - p, p] = np.diagonal(M, -p)
    return band


def factorised(band: Array) -> Array:
    """L D L^T in place of M: 1 / D and the three entries below it in L."""
    A, n = band.copy(), len(band)
    for k in range(n):
        for p in range(1, min(WIDTH, n - k)):
            L = A[k, p] / A[k, 0]
            for o in range(p, min(WIDTH, n - k)):
                A[k + p, o - p] -= L * A[k, o]
        A[k, 1:] /= A[k, 0]
        A[k, 0] = 1.0 / A[k, 0]
    return A


def inverse_of(factors: Array) -> Array:
    """M^-1, from L D L^T."""
    n = len(factors)
    X = np.eye(n)
    for k in range(n):
        for p in range(1, min(WIDTH, n - k)):
            X[k + p] -= factors[k, p] * X[k]
    X *= factors[:, :1]
    for k in range(n - 1, -1, -1):
        for p in range(1, min(WIDTH, n - k)):
            X[k] -= factors[k, p] * X[k + p]
    return X


def band_tables(beams: list[Beam], row_frames: Rows, n: int) -> dict[str, Any]:
    """`beam`, `band`, `consistent` and `across` of a model with n frames."""
    of_frame = slots(row_frames, n) if beams else []
    rows, bands, across, at = [], [np.zeros((0, WIDTH))], [], 0
    for beam in beams:
        M = scalar_mass(beam)
        band = banded(M)
        inverse = inverse_of(factorised(band))
        rows.append((beam.first, beam.nodes, at, beam.element))
        bands.append(band)
        at += 2 * beam.nodes
        nodes = [k for k in range(beam.nodes) for _ in of_frame[beam.first + k]]
        for last, p in enumerate(nodes):
            for o in nodes[: last + 1]:
                across.append(inverse[2 * p : 2 * p + 2, 2 * o : 2 * o + 2].ravel())
    return {
        "beam": np.array(rows, np.int64).reshape(-1, 4),
        "band": np.vstack([factorised(band) for band in bands]),
        "consistent": np.vstack(bands),
        "across": np.array(across, float).reshape(-1, WIDTH),
    }
