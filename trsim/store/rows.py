"""Tables of a few rows: a dataset for each field of a NamedTuple, which is a row."""

from typing import Any

import h5py
from h5py import h5d

from trsim.store import made

KINDS: dict[type, str] = {float: "f8", int: "i8", bool: "?"}  # all else is text


def store(group: h5py.Group, row: Any, rows: list[Any]) -> dict[str, h5d.DatasetID]:
    """Put rows into an empty group; row: the class of them.  What was made, by name."""
    return {
        key: made.values(
            group, key, [getattr(one, key) for one in rows], KINDS.get(kind, made.TEXT)
        )
        for key, kind in row.__annotations__.items()
    }


def stored(group: h5py.Group, row: Any) -> list[Any]:
    """The rows in a group."""
    columns = [group[key] for key in row.__annotations__]
    read = [c.asstr()[:] if c.dtype == object else c[:].tolist() for c in columns]
    return [row(*values) for values in zip(*read, strict=True)]
