"""Records of arrays that compiled code receives as one pointer.

A Packed object holds named numpy arrays and numbers.  Compiled functions see it as a single word,
read `s.name` as a view of the array (no copy, no reference count), and may write into arrays, never
replace them.  Passing eighty arrays as arguments costs ten times the physics; this costs nothing.
Numbers that change (`r.t += h`) are entries of an array of the record, so its arrays are all of it.

In memory: three words per field, (address, rows, columns) of an array, or the number itself.
The addresses never change, which the loads say to the optimiser ("invariant").

What the compiler must know of it is in compiler.py, imported when something is compiled.
"""

from __future__ import annotations

import itertools
import math
from collections import Counter
from ctypes import addressof
from functools import cache
from operator import setitem
from typing import TYPE_CHECKING, Any, NamedTuple

from trsim.kernels.buffer import address, at
from trsim.kernels.lazy import PYTHON
from trsim.kernels.signatures import KINDS, Kind

if TYPE_CHECKING:  # what the annotations mean to Python
    import numpy as np
    from numpy.typing import NDArray

    f8 = float
    F8 = float
    i8 = int
    I8 = int
    A1 = NDArray[np.float64]
    C1 = NDArray[np.complex128]
    C2 = NDArray[np.complex128]
    A2 = NDArray[np.float64]
    T2 = NDArray[np.float64]
    T3 = NDArray[np.float64]
    T6 = NDArray[np.float64]
    T9 = NDArray[np.float64]
    T12 = NDArray[np.float64]
    T14 = NDArray[np.float64]
    I1 = NDArray[np.int64]
    I2 = NDArray[np.int64]
else:  # and to compiled code
    from trsim.kernels.signatures import (
        A1,
        A2,
        C1,
        C2,
        F8,
        I1,
        I2,
        I8,
        T2,
        T3,
        T6,
        T9,
        T12,
        T14,
        f8,
        i8,
    )

__all__ = [
    "A1", "A2", "C1", "C2", "F8", "I1", "I2", "I8", "T2", "T3", "T6", "T9", "T12", "T14", "WORDS",
    "Packed", "f8", "i8",
]  # fmt: skip

WORDS = 3  # per field
LINE = 8  # words: where one array ends and the next begins, there is a new line of the cache
HOLDERS = {"F8": "clock", "I8": "count"}  # the arrays of numbers that change


