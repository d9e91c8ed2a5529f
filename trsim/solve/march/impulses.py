"""Impulses of an event: what its constraints put on every body as velocities jump.

    M (v+ - v-) = J^T Lambda         Lambda = -S^-1 (J v- + Phi_t)         [Nikravesh1988]

Lambda of each row is what was solved for; where rows are redundant it is shared between them as
reactions are (least_norm.py), which changes nothing of J^T Lambda.  A line tells one row and one
body it acts on, the ground too.
"""

from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from trsim.assemble.equations import poses
from trsim.assemble.least_norm import least_norm
from trsim.elements.scene import Scene
from trsim.solve.march.record import Record

Array = NDArray[np.float64]

# of a line of impulses: time, event, row, body, Lambda, force and moment about the centre of mass
N_IMPULSE = 11
# of a line of jumps: time, event, body, velocity and angular velocity before and after
N_JUMP = 15
OUT_OF_PLANE = (2, 3, 4)  # components of a wrench


class Jump(NamedTuple):
    """How velocities jumped at an event, and by which impulses."""

    impulses: Array  # (n, N_IMPULSE)
    velocities: Array  # (n, N_JUMP)


def no_jump() -> Jump:
    """Nothing is told."""
    return Jump(np.zeros((0, N_IMPULSE)), np.zeros((0, N_JUMP)))


def together(jumps: list[Jump]) -> Jump:
    """The lines of several events."""
    parts = [no_jump(), *jumps]
    return Jump(*(np.vstack(lines) for lines in zip(*parts, strict=True)))


def told(mechanism: Any, work: Scene, r: Record, k: int, before: Array) -> Jump:
    """Of event k, whose velocities were just projected, with what was solved for still in `x`.

    before: twists of the frames (n, 6) before it.
    """
    t = float(r.t)
    poses(work, r.y)
    velocities = [
        [t, k, f, *before[f, :3], *work.V[f, :3], *before[f, 3:], *work.V[f, 3:]]
        for f in range(1, work.n_r)
    ]
    return Jump(
        np.array(lines_of(mechanism, work, r, k)).reshape(-1, N_IMPULSE),
        np.array(velocities).reshape(-1, N_JUMP),
    )


def lines_of(mechanism: Any, work: Scene, r: Record, k: int) -> list[list[float]]:
    """A line for each row in force and each rigid body it names."""
    if work.m == 0:
        return []
    work.lam[:] = 0.0
    work.lam[: work.m] = work.x[: work.m]
    if work.shared_out != 0:
        least_norm(work)
    rows, found = mechanism.stages.numbers(r.stage, r.left_out), []
    for line, (row, f) in enumerate(zip(work.line_row, work.line_frame, strict=True)):
        if f >= work.n_r:  # a node of a flexible bar has no wrench
            continue
        wrench = -work.lam[row] * work.J[line]
        if work.d == 3:
            wrench[list(OUT_OF_PLANE)] = 0.0
        found.append([float(r.t), k, rows[row], f, -work.lam[row], *wrench])
    return found
