"""Types of compiled functions: numbers, arrays and records, as plain words.

Nothing here needs the compiler; kernels/compiler.py says what it takes them for.
"""

from __future__ import annotations

from typing import Any, NamedTuple

KNOWN = range(62, 69)  # numba 0.62 to 0.68: what pipeline.py takes of its inside, how it calls


class Kind(NamedTuple):
    """The type of an argument, or of a field of a record."""

    name: str
    dimensions: int = 0  # of an array
    dtype: str = ""  # of a number or of the entries of an array; "" for a record
    fields: tuple[tuple[str, Kind], ...] = ()  # of a record
    columns: int = 0  # of a table that always has as many
    # of a record: numbers that change, each with the array it is an entry of, and which
    entries: tuple[tuple[str, str, int], ...] = ()


class Signature(NamedTuple):
    """What a compiled function takes and returns (None: nothing)."""

    returns: Kind | None
    arguments: tuple[Kind, ...]


f8, i8 = Kind("f8", 0, "float64"), Kind("i8", 0, "int64")
F8, I8 = Kind("F8", 0, "float64"), Kind("I8", 0, "int64")  # numbers of a record that change
A1, A2 = Kind("A1", 1, "float64"), Kind("A2", 2, "float64")
I1, I2 = Kind("I1", 1, "int64"), Kind("I2", 2, "int64")
C1, C2 = Kind("C1", 1, "complex128"), Kind("C2", 2, "complex128")
# tables as wide as that: where a row begins is then known when code is compiled
T2, T3, T6, T9, T12, T14 = (Kind(f"T{n}", 2, "float64", columns=n) for n in (2, 3, 6, 9, 12, 14))
KINDS = {
    kind.name: kind for kind in (f8, i8, F8, I8, A1, A2, I1, I2, C1, C2, T2, T3, T6, T9, T12, T14)
}


# arguments are kinds; to Python's type checker the same words are numbers and arrays (packed.py)


def void(*arguments: Any) -> Signature:
    """The signature of a function that returns nothing."""
    return Signature(None, arguments)


def float64(*arguments: Any) -> Signature:
    return Signature(f8, arguments)


def int64(*arguments: Any) -> Signature:
    return Signature(i8, arguments)
