"""numba, where something must be compiled: our types in its terms, and the machine code it makes.

Records are known by their type, and by `s.name` in compiled code, columns of an instance by
`own = Own(s, e)` and `own.name`.  Functions are compiled without
the wrappers that let Python call them: their machine code needs nothing but the C library, and can
be kept in a file (machine.py).
"""

import trsim.kernels.numba_quick  # noqa: F401 - before numba

# isort: split

import hashlib
from functools import cache
from types import CodeType, FunctionType
from typing import Any, NamedTuple

from llvmlite import ir
from numba import types
from numba.core import cgutils
from numba.core.datamodel import models
from numba.core.registry import cpu_target
from numba.core.typing.templates import AttributeTemplate
from numba.extending import (
    infer_getattr,
    intrinsic,
    lower_getattr_generic,
    lower_setattr_generic,
    register_model,
    typeof_impl,
)
from numba.np.arrayobj import populate_array

from trsim.kernels.columns import ARRAY, NUMBER, Column, Layout
from trsim.kernels.lazy import inner
from trsim.kernels.packed import WORDS
from trsim.kernels.signatures import Kind, Signature
from trsim.kernels.way import way

NUMBERS = {"float64": types.float64, "int64": types.int64, "complex128": types.complex128}
WORD = ir.IntType(64)


class Code(NamedTuple):
    """Machine code of one function."""

    symbol: str  # its name in the object file
    objects: bytes  # a relocatable object file
    needs: tuple[str, ...]  # functions of others it calls
    made_of: frozenset[CodeType]  # functions of ours in it


@cache
def numba_type(kind: Kind | None) -> Any:
    """What numba takes a kind for."""
    if kind is None:
        return types.void
    if kind.fields:
        return PackedType(kind)
    number = NUMBERS[kind.dtype]
    return types.Array(number, kind.dimensions, "C") if kind.dimensions else number


def numba_signature(signature: Signature) -> Any:
    return numba_type(signature.returns)(*map(numba_type, signature.arguments))


def dispatcher(python: Any, key: str) -> Any:
    """A function as numba's; the key makes its symbol the only one of its name."""
    named = FunctionType(python.__code__, python.__globals__, python.__name__,
                         python.__defaults__, python.__closure__)  # fmt: skip
    named.__qualname__, named.__module__ = f"{python.__name__}_{key}", python.__module__
    return inner(named)


def machine_code(compiled: Any, signature: Signature, processor: Any = None) -> Code:
    """Compile a dispatcher, and all it calls, for a signature.

    processor: LLVM's target machine, where it is not that of this process.
    """
    wanted = numba_signature(signature)
    with way.quick():
        compiled.compile(wanted)
        result = compiled.overloads[wanted.args]
        symbol = result.fndesc.llvm_func_name
        module, objects = way.translated(result.library, symbol, processor)
    functions = module.functions
    needs = [f.name for f in functions if f.is_declaration and not f.name.startswith("llvm.")]
    return Code(symbol, objects, tuple(needs), way.made_of(result.library))


def type_of(value: Any) -> Any:
    """What numba takes a global of a function for."""
    way.refresh()  # it may be new
    return cpu_target.typing_context.resolve_value_type(value)


def caller(signature: Signature) -> Any:
    """What compiled code takes `machine.Caller` for: call(address, *arguments)."""
    wanted = numba_signature(signature)

    @intrinsic
    def call(typingctx, address, *arguments):  # type: ignore[no-untyped-def]
        def codegen(context, builder, _, values):  # type: ignore[no-untyped-def]
            given = cgutils.unpack_tuple(builder, values[1])
            cast = [
                context.cast(builder, value, have, want)
                for value, have, want in zip(given, arguments, wanted.args, strict=True)
            ]
            returns = wanted.return_type
            function_type = context.call_conv.get_function_type(returns, wanted.args)
            pointer = builder.inttoptr(values[0], ir.PointerType(function_type))
            status, result = context.call_conv.call_function(
                builder, pointer, returns, wanted.args, cast
            )
            with cgutils.if_unlikely(builder, status.is_error):
                context.call_conv.return_status_propagate(builder, status)
            return context.get_dummy_value() if returns is types.none else result

        return wanted.return_type(types.int64, types.Tuple(arguments)), codegen

    return call


