"""Points of a run: phase portraits, Poincare sections, impact maps, journal orbits.

phase/NAME     x, y        one channel over another, at the output rows
poincare/NAME  time, x, y  two channels where the motion passes a surface, as the solver
                           located it; and at the end how far the points are apart
impact/NAME    time, angle, speed    of every touch of a joint with clearance, from the events
orbit/NAME     rows, steps           time, x, y of its journal, at the output rows and at the
                                     steps in touch: links to where they are stored
"""

import math
from collections.abc import Mapping
from typing import Any, NamedTuple

import h5py
import numpy as np
from h5py import h5s

from trsim.arrays import Array
from trsim.elements.scene import COMPONENTS
from trsim.errors import ScenarioError, known
from trsim.store import made, torn
from trsim.store.grow import Field, Growing
from trsim.store.made import Book, Layout

LOCATED = "located on the dense output of the step"
EXPECTED = 256  # points
TIME, SECTION, X, Y = range(4)  # columns of a block of points, see solve/march/record.py
JOURNAL = ("eccentricity_x", "eccentricity_y")


class Portrait(NamedTuple):
    """One channel over another."""

    name: str
    x: str
    y: str


class Plan(NamedTuple):
    """What a run stores besides its rows, and the columns of rows that needs."""

    portraits: tuple[Portrait, ...]
    sections: tuple[Any, ...]  # of assemble/mechanism.py
    columns: frozenset[str]


class Dispersion(NamedTuple):
    """How far the points of a section lie apart: root mean squares about their mean.

    points  how many
    x       in the unit of the channel; none without points
    y       the same
    radius  root of the sum of both squares; none where x and y have different units
    """

    points: int
    x: float
    y: float
    radius: float


class Points(NamedTuple):
    """A phase portrait or a Poincare section."""

    definition: Mapping[str, Any]
    time: Array
    x: Array
    y: Array
    x_unit: str
    y_unit: str

    @property
    def dispersion(self) -> Dispersion:
        """How far the points lie apart."""
        return dispersion(self.x, self.y, self.x_unit == self.y_unit)


class Impacts(NamedTuple):
    """The touches of a joint with clearance."""

    time: Array  # s
    angle: Array  # rad, of the contact point around the bearing
    speed: Array  # m/s, of approach


def plan(scenario: Any, mechanism: Any) -> Plan:
    """The portraits and sections of a run.  Raises ScenarioError for unknown channels."""
    from trsim.assemble.sections import without_play  # nobody who reads a file needs mechanisms

    sizes = {column.name: column.size for column in mechanism.columns}
    portraits = [
        Portrait(name, _found(spec.x, sizes, ("phase_portraits", name, "x")),
                 _found(spec.y, sizes, ("phase_portraits", name, "y")))
        for name, spec in scenario.phase_portraits.items()
        if not without_play(scenario, (spec.x, spec.y))
    ]  # fmt: skip
    needed = frozenset(split(channel, sizes)[0] for p in portraits for channel in p[1:])
    portraits = portraits or _default(scenario, mechanism)
    return Plan(tuple(portraits), mechanism.sections, needed)


def surface(definition: Any) -> str:
    """The surface of a section in words, from its attributes."""
    if definition.get("every"):
        return f"every {definition['every']:.6g} s"
    if definition.get("at_onset"):
        return f"at each touch of {definition['at_onset']}"
    direction = {"up": " upwards", "down": " downwards"}.get(definition["crosses"], "")
    return f"{definition['when']} crosses zero{direction}"


def dispersion(x: Array, y: Array, alike: bool) -> Dispersion:
    """The dispersion of some points; `alike` says whether x and y have one unit."""
    if not len(x):
        return Dispersion(0, np.nan, np.nan, np.nan)
    own = float(np.std(x)), float(np.std(y))
    return Dispersion(len(x), *own, float(np.hypot(*own)) if alike else np.nan)


def split(channel: str, sizes: Any) -> tuple[str, int | None]:
    """The stored channel and the component that `channel` names."""
    if channel not in sizes and channel[-2:] in COMPONENTS and sizes.get(channel[:-2]) == 3:
        return channel[:-2], COMPONENTS[channel[-2:]]
    return channel, None


def between_bars(name: str) -> str | None:
    """V of `|V|`, the magnitude of a vector; None of any other name."""
    return name[1:-1] if len(name) > 2 and name[0] == name[-1] == "|" else None


def _found(channel: str, sizes: dict[str, int], path: tuple) -> str:
    stored, component = split(channel, sizes)
    if stored not in sizes:
        raise ScenarioError(f"no channel named '{channel}'", known(channel, sizes), path)
    if sizes[stored] > 1 and component is None:
        hint = f"Did you mean '{channel}.x'?"
        raise ScenarioError(f"'{channel}' has {sizes[stored]} components", hint, path)
    return channel


def _default(scenario: Any, mechanism: Any) -> list[Portrait]:
    """Rate over value of every sensor; the journal's of every joint with clearance."""
    wanted = {column.name for column in mechanism.columns if column.wanted}
    pairs = [(name, name, f"{name}.rate") for name in scenario.sensors]
    pairs += [
        (i.name, f"{i.name}.eccentricity_x", f"{i.name}.eccentricity_x_rate")
        for i in mechanism.instances
    ]
    return [Portrait(*pair) for pair in pairs if {pair[1], pair[2]} <= wanted]


