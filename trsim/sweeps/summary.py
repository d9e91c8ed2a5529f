"""What a sweep keeps of a case whose rows it does not keep: numbers, extremes, events, sections.

A record is made by the same functions that answer questions about a result file (outputs.py), so a
number of it is to the bit the number that the file of the same case gives:

    channels      mean, rms, std, final, peak, least, range of every channel and component
    contacts      flight, contact, following, impacts, onsets, between of every contact
    asked         fluctuations of the rates of sensors, largest magnitudes of reactions, and what
                  `sweep: numbers:` names
    peaks         the table of extremes, with their times and strokes
    events        the first EVENTS of them
    sections      the first POINTS of each Poincare section
    summary, solver   as a result file has them

Its sha256 tells whether two runs gave the same.
"""

import base64
import gzip
import hashlib
import json
import math
import zlib
from collections.abc import Iterable, Iterator
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np

from trsim.analyse.extremes import LARGEST, MAGNITUDE, SMALLEST
from trsim.analyse.fluctuation import shows
from trsim.analyse.outputs import OF_SHARES, of_shares, scalar
from trsim.analyse.window import Window, window
from trsim.arrays import Array
from trsim.errors import TrsimError, UsageError
from trsim.store.grow import components
from trsim.store.peaks import Peak
from trsim.store.points import Points
from trsim.store.read import Events, Part, Run

EVENTS, POINTS = 1000, 2000  # that are kept of a case, of a section
OF_CHANNELS = ("mean", "rms", "std", "final", "peak", "least", "range")
OF_ROWS = (*OF_CHANNELS, "fluctuation")
OF_CONTACTS = tuple(OF_SHARES)
# what tells records of this form from those of another one
EVERY = ("form 1", *OF_CHANNELS, *OF_CONTACTS, str(EVENTS), str(POINTS))
LEVEL = 3  # of gzip: half the time of level 6 for 6 % more
AT_ONCE = 1 << 16  # values of channels that are looked at together: they stay in the cache


def record(run: Run, asked: Iterable[str] = ()) -> dict[str, Any]:
    """What is kept of a run; asked: numbers by their words, besides those kept of every run."""
    whole = window(run) if run.rows else Window(0.0, 0.0)
    events = run.events
    return {
        "attributes": {name: run.attributes[name] for name in ("title", "status", "reason")},
        "rows": run.rows,
        "ends": run.time[[0, -1]].tolist() if run.rows else [],
        "units": dict(run.units),
        "report": run.scenario.get("report"),
        "parts": {name: list(part) for name, part in run.parts.items()},
        "sizes": {name: size for name, size in run.sizes.items() if size != 1},
        "channels": of_channels(run) if run.rows else {},
        "contacts": {
            name: of_shares(run, name, whole, OF_CONTACTS) for name in run.contacts
        } if run.rows else {},
        "asked": {word: list(number(run, word)) for word in (*usual(run), *asked)},
        "peaks": [list(peak) for peak in run.peaks],
        "events": {
            name: column[:EVENTS].tolist() for name, column in events._asdict().items()
        } | {"all": len(events.time)},
        "sections": {
            name: {
                "definition": _defined(p), "units": [p.x_unit, p.y_unit], "all": len(p.time),
                "points": [column[:POINTS].tolist() for column in (p.time, p.x, p.y)],
            } for name, p in run.poincare.items()
        },
        "summary": run.summary,
        "solver": run.group("solver"),
    }  # fmt: skip


def usual(run: Run) -> list[str]:
    """The words for magnitudes, and for fluctuations of sensors' rates where the rows show them."""
    found = [f"peak:|{peak.channel}|" for peak in run.peaks if peak.extreme == MAGNITUDE]
    sensors = [name for name, part in run.parts.items() if part.section == "sensors"]
    rates = [f"{name}.rate" for name in sensors if run.sizes.get(f"{name}.rate") == 1]
    return found + ([f"fluctuation:{rate}" for rate in rates] if rates and shows(run.time) else [])


