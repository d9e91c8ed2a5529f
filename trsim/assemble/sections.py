"""Poincare sections packed: the surface of each, and the output columns it shows."""

from collections.abc import Iterable, Sequence
from typing import Any

import numpy as np
from numpy.typing import NDArray

from trsim.assemble.instances import Column, Instance, Section
from trsim.assemble.waves import Swinging, followed
from trsim.elements.scene import COMPONENTS
from trsim.errors import ScenarioError, known
from trsim.scenario.event import DIRECTIONS

# kinds of surface, and columns of model.section and of model.section_at
CROSSING, STROBE, TOUCH = 0, 1, 2
# WHEN: an output column, or the row of a contact; WAVES: 1 where loads and drives make it swing;
# ALONE: the row of the element that tells WHEN by places and rates alone, or -1
KIND, WHEN, DIRECTION, X, Y, WAVES, ALONE, N_SECTION = range(8)
AFTER, EVERY = range(2)
SECTION = "poincare"  # of a scenario
SMOOTH = ("m", "m/s", "rad", "rad/s", "-")  # units of what loads move by its accelerations only


def sections(
    scenario: Any, heard: NDArray[np.int64], instances: list[Instance], columns: list[Column],
    waves: Sequence[Swinging],
) -> tuple[dict[str, Any], tuple[Section, ...]]:  # fmt: skip
    """The fields of a model that tell of sections, and their names; heard: columns that user events
    watch; waves: see waves.followed.

    Sections in a bearing whose clearance is 0 are left out: a sweep may well begin with an ideal
    joint.  Raises ScenarioError for channels and contacts that do not exist.
    """
    there = {column.name: column for column in columns}
    # what a drive prescribes, and sensors that are functions themselves
    functions = {i.name for i in instances if i.section == "drives" or i.element.stands_for}
    rows, at, found = [], [], []
    for name, spec in scenario.poincare.items():
        if without_play(scenario, (spec.when, spec.at_onset, *spec.plot)):
            continue
        x, y = (column_of(c, there, (SECTION, name, "plot", k)) for k, c in enumerate(spec.plot))
        kind, when = surface(scenario, name, spec, instances, there)
        waving = kind == CROSSING and not smooth(there[stored(spec.when, there)[0]], functions)
        alone = alone_in(stored(spec.when, there)[0], instances) if kind == CROSSING else -1
        rows.append((kind, when, DIRECTIONS[spec.crosses], x, y, int(waving), alone))
        at.append((spec.after, spec.every or 0.0))
        units = [there[stored(c, there)[0]].unit for c in spec.plot]
        crosses = spec.crosses if spec.when else ""
        found.append(Section(name, spec.when or "", crosses, spec.every or 0.0, spec.at_onset or "",
                             spec.after, *spec.plot, *units))  # fmt: skip
    watched = (c for o in heard.tolist() for c in columns if c.start <= o < c.start + c.size)
    swinging = any(not smooth(column, functions) for column in watched)
    fields = {
        "section": np.array(rows, np.int64).reshape(-1, N_SECTION),
        "section_at": np.array(at, float).reshape(-1, 2),
        **followed(waves if swinging or any(row[WAVES] for row in rows) else []),
    }
    return fields, tuple(found)


def alone_in(name: str, instances: list[Instance]) -> int:
    """The row of the element whose channel this is, if it is of places and rates alone; else -1."""
    for e, instance in enumerate(instances):
        for channel in instance.channels:
            if channel.moves and name == f"{instance.name}.{channel.name}".rstrip("."):
                return e
    return -1


def smooth(column: Column, functions: set[str]) -> bool:
    """Whether steps follow a channel: a place, a velocity or an energy, but not what is prescribed.

    However fast a load swings, these are its integrals.  functions: what shows one itself.
    """
    if column.name.startswith("energy."):
        return True
    return column.unit in SMOOTH and column.name.split(".")[0] not in functions


def without_play(scenario: Any, channels: Iterable[str | None]) -> str:
    """The joint with a clearance of 0 that one of some channels is about; "" if there is none."""
    for channel in channels:
        name = (channel or "").split(".")[0]
        if getattr(scenario.joints.get(name), "clearance", None) == 0.0:
            return name
    return ""


def surface(
    scenario: Any, name: str, spec: Any, instances: list[Instance], there: dict[str, Column]
) -> tuple[int, int]:
    """Which kind of surface it is, and the column or the contact that goes with it."""
    if spec.every:
        return STROBE, -1
    if spec.when:
        return CROSSING, column_of(spec.when, there, (SECTION, name, "when"))
    path = (SECTION, name, "at_onset")
    contacts = {i.name: e for e, i in enumerate(instances) if i.row.contact}
    if spec.at_onset not in contacts:
        hint = known(spec.at_onset, contacts) if contacts else "no joint here has clearance"
        raise ScenarioError(f"no contact named '{spec.at_onset}'", hint, path)
    if not scenario.solver.locates:
        what = "touches are not located in this run"
        raise ScenarioError(what, "Write `solver: {locate_events: true}`.", path)
    return TOUCH, contacts[spec.at_onset]


def stored(channel: str, there: Any) -> tuple[str, int | None]:
    """The column and the component that `channel` names."""
    if channel not in there and channel[-2:] in COMPONENTS:
        return channel[:-2], COMPONENTS[channel[-2:]]
    return channel, None


def column_of(channel: str, there: dict[str, Column], path: tuple) -> int:
    """The place of a number in an output row."""
    name, component = stored(channel, there)
    if name not in there or (component is not None and there[name].size != 3):
        raise ScenarioError(f"no channel named '{channel}'", known(channel, there), path)
    if there[name].size > 1 and component is None:
        hint = f"Did you mean '{channel}.x'?"
        raise ScenarioError(f"'{channel}' has {there[name].size} components", hint, path)
    return there[name].start + (component or 0)
