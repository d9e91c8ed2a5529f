"""A scenario file and all it extends, tables and --set included, as one tree.

    extends: mechanism.yaml           or a list; a later one overrides an earlier one

A file found this way, and a CSV table, lies in the folder of the scenario or below.  Where the
scenario is in a project, a folder called `scenarios` or one that holds a file `trsim-root`, it
may lie anywhere in the nearest such folder.  Links are followed before this is checked.

Mappings are merged key by key.  Lists and scalars replace; so does a mapping whose `type` is
another; `null` removes the key.  A CSV table is read where its file name stands, so that the
tree is complete in itself.  A case of `cases:` may extend files, and other cases by their names; it
holds them then.
"""

import hashlib
import os
from collections.abc import Callable, Iterable
from copy import deepcopy
from functools import partial
from pathlib import Path
from typing import Any

from trsim.errors import (
    FileError,
    Place,
    ScenarioError,
    described,
    known,
    unreadable,
)
from trsim.numbers import Measured, angular, number, written
from trsim.scenario import wide_table
from trsim.scenario.drawn import Drawings
from trsim.scenario.merge import graft, mapping, merge, override, part
from trsim.scenario.table import rows
from trsim.scenario.text import LARGEST, Tree, decoded, read

SUFFIXES = (".yaml", ".yml")
DEEPEST = 8  # levels of extends
MOST = 40  # files
MOST_OF_CASES, BYTES = 1000, 4_000_000  # files that cases extend, again and again; all together
SWEPT = ("cases", "sweep")  # sections that make several scenarios of one


def expand(path: str | os.PathLike, sets: Iterable[str] = ()) -> tuple[Tree, str]:
    """The tree of a scenario file, and its text as given."""
    if (missing := unreadable(path)) is not None:
        raise missing
    real = Path(path).resolve()
    files = _Files(_root(real.parent))
    data = files.content(real, str(path))
    tree = files.tree(real, str(path), data, ())
    return _finished(tree, files, real.parent, sets), decoded(data, str(path))


def expand_text(
    text: str, sets: Iterable[str] = (), name: str = "<text>", folder: Path | None = None
) -> Tree:
    """The tree of a text; it extends files only where a folder is given."""
    files = _Files(_root(folder.resolve()) if folder else None)
    tree = read(text, name)
    files.digests[name] = hashlib.sha256(text.encode("utf-8", "replace")).hexdigest()
    tree = files.extended(tree, folder.resolve() if folder else None, ())
    return _finished(tree, files, folder, sets)


def _finished(tree: Tree, files: "_Files", folder: Path | None, sets: Iterable[str]) -> Tree:
    for text in sets:
        override(tree, text)
    files.inline_tables(tree, tree.data, folder, ())
    tree.files = files.digests
    return tree


def _extends(case: Any) -> bool:
    return isinstance(case, dict) and "extends" in case


def _root(folder: Path) -> Path:
    for ancestor in (folder, *folder.parents):
        if ancestor.name == "scenarios" or (ancestor / "trsim-root").is_file():
            return ancestor
    return folder


