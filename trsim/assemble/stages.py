"""The models of one mechanism as user events leave it: one state, one set of channels.

A stage is the position of all switches (switches.py).  Bodies, element instances, states and output
columns are those of the whole run; what differs is which constraint rows are solved, and the motion
that drives follow.  Rows are chosen again for every stage, so what becomes redundant is dropped.

Rows that stand for others where the mechanism is drawn may come to depend on each other as it
moves, where others would not.  `anew` then chooses others of the same stage (better.py); which ones
is a part of the record of a run.
"""

from collections.abc import Callable, Sequence
from dataclasses import replace
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from trsim.assemble.better import better
from trsim.assemble.instances import Instance, RowName
from trsim.assemble.layout import no_outputs
from trsim.assemble.places import JointCoordinate
from trsim.assemble.rows import all_rows
from trsim.assemble.switches import (
    AS_DRAWN,
    HELD,
    LOOSE,
    MOST,
    PHASE,
    Switches,
    lock_name,
    park_name,
)
from trsim.elements.prescribed import AnyDrive
from trsim.elements.scene import Model, Scene

Array = NDArray[np.float64]
Rows = list[RowName]


class Choice(NamedTuple):
    """The model of a stage, its rows in the solve and those left out."""

    model: Model
    kept: Rows
    dropped: Rows

    @property
    def names(self) -> tuple[str, ...]:
        """The names of the rows in the solve."""
        return tuple(f"{row.element}.{row.axis}" for row in self.kept)


class Stages:
    """Models by the position of the switches, made when they are first asked for."""

    def __init__(
        self, switches: Switches, instances: list[Instance], first: Choice,
        build: Callable[[list[Instance], Rows], Choice],
        rebuild: Callable[[list[Instance], Rows, Rows], Model],
        turning: Sequence[tuple[tuple[str, str], JointCoordinate]],
    ) -> None:  # fmt: skip
        """build: (instances, rows that are in force) -> a choice, its model without outputs;
        rebuild: (instances, rows to solve, rows to leave out) -> such a model;
        turning: rigid drives, locks and relations (section, name) of hinges in space, and of which
        angle."""
        self.switches, self.instances, self.first = switches, instances, first.model
        self._build, self._rebuild, self._turning = build, rebuild, turning
        self._made = {(0,) * len(switches.names): first}
        every = all_rows(instances, closed(dict.fromkeys(switches.names, HELD)))
        self.every = tuple(f"{row.element}.{row.axis}" for row in every)
        self._number = {key(row): k for k, row in enumerate(every)}
        may_depend = len(first.dropped) > 0 or len(switches.names) > 0
        self._place = self._number if may_depend else {}

    def model(self, stage: NDArray[np.int64]) -> Model:
        """The model of a stage.  Raises ModelError where a lock or drive contradicts the rest."""
        return self._found(stage).model

    def rows(self, stage: NDArray[np.int64]) -> tuple[str, ...]:
        """Names of the rows in the solve."""
        return self._found(stage).names

    def left_out(self, stage: NDArray[np.int64]) -> NDArray[np.int64]:
        """1 for every row, of all there may be, that is left out as a stage is made."""
        return self._marked(self._found(stage).dropped)

    def choice(self, stage: NDArray[np.int64], left_out: NDArray[np.int64]) -> Choice:
        """What a stage solves where these rows are left out."""
        made = self._found(stage)
        if np.array_equal(left_out, self._marked(made.dropped)):
            return made
        position = (*stage.tolist(), -1, *left_out.tolist())
        if position not in self._made:
            rows = sorted([*made.kept, *made.dropped], key=key)
            kept = [row for row in rows if not left_out[self._place[key(row)]]]
            dropped = [row for row in rows if left_out[self._place[key(row)]]]
            model = self._rebuild(self._switched(stage), kept, dropped)
            self._made[position] = Choice(self._finished(model, stage), kept, dropped)
        return self._made[position]

    def numbers(self, stage: NDArray[np.int64], left_out: NDArray[np.int64]) -> list[int]:
        """Which of `every` the rows of a stage are: those of the solve, then those left out."""
        choice = self.choice(stage, left_out)
        return [self._number[key(row)] for row in (*choice.kept, *choice.dropped)]

    def anew(
        self, stage: NDArray[np.int64], left_out: NDArray[np.int64], work: Scene, y: Array
    ) -> NDArray[np.int64]:
        """Which rows to leave out at y; work: a scene of the choice in force."""
        made = self.choice(stage, left_out)
        dropped = better(work, y, made.kept, made.dropped, self.instances)
        return left_out if dropped is None else self._marked(dropped)

    def _marked(self, rows: Rows) -> NDArray[np.int64]:
        marks = np.zeros(len(self._place), np.int64)
        marks[[self._place[key(row)] for row in rows]] = 1
        return marks

    def _switched(self, stage: NDArray[np.int64]) -> list[Instance]:
        at = dict(zip(self.switches.names, stage.tolist(), strict=True))
        return [switched(i, at, self.switches) for i in self.instances]

    def _finished(self, model: Model, stage: NDArray[np.int64]) -> Model:
        """With the outputs of all stages; what is locked crosses no value, and is not looked at."""
        at = zip(self.switches.names, stage.tolist(), strict=True)
        held = {name for (section, name), to in at if (section, to) == ("locks", HELD)}
        held -= {angle.name for _, angle in self.without_hinge(stage)}
        watch, phase = model.watch.copy(), dict(self._at(stage)).get(PHASE, 0)
        for k, event in enumerate(self.switches.events):
            if event.coordinate in held or event.phase not in (-1, phase):
                watch[k, MOST] = 0
        outputs = {name: getattr(self.first, name) for name in no_outputs(0)}
        outputs["silent"] = silent(self._switched(stage), self.switches)
        return model.replaced(watch=watch, **outputs)

    def _at(self, stage: NDArray[np.int64]) -> list[tuple[tuple[str, str], int]]:
        return list(zip(self.switches.names, stage.tolist(), strict=True))

    def without_hinge(
        self, stage: NDArray[np.int64]
    ) -> list[tuple[tuple[str, str], JointCoordinate]]:
        """Rigid drives, closed locks and relations of angles (section, name) with a hinge in space
        that is apart; its angle.

        What is seen of its angle is that of a line that leaves the plane of the hinge: there is
        nothing to turn, so they let go.
        """
        at = dict(zip(self.switches.names, stage.tolist(), strict=True))
        return [
            (of, x)
            for of, x in self._turning
            if at.get(("joints", x.joint)) == LOOSE
            and (at.get(("locks", x.name)) == HELD if of[0] == "events" else at.get(of) != LOOSE)
        ]

    def _found(self, stage: NDArray[np.int64]) -> Choice:
        position = tuple(stage.tolist())
        if position not in self._made:
            at = dict(zip(self.switches.names, position, strict=True))
            gone = {of for of, _ in self.without_hinge(stage)}
            made = self._build(self._switched(stage), in_force(self.instances, at, gone))
            self._made[position] = made._replace(model=self._finished(made.model, stage))
        return self._made[position]


