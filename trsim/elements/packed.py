"""Records of arrays that compiled code receives as one pointer.

A Packed object holds named numpy arrays and numbers.  Compiled functions see it as a single word,
read `s.name` as a view of the array (no copy, no reference count), and may write into arrays, never
replace them.  Passing eighty arrays as arguments costs ten times the physics; this costs nothing.

In memory: three words per field, (address, rows, columns) of an array, or the number itself.
The addresses never change, which the loads say to the optimiser ("invariant").

What the compiler must know of it is in compiler.py, imported when something is compiled.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from trsim.elements.signatures import KINDS, Kind

if TYPE_CHECKING:  # what the annotations mean to Python
    import numpy as np
    from numpy.typing import NDArray

    f8 = float
    i8 = int
    A1 = NDArray[np.float64]
    A2 = NDArray[np.float64]
    I1 = NDArray[np.int64]
    I2 = NDArray[np.int64]
else:  # and to compiled code
    from trsim.elements.signatures import A1, A2, I1, I2, f8, i8

__all__ = ["A1", "A2", "I1", "I2", "WORDS", "Packed", "f8", "i8"]

WORDS = 3  # per field


class Packed:
    """Base class of records: subclasses annotate their fields with A1, A2, I1, I2, f8 or i8."""

    kind: Kind  # what signatures call it

    def __init_subclass__(cls) -> None:
        own = {k: v for k, v in vars(cls).get("__annotations__", {}).items() if k != "kind"}
        inherited = dict(cls.kind.fields) if hasattr(cls, "kind") else {}
        fields = {k: v if isinstance(v, Kind) else KINDS[v] for k, v in own.items()}
        cls.kind = Kind(cls.__name__, fields=tuple({**inherited, **fields}.items()))

    def __init__(self, **values: Any) -> None:
        import numpy as np

        fields = self.kind.fields
        missing = {name for name, _ in fields} ^ set(values)
        if missing:
            raise TypeError(f"{type(self).__name__}: fields {sorted(missing)} missing or unknown")
        self.words = np.zeros(WORDS * len(fields), np.int64)
        for k, (name, kind) in enumerate(fields):
            value = values[name]
            if kind.dimensions:
                if not _fits(value, kind):
                    value = np.require(value, kind.dtype, ["C", "W"])
                if value.ndim != kind.dimensions:
                    raise TypeError(f"{name}: {value.ndim} dimensions instead of {kind.dimensions}")
                self.words[WORDS * k] = value.ctypes.data
                self.words[WORDS * k + 1 : WORDS * k + 1 + value.ndim] = value.shape
            elif kind.dtype == "float64":
                self.words[WORDS * k : WORDS * k + 1].view(np.float64)[0] = value
            else:
                self.words[WORDS * k] = value
            setattr(self, name, value)
        self.address = self.words.ctypes.data

    def arrays(self) -> dict[str, Any]:
        """The arrays by name."""
        return {name: getattr(self, name) for name, kind in self.kind.fields if kind.dimensions}


def _fits(value: Any, kind: Kind) -> bool:
    """Whether compiled code can work on an array as it is."""
    flags = getattr(value, "flags", None)
    return flags is not None and value.dtype == kind.dtype and flags.carray