class _Files:
    """The files one scenario is made of."""

    def __init__(self, root: Path | None) -> None:
        self.root = root
        self.digests: dict[str, str] = {}
        self.folders: dict[str, Path] = {}  # name of a YAML file -> where it lies
        self.count, self.bytes, self.most = 0, 0, MOST

    def content(self, real: Path, name: str) -> bytes:
        self.count += 1
        if self.count > self.most:
            raise ScenarioError(f"more than {self.most} files")
        try:
            with real.open("rb") as file:
                data = file.read(LARGEST + 1)
        except OSError as error:
            raise FileError(f"{name}: {error.strerror}", file=name) from None
        self.bytes += len(data)
        if self.count > MOST and self.bytes > BYTES:
            raise ScenarioError(f"the files of all cases have more than {BYTES // 1000000} MB")
        self.digests[name] = hashlib.sha256(data).hexdigest()
        return data

    def tree(self, real: Path, name: str, data: bytes, above: tuple[Path, ...]) -> Tree:
        tree = read(decoded(data, name), name)
        self.folders[name] = real.parent
        return self.extended(tree, real.parent, (*above, real))

    def extended(
        self,
        tree: Tree,
        folder: Path | None,
        above: tuple[Path, ...],
        of_case: Callable[[Any], Tree | None] = lambda _: None,
    ) -> Tree:
        """The tree merged over what its key `extends` names, and so each of its cases.

        of_case: the tree of the case of a name; None where it is the name of a file.
        """
        self.cases(tree, folder, above)
        names = tree.data.pop("extends", None)
        if names is None:
            return tree
        single = not isinstance(names, list)
        base, drawings = Tree({}), Drawings()
        for k, name in enumerate([names] if single else names):
            where = ("extends",) if single else ("extends", k)
            place: Any = tree.place(where)
            try:
                whole: Any = of_case(name)
                is_file = whole is None
                if is_file:
                    whole = self.tree(*self.file(name, place, folder, above), above)
                drawings.agree(name, whole.data, is_file)
            except (ScenarioError, FileError) as error:
                if error.place is not None:
                    raise
                raise ScenarioError(error.what, error.hint, where, place) from None
            merge(base, whole)
        merge(base, tree)
        return base

    def file(
        self, name: Any, place: Any, folder: Path | None, above: tuple[Path, ...]
    ) -> tuple[Path, str, bytes]:
        """A file that is extended: where it is, what it is called, what is in it."""
        real = self.inside(name, folder, SUFFIXES)
        if any(os.path.samefile(real, other) for other in above):
            raise ScenarioError(f"{described(name)} extends itself")
        if len(above) >= DEEPEST:
            raise ScenarioError(f"more than {DEEPEST} levels of extends")
        shown = _beside(name, place)
        return real, shown, self.content(real, shown)

    def cases(self, tree: Tree, folder: Path | None, above: tuple[Path, ...]) -> None:
        """Put what a case extends into the case, but for the cases and the sweep of that file."""
        cases, made = mapping(tree.data, "cases"), set[str]()

        def whole(name: str, below: tuple[str, ...]) -> None:
            """Complete a case; `below`: those that extend it."""
            if name in made or not isinstance(cases[name], dict):
                return
            if name in below:
                raise ScenarioError(f"case {described(name)} extends itself")
            if "extends" in cases[name]:
                inner = part(tree, ("cases", name))
                own = {key: inner.data.pop(key) for key in SWEPT if key in inner.data}
                more = partial(base, below=(*below, name))
                graft(tree, ("cases", name), self.extended(inner, folder, above, more))
                for key in SWEPT:
                    cases[name].pop(key, None)
                cases[name] |= own
            made.add(name)

        def base(name: Any, below: tuple[str, ...]) -> Tree | None:
            """What a case that others extend is, without its sweep; None of a file."""
            if not isinstance(name, str) or name.endswith(SUFFIXES):
                return None
            if name not in cases:
                what = f"no case named {described(name)}"
                raise ScenarioError(what, known(name, cases) or "a file ends in .yaml")
            whole(name, below)
            inner = part(tree, ("cases", name))
            data = inner.data if isinstance(inner.data, dict) else {}
            kept = {key: deepcopy(value) for key, value in data.items() if key not in SWEPT}
            return Tree(kept, inner.marks, inner.keys, inner.files)

        self.most = MOST_OF_CASES if any(map(_extends, cases.values())) else self.most
        for name in cases:
            whole(name, ())

    def inside(self, name: Any, folder: Path | None, suffixes: tuple[str, ...]) -> Path:
        """The regular file `name` says, refused outside the root."""
        if not isinstance(name, str) or not name or "\0" in name:
            raise ScenarioError(f"must be the name of a file, got {described(name)}")
        if folder is None or self.root is None:
            raise ScenarioError("a text without a folder cannot name files")
        if os.path.isabs(name) or "\\" in name or ":" in name:
            raise ScenarioError(f"{described(name)} is not relative to this file")
        if not name.endswith(suffixes):
            raise ScenarioError(f"{described(name)} does not end in {' or '.join(suffixes)}")
        try:
            real = (folder / name).resolve()
            if not real.is_relative_to(self.root):
                raise ScenarioError(
                    f"{described(name)} lies outside {self.root.name}/",
                    "An empty file `trsim-root` in a folder above marks the folder of a project.",
                )
            if real.is_file():
                return real
            if real.exists():
                raise ScenarioError(f"{described(name)} is not a regular file")
            found = [p.name for p in real.parent.iterdir() if p.suffix in suffixes][:200]
        except (OSError, RuntimeError):
            found = []
        hint = f"There is no {suffixes[0]} file in that folder."
        hint = known(name, sorted(found)) if found else hint
        raise ScenarioError(f"there is no file {described(name)}", hint)

    def inline_tables(self, tree: Tree, data: Any, folder: Path | None, path: tuple) -> None:
        """Replace each `table: file.csv` by its rows."""
        for key, value in list(data.items() if isinstance(data, dict) else enumerate(data)):
            here = (*path, key)
            if here == ("report",) or (here[0], here[2:]) == ("cases", ("report",)):
                continue
            if isinstance(value, dict | list):
                self.inline_tables(tree, value, folder, here)
            elif key == "table" and isinstance(value, str):
                place: Any = tree.place(here)
                try:
                    real = self.inside(
                        value, self.folders.get(place.file, folder), (".csv", ".CSV")
                    )
                    shown = _beside(value, place)
                    columns = data.get("columns") if isinstance(data, dict) else None
                    of_kind = wide_table.rows if path[-1] == "components" else rows
                    if of_kind is wide_table.rows:
                        data.pop("columns", None)  # they are chosen: of rows there are none
                    data[key], bare = of_kind(self.content(real, shown), shown, columns)
                    if bare:
                        tree.bare[here] = f"{' and '.join(bare)} of {shown}"
                except (ScenarioError, FileError) as error:
                    place = error.place or place
                    raise ScenarioError(error.what, error.hint, here, place) from None


