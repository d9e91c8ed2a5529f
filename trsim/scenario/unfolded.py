"""A tree in which the entries of instances stand among the others, and where they are written."""

from collections.abc import Iterable, Iterator
from typing import Any, NamedTuple

from trsim.errors import Place, TrsimError
from trsim.frame import Frame
from trsim.scenario.template import SECTIONS
from trsim.scenario.text import Path, Tree


class Scope(NamedTuple):
    """What the entries of one instance are read with."""

    parameters: dict[str, float]
    frame: Frame | None
    names: dict[str, str]  # of the template -> of the scenario


class Entry(NamedTuple):
    """An entry of an instance."""

    data: Any
    scope: Scope


class Origin(NamedTuple):
    """Which entry of which template an entry of the scenario is."""

    instance: str
    template: str
    section: str
    name: str

    @property
    def own(self) -> Path:
        """Where the instance says something of its own about it."""
        return ("instances", self.instance, self.section, self.name)

    @property
    def shared(self) -> Path:
        return ("templates", self.template, self.section, self.name)


class Unfolded(Tree):
    """A tree with the entries of its instances, which are what their templates make of them."""

    def __init__(self, tree: Tree) -> None:
        super().__init__(dict(tree.data), tree.marks, tree.keys, tree.files)
        self.origins: dict[Path, Origin] = {}  # (section, name) -> where it comes from
        self.scopes: dict[str, Scope] = {}  # of the instances
        self.framed: Scope | None = None  # of all other entries, where the scenario has a frame

    def scope(self, path: Path) -> Scope | None:
        """What an entry, and all in it, is read with; None: as the scenario itself."""
        origin = self.origins.get(tuple(path[:2]))
        return self.scopes[origin.instance] if origin else self.framed

    def entries(self) -> dict[str, Any]:
        """The data, ready to be validated."""
        found = dict(self.data)
        for section in (*SECTIONS, "totals"):
            if isinstance(found.get(section), dict):
                found[section] = {
                    name: Entry(data, scope) if (scope := self.scope((section, name))) else data
                    for name, data in found[section].items()
                }
        return found

    def written(self, path: Path) -> Path:
        """Where in the files a path is written: in an instance, or else in its template."""
        path = tuple(path)
        origin = self.origins.get(path[:2])
        if origin:
            own = {name: word for word, name in self.scopes[origin.instance].names.items()}
            path = (*origin.own, *(own.get(str(key), key) for key in path[2:]))
        if path[:1] == ("instances",) and len(path) > 2 and path not in self.marks:
            given = self.data["instances"].get(path[1])
            template = given.get("template") if isinstance(given, dict) else None
            shared: Path = ("templates", str(template), *path[2:])
            if self._depth(shared) >= self._depth(path):
                return shared
        return path

    def _depth(self, path: Path) -> int:
        """How much of a path stands in the files, but for the names of templates and instances."""
        while len(path) > 2 and path not in self.marks:
            path = path[:-1]
        return len(path)

    def place(self, path: Path) -> Place | None:
        return super().place(self.written(path))

    def key_place(self, path: Path) -> Place | None:
        return super().key_place(self.written(path))

    def value(self, path: Path) -> Any:
        """What is written for the value at the path of an entry; None where nothing is."""
        written, found = self.written(path), self.data
        inner = (*path[:2], *written[4:]) if tuple(path[:2]) in self.origins else written
        for key in inner:
            if isinstance(found, list) and isinstance(key, int) and key < len(found):
                found = found[key]
            else:
                found = found.get(key) if isinstance(found, dict) else None
        return found

    def meant(self, path: Iterable[str]) -> tuple[str, ...]:
        """The path of a validated entry for one through a template or an instance."""
        path = tuple(path)
        for (section, name), origin in self.origins.items():
            if path[:4] in (origin.own, origin.shared):
                return (str(section), str(name), *path[4:])
        return path

    def once(self, problems: Iterable[TrsimError]) -> Iterator[TrsimError]:
        """The problems as written: what is wrong in a template, once for all its instances."""
        found: dict[tuple, tuple[TrsimError, list[str]]] = {}
        for problem in problems:
            origin = self.origins.get(problem.path[:2])
            problem.path = self.written(problem.path)
            _, who = found.setdefault((problem.path, problem.what), (problem, []))
            who += [origin.instance] if origin else []
        for problem, who in found.values():
            shared = who and problem.path[:1] == ("templates",)
            if shared and set(who) < self.users(problem.path[1]):
                problem.hint = f"In {', '.join(dict.fromkeys(who))}.  {problem.hint}".strip()
            yield problem

    def users(self, template: str | int) -> set[str]:
        """The instances of a template."""
        return {o.instance for o in self.origins.values() if o.template == template}
