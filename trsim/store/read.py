"""The reader of result files, complete or partial."""

import json
import os
from collections.abc import Iterator, Mapping
from contextlib import contextmanager
from dataclasses import dataclass
from pathlib import Path
from typing import Any, NamedTuple

import h5py
import numpy as np
from h5py import h5d
from numpy.typing import NDArray

from trsim.arrays import Array
from trsim.errors import FileError, UsageError, known, unreadable
from trsim.store import certificate, rows, torn
from trsim.store.content import content_hash
from trsim.store.grow import LONGEST
from trsim.store.peaks import Peak
from trsim.store.plain import SIGNATURE, Plain
from trsim.store.points import Impacts, Points, between_bars, plain, split, stored
from trsim.store.sound import Group, Item, Unsound, check_sound
from trsim.store.tables import MAY_BE_NAN

FORMAT, VERSION = "trsim run", 1
SWMR = 0x04  # in byte 11 of the file: open for one writer, or its writer was killed


class Part(NamedTuple):
    """One element of the mechanism of a run."""

    section: str
    type: str
    joint: str  # of a drive or a sensor
    bodies: tuple[str, ...]
    clearance: float  # m, radial; 0 for an ideal joint


class Events(NamedTuple):
    """Onsets and separations of contacts."""

    time: Array  # s
    kind: NDArray[Any]  # onset, separation; of the element `solver`: to implicit, to explicit
    element: NDArray[Any]
    speed: Array  # m/s
    angle: Array  # rad
    did: NDArray[Any]  # by a user event, in words; empty where the scenario has none
    work: Array  # J, done by it