def of_channels(run: Run) -> dict[str, list[float]]:
    """The numbers OF_CHANNELS of every channel and component, as outputs.py defines them."""
    kept = {(peak.channel, peak.extreme): peak.value for peak in run.peaks}
    steps = {contact: run.steps(contact) for contact in run.contacts}
    found: dict[str, list[float]] = {}
    for channels in several(run):
        names = [name for c in channels for name in components(c, run.sizes[c])]
        rows, n = np.empty((run.rows, len(names)), order="F"), 0
        at = {}
        for channel in channels:
            at[channel] = columns = slice(n, n := n + run.sizes[channel])
            rows[:, columns] = run.channel(channel).reshape(run.rows, -1)
        means, peak, least = by_columns(rows)
        for channel, columns in at.items():
            contact, _, own = channel.rpartition(".")
            touch = steps.get(contact, {}).get(own)  # values at the accepted steps in touch
            if touch is not None:
                touch = touch.reshape(len(touch), run.sizes[channel])  # none: it never touched
                peak[columns] = np.fmax(peak[columns], _largest(touch))
                least[columns] = np.fmin(least[columns], -_largest(-touch))
        for name, of_rows, high, low in zip(names, means.T.tolist(), peak, least, strict=True):
            # which of two zeros, 0.0 and -0.0, is the larger depends on the processor
            most = max(float(high), kept.get((name, LARGEST), -np.inf)) + 0.0
            fewest = min(float(low), kept.get((name, SMALLEST), np.inf)) + 0.0
            found[name] = [*of_rows, most, fewest, most - fewest]
    return found


def several(run: Run) -> Iterator[list[str]]:
    """The channels, as many at a time as AT_ONCE values make."""
    taken, n = [], 0
    for channel, size in run.sizes.items():
        taken.append(channel)
        n += size * run.rows
        if n > AT_ONCE:
            yield taken
            taken, n = [], 0
    if taken:
        yield taken


def by_columns(rows: Array) -> tuple[Array, Array, Array]:
    """Mean, rms, standard deviation and last value (4, N), largest (N) and smallest of each column.

    rows (n, N), one column behind the other in memory: numpy then adds each as if it were alone.
    """
    square = rows**2
    means = [rows.mean(axis=0), np.sqrt(square.mean(axis=0)), rows.std(axis=0), rows[-1]]
    return np.array(means), _largest(rows), -_largest(-rows)


def _largest(x: Array) -> Array:
    """The largest value that is a number of each column of x (n, N); -inf without any."""
    found: Array = np.fmax.reduce(x, axis=0, initial=-np.inf)
    return found


def _defined(section: Points) -> dict[str, Any]:
    """What a section is of, without what follows from its points."""
    told = section.definition.items()
    return {name: value for name, value in told if not name.startswith("dispersion_")}


def number(run: Run, word: str) -> tuple[float | None, str]:
    """A number and its unit, or None and why there is none."""
    try:
        value, unit = scalar(run, word)
    except TrsimError as error:
        return None, error.what.removeprefix(f"{run.path}:").strip()
    return (value, unit) if math.isfinite(value) else (None, f"nothing to make {word} of")


# --- as it is stored -------------------------------------------------------------------------


def packed(told: dict[str, Any]) -> tuple[bytes, str]:
    """A record as it is stored, and the sha256 of what it says."""
    text = json.dumps(told, ensure_ascii=False, sort_keys=True, separators=(",", ":"))
    data = f"{text}\n".encode()
    return gzip.compress(data, LEVEL, mtime=0), hashlib.sha256(data).hexdigest()


def sent(told: dict[str, Any]) -> dict[str, str]:
    """A record for a message of text."""
    data, sha = packed(told)
    return {"record": base64.b64encode(data).decode(), "content": sha}


def received(text: str) -> bytes:
    """A record that was sent, as it is stored."""
    return base64.b64decode(text)


def unpacked(data: bytes, sha: str) -> dict[str, Any] | None:
    """A stored record; None where it is not the one with this sha256."""
    try:
        text = gzip.decompress(data)
    except (OSError, EOFError, ValueError, zlib.error):
        return None
    if hashlib.sha256(text).hexdigest() != sha:
        return None
    found: dict[str, Any] = json.loads(text)
    return found


# --- read like a run -------------------------------------------------------------------------


