"""Records of arrays that compiled code receives as one pointer.

A Packed object holds named numpy arrays and numbers.  Compiled functions see it as a single word,
read `s.name` as a view of the array (no copy, no reference count), and may write into arrays, never
replace them.  Passing eighty arrays as arguments costs ten times the physics; this costs nothing.

In memory: three words per field, (address, rows, columns) of an array, or the number itself.
The addresses never change, which the loads say to the optimiser ("invariant").
"""

from typing import TYPE_CHECKING, Any, get_type_hints

import numpy as np
from llvmlite import ir
from numba import types
from numba.core import cgutils
from numba.core.datamodel import models
from numba.core.typing.templates import AttributeTemplate
from numba.extending import (
    NativeValue,
    infer_getattr,
    lower_getattr_generic,
    register_model,
    typeof_impl,
    unbox,
)
from numba.np.arrayobj import populate_array

import trsim.elements.numba_quick  # noqa: F401

if TYPE_CHECKING:  # what the annotations mean to Python
    from numpy.typing import NDArray

    f8 = float
    i8 = int
    A1 = NDArray[np.float64]
    A2 = NDArray[np.float64]
    I1 = NDArray[np.int64]
    I2 = NDArray[np.int64]
else:  # and to the compiler
    f8, i8 = types.float64, types.int64
    A1, A2 = types.Array(f8, 1, "C"), types.Array(f8, 2, "C")
    I1, I2 = types.Array(i8, 1, "C"), types.Array(i8, 2, "C")

WORDS = 3  # per field


class PackedType(types.Type):
    """The numba type of a Packed record; two records with the same fields have the same type."""

    def __init__(self, name: str, fields: tuple[tuple[str, types.Type], ...]) -> None:
        self.fields = fields
        self.index = {field: k for k, (field, _) in enumerate(fields)}
        listed = ",".join(f"{field}:{kind}" for field, kind in fields)
        super().__init__(name=f"{name}({listed})")


class Packed:
    """Base class of records: subclasses annotate their fields with A1, A2, I1, I2, f8 or i8."""

    numba_type: PackedType

    def __init_subclass__(cls) -> None:
        hints = {k: v for k, v in get_type_hints(cls).items() if k != "numba_type"}
        cls.numba_type = PackedType(cls.__name__, tuple(hints.items()))

    def __init__(self, **values: Any) -> None:
        fields = self.numba_type.fields
        missing = {name for name, _ in fields} ^ set(values)
        if missing:
            raise TypeError(f"{type(self).__name__}: fields {sorted(missing)} missing or unknown")
        self.words = np.zeros(WORDS * len(fields), np.int64)
        for k, (name, kind) in enumerate(fields):
            value = values[name]
            if isinstance(kind, types.Array):
                wanted = np.float64 if kind.dtype == f8 else np.int64
                value = np.require(value, wanted, ["C", "W"])
                if value.ndim != kind.ndim:
                    raise TypeError(f"{name}: {value.ndim} dimensions instead of {kind.ndim}")
                self.words[WORDS * k] = value.ctypes.data
                self.words[WORDS * k + 1 : WORDS * k + 1 + value.ndim] = value.shape
            elif kind == f8:
                self.words[WORDS * k : WORDS * k + 1].view(np.float64)[0] = value
            else:
                self.words[WORDS * k] = value
            object.__setattr__(self, name, value)

    @property
    def address(self) -> int:
        return self.words.ctypes.data

    def arrays(self) -> dict[str, np.ndarray]:
        """The arrays by name."""
        return {
            n: getattr(self, n) for n, k in self.numba_type.fields if isinstance(k, types.Array)
        }


@typeof_impl.register(Packed)
def _typeof(value: Packed, context: Any) -> PackedType:
    return value.numba_type


@register_model(PackedType)
class PackedModel(models.PrimitiveModel):
    """One word: the address of the record."""

    def __init__(self, dmm: Any, fe_type: Any) -> None:
        super().__init__(dmm, fe_type, ir.IntType(64))


@unbox(PackedType)
def _unbox(typ: PackedType, obj: Any, c: Any) -> NativeValue:
    attribute = c.pyapi.object_getattr_string(obj, "address")
    address = c.pyapi.long_as_longlong(attribute)
    c.pyapi.decref(attribute)
    return NativeValue(address, is_error=cgutils.is_not_null(c.builder, c.pyapi.err_occurred()))


@infer_getattr
class PackedAttribute(AttributeTemplate):
    """`s.name` has the annotated type."""

    key = PackedType

    def generic_resolve(self, typ: PackedType, attr: str) -> types.Type | None:
        return typ.fields[typ.index[attr]][1] if attr in typ.index else None


@lower_getattr_generic(PackedType)
def _getattr(context: Any, builder: Any, typ: PackedType, value: Any, attr: str) -> Any:
    place = typ.index[attr]
    kind = typ.fields[place][1]
    word_type = ir.IntType(64)
    base = builder.inttoptr(value, ir.PointerType(word_type))

    def word(k: int) -> Any:
        pointer = builder.gep(base, [ir.Constant(word_type, WORDS * place + k)])
        loaded = builder.load(pointer)
        loaded.set_metadata("invariant.load", builder.module.add_metadata([]))
        return loaded

    if not isinstance(kind, types.Array):
        return builder.bitcast(word(0), ir.DoubleType()) if kind == f8 else word(0)
    array = context.make_array(kind)(context, builder)
    shape = [word(1 + k) for k in range(kind.ndim)]
    size = ir.Constant(word_type, 8)
    strides = [size] if kind.ndim == 1 else [builder.mul(shape[1], size), size]
    populate_array(
        array,
        data=builder.inttoptr(word(0), array.data.type),
        shape=cgutils.pack_array(builder, shape),
        strides=cgutils.pack_array(builder, strides),
        itemsize=size,
        meminfo=None,
    )
    return array._getvalue()
