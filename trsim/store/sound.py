"""Whether a file is built like a result file: every object of its kind, where it is looked for.

A file may be damaged, or made by somebody else.  What is read of it later - tables as numbers,
names as texts, a status as one of ours - is looked at here once, before anything is read.
Links to other places are refused, as they make loops and lead out of the file.
"""

from collections.abc import Iterator
from typing import Any, NamedTuple

import h5py
import numpy as np
from h5py import h5a, h5d, h5g, h5l, h5o, h5s, h5t

from trsim.statuses import STATUSES
from trsim.store import made
from trsim.store.content import alone, attribute
from trsim.store.tables import AT_EVENTS

ROOM = 1 << 26  # bytes a dataset may have without being in the file: rows that were made room for
DEEPEST = 4  # groups in groups
MOST = 200_000  # objects
NUMBERS, TEXT = "numbers", "texts"
GROUPS = ("events", "peaks", "summary", "solver", "scenario", "mechanism", "provenance", "steps",
          "phase", "poincare")  # fmt: skip
AT_ROOT = ("format", "title", "status", "reason")
OF_PARTS = {**dict.fromkeys(("name", "section", "type", "joint", "bodies"), TEXT),
            "clearance": NUMBERS}  # fmt: skip
OF_CONTACT = ("impacts", "fastest_impact", "peak_force", "peak_time", "steps")
WORDS = {"kind", "element", "did", *(word for words in AT_EVENTS.values() for word in words)}
OF_EVENTS = {"time": NUMBERS, "kind": TEXT, "element": TEXT, "speed": NUMBERS, "angle": NUMBERS}
OF_PEAKS = {**dict.fromkeys(("channel", "extreme", "unit"), TEXT),
            **dict.fromkeys(("value", "time", "stroke"), NUMBERS)}  # fmt: skip
OF_SOLVER = ("steps", "tolerance", "energy_residual_relative")


class Unsound(ValueError):
    """What is not as it should be."""


class Item(NamedTuple):
    """A dataset."""

    kind: str
    shape: tuple[int, ...]
    unit: str


class Group(dict[str, Any]):
    """What is in a group, by name: an Item or a Group."""

    def __init__(self, path: str, item: h5g.GroupID) -> None:
        super().__init__()
        self.path, self.item = path, item

    @property
    def name(self) -> str:
        """The name in a message."""
        return self.path.rstrip("/") or "/"

    def opened(self, name: str) -> h5d.DatasetID:
        """A dataset of it."""
        return h5d.open(self.item, name.encode())

    def texts(self, name: str) -> list[str]:
        """The rows of a dataset of texts."""
        item = self.opened(name)
        if not item.get_type().is_variable_str():
            return list(h5py.Dataset(item).asstr()[:])
        found = np.empty(item.shape, made.TEXT)
        item.read(h5s.ALL, h5s.ALL, found, made.OBJECTS)
        return [text.decode() for text in found.tolist()]

    @property
    def attributes(self) -> dict[str, Any]:
        """The attributes as Python's own numbers and texts."""
        found = {name.decode(): attribute(self.item, name) for name in _names(self.item)}
        return {name: _own(value) for name, value in found.items()}

    def has(self, name: str) -> bool:
        """Whether the group has an attribute."""
        return bool(h5a.exists(self.item, name.encode()))

    def text(self, name: str) -> str:
        """An attribute that is a text."""
        value = _own(attribute(self.item, name.encode())) if self.has(name) else None
        if not isinstance(value, str):
            raise Unsound(f"{self.name}: its {name} is no text")
        return value

    def numbers(self, *names: str) -> None:
        """Check that there are attributes that are numbers."""
        for name in names:
            if not self.has(name) or not _is_number(h5a.open(self.item, name.encode())):
                raise Unsound(f"{self.name}: its {name} is no number")

    def scalars(self) -> None:
        """Check that all attributes are texts or numbers."""
        for name in _names(self.item):
            attribute = h5a.open(self.item, name)
            if not _is_text(attribute) and not _is_number(attribute):
                raise Unsound(f"{self.name}: {printable(repr(name))} is neither")

    def groups(self) -> Iterator["Group"]:
        for name, inner in self.items():
            if not isinstance(inner, Group):
                raise Unsound(f"{self.path}{printable(name)} is no group")
            yield inner

    def want(self, name: str, kind: str, rank: int = 1) -> Item:
        """A dataset that is there and of its kind."""
        found = self.get(name)
        if not isinstance(found, Item) or found.kind != kind or len(found.shape) != rank:
            raise Unsound(f"{self.path}{printable(name)} is not there as {kind}")
        return found

    def want_all(self, kinds: dict[str, str], alike: bool = False) -> None:
        """Several; alike: of one length."""
        lengths = {self.want(name, kind).shape for name, kind in kinds.items()}
        if alike and len(lengths) > 1:
            raise Unsound(f"the tables in {self.path} differ in length")


