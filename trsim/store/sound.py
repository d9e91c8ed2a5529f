"""Whether a file is built like a result file: every object of its kind, where it is looked for.

A file may be damaged, or made by somebody else.  What is read of it later - tables as numbers,
names as texts, a status as one of ours - is looked at here once, before anything is read.
Links to other places are refused, as they make loops and lead out of the file.
"""

from collections.abc import Iterator
from typing import Any, NamedTuple

import h5py
import numpy as np
from h5py import h5a, h5d, h5g, h5l, h5o, h5t

from trsim.statuses import STATUSES
from trsim.store.content import attribute
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

    def __init__(self, path: str) -> None:
        super().__init__()
        self.path = path

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
    _root(file, root)
    _few(file, root)
    _tables(file, root)
    _points(file, root)
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
        found = Group(printable(path))
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


def _links(group: h5g.GroupID) -> list[tuple[bytes, int, int]]:
    """Names in a group, kinds of their links, and addresses of what these lead to."""
    found: list[tuple[bytes, int, int]] = []
    group.links.iterate(lambda name, info: found.append((name, info.type, info.u)), info=True)
    return found


def _item(item: h5d.DatasetID, path: str) -> Item:
    """Numbers or texts in one or two dimensions, inside the file."""
    try:
        kind, shape = item.dtype, item.shape
    except (TypeError, ValueError):
        raise Unsound(f"{printable(path)} is of a kind no result has") from None
    text = h5py.check_string_dtype(kind) is not None
    if shape is None or len(shape) > 2 or not (text or kind.kind in "fiub"):
        raise Unsound(f"{printable(path)} is of a kind no result has")
    plan = item.get_create_plist()
    if plan.get_layout() == h5d.VIRTUAL or plan.get_external_count():
        raise Unsound(f"{printable(path)} is kept in another file")
    size = kind.itemsize
    for n in shape:
        size *= n
    if size > ROOM and size > 2 * item.get_storage_size() + ROOM:
        raise Unsound(f"{printable(path)} says to have {shape[0]} rows, which are not in the file")
    unit: Any = attribute(item, b"units") if h5a.exists(item, b"units") else "-"
    texts = {"units": isinstance(unit, str | bytes), "long_name": True}
    if h5a.exists(item, b"long_name"):
        texts["long_name"] = _is_text(h5a.open(item, b"long_name"))
    for key, is_text in texts.items():
        if not is_text:
            raise Unsound(f"{printable(path)}: its {key} is no text")
    unit = unit.decode("utf-8", "surrogateescape") if isinstance(unit, bytes) else unit
    return Item(TEXT if text else NUMBERS, shape, unit)


def _is_text(attribute: h5a.AttrID) -> bool:
    return attribute.shape == () and attribute.get_type().get_class() == h5t.STRING


def _is_number(attribute: h5a.AttrID) -> bool:
    return attribute.shape == () and attribute.dtype.kind in "fiub"


# --- attributes ------------------------------------------------------------------------------


def _text(holder: Any, name: str) -> str:
    value = holder.attrs.get(name)
    if not isinstance(value, str):
        raise Unsound(f"{printable(holder.name)}: its {name} is no text")
    return value


def _number(holder: Any, *names: str) -> None:
    for name in names:
        coded = name.encode()
        if not h5a.exists(holder.id, coded) or not _is_number(h5a.open(holder.id, coded)):
            raise Unsound(f"{printable(holder.name)}: its {name} is no number")


def _scalars(holder: Any) -> None:
    """All attributes are texts or numbers."""
    for k in range(h5a.get_num_attrs(holder.id)):
        attribute = h5a.open(holder.id, index=k)
        if not _is_text(attribute) and not _is_number(attribute):
            raise Unsound(f"{printable(holder.name)}: {printable(repr(attribute.name))} is neither")


# --- what a result has -----------------------------------------------------------------------


def _root(file: h5py.File, root: Group) -> None:
    """The attributes of the file, and the rows of its channels."""
    for name in AT_ROOT:
        _text(file, name)
    if "content_sha256" in file.attrs:
        _text(file, "content_sha256")
    if file.attrs["status"] not in STATUSES:
        raise Unsound(f"its status is '{printable(file.attrs['status'])}', which no run has")
    root.want("time", NUMBERS)
    for name, item in root.items():
        if isinstance(item, Item) and item.shape:
            kind = TEXT if name.startswith("component.") else NUMBERS
            if item.kind != kind:
                raise Unsound(f"{printable(name)} is not there as {kind}")


def _few(file: h5py.File, root: Group) -> None:
    """What there is once: scenario, mechanism, summary, solver, peaks."""
    for name in ("solver", "provenance", "summary"):
        _scalars(file[name])
    scenario, mechanism, solver = root["scenario"], root["mechanism"], root["solver"]
    for name in ("text", "resolved", "sha256"):
        scenario.want(name, TEXT, 0)
    scenario.want_all({"files": TEXT, "files_sha256": TEXT}, alike=True)
    mechanism.want_all(OF_PARTS, alike=True)
    mechanism.want_all(dict.fromkeys(("redundant", "not_unique", "notes"), TEXT))
    _number(file["mechanism"], "mobility")
    if "warnings" in solver:
        solver.want("warnings", TEXT)
    if "steps" in file["solver"].attrs:
        _text(file["solver"], "method")
        _number(file["solver"], *OF_SOLVER)
    if root["peaks"]:
        root["peaks"].want_all(OF_PEAKS, alike=True)
    summary = file["summary"]
    if "rows" in summary.attrs:
        _number(summary, "time", "rows", "events")
    for name, _ in zip(root["summary"], root["summary"].groups(), strict=True):
        if name not in root["steps"]:
            raise Unsound(f"summary/{printable(name)} is of no contact")
        _number(summary[name], *OF_CONTACT)


def _tables(file: h5py.File, root: Group) -> None:
    """Events, and what is kept at them and at steps in contact."""
    events = root["events"]
    events.want_all(OF_EVENTS)
    events.want_all({k: v for k, v in (("did", TEXT), ("work", NUMBERS)) if k in events})
    user = file["events"].attrs.get("user", np.array([], object))
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


def _points(file: h5py.File, root: Group) -> None:
    """Portraits and sections."""
    for section in ("phase", "poincare"):
        for name, inner in zip(root[section], root[section].groups(), strict=True):
            group = file[section][name]
            _scalars(group)
            for axis in ("x", "y"):
                _text(group, axis)
                if axis in inner and "units" not in group[axis].attrs:
                    raise Unsound(f"{inner.path}{axis} has no units")
            there = [k for k in ("time", "x", "y") if k in inner or section == "poincare"]
            inner.want_all(dict.fromkeys(there, NUMBERS))
            if section == "poincare":
                _surface(group)


def _surface(group: Any) -> None:
    """Where a section is: at a channel's zero, at an interval, or at an onset."""
    if "every" in group.attrs:
        _number(group, "every")
    else:
        for name in ("at_onset",) if "at_onset" in group.attrs else ("when", "crosses"):
            _text(group, name)
