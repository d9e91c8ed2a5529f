"""The folder of a sweep: plan.json, ledger.jsonl, index.csv and cases/NAME.h5."""

import csv
import io
import json
import os
import re
from collections.abc import Mapping
from contextlib import suppress
from pathlib import Path
from typing import Any

from trsim.errors import FileError, UsageError
from trsim.statuses import NOT_NEEDED
from trsim.store.lock import refuse_if_written
from trsim.store.own import remove
from trsim.store.target import FIGURES, HEADER, Kind, fresh, headed, replaceable
from trsim.sweeps.ledger import WORD, Entry, in_a_line
from trsim.sweeps.plan import CASE, Chosen, Plan
from trsim.sweeps.values import value

FORMAT, VERSION = "trsim sweep", 1
NUMBERED = re.compile(r"\.\d+(-\d+)?")
STARTED = re.compile(r"ledger(-\d+of\d+)?\.jsonl(\.lock)?|plan\.json\.\d+(-\d+)?")
TITLES, FIRST = ("name", "status", "reason"), b'{"format": "trsim sweep"'
INDEX = headed(*TITLES)
PLAN = Kind("plan of a sweep", lambda start: start.startswith(FIRST))
DRAWN = {f".{ending}": kind for ending, kind in FIGURES.items()} | {
    ".html": Kind("page of trsim", lambda start: b'content="trsim"' in start[:HEADER]),
    ".glb": Kind("animation of trsim", lambda start: b'"generator":"trsim"' in start),
}
NEEDED = {"version", "source", "engine", "keys", "units", "method", "samples", "seed", "cases"}
KINDS = {"source": str, "engine": str, "keys": list, "units": dict, "written": dict, "method": str,
         "samples": int, "seed": int, "cases": list, "numbers": list, "sets": list,
         "chosen": list}  # fmt: skip
AGAIN = "The same `trsim sweep` writes it again."
SPARED = "not_needed"  # of a case in plan.json that an adaptive sweep did not ask for
LAST = ("attempts", "wall_time", "content_sha256")


def check_usable(folder: Path) -> None:
    """Check that a folder is that of a sweep, of a report of one run, empty, or not there.

    `run NAME.yaml`, `report` and `sweep NAME.yaml` name the same folder, in either order.
    """
    if folder.exists() and not folder.is_dir():
        raise UsageError(f"{folder} is not a folder", "Name another one with -o.")
    if folder.is_dir() and not (folder / "plan.json").exists():
        found = [path for path in folder.iterdir() if not _of_a_start(path)]
        if found and not _of_a_report(found):
            what = f"{folder} is a folder of other files, not of a sweep"
            raise UsageError(what, "Name another one with -o.")
    for name, kind in (("index.csv", INDEX), ("plan.json", PLAN)):
        replaceable(folder / name, kind)


def begun(what: str, first: bytes) -> Kind:
    """Files that begin so, or were left before they did."""
    return Kind(f"{what} that was begun", lambda start: first.startswith(start[: len(first)]))


# under another name until they are complete (store/target.py)
UNFINISHED = {
    "plan.json": begun("plan", FIRST),
    "index.csv": begun("index", ",".join(TITLES).encode()),
}


def remove_unfinished(folder: Path) -> None:
    """Remove plans and indices whose writers were killed.  Only for who is alone in the folder."""
    for name, kind in UNFINISHED.items():
        for path in folder.glob(f"{name}.*"):
            if NUMBERED.fullmatch(path.name.removeprefix(name)):
                with suppress(FileError):  # something else with such a name stays
                    remove(path, kind)


def refuse_at_work(folder: Path, mine: Path | None = None) -> None:
    """Raise FileError if a process makes a sweep in a folder; mine: the ledger of this one."""
    for lock in folder.glob("ledger*.jsonl.lock"):
        if (other := lock.with_name(lock.name.removesuffix(".lock"))) != mine:
            refuse_if_written(other)


def _of_a_start(path: Path) -> bool:
    """Whether a sweep that was killed before its plan was written may have left this."""
    if path.name == "cases":
        return path.is_dir() and not any(path.iterdir())
    return STARTED.fullmatch(path.name) is not None and path.is_file()


def _of_a_report(paths: list[Path]) -> bool:
    """Whether these are figures and pages of `trsim report`, and perhaps tables beside them."""
    drawn = [path for path in paths if path.suffix != ".csv"]
    return bool(drawn) and all(map(_drawn, drawn))


def _drawn(path: Path) -> bool:
    kind = DRAWN.get(path.suffix)
    with suppress(UsageError, FileError):
        return kind is not None and path.is_file() and bool(replaceable(path, kind))
    return False


def write_plan(folder: Path, plan: Plan, engine: str, chosen: Chosen | None = None) -> None:
    """plan.json; what reads a sweep later needs nothing else to know its cases.

    chosen: which of them were asked for, once an adaptive sweep has ended.
    """
    cases = [
        {"name": c.name, "digest": c.digest, "values": _values(c.case, c.values)}
        | ({SPARED: True} if chosen and c.name not in chosen.cases else {})
        for c in plan.cases
    ]
    told = {
        "format": FORMAT, "version": VERSION, "source": plan.source, "engine": engine,
        "keys": plan.keys, "units": plan.units, "written": plan.written, "method": plan.method,
        "samples": plan.samples, "seed": plan.seed, "cases": cases,
        "numbers": list(plan.numbers), "sets": list(plan.sets),
    }  # fmt: skip
    if plan.adaptive:
        told["chosen"] = list(chosen.told) if chosen else []
    write_told(folder, told)


