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
    return {name: _case(tree, name) for name in named}


def _case(tree: Tree, name: str) -> Tree:
    path = ("cases", name)
    inner = part(tree, path)
    if inner.data is None:
        inner = Tree({})
    if not isinstance(inner.data, dict):
        what = f"must be a mapping of overrides, got {described(inner.data)}"
        raise ScenarioError(what, path=path, place=tree.place(path))
    if "cases" in inner.data:
        raise ScenarioError("a case has no cases of its own", "", path, tree.place(path))
    own = {"cases"} | ({"sweep"} if "sweep" in inner.data else set())
    whole = Tree(
        {key: value for key, value in deepcopy(tree.data).items() if key not in own},
        {place: mark for place, mark in tree.marks.items() if place[:1] not in {(k,) for k in own}},
        {place: mark for place, mark in tree.keys.items() if place[:1] not in {(k,) for k in own}},
        tree.files,
    )
    merge(whole, Tree(deepcopy(inner.data), inner.marks, inner.keys))
    return whole
