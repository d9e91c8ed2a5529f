"""Elements of a scenario packed, and the names of their rows, columns and sections."""

from dataclasses import dataclass
from functools import cached_property
from math import inf
from typing import Any, NamedTuple

from trsim.elements.contract import Channel, Element, Row, Turning


class Column(NamedTuple):
    """One channel of the output rows."""

    name: str
    unit: str
    meaning: str
    start: int
    size: int
    wanted: bool
    for_points: bool = False  # measured only because a section or a portrait shows it
    least: float = -inf  # a lower bound by its definition alone
    turn: bool = False  # one about any axis, whose largest angle every run is judged by


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


class Named(NamedTuple):
    """A function, and where it stands in the scenario."""

    name: str  # forces.push.force
    offset: int  # in tab
    spec: Any  # its FunctionSpec


@dataclass(frozen=True)
class Instance:
    """One element of the scenario, packed."""

    section: str
    name: str
    element: Element
    row: Row
    acts: bool = True  # False of a force that events have removed, or are still to apply

    @property
    def entry(self) -> str:
        """The name that it has in its section of the scenario."""
        return self.name.partition(".")[0] if self.section == "forces" else self.name

    @cached_property
    def channels(self) -> tuple[Channel, ...]:
        """Its channels, each in its own unit."""
        found = self.element.channels if self.row.channels is None else self.row.channels
        return tuple(channel.on("rad" if self.row.turns else "m") for channel in found)

    @property
    def named_by_rows(self) -> frozenset[int]:
        """The frames that its constraint rows name."""
        return frozenset().union(*(self.row.frames(k) for k in range(len(self.element.rows))))

    @property
    def turning(self) -> Turning:
        """How it depends on the turns of its frames."""
        if self.element.turning:
            return self.element.turning(self.row)
        # of bodies themselves, and of their weight, no turn matters here
        own = self.section not in ("bodies", "")
        return Turning(tuple(self.element.acts_on(self.row)) if own else ())


@dataclass(frozen=True)
class RowName:
    """A constraint row, for messages and reports."""

    element: str  # joint or drive
    axis: str
    instance: int
    index: int  # which of the element's rows
    frames: tuple[int, ...]  # that it names, each once
    rotation: bool
