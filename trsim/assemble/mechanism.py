"""A model with the names that go with its numbers."""

from collections.abc import Mapping
from dataclasses import dataclass, field
from math import inf
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from trsim.assemble.members import Beam
from trsim.elements.contract import Channel, Element, Row
from trsim.elements.scene import Model

if TYPE_CHECKING:
    from trsim.assemble.stages import Stages

Array = NDArray[np.float64]


class Column(NamedTuple):
    """One channel of the output rows."""

    name: str
    unit: str
    meaning: str
    start: int
    size: int
    wanted: bool
    for_points: bool = False  # measured only because a section or a portrait shows it
    least: float = -inf  # what its definition alone keeps it above, or at


class Section(NamedTuple):
    """A Poincare section; of `when`, `every` and `at_onset` one is given."""

    name: str
    when: str
    crosses: str
    every: float  # s, or 0
    at_onset: str
    after: float  # s
    x: str
    y: str
    x_unit: str
    y_unit: str


@dataclass(frozen=True)
class Instance:
    """One element of the scenario, packed."""

    section: str
    name: str
    element: Element
    row: Row

    @property
    def channels(self) -> tuple[Channel, ...]:
        """Its channels, each in its own unit."""
        found = self.element.channels if self.row.channels is None else self.row.channels
        own = "rad" if self.row.turns else "m"
        return tuple(channel._replace(unit=channel.unit_on(own)) for channel in found)


@dataclass(frozen=True)
class RowName:
    """A constraint row, for messages and reports."""

    element: str  # joint or drive
    axis: str
    instance: int
    index: int  # which of the element's rows
    frames: tuple[int, int]
    rotation: bool


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
    coordinates: Mapping[str, Any]  # joint -> JointCoordinate
    frames: Mapping[str, int]
    beams: Mapping[str, Beam]
    notes: tuple[str, ...]
    stages: "Stages"  # what user events make of it
    sections: tuple[Section, ...] = ()  # in the order of model.section
    ahead: Mapping[int, float] = field(default_factory=dict)  # state -> how far from its coordinate
