"""What all drives share: a prescribed motion f(t), and names of their columns.

A drive that an event has released has neither row nor spring: nothing is prescribed any more, and
what it tells is where its joint is.

For a prescribed velocity the state holds the prescribed place, its integral from where x was when
the motion began; f is the velocity then.
"""

from typing import Any

from trsim.elements.contract import compiled
from trsim.elements.frames import Along
from trsim.kernels.columns import constraint_row, f8, i8
from trsim.kernels.lazy import internal
from trsim.kernels.signatures import A1, A2, void
from trsim.laws.functions import motion


class AnyDrive(Along):
    """Of every drive; one between two points has no axis of its own."""

    row: constraint_row
    state: i8  # of z: the prescribed place of a drive by velocity, or -1
    rotates: i8  # 1: it drives an angle
    motion: i8  # f in tab
    stiffness: f8  # 0 of a rigid drive, and of one that was released
    damping: f8
    sign: f8


@internal
def began(scene, e, offset):
    """When the clock of a function began, s: of the motion of drive e, unless that is negative.

    Less than 0 where no drive follows it.
    """
    if e < 0:
        return 0.0
    own = AnyDrive(scene, e)
    return own.since if own.motion == offset else -1.0


@compiled(void(A1, i8, A1, A2))
def write_rates(tab, offset, times, out):
    """out[k] = f, f', f'' of a function of tab at times[k]."""
    for k in range(len(times)):
        out[k, 0], out[k, 1], out[k, 2] = motion(tab, offset, times[k])


def rates_along(tab: Any, offset: int, times: Any) -> Any:
    """f, f', f'' of a function of tab at n times, (n, 3)."""
    import numpy as np

    out = np.zeros((len(times), 3))
    write_rates(tab, offset, times, out)
    return out


def rates_at(tab: Any, offset: int, t: float) -> tuple[float, float, float]:
    """f, f', f'' of a function of tab at t."""
    import numpy as np

    f, f_dot, f_ddot = rates_along(tab, offset, np.array([t]))[0].tolist()
    return f, f_dot, f_ddot


@internal
def holds(scene, e):
    """Whether a drive acts on its joint: it has not let go."""
    own = AnyDrive(scene, e)
    return own.row >= 0 or own.stiffness > 0.0


@internal
def prescribed(t, scene, e):
    """Prescribed place, its rate and second rate at time t."""
    own = AnyDrive(scene, e)
    f, f_dot, f_ddot = motion(scene.tab, own.motion, t - own.since)
    if own.state < 0:
        return f, f_dot, f_ddot
    return scene.z[own.state], f, f_dot
