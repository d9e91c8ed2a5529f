"""Which channels a run records, and the columns they stand in."""

from collections.abc import Iterable
from typing import Any

import numpy as np

from trsim.assemble.asked import is_asked, matches, points_of
from trsim.assemble.instances import Column, Instance
from trsim.assemble.outputs import energy_columns, hear
from trsim.assemble.sections import N_SECTION
from trsim.assemble.switches import CHANNEL, Switches
from trsim.assemble.waves import followed
from trsim.elements.contract import FIRST_ROW, Channel
from trsim.elements.scene import COMPONENTS, Model
from trsim.errors import ScenarioError, known

# units of what is about an axis, and of what is along a line at a distance from it
ALONG = {"N*m": "N", "rad": "m", "rad/s": "m/s", "rad/s^2": "m/s^2"}
# powers of mass, size and speed
NATURAL = {"m": (0, 1, 0), "m/s": (0, 0, 1), "m/s^2": (0, -1, 2)}
NATURAL |= {"N": (1, -1, 2), "J": (1, 0, 2), "W": (1, -1, 3)}
UNKNOWN = (0, 0, 0)
OF_FORCES = ("N", "N*m", "J", "W", "N/m")  # units of what is none where a force does not act
WITH_PEAKS = ("joints", "drives", "forces", "sensors")  # sections whose channels' extremes are told


def no_outputs(rows: int) -> dict[str, Any]:
    """All that tells a model of so many instances what to record: nothing."""
    none = np.zeros(0, np.int64)
    return {
        "wanted": np.full(rows, -1, np.int64),
        "joint_out": none.reshape(0, 4),
        "column_energy": -1,
        "n_out": 0,
        "section": none.reshape(0, N_SECTION),
        "section_at": np.zeros((0, 2)),
        **followed([]),
        "hear": 0,
        "heard": none,
        **dict.fromkeys(("vector", "sought", "kin", "shared", "silent"), none),
        **dict.fromkeys(("lever", "least"), np.zeros(0)),
        "natural": none.reshape(0, 3),
    }


def all_names(instances: Iterable[Instance], jumps: int) -> list[str]:
    """Every channel one may ask for, and the elements that have some."""
    names = []
    for instance in instances:
        recorded = (*instance.channels, *instance.element.reactions)
        channels = [f"{instance.name}.{c.name}" for c in recorded if c.name]
        names += [instance.name, *channels] if channels else []
    return names + [f"energy.{name}" for name in energy_columns(jumps)]


def layout(
    scenario: Any, model: Model, instances: list[Instance], switches: Switches
) -> tuple[dict[str, Any], list[Column]]:
    """The fields of a model that tell of its outputs, and the columns."""
    patterns, shown = tuple(scenario.output.channels), points_of(scenario)
    columns: list[Column] = []
    wanted = model.wanted.copy()
    joints: list[tuple[int, ...]] = []
    width = 0

    def asked(names: list[str]) -> list[bool]:
        return [is_asked(name, patterns) for name in names]

    def add(name: str, channel: Channel, wanted: bool, extra: bool = False) -> None:
        nonlocal width
        _, unit, meaning, size, least, turn, _ = channel
        columns.append(Column(name, unit, meaning, width, size, wanted, extra, least, turn))
        width += size

    read: set[str] = set()  # sensors that formulas need which are needed
    for instance in reversed(instances):
        if instance.section == "sensors" and instance.row.reads:
            own = [f"{instance.name}.{c.name}".rstrip(".") for c in instance.channels]
            if instance.name in read or any(asked(own)) or not shown.isdisjoint(own):
                read |= instance.row.reads

    for e, instance in enumerate(instances):
        channels = instance.channels
        if not channels:
            continue
        names = [f"{instance.name}.{c.name}" if c.name else instance.name for c in channels]
        told = asked(names)
        # contacts are always measured: their peaks and steps are part of every result
        anyway = any(told) or instance.row.contact is not None
        needs = not shown.isdisjoint(names) or (
            instance.section == "sensors" and instance.name in read
        )
        if anyway or needs or instance.element.judged(instance.row):
            wanted[e] = width
            for name, channel, one in zip(names, channels, told, strict=True):
                add(name, channel, one, extra=not anyway)
    for e, instance in enumerate(instances):
        channels = instance.element.reactions
        names = [f"{instance.name}.{c.name}" for c in channels]
        told = asked(names)
        if any(told) or not shown.isdisjoint(names):
            joints.append((e, FIRST_ROW, len(instance.element.rows), width))
            for name, channel, one in zip(names, channels, told, strict=True):
                add(name, channel, one, extra=not any(told))
    energy = width
    book = energy_columns(model.jumps)
    for name, one in zip(book, asked([f"energy.{name}" for name in book]), strict=True):
        add(f"energy.{name}", Channel(name, "J", "energy book"), one)
    unused = [p for p in patterns if not any(matches(c.name, (p,)) for c in columns)]
    if unused:
        raise ScenarioError(
            f"no channel matches '{unused[0]}'",
            known(unused[0], all_names(instances, model.jumps)),
            ("output", "channels", patterns.index(unused[0])),
        )
    fields = {
        "wanted": wanted,
        "joint_out": np.array(joints, np.int64).reshape(-1, 4),
        "column_energy": energy,
        "n_out": width,
        **compared(columns, of_peaks(instances), model.size),
        **watched(columns, switches),
    }
    return fields, columns


