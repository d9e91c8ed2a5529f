"""A scenario file to a validated Scenario, or all that is wrong with it at once."""

import re
from collections.abc import Iterable, Iterator
from functools import cache
from itertools import islice
from os import PathLike
from pathlib import Path
from typing import Any, get_args

from pydantic import ValidationError

from trsim.errors import Problems, ScenarioError, TrsimError, closest, described
from trsim.fields import Spec, SpecError, Unit
from trsim.scenario import expand
from trsim.scenario.commas import in_a_list
from trsim.scenario.limits import sizes
from trsim.scenario.memory import Memory
from trsim.scenario.names import name_faults, sweep_faults
from trsim.scenario.scenario import Scenario, suggestion
from trsim.scenario.text import Tree
from trsim.scenario.unfold import unfold
from trsim.units import units_hint

SHOWN = 30  # problems in one message
MOST = 200  # problems read from one mapping


def load(path: str | PathLike, sets: Iterable[str] = ()) -> Scenario:
    """The scenario in a file, with each `section.name.key=value` of `sets` put in."""
    return of_tree(*expand.expand(path, sets))


def loads(
    text: str, sets: Iterable[str] = (), name: str = "<text>", folder: Path | None = None
) -> Scenario:
    """The scenario in a text; `folder` is where files it names are looked for."""
    return of_tree(expand.expand_text(text, sets, name, folder), text)


def of_case(data: dict) -> Scenario:
    """The scenario of data that are complete and were read before, one of many much alike in this
    process: what is wrong with it has no place in a file."""
    return of_tree(Tree(data), "", Memory.lasting())


def valid(data: dict, memory: Memory) -> bool:
    """Whether the data of a tree, with good names, make a scenario; what of it was seen is known.

    To say what is wrong takes a tree.
    """
    values, faults = expand.parameters(Tree(data))
    whole, more = unfold(Tree(data), values, memory.merged)
    if faults or more:
        return False
    context = {"parameters": values, "memory": memory}
    try:
        data = {**whole.entries(), "parameters": values}
        scenario = Scenario.model_validate(data, context=context)
    except (ValidationError, SpecError):
        return False
    return not any(sizes(scenario))


def locate(error: TrsimError, scenario: Scenario) -> TrsimError:
    """The error, now knowing its place in the files of the scenario."""
    for problem in error.problems:
        problem.place = problem.place or scenario.place(problem.path)
    return error


def of_tree(tree: Tree, text: str, memory: Memory | None = None) -> Scenario:
    """The scenario of a tree that is complete; text: as given; memory: of specs made before."""
    values, faults = expand.parameters(tree)
    whole, more = unfold(tree, values)
    problems: list[TrsimError] = [
        *islice(name_faults(whole.data), SHOWN),
        *islice(sweep_faults(whole.data), SHOWN),
    ]
    for problem in problems:  # it is the key that is wrong
        problem.place = whole.key_place(problem.path)
    problems += faults
    for fault, path in more:
        problems += _unfolded(fault, path, whole)
    try:
        data = {**whole.entries(), "parameters": values}
        context = {"parameters": values, "memory": memory}
        scenario = Scenario.model_validate(data, context=context)
        problems += sizes(scenario)
    except (ValidationError, SpecError) as error:
        problems += _unfolded(error, (), whole)
    for problem in problems:
        problem.place = problem.place or whole.place(problem.path)
        if "got a list of" in problem.what and (comma := in_a_list(problem.place)):
            problem.hint = f"{comma}  {problem.hint}".rstrip()
    if problems:
        files = list(tree.files)
        problems = sorted(whole.once(problems), key=lambda problem: _order(problem, files))
        if len(problems) == 1:
            raise problems[0]
        raise Problems(problems[:SHOWN], len(problems) - SHOWN if len(problems) > SHOWN else 0)
    scenario._tree, scenario._unfolded, scenario._text = tree, whole, text
    return scenario


def _order(problem: TrsimError, files: list[str]) -> tuple:
    place = problem.place
    if place is None:
        return (len(files), 0, 0)
    return (files.index(place.file) if place.file in files else -1, place.line, place.column)


# --- pydantic's errors in our words ----------------------------------------------------------

SHAPES = {
    **dict.fromkeys(("float_type", "float_parsing"), "a number"),
    **dict.fromkeys(("int_type", "int_parsing", "int_from_float"), "a whole number"),
    "string_type": "text",
    "bool_type": "true or false",
    **dict.fromkeys(("tuple_type", "list_type"), "a list"),
    **dict.fromkeys(("dict_type", "model_type"), "a mapping"),
}
BOUNDS = {
    "greater_than": (">", "gt"),
    "greater_than_equal": (">=", "ge"),
    "less_than": ("<", "lt"),
    "less_than_equal": ("<=", "le"),
}


