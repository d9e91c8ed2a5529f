"""Which side of a singular position a driven mechanism is on: the sign of det J.

Where rows are as many as velocities J is square.  Its determinant is zero only where rows depend on
each other; what goes from one branch of positions to another, or past a place where branches meet,
changes its sign.
"""

import numpy as np

from trsim.assemble.linear import SINGULAR, smallest_pivot
from trsim.assemble.projection import project_positions
from trsim.elements.contract import SCENE, compiled
from trsim.elements.scene import Scene
from trsim.kernels.signatures import float64
from trsim.solve.march.record import BUFFERS, EXACT_POINTS, PARTS, Buffers, Record
from trsim.solve.methods.dense_lu import factorise_real


@compiled(float64(SCENE, BUFFERS))
def side(s, b):
    """The sign of det J of the last factorisation; 0: it is zero."""
    A, swaps, n, sign = b.square, b.swaps, s.n_v, 1.0
    for i in range(n):
        for j in range(n):
            A[i, j] = 0.0
    for f in range(1, s.n_r):
        for p in range(s.frame_start[f], s.frame_start[f + 1]):
            for c in range(s.d):
                A[s.slot_row[p], s.d * (f - 1) + c] += s.B[p, c]
    if not factorise_real(A, swaps, n):
        return 0.0
    for k in range(n):
        if swaps[k] != k:
            sign = -sign
        if A[k, k] < 0.0:
            sign = -sign
    return sign


def with_room(r: Record, b: Buffers, work: Scene) -> tuple[Record, Buffers]:
    """The record with more samples, since those inside steps are exact, and the buffers with room
    for J."""
    n, points = work.n_v, EXACT_POINTS
    samples = {"sample": np.zeros((points, len(work.kin))), "sampled": np.zeros(points)}
    r = Record(r, **samples, slope=np.zeros((points, len(work.kin))))
    r.driven = 1
    nodes = {"node": np.zeros((5, points)), "lattice": np.zeros((points, 1 + PARTS))}
    square = {"square": np.zeros((n, n)), "swaps": np.zeros(n, np.int64)}
    return r, Buffers(b, **nodes, inverse=np.zeros((points, points)), **square)


def keep_side(work: Scene, r: Record, b: Buffers) -> bool:
    """Note the side at the state of a record; whether there is one."""
    counted = work.status.copy()
    project_positions(work, float(r.t), r.y.copy())
    singular = work.status[0] == SINGULAR
    r.side = 0.0 if singular else side(work, b)
    r.least_pivot = smallest_pivot.python(work) if work.near_rows > 0.0 else 1.0
    work.status[:] = counted
    return bool(r.side != 0.0)
