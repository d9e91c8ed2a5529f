"""What a result file says about itself: scenario, mechanism, summary, provenance."""

import hashlib
import json
import os
import platform
import re
import time
from collections.abc import Sequence
from functools import cache
from pathlib import PurePath
from typing import Any, NamedTuple

import h5py
import numpy as np

from trsim.statuses import Status
from trsim.store.made import Book
from trsim.store.peaks import Peak
from trsim.store.read import FORMAT, VERSION, Part
from trsim.version import __version__

PACKAGES = ("numpy", "numba", "llvmlite", "scipy", "h5py", "pydantic")  # have a part in results
NO_ROOM = re.compile(
    r"(?i)memory allocation failed|can't allocate|unable to allocate|out of memory"
)
CPU = "integration_cpu"  # differs from run to run: kept apart from the statistics
GROUPS = ("steps", "events", "peaks", "summary", "solver", "scenario", "mechanism", "provenance")


class Clock(NamedTuple):
    """When a run began."""

    date: float
    wall: float
    cpu: float

    @classmethod
    def now(cls) -> "Clock":
        return cls(time.time(), time.perf_counter(), time.process_time())


class Impacts:
    """Onsets, fastest onset and largest force of every contact, kept while blocks pass by."""

    ONSETS, FASTEST, FORCE, WHEN = range(4)

    def __init__(self, instances: int) -> None:
        self.of = np.zeros((instances, 4))

    def press(self, e: int, lines: Any, column: int) -> None:
        """Keep the largest force of a contact; of equal ones the first."""
        if len(lines):
            k = int(np.argmax(lines[:, column]))
            if lines[k, column] > self.of[e, self.FORCE]:
                self.of[e, self.FORCE], self.of[e, self.WHEN] = lines[k, column], lines[k, 0]

    def update(self, events: Any) -> None:
        for _, kind, e, speed, *_ in events.tolist():
            if kind == 1.0:
                contact = self.of[int(e)]
                contact[self.ONSETS] += 1.0
                contact[self.FASTEST] = max(contact[self.FASTEST], speed)


# --- before the first row --------------------------------------------------------------------


def expected(scenario: Any) -> int:
    """How many rows a run may have; of one that has a row for each step nobody knows."""
    end, every = scenario.solver.end or 0.0, scenario.output.every
    return int(min(end / every if every else 1000, 1e9)) + 1


def begin(book: Book) -> None:
    """Attributes and groups of a file whose run is about to start."""
    told = {"format_version": VERSION, "format": FORMAT, "status": "running", "reason": ""}
    book.attributes("", told)
    for name in GROUPS:
        book.group(name)


def given(book: Book, scenario: Any, mechanism: Any) -> None:
    """What is simulated; files of runs with the same channels differ in nothing else so far."""
    book.attribute("", "title", scenario.title)
    _scenario(book, scenario)
    _mechanism(book, scenario, mechanism)


def _scenario(book: Book, scenario: Any) -> None:
    """The text as given, its resolved form as JSON (which is YAML), and what it was read from."""
    source = scenario.source
    files = {PurePath(name).name: digest for name, digest in source.files.items()}
    resolved = json.dumps(scenario.resolved, indent=1, ensure_ascii=False)
    book.values("scenario/text", source.text)
    book.values("scenario/resolved", resolved)
    book.values("scenario/sha256", hashlib.sha256(source.text.encode()).hexdigest())
    book.values("scenario/files", list(files))
    book.values("scenario/files_sha256", list(files.values()))


def _mechanism(book: Book, scenario: Any, mechanism: Any) -> None:
    """What was assembled: instances, and what the motion does not determine."""
    told = {"planar": bool(mechanism.planar), "mobility": int(mechanism.mobility)}
    book.attributes("mechanism", told)
    for name in ("redundant", "singular", "not_unique", "notes"):
        book.values(f"mechanism/{name}", list(getattr(mechanism, name)))
    found = parts(scenario, mechanism)
    book.values("mechanism/name", list(found))
    for name in ("section", "type", "joint"):
        book.values(f"mechanism/{name}", [getattr(part, name) for part in found.values()])
    book.values("mechanism/bodies", [" ".join(part.bodies) for part in found.values()])
    clearances = [part.clearance for part in found.values()]
    path = book.values("mechanism/clearance", clearances, "f8")
    book.attributes(path, {"units": "m", "long_name": "radial clearance"})


def parts(scenario: Any, mechanism: Any) -> dict[str, Part]:
    """The elements of a mechanism by name."""
    found = {}
    for one in mechanism.instances:
        if one.section:
            spec = getattr(scenario, one.section).get(one.name)
            joint = str(getattr(spec, "joint", None) or "")
            bodies = tuple(getattr(spec, "bodies", None) or ())
            clearance = float(getattr(spec, "clearance", None) or 0.0)
            found[one.name] = Part(one.section, one.element.key, joint, bodies, clearance)
    return found


