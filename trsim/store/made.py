"""What a result file is made of, in calls of HDF5 itself.

h5py's own objects cost more than all that HDF5 does: a file of a short run has a hundred datasets
and two hundred attributes.  Types, spaces and lists of properties are made once in a process.  What
is made is the same as h5py makes.  What was told is remembered: reading it again for the content
hash would cost as much as writing it.
"""

import hashlib
from collections.abc import Iterable, Mapping
from functools import cache, lru_cache
from typing import Any, NamedTuple

import h5py
import numpy as np
from h5py import h5a, h5d, h5ds, h5g, h5o, h5p, h5s, h5t

TEXT = h5py.string_dtype()
NUMBERS = h5t.py_create(np.dtype("f8"))
TEXTS, OBJECTS = h5t.py_create(TEXT, logical=True), h5t.py_create(TEXT)  # in files, in memory
SCALAR = h5s.create(h5s.SCALAR)
# as HDF5 has them in memory: what uses a scale, and the number and place of scales of a dimension
USE = np.dtype({"names": ["dataset", "dimension"], "formats": ["u8", "u4"], "itemsize": 16})
LIST = np.dtype([("number", np.uintp), ("place", np.uintp)])
Scaled = tuple[str, tuple[str, ...]]  # a dataset, and the scales of its dimensions; "" for none


def kind(dtype: np.dtype) -> h5t.TypeID:
    """The type in a file for one of numpy; objects are texts."""
    # numpy does not tell one dtype of objects from another
    return TEXTS if dtype.kind == "O" else _kind(dtype)


def memory(dtype: np.dtype) -> h5t.TypeID:
    """The type of arrays of a dtype in memory."""
    return OBJECTS if dtype.kind == "O" else _kind(dtype)


@cache
def _kind(dtype: np.dtype) -> h5t.TypeID:
    return h5t.py_create(dtype, logical=True)


def coded(value: Any) -> Any:
    """The bytes of a value, the same for every way of storing text."""
    if isinstance(value, str | bytes):
        return value.encode() if isinstance(value, str) else value
    array = np.ascontiguousarray(value)
    if array.dtype.kind in "OSU":
        return b"\0".join(coded(part) for part in array.ravel().tolist())
    return array.data if array.size else b""


@lru_cache(maxsize=256)
def spaced(shape: tuple[int, ...]) -> h5s.SpaceID:
    """The space of an array that keeps its shape."""
    return h5s.create_simple(shape) if shape else SCALAR


# --- properties ------------------------------------------------------------------------------


class Layout(NamedTuple):
    """How a dataset is laid out."""

    shape: tuple[int, ...] = ()
    chunk: tuple[int, ...] = ()  # of one that may grow; none of one that keeps its shape
    unwritten: float = 0.0  # what stands in rows that were never written
    dated: bool = False  # whether HDF5 keeps times of it


@cache
def _space(layout: Layout) -> h5s.SpaceID:
    if not layout.chunk:
        return spaced(layout.shape)
    return h5s.create_simple(layout.shape, (h5s.UNLIMITED, *layout.shape[1:]))


@cache
def _plan(layout: Layout) -> h5p.PropDCID:
    made = h5p.create(h5p.DATASET_CREATE)
    if layout.chunk:
        made.set_chunk(layout.chunk)
        made.set_fletcher32()
    if layout.unwritten:
        made.set_fill_value(np.array(layout.unwritten))
    made.set_obj_track_times(layout.dated)
    return made


@cache
def _utf8() -> h5p.PropLCID:
    made = h5p.create(h5p.LINK_CREATE)
    made.set_char_encoding(h5t.CSET_UTF8)
    return made


def _named(path: str) -> h5p.PropLCID | None:
    return None if path.isascii() else _utf8()


# --- objects ---------------------------------------------------------------------------------


class Told:
    """What was told of one object."""

    def __init__(self, words: tuple[str, str] | None = None, data: Any = None) -> None:
        self.words = words  # dtype and shape of a dataset; None of a group
        self.data = data  # array or text; None where it is in the file alone
        self.attributes: dict[str, Any] = {}  # name -> bytes


