"""Tables of a few rows: a dataset for each field of a NamedTuple, which is a row."""

from typing import Any

import h5py

from trsim.store.made import TEXT, Book

KINDS: dict[type, str] = {float: "f8", int: "i8", bool: "?"}  # all else is text


def store(book: Book, path: str, row: Any, rows: list[Any]) -> None:
    """Put rows into an empty group; row: the class of them."""
    for key, kind in row.__annotations__.items():
        values = [getattr(one, key) for one in rows]
        book.values(f"{path}/{key}", values, KINDS.get(kind, TEXT))


def stored(group: h5py.Group, row: Any) -> list[Any]:
    """The rows in a group."""
    columns = [group[key] for key in row.__annotations__]
    read = [c.asstr()[:] if c.dtype == object else c[:].tolist() for c in columns]
    return [row(*values) for values in zip(*read, strict=True)]