def key(row: RowName) -> tuple[int, int]:
    """What tells a row from all others, in the order of the elements."""
    return row.instance, row.index


def switched(instance: Instance, at: dict[tuple[str, str], int], switches: Switches) -> Instance:
    """A drive with the motion its switch says, a force that acts or does not; every other instance
    as it is."""
    to = at.get((instance.section, instance.name), AS_DRAWN)
    if instance.section == "forces" and to != AS_DRAWN:
        return replace(instance, acts=to == HELD)
    if instance.section != "drives" or to == AS_DRAWN:
        return instance
    if to == LOOSE:
        return replace(instance, row=AnyDrive.changed(instance.row, stiffness=0.0, damping=0.0))
    state, motion = switches.motions[instance.name][to - 1]
    return replace(instance, row=AnyDrive.changed(instance.row, state=state, motion=motion))


def in_force(
    instances: list[Instance], at: dict[tuple[str, str], int], gone: set[tuple[str, str]]
) -> Rows:
    """The rows of the joints that are together, of the drives that hold, of the closed locks.

    gone: drives and locks (section, name) that hold nothing.
    """
    loose = {key for key, to in at.items() if to == LOOSE} | gone
    rows = all_rows(instances, closed(at))
    of = [(instances[r.instance].section, instances[r.instance].name) for r in rows]
    return [row for row, key in zip(rows, of, strict=True) if key not in loose]


def closed(at: dict[tuple[str, str], int]) -> list[str]:
    """The names of the locks that are closed, and of what holds parked bodies."""
    named = {"locks": lock_name, "parks": park_name}
    held = [(section, name) for (section, name), to in at.items() if to == HELD]
    return [named[section](name) for section, name in held if section in named]


def silent(instances: list[Instance], switches: Switches) -> NDArray[np.int64]:
    """The columns of forces that do not act."""
    resting = [one.name for one in instances if not one.acts]
    columns = [column for name in resting for column in switches.silent.get(name, ())]
    return np.array(columns, np.int64)
