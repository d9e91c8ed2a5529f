"""The key of a compiled function: everything its machine code depends on.

Its bytecode and constants, the same of every function it calls, the values of the constants it
reads, the signature with all fields of the records in it, the files that tell numba how to compile,
the versions of the compiler, and the processor.
"""

import hashlib
from collections.abc import Callable
from functools import cache
from opcode import opmap
from pathlib import Path
from types import BuiltinFunctionType, CodeType, FunctionType, ModuleType
from typing import Any

from trsim.elements.signatures import Signature
from trsim.laws import COMPILED, UNWRAPPED, Lazy

LENGTH = 20  # hexadecimal digits
EXTENDED_ARG, LOAD_GLOBAL = opmap["EXTENDED_ARG"], opmap["LOAD_GLOBAL"]
COMPILER = ("compiler.py", "numba_quick.py", "machine.py", "../laws/pipeline.py")


def of(python: Callable, signature: Signature) -> str:
    """The key of a function with a signature."""
    parts = (_surroundings(), repr(signature), _function(python))
    return hashlib.sha256("\n".join(parts).encode()).hexdigest()[:LENGTH]


@cache
def _surroundings() -> str:
    """Compiler and processor."""
    from importlib.metadata import version

    import llvmlite.binding as llvm

    here = Path(__file__).parent
    files = [hashlib.sha256((here / name).read_bytes()).hexdigest() for name in COMPILER]
    processor = llvm.get_host_cpu_name(), llvm.get_host_cpu_features().flatten()
    options = COMPILED, UNWRAPPED
    return repr((files, options, version("numba"), llvm.llvm_version_info, processor))


@cache
def _function(python: Any) -> str:
    """A function with everything it reads, as a digest."""
    told = [_code(python.__code__)]
    scope, seen = python.__globals__, set[str]()
    for code in _codes(python.__code__):
        seen |= _globals(code)
    told += [f"{name} {_value(scope[name])}" for name in sorted(seen) if name in scope]
    told += [_value(cell.cell_contents) for cell in python.__closure__ or ()]
    told += [_value(default) for default in python.__defaults__ or ()]
    return hashlib.sha256("\n".join(told).encode()).hexdigest()


def _codes(code: CodeType) -> list[CodeType]:
    """A code object and those inside it."""
    inner = [_codes(c) for c in code.co_consts if isinstance(c, CodeType)]
    return [code, *(c for codes in inner for c in codes)]


def _globals(code: CodeType) -> set[str]:
    """Names of the globals a code object reads; its other names are attributes."""
    found, extended = set[str](), 0
    for op, argument in zip(code.co_code[::2], code.co_code[1::2], strict=True):
        argument |= extended << 8
        extended = argument if op == EXTENDED_ARG else 0
        if op == LOAD_GLOBAL:
            found.add(code.co_names[argument >> 1])
    return found


def _code(code: CodeType) -> str:
    """Bytecode and constants."""
    constants = [_constant(c) for c in code.co_consts]
    return repr((code.co_code.hex(), constants, code.co_names, code.co_varnames))


def _constant(value: Any) -> str:
    if isinstance(value, CodeType):
        return _code(value)
    # the order of a set differs from process to process
    return repr(sorted(map(repr, value)) if isinstance(value, frozenset) else value)


def _value(value: Any) -> str:
    """A global of a function."""
    if isinstance(value, Lazy):
        return _function(value.python)
    if isinstance(value, FunctionType):
        return _function(value)
    if isinstance(value, ModuleType):
        return value.__name__
    if isinstance(value, BuiltinFunctionType | type):
        return f"{value.__module__}.{value.__qualname__}"
    if hasattr(value, "tobytes"):
        return f"{value.dtype} {value.shape} {hashlib.sha256(value.tobytes()).hexdigest()}"
    signature = getattr(value, "signature", None)
    return repr(value) if signature is None else repr(signature)