def _beside(name: str, place: Place | None) -> str:
    """A file name as seen from where the file that names it was seen from."""
    return os.path.normpath(Path(place.file if place else ".").parent / name)


# --- parameters ------------------------------------------------------------------------------


def parameters(tree: Tree) -> tuple[dict[str, float], list[ScenarioError]]:
    """The value of each parameter, SI, and what is wrong with them."""
    given = tree.data.get("parameters")
    if given is None:
        return {}, []
    if not isinstance(given, dict):
        what = f"must be a mapping of names to numbers, got {described(given)}"
        return {}, [ScenarioError(what, path=("parameters",))]
    return numbers(given, {}, ("parameters",))


def numbers(
    given: dict[str, Any], others: dict[str, float], path: tuple[str, ...]
) -> tuple[dict[str, float], list[ScenarioError]]:
    """The value of each entry of a mapping, which may use others and those before it."""
    values: dict[str, float] = {}
    problems: list[ScenarioError] = []
    for name, value in given.items():
        if len(problems) == MOST:
            break
        try:
            if not isinstance(value, str | int | float):
                raise ScenarioError(f"must be a number, got {described(value)}")
            there = others | values
            found = written(value, there) if isinstance(value, str) else None
            values[name] = number(found[0] if found else value, ("-",), there)
            if found and found[1]:
                values[name] = Measured.of(values[name], found[1])
            elif isinstance(value, str) and found is None and angular(value, there):
                values[name] = Measured.of(values[name], "")
        except ScenarioError as error:
            later = [other for other in given if f"'{other}'" in error.what and other != name]
            hint = f"{later[0]} is defined after {name}." if later else error.hint
            problems.append(ScenarioError(error.what, hint, (*path, name)))
            values[name] = 1.0  # so that what uses it is not reported as well
    return values, problems
