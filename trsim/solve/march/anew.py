"""Rows chosen anew in a run, where those of the solve come to depend on each other."""

from typing import Any

import numpy as np
from numpy.typing import NDArray

from trsim.assemble.equations import poses
from trsim.assemble.linear import smallest_pivot
from trsim.assemble.mechanism import Mechanism
from trsim.assemble.projection import (
    CLOSED,
    NEWTON,
    close_positions,
    project_positions,
    project_velocities,
)
from trsim.elements.scene import Model, Scene, carried, scene
from trsim.errors import FileError
from trsim.solve.march.act import total_energy
from trsim.solve.march.checkpoint import ANEW, UNFIT
from trsim.solve.march.openings import FEEBLE
from trsim.solve.march.phases import settle
from trsim.solve.march.record import Buffers, Record
from trsim.solve.start.consistent import Start

Array = NDArray[np.float64]

NO_TIME, MANY = 1e-7, 30  # of the run; rows chosen anew so soon after others, so many times
AT_END = 2e-15  # of the time of a step's end: an output row there


def begun_with(mechanism: Mechanism, begun: Start) -> tuple[Scene, NDArray[np.int64]]:
    """The scene a run starts with, and which rows are left out of it."""
    stages = mechanism.stages
    stage = np.zeros(len(stages.switches.names), np.int64)
    left_out = stages.left_out(stage)
    work = scene(mechanism.model)
    if len(mechanism.model.redundant) and feeble(work, begun.y):
        left_out = stages.anew(stage, left_out, work, begun.y)
        work = scene(stages.choice(stage, left_out).model)
    return work, left_out


def resumed(mechanism: Mechanism, work: Scene, r: Record) -> Scene:
    """The scene of a record that was put back.  Raises FileError where it has other rows."""
    stages = mechanism.stages
    usual = stages.left_out(r.stage)
    choice = stages.choice(r.stage, r.left_out)
    marks = int(np.sum(r.left_out == 1))
    if not marks == len(choice.dropped) == int(np.sum(usual)) == int(np.sum(r.left_out != 0)):
        raise FileError(f"{UNFIT}: record.left_out", ANEW)
    r.kept = 0  # what passes.py knows of rows is in the scene
    return work if same(work, choice.model) else carried(work, choice.model)


def same(work: Scene, model: Model) -> bool:
    """Whether a scene is that of a model: the same rows of the same elements."""
    return np.array_equal(work.con, model.con) and np.array_equal(work.par, model.par)


def feeble(work: Scene, y: Array) -> bool:
    """Whether rows nearly depend on each other, by the pivots of S; see openings.py."""
    project_positions(work, 0.0, y.copy())
    return bool(smallest_pivot.python(work) < FEEBLE)


def anew(
    mechanism: Mechanism, work: Scene, r: Record, b: Buffers, setting: Any, acted: bool = False
) -> Scene:
    """The scene to go on with: of the same stage, its rows those that hold best here.

    What weak rows let go of is closed by them, without projection too: it is no drift.  An output
    row at the end of the step is that of the new ones; not one before an event that `acted`.
    """
    r.weak = 0
    stages = mechanism.stages
    left_out = stages.anew(r.stage, r.left_out, work, r.y)
    if np.array_equal(left_out, r.left_out):
        return work
    r.left_out[:] = left_out
    work = carried(work, stages.choice(r.stage, left_out).model)
    before = total_energy(work, float(r.t), r.y)
    project(work, float(r.t), r.y)
    r.work_projection += total_energy(work, float(r.t), r.y) - before
    settle(work, r, b, setting)
    last = int(r.rows) - 1
    if not acted and last >= 0 and b.rows[last, 0] >= r.t * (1.0 - AT_END):
        b.rows[last, 1:] = work.out
    return work


def stuck(r: Record, setting: Any) -> bool:
    """Whether rows come to depend on each other wherever a run goes: it would not reach its end."""
    t = float(r.t)
    soon = t - r.chosen_t < NO_TIME * setting.t_end
    r.chosen, r.chosen_t = r.chosen + 1 if soon else 1, t
    return bool(r.chosen > MANY)


def project(work: Scene, t: float, y: Array) -> None:
    """Positions and velocities to the rows, nearest in M."""
    close_positions(work, t, y, CLOSED * work.size, NEWTON)
    poses(work, y)
    project_velocities(work, y)
