"""Trees of scenarios merged, cut and changed at a path; every piece remembers its place.

Mappings are merged key by key.  Lists and scalars replace; so does a mapping whose `type` is
another; `null` removes the key.
"""

import re
from collections.abc import Iterable
from typing import Any

from trsim.errors import Place, ScenarioError, UsageError, described, known
from trsim.scenario.text import Tree, read
from trsim.units import quantity, unit

NAMED = (  # sections whose entries have names
    *("points", "bodies", "joints", "drives", "sensors", "forces", "contact_laws", "events"),
)
PARAMETERS = "parameters"
KNOWN = (PARAMETERS, *NAMED, "templates", "instances")  # --set changes what is there


def keys_of(dotted: str) -> list[str]:
    """The keys of a dotted path.  Those of `initial` have dots themselves: `bearing.rate`."""
    keys = dotted.split(".")
    coordinate = keys[0] == "initial" and len(keys) > 2 and keys[1] != "equilibrium"
    return [keys[0], ".".join(keys[1:])] if coordinate else keys


def mapping(data: Any, key: Any) -> dict[str, Any]:
    """What stands under a key, if it is a mapping; an empty one otherwise."""
    found = data.get(key) if isinstance(data, dict) else None
    return found if isinstance(found, dict) else {}


def merge(base: Tree, over: Tree) -> None:
    """Change `base` into `base` overridden by `over`."""
    before = mapping(base.data, PARAMETERS)
    for name, value in mapping(over.data, PARAMETERS).items():
        path = (PARAMETERS, name)
        same_dimension(before.get(name), value, path, over.marks.get(path))
    _merge(base, base.data, over.data, ())
    kept = set(_paths(base.data, ()))
    base.marks.update((path, place) for path, place in over.marks.items() if path in kept)
    base.keys.update((path, place) for path, place in over.keys.items() if path in kept)


def same_dimension(old: Any, new: Any, path: tuple, place: Place | None) -> None:
    """Refuse a quantity of another dimension for a parameter: expressions would take its number for
    one in the old unit."""
    before, after = (quantity(one, {}) if isinstance(one, str) else None for one in (old, new))
    if before and after and unit(before[1])[1] != unit(after[1])[1]:
        what = f"{described(new)} is of another dimension than {described(old)}, which it replaces"
        raise ScenarioError(what, f"write it in {before[1]}, or in a unit like it", path, place)


def _merge(base: Tree, old: Any, new: Any, path: tuple) -> None:
    for key, value in new.items():
        here, before = (*path, key), old.get(key)
        if _same_kind(before, value):
            _merge(base, before, value, here)
            continue
        if key in old:
            for gone in _paths(before, here):
                base.marks.pop(gone, None)
                base.keys.pop(gone, None)
        if value is None and key in old:
            del old[key]
        else:
            old[key] = value


def _same_kind(before: Any, value: Any) -> bool:
    """Whether two values are mappings to be merged; not if they are of different `type`."""
    if not (isinstance(before, dict) and isinstance(value, dict)):
        return False
    return before.get("type") in (None, value.get("type", before.get("type")))


def merged(base: Any, over: Any) -> Any:
    """Data overridden by other data; neither is changed, and what is the same is not copied."""
    if not _same_kind(base, over):
        return over
    found = dict(base)
    for key, value in over.items():
        if value is None and key in found:
            del found[key]
        else:
            found[key] = merged(found.get(key), value)
    return found


def part(tree: Tree, path: tuple) -> Tree:
    """What stands at a path, as a tree of its own."""
    data, n = tree.data, len(path)
    for key in path:
        data = data[key]
    places = list(_paths(data, path))
    marks, keys = (
        {place[n:]: marks[place] for place in places if place in marks}
        for marks in (tree.marks, tree.keys)
    )
    return Tree(data, marks, keys, tree.files)


def graft(tree: Tree, path: tuple, inner: Tree) -> None:
    """Put a tree in the place of what stands at a path."""
    data = tree.data
    for key in path[:-1]:
        data = data[key]
    data[path[-1]] = inner.data
    tree.marks.update({(*path, *place): mark for place, mark in inner.marks.items()})
    tree.keys.update({(*path, *place): mark for place, mark in inner.keys.items()})


def _paths(data: Any, path: tuple) -> Iterable[tuple]:
    """The path of everything in a tree."""
    yield path
    if isinstance(data, dict | list):
        for key, value in data.items() if isinstance(data, dict) else enumerate(data):
            yield from _paths(value, (*path, key))


def override(tree: Tree, text: str) -> None:
    """Change one value of a tree: `joints.B.clearance=0.3mm`."""
    keys, new, at, key_place = setting(text)
    put(tree, keys, new, at, key_place)


def setting(text: str) -> tuple[list[str], Any, Place, Place]:
    """The keys and the value of a --set, and their places."""
    dotted, equals, value = text.partition("=")
    keys = keys_of(dotted.strip())
    if not equals or not all(keys):
        raise UsageError(f"--set {described(text)}: write --set section.name.key=value")
    key_place = Place("--set", 0, 1, text)
    if keys[0] == "extends":
        what = "--set changes values once all files are merged; `extends` was read before"
        raise UsageError(what, "Write it in a small file that extends both.")
    at = Place("--set", 0, len(dotted) + 2, text)
    try:
        new = read(value, "--set", mapping=False).data
    except ScenarioError as error:
        raise ScenarioError(error.what, error.hint, tuple(keys), at) from None
    return keys, new, at, key_place


def put(tree: Tree, keys: list[str], new: Any, at: Place, key_place: Place) -> None:
    """Change one value of a tree, which remembers where it came from."""
    named = mapping(tree.data, keys[0])
    if len(keys) > 1 and keys[0] in KNOWN and keys[1] not in named:
        what = f"nothing named {described(keys[1])} in {keys[0]}"
        hint = _of_an_instance(tree, keys) or known(keys[1], named)
        raise ScenarioError(what, hint, (keys[0],), key_place)
    inner: Any = tree.data
    path: tuple = ()
    for k, word in enumerate(keys):
        key = _key(inner, word, path, key_place)
        path = (*path, key)
        tree.marks.setdefault(path, key_place)
        if k == len(keys) - 1:
            if keys[0] == PARAMETERS and len(keys) == 2 and isinstance(inner, dict):
                same_dimension(inner.get(key), new, path, at)
            inner[key] = new
        elif isinstance(inner, dict) and inner.get(key) is None:
            inner[key] = {}
        inner = inner[key]
    for here in _paths(new, path):
        tree.marks[here], tree.keys[here] = at, key_place


def _of_an_instance(tree: Tree, keys: list[str]) -> str:
    """Where an entry of an instance is changed; nothing if the name is none."""
    for instance in mapping(tree.data, "instances"):
        if keys[1].startswith(f"{instance}_"):
            own = keys[1].removeprefix(f"{instance}_")
            rest = ".".join((keys[0], own, *keys[2:]))
            return f"Entries of an instance are changed in it: instances.{instance}.{rest}"
    return ""


def _key(inner: Any, word: str, path: tuple, place: Place) -> str | int:
    """A word of a dotted path as the key of a mapping or the index of a list."""
    if isinstance(inner, dict):
        return word
    if isinstance(inner, list) and re.fullmatch("[0-9]{1,5}", word) and int(word) < len(inner):
        return int(word)
    what = f"has no entry {described(word)}: it is {described(inner)}"
    raise ScenarioError(what, path=path, place=place)
