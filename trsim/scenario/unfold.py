"""The entries of instances among the others of a scenario.

    instances: {left: {template: chain}}     door of the template becomes left_door

What an entry says stays as written.  Its Scope tells what it means there: the numbers of its
parameters, its frame, and that `door` is left_door.  An instance overrides its template key by key.
Where the scenario has a frame, all other entries have a Scope with it, and the frames of instances
are seen from it.
"""

import re
from collections.abc import Callable, Iterator
from typing import Any

from trsim.errors import ScenarioError, described, known
from trsim.frame import Frame
from trsim.scenario.expand import numbers
from trsim.scenario.limits import before_unfolding
from trsim.scenario.merge import mapping, merged
from trsim.scenario.names import NAME, name_faults
from trsim.scenario.template import SECTIONS, Placement
from trsim.scenario.text import Path, Tree
from trsim.scenario.unfolded import Origin, Scope, Unfolded

Fault = tuple[Exception, Path]  # and where it was found
Merge = Callable[[Any, Any], Any]


def unfold(
    tree: Tree, values: dict[str, float], merge: Merge = merged
) -> tuple[Unfolded, list[Fault]]:
    """The tree with its instances unfolded, and what is wrong with these.

    values: of the parameters.  Shapes that are wrong altogether are left out here; that they are is
    found when the sections `templates` and `instances` are validated.
    """
    whole, faults = Unfolded(tree), list[Fault]()
    outer = of_all(tree.data.get("frame"), values)
    whole.framed = Scope(values, outer, {}) if outer else None
    templates, instances = mapping(tree.data, "templates"), mapping(tree.data, "instances")
    for name, template in templates.items():
        if isinstance(template, dict):
            here = ("templates", name)
            faults += [(fault.at(*here), ()) for fault in name_faults(template)]
    if not instances:
        return whole, faults
    if too_many := [(fault, ()) for fault in before_unfolding(tree.data, templates, instances)]:
        whole.data["instances"] = {}
        return whole, [*faults, *too_many]
    whole.data["instances"] = dict(instances)
    for section in SECTIONS:
        if isinstance(whole.data.get(section, {}), dict):
            whole.data[section] = dict(whole.data.get(section, {}))
    for name, given in instances.items():
        try:
            of = _template(name, given, templates)
        except ScenarioError as error:
            faults.append((error.at("instances", name), ()))
            continue
        if of is not None:
            faults += _put(whole, name, given, of, values, merge)
    return whole, faults


def of_all(given: Any, values: dict[str, float]) -> Frame | None:
    """The frame of the whole scenario; what is wrong with it the scenario itself says."""
    if given is None:
        return None
    try:
        return Placement.model_validate(given, context={"parameters": values}).moved
    except ValueError:
        return None


def _template(name: str, given: Any, templates: dict[str, Any]) -> dict[str, Any] | None:
    """The template of an instance; None where a shape is wrong."""
    if not re.fullmatch(NAME, name):
        hint = "Its name begins the names of its entries: letters, digits and _, a letter first."
        raise ScenarioError(f"not a name: {described(name)}", hint)
    word = given.get("template") if isinstance(given, dict) else None
    if not isinstance(word, str):
        return None
    if word not in templates:
        hint = known(word, templates) if templates else "Describe it under `templates`."
        raise ScenarioError(f"no template named {described(word)}", hint, ("template",))
    return templates[word] if isinstance(templates[word], dict) else None