def watched(columns: list[Column], switches: Switches) -> dict[str, Any]:
    """The columns that user events watch."""
    if all(event.kind != CHANNEL for event in switches.events):
        return {"heard": np.zeros(0, np.int64), "hear": 0}
    there = {column.name: column.start for column in columns}
    found = []
    for event in switches.events:
        stem = event.when if event.when in there else event.when[:-2]
        place = COMPONENTS.get(event.when[len(stem) :], 0)
        heard = event.kind == CHANNEL and stem in there
        found.append(there[stem] + place if heard else -1)
    return {"heard": np.array(found, np.int64), "hear": hear.address()}


def columns_of_forces(
    columns: list[Column], instances: Iterable[Instance]
) -> dict[str, tuple[int, ...]]:
    """Of every force the columns that are zero where it does not act."""
    found: dict[str, tuple[int, ...]] = {}
    names = {instance.name for instance in instances if instance.section == "forces"}
    for column in columns:
        name = column.name.split(".")[0]
        if name in names and column.unit in OF_FORCES:
            own = range(column.start, column.start + column.size)
            found[name] = (*found.get(name, ()), *own)
    return found


def of_peaks(instances: Iterable[Instance]) -> set[str]:
    """The elements whose channels have a line in the table of peaks."""
    return {instance.name for instance in instances if instance.section in WITH_PEAKS}


def compared(columns: list[Column], told: set[str], size: float) -> dict[str, Any]:
    """Vectors whose magnitudes have extremes of their own, and which channels are of one kind.

    told: elements whose extremes are looked for between samples.  Those of the others, which nobody
    is told, are of the samples.  size: of the mechanism, m; what is about an axis is of one kind
    with what is along a line at that distance.
    """
    units: dict[str, int] = {}
    kin: list[int] = []
    levers: list[float] = []
    least: list[float] = []
    shared: list[int] = []

    by_unit = dict.fromkeys(ALONG, size) | {"N*m": 1.0 / size}

    def of_kind(column: Column) -> int:
        return units.setdefault(ALONG.get(column.unit, column.unit), len(units))

    def lever(column: Column) -> float:
        return by_unit.get(column.unit, 1.0)

    for column in columns:
        number = column.size
        sought = not column.for_points and column.name.partition(".")[0] in told
        kin += [of_kind(column) if sought else -1] * number
        levers += [lever(column)] * number
        least += [column.least] * number
        if column.unit in ("N", "N*m"):
            shared += range(column.start, column.start + number)
    vectors = [c for c in columns if is_vector(c)]
    # their numbers stand already: each has a column of the same unit
    kin += [kin[column.start] for column in vectors]
    turns = [c for c in columns if c.turn]  # judged in any run: behind those that are told
    kin += [of_kind(column) for column in turns]
    vectors += turns
    levers += [lever(column) for column in vectors]
    least += [0.0 for _ in vectors]
    those = [k for k, number in enumerate(kin) if number >= 0]
    return {
        "vector": np.array([column.start for column in vectors], np.int64),
        "sought": np.array(those, np.int64),
        "kin": np.array([kin[k] for k in those], np.int64),
        "lever": np.array([levers[k] for k in those]),
        "least": np.array([least[k] for k in those]),
        "natural": np.array([NATURAL.get(unit, UNKNOWN) for unit in units], np.int64).reshape(
            -1, 3
        ),
        "shared": np.array(shared, np.int64),
    }


def is_vector(column: Column) -> bool:
    """Whether the extremes of a channel are those of its magnitude as well."""
    of_rows = column.size == 3 and column.wanted
    return of_rows and column.name.rpartition(".")[2].startswith("reaction")
