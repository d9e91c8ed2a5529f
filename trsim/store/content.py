"""The content hash: two files with the same hash hold the same results.

Covered is every name, attribute, type and byte of data, except the groups /provenance (machine,
versions, times) and /certificate (which has a hash of its own), and what HDF5 keeps for itself.
How a file was cut into chunks does not matter.
"""

import hashlib
from typing import Any

import h5py
import numpy as np
from h5py import h5a, h5s

UNCOVERED = {"provenance", "certificate"}  # groups
OWN = {"content_sha256", "CLASS", "NAME", "DIMENSION_LIST", "REFERENCE_LIST"}  # attributes
PIECE = 1 << 20  # bytes read at a time


def content_hash(file: h5py.Group) -> str:
    """The sha256 of the contents of an open file, or of a group, in hexadecimal."""
    digest = hashlib.sha256()
    _group(file, "", digest, {})
    return digest.hexdigest()


def _group(group: h5py.Group, path: str, digest: Any, seen: dict[Any, str]) -> None:
    _say(digest, "group", path)
    _attributes(group, digest)
    for name in sorted(group):
        item, inner = group[name], f"{path}/{name}"
        if not path and name in UNCOVERED:
            continue
        if isinstance(item, h5py.Group):
            _group(item, inner, digest, seen)
            continue
        address = h5py.h5o.get_info(item.id).addr
        if address in seen:
            _say(digest, "link", inner, seen[address])
        else:
            seen[address] = inner
            _dataset(item, inner, digest)


def _dataset(item: h5py.Dataset, path: str, digest: Any) -> None:
    text = h5py.check_string_dtype(item.dtype) is not None
    _say(digest, "data", path, "text" if text else item.dtype.str, str(item.shape))
    _attributes(item, digest)
    if item.shape == ():
        digest.update(_bytes(item[()]))
        return
    width = max(1, item.dtype.itemsize * int(np.prod(item.shape[1:])))
    rows = max(1, PIECE // width)
    if rows >= len(item) and item.dtype.kind == "f":  # most are, and h5py's own way is slow
        whole = np.empty(item.shape, item.dtype)
        item.id.read(h5s.ALL, h5s.ALL, whole)
        digest.update(_bytes(whole))
        return
    for k in range(0, len(item), rows):
        digest.update(_bytes(item[k : k + rows]))


def _attributes(item: Any, digest: Any) -> None:
    for name in sorted(item.attrs):
        if name not in OWN:
            _say(digest, "attribute", name)
            digest.update(_bytes(_text(item, name)))


def _text(item: Any, name: str) -> Any:
    """The value of an attribute; of most, which are texts, without h5py's long way to it."""
    attribute = h5a.open(item.id, name.encode())
    if attribute.shape != () or attribute.dtype.kind != "O":
        return item.attrs[name]
    value = np.empty((), h5py.string_dtype())
    attribute.read(value)
    return value[()] if isinstance(value[()], str | bytes) else item.attrs[name]


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
