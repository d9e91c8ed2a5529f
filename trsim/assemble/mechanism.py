"""A model with the names that go with its numbers."""

from collections.abc import Mapping
from dataclasses import dataclass, field, replace
from typing import Any

import numpy as np
from numpy.typing import NDArray

from trsim.assemble.instances import Column, Instance, Named, Section
from trsim.assemble.members import Beam
from trsim.assemble.poles import Guard
from trsim.assemble.stages import Stages
from trsim.elements.scene import Model

Array = NDArray[np.float64]


@dataclass(frozen=True)
class Mechanism:
    """A model with the names that go with its numbers."""

    model: Model
    y0: Array  # as drawn; velocities as given, z zero
    instances: tuple[Instance, ...]
    columns: tuple[Column, ...]
    planar: bool
    timed: bool  # a load or drive depends on time explicitly
    planar_assumed: bool  # nothing holds the bodies in their plane
    spatial_because: tuple[str, ...]  # what reaches out of the plane, where nobody asked for space
    mobility: int  # degrees of freedom left, by rank near the drawn position; drives are rows
    mobility_by_count: int  # unknowns minus rows, as Gruebler counts them
    redundant: tuple[str, ...]  # rows dropped, "joint.axis"
    singular: tuple[str, ...]  # rows dependent only as drawn
    unique: tuple[str, ...]  # rows whose reaction the motion determines
    not_unique: tuple[str, ...]  # and those it does not
    rows: tuple[str, ...]  # rows in the solve
    follows: tuple[int, ...]  # coordinate each element state starts at, or -1
    coordinates: Mapping[str, Any]  # what it is called -> JointCoordinate
    frames: Mapping[str, int]
    beams: Mapping[str, Beam]
    notes: tuple[str, ...]
    stages: Stages  # what user events make of it
    functions: tuple[Named, ...] = ()  # of loads and motions
    guards: tuple[Guard, ...] = ()  # what of them may have no value, as in model.pole
    sections: tuple[Section, ...] = ()  # in the order of model.section
    ahead: Mapping[int, float] = field(default_factory=dict)  # state -> how far from its coordinate

    def in_stage(self, stage: NDArray[np.int64], left_out: NDArray[np.int64]) -> "Mechanism":
        """The mechanism as it is in a stage, with these rows left out."""
        choice = self.stages.choice(stage, left_out)
        if choice.model is self.model:
            return self
        return replace(self, model=choice.model, rows=choice.names)