@dataclass(frozen=True)
class Run:
    """The contents of a result file; the numbers are read when they are asked for."""

    path: Path
    attributes: Mapping[str, Any]  # title, status, reason, content_sha256 ...
    units: Mapping[str, str]  # channel -> SI unit
    sizes: Mapping[str, int]  # channel -> components
    parts: Mapping[str, Part]  # name -> element
    contacts: tuple[str, ...]  # names with a table of steps
    rows: int

    @property
    def names(self) -> tuple[str, ...]:
        """The channels."""
        return tuple(self.units)

    @property
    def time(self) -> Array:
        return self.channel("time")

    @property
    def reached(self) -> float:
        """The time a run came to, s: its end where it ended well, also between two rows."""
        with opened(self.path) as file:
            return reached(file)

    def channel(self, name: str) -> Array:
        """The rows of a channel, (n) or (n, size).

        `B.force.x` is one component, `|B.force|` the magnitude.
        """
        if (inside := between_bars(name)) is not None:
            return self._magnitude(inside)
        stored, component = split(name, self.sizes)
        if not self.stores(name):
            raise UsageError(f"{self.path}: no channel named '{name}'", known(name, self.names))
        found = self._rows(stored)
        return found if component is None else found[:, component]

    def _rows(self, stored: str) -> Array:
        """The rows of a channel that is stored."""
        with opened(self.path) as file:
            dataset = h5py.Dataset(h5d.open(file.id, stored.encode()))
            return torn.rows(dataset, 0, self.rows)

    def _magnitude(self, name: str) -> Array:
        """The rows of the length of a vector; of a number those of its size without the sign."""
        found = self.channel(name)
        if found.ndim > 1 and found.shape[1] != 3:
            what = f"{self.path}: '{name}' has {found.shape[1]} components and no magnitude"
            raise UsageError(what, "Vectors of three have one.")
        return np.abs(found) if found.ndim == 1 else np.sqrt(np.sum(found * found, axis=1))

    def stores(self, name: str) -> bool:
        """Whether there are rows of a channel, of a component or of a magnitude."""
        return name == "time" or self._stored(name) in self.units

    def unit(self, name: str) -> str:
        return "s" if name == "time" else self.units[self._stored(name)]

    def kept(self, word: str) -> tuple[float, str] | None:
        """A number by its word (analyse/outputs.py), and its unit, where it is kept as such: of a
        case of which a sweep keeps numbers only."""
        return None

    def meaning(self, name: str) -> str:
        with opened(self.path) as file:
            return str(file[self._stored(name)].attrs["long_name"])

    def _stored(self, name: str) -> str:
        """The channel that a component or a magnitude is of."""
        return split(between_bars(name) or name, self.sizes)[0]

    def steps(self, joint: str) -> dict[str, Array]:
        """`time` and the channels of a contact at every accepted step in touch."""
        self.check_contact(joint)
        with opened(self.path) as file:
            return table(file["steps"][joint])

    def check_contact(self, joint: str) -> None:
        """Check that there is such a contact.  Raises UsageError."""
        if joint not in self.contacts:
            raise UsageError(f"{self.path}: no contact '{joint}'", known(joint, self.contacts))

    def contact_unit(self, joint: str, *channels: str) -> str:
        """The unit of the first of the channels that a contact has, force or speed."""
        with opened(self.path) as file:
            there = file["steps"][joint]
            units = [str(there[c].attrs.get("units", "-")) for c in channels if c in there]
        return units[0] if units else "-"

    @property
    def events(self) -> Events:
        with opened(self.path) as file:
            none: dict[str, Any] = {"did": np.array([], "S1"), "work": np.array([])}
            there = {**none, **table(file["events"])}
            words = {name: there[name].astype(str) for name in ("kind", "element", "did")}
        return Events(**{name: {**there, **words}[name] for name in Events._fields})

    @property
    def fired(self) -> dict[str, int]:
        """How often each user event of the scenario happened."""
        with opened(self.path) as file:
            names = [str(name) for name in file["events"].attrs.get("user", ())]
            happened = table(file["events"])["element"].astype(str).tolist()
        return {name: happened.count(name) for name in names}

    @property
    def recorded(self) -> dict[str, Array]:
        """`time`, `event` and the channels at user events that record; empty without any."""
        with opened(self.path) as file:
            return table(file["recorded"]) if "recorded" in file else {}

    @property
    def impulses(self) -> dict[str, Array]:
        """`time`, `event`, `row`, `body` and impulses of user events; empty without any."""
        with opened(self.path) as file:
            return table(file["impulses"]) if "impulses" in file else {}

    @property
    def velocity_jumps(self) -> dict[str, Array]:
        """`time`, `event`, `body` and velocities before and after user events; or empty."""
        with opened(self.path) as file:
            return table(file["velocity_jumps"]) if "velocity_jumps" in file else {}

    @property
    def peaks(self) -> tuple[Peak, ...]:
        with opened(self.path) as file:
            there = "channel" in file["peaks"]
            return tuple(rows.stored(file["peaks"], Peak)) if there else ()

    @property
    def phase(self) -> dict[str, Points]:
        return self._points("phase")

    @property
    def poincare(self) -> dict[str, Points]:
        return self._points("poincare")

    def impacts(self, joint: str) -> Impacts:
        """The touches of a joint with clearance, or of a stop, whose angle is nan."""
        self.check_contact(joint)
        events = self.events
        onset = (events.kind == "onset") & (events.element == joint)
        return Impacts(events.time[onset], events.angle[onset], events.speed[onset])

    def _points(self, section: str) -> dict[str, Points]:
        with opened(self.path) as file:
            return {n: stored(g) for n, g in file[section].items() if "x" in g and "y" in g}

    def group(self, name: str) -> dict[str, Any]:
        """The attributes of a group: summary, solver, provenance, mechanism."""
        with opened(self.path) as file:
            return plain(file[name].attrs)

    @property
    def summary(self) -> dict[str, Any]:
        with opened(self.path) as file:
            group = file["summary"]
            found = {name: plain(inner.attrs) for name, inner in group.items()}
            return {**plain(group.attrs), "contacts": found}

    @property
    def certificate(self) -> "certificate.Certificate | None":
        """What an independent run says of this one, where there was one."""
        with opened(self.path) as file:
            return certificate.of(file)

    def text(self, name: str) -> Any:
        """A dataset of words by its path: scenario/text, mechanism/redundant."""
        with opened(self.path) as file:
            found = file[name].asstr()[()]
        return found if isinstance(found, str) else tuple(found)

    @property
    def warnings(self) -> tuple[str, ...]:
        """What was said before and after the run; nothing in a file that was not completed."""
        with opened(self.path) as file:
            found = file["solver"].get("warnings")
            return tuple(found.asstr()[()]) if found is not None else ()

    @property
    def scenario(self) -> dict[str, Any]:
        """The scenario as plain data, after extends, tables and --set."""
        with opened(self.path) as file:
            found = json.loads(file["scenario/resolved"].asstr()[()])
            if not isinstance(found, dict):
                raise Unsound("its scenario is no mapping")
        return found


def read(path: str | os.PathLike) -> Run:
    """Open a result file.  Raises FileError where there is none that can be read."""
    path = Path(path)
    with opened(path) as file:
        root = _check(file, path)
        channels = {n: item for n, item in root.items() if isinstance(item, Item) and item.shape}
        channels = {n: i for n, i in channels.items() if not n.startswith("component.")}
        return Run(
            path=path,
            attributes=root.attributes,
            units={n: item.unit for n, item in channels.items() if n != "time"},
            sizes={n: (*item.shape, 1)[1] for n, item in channels.items() if n != "time"},
            parts=_parts(root["mechanism"]),
            contacts=tuple(root["steps"]),
            rows=_rows_of(file, channels),
        )


def _rows_of(file: h5py.File, items: dict[str, Item]) -> int:
    """The rows that all of some datasets have."""
    if file.attrs["status"] == "running":
        return _written([file[name] for name in items])
    return min(item.shape[0] for item in items.values())


