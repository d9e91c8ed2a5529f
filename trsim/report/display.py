"""How numbers and runs are called in figures: display units, labels, what differs between runs."""

from collections.abc import Iterator, Mapping
from typing import Any, NamedTuple

from trsim.arrays import Array
from trsim.errors import ScenarioError
from trsim.scenario.shown import replaced
from trsim.store.read import Run
from trsim.units import unit

DEFAULT = {"angle": "deg", "length": "mm"}
COMPARED = ("parameters", "points", "bodies", "joints", "drives", "forces", "contact_laws",
            "gravity", "solver")  # fmt: skip
MINOR = ("contact", "type")  # keys that say nothing where another one differs
SHORT = 0.05  # s: a shorter run is told in ms
MOST = 3  # parameters in a label


class Shown(NamedTuple):
    """A run among others: with the label and the units of its figures."""

    run: Run
    label: str
    units: Mapping[str, tuple[float, str]]  # SI unit -> factor, display unit
    asked: Mapping[str, tuple[float, str]] = {}  # those somebody chose: tables have them, too

    def told(self, si: str) -> tuple[float, str]:
        """Factor and text of the unit in tables: that of figures where one is chosen, else SI."""
        return self.asked.get(si, (1.0, si))

    def unit(self, channel: str) -> str:
        return self.display(self.run.unit(channel))[1]

    def display(self, si: str) -> tuple[float, str]:
        """Factor and text of the display unit of an SI unit."""
        return self.units.get(si, (1.0, written(si)))

    @property
    def time(self) -> Array:
        return self.scaled(self.run.time, "s")

    @property
    def time_label(self) -> str:
        return f"time ({self.display('s')[1]})"

    def values(self, channel: str) -> Array:
        """The rows of a channel in its display unit."""
        return self.scaled(self.run.channel(channel), self.run.unit(channel))

    def scaled(self, values: Any, si: str) -> Any:
        return values * self.display(si)[0]

    def has(self, *channels: str) -> bool:
        return self.run.rows > 0 and all(channel in self.run.units for channel in channels)


def compared(runs: list[Run], asked: Mapping[str, tuple[float, str]] | None = None) -> list[Shown]:
    """The runs with labels that tell them apart, all in the units of the first, or as asked for.

    asked: SI unit -> factor and unit, of an option.
    """
    scenarios = [run.scenario for run in runs]
    given = (scenarios[0].get("report") or {}).get("units") or {}
    chosen = in_si(given) | with_rates(asked or {})
    units = display_units(given)
    if "time" not in given and max(run.summary.get("time", 1.0) for run in runs) < SHORT:
        units["s"] = (1e3, "ms")
    units |= {si: (factor, written(text)) for si, (factor, text) in chosen.items()}
    labels = differences(scenarios) if len(runs) > 1 else [""]
    if len(set(labels)) < len(labels):
        labels = [run.attributes["title"] or run.path.stem for run in runs]
    if len(set(labels)) < len(labels):
        labels = [str(run.path) for run in runs]
    return [Shown(run, label, units, chosen) for run, label in zip(runs, labels, strict=True)]


# --- units -----------------------------------------------------------------------------------


def display_units(chosen: Mapping[str, str]) -> dict[str, tuple[float, str]]:
    """SI unit -> factor and text, for the units chosen in `report: {units: ...}`.

    The unit of length is for sizes and clearances: velocities and accelerations of bodies stay in
    m/s and m/s^2, angles take their unit along to their rates.
    """
    every = in_si({**DEFAULT, **chosen})
    return {si: (factor, written(text)) for si, (factor, text) in every.items()}


def in_si(chosen: Mapping[str, str]) -> dict[str, tuple[float, str]]:
    """SI unit -> factor and unit, for kinds and units; nonsense is left out."""
    found = {}
    for kind, text in chosen.items():
        try:
            found[replaced(kind, text)] = 1.0 / float(unit(text)[0]), text
        except ScenarioError:
            continue
    return with_rates(found)


def with_rates(chosen: Mapping[str, tuple[float, str]]) -> dict[str, tuple[float, str]]:
    """The same with the rates of angles in the unit of angles, unless they have their own."""
    factor, text = chosen.get("rad", (1.0, ""))
    rates = {f"rad{rate}": (factor, text + rate) for rate in ("/s", "/s^2")} if text else {}
    return {**rates, **chosen}


def written(text: str) -> str:
    """A unit as it is printed."""
    return text.replace("^2", "²").replace("*", "\u00b7").replace("^1.5", "$^{1.5}$")


def short(value: float, digits: int = 4) -> str:
    """A number for a reader: never 4.587e+04, a real minus sign."""
    text = f"{value:.0f}" if 10**digits <= abs(value) < 1e7 else f"{value:.{digits}g}"
    return text.replace("-", "\u2212")


# --- what differs ----------------------------------------------------------------------------


def differences(scenarios: list[dict[str, Any]]) -> list[str]:
    """One label per scenario: the entries in which they differ, with their values."""
    flat = [dict(_flat({k: s[k] for k in COMPARED if k in s})) for s in scenarios]
    keys = dict.fromkeys(key for one in flat for key in one)
    differing = [key for key in keys if len({repr(one.get(key)) for one in flat}) > 1]
    major = [key for key in differing if key[-1] not in MINOR] or differing
    return [_label(one, major) for one in flat]


def _flat(data: Any, path: tuple[str, ...] = ()) -> Iterator[tuple[tuple[str, ...], Any]]:
    if isinstance(data, dict):
        for key, value in data.items():
            yield from _flat(value, (*path, key))
    else:
        yield path, data


def _label(one: dict[tuple[str, ...], Any], keys: list[tuple[str, ...]]) -> str:
    """A, B: clearance 0.3 mm; the same value of the same key is told once."""
    same: dict[tuple[str, Any], list[str]] = {}
    for key in keys:
        value = one.get(key, 0 if key[-1] == "clearance" else "-")
        owner = key[-2] if len(key) > 2 else ""
        same.setdefault((key[-1], str(value)), []).append(owner)
    parts = []
    for (name, value), owners in same.items():
        who = ", ".join(owner for owner in owners if owner)
        parts.append(f"{name}{f' at {who}' if who else ''} {value}")
    if len(parts) > MOST:
        return ""
    return "; ".join(parts)
