"""The content hash: two files with the same hash hold the same results.

Covered is every name, attribute, type and byte of data, except the groups /provenance (machine,
versions, times) and /certificate (which has a hash of its own), and what HDF5 keeps for itself.
How a file was cut into chunks does not matter.
"""

import hashlib
import math
from typing import Any

import h5py
import numpy as np
from h5py import h5a, h5d, h5g, h5o, h5s, h5t

from trsim.store import made
from trsim.store.made import Book, Told, coded

UNCOVERED = {"provenance", "certificate"}  # groups
OWN = {b"content_sha256", b"CLASS", b"NAME", b"DIMENSION_LIST", b"REFERENCE_LIST"}  # attributes
PIECE = 1 << 20  # bytes read at a time

# h5py's low level throughout: its Group, Dataset and attributes cost more than what is read


def content_hash(file: h5py.Group) -> str:
    """The sha256 of the contents of an open file, or of a group, in hexadecimal."""
    digest = hashlib.sha256()
    _group(file.id, "", digest, {})
    return digest.hexdigest()


def told_hash(book: Book) -> str:
    """The same of a file that a book made, all of it; only rows are read from the file."""
    digest = hashlib.sha256()
    inside: dict[str, list[tuple[bytes, str]]] = {path: [] for path in book.told}
    for path in (*book.told, *book.links):
        if path:
            above, _, name = path.rpartition("/")
            inside[above].append((name.encode(), path))
    _told(book, "", inside, digest, {})
    return digest.hexdigest()


def _told(book: Book, path: str, inside: Any, digest: Any, seen: dict[str, str]) -> None:
    """A group of a book; seen: names of datasets that were told already."""
    _say(digest, "group", f"/{path}" if path else "")
    _remembered(book.told[path], digest)
    for _, inner in sorted(inside[path]):
        source = book.links.get(inner, inner)
        told = book.told[source]
        if inner in UNCOVERED:
            continue
        if told.words is None:
            _told(book, inner, inside, digest, seen)
        elif source in seen:
            _say(digest, "link", f"/{inner}", f"/{seen[source]}")
        else:
            seen[source] = inner
            if told.data is None:
                _dataset(book.opened(source), f"/{inner}", digest, told)
            else:
                _say(digest, "data", f"/{inner}", *told.words)
                _remembered(told, digest)
                digest.update(coded(told.data))


def _remembered(told: Told, digest: Any) -> None:
    """Attributes as they were told."""
    for name in sorted(told.attributes, key=str.encode):
        _say(digest, "attribute", name)
        digest.update(told.attributes[name])


def _group(group: Any, path: str, digest: Any, seen: dict[int, str]) -> None:
    _say(digest, "group", path)
    _attributes(group, digest)
    for link in sorted(group):
        name = link.decode()
        inner = f"{path}/{name}"
        if not path and name in UNCOVERED:
            continue
        item = h5o.open(group, link)
        if isinstance(item, h5g.GroupID):
            _group(item, inner, digest, seen)
            continue
        address = h5o.get_info(item).addr
        if address in seen:
            _say(digest, "link", inner, seen[address])
        else:
            seen[address] = inner
            _dataset(item, inner, digest)


def _dataset(item: Any, path: str, digest: Any, told: Told | None = None) -> None:
    """A dataset, with the attributes it has, or those that were told of it."""
    if not isinstance(item, h5d.DatasetID):
        raise TypeError(f"{path} holds no data")
    kind, shape = item.get_type(), item.shape
    numbers = kind.get_class() == h5t.FLOAT and kind.equal(made.NUMBERS)  # as most are
    dtype = np.dtype("f8") if numbers else item.dtype
    text = not numbers and h5py.check_string_dtype(dtype) is not None
    _say(digest, "data", path, "text" if text else dtype.str, str(shape))
    if told is None:
        _attributes(item, digest)
    else:
        _remembered(told, digest)
    rows = max(1, PIECE // max(1, dtype.itemsize * math.prod(shape[1:] if shape else ())))
    if not shape or rows >= shape[0]:
        whole = np.empty(shape, dtype)
        if whole.size:
            item.read(h5s.ALL, h5s.ALL, whole, made.NUMBERS if numbers else None)
        digest.update(coded(whole if shape else whole[()]))
        return
    for k in range(0, shape[0], rows):
        digest.update(coded(h5py.Dataset(item)[k : k + rows]))


def _attributes(item: Any, digest: Any) -> None:
    names: list[bytes] = []
    h5a.iterate(item, names.append)
    for name in sorted(names):
        if name not in OWN:
            _say(digest, "attribute", name.decode())
            digest.update(coded(attribute(item, name)))


def attribute(item: Any, name: bytes) -> Any:
    """The value of an attribute, as h5py gives it; a text may be bytes, a number an array."""
    opened = h5a.open(item, name)
    kind = opened.get_type()
    family = kind.get_class()
    if alone(opened) and family == h5t.STRING and kind.is_variable_str():
        text = np.empty((), made.TEXT)
        opened.read(text, made.OBJECTS)
        if isinstance(text[()], str | bytes):  # nothing else than a text is there
            return text[()]
    elif alone(opened) and family in (h5t.FLOAT, h5t.INTEGER):
        number = np.empty((), kind.dtype)
        opened.read(number)
        return number
    high = h5py.Group if isinstance(item, h5g.GroupID) else h5py.Dataset
    return high(item).attrs[name.decode()]


def alone(attribute: h5a.AttrID) -> bool:
    """Whether an attribute is one thing, no array of them and not nothing."""
    return bool(attribute.get_space().get_simple_extent_type() == h5s.SCALAR)


def _say(digest: Any, *words: str) -> None:
    digest.update(("\n".join(words) + "\n").encode())