def check_sound(file: h5py.File) -> Group:
    """What is in a file.  Raises Unsound, or what h5py raises for a file that cannot be read."""
    root = _Walk().group(file.id, "/", h5o.get_info(file.id).addr, 0)
    for name in GROUPS:
        if not isinstance(root.get(name), Group):
            raise Unsound(f"it has no group {name}")
    _root(root)
    _few(root)
    _tables(file, root)
    _points(root)
    return root


def printable(name: str) -> str:
    """A name of a file in a message."""
    return name.encode("ascii", "replace").decode()[:80]


class _Walk:
    """The way through all objects of a file."""

    def __init__(self) -> None:
        self.groups: set[int] = set()
        self.seen: dict[int, Item] = {}  # by address: a dataset may have several names
        self.count = 0

    def group(self, group: h5g.GroupID, path: str, address: int, depth: int) -> Group:
        if address in self.groups or depth > DEEPEST:
            raise Unsound(f"{printable(path)} is a group in itself")
        self.groups.add(address)
        found = Group(printable(path), group)
        for coded, link, address in _links(group):
            self.count += 1
            try:
                name = coded.decode()
            except UnicodeDecodeError:
                raise Unsound("a name is no UTF-8") from None
            if self.count > MOST:
                raise Unsound(f"it has more than {MOST} objects")
            if link != h5l.TYPE_HARD:
                raise Unsound(f"{printable(path + name)} is a link to another place")
            if address in self.seen:
                found[name] = self.seen[address]
                continue
            item = h5o.open(group, coded)
            if isinstance(item, h5g.GroupID):
                found[name] = self.group(item, f"{path}{name}/", address, depth + 1)
            elif isinstance(item, h5d.DatasetID):
                found[name] = self.seen[address] = _item(item, path + name)
            else:
                raise Unsound(f"{printable(path + name)} is neither a group nor a dataset")
        return found


def _names(item: Any) -> list[bytes]:
    """The names of the attributes of an object."""
    found: list[bytes] = []
    h5a.iterate(item, found.append)
    return found


def _own(value: Any) -> Any:
    """The value of an attribute as Python's own; a text of fixed length stays one of bytes."""
    if type(value) is bytes:
        return value.decode("utf-8", "surrogateescape")
    single = isinstance(value, np.generic) or (isinstance(value, np.ndarray) and value.shape == ())
    return value.item() if single else value


def _links(group: h5g.GroupID) -> list[tuple[bytes, int, int]]:
    """Names in a group, kinds of their links, and addresses of what these lead to."""
    found: list[tuple[bytes, int, int]] = []
    group.links.iterate(lambda name, info: found.append((name, info.type, info.u)), info=True)
    return found


def _item(item: h5d.DatasetID, path: str) -> Item:
    """Numbers or texts in one or two dimensions, inside the file."""
    kind, shape = item.get_type(), item.shape
    text = kind.get_class() == h5t.STRING
    if shape is None or len(shape) > 2 or not (text or _plain(kind)):
        raise Unsound(f"{printable(path)} is of a kind no result has")
    plan = item.get_create_plist()
    if plan.get_layout() == h5d.VIRTUAL or plan.get_external_count():
        raise Unsound(f"{printable(path)} is kept in another file")
    size = kind.get_size()
    for n in shape:
        size *= n
    if size > ROOM and size > 2 * item.get_storage_size() + ROOM:
        raise Unsound(f"{printable(path)} says to have {shape[0]} rows, which are not in the file")
    unit: Any = attribute(item, b"units") if h5a.exists(item, b"units") else "-"
    if not isinstance(unit, str | bytes):
        raise Unsound(f"{printable(path)}: its units is no text")
    if h5a.exists(item, b"long_name") and not _is_text(h5a.open(item, b"long_name")):
        raise Unsound(f"{printable(path)}: its long_name is no text")
    unit = unit.decode("utf-8", "surrogateescape") if isinstance(unit, bytes) else unit
    return Item(TEXT if text else NUMBERS, shape, unit)


