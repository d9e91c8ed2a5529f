"""The reaction of a joint: what its rows put on body j, as force and moment about the joint.

    f = -sum_k lam_k J_k[r_j],    m = -sum_k lam_k J_k[omega_j] - p_j x f

In a planar scene the out-of-plane components are those of the planar problem: zero.
"""

from trsim.elements.frames import TwoPoints, arm
from trsim.kernels.lazy import internal


@internal
def reaction_of(s, rows, lam, out, o):
    """Six numbers from out[o] on: the reaction of a joint with the multipliers lam.

    rows: its instance, where its rows begin in con, how many.
    """
    J, row_start = s.J, s.row_start
    e, first, number = rows
    own = TwoPoints(s, e)
    for c in range(6):
        out[o + c] = 0.0
    for r in range(first, first + number):
        row = s.con[e, r]
        if row >= 0:
            for l in range(row_start[row], row_start[row + 1]):
                if s.line_frame[l] == own.j:
                    for c in range(6):
                        out[o + c] -= lam[row] * J[l, c]
    p = arm(s.X, own.j, own.p_j)
    f0, f1, f2 = out[o], out[o + 1], out[o + 2]
    out[o + 3] -= p[1] * f2 - p[2] * f1
    out[o + 4] -= p[2] * f0 - p[0] * f2
    out[o + 5] -= p[0] * f1 - p[1] * f0
