"""Tables of a few rows: a dataset for each field of a NamedTuple, which is a row."""

from typing import Any

import h5py
import numpy as np

from trsim.store.grow import TEXT

KINDS: dict[type, str] = {float: "f8", int: "i8", bool: "?"}  # all else is text


def store(group: h5py.Group, row: Any, rows: list[Any]) -> None:
    """Put rows into an empty group; row: the class of them."""
    for key, kind in row.__annotations__.items():
        values = [getattr(one, key) for one in rows]
        group.create_dataset(key, data=np.array(values, dtype=KINDS.get(kind, TEXT)))


def stored(group: h5py.Group, row: Any) -> list[Any]:
    """The rows in a group."""
    columns = [group[key] for key in row.__annotations__]
    read = [c.asstr()[:] if c.dtype == object else c[:].tolist() for c in columns]
    return [row(*values) for values in zip(*read, strict=True)]
