"""What is given to be run: a scenario file, a result file with its scenario inside, or a dict."""

import json
import os
from collections.abc import Mapping
from pathlib import Path
from typing import TYPE_CHECKING, Any, TypeAlias

from trsim.errors import ScenarioError, TrsimError, UsageError, described, unreadable

if TYPE_CHECKING:
    from trsim.scenario.scenario import Scenario

SIGNATURE = b"\x89HDF\r\n\x1a\n"
Given: TypeAlias = "str | os.PathLike[str] | Mapping[str, Any] | Scenario"
Sets: TypeAlias = Mapping[str, Any]  # dotted key -> value


def load(scenario: Given, set: Sets | None = None) -> "Scenario":
    """Read a scenario.

    scenario  the name of a scenario file or of a result file, or a dict of the same words
    set       what is changed in it: {"joints.pin.clearance": "0.3 mm"}

    Raises ScenarioError, of a single fault or as Problems with all there are; FileError.
    """
    return loaded(scenario, settings(set))


def settings(given: Sets | None) -> tuple[str, ...]:
    """Changed values as `--set` takes them."""
    from trsim.api.words import written

    if given is not None and not isinstance(given, Mapping):
        hint = 'Write for example set={"joints.pin.clearance": "0.3 mm"}.'
        raise UsageError(f"`set` is no dict but {described(given)}", hint)
    return tuple(f"{key}={written(value, (key,))}" for key, value in (given or {}).items())


def loaded(given: Given, sets: tuple[str, ...]) -> "Scenario":
    """The scenario; that of a result file is the one it was made from, as resolved then."""
    from trsim.scenario.load import load, loads
    from trsim.scenario.scenario import Scenario

    if isinstance(given, Mapping):
        from trsim.api.words import tree
        from trsim.scenario.load import of_tree

        return of_tree(*tree(given, sets))
    if isinstance(given, Scenario):
        if not sets:
            return given
        text, digests = json.dumps(given.resolved), given.source.files
        return _again(loads(text, sets, called(given)), given.source.text, digests)
    if not isinstance(given, str | os.PathLike):
        what = f"a scenario is the name of a file or a dict, not {described(given)}"
        raise UsageError(what, 'Write for example trsim.load("crank.yaml").')
    if isinstance(given, str) and "\n" in given:
        hint = "Save the text as a file, or give a dict: yaml.safe_load(text) makes one."
        raise UsageError("a text of several lines is no name of a file", hint)
    if not is_result(given):
        return load(given, sets)
    from trsim.store.read import read

    run = read(given)
    scenario = loads(run.text("scenario/resolved"), sets, f"{given}/scenario/resolved")
    names, digests = run.text("scenario/files"), run.text("scenario/files_sha256")
    return _again(scenario, run.text("scenario/text"), dict(zip(names, digests, strict=True)))


def _again(scenario: "Scenario", text: str, files: dict[str, str]) -> "Scenario":
    """The scenario, whose source is still what the user wrote: a new result says so too."""
    scenario._text, scenario._tree.files = text, files
    return scenario


def called(given: Given) -> str:
    """How messages call it."""
    if isinstance(given, Mapping):
        from trsim.api.words import NAME

        return NAME
    if isinstance(given, str | os.PathLike):
        return os.fspath(given)
    source = getattr(given, "source", None)
    return next(iter(source.files), "scenario") if source else "scenario"


def is_result(source: str | os.PathLike) -> bool:
    """Whether it is HDF5, whatever its name."""
    if unreadable(source) is not None:  # a FIFO would wait for its other end
        return False
    try:
        with open(source, "rb") as file:
            return file.read(8) == SIGNATURE
    except OSError:
        return False


def same(given: Given, summary: dict[str, Any]) -> bool | None:
    """Whether a new result holds what the one it was made from holds; None if there is none."""
    from trsim.store.read import read, verify

    if not isinstance(given, str | os.PathLike):
        return None
    try:
        if not is_result(given) or not verify(given):  # damaged, it is not what it says it is
            return None
        before = read(given).attributes.get("content_sha256")
    except TrsimError:
        return None
    return summary.get("content_sha256") == before if before else None


def stem(source: str) -> str:
    """The name of the result, without its ending: never that of the result it was made from."""
    name = Path(source).name
    if not is_result(source):
        return Path(source).stem
    return name.removesuffix(".part").removesuffix(".h5") + ".again"


def must_end(scenario: Any) -> None:
    """Refuse a run of a scenario that does not say how long it is."""
    if scenario.solver.end is None:
        what = "field required: end (s)"
        error = ScenarioError(what, "Write for example `end: 1 s`.", ("solver",))
        error.place = scenario.place(error.path)
        raise error
