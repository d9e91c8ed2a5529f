"""Records of arrays that compiled code receives as one pointer.

A Packed object holds named numpy arrays and numbers.  Compiled functions see it as a single word,
read `s.name` as a view of the array (no copy, no reference count), and may write into arrays, never
replace them.  Passing eighty arrays as arguments costs ten times the physics; this costs nothing.

In memory: three words per field, (address, rows, columns) of an array, or the number itself.
The addresses never change, which the loads say to the optimiser ("invariant").

What numba must know of it is in packed_numba.py, imported when a numba type is first asked for.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, get_type_hints

if TYPE_CHECKING:  # what the annotations mean to Python
    import numpy as np
    from numpy.typing import NDArray

    f8 = float
    i8 = int
    A1 = NDArray[np.float64]
    A2 = NDArray[np.float64]
    I1 = NDArray[np.int64]
    I2 = NDArray[np.int64]
else:  # and to the compiler

    def __getattr__(name: str) -> Any:
        """A1, A2, I1, I2, f8, i8: numba's types, imported when they are needed."""
        if name in ("A1", "A2", "I1", "I2", "f8", "i8"):
            from trsim.elements import packed_numba

            return getattr(packed_numba, name)
        raise AttributeError(name)


WORDS = 3  # per field


class _NumbaType:
    """The numba type of a class of records, made when it is first asked for."""

    def __get__(self, record: Any, owner: type) -> Any:
        if "_type" not in vars(owner):
            from trsim.elements import packed_numba as numba_side

            hints = get_type_hints(owner, localns=vars(numba_side))
            fields = {k: v for k, v in hints.items() if k != "numba_type"}
            owner._type = numba_side.PackedType(owner.__name__, tuple(fields.items()))  # type: ignore[attr-defined]
        return owner._type  # type: ignore[attr-defined]


class Packed:
    """Base class of records: subclasses annotate their fields with A1, A2, I1, I2, f8 or i8."""

    numba_type = _NumbaType()

    def __init__(self, **values: Any) -> None:
        import numpy as np

        fields = self.numba_type.fields
        missing = {name for name, _ in fields} ^ set(values)
        if missing:
            raise TypeError(f"{type(self).__name__}: fields {sorted(missing)} missing or unknown")
        self.words = np.zeros(WORDS * len(fields), np.int64)
        for k, (name, kind) in enumerate(fields):
            value = values[name]
            if _is_array(kind):
                wanted = np.float64 if str(kind.dtype) == "float64" else np.int64
                if not _as_it_is(value, wanted):
                    value = np.require(value, wanted, ["C", "W"])
                if value.ndim != kind.ndim:
                    raise TypeError(f"{name}: {value.ndim} dimensions instead of {kind.ndim}")
                self.words[WORDS * k] = value.ctypes.data
                self.words[WORDS * k + 1 : WORDS * k + 1 + value.ndim] = value.shape
            elif str(kind) == "float64":
                self.words[WORDS * k : WORDS * k + 1].view(np.float64)[0] = value
            else:
                self.words[WORDS * k] = value
            object.__setattr__(self, name, value)
        self.address: int = self.words.ctypes.data
        self._numba_type_ = self.numba_type  # what numba takes a record for

    def arrays(self) -> dict[str, np.ndarray]:
        """The arrays by name."""
        return {n: getattr(self, n) for n, kind in self.numba_type.fields if _is_array(kind)}


def _is_array(kind: Any) -> bool:
    return hasattr(kind, "ndim")


def _as_it_is(value: Any, wanted: Any) -> bool:
    """Whether compiled code can use the array without a copy."""
    flags = getattr(value, "flags", None)
    return flags is not None and value.dtype == wanted and flags.c_contiguous and flags.writeable