def _plain(kind: h5t.TypeID) -> bool:
    """Whether a type is one of numbers, as numpy has them."""
    if kind.get_class() == h5t.FLOAT and kind.equal(made.NUMBERS):  # as most are
        return True
    try:
        return kind.dtype.kind in "fiub"
    except (TypeError, ValueError):
        return False


def _is_text(attribute: h5a.AttrID) -> bool:
    return alone(attribute) and attribute.get_type().get_class() == h5t.STRING


def _is_number(attribute: h5a.AttrID) -> bool:
    return alone(attribute) and _plain(attribute.get_type())


# --- what a result has -----------------------------------------------------------------------


def _root(root: Group) -> None:
    """The attributes of the file, and the rows of its channels."""
    told = {name: root.text(name) for name in AT_ROOT}
    if root.has("content_sha256"):
        root.text("content_sha256")
    if told["status"] not in STATUSES:
        raise Unsound(f"its status is '{printable(told['status'])}', which no run has")
    root.want("time", NUMBERS)
    for name, item in root.items():
        if isinstance(item, Item) and item.shape:
            kind = TEXT if name.startswith("component.") else NUMBERS
            if item.kind != kind:
                raise Unsound(f"{printable(name)} is not there as {kind}")


def _few(root: Group) -> None:
    """What there is once: scenario, mechanism, summary, solver, peaks."""
    for name in ("solver", "provenance", "summary"):
        root[name].scalars()
    scenario, mechanism, solver = root["scenario"], root["mechanism"], root["solver"]
    for name in ("text", "resolved", "sha256"):
        scenario.want(name, TEXT, 0)
    scenario.want_all({"files": TEXT, "files_sha256": TEXT}, alike=True)
    mechanism.want_all(OF_PARTS, alike=True)
    mechanism.want_all(dict.fromkeys(("redundant", "not_unique", "notes"), TEXT))
    mechanism.numbers("mobility")
    if "warnings" in solver:
        solver.want("warnings", TEXT)
    if solver.has("steps"):
        solver.text("method")
        solver.numbers(*OF_SOLVER)
    if root["peaks"]:
        root["peaks"].want_all(OF_PEAKS, alike=True)
    summary = root["summary"]
    if summary.has("rows"):
        summary.numbers("time", "rows", "events")
    for name, contact in zip(summary, summary.groups(), strict=True):
        if name not in root["steps"]:
            raise Unsound(f"summary/{printable(name)} is of no contact")
        contact.numbers(*OF_CONTACT)


def _tables(file: h5py.File, root: Group) -> None:
    """Events, and what is kept at them and at steps in contact."""
    events = root["events"]
    events.want_all(OF_EVENTS)
    events.want_all({k: v for k, v in (("did", TEXT), ("work", NUMBERS)) if k in events})
    user = file["events"].attrs["user"] if events.has("user") else np.array([], object)
    if not isinstance(user, np.ndarray) or not all(isinstance(n, str) for n in user.flat):
        raise Unsound("events: its user is no list of names")
    tables = [events, *root["steps"].groups()]
    for name, words in AT_EVENTS.items():
        if name in root:
            if not isinstance(root[name], Group):
                raise Unsound(f"{name} is no group")
            tables.append(root[name])
            for word in words:
                root[name].want(word, TEXT)
    for table in tables:
        table.want("time", NUMBERS)
        for name, item in table.items():
            if not isinstance(item, Item) or not item.shape:
                raise Unsound(f"{table.path}{printable(name)} has no rows")
            if item.kind != NUMBERS and name not in WORDS:
                raise Unsound(f"{table.path}{printable(name)} is not there as {NUMBERS}")


def _points(root: Group) -> None:
    """Portraits and sections."""
    for section in ("phase", "poincare"):
        for inner in root[section].groups():
            inner.scalars()
            for axis in ("x", "y"):
                inner.text(axis)
                if axis in inner and not h5a.exists(inner.item, b"units", obj_name=axis.encode()):
                    raise Unsound(f"{inner.path}{axis} has no units")
            there = [k for k in ("time", "x", "y") if k in inner or section == "poincare"]
            inner.want_all(dict.fromkeys(there, NUMBERS))
            if section == "poincare":
                _surface(inner)


def _surface(group: Group) -> None:
    """Where a section is: at a channel's zero, at an interval, or at an onset."""
    if group.has("every"):
        group.numbers("every")
    else:
        for name in ("at_onset",) if group.has("at_onset") else ("when", "crosses"):
            group.text(name)
