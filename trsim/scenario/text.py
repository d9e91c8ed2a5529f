"""YAML text to plain data, and where in the text each piece stands.

The grammar is a small part of YAML 1.2: mappings, lists and scalars of the core schema.  Tags,
anchors, aliases, duplicate keys and further documents are refused, so nothing in a file can run
or grow.  `no`, `on`, dates, 1:30 and 010 are text, and 010 is no number either; keys always are.
"""

import math
import re
from collections.abc import Iterator
from dataclasses import dataclass, field
from typing import Any

import yaml

from trsim.errors import Place, ScenarioError, described

LARGEST = 1_000_000  # bytes
DEEPEST = 20  # nested mappings and lists
MOST = 20_000  # scalars, lists and mappings

Path = tuple[str | int, ...]
LOADER: Any = getattr(yaml, "CSafeLoader", yaml.SafeLoader)
NODES = (yaml.ScalarEvent, yaml.MappingStartEvent, yaml.SequenceStartEvent, yaml.AliasEvent)
ENDS = (yaml.MappingEndEvent, yaml.SequenceEndEvent)

_UNPRINTABLE = re.compile(r"[^\t\n\r\x20-\x7e\x85\xa0-\ud7ff\ue000-\ufffd\U00010000-\U0010ffff]")
_CONSTANTS = {"": None, "~": None} | {
    form(word): value
    for word, value in (("null", None), ("true", True), ("false", False))
    for form in (str.lower, str.capitalize, str.upper)
}
_INTEGER = re.compile(r"[-+]?(0|[1-9][0-9]*)")
_BASED = re.compile(r"0o[0-7]+|0x[0-9a-fA-F]+")
_FLOAT = re.compile(r"[-+]?(\.[0-9]+|(0|[1-9][0-9]*)(\.[0-9]*)?)([eE][-+]?[0-9]+)?")
_NOT_FINITE = re.compile(r"[-+]?\.(inf|Inf|INF)|\.(nan|NaN|NAN)")

_HINTS = {
    "mapping values are not allowed": "Two ':' on one line?  Quote a text that contains ': '.",
    "cannot start any token": "Quote a text that starts with a special character.",
    "expected ',' or": "A comma or a closing bracket is missing.",
    "did not find expected key": "Check the indentation of this line and the one before.",
    "could not find expected ':'": "A key needs ': ' after it.",
}


@dataclass
class Tree:
    """Plain data, and for each path the place of its value and of its key."""

    data: Any
    marks: dict[Path, Place] = field(default_factory=dict)
    keys: dict[Path, Place] = field(default_factory=dict)
    files: dict[str, str] = field(default_factory=dict)  # name -> sha256
    bare: dict[Path, str] = field(default_factory=dict)  # tables -> columns without a unit

    def place(self, path: Path) -> Place | None:
        """Where a fault in the value at `path`, or in what holds it, is best shown."""
        path = tuple(path)
        while path and path not in self.marks:
            path = path[:-1]
        return self.marks.get(path)

    def key_place(self, path: Path) -> Place | None:
        return self.keys.get(tuple(path)) or self.place(path)


def _too_large(file: str) -> tuple[str, str]:
    """What, and the hint."""
    hint = "Move long tables into CSV files: `table: name.csv`."
    if file.lower().endswith(".csv"):
        hint = "Thin it out: an Akima curve needs few points."
    return f"{file} is larger than {LARGEST // 1_000_000} MB", hint


def decoded(data: bytes, file: str) -> str:
    """UTF-8 bytes as text; a byte order mark is dropped."""
    if len(data) > LARGEST:
        raise ScenarioError(*_too_large(file))
    try:
        return data.decode("utf-8-sig")
    except UnicodeDecodeError as error:
        before = data[: error.start].decode("utf-8", "replace")
        lines = [*before.splitlines(), ""] if before.endswith(("\n", "\r")) else before.splitlines()
        line = lines[-1] if lines else ""
        place = Place(file, max(len(lines), 1), len(line) + 1, line)
        what = f"not UTF-8: byte 0x{data[error.start]:02x}"
        raise ScenarioError(what, "Save the file as UTF-8.", place=place) from None


def read(text: str, file: str = "<text>", mapping: bool = True) -> Tree:
    """The plain data of a YAML text, with marks.  Raises ScenarioError at the first fault."""
    text = text.removeprefix("\ufeff")
    if len(text) > LARGEST:
        raise ScenarioError(*_too_large(file))
    lines = text.splitlines()

    def place(line: int, column: int) -> Place:
        return Place(file, line + 1, column + 1, lines[line] if line < len(lines) else "")

    bad = _UNPRINTABLE.search(text)
    if bad:
        line = len(text[: bad.start() + 1].splitlines()) - 1
        column = bad.start() - (text.rfind("\n", 0, bad.start()) + 1)
        what = f"character {ord(bad[0]):#04x} cannot stand in a scenario"
        raise ScenarioError(what, "Delete it.", place=place(line, column))
    events = _events(text, place)
    tree = Tree(None)
    first = next(events, None)
    if first is not None:
        tree.data = _node(first, events, tree, (), place)
        if next(events, None) is not None:  # pragma: no cover - refused by _events
            raise ScenarioError("more than one document")
    if mapping and not isinstance(tree.data, dict):
        what = "the scenario is empty" if tree.data is None else "a scenario is a mapping"
        got = "" if tree.data is None else f", got {described(tree.data)}"
        raise ScenarioError(what + got, "Write `key: value` lines.", place=place(0, 0))
    return tree


