"""Named overrides of a scenario, `cases:`, each as a scenario of its own.

    cases:
      rigid: {}
      flexible: {extends: flexible_rod.yaml, solver: {end: 0.5 s}}

A case is the file, what the case extends merged over it, and the case's own keys over both.  A
`sweep` of its own replaces that of the file.
"""

import re
from copy import deepcopy

from trsim.errors import ScenarioError, described
from trsim.scenario.merge import merge, part
from trsim.scenario.text import Tree

NAME = r"[A-Za-z0-9][A-Za-z0-9_.+-]{0,59}"  # it is part of a file name


def cases(tree: Tree) -> dict[str, Tree]:
    """The tree of each case; of a scenario without cases its own, under the name ''.

    Raises ScenarioError where `cases` is not a mapping of mappings.
    """
    named = tree.data.get("cases")
    if named is None or named == {}:
        return {"": tree}
    if not isinstance(named, dict):
        what = f"must be a mapping of names to overrides, got {described(named)}"
        raise ScenarioError(what, path=("cases",), place=tree.place(("cases",)))
    for name in named:
        if not re.fullmatch(NAME, name):
            what, path = f"not a name of a case: {described(name)}", ("cases", name)
            hint = "It names a file: letters, digits and _ . + -, 60 at most, no sign first."
            raise ScenarioError(what, hint, path, tree.key_place(path))
    bare = _without(tree, {"cases"})
    return {name: _case(tree, bare, name) for name in named}


def _without(tree: Tree, sections: set[str]) -> Tree:
    """A tree without some of its sections; its data are shared."""
    data = {key: value for key, value in tree.data.items() if key not in sections}
    marks, keys = (
        {place: mark for place, mark in marks.items() if not place or place[0] not in sections}
        for marks in (tree.marks, tree.keys)
    )
    return Tree(data, marks, keys, tree.files)


def _case(tree: Tree, bare: Tree, name: str) -> Tree:
    """The tree of a case; bare: what all cases begin with."""
    path = ("cases", name)
    inner = part(tree, path)
    if inner.data is None:
        inner = Tree({})
    if not isinstance(inner.data, dict):
        what = f"must be a mapping of overrides, got {described(inner.data)}"
        raise ScenarioError(what, path=path, place=tree.place(path))
    if "cases" in inner.data:
        raise ScenarioError("a case has no cases of its own", "", path, tree.place(path))
    whole = _without(bare, {"sweep"} if "sweep" in inner.data else set())
    whole.data = deepcopy(whole.data)
    merge(whole, Tree(deepcopy(inner.data), inner.marks, inner.keys))
    return whole