class PackedType(types.Type):
    """The numba type of a Packed record; two records with the same fields have the same type."""

    def __init__(self, kind: Kind) -> None:
        self.fields = tuple((field, numba_type(inner)) for field, inner in kind.fields)
        self.columns = tuple(inner.columns for _, inner in kind.fields)
        self.index = {field: k for k, (field, _) in enumerate(self.fields)}
        # a number that changes: place of its array, and which of its entries
        self.entries = {name: (self.index[holder], k) for name, holder, k in kind.entries}
        listed = ",".join(f"{field}:{inner.name}" for field, inner in kind.fields)
        listed += "".join(f",{name}={holder}[{k}]" for name, holder, k in kind.entries)
        digest = hashlib.sha256(listed.encode()).hexdigest()[:8]  # it stands in every symbol
        super().__init__(name=f"{kind.name}_{digest}")
        self.types = dict(self.fields)
        self.types |= {name: self.types[holder].dtype for name, holder, _ in kind.entries}


@register_model(PackedType)
class PackedModel(models.PrimitiveModel):
    """One word: the address of the record."""

    def __init__(self, dmm: Any, fe_type: Any) -> None:
        super().__init__(dmm, fe_type, WORD)


@infer_getattr
class PackedAttribute(AttributeTemplate):
    """`s.name` has the annotated type."""

    key = PackedType

    def generic_resolve(self, typ: PackedType, attr: str) -> types.Type | None:
        return typ.types.get(attr)


def _word(builder: Any, value: Any, k: int) -> Any:
    """The k-th word of a record, which never changes."""
    base = builder.inttoptr(value, ir.PointerType(WORD))
    loaded = builder.load(builder.gep(base, [ir.Constant(WORD, k)]))
    loaded.set_metadata("invariant.load", builder.module.add_metadata([]))
    return loaded


def _entry(context: Any, builder: Any, typ: PackedType, value: Any, attr: str) -> Any:
    """Where a number that changes is."""
    place, k = typ.entries[attr]
    number = ir.PointerType(context.get_data_type(typ.types[attr]))
    array = builder.inttoptr(_word(builder, value, WORDS * place), number)
    return builder.gep(array, [ir.Constant(WORD, k)])


@lower_setattr_generic(PackedType)
def _setattr(context: Any, builder: Any, sig: Any, arguments: Any, attr: str) -> None:
    typ, (value, number) = sig.args[0], arguments
    if attr not in typ.entries:
        raise TypeError(f"{typ.name}: '{attr}' does not change")
    builder.store(number, _entry(context, builder, typ, value, attr))


@lower_getattr_generic(PackedType)
def _getattr(context: Any, builder: Any, typ: PackedType, value: Any, attr: str) -> Any:
    if attr in typ.entries:
        return builder.load(_entry(context, builder, typ, value, attr))
    place = typ.index[attr]
    kind, columns = typ.fields[place][1], typ.columns[place]
    first = _word(builder, value, WORDS * place)
    if not isinstance(kind, types.Array):
        return builder.bitcast(first, ir.DoubleType()) if kind == types.float64 else first
    shape = [_word(builder, value, WORDS * place + 1 + k) for k in range(kind.ndim)]
    if columns:
        shape[1] = ir.Constant(WORD, columns)
    return _array(context, builder, kind, first, shape)


