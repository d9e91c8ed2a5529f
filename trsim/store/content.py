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

UNCOVERED = {"provenance", "certificate"}  # groups
OWN = {"content_sha256", "CLASS", "NAME", "DIMENSION_LIST", "REFERENCE_LIST"}  # attributes
PIECE = 1 << 20  # bytes read at a time
TEXT = h5py.string_dtype()


# h5py's low level throughout: its Group, Dataset and attributes cost more than what is read


def content_hash(file: h5py.Group) -> str:
    """The sha256 of the contents of an open file, or of a group, in hexadecimal."""
    digest = hashlib.sha256()
    _group(file.id, "", digest, {})
    return digest.hexdigest()


def _group(group: Any, path: str, digest: Any, seen: dict[Any, str]) -> None:
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


def _dataset(item: Any, path: str, digest: Any) -> None:
    if not isinstance(item, h5d.DatasetID):
        raise TypeError(f"{path} holds no data")
    dtype, shape = item.dtype, item.shape
    text = h5py.check_string_dtype(dtype) is not None
    _say(digest, "data", path, "text" if text else dtype.str, str(shape))
    _attributes(item, digest)
    if shape == ():
        digest.update(_bytes(h5py.Dataset(item)[()]))
        return
    width = max(1, dtype.itemsize * math.prod(shape[1:]))
    rows = max(1, PIECE // width)
    if rows >= shape[0] and dtype.kind == "f":  # as most are
        whole = np.empty(shape, dtype)
        item.read(h5s.ALL, h5s.ALL, whole)
        digest.update(_bytes(whole))
        return
    for k in range(0, shape[0], rows):
        digest.update(_bytes(h5py.Dataset(item)[k : k + rows]))


def _attributes(item: Any, digest: Any) -> None:
    names: list[bytes] = []
    h5a.iterate(item, names.append)
    for name in sorted(names):
        if name.decode() not in OWN:
            _say(digest, "attribute", name.decode())
            digest.update(_bytes(attribute(item, name)))


def attribute(item: Any, name: bytes) -> Any:
    """The value of an attribute, as h5py gives it; most are texts, which may be bytes."""
    opened = h5a.open(item, name)
    kind = opened.get_type()
    if isinstance(kind, h5t.TypeStringID) and kind.is_variable_str() and opened.shape == ():
        value = np.empty((), TEXT)
        opened.read(value)
        if isinstance(value[()], str | bytes):
            return value[()]
    high = h5py.Group if isinstance(item, h5g.GroupID) else h5py.Dataset
    return high(item).attrs[name.decode()]


def _bytes(value: Any) -> Any:
    """The bytes of a value, the same for every way of storing text."""
    if isinstance(value, str | bytes):
        return value.encode() if isinstance(value, str) else value
    array = np.ascontiguousarray(value)
    if array.dtype.kind in "OSU":
        return b"\0".join(_bytes(part) for part in array.ravel().tolist())
    return array.data if array.size else b""


def _say(digest: Any, *words: str) -> None:
    digest.update(("\n".join(words) + "\n").encode())
