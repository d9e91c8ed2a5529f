"""The models of one mechanism as user events leave it: one state, one set of channels.

A stage is the position of all switches (switches.py).  Bodies, element instances, states and output
columns are those of the whole run; what differs is which constraint rows are solved, and the motion
that drives follow.  Rows are chosen again for every stage, so what becomes redundant is dropped.
"""

from collections.abc import Callable
from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from trsim.assemble.mechanism import Instance, Mechanism, RowName
from trsim.assemble.rows import all_rows
from trsim.assemble.switches import AS_DRAWN, HELD, LOOSE, Switches, lock_name
from trsim.elements.prescribed import OWN_MOTION, OWN_STATE, C, K
from trsim.elements.scene import Model

Rows = list[RowName]
# the same in every stage
OUTPUTS = (
    "wanted",
    "joint_out",
    "column_energy",
    "n_out",
    "section",
    "section_at",
    "vector",
    "kin",
)


class Stages:
    """Models by the position of the switches, made when they are first asked for."""

    def __init__(
        self, switches: Switches, instances: list[Instance], first: Model,
        build: Callable[[list[Instance], Rows], tuple[Model, Rows]],
    ) -> None:  # fmt: skip
        """build: (instances, rows that are in force) -> (model without outputs, rows solved)."""
        self.switches, self.instances, self.first = switches, instances, first
        self._build = build
        self._made: dict[tuple[int, ...], tuple[Model, tuple[str, ...]]] = {}

    def model(self, stage: NDArray[np.int64]) -> Model:
        """The model of a stage.  Raises ModelError where a lock or drive contradicts the rest."""
        return self._found(stage)[0]

    def rows(self, stage: NDArray[np.int64]) -> tuple[str, ...]:
        """Names of the rows in the solve."""
        return self._found(stage)[1]

    def mechanism(self, mechanism: Mechanism, stage: NDArray[np.int64]) -> Mechanism:
        """The mechanism as it is in a stage."""
        if not np.any(stage):
            return mechanism
        return replace(mechanism, model=self.model(stage), rows=self.rows(stage))

    def _found(self, stage: NDArray[np.int64]) -> tuple[Model, tuple[str, ...]]:
        position = tuple(stage.tolist())
        if position not in self._made:
            at = dict(zip(self.switches.names, position, strict=True))
            instances = [switched(i, at, self.switches) for i in self.instances]
            model, rows = self._build(instances, in_force(instances, at))
            outputs = {name: getattr(self.first, name) for name in OUTPUTS}
            names = tuple(f"{row.element}.{row.axis}" for row in rows)
            self._made[position] = model.replaced(**outputs), names
        return self._made[position]


def switched(instance: Instance, at: dict[tuple[str, str], int], switches: Switches) -> Instance:
    """A drive with the motion its switch says; every other instance as it is."""
    to = at.get((instance.section, instance.name), AS_DRAWN)
    if instance.section != "drives" or to == AS_DRAWN:
        return instance
    con, par = list(instance.row.con), list(instance.row.par)
    if to == LOOSE:
        par[K] = par[C] = 0.0
    else:
        con[OWN_STATE], con[OWN_MOTION] = switches.motions[instance.name][to - 1]
    return replace(instance, row=replace(instance.row, con=tuple(con), par=tuple(par)))


def in_force(instances: list[Instance], at: dict[tuple[str, str], int]) -> Rows:
    """The rows of the joints that are together, of the drives that hold, of the closed locks."""
    closed = [name for (section, name), to in at.items() if (section, to) == ("locks", HELD)]
    loose = {key for key, to in at.items() if to == LOOSE}
    rows = all_rows(instances, [lock_name(name) for name in closed])
    of = [(instances[r.instance].section, instances[r.instance].name) for r in rows]
    return [row for row, key in zip(rows, of, strict=True) if key not in loose]
