"""When two runs of one scenario are two motions: the predictability horizon.

    d(t) = max over channels |x - x'| / (max x - min x)        apart where d > APART

Impacts multiply any difference, so runs of a mechanism with clearance part from one another
whatever their tolerances: from there on single values mean nothing.  A mechanism that is pressed
together, or at rest, loses that memory: the runs come together again, and may part again.
"""

from collections.abc import Mapping
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from trsim.arrays import Array

APART = 0.01  # of a range
PAUSE = 0.01  # of the rows: runs that are together for less have not come together again
STILL = 1e-9  # of the largest value of the same unit: less is rounding, not motion


class Window(NamedTuple):
    """Rows from the first where two runs are apart to the one after the last, without a pause."""

    begin: int
    end: int


def still(
    ranges: Mapping[str, float], largest: Mapping[str, float], units: Mapping[str, str]
) -> set[str]:
    """Channels that change by no more than rounding; `largest`: magnitude of each."""
    of: dict[str, float] = {}
    for name, size in largest.items():
        of[units[name]] = max(of.get(units[name], 0.0), size)
    return {name for name, size in ranges.items() if size <= STILL * of[units[name]]}


def resting(
    values: Mapping[str, Array], units: Mapping[str, str]
) -> tuple[dict[str, float], set[str]]:
    """Range of each channel (n, m), and those that change by no more than rounding."""
    ranges = {name: float(np.max(np.ptp(x, axis=0))) for name, x in values.items()}
    largest = {name: float(np.max(np.abs(x))) for name, x in values.items()}
    return ranges, still(ranges, largest, units)


def windows(apart: NDArray[np.bool_]) -> list[Window]:
    """Where two runs are apart, in order; apart (n): whether they are, row by row."""
    edges = np.flatnonzero(np.diff(apart, prepend=False, append=False))
    if not edges.size:
        return []
    begins, ends = edges[::2], edges[1::2]
    new = begins[1:] - ends[:-1] >= max(1.0, PAUSE * apart.size)
    begins, ends = begins[np.append(True, new)], ends[np.append(new, True)]
    return [Window(*pair) for pair in zip(begins.tolist(), ends.tolist(), strict=True)]
