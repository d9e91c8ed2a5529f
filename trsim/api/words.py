"""A scenario as a dict of Python: the same words and numbers as in a file.

It becomes the text of a file (JSON, which is YAML), so that a result file says what was run and a
sweep can hand it to other processes.  Errors name the place in the dict: scenario: bodies.rod.mass.
"""

import json
import math
import os
from collections.abc import Mapping
from pathlib import Path
from typing import Any

from trsim.errors import Place, ScenarioError, TrsimError
from trsim.scenario.expand import expand_text
from trsim.scenario.text import Tree

NAME = "scenario"  # of a dict, in messages
DEEPEST = 40
FOLDED = {
    ord(c): f"\\u{ord(c):04x}" for c in "\x85\u2028\u2029"
}  # ends of lines to YAML, not to JSON
FORCES = (
    'Write an expression as text, "100*sin(2*pi*t)", or a table of rows, '
    '{"table": [[0, 0], [0.1, 250]]}: what a run calls is compiled (`trsim explain functions`).'
)


def tree(given: Mapping[str, Any], sets: tuple[str, ...]) -> tuple[Tree, str]:
    """The tree of a dict, and its text; files that it names are looked for in the current folder.

    Raises ScenarioError.
    """
    text = written(given, (), indent=1)
    flat = Place(NAME, 0, 1, "")
    try:
        found = expand_text(text, sets, NAME, Path.cwd())
    except TrsimError as error:
        for problem in error.problems:
            if problem.place is not None and problem.place.file == NAME:
                problem.place = flat
        raise
    for marks in (found.marks, found.keys):
        marks.update({path: flat for path, mark in marks.items() if mark.file == NAME})
    return found, text


def written(value: Any, path: tuple, indent: int | None = None) -> str:
    """A value as the text of a scenario.  Raises ScenarioError where it has no such text."""
    text = json.dumps(_plain(value, path), ensure_ascii=False, indent=indent)
    return text.translate(FOLDED)


def _plain(value: Any, path: tuple) -> Any:
    """Dicts, lists, numbers and words; arrays become lists."""
    if len(path) > DEEPEST:
        raise _refused("a dict that holds itself, or is too deep", "", path[:3])
    if value is None or isinstance(value, bool | str):
        return value
    if isinstance(value, Mapping):
        for key in value:
            if not isinstance(key, str):
                raise _refused(f"a key must be a word, got {key!r}", "Quote it.", path)
        return {key: _plain(inner, (*path, key)) for key, inner in value.items()}
    if isinstance(value, list | tuple | range):
        return [_plain(inner, (*path, k)) for k, inner in enumerate(value)]
    if isinstance(value, int | float):
        if not math.isfinite(value):
            raise _refused(f"not a finite number: {value}", "", path)
        return float(value) if isinstance(value, float) else int(value)
    if isinstance(value, os.PathLike):
        return os.fspath(value)
    if hasattr(value, "tolist"):  # an array or a number of numpy, a column of pandas
        return _plain(value.tolist(), path)
    if callable(value):
        name = getattr(value, "__name__", type(value).__name__)
        raise _refused(f"a function of Python ({name}) cannot act in a scenario", FORCES, path)
    what = f"an object of the type {type(value).__name__} has no place in a scenario"
    raise _refused(what, "Give numbers, texts, lists and dicts.", path)


def _refused(what: str, hint: str, path: tuple) -> ScenarioError:
    return ScenarioError(what, hint, path, Place(NAME, 0, 1, ""))
