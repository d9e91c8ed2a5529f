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
    edges: dict[tuple[int, tuple[int, ...]], tuple[int, ...]] = {}
    drives: dict[tuple[int, tuple[int, ...]], tuple[int, ...]] = {}
    for row in rows:
        driven = instances[row.instance].section == "drives"
        bodies = tuple(sorted(of_bar.get(f, f) for f in row.frames))
        (drives if driven else edges)[row.instance, row.frames] = bodies
    joined = set(edges.values())
    left = [*edges.values(), *(bodies for bodies in drives.values() if bodies not in joined)]
    while True:
        ends = [f for bodies in left for f in bodies]
        single = {f for f in ends if f != 0 and ends.count(f) == 1}
        if not single:
            break
        left = [bodies for bodies in left if not single & set(bodies)]
    nodes = set(of_bar.values())
    return np.array(sorted({f for bodies in left for f in bodies} - {0} - nodes), np.int64)