def _put(
    whole: Unfolded, name: str, given: dict, of: dict, values: dict[str, float], merge: Merge
) -> Iterator[Fault]:
    """Put one instance among the entries; what is wrong with it."""
    view = whole.data["instances"][name] = dict(given)
    local, faults = _numbers(name, given, of, values)
    yield from faults
    if isinstance(given.get("parameters", {}), dict):
        view["parameters"] = {**mapping(of, "parameters"), **mapping(given, "parameters")}
    own = {entry: f"{name}_{entry}" for section in SECTIONS for entry in mapping(of, section)}
    here = {key: value for key, value in values.items() if key not in own} | local
    outer = whole.framed.frame if whole.framed else None
    frame = outer
    if (written := _written(given, of, merge)) is not None:
        view["frame"] = written
        frame, faults = _frame(name, written, here, outer)
        yield from faults
    whole.scopes[name] = Scope(here, frame, own)
    put: set[str] = set()
    for section in SECTIONS:
        if not isinstance(given.get(section, {}), dict):
            continue
        known_here, over = mapping(of, section), mapping(given, section)
        yield from _strangers(name, given["template"], section, over, known_here)
        view[section] = {
            entry: merge(data, over[entry]) if entry in over else data
            for entry, data in known_here.items()
            if over.get(entry, data) is not None
        }
        for entry in [entry for entry in view[section] if entry not in put]:
            yield from _entry(whole, own[entry], Origin(name, given["template"], section, entry))
        put |= known_here.keys()  # a name that comes twice is a fault of the template


def _strangers(
    name: str, template: str, section: str, over: dict, entries: dict
) -> Iterator[Fault]:
    """Entries an instance would change that its template does not have."""
    for entry in over:
        if entry not in entries:
            what = f"template {described(template)} has no {described(entry)} in its {section}"
            hint = known(entry, entries) if entries else ""
            yield ScenarioError(what, hint), ("instances", name, section, entry)


def _entry(whole: Unfolded, name: str, origin: Origin) -> Iterator[Fault]:
    """Put one entry among those of its section; what is wrong with that."""
    taken = whole.data.get(origin.section)
    if not isinstance(taken, dict):
        return
    if name in taken:
        what = f"its entry {described(origin.name)} is {described(name)}, a name that is taken"
        own = ".".join(map(str, origin.own))
        hint = f"There is {origin.section}.{name}: rename one, or change the entry at {own}."
        yield ScenarioError(what, hint), ("instances", origin.instance)
        return
    taken[name] = whole.data["instances"][origin.instance][origin.section][origin.name]
    whole.origins[origin.section, name] = origin


def _numbers(
    name: str, given: dict, of: dict, values: dict[str, float]
) -> tuple[dict[str, float], list[Fault]]:
    """The numbers of an instance's parameters: its own, and of the others those of the template."""
    defaults, mine = mapping(of, "parameters"), mapping(given, "parameters")
    here, there = ("instances", name, "parameters"), ("templates", given["template"], "parameters")
    faults: list[Fault] = []
    for key in mine:
        if key not in defaults:
            what = f"template {described(given['template'])} has no parameter {described(key)}"
            hint = known(key, defaults) if defaults else f"Name it in {'.'.join(there)}."
            faults.append((ScenarioError(what, hint), (*here, key)))
    found, wrong = numbers(mine, values, here)
    rest = {key: value for key, value in defaults.items() if key not in mine}
    others, more = numbers(rest, values | found, there)
    faults += [(error, ()) for error in (*wrong, *more)]
    return found | others, faults


def _written(given: dict, of: dict, merge: Merge) -> Any:
    """What an instance says of its frame, or its template where it says nothing; None: neither."""
    written = [one["frame"] for one in (of, given) if one.get("frame") is not None]
    both = len(written) > 1 and all(isinstance(one, dict) for one in written)
    return merge(written[0], written[1]) if both else written[-1] if written else None


def _frame(
    name: str, written: Any, values: dict[str, float], outer: Frame | None
) -> tuple[Frame | None, list[Fault]]:
    """The frame of an instance, seen from that of the scenario."""
    try:
        context = {"parameters": values, "frame": outer}
        return Placement.model_validate(written, context=context).moved, []
    except ValueError as error:  # as pydantic has it, or one of ours
        return None, [(error, ("instances", name, "frame"))]