class Packed:
    """Base class of records: subclasses annotate their fields with A1, A2, I1, I2, C1, C2, f8
    or i8, or with T2 to T14, tables of so many columns.

    F8 and I8 are numbers that change: entries of the record's arrays `clock` (A1) and `count` (I1),
    in the order they are declared in.
    """

    kind: Kind  # what signatures call it
    places: dict[str, int]  # of a field among the fields
    sizes: Counter[str]  # of the arrays that numbers which change are entries of

    def __init_subclass__(cls) -> None:
        own = {k: v for k, v in vars(cls).get("__annotations__", {}).items() if k != "kind"}
        before = getattr(cls, "kind", Kind(""))
        fields, entries = dict(before.fields), list(before.entries)
        cls.sizes = Counter(holder for _, holder, _ in entries)
        for name, word in own.items():
            kind = word if isinstance(word, Kind) else KINDS[word]
            holder = HOLDERS.get(kind.name)
            if holder is None:
                fields[name] = kind
            else:
                entries.append((name, holder, cls.sizes[holder]))
                setattr(cls, name, _entry(*entries[-1][1:]))
                cls.sizes[holder] += 1
        cls.kind = Kind(cls.__name__, fields=tuple(fields.items()), entries=tuple(entries))
        cls.places = {name: k for k, (name, _) in enumerate(cls.kind.fields)}

    def __init__(
        self, like: Packed | None = None, room: dict[str, tuple[int, ...]] | None = None, /,
        **values: Any,
    ) -> None:  # fmt: skip
        """like: a record whose fields are the first of these, taken over where they are not given;
        room: shapes of arrays of zeros, made in one piece: asking each for its address is slow."""
        import numpy as np

        wrong = {*(room or {}), *values} - self.places.keys()
        words = [0] * (WORDS * len(self.places))
        if not wrong:
            if like is not None:
                self._share(like, words)
            else:
                values = {name: np.zeros(n) for name, n in self.sizes.items()} | values
            self._make(room or {}, words)
            self._take(values, words)
            wrong = self.places.keys() - vars(self).keys()
        if wrong:
            raise TypeError(f"{type(self).__name__}: fields {sorted(wrong)} missing or unknown")
        self.words = np.array(words, np.int64)
        self.address = address(self.words)

    def _share(self, like: Packed, words: list[int]) -> None:
        """The first fields, as another record has them."""
        number = min(len(self.places), len(like.places))
        words[: WORDS * number] = like.words[: WORDS * number].tolist()
        there = vars(like)
        vars(self).update({name: there[name] for name in itertools.islice(self.places, number)})

    def _make(self, room: dict[str, tuple[int, ...]], words: list[int]) -> None:
        """Arrays of zeros."""
        import numpy as np

        sizes = [math.prod(shape) for shape in room.values()]
        ends = [0, *itertools.accumulate(LINE * -(-size // LINE) for size in sizes)]
        piece = np.zeros(ends[-1])
        record: Any = type(self)
        start, own, fields = address(piece), vars(self), _fields(record)
        for (name, shape), size, begin in zip(room.items(), sizes, ends, strict=False):
            field = fields[name]
            _check(field, shape)
            part, word = piece[begin : begin + size], field.word
            own[name] = part if len(shape) == 1 else part.reshape(shape)
            words[word] = start + 8 * begin
            words[word + 1 : word + 1 + len(shape)] = shape

    def _take(self, values: dict[str, Any], words: list[int]) -> None:
        """Fields that are given."""
        import numpy as np

        record: Any = type(self)
        own, fields = vars(self), _fields(record)
        for name, value in values.items():
            field = fields[name]
            word = field.word
            if field.dimensions:
                try:  # as nearly all are what compiled code can work on
                    start = addressof(at(value)) if value.dtype is field.dtype else 0
                except (AttributeError, TypeError):
                    start = 0
                if not start:
                    value = np.require(value, field.dtype, ["C", "W"])
                    start = address(value)
                shape = value.shape
                _check(field, shape)
                words[word] = start
                words[word + 1 : word + 1 + len(shape)] = shape
            elif field.real:
                number = np.float64(value)
                words[word] = int(number.view(np.int64))
                value = number if PYTHON else value
            else:
                words[word] = value
            own[name] = value

    def arrays(self) -> dict[str, Any]:
        """The arrays by name."""
        return {name: getattr(self, name) for name, kind in self.kind.fields if kind.dimensions}


def _entry(holder: str, k: int) -> property:
    """A number that changes, for Python."""
    return property(
        lambda record: getattr(record, holder)[k],
        lambda record, value: setitem(getattr(record, holder), k, value),
    )


class _Field(NamedTuple):
    """What a record asks of a field."""

    name: str
    word: int  # where it begins among the words of the record
    dimensions: int
    real: bool  # a number with a fraction
    dtype: Any
    columns: int  # of a table that always has as many
    number: int  # of an array that numbers which change are entries of


@cache
def _fields(record: Any) -> dict[str, _Field]:
    """The fields of a class of records by name, looked up once: records are made by the hundred."""
    import numpy as np

    return {
        name: _Field(
            name, WORDS * k, kind.dimensions, kind.dtype == "float64", np.dtype(kind.dtype),
            kind.columns, record.sizes.get(name, 0),
        )
        for k, (name, kind) in enumerate(record.kind.fields)
    }  # fmt: skip


def _check(field: _Field, shape: tuple[int, ...]) -> None:
    """Raise TypeError where an array is not as compiled code takes it to be."""
    if len(shape) != field.dimensions:
        raise TypeError(f"{field.name}: {len(shape)} dimensions instead of {field.dimensions}")
    if field.number and shape[0] != field.number:
        raise TypeError(f"{field.name}: {shape[0]} numbers instead of {field.number}")
    if field.columns and shape[1] != field.columns:
        raise TypeError(f"{field.name}: {shape[1]} columns instead of {field.columns}")
