"""Which channels a run records, and the columns they stand in."""

from fnmatch import fnmatchcase
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np

from trsim.assemble.outputs import ENERGY_COLUMNS
from trsim.elements.contract import FIRST_ROW
from trsim.elements.scene import Model
from trsim.errors import ScenarioError, known

if TYPE_CHECKING:
    from trsim.assemble.addresses import Addresses
    from trsim.assemble.mechanism import Instance

NOT_BY_DEFAULT = ("*.rotation",)


class Column(NamedTuple):
    """One channel of the output rows."""

    name: str
    unit: str
    meaning: str
    start: int
    size: int
    wanted: bool


def matches(name: str, patterns: tuple[str, ...]) -> bool:
    """Whether a channel is asked for: by name, by pattern, or by the name of its element."""
    return any(fnmatchcase(name, p) or name.startswith(p + ".") for p in patterns)


def units(instance: "Instance", unit: str, at: "Addresses") -> str:
    """Units that depend on whether a joint turns or slides."""
    if unit in ("coordinate", "coordinate/s", "coordinate/s^2", "drive"):
        spec = getattr(at.scenario, instance.section).get(instance.name)
        x = at.coordinate(spec.joint) if spec and spec.joint else None
        # no joint: a stop of a point on a wall, or a drive made for the start of a run
        own = "rad" if x is not None and x.kind == "angle" else "m"
        return {"drive": "N*m" if own == "rad" else "N"}.get(unit, unit.replace("coordinate", own))
    return unit


def all_names(instances: list["Instance"]) -> list[str]:
    """Every channel one may ask for, and the elements that have some."""
    names = []
    for instance in instances:
        channels = [f"{instance.name}.{c.name}" for c in instance.element.channels if c.name]
        if instance.section == "joints" and instance.element.rows:
            channels += [f"{instance.name}.reaction", f"{instance.name}.reaction_moment"]
        names += [instance.name, *channels] if channels else []
    return names + [f"energy.{name}" for name in ENERGY_COLUMNS]


def layout(
    scenario: Any, model: Model, instances: list["Instance"], at: "Addresses", planar: bool
) -> tuple[Model, list[Column]]:
    """The model with its output tables filled, and the columns."""
    patterns = tuple(scenario.output.channels)
    columns: list[Column] = []
    wanted = model.wanted.copy()
    joints: list[tuple[int, ...]] = []
    width = 0

    def asked(name: str) -> bool:
        if patterns == ("*",):
            return not matches(name, NOT_BY_DEFAULT)
        return matches(name, patterns)

    def add(name: str, unit: str, meaning: str, size: int) -> None:
        nonlocal width
        columns.append(Column(name, unit, meaning, width, size, asked(name)))
        width += size

    for e, instance in enumerate(instances):
        channels = instance.element.channels
        names = [f"{instance.name}.{c.name}" if c.name else instance.name for c in channels]
        # contacts are always measured: their peaks and steps are part of every result
        if names and (any(map(asked, names)) or instance.row.contact):
            wanted[e] = width
            for name, channel in zip(names, channels, strict=True):
                add(name, units(instance, channel.unit, at), channel.meaning, channel.size)
    for e, instance in enumerate(instances):
        number = len(instance.element.rows)
        if instance.section != "joints" or not number:
            continue
        name = f"{instance.name}.reaction"
        if asked(name) or asked(name + "_moment"):
            joints.append((e, FIRST_ROW, number, width))
            add(name, "N", "constraint force on the second body, world axes", 3)
            add(name + "_moment", "N*m", "constraint moment on the second body at the joint", 3)
    energy = width
    for name in ENERGY_COLUMNS:
        add(f"energy.{name}", "J", "energy book", 1)
    unused = [p for p in patterns if not any(matches(c.name, (p,)) for c in columns)]
    if unused:
        raise ScenarioError(
            f"no channel matches '{unused[0]}'",
            known(unused[0], all_names(instances)),
            ("output", "channels"),
        )
    filled = model.replaced(
        wanted=wanted,
        joint_out=np.array(joints, np.int64).reshape(-1, 4),
        column_energy=energy,
        n_out=width,
    )
    return filled, columns
