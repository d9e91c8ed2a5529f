"""What is read in one piece stays small: six parameters of a function, 500 lines of a file."""

import ast
from collections.abc import Iterator

import pytest

from .test_circles import ROOT, modules

MOST_PARAMETERS, MOST_LINES = 6, 500


def sources() -> dict[str, str]:
    """The text of every module."""
    return {name: path.read_text() for name, path in modules(ROOT).items()}


def crowded(tree: ast.AST) -> Iterator[tuple[int, str, int]]:
    """Where a function takes more than it may: line, name, how many; `self` and `cls` count not."""
    methods = {
        part
        for node in ast.walk(tree)
        if isinstance(node, ast.ClassDef)
        for part in node.body
        if not any("staticmethod" in ast.unparse(d) for d in getattr(part, "decorator_list", ()))
    }
    for node in ast.walk(tree):
        if isinstance(node, ast.FunctionDef | ast.AsyncFunctionDef):
            given = node.args
            number = len(given.posonlyargs) + len(given.args) + len(given.kwonlyargs)
            number -= node in methods
            if number > MOST_PARAMETERS:
                yield node.lineno, node.name, number


def test_no_function_takes_more_than_six():
    found = {name: [*crowded(ast.parse(text))] for name, text in sources().items()}
    assert {name: ones for name, ones in found.items() if ones} == {}


def test_no_file_is_longer_than_500_lines():
    lengths = {name: len(text.splitlines()) for name, text in sources().items()}
    assert {name: lines for name, lines in lengths.items() if lines > MOST_LINES} == {}


@pytest.mark.parametrize(
    "source, number",
    [
        ("def f(a, b, c, d, e, f, g): pass", 7),
        ("def f(a, b, /, c, d, *, e, f, g): pass", 7),
        ("class A:\n    def f(self, a, b, c, d, e, f, g): pass", 7),
        ("class A:\n    @staticmethod\n    def f(a, b, c, d, e, f, g): pass", 7),
        ("def f():\n    async def g(a, b, c, d, e, f, g): pass", 7),
    ],
)
def test_seven_are_found(source, number):
    assert [found[2] for found in crowded(ast.parse(source))] == [number]


@pytest.mark.parametrize(
    "source",
    [
        "def f(a, b, c, d, e, f): pass",
        "class A:\n    def f(self, a, b, c, d, e, f): pass",
        "class A:\n    @classmethod\n    def f(cls, a, b, c, d, e, f): pass",
        "def f(a, b, c, d, e, f, *more, **named): pass",
    ],
)
def test_six_are_none(source):
    assert not [*crowded(ast.parse(source))]