def flag(book: Book, mechanism: Any) -> None:
    """Mark the reactions that the motion does not determine; of a relation all that it tells."""
    relations = {i.name: [c.name for c in i.channels] for i in mechanism.instances if i.row.relates}
    for name in {row.split(".")[0] for row in mechanism.not_unique}:
        for own in relations.get(name, ("reaction", "reaction_moment")):
            channel = f"{name}.{own}"
            if channel in book.told:
                rows = [row for row in mechanism.not_unique if row.split(".")[0] == name]
                book.attribute(channel, "not_unique", ", ".join(rows))


# --- after the last row ----------------------------------------------------------------------


def summary(
    run: Any, title: str, status: Status, reason: str, outcome: Any, found: list[Peak]
) -> dict[str, Any]:
    """The run in a few numbers."""
    from trsim.scenario.lint import lint
    from trsim.solve.diagnose.doubts import doubts, settled  # who recovers a file needs no solver

    mechanism = run.mechanism
    late = doubts(run.scenario, mechanism, outcome) if outcome else ()
    moved = settled(run.scenario, mechanism, outcome.start) if outcome else ""
    names = [instance.name for instance in mechanism.instances]
    largest = {p.channel: p for p in found if p.extreme == "largest"}
    contacts = {}
    for e in run.contacts:
        force = largest.get(f"{names[e]}.contact_force") or largest.get(f"{names[e]}.normal_force")
        onsets, fastest, peak, when = run.impacts.of[e].tolist()
        contacts[names[e]] = {
            "impacts": int(onsets),
            "fastest_impact": fastest,
            "peak_force": force.value if force else peak,
            "peak_time": force.time if force else when,
            "steps": run.contacts[e].n,
        }
    return {
        "status": status,
        "reason": reason,
        "title": title,
        "time": float(outcome.time if outcome else run.time),
        "rows": run.rows.n,
        "events": run.events.n,
        "fired": dict(outcome.fired) if outcome else {},
        "contacts": contacts,
        "statistics": dict(outcome.statistics) if outcome else {},
        "warnings": [*mechanism.notes, *lint(run.scenario), *late],
        "mobility": int(mechanism.mobility),
        "redundant": list(mechanism.redundant),
        "not_unique": list(mechanism.not_unique),
        **({"settled": moved} if moved else {}),
    }


def end(book: Book, told: dict[str, Any], scenario: Any, outcome: Any, provenance: dict) -> None:
    """Status, summary, solver, warnings and provenance."""
    summarised(book, told)
    book.values("solver/warnings", told["warnings"])
    book.attributes("solver", of_solver(scenario, told["statistics"]))
    book.attributes("provenance", provenance)


def of_solver(scenario: Any, statistics: dict[str, Any]) -> dict[str, Any]:
    """The settings of the solver, and what it counted; no times."""
    plain = {n: v for n, v in vars(scenario.solver).items() if isinstance(v, str | int | float)}
    return plain | {name: value for name, value in statistics.items() if name != CPU}


def summarised(book: Book, told: dict[str, Any]) -> None:
    """Status and summary."""
    book.attributes("", {name: told[name] for name in ("status", "reason")})
    book.attributes("summary", {name: told[name] for name in ("time", "rows", "events")})
    for joint, numbers in told["contacts"].items():
        book.attributes(book.group(f"summary/{joint}"), numbers)


def provenance(command: str, clock: Clock, outcome: Any, resumed: Sequence[str]) -> dict[str, Any]:
    """Where, when, by what and how long; times are those since the run was last resumed."""
    told = {
        "command": command,
        "machine": platform.node(),
        "platform": platform.platform(),
        "processors": os.cpu_count() or 0,
        "began": stamp(clock.date),
        "resumed": len(resumed),
        "resumed_at": "; ".join(resumed),
        "wall_time": time.perf_counter() - clock.wall,
        "cpu_time": time.process_time() - clock.cpu,
        "trsim": __version__,
        "python": platform.python_version(),
        "hdf5": h5py.version.hdf5_version,
    }
    told |= versions()
    if outcome is not None and CPU in outcome.statistics:
        told[CPU] = outcome.statistics[CPU]
    return told


@cache
def versions() -> dict[str, str]:
    """The versions of the packages that have a part in results, as they were installed."""
    from importlib.metadata import version

    return {package: version(package) for package in PACKAGES}


def stamp(date: float) -> str:
    """A date in UTC."""
    return time.strftime("%Y-%m-%dT%H:%M:%SZ", time.gmtime(date))


def cause(error: BaseException) -> str:
    """The part of an HDF5 message that names what the system said."""
    text = str(error)
    if NO_ROOM.search(text):
        return "out of memory"
    found = re.search(r"error message = '([^']*)'", text)
    reason = found[1] if found else getattr(error, "strerror", None) or text
    return reason.splitlines()[0][:200] if reason else type(error).__name__