def verify(path: str | os.PathLike) -> bool:
    """Whether the contents of a complete file still are what its hash says."""
    with opened(Path(path)) as file:
        _check(file, Path(path))
        same = content_hash(file) == file.attrs.get("content_sha256")
        return same and certificate.whole(file)


def reached(file: h5py.File) -> float:
    """The time the run of an open file came to, s.

    Of one that was not completed, which does not say so, the last time in its tables.
    """
    told = file["summary"].attrs
    if "time" in told and file.attrs["status"] != "recovered":
        return float(told["time"])
    last = [0.0]
    for group in (file, file["events"], *file["steps"].values(), *file["poincare"].values()):
        n = _written([group["time"]])
        last += torn.rows(group["time"], max(n - 1, 0), n).tolist()
    return max(last)


@contextmanager
def opened(path: Path) -> Iterator[h5py.File]:
    """An HDF5 file for reading, also while it is written or after its writer was killed."""
    if (missing := unreadable(path)) is not None:
        part = Path(f"{path}.part")
        if part.is_file():
            missing.hint = f"{part} exists: the run is going on, or was broken off."
        raise missing
    try:
        with _file(path) as file:
            yield file
    except (OSError, LookupError, RuntimeError, ValueError, TypeError, MemoryError) as error:
        if isinstance(error, FileError):
            raise
        raise FileError(*_unreadable(path, error), file=str(path)) from None


def _file(path: Path) -> h5py.File:
    """The file, in the mode its superblock asks for: HDF5 waits long for a writer that is not."""
    with path.open("rb") as file:
        start = file.read(36)
    writing = len(start) == 36 and start.startswith(SIGNATURE) and start[11] & SWMR
    if writing and path.stat().st_size < int.from_bytes(start[28:36], "little"):
        # cut short: in SWMR mode HDF5 would go on looking for the rest, for minutes
        return h5py.File(Plain(path), "r")
    return h5py.File(path, "r", libver="latest", swmr=True) if writing else h5py.File(path, "r")


def _unreadable(path: Path, error: Exception) -> tuple[str, str]:
    if isinstance(error, PermissionError) or not os.access(path, os.R_OK):
        return f"{path}: permission denied", ""
    with path.open("rb") as file:
        signature = file.read(8)
    if signature != SIGNATURE:
        return f"{path} is not a result file", "A result file is written by `trsim run`."
    text = str(error).splitlines()[0] if str(error) else type(error).__name__
    what = "is truncated" if "truncated" in text else "is damaged"
    hint = "Run the scenario again."
    if path.suffix == ".part":
        hint = f"`trsim recover {path}` copies what is left."
    return f"{path} {what}: {text[:200]}", hint


def _check(file: h5py.File, path: Path) -> Group:
    """What is in the file of a result, which is refused where it is none."""
    if file.attrs.get("format") != FORMAT:
        hint = "A result file is written by `trsim run`."
        raise FileError(f"{path} is an HDF5 file, but not a result of trsim", hint)
    version = file.attrs["format_version"]
    if not isinstance(version, np.integer):
        raise Unsound("it does not say its version")
    if version > VERSION:
        what = f"{path} has format {version}; this trsim reads up to {VERSION}"
        raise FileError(what, "Use a newer trsim.")
    return check_sound(file)


def _parts(group: Group) -> dict[str, Part]:
    words = [group.texts(name) for name in ("name", "section", "type", "joint", "bodies")]
    clearance = h5py.Dataset(group.opened("clearance"))[:].tolist()
    return {
        name: Part(section, kind, joint, tuple(bodies.split()), c)
        for name, section, kind, joint, bodies, c in zip(*words, clearance, strict=True)
    }


def table(group: h5py.Group) -> dict[str, Any]:
    """The rows that all datasets of a group have."""
    n = _written(list(group.values()))
    return {name: torn.rows(dataset, 0, n) for name, dataset in group.items()}


def _written(datasets: list[h5py.Dataset]) -> int:
    """The rows that all datasets have.

    A killed writer, or one that met a full disk, may have left some behind, or have made room for
    rows it never filled: they are NaN then.
    """
    n = min(len(dataset) for dataset in datasets)
    if datasets[0].file.attrs["status"] != "running":
        return n
    for dataset in datasets:
        if dataset.name.rsplit("/", 1)[-1] in MAY_BE_NAN:
            continue
        while n and dataset.dtype.kind == "f":
            begin = max(n - LONGEST, 0)
            filled = ~np.isnan(torn.rows(dataset, begin, n).reshape(n - begin, -1)).any(axis=1)
            if filled.any():
                n = begin + int(np.flatnonzero(filled)[-1]) + 1
                break
            n = begin
    return n
