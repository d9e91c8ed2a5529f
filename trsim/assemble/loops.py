"""Bodies in kinematic loops: where joints hold more than an open chain would need.

Rows of J can come to depend on each other in loops only, and only by what turns there: a rotor that
hangs on a loop may turn as it likes.
"""

from collections.abc import Iterable, Sequence

import numpy as np
from numpy.typing import NDArray

from trsim.assemble.instances import Instance, RowName


def looped(
    instances: Sequence[Instance], rows: Sequence[RowName], bars: Iterable[tuple[int, int]] = ()
) -> NDArray[np.int64]:
    """Frames of the rigid bodies in loops, rising, the ground left out.

    What is left of the graph of joints when bodies that one joint holds are taken off it, again and
    again.  A drive between two bodies that a joint joins already closes none; a second joint does.
    bars: first frame and number of nodes of each, which is one body.
    """
    of_bar = {f: first for first, nodes in bars for f in range(first, first + nodes)}
    edges: dict[int, tuple[int, int]] = {}
    drives: dict[int, tuple[int, int]] = {}
    for row in rows:
        i, j = (of_bar.get(f, f) for f in row.frames)
        driven = instances[row.instance].section == "drives"
        (drives if driven else edges)[row.instance] = (min(i, j), max(i, j))
    joined = set(edges.values())
    edges |= {e: pair for e, pair in drives.items() if pair not in joined}
    left = list(edges.values())
    while True:
        ends = [f for pair in left for f in pair]
        single = {f for f in ends if f != 0 and ends.count(f) == 1}
        if not single:
            break
        left = [pair for pair in left if not single & set(pair)]
    nodes = set(of_bar.values())
    return np.array(sorted({f for pair in left for f in pair} - {0} - nodes), np.int64)
