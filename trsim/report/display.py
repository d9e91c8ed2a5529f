"""How numbers and runs are called in figures: display units, labels, what differs between runs."""

from collections.abc import Iterator, Mapping
from typing import Any, NamedTuple

from trsim.arrays import Array
from trsim.errors import ScenarioError
from trsim.scenario.shown import replaced
from trsim.store.read import Run
from trsim.units import quantity, unit

DEFAULT = {"angle": "deg", "length": "mm"}
ASIDE = ("title", "report", "limits", "cases", "sweep")  # of a scenario; a run is the same without
MINOR = ("contact", "type")  # keys that say nothing where another one comes or goes with them
PLAIN = ("parameters", "points", "solver")  # sections whose entries are known by their names alone
SHORT = 0.05  # s: a shorter run is told in ms
MOST = 3  # parameters in a label
LONGEST = 40  # letters of a value in a label

Entry = tuple[str, ...]  # the way to a value of a scenario


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
    given = (runs[0].scenario.get("report") or {}).get("units") or {}
    chosen = in_si(given) | with_rates(asked or {})
    units = display_units(given)
    if "time" not in given and max(run.summary.get("time", 1.0) for run in runs) < SHORT:
        units["s"] = (1e3, "ms")
    units |= {si: (factor, written(text)) for si, (factor, text) in chosen.items()}
    labels = told_apart(runs) if len(runs) > 1 else [""]
    return [Shown(run, label, units, chosen) for run, label in zip(runs, labels, strict=True)]


def told_apart(runs: list[Run]) -> list[str]:
    """A label for each run: all that differs, or its title, or its file."""
    labels = differences([run.scenario for run in runs])
    if not all(labels) or len(set(labels)) < len(labels):
        labels = [run.attributes["title"] or run.path.stem for run in runs]
    if len(set(labels)) < len(labels):
        labels = [str(run.path) for run in runs]
    return labels


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
    return text.replace("^2", "²").replace("*", "\u00b7").replace("^1.5", raised("1.5"))


def raised(text: str) -> str:
    """A number as an exponent, in letters that need no mathematics."""
    return text.translate(str.maketrans("0123456789.-", "⁰¹²³⁴⁵⁶⁷⁸⁹\u00b7⁻"))


def short(value: float, digits: int = 4) -> str:
    """A number for a reader: never 4.587e+04, a real minus sign."""
    text = f"{value:.0f}" if 10**digits <= abs(value) < 1e7 else f"{value:.{digits}g}"
    return text.replace("-", "\u2212")


# --- what differs ----------------------------------------------------------------------------


def differences(scenarios: list[dict[str, Any]]) -> list[str]:
    """One label per scenario: all entries in which they differ, with their values; empty ones
    where these are too many or too long for a label."""
    flat = [dict(_flat({k: v for k, v in s.items() if k not in ASIDE})) for s in scenarios]
    keys = dict.fromkeys(key for one in flat for key in one)
    differing = [key for key in keys if len({repr(_meant(one.get(key))) for one in flat}) > 1]
    major = [key for key in differing if key[-1] not in MINOR]
    told = [key for key in differing if key in major or not _implied(key, major, flat)]
    return [_label(one, told) for one in flat]


def _meant(value: Any) -> Any:
    """A value as it counts, however it was written: 1kg, 1 kg and 1 are the same mass."""
    if isinstance(value, list):
        return [_meant(one) for one in value]
    if isinstance(value, str):
        try:
            found = quantity(value)
        except ScenarioError:
            return value
        return value if found is None else found[0]
    return float(value) if isinstance(value, int) and not isinstance(value, bool) else value


def _implied(key: Entry, major: list[Entry], flat: list[dict[Entry, Any]]) -> bool:
    """Whether an entry changes only as another one of its element comes or goes."""
    return any(
        len({(other in one, repr(one.get(key))) for one in flat})
        == len({other in one for one in flat})
        for other in major
        if other[:-1] == key[:-1]
    )


def _flat(data: Any, path: Entry = ()) -> Iterator[tuple[Entry, Any]]:
    if isinstance(data, dict):
        for key, value in data.items():
            yield from _flat(value, (*path, key))
    else:
        yield path, data


def _label(one: dict[Entry, Any], keys: list[Entry]) -> str:
    """A, B: clearance 0.3 mm; the same value of the same key is told once."""
    same: dict[tuple[str, str], list[str]] = {}
    for key in keys:
        value = str(one.get(key, 0 if key[-1] == "clearance" else "-"))
        if len(value) > LONGEST:
            return ""
        same.setdefault((_word(key), value), []).append(".".join(map(str, key[1:-1])))
    parts = []
    for (name, value), owners in same.items():
        who = ", ".join(owner for owner in owners if owner)
        parts.append(f"{name}{f' at {who}' if who else ''} {value}")
    if len(parts) > MOST:
        return ""
    return "; ".join(parts)


def _word(key: Entry) -> str:
    """What an entry is called: `clearance`, `end`, but `initial pivot`, `output every`."""
    bare = len(key) == 1 or key[0] in PLAIN or (len(key) > 2 and key[0] != "initial")
    return str(key[-1]) if bare else f"{key[0]} {key[-1]}"