# --- in the file -----------------------------------------------------------------------------


def declare(book: Book, planned: Plan) -> list[Growing]:
    """The groups with their definitions, portraits of scalar channels as links; the tables."""
    there = {*book.told, *(book.file or ())}
    for name in ("phase", "poincare", "impact", "orbit"):
        if name not in there:
            book.group(name)
    for portrait in planned.portraits:
        path = book.group(f"phase/{portrait.name}")
        book.attributes(path, {"x": portrait.x, "y": portrait.y})
        if {portrait.x, portrait.y} <= there:
            for axis, source in (("time", "time"), ("x", portrait.x), ("y", portrait.y)):
                book.link(f"{path}/{axis}", source)
    return [_table(book, section) for section in planned.sections]


def _table(book: Book, section: Any) -> Growing:
    """The growing table of a section."""
    path = book.group(f"poincare/{section.name}")
    book.attributes(path, defined(section))
    fields = [
        Field("time", "s", "simulated time", TIME),
        Field("x", section.x_unit, section.x, X),
        Field("y", section.y_unit, section.y, Y),
    ]
    return Growing(book, path, fields, (4, EXPECTED))


def defined(section: Any) -> dict[str, Any]:
    """What a section is of."""
    told = {key: getattr(section, key) for key in ("when", "crosses", "every", "at_onset")}
    told = {key: value for key, value in told.items() if value}
    return told | {"x": section.x, "y": section.y, "after": section.after, "method": LOCATED}


def complete(book: Book, planned: Plan) -> None:
    """What is known only at the end, or follows from what is there."""
    file = book.file
    for portrait in planned.portraits:
        path = f"phase/{portrait.name}"
        if f"{path}/x" not in book.links:
            book.link(f"{path}/time", "time")
            _store(book, f"{path}/x", portrait.x)
            _store(book, f"{path}/y", portrait.y)
    for name in file["poincare"]:
        x, y = f"poincare/{name}/x", f"poincare/{name}/y"
        alike = book.said(x, "units") == book.said(y, "units")
        spread = dispersion(book.rows(x)[:], book.rows(y)[:], alike)
        told = {f"dispersion_{word}": value for word, value in spread._asdict().items()}
        book.attributes(f"poincare/{name}", {n: v for n, v in told.items() if v == v})
    for name in file["steps"]:
        if all(book.has(f"steps/{name}/{channel}") for channel in JOURNAL):
            _journal(book, name)


def _journal(book: Book, name: str) -> None:
    """Touches and orbit of a joint with clearance."""
    path = book.group(f"impact/{name}")
    kind, element = (book.rows(f"events/{word}")[:] for word in ("kind", "element"))
    onset = np.flatnonzero((kind == b"onset") & (element == name.encode()))
    for axis in ("time", "angle", "speed"):
        source = f"events/{axis}"
        told = {key: book.said(source, key) for key in ("units", "long_name")}
        _kept(book, f"{path}/{axis}", book.rows(source)[:][onset], EXPECTED, told)
    book.scale(f"{path}/time", "time")
    book.attach([(f"{path}/{axis}", (f"{path}/time",)) for axis in ("angle", "speed")])
    rows = [f"{name}.{channel}" for channel in JOURNAL]
    sources = {"steps": [f"steps/{name}/{channel}" for channel in ("time", *JOURNAL)]}
    if all(book.has(channel) for channel in rows):
        sources["rows"] = ["time", *rows]
    orbit = book.group(f"orbit/{name}")
    for part, paths in sources.items():
        inner = book.group(f"{orbit}/{part}")
        for axis, source in zip(("time", "x", "y"), paths, strict=True):
            book.link(f"{inner}/{axis}", source)


def _store(book: Book, path: str, channel: str) -> None:
    """The rows of a channel, or of a component, as a dataset of its own."""
    file = book.file
    sizes = {n: math.prod(d.shape[1:]) for n, d in file.items() if isinstance(d, h5py.Dataset)}
    name, component = split(channel, sizes)
    source, n = file[name], len(file["time"])
    data = source[:n] if component is None else source[:n, component]
    told = {"units": source.attrs["units"], "long_name": channel}
    _kept(book, path, data, 4096, told)


def _kept(book: Book, path: str, data: Array, chunk: int, told: dict[str, Any]) -> None:
    """A dataset with numbers that are known."""
    book.dataset(path, "f8", Layout(data.shape, (chunk,)))
    if len(data):
        book.item(path).write(h5s.ALL, h5s.ALL, np.ascontiguousarray(data), made.memory(data.dtype))
    book.attributes(path, told)


# --- out of it --------------------------------------------------------------------------------


def stored(group: h5py.Group) -> Points:
    """The points of a group, also while it is written."""
    n = min(len(group[axis]) for axis in ("time", "x", "y"))
    table = np.array([torn.rows(group[axis], 0, n) for axis in ("time", "x", "y")])
    table = table[:, ~np.isnan(table).any(axis=0)]  # room that a killed writer never filled
    units = str(group["x"].attrs["units"]), str(group["y"].attrs["units"])
    return Points(plain(group.attrs), table[0], table[1], table[2], *units)


def plain(attributes: Any) -> dict[str, Any]:
    """Attributes as Python's own numbers and texts."""
    return {n: v.item() if isinstance(v, np.generic) else v for n, v in attributes.items()}
