"""No circle of imports in trsim, none hidden in a function or behind TYPE_CHECKING."""

import ast
from collections.abc import Iterator
from graphlib import CycleError, TopologicalSorter
from pathlib import Path

import pytest

ROOT = Path(__file__).parents[1]


def modules(root: Path) -> dict[str, Path]:
    """Every module of the package, by its dotted name."""
    found = {}
    for path in (root / "trsim").rglob("*.py"):
        name = ".".join(path.relative_to(root).with_suffix("").parts)
        found[name.removesuffix(".__init__")] = path
    return found


def imported(tree: ast.AST, there: dict[str, Path]) -> Iterator[str]:
    """The modules of the package that a source imports, wherever it does."""
    for node in ast.walk(tree):
        if isinstance(node, ast.Import):
            yield from (alias.name for alias in node.names if alias.name in there)
        elif isinstance(node, ast.ImportFrom):
            for alias in node.names:
                name = f"{node.module}.{alias.name}"
                yield name if name in there else str(node.module)


def in_order(root: Path) -> list[str]:
    """The modules, each behind those it imports; raises CycleError."""
    there, graph = modules(root), {}
    for name, path in there.items():
        found = set(imported(ast.parse(path.read_text()), there))
        graph[name] = {one for one in found if one in there and one != name}
    return list(TopologicalSorter(graph).static_order())


def test_no_module_imports_one_that_imports_it():
    assert len(in_order(ROOT)) > 300


@pytest.mark.parametrize("hidden", ["", "if TYPE_CHECKING:\n    ", "def late():\n    "])
def test_a_circle_is_found_wherever_it_hides(tmp_path, hidden):
    (tmp_path / "trsim").mkdir()
    (tmp_path / "trsim" / "one.py").write_text("from trsim import two\n")
    (tmp_path / "trsim" / "two.py").write_text(f"{hidden}from trsim.one import word\n")
    with pytest.raises(CycleError):
        in_order(tmp_path)
