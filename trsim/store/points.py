"""Points of a run: phase portraits and Poincare sections, as the scenario declares them.

A phase portrait is one channel over another; a section is two channels at the times a third one
crosses zero.  Until the solver locates the crossings they come from the cubic through the four
output rows around each sign change.
"""

from collections.abc import Iterator
from typing import Any, NamedTuple

import h5py
import numpy as np
from numpy.typing import NDArray

from trsim.errors import ScenarioError, known

Array = NDArray[np.float64]

INTERPOLATED = "interpolated from output rows"
COMPONENTS = {".x": 0, ".y": 1, ".z": 2}
ROWS = 1 << 16  # rows looked at together


class Portrait(NamedTuple):
    """One channel over another."""

    name: str
    x: str
    y: str


class Section(NamedTuple):
    """Two channels where a third one crosses zero."""

    name: str
    when: str
    crosses: str
    x: str
    y: str


class Plan(NamedTuple):
    """What a run stores besides its rows, and the columns that needs."""

    portraits: tuple[Portrait, ...]
    sections: tuple[Section, ...]
    columns: frozenset[str]


def plan(scenario: Any, mechanism: Any) -> Plan:
    """The portraits and sections of a scenario.  Raises ScenarioError for unknown channels."""
    sizes = {column.name: column.size for column in mechanism.columns}
    portraits = [
        Portrait(name, _found(spec.x, sizes, ("phase_portraits", name, "x")),
                 _found(spec.y, sizes, ("phase_portraits", name, "y")))
        for name, spec in (getattr(scenario, "phase_portraits", None) or {}).items()
    ]  # fmt: skip
    sections = []
    for name, spec in (getattr(scenario, "poincare", None) or {}).items():
        when = _found(spec.when, sizes, ("poincare", name, "when"))
        x, y = (_found(c, sizes, ("poincare", name, "plot", k)) for k, c in enumerate(spec.plot))
        sections.append(Section(name, when, spec.crosses, x, y))
    needed = [c for p in portraits for c in p[1:]] + [c for s in sections for c in (s.when, *s[3:])]
    portraits = portraits or _default(scenario, mechanism)
    return Plan(tuple(portraits), tuple(sections), frozenset(split(c, sizes)[0] for c in needed))


def split(channel: str, sizes: Any) -> tuple[str, int | None]:
    """The stored channel and the component that `channel` names."""
    if channel not in sizes and channel[-2:] in COMPONENTS and sizes.get(channel[:-2]) == 3:
        return channel[:-2], COMPONENTS[channel[-2:]]
    return channel, None


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


def declare(file: h5py.File, planned: Plan) -> None:
    """The groups with their definitions; portraits of scalar channels are links to them."""
    phase, poincare = file.create_group("phase"), file.create_group("poincare")
    for portrait in planned.portraits:
        group = phase.create_group(portrait.name)
        group.attrs.update({"x": portrait.x, "y": portrait.y})
        if portrait.x in file and portrait.y in file:
            group["time"] = file["time"]
            group["x"], group["y"] = file[portrait.x], file[portrait.y]
    for section in planned.sections:
        group = poincare.create_group(section.name)
        group.attrs.update(section._asdict())
        group.attrs["method"] = INTERPOLATED


def complete(file: h5py.File, planned: Plan) -> None:
    """Fill in the points, once all rows are there."""
    for portrait in planned.portraits:
        group = file["phase"][portrait.name]
        if "x" not in group:
            group["time"] = file["time"]
            for axis, channel in (("x", portrait.x), ("y", portrait.y)):
                points = [part[axis] for part in _parts(file, {axis: channel})]
                _store(file, group, axis, channel, points)
    for section in planned.sections:
        group = file["poincare"][section.name]
        channels = {"when": section.when, "x": section.x, "y": section.y}
        found = [crossings(part, section.crosses) for part in _parts(file, channels, overlap=3)]
        _store(file, group, "time", "time", [part["time"] for part in found])
        for axis, channel in (("x", section.x), ("y", section.y)):
            _store(file, group, axis, channel, [part[axis] for part in found])
            group[axis].dims[0].attach_scale(group["time"])


