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
from array import array
from collections import Counter
from ctypes import addressof, c_double
from functools import cache, lru_cache
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
SHAPES = 256  # of records that are remembered
LINE = 8  # words: where one array ends and the next begins, there is a new line of the cache
EMPTY = c_double()
NOWHERE = addressof(EMPTY)  # where arrays without entries are
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
    words: NDArray[np.int64]  # what compiled code reads
    address: int  # where they begin
    _zeros: tuple[tuple[Any, _Room], ...]  # pieces of memory with arrays of zeros; later ones count

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

        places, own = self.places.keys(), vars(self)
        words = array("q", bytes(8 * WORDS * len(places)))
        own["_zeros"] = ()
        wrong: Any = {*(room or ()), *values} - places
        if not wrong:
            if like is not None:
                self._share(like, words)
            else:
                values = {name: np.zeros(n) for name, n in self.sizes.items()} | values
            if room:
                self._make(room, words)
            self._take(values, words)
            if type(like) is not type(self):
                wrong = places - own.keys()
                wrong = wrong.difference(*(room.lies for _, room in self._zeros))
        if wrong:
            raise TypeError(f"{type(self).__name__}: fields {sorted(wrong)} missing or unknown")
        own["words"] = np.frombuffer(words, np.int64)
        own["address"] = address(words)

    def __getattr__(self, name: str) -> Any:
        """A view of an array of zeros, made when Python first asks for it, as it does for few."""
        for piece, room in reversed(vars(self).get("_zeros", ())):
            if name in room.lies:
                begin, end, shape = room.lies[name]
                view = vars(self)[name] = piece[begin:end].reshape(shape)
                return view
        raise AttributeError(f"{type(self).__name__} has no '{name}'")

    def _share(self, like: Packed, words: array[int]) -> None:
        """The first fields, as another record has them."""
        number, own = min(len(self.places), len(like.places)), vars(self)
        words[: WORDS * number] = array("q", like.words[: WORDS * number].tobytes())
        if number == len(like.places):
            own |= vars(like)
            return
        for name in itertools.islice(self.places, number):
            own[name] = getattr(like, name)

    def _make(self, room: dict[str, tuple[int, ...]], words: array[int]) -> None:
        """Arrays of zeros."""
        import numpy as np

        record: Any = type(self)
        made = _room(record, tuple(room.items()))
        piece, own = np.zeros(made.size), vars(self)
        for name in own.keys() & made.lies.keys():
            del own[name]
        own["_zeros"] = (*self._zeros, (piece, made))
        told = np.frombuffer(words, np.int64)
        told[made.starts] = address(piece) + made.behind
        told[made.places] = made.numbers

    def _take(self, values: dict[str, Any], words: array[int]) -> None:
        """Fields that are given."""
        import numpy as np

        record: Any = type(self)
        own, fields, reals = vars(self), _fields(record), memoryview(words).cast("B").cast("d")
        for name, value in values.items():
            field = fields[name]
            if field.dimensions:
                try:  # as nearly all are what compiled code can work on
                    start, shape = 0, value.shape
                    if value.dtype is field.dtype:
                        start = addressof(at(value)) if shape[0] else NOWHERE
                except (AttributeError, IndexError, TypeError):
                    pass
                if not start:
                    value = np.require(value, field.dtype, ["C", "W"])
                    start, shape = address(value), value.shape
                _tell(words, field, start, shape)
            elif field.real:
                reals[field.word] = value
                value = np.float64(value) if PYTHON else value
            else:
                words[field.word] = value
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


class _Room(NamedTuple):
    """Where arrays of zeros lie in one piece of memory, and what tells of them."""

    size: int  # of the piece
    lies: dict[str, tuple[int, int, tuple[int, ...]]]  # name -> from where, to where, shape
    starts: NDArray[np.int64]  # words of the record with their addresses
    behind: NDArray[np.int64]  # bytes from the beginning of the piece to each
    places: NDArray[np.int64]  # words of the record with their shapes
    numbers: NDArray[np.int64]


@lru_cache(SHAPES)
def _room(record: Any, shapes: tuple[tuple[str, tuple[int, ...]], ...]) -> _Room:
    """Of a class of records; looked up once: records of the same shapes are made by the hundred."""
    import numpy as np

    lies, begin, words = dict[str, tuple[int, int, tuple[int, ...]]](), 0, dict[int, int]()
    fields = _fields(record)
    for name, shape in shapes:
        end = begin + math.prod(shape)
        lies[name] = begin, end, shape
        one = array("q", bytes(8 * WORDS))
        _tell(one, fields[name]._replace(word=0), 8 * begin, shape)
        words |= {fields[name].word + k: number for k, number in enumerate(one)}
        begin += LINE * -(-(end - begin) // LINE)
    starts = [fields[name].word for name, _ in shapes]
    behind = [words.pop(word) for word in starts]
    given = (starts, behind, list(words), list(words.values()))
    return _Room(begin, lies, *(np.array(one, np.int64) for one in given))


def _tell(words: array[int], field: _Field, start: int, shape: tuple[int, ...]) -> None:
    """Note where an array is, and its shape.  Raises TypeError where it is not as compiled code
    takes it to be."""
    name, word, dimensions, _, _, columns, number = field
    if len(shape) != dimensions:
        raise TypeError(f"{name}: {len(shape)} dimensions instead of {dimensions}")
    words[word] = start
    words[word + 1] = shape[0]
    if number and shape[0] != number:
        raise TypeError(f"{name}: {shape[0]} numbers instead of {number}")
    if dimensions > 1:
        words[word + 2] = shape[1]
        if columns and shape[1] != columns:
            raise TypeError(f"{name}: {shape[1]} columns instead of {columns}")