def write_told(folder: Path, told: Mapping[str, Any]) -> None:
    """plan.json, as `read_plan` gives it."""
    with fresh(folder / "plan.json", PLAN) as unfinished:
        text = json.dumps(told, ensure_ascii=False)
        unfinished.write_text(text, encoding="utf-8", newline="\n")


def _values(case: str, values: dict[str, Any]) -> dict[str, Any]:
    return ({CASE: case} if case else {}) | {key: value(one) for key, one in values.items()}


def read_plan(folder: Path) -> dict[str, Any]:
    """What plan.json says.  Raises FileError or UsageError where there is none to read."""
    path = folder / "plan.json"
    try:
        told = json.loads(path.read_text(encoding="utf-8"))
    except (FileNotFoundError, NotADirectoryError):
        what = "no such folder" if not folder.exists() else "not the folder of a sweep"
        hint = "`trsim sweep SCENARIO -o FOLDER` makes one."
        raise FileError(f"{folder}: {what}", hint, file=str(folder)) from None
    except (OSError, ValueError, RecursionError) as error:
        reason = getattr(error, "strerror", None) or "is damaged"
        raise FileError(f"{path}: {reason}", AGAIN, file=str(path)) from None
    if not isinstance(told, dict) or told.get("format") != FORMAT:
        raise FileError(f"{path} is not the plan of a sweep", file=str(path))
    if not isinstance(told.get("version"), int):
        raise FileError(f"{path} is damaged: it does not say its version", AGAIN, file=str(path))
    if told["version"] > VERSION:
        what = f"{path} has version {told['version']}; this trsim reads up to {VERSION}"
        raise FileError(what, "Use a newer trsim.", file=str(path))
    if lost := NEEDED - set(told):
        what = f"{path} is damaged: it has no {', '.join(sorted(lost))}"
        raise FileError(what, AGAIN, file=str(path))
    if wrong := _wrong(told):
        raise FileError(f"{path} is damaged: its {wrong}", AGAIN, file=str(path))
    return told


def _wrong(told: dict[str, Any]) -> str:
    """What in a plan is not of its kind."""
    for name, kind in KINDS.items():
        if not isinstance(told.get(name, kind()), kind):
            return f"{name} is no {kind.__name__}"
    texts = [*told["keys"], *told["units"].values(), *told.get("written", {}).values()]
    texts += [*told.get("numbers", ()), *told.get("sets", ()), *told.get("chosen", ())]
    if not all(isinstance(text, str) for text in texts):
        return "keys, units, numbers, sets or chosen are no texts"
    names = []
    for one in told["cases"]:
        if not isinstance(one, dict) or not isinstance(one.get("values"), dict):
            return "cases are no mappings with values"
        if not all(isinstance(one.get(name), str) for name in ("name", "digest")):
            return "cases have no name or digest"
        if not isinstance(one.get(SPARED, True), bool):
            return f"case {one['name'][:60]!r} does not say whether it was needed"
        if not all(isinstance(value, WORD) for value in one["values"].values()):
            return f"case {one['name'][:60]!r} has a value that is none"
        if "/" in one["name"] or "\0" in one["name"] or one["name"] in ("", ".", ".."):
            return f"case {one['name'][:60]!r} is no name of a file"
        names.append(one["name"])
    return "cases have a name twice" if len({*names}) < len(names) else ""


def write_index(folder: Path, told: Mapping[str, Any], entries: Mapping[str, Entry]) -> Path:
    """index.csv: one row for each case, in the order of the plan.

    Numbers are SI.  Columns of the summary are those that any case has.
    """
    keys, cases = list(told["keys"]), told["cases"]
    columns: dict[str, None] = {}
    for case in cases:
        if case["name"] in entries:
            columns.update(dict.fromkeys(entries[case["name"]].summary))
    out = io.StringIO()
    table = csv.writer(out)
    titles = [f"{key} [{told['units'].get(key, '-')}]" for key in keys]
    table.writerow(["name", "status", "reason", *titles, *columns, *LAST])
    for case in cases:
        entry = entries.get(case["name"])
        values = [case["values"].get(key) for key in keys]
        if entry is None or entry.digest != case["digest"]:
            status = NOT_NEEDED if case.get(SPARED) else "missing"
            table.writerow([case["name"], status, "", *values])
            continue
        numbers = [entry.summary.get(column) for column in columns]
        last = [entry.attempts, round(entry.wall, 3), entry.content]
        reason = in_a_line(entry.reason)
        table.writerow([case["name"], entry.status, reason, *values, *numbers, *last])
    path = folder / "index.csv"
    with fresh(path, INDEX) as unfinished:
        unfinished.write_bytes(out.getvalue().encode())
    return path


def strays(folder: Path, names: set[str]) -> list[str]:
    """Result files in the folder that are of no case of the plan."""
    try:
        found = os.listdir(folder / "cases")
    except OSError:
        return []
    return sorted(f for f in found if f.endswith(".h5") and f.removesuffix(".h5") not in names)
