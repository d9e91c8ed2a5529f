"""What all drives share: a prescribed motion f(t), and the layout of their rows.

Row.con   0 i, 1 j, 2 coordinate x in S, 3 state of z or -1, 4 angle or stroke, 5 f in tab
con       the same with the constraint row of the drive behind the coordinate
par       0:3, 3:6 the points in bodies i and j, 6:9 the drive's own, 9 k, 10 c, 11 sign

A drive that an event has released has neither row nor spring: nothing is prescribed any more, and
what it tells is where its joint is.

For a prescribed velocity the state holds the prescribed place, its integral from where x was when
the motion began; f is the velocity then.
"""

from typing import Any

from trsim.elements.contract import compiled
from trsim.elements.frames import helper
from trsim.kernels.signatures import A1, f8, i8, void
from trsim.laws.functions import motion

ENTRY, OWN_STATE, OWN_MOTION = 2, 3, 5  # of Row.con
ROW, STATE, ROTATES, MOTION = 3, 4, 5, 6  # of con
K, C, SIGN = 9, 10, 11  # of par


@compiled(void(A1, i8, f8, A1))
def write_rates(tab, offset, t, out):
    """out = f, f', f'' of a function of tab at t."""
    out[0], out[1], out[2] = motion(tab, offset, t)


def rates_at(tab: Any, offset: int, t: float) -> tuple[float, float, float]:
    """f, f', f'' of a function of tab at t."""
    import numpy as np

    out = np.zeros(3)
    write_rates(tab, offset, t, out)
    f, f_dot, f_ddot = out.tolist()
    return f, f_dot, f_ddot


@helper
def holds(con, par, e):
    """Whether a drive acts on its joint: it has not let go."""
    return con[e, ROW] >= 0 or par[e, K] > 0.0


@helper
def prescribed(t, z, tab, state, offset):
    """Prescribed place, its rate and second rate at the time t since the motion began."""
    f, f_dot, f_ddot = motion(tab, offset, t)
    if state < 0:
        return f, f_dot, f_ddot
    return z[state], f, f_dot