class Book:
    """Makes the objects of a file, by their paths, and remembers what was told of them.

    Without a file it remembers what is to be made, until there is one.
    """

    def __init__(self, file: h5py.File | None = None) -> None:
        self.told = {"": Told()}  # by path
        self.links = dict[str, str]()  # other names of datasets, and their first ones
        self.waiting: list[tuple[Any, ...]] = []  # a method, and what it is given
        self.file: Any = file
        self._items = dict[str, Any]()
        if file is not None:
            self.go_on(file)

    def go_on(self, file: h5py.File) -> None:
        """Go on in another file that has what was told, or in the same, opened again."""
        self.file, self._items, self.waiting = file, {"": file.id}, []

    def put(self, file: h5py.File) -> None:
        """Make in an empty file what waits."""
        waiting = self.waiting
        self.go_on(file)
        for k, (make, *given) in enumerate(waiting):
            make(self, *given)
            if not k:  # who is killed from now on leaves a file that is known as ours: target.py
                file.flush()

    def digest(self) -> bytes:
        """A hash of what waits: files of one digest are alike."""
        found = hashlib.sha256()
        for make, *given in self.waiting:
            plain = [(g.dtype.str, g.shape) if isinstance(g, np.ndarray) else g for g in given]
            found.update(repr((make.__name__, plain)).encode())
            for array in given:
                if isinstance(array, np.ndarray):
                    found.update(coded(array))
        return found.digest()

    def _do(self, make: Any, *given: Any) -> None:
        if self.file is None:
            self.waiting.append((make, *given))
        else:
            make(self, *given)

    def item(self, path: str) -> Any:
        """The identifier of an object."""
        if path not in self._items:
            self._items[path] = h5o.open(self.file.id, path.encode())
        return self._items[path]

    def opened(self, path: str) -> Any:
        """The identifier of a dataset for one use: of those that grow there may be many."""
        return self._items.get(path) or h5d.open(self.file.id, path.encode())

    def tell(self, path: str, array: Any) -> None:
        """Remember all rows of a dataset that grew."""
        word = "text" if array.dtype.kind in "OS" else array.dtype.str
        told = self.told[path]
        told.words, told.data = (word, str(array.shape)), array

    def has(self, path: str) -> bool:
        """Whether there is an object."""
        return path in self.told or path in self.file

    def rows(self, path: str) -> Any:
        """The rows of a dataset: an array where they are remembered, else what reads them."""
        told = self.told.get(path)
        return self.file[path] if told is None or told.data is None else told.data

    def said(self, path: str, name: str) -> str:
        """An attribute that is a text."""
        told = self.told.get(path)
        if told is None or name not in told.attributes:
            return str(self.file[path].attrs[name])
        return str(told.attributes[name].decode())

    def group(self, path: str) -> str:
        """A new group; its path."""
        self.told[path] = Told()
        self._do(_group, path)
        return path

    def dataset(self, path: str, dtype: Any, layout: Layout) -> str:
        """A new dataset without values, which are put into the file by whoever has them."""
        self.told[path] = Told(("", ""))
        self._do(_dataset, path, np.dtype(dtype), layout)
        return path

    def values(self, path: str, given: Any, dtype: Any = TEXT) -> str:
        """A new dataset that keeps its shape; its path."""
        array = np.asarray(given, dtype)
        word = "text" if array.dtype.kind == "O" else array.dtype.str
        data = given if isinstance(given, str) else array
        self.told[path] = Told((word, str(array.shape)), data)
        self._do(_values, path, array)
        return path

    def link(self, path: str, of: str) -> None:
        """Another name for a dataset."""
        self.links[path] = of
        self._do(_link, path, of)

    def attribute(self, path: str, name: str, value: Any) -> None:
        """Tell something of an object; in place of what was told."""
        array = np.asarray(value, TEXT if isinstance(value, str) else None)
        array = array.astype(TEXT) if array.dtype.kind == "U" else array
        if path in self.told:
            self.told[path].attributes[name] = coded(value if isinstance(value, str) else array)
        self._do(_attribute, path, name, array)

    def attributes(self, path: str, told: Mapping[str, Any]) -> None:
        """The same of several things."""
        for name, value in told.items():
            self.attribute(path, name, value)

    def scale(self, path: str, name: str) -> None:
        """Have a dataset be a scale."""
        self._do(_scale, path, name)

    def attach(self, found: Iterable[Scaled]) -> None:
        """Attach scales to the dimensions of datasets that have none."""
        self._do(_attach, tuple(found))