@dataclass(frozen=True, kw_only=True)
class Kept(Run):
    """What a sweep kept of a case, read like its result file; without rows."""

    told: dict[str, Any]  # the record
    case: str

    @property
    def reached(self) -> float:
        return float(self.told["summary"]["time"])

    @property
    def time(self) -> Array:
        """The first row and the last."""
        return np.array(self.told["ends"])

    def kept(self, word: str) -> tuple[float, str] | None:
        """The number of a word, and its unit; None where it is not kept.

        Raises UsageError where the run had none.
        """
        if word in self.told["asked"]:
            value, unit = self.told["asked"][word]
            if value is None:
                raise UsageError(f"{self.path}: {unit}")
            return float(value), str(unit)
        kind, _, of = word.partition(":")
        if kind in OF_CHANNELS and of in self.told["channels"]:
            value = self.told["channels"][of][OF_CHANNELS.index(kind)]
            return float(value), self.unit(self._whole_of(of))
        if kind in OF_CONTACTS and of in self.told["contacts"]:
            value = self.told["contacts"][of][OF_CONTACTS.index(kind)]
            return float(value), "s" if kind == "between" else "-"
        if kind in OF_ROWS:
            self.channel(of.partition("@")[0])  # tells what there is not
        return None

    def _whole_of(self, name: str) -> str:
        """The channel that a name is, or is a component of."""
        return name if name in self.units else name.rpartition(".")[0]

    def _rows(self, stored: str) -> Array:
        if stored == "time":
            return self.time
        raise self._gone(f"the rows of '{stored}'")

    def _gone(self, what: str) -> UsageError:
        return UsageError(
            f"{self.path}: the sweep did not keep {what}",
            f"`trsim run {self.path.parent.parent} '{self.case}'` runs the case again and keeps "
            "all of it; `numbers:` in the scenario's `sweep:` keeps a number of every case.",
        )

    def steps(self, joint: str) -> dict[str, Array]:
        self.check_contact(joint)
        raise self._gone(f"the steps of '{joint}'")

    def contact_unit(self, joint: str, *channels: str) -> str:
        units = [self.units[f"{joint}.{c}"] for c in channels if f"{joint}.{c}" in self.units]
        return units[0] if units else "-"

    @property
    def events(self) -> Events:
        if self.told["events"]["all"] > EVENTS:
            raise self._gone(f"more than {EVENTS} of its events")
        return Events(*(np.array(self.told["events"][name]) for name in Events._fields))

    @property
    def peaks(self) -> tuple[Peak, ...]:
        return tuple(Peak(*one) for one in self.told["peaks"])

    @property
    def poincare(self) -> dict[str, Points]:
        return dict(self._sections())

    def _sections(self) -> Iterator[tuple[str, Points]]:
        for name, kept in self.told["sections"].items():
            if kept["all"] > POINTS:
                raise self._gone(f"more than {POINTS} points of section '{name}'")
            time, x, y = map(np.array, kept["points"])
            yield name, Points(kept["definition"], time, x, y, *kept["units"])

    @property
    def summary(self) -> dict[str, Any]:
        found: dict[str, Any] = self.told["summary"]
        return found

    @property
    def scenario(self) -> dict[str, Any]:
        """Its wishes for figures."""
        return {"report": self.told["report"]}

    def group(self, name: str) -> dict[str, Any]:
        if name != "solver":
            raise self._gone(f"its {name}")
        found: dict[str, Any] = self.told["solver"]
        return found

    @property
    def phase(self) -> dict[str, Points]:
        return {}


def _part(section: str, kind: str, joint: str, bodies: list[str], clearance: float) -> Part:
    return Part(section, kind, joint, tuple(bodies), clearance)


def kept(path: Path, case: str, told: dict[str, Any]) -> Kept:
    """The run of a record; path: that of the result file which the case would have."""
    units, sizes = told["units"], told["sizes"]
    return Kept(
        path=path, attributes=told["attributes"], units=units,
        sizes={name: sizes.get(name, 1) for name in units},
        parts={name: _part(*part) for name, part in told["parts"].items()},
        contacts=tuple(told["summary"]["contacts"]), rows=told["rows"], told=told, case=case,
    )  # fmt: skip