def _parts(
    file: h5py.File, channels: dict[str, str], overlap: int = 0
) -> Iterator[dict[str, Array]]:
    """Stretches of the rows of some channels, each sharing a few rows with the one before."""
    sizes = {name: item.shape[1] if item.ndim == 2 else 1 for name, item in _datasets(file)}
    n = len(file["time"])
    for k in range(0, max(n, 1), ROWS):
        begin, end = max(k - overlap, 0), min(k + ROWS, n)
        part = {"time": file["time"][begin:end], "first": begin == 0, "last": end == n}
        for axis, channel in channels.items():
            stored, component = split(channel, sizes)
            rows = file[stored][begin:end]
            part[axis] = rows if component is None else rows[:, component]
        yield part


def _datasets(file: h5py.File) -> Iterator[tuple[str, h5py.Dataset]]:
    return ((name, item) for name, item in file.items() if isinstance(item, h5py.Dataset))


def _store(file: h5py.File, group: h5py.Group, axis: str, channel: str, parts: list[Array]) -> None:
    data = np.concatenate(parts) if parts else np.zeros(0)
    dataset = group.create_dataset(axis, data=data, chunks=(4096,), maxshape=(None,),
                                   fletcher32=True)  # fmt: skip
    if axis == "time":
        dataset.make_scale("time")
    source = file[channel if channel in file else channel[:-2]]
    dataset.attrs["units"] = source.attrs["units"]
    dataset.attrs["long_name"] = channel


# --- crossings -------------------------------------------------------------------------------


def crossings(part: dict[str, Any], crosses: str) -> dict[str, Array]:
    """Times, x and y of the zero crossings of `when` in rows of one stretch.

    Between two stretches that share three rows, each crossing belongs to exactly one of them: to
    the one in which its four rows lie, the first and the last interval of a run excepted.
    """
    time, w = part["time"], part["when"]
    n = len(time)
    if n < 2:
        return {axis: np.zeros(0) for axis in ("time", "x", "y")}
    up, down = (w[:-1] < 0.0) & (w[1:] >= 0.0), (w[:-1] > 0.0) & (w[1:] <= 0.0)
    k = np.flatnonzero({"up": up, "down": down}.get(crosses, up | down))
    k = k[((k >= 1) | part["first"]) & ((k <= n - 3) | part["last"])]
    four = np.clip(k - 1, 0, max(n - 4, 0))[:, None] + np.arange(min(4, n))
    lever = (time[four] - time[k][:, None]) / (time[k + 1] - time[k])[:, None]
    root = _roots(lever, w[four])
    weight = _lagrange(lever, root)
    return {
        "time": time[k] + root * (time[k + 1] - time[k]),
        "x": np.sum(weight * part["x"][four], axis=1),
        "y": np.sum(weight * part["y"][four], axis=1),
    }


def _roots(u: Array, w: Array) -> Array:
    """Where in 0..1 the polynomials through (u, w) are zero, by bisection."""
    low, high = np.zeros(len(u)), np.ones(len(u))
    sign = np.sign(np.sum(_lagrange(u, high) * w, axis=1))
    for _ in range(52):
        middle = 0.5 * (low + high)
        right = np.sign(np.sum(_lagrange(u, middle) * w, axis=1)) == sign
        low, high = np.where(right, low, middle), np.where(right, middle, high)
    return 0.5 * (low + high)


def _lagrange(u: Array, at: Array) -> Array:
    """Weights of the values at u in the polynomial's value, one row per polynomial."""
    weight = np.ones_like(u)
    for i in range(u.shape[1]):
        for j in range(u.shape[1]):
            if i != j:
                weight[:, i] *= (at - u[:, j]) / (u[:, i] - u[:, j])
    return weight