def _events(text: str, place: Any) -> Iterator[Any]:
    """The nodes of the one document, as YAML events; everything outside our grammar refused."""

    def at(event: Any) -> Place:
        found: Place = place(event.start_mark.line, event.start_mark.column)
        return found

    documents = 0
    try:
        following = LOADER(text).get_event
        for count, event in enumerate(iter(following, None)):
            kind = type(event)
            if kind in NODES:
                if event.anchor or kind is yaml.AliasEvent:
                    what = "anchors and aliases are not allowed"
                    hint = "Use `parameters` or `extends`."
                    raise ScenarioError(what, hint, place=at(event))
                if event.tag:
                    what = f"tags are not allowed: {described(event.tag)}"
                    hint = "Quote a text that starts with '!'."
                    raise ScenarioError(what, hint, place=at(event))
            elif kind is yaml.DocumentStartEvent:
                documents += 1
                if documents > 1:
                    what, hint = "a second document starts here", "Put it into a file of its own."
                    raise ScenarioError(what, hint, place=at(event))
                continue
            elif kind is yaml.StreamEndEvent:
                return
            elif kind not in ENDS:
                continue
            if count > MOST:
                hint = "Long tables belong into CSV files: `table: name.csv`."
                raise ScenarioError(f"more than {MOST} values", hint, place=at(event))
            yield event
    except yaml.MarkedYAMLError as error:
        mark: Any = error.problem_mark or error.context_mark
        if error.context_mark and mark.line >= len(text.splitlines()):
            mark = error.context_mark  # where it was opened says more than the end of the file
        where = place(mark.line, mark.column) if mark else None
        problem = error.problem or error.context or "unreadable"
        if "nesting depth" in problem:  # of a C loader, which reads ahead of the events it gives
            what = f"nested more than {DEEPEST} deep"
            raise ScenarioError(what, place=place(*too_deep(text))) from None
        hint = next((hint for part, hint in _HINTS.items() if part in problem), "")
        if where and "\t" in where.excerpt[: where.column]:
            hint = "Indent with spaces: YAML does not allow tabs."
        raise ScenarioError(f"not YAML: {problem}", hint, place=where) from None
    except (yaml.YAMLError, ValueError, RecursionError) as error:
        if isinstance(error, ScenarioError):
            raise
        raise ScenarioError(f"not YAML: {described(str(error))}", place=place(0, 0)) from None


def too_deep(text: str) -> tuple[int, int]:
    """Line and column, from 0, of the first collection that stands in more than DEEPEST others."""
    within = 0
    for event in yaml.parse(text, Loader=yaml.SafeLoader):
        if isinstance(event, yaml.CollectionStartEvent):
            mark: Any = event.start_mark
            if within > DEEPEST:
                return mark.line, mark.column
            within += 1
        elif isinstance(event, yaml.CollectionEndEvent):
            within -= 1
    return 0, 0


def _node(event: Any, events: Iterator[Any], tree: Tree, path: Path, place: Any) -> Any:
    """The data of the node that `event` begins; its marks go into the tree."""
    mark, kind = event.start_mark, type(event)
    where = place(mark.line, mark.column)
    if len(path) > DEEPEST:
        raise ScenarioError(f"nested more than {DEEPEST} deep", place=where)
    tree.marks[path] = where
    if kind is yaml.ScalarEvent:
        return _scalar(event, path, where)
    if kind is yaml.SequenceStartEvent:
        items: list[Any] = []
        while type(event := next(events)) is not yaml.SequenceEndEvent:
            items.append(_node(event, events, tree, (*path, len(items)), place))
        return items
    # what is wrong with a mapping is shown at its key, not at the first key inside
    tree.marks[path] = tree.keys.get(path, where)
    mapping: dict[str, Any] = {}
    while type(event := next(events)) is not yaml.MappingEndEvent:
        mark = event.start_mark
        at = place(mark.line, mark.column)
        if type(event) is not yaml.ScalarEvent:
            hint = "Quote a text that starts with a bracket."
            raise ScenarioError("a key must be a word", hint, path, at)
        key = event.value
        here = (*path, key)
        if key in mapping:
            what = f"key {described(key)} stands here twice"
            raise ScenarioError(what, f"First on line {tree.keys[here].line}.", path, at)
        if not key.isprintable() or len(key) > 200:
            raise ScenarioError("not a key", "", path, at)
        tree.keys[here] = at
        mapping[key] = _node(next(events), events, tree, here, place)
    return mapping


def _scalar(event: Any, path: Path, where: Place) -> Any:
    """A scalar by the YAML 1.2 core schema; quoted ones are text."""
    text = event.value
    if not text.isprintable() and _UNPRINTABLE.search(text):
        raise ScenarioError("a character that cannot be printed", "Delete it.", path, where)
    if not event.implicit[0]:
        return text
    if text in _CONSTANTS:
        return _CONSTANTS[text]
    if _INTEGER.fullmatch(text) and len(text) < 16:
        return int(text)
    if _BASED.fullmatch(text) and len(text) < 16:
        return int(text, 0)
    if _FLOAT.fullmatch(text):
        value = float(text)
        if math.isfinite(value):
            return value
    elif not _NOT_FINITE.fullmatch(text):
        return text
    raise ScenarioError(f"not a finite number: {described(text)}", "", path, where)