# --- in the file -----------------------------------------------------------------------------


def _group(book: Book, path: str) -> None:
    book._items[path] = h5g.create(book.file.id, path.encode(), _named(path))


def _dataset(book: Book, path: str, dtype: Any, layout: Layout) -> Any:
    space, plan = _space(layout), _plan(layout)
    made = h5d.create(book.file.id, path.encode(), kind(dtype), space, plan, _named(path))
    book._items[path] = made
    return made


def _values(book: Book, path: str, array: Any) -> None:
    made = _dataset(book, path, array.dtype, Layout(array.shape))
    if array.size:
        made.write(h5s.ALL, h5s.ALL, np.ascontiguousarray(array), memory(array.dtype))


def _link(book: Book, path: str, of: str) -> None:
    h5o.link(book.item(of), book.file.id, path.encode(), _named(path))


def _attribute(book: Book, path: str, name: str, array: Any) -> None:
    item, key = book.item(path), name.encode()
    if h5a.exists(item, key):
        h5a.delete(item, key)
    made = h5a.create(item, key, kind(array.dtype), spaced(array.shape))
    made.write(array, memory(array.dtype))


def _scale(book: Book, path: str, name: str) -> None:
    h5ds.set_scale(book.item(path), name.encode())


def _attach(book: Book, found: tuple[Scaled, ...]) -> None:
    """HDF5 would list anew with each dataset what the scale is attached to: as many writes as
    their square.  Here every scale is told once."""
    uses: dict[str, list[tuple[int, int]]] = {}
    of: dict[str, Any] = {}
    for path, scales in found:
        item, lists = book.item(path), np.zeros(len(scales), LIST)
        mine = _reference(item)
        for k, scale in enumerate(scales):
            if not scale:
                continue
            if scale not in of:
                of[scale] = np.array([_reference(book.item(scale))], np.uint64)
                uses[scale] = _uses(book.item(scale))
            uses[scale].append((mine, k))
            lists[k] = 1, of[scale].ctypes.data
        made = h5a.create(item, b"DIMENSION_LIST", _of_scales(), spaced(lists.shape))
        made.write(lists, _of_scales())
    for scale, pairs in uses.items():
        listed = np.array(pairs, USE)
        made = h5a.create(book.item(scale), b"REFERENCE_LIST", _of_uses(), spaced(listed.shape))
        made.write(listed, _of_uses())


# --- dimension scales ------------------------------------------------------------------------


@cache
def _of_scales() -> h5t.TypeVlenID:
    """The type in which HDF5 lists the scales of a dimension."""
    return h5t.vlen_create(h5t.STD_REF_OBJ)


@cache
def _of_uses() -> h5t.TypeCompoundID:
    """The type in which HDF5 lists what a scale is attached to."""
    made = h5t.create(h5t.COMPOUND, 16)
    made.insert(b"dataset", 0, h5t.STD_REF_OBJ)
    made.insert(b"dimension", 8, h5t.STD_U32LE)
    return made


def _reference(item: h5d.DatasetID) -> int:
    """What leads to an object in its file."""
    return int(h5o.get_info(item).addr)


def _uses(scale: h5d.DatasetID) -> list[tuple[int, int]]:
    """What a scale is attached to so far; its list is taken away."""
    if not h5a.exists(scale, b"REFERENCE_LIST"):
        return []
    opened = h5a.open(scale, b"REFERENCE_LIST")
    found = np.empty(opened.shape, USE)
    opened.read(found, _of_uses())
    h5a.delete(scale, b"REFERENCE_LIST")
    return list(found.tolist())