def _array(context: Any, builder: Any, kind: Any, address: Any, shape: list[Any]) -> Any:
    """An array at an address."""
    array = context.make_array(kind)(context, builder)
    size = ir.Constant(WORD, kind.dtype.bitwidth // 8)
    strides = [size] if kind.ndim == 1 else [builder.mul(shape[1], size), size]
    populate_array(
        array,
        data=builder.inttoptr(address, array.data.type),
        shape=cgutils.pack_array(builder, shape),
        strides=cgutils.pack_array(builder, strides),
        itemsize=size,
        meminfo=None,
    )
    return array._getvalue()


class ColumnsType(types.Type):
    """The numba type of the columns of an instance, in the tables of a record."""

    def __init__(self, layout: Layout, record: PackedType) -> None:
        self.record, self.tables = record, [t for t in layout.tables if t in record.index]
        self.columns = {k: c for k, c in layout.columns.items() if c.table in self.tables}
        digest = hashlib.sha256(f"{record.name} {self.columns}".encode()).hexdigest()[:8]
        super().__init__(name=f"{layout.__name__}_{digest}")

    def kind(self, column: Column) -> Any:
        """The type of a field."""
        number = types.int64 if column.table == "con" else types.float64
        if column.form == ARRAY:
            return types.Array(number, 1, "C")
        return number if column.form == NUMBER else types.UniTuple(number, column.number)


@register_model(ColumnsType)
class ColumnsModel(models.StructModel):
    """The record, and where the row begins in each of its tables."""

    def __init__(self, dmm: Any, fe_type: ColumnsType) -> None:
        rows = [(t, types.CPointer(_entries(fe_type.record, t).dtype)) for t in fe_type.tables]
        super().__init__(dmm, fe_type, [("record", fe_type.record), *rows])


def _entries(record: PackedType, table: str) -> Any:
    """The type of a table of a record."""
    return record.fields[record.index[table]][1]


@typeof_impl.register(Layout)
def _typeof(layout: Layout, _: Any) -> Any:
    return type_of(_at_row(layout))


@cache
def _at_row(layout: Layout) -> Any:
    """What compiled code takes a class of columns for: Own(record, e)."""

    @intrinsic
    def at_row(typingctx, record, e):  # type: ignore[no-untyped-def]
        columns = ColumnsType(layout, record)

        def codegen(context, builder, _, values):  # type: ignore[no-untyped-def]
            own = cgutils.create_struct_proxy(columns)(context, builder)
            own.record = values[0]
            for table in columns.tables:
                first = WORDS * record.index[table]  # address, rows, columns
                entry = context.get_value_type(_entries(record, table).dtype)
                base = builder.inttoptr(_word(builder, values[0], first), entry.as_pointer())
                begin = builder.mul(values[1], _word(builder, values[0], first + 2))
                setattr(own, table, builder.gep(base, [begin], inbounds=True))
            return own._getvalue()

        return columns(record, types.int64), codegen

    return at_row


@infer_getattr
class ColumnsAttribute(AttributeTemplate):
    """`own.name` has the type of its columns."""

    key = ColumnsType

    def generic_resolve(self, typ: ColumnsType, attr: str) -> types.Type | None:
        return typ.kind(typ.columns[attr]) if attr in typ.columns else None


def _place(context: Any, builder: Any, typ: ColumnsType, value: Any, column: Column, k: int) -> Any:
    """The address of a column of a field."""
    own = cgutils.create_struct_proxy(typ)(context, builder, value=value)
    at = ir.Constant(WORD, column.at + k)
    return builder.gep(getattr(own, column.table), [at], inbounds=True)


@lower_getattr_generic(ColumnsType)
def _get_column(context: Any, builder: Any, typ: ColumnsType, value: Any, attr: str) -> Any:
    column = typ.columns[attr]
    if column.form == ARRAY:
        size = ir.Constant(WORD, column.number)
        if not column.number:
            own = cgutils.create_struct_proxy(typ)(context, builder, value=value)
            whole = _word(builder, own.record, WORDS * typ.record.index[column.table] + 2)
            size = builder.sub(whole, ir.Constant(WORD, column.at))
        first = builder.ptrtoint(_place(context, builder, typ, value, column, 0), WORD)
        return _array(context, builder, typ.kind(column), first, [size])
    places = (_place(context, builder, typ, value, column, k) for k in range(column.number))
    loaded = [builder.load(place) for place in places]
    if column.form == NUMBER:
        return loaded[0]
    return context.make_tuple(builder, typ.kind(column), loaded)


@lower_setattr_generic(ColumnsType)
def _set_column(context: Any, builder: Any, sig: Any, args: Any, attr: str) -> None:
    typ, column = sig.args[0], sig.args[0].columns[attr]
    if column.table != "mem":
        raise TypeError(f"'{attr}': constants of an instance cannot be written")
    builder.store(args[1], _place(context, builder, typ, args[0], column, 0))
