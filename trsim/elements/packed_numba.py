"""What numba knows of Packed records: their type, and `s.name` in compiled code."""

from typing import Any

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
    unbox,
)
from numba.np.arrayobj import populate_array

import trsim.elements.numba_quick  # noqa: F401
from trsim.elements.packed import WORDS

f8, i8 = types.float64, types.int64
A1, A2 = types.Array(f8, 1, "C"), types.Array(f8, 2, "C")
I1, I2 = types.Array(i8, 1, "C"), types.Array(i8, 2, "C")


class PackedType(types.Type):
    """The numba type of a Packed record; two records with the same fields have the same type."""

    def __init__(self, name: str, fields: tuple[tuple[str, types.Type], ...]) -> None:
        self.fields = fields
        self.index = {field: k for k, (field, _) in enumerate(fields)}
        listed = ",".join(f"{field}:{kind}" for field, kind in fields)
        super().__init__(name=f"{name}({listed})")


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
