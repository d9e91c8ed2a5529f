"""Calling a function by its address.

The tables of a model hold addresses of machine code, so the solver is compiled once per
installation and a scenario loads only the elements it uses.  A call costs a few nanoseconds.
"""

from collections.abc import Callable
from typing import Any

from llvmlite import ir
from numba import types
from numba.core import cgutils
from numba.extending import intrinsic

from trsim.elements.contract import KERNEL


def caller(signature: Any) -> Callable:
    """A function call(address, *arguments) for functions of the given signature."""

    @intrinsic
    def call(typingctx, address, *arguments):  # type: ignore[no-untyped-def]
        wanted = signature.args

        def codegen(context, builder, _, values):  # type: ignore[no-untyped-def]
            given = cgutils.unpack_tuple(builder, values[1])
            cast = [
                context.cast(builder, value, have, want)
                for value, have, want in zip(given, arguments, wanted, strict=True)
            ]
            returns = signature.return_type
            function_type = context.call_conv.get_function_type(returns, wanted)
            pointer = builder.inttoptr(values[0], ir.PointerType(function_type))
            status, result = context.call_conv.call_function(
                builder, pointer, returns, wanted, cast
            )
            with cgutils.if_unlikely(builder, status.is_error):
                context.call_conv.return_status_propagate(builder, status)
            return context.get_dummy_value() if returns is types.none else result

        return signature.return_type(types.int64, types.Tuple(arguments)), codegen

    return call


call_kernel = caller(KERNEL)
