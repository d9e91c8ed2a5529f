"""The table of methods says what their modules do, and nobody asks a method for its name."""

import ast
from importlib import import_module
from pathlib import Path

import pytest

from trsim.scenario.methods import GGL, METHODS
from trsim.scenario.scenario import SolverSpec

ROOT = Path(__file__).parents[2]
MADE = [(name, files) for name in METHODS for files in METHODS[name].files.values()]


@pytest.mark.parametrize("name, files", MADE)
def test_modules(name, files):
    """The first is explicit where the method is, all others are implicit."""
    method = METHODS[name]
    modules = [import_module(f"trsim.solve.methods.{file}") for file in files]
    expected = [not method.explicit, *[True] * (len(files) - 1)]
    assert [module.IMPLICIT for module in modules] == expected
    assert len(files) == 1 + method.chooses


def test_twins_are_of_another_family():
    for name, method in METHODS.items():
        assert METHODS[method.twin].adaptive
        assert method.twin != name or name == "auto"


def test_what_is_documented():
    documents = (ROOT / "docs" / "scenarios.md").read_text()
    row = next(line for line in documents.splitlines() if line.startswith("| `solver` |"))
    assert all(name in row for name in METHODS)
    assert "`formulation` of radau and auto" in row
    assert {name for name, method in METHODS.items() if GGL in method.files} == {"radau", "auto"}


@pytest.mark.parametrize("name", METHODS)
@pytest.mark.parametrize("told", [None, True, False])
def test_touches_are_located(name, told):
    solver = SolverSpec(method=name, step=1e-3, locate_events=told)
    assert solver.locates == (told if told is not None else name != "rk4")


def named(node: ast.AST) -> bool:
    word = node.value if isinstance(node, ast.Constant) else None
    return isinstance(word, str) and (word in METHODS or word.startswith("scipy:"))


def test_nobody_asks_for_a_name():
    words = (*METHODS, "scipy:")
    for path in (ROOT / "trsim").rglob("*.py"):
        text = path.read_text()
        if not any(word in text for word in words):
            continue
        for node in ast.walk(ast.parse(text)):
            compared = isinstance(node, ast.Compare)
            called = isinstance(node, ast.Call) and getattr(node.func, "attr", "") == "startswith"
            asked = [one for one in ast.walk(node) if named(one)] if compared or called else []
            assert not asked, f"{path}:{node.lineno} asks for {asked[0].value}"