def _unfolded(
    error: Any, path: tuple, tree: Tree, spec: type[Spec] | None = None
) -> Iterator[ScenarioError]:
    """The errors below `path`, which pydantic met in a mapping that should become a `spec`."""
    if isinstance(error, SpecError):
        yield from _unfolded(error.error, path, tree, error.spec)
    elif isinstance(error, ValidationError):
        meant, missing = set(), []
        for one in _chosen(error, path, tree.data):
            here, kind = one["here"], one["type"]
            if kind == "value_error":
                yield from _unfolded(one["ctx"]["error"], here, tree)
            elif kind == "missing" and isinstance(one["loc"][-1], str):
                missing.append(one)
            elif kind == "extra_forbidden" and spec:
                key = one["loc"][-1]
                close, hint = suggestion(key, spec, _value(tree.data, here))
                meant.add((here, close))
                place = tree.key_place((*here, key))
                yield ScenarioError(f"unknown key {described(key)}", hint, here, place)
            else:
                hint = _unit_hint(spec, here[len(path) :])
                yield ScenarioError(*_told(one, hint), path=here)
        for one in missing:
            # a misspelt key is one fault, not two
            if (one["here"], one["loc"][-1]) not in meant:
                yield _missing(one, spec)
    elif isinstance(error, ScenarioError):
        found = error.at(*path)
        if found.what.startswith("unknown key"):
            found.place = tree.key_place(found.path)
            found.path = found.path[:-1]
        yield found
    else:
        yield ScenarioError(str(error), path=path)


def _chosen(error: ValidationError, path: tuple, data: Any) -> Iterator[dict]:
    """Pydantic's errors with their path in the tree, `here`.

    Of a union pydantic tells what every branch had against the value; we keep the branch that
    came closest, or say which shapes there are if none fits.
    """
    branches: dict[tuple, dict[Any, list[dict]]] = {}
    found: Any = error.errors(include_url=False)[:MOST]
    for one in found:
        here, root, tag = _in_tree(one, path, data)
        branches.setdefault(root, {}).setdefault(tag, []).append({**one, "here": here})
    for root, of_tag in branches.items():
        for ones in of_tag.values():
            short = sum(
                one["type"] == "missing" and isinstance(one["loc"][-1], int) for one in ones
            )
            for one in ones:
                one["shape"] = _shape(one, short)
        best = min(of_tag.values(), key=_unfit)
        shapes = dict.fromkeys(one["shape"] for ones in of_tag.values() for one in ones)
        if len(of_tag) > 1 and all(one["shape"] for one in best):
            whole = {**best[0], "here": root, "shape": " or ".join(filter(None, shapes))}
            yield {**whole, "type": "union", "input": _value(data, root)}
        else:
            yield from best


def _unfit(ones: list[dict]) -> tuple[int, int]:
    """How little a branch fits: what has another shape, and how soon something is wrong in it."""
    return sum(one["shape"] is not None for one in ones), -max(len(one["here"]) for one in ones)


def _in_tree(one: dict, path: tuple, data: Any) -> tuple[tuple, tuple, Any]:
    """The path of an error in the tree; where a union begins on it, and the branch's name."""
    here, root, tag = path, None, None
    inner = _value(data, path)
    for k, part in enumerate(one["loc"], start=1):
        last = k == len(one["loc"])
        inside = part in inner if isinstance(inner, dict) else False
        if isinstance(inner, list) and isinstance(part, int):
            inside = part < len(inner)
        if inside and not (last and one["type"] == "extra_forbidden"):
            here, inner = (*here, part), inner[part]
        elif not last or one["type"] not in ("missing", "extra_forbidden"):
            root, tag = root or here, tag or part
    return here, root or here, tag


def _value(data: Any, path: tuple) -> Any:
    for key in path:
        data = data[key]
    return data


def _shape(one: dict, short: int) -> str | None:
    """What the value should have been, where it is of another kind altogether."""
    kind, context = one["type"], one.get("ctx", {})
    if kind == "missing" and isinstance(one["loc"][-1], int):
        return f"a list of {len(one['input']) + short}"
    if kind in ("too_long", "too_short"):
        return f"a list of {context.get('max_length', context.get('min_length'))}"
    if kind == "literal_error":
        return f"one of {', '.join(_words(one)) or context['expected']}"
    return SHAPES.get(kind)


def _words(one: dict) -> list[str]:
    return re.findall(r"'([^']*)'", one["ctx"]["expected"])


def _told(one: dict, hint: str) -> tuple[str, str]:
    """What is wrong and the hint, of one of pydantic's errors."""
    kind = one["type"]
    if kind == "literal_error" and _words(one):
        close = closest(one["input"], _words(one))
        hint = f"Did you mean '{close}'?" if close else ""
    if kind == "string_type" and isinstance(one["input"], int | float):
        hint = "Quote a text that looks like a number or like true, false, null."
    if one["shape"]:
        return f"must be {one['shape']}, got {described(one['input'])}", hint
    if kind in BOUNDS:
        sign, key = BOUNDS[kind]
        return f"must be {sign} {one['ctx'][key]:g}, got {described(one['input'])}", hint
    return one["msg"][0].lower() + one["msg"][1:], hint


def _missing(one: dict, spec: type[Spec] | None) -> ScenarioError:
    key = one["loc"][-1]
    unit = unit_of(spec, key)
    told = f" ({unit.text})" if unit else ""
    return ScenarioError(f"field required: {key}{told}", "", one["here"])


def _unit_hint(spec: type[Spec] | None, below: tuple) -> str:
    unit = unit_of(spec, below[0]) if below else None
    return units_hint(unit.units) if unit else ""


def unit_of(spec: type[Spec] | None, key: Any) -> Unit | None:
    """The unit of a field, wherever it stands in the annotation."""
    of: Any = spec
    return _unit_of(of, key)


@cache
def _unit_of(spec: Any, key: Any) -> Unit | None:
    field = spec.model_fields.get(key) if spec else None
    parts = [*field.metadata, field.annotation] if field else []
    while parts:
        part = parts.pop(0)
        if isinstance(part, Unit):
            return part
        parts += [*getattr(part, "__metadata__", ()), *get_args(part)]
    return None
