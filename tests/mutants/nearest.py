"""In which order tests are tried on a mutation: those likely to notice it first."""

import re
from functools import cache
from pathlib import Path

OF_PROGRAM = re.compile(r"from (trsim(?:\.\w+)*) import (?:\(([^)]*)\)|(.*))|import (trsim[\w.]*)")


@cache
def test_files(root: Path) -> list[str]:
    """All test files but those of mutations, as they are called from the root."""
    found = [path.relative_to(root) for path in (root / "tests").rglob("test_*.py")]
    return sorted(path.as_posix() for path in found if path.parts[1] != "mutants")


@cache
def named(root: Path, test: str) -> frozenset[str]:
    """Modules of the program that a file imports, and what it imports of them."""
    found = set()
    for module, several, one, whole in OF_PROGRAM.findall((root / test).read_text()):
        found.add(module or whole)
        names = re.findall(r"\w+", several or one)
        found |= {f"{module}.{name}" for name in names}
    return frozenset(found)


@cache
def rooms_with(root: Path, module: str) -> frozenset[str]:
    """Rooms of the program with a file that imports a module."""
    files = [path.relative_to(root) for path in (root / "trsim").rglob("*.py")]
    return frozenset(path.parts[1] for path in files if module in named(root, path.as_posix()))


def words(name: str) -> set[str]:
    return set(name.split("_"))


def stages(root: Path, file: str) -> list[list[str]]:
    """Test files for a source file: its own; those that import it or share a word of its name;
    those of its room; those of rooms that import it; all others.

    A stage is one process of tests: what is not reached is not even imported.
    """
    module = file.removesuffix(".py").replace("/", ".")
    _, room, *_, last = module.split(".")
    found: list[list[str]] = [[], [], [], [], []]
    for test in test_files(root):
        path = Path(test)
        if path.stem == f"test_{last}":
            stage = 0
        elif module in named(root, test) or words(last) & words(path.stem) - {"test"}:
            stage = 1
        else:
            others = 3 if path.parts[1] in rooms_with(root, module) else 4
            stage = 2 if path.parts[1] == room else others
        found[stage].append(test)
    return [stage for stage in found if stage]
