"""What a result file is made of, in calls of HDF5 itself.

h5py's own objects cost more than all that HDF5 does: a file of a short run has a hundred datasets
and two hundred attributes.  Types, spaces and lists of properties are made once in a process.  What
is made is the same as h5py makes.
"""

from collections.abc import Mapping, Sequence
from functools import cache
from typing import Any

import h5py
import numpy as np
from h5py import h5a, h5d, h5ds, h5g, h5o, h5p, h5r, h5s, h5t

from trsim.arrays import Array

TEXT = h5py.string_dtype()
SCALAR = h5s.create(h5s.SCALAR)
REFERENCES = h5py.vlen_dtype(h5py.ref_dtype)
USE = np.dtype([("dataset", h5py.ref_dtype), ("dimension", "u4")])  # of a scale
Attached = tuple[h5d.DatasetID, tuple[h5d.DatasetID | None, ...]]  # the scales of its dimensions


TEXTS, OBJECTS = h5t.py_create(TEXT, logical=True), h5t.py_create(TEXT)  # in files, in memory


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


def spaced(shape: tuple[int, ...]) -> h5s.SpaceID:
    """The space of an array that keeps its shape."""
    return h5s.create_simple(shape) if shape else SCALAR


@cache
def plain() -> h5p.PropDCID:
    """Properties of a dataset that keeps its shape."""
    made = h5p.create(h5p.DATASET_CREATE)
    made.set_obj_track_times(False)
    return made


@cache
def growing(chunk: tuple[int, ...], numbers: bool) -> h5p.PropDCID:
    """Properties of a dataset that grows."""
    made = _chunked(chunk)
    if numbers:
        made.set_fill_value(np.array(np.nan))  # a row that was never written says so
    return made


@cache
def chunked(chunk: tuple[int, ...]) -> h5p.PropDCID:
    """Properties of a dataset that may grow; what is not written is zero."""
    made = _chunked(chunk)
    made.set_obj_track_times(False)
    return made


def _chunked(chunk: tuple[int, ...]) -> h5p.PropDCID:
    made = h5p.create(h5p.DATASET_CREATE)
    made.set_chunk(chunk)
    made.set_fletcher32()
    return made


@cache
def _utf8() -> h5p.PropLCID:
    made = h5p.create(h5p.LINK_CREATE)
    made.set_char_encoding(h5t.CSET_UTF8)
    return made


def _link(name: str) -> h5p.PropLCID | None:
    return None if name.isascii() else _utf8()


# --- objects ---------------------------------------------------------------------------------


def group(holder: h5py.Group, name: str) -> h5py.Group:
    """A new group."""
    return h5py.Group(h5g.create(holder.id, name.encode(), _link(name)))


def dataset(
    holder: h5py.Group, name: str, dtype: Any, space: h5s.SpaceID, plan: h5p.PropDCID
) -> h5d.DatasetID:  # fmt: skip
    """A new dataset without values."""
    made = kind(np.dtype(dtype))
    return h5d.create(holder.id, name.encode(), made, space, plan, _link(name))


def values(holder: h5py.Group, name: str, given: Any, dtype: Any = None) -> h5d.DatasetID:
    """A new dataset that keeps its shape."""
    array = np.asarray(given, dtype)
    made = dataset(holder, name, array.dtype, spaced(array.shape), plain())
    if array.size:
        made.write(h5s.ALL, h5s.ALL, np.ascontiguousarray(array), memory(array.dtype))
    return made


def link(holder: h5py.Group, name: str, item: h5d.DatasetID) -> None:
    """Another name for a dataset."""
    h5o.link(item, holder.id, name.encode(), _link(name))


# --- attributes ------------------------------------------------------------------------------


def attribute(item: Any, name: str, value: Any) -> None:
    """Tell something of a group or dataset, by its identifier; in place of what was told."""
    array = np.asarray(value, TEXT if isinstance(value, str) else None)
    array = array.astype(TEXT) if array.dtype.kind == "U" else array
    coded = name.encode()
    if h5a.exists(item, coded):
        h5a.delete(item, coded)
    made = h5a.create(item, coded, kind(array.dtype), spaced(array.shape))
    made.write(array, memory(array.dtype))


def attributes(item: Any, told: Mapping[str, Any]) -> None:
    """The same of several things."""
    for name, value in told.items():
        attribute(item, name, value)


# --- dimension scales ------------------------------------------------------------------------


@cache
def _of_scales() -> h5t.TypeVlenID:
    """The type in which HDF5 lists the scales of a dimension."""
    return h5t.vlen_create(h5t.STD_REF_OBJ)


@cache
def _uses() -> h5t.TypeCompoundID:
    """The type in which HDF5 lists what a scale is attached to."""
    made = h5t.create(h5t.COMPOUND, 16)
    made.insert(b"dataset", 0, h5t.STD_REF_OBJ)
    made.insert(b"dimension", 8, h5t.STD_U32LE)
    return made


def attach(found: Sequence[Attached]) -> None:
    """Attach scales to the dimensions of datasets that have none.

    HDF5 would list anew with each dataset what the scale is attached to: as many writes as their
    square.  Here every scale is told once.
    """
    uses: dict[int, list[tuple[Any, int]]] = {}  # by the numbers HDF5 gives to what is open
    for item, scales in found:
        lists, mine = np.empty(len(scales), REFERENCES), _reference(item)
        for k, scale in enumerate(scales):
            lists[k] = np.array([_reference(scale)] if scale else [], h5py.ref_dtype)
            if scale:
                uses.setdefault(scale.id, _attached(scale)).append((mine, k))
        h5a.create(item, b"DIMENSION_LIST", _of_scales(), spaced((len(lists),))).write(lists)
    for scale in {scale.id: scale for _, scales in found for scale in scales if scale}.values():
        listed = np.array(uses[scale.id], USE)
        h5a.create(scale, b"REFERENCE_LIST", _uses(), spaced(listed.shape)).write(listed)


def scale(item: h5d.DatasetID, name: str) -> None:
    """Have a dataset be a scale."""
    h5ds.set_scale(item, name.encode())


def _reference(item: h5d.DatasetID) -> Any:
    return h5r.create(item, b".", h5r.OBJECT)


def _attached(scale: h5d.DatasetID) -> list[tuple[Any, int]]:
    """What a scale is attached to so far; its list is taken away."""
    if not h5a.exists(scale, b"REFERENCE_LIST"):
        return []
    opened = h5a.open(scale, b"REFERENCE_LIST")
    found = np.empty(opened.shape, USE)
    opened.read(found)
    h5a.delete(scale, b"REFERENCE_LIST")
    return list(found.tolist())
