"""Other rooms know elements by what these declare of themselves, not one of them by its name."""

import ast
from collections.abc import Iterator
from functools import cache
from pathlib import Path

import pytest

from trsim.elements import ELEMENTS

from .test_circles import ROOT, imported, modules

AT_HOME = ("trsim.elements", "trsim.studies")  # a study is run of what anybody could write
# keys of elements that are words of something else as well, where they stand alone in a string
WORDS = {
    "cam": "a scenario to begin with",
    "drive": "an entry of `drives`, in messages",
    "distance": "a kind of what is watched",
    "point": "a key of what is given by one, in messages and in pictures",
    "energy": "the energy book",
    "reaction": "a channel of joints and actuators",
    "section": "of a scenario, and of a study; a Poincare section",
    "sensor": "an entry of `sensors`, in messages",
    "gravity": "a key of the scenario",
    "marker": "how a figure shows a point",
    "link": "of an object in a result file that has two names",
    "parallel": "an array of the model",
    "planar": "a key of the scenario, and a fact of the mechanism",
}


@cache
def abroad(root: Path) -> list[tuple[str, ast.AST]]:
    """The modules outside the rooms that may name single elements, and their sources."""
    return [
        (name, ast.parse(path.read_text()))
        for name, path in modules(root).items()
        if not name.startswith(AT_HOME)
    ]


def called(function: ast.AST) -> str:
    """The last name of what is called."""
    return getattr(function, "attr", getattr(function, "id", ""))


def named(tree: ast.AST) -> Iterator[tuple[int, str]]:
    """Where a source has the key of an element as a string, and which.

    Asked for or compared with by a key, not even a word of something else may stand there.
    """
    asked: set[ast.AST] = set()
    for node in ast.walk(tree):
        if isinstance(node, ast.Compare):
            asked |= {part for side in (node.left, *node.comparators) for part in ast.walk(side)}
        elif isinstance(node, ast.Call) and called(node.func).endswith("load"):
            asked |= {*node.args}
    for node in ast.walk(tree):
        key = node.value if isinstance(node, ast.Constant) else ""
        if key in ELEMENTS and (node in asked or key not in WORDS):
            yield node.lineno, key


def test_no_room_imports_a_single_element():
    there = modules(ROOT)
    single = {f"trsim.elements.{key}" for key in ELEMENTS}
    assert single <= {*there}
    found = {name: single & {*imported(tree, there)} for name, tree in abroad(ROOT)}
    assert {name: ones for name, ones in found.items() if ones} == {}


def test_no_room_asks_for_an_element_by_its_name():
    found = {name: [*named(tree)] for name, tree in abroad(ROOT)}
    assert {name: ones for name, ones in found.items() if ones} == {}


def test_every_word_of_something_else_is_the_key_of_an_element():
    assert {*WORDS} <= {*ELEMENTS}


@pytest.mark.parametrize(
    "source, line",
    [
        ('if spec.type == "bushing":\n    pass', 1),
        ('found = 0\nspec = load("drive")', 2),
        ('KINDS = ("fixed", "pin")', 1),
        ('if spec.type in ("gravity",):\n    pass', 1),
    ],
)
def test_a_name_is_found(source, line):
    assert [where for where, _ in named(ast.parse(source))] == [line]


@pytest.mark.parametrize("source", ['check(name, there, "drive")', '"the bushing holds it"'])
def test_other_words_are_none(source):
    assert not [*named(ast.parse(source))]
