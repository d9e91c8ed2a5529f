"""The key of a compiled function: everything its machine code depends on.

Its bytecode and constants, the same of every function it reaches, the values of the constants it
reads, the signature with all fields of the records in it, the files that tell numba how to compile,
the versions of the compiler, numba's settings, and the processor.

A function is reached by its name, as `module.function`, or from a closure, a default, a tuple or a
dictionary.  What cannot be told by its content is refused, with the place it is read at: a key that
left something out would run old machine code after an edit.
"""

import hashlib
import os
import sys
from collections.abc import Callable, Iterator
from enum import Enum
from functools import cache
from opcode import opmap
from operator import itemgetter
from pathlib import Path
from types import CodeType, FunctionType, ModuleType
from typing import Any, NamedTuple, NoReturn

from trsim.kernels.columns import Layout
from trsim.kernels.lazy import COMPILED, UNWRAPPED, Lazy
from trsim.kernels.signatures import Signature

LENGTH = 20  # hexadecimal digits
CACHE, EXTENDED_ARG = opmap["CACHE"], opmap["EXTENDED_ARG"]
LOAD_GLOBAL, LOAD_ATTR = opmap["LOAD_GLOBAL"], opmap["LOAD_ATTR"]
LOAD_METHOD = LOAD_ATTR if sys.version_info >= (3, 12) else opmap["LOAD_METHOD"]
ATTRIBUTE_SHIFT = int(LOAD_METHOD == LOAD_ATTR)  # since 3.12 the last bit tells a method
# the package's own files that decide what a function becomes
COMPILER = (
    "kernels/buffer.py", "kernels/columns.py", "kernels/compiler.py", "kernels/fingerprint.py",
    "kernels/lazy.py", "kernels/numba_own.py", "kernels/numba_quick.py", "kernels/packed.py",
    "kernels/pipeline.py", "kernels/plain.py", "kernels/signatures.py", "kernels/way.py",
)  # fmt: skip
# told by their names: they belong to Python, numpy or numba, whose versions are in every key
OF_OTHERS = frozenset({"builtins", "cmath", "math", "operator", "numpy", "numba"})
LARGEST = 10**6  # bytes of an array whose numbers numba puts into the machine code
PLAIN = frozenset({bool, bytes, complex, float, int, range, str, type(None), type(...)})


class Told(NamedTuple):
    """A function with everything it reads, as a digest; the functions it reaches at once."""

    digest: str
    reached: tuple[FunctionType, ...]


def of(python: Callable, signature: Signature, surroundings: str | None = None) -> str:
    """The key of a function with a signature.

    surroundings: in place of this compiler, its settings and this processor; whoever gives them
    answers for these (carried.py).
    """
    around = _surroundings() if surroundings is None else surroundings
    parts = (around, repr(signature), _function(python).digest)
    return hashlib.sha256("\n".join(parts).encode()).hexdigest()[:LENGTH]


def mark(python: Callable, signature: Signature) -> str:
    """What a function is called whatever Python made its bytecode, as long as no source changes.

    A key with the places of sources in place of bytecode.
    """
    parts = (repr(signature), _function(python, _place).digest)
    return hashlib.sha256("\n".join(parts).encode()).hexdigest()[:LENGTH]


def covered(python: Callable) -> set[CodeType]:
    """The code of a function, and of all others that its key covers."""
    found, waiting = set[Any](), [python]
    while waiting:
        one = waiting.pop()
        if one not in found:  # two closures of one body reach what each has
            found.add(one)
            waiting += _function(one).reached
    return {one.__code__ for one in found}


@cache
def _surroundings() -> str:
    """Compiler, its settings, and processor."""
    from importlib.metadata import version

    import llvmlite
    import llvmlite.binding as llvm
    import numpy as np

    versions = sys.version, np.__version__, version("numba"), llvmlite.__version__
    processor = llvm.get_host_cpu_name(), llvm.get_host_cpu_features().flatten()
    return repr((how(), settings(), versions, llvm.llvm_version_info, processor))


@cache
def how() -> str:
    """What of this package decides how code is made."""
    package = Path(__file__).parents[1]
    files = [_digest((package / name).read_bytes()) for name in COMPILER]
    return _digest(repr((files, COMPILED, UNWRAPPED)).encode())


def settings() -> list[tuple[str, str]]:
    """Variables of the environment that numba reads."""
    return sorted(
        (name, value) for name, value in os.environ.items()
        if name.startswith("NUMBA_") and name != "NUMBA_NUM_THREADS"  # nothing is parallel
    )  # fmt: skip


_open: list[Callable] = []  # whose digests are being made


def _code(code: CodeType) -> str:
    """Bytecode and constants, and how arguments are taken."""
    constants = [_constant(c) for c in code.co_consts]
    names = code.co_names, code.co_varnames, code.co_freevars, code.co_cellvars
    counts = code.co_argcount, code.co_posonlyargcount, code.co_kwonlyargcount, code.co_flags
    return repr((code.co_code.hex(), code.co_exceptiontable.hex(), constants, names, counts))


def _place(code: CodeType) -> str:
    """Where a function is written."""
    package = Path(__file__).parents[1]
    file = Path(code.co_filename)
    inside = file.relative_to(package).as_posix() if file.is_relative_to(package) else file.name
    return f"{inside} {code.co_firstlineno} {code.co_qualname}"


@cache
def _function(python: Any, told_of: Callable[[CodeType], str] = _code) -> Told:
    """A function with everything it reads; told_of: what its own code is told by."""
    if python in _open:
        _refuse(python, python.__name__, "calls itself")
    _open.append(python)
    try:
        reached: list[FunctionType] = []

        def function(one: Any) -> str:
            reached.append(one)
            return _function(one, told_of).digest

        told = [told_of(python.__code__)]
        for path, value in _read(python):
            told.append(f"{path} {_value(value, python, path, function)}")
        return Told(_digest("\n".join(told).encode()), tuple(reached))
    finally:
        _open.pop()


def _read(python: Any) -> Iterator[tuple[str, Any]]:
    """What a function reads beside its arguments: where it stands, and its value."""
    scope, seen = python.__globals__, dict[tuple[str, ...], None]()
    for code in _codes(python.__code__):
        seen.update(dict.fromkeys(_globals(code, scope)))
    for path in sorted(seen):
        value = scope[path[0]]
        for name in path[1:]:
            value = getattr(value, name)
        if isinstance(value, ModuleType):
            _refuse(python, ".".join(path), "is a module, read for other than a name in it")
        yield ".".join(path), value
    cells = zip(python.__code__.co_freevars, python.__closure__ or (), strict=True)
    for name, cell in sorted(cells, key=itemgetter(0)):
        yield f"cell {name}", cell.cell_contents
    for k, default in enumerate(python.__defaults__ or ()):
        yield f"default {k}", default
    for name, default in sorted((python.__kwdefaults__ or {}).items()):
        yield f"default {name}", default


def _codes(code: CodeType) -> list[CodeType]:
    """A code object and those inside it."""
    inner = [_codes(c) for c in code.co_consts if isinstance(c, CodeType)]
    return [code, *(c for codes in inner for c in codes)]


def _globals(code: CodeType, scope: dict[str, Any]) -> Iterator[tuple[str, ...]]:
    """The globals a code object reads, those in modules by the names that lead to them.

    Names that are not in the scope are Python's own.
    """
    operations, arguments = code.co_code[::2], code.co_code[1::2]
    k = operations.find(LOAD_GLOBAL)
    while k >= 0:
        name = code.co_names[_argument(operations, arguments, k) >> 1]
        if name in scope:
            path: tuple[str, ...] = (name,)
            value, at = scope[name], k
            while isinstance(value, ModuleType):
                at = _after(operations, at)
                if operations[at] not in (LOAD_ATTR, LOAD_METHOD):
                    break
                argument = _argument(operations, arguments, at)
                path += (code.co_names[argument >> ATTRIBUTE_SHIFT],)
                value = getattr(value, path[-1])
            yield path
        k = operations.find(LOAD_GLOBAL, k + 1)


def _argument(operations: bytes, arguments: bytes, k: int) -> int:
    """The argument of an operation, with the higher bytes that stand before it."""
    argument, shift = arguments[k], 8
    while k > 0 and operations[k - 1] == EXTENDED_ARG:
        k -= 1
        argument |= arguments[k] << shift
        shift += 8
    return argument


def _after(operations: bytes, k: int) -> int:
    """Where the next operation stands."""
    k += 1
    while operations[k] in (CACHE, EXTENDED_ARG):
        k += 1
    return k


def _constant(value: Any) -> str:
    if isinstance(value, CodeType):
        return _code(value)
    if isinstance(value, tuple):
        return f"({','.join(map(_constant, value))})"
    # the order of a set differs from process to process
    return repr(sorted(map(_constant, value)) if isinstance(value, frozenset) else value)


def _value(
    value: Any, python: Callable, path: str, told: Callable[[FunctionType], str]
) -> str:  # fmt: skip
    """Something a function reads, by its content; functions by what is told of them."""
    kind = type(value)
    if kind in PLAIN:
        return f"{kind.__name__} {value!r}"
    if isinstance(value, Layout):
        return repr(value.columns)
    if isinstance(value, Lazy) or (kind is FunctionType and not _name(value)):
        function: Any = value.python if isinstance(value, Lazy) else value
        return told(function)
    if hasattr(kind, "tobytes") and not value.dtype.hasobject:
        order = value.flags.c_contiguous, value.flags.f_contiguous
        if not any(order) or value.nbytes > LARGEST:
            _refuse(
                python, path, "is a view with gaps or larger than 1 MB: numba keeps its address"
            )
        return f"{value.dtype.str} {value.shape} {order} {_digest(value.tobytes())}"
    parts = _parts(value)
    if parts is not None:
        each = [_value(part, python, path, told) for part in parts]
        return f"{kind.__qualname__} {getattr(kind, '_fields', '')} ({','.join(each)})"
    signature = getattr(value, "signature", None)
    if isinstance(signature, Signature):  # a machine.Caller: its code is made of this alone
        return repr(signature)
    return _name(value) or _refuse(python, path, f"is a {kind.__qualname__}")


def _parts(value: Any) -> list[Any] | None:
    """What a container holds, in its order; None: it is no container."""
    if isinstance(value, tuple | list):
        return list(value)
    if type(value) is dict:
        return [part for item in value.items() for part in item]
    if isinstance(value, set | frozenset):
        return sorted(value, key=repr)
    if isinstance(value, Enum):
        return [value.name, value.value]
    if isinstance(value, type) and issubclass(value, Enum):
        return [part for one in value for part in (one.name, one.value)]
    return None


def _name(value: Any) -> str:
    """What Python, numpy or numba have under a name; empty for everything else."""
    module = getattr(value, "__module__", None) or "numpy"  # its ufuncs have none
    name = getattr(value, "__qualname__", None) or getattr(value, "__name__", None)
    if name is None or module.split(".")[0] not in OF_OTHERS:
        return ""
    found = sys.modules.get(module)
    for part in name.split("."):
        found = getattr(found, part, None)
    return f"{module}.{name}" if found is value else ""


def _digest(content: bytes) -> str:
    return hashlib.sha256(content).hexdigest()


def _refuse(python: Any, path: str, why: str) -> NoReturn:
    raise TypeError(
        f"{python.__module__}.{python.__qualname__}: '{path}' {why}. Compiled code may read "
        "numbers, texts, arrays, tuples of them, and functions, by name or as module.name: other "
        "things cannot be told by their content, and old machine code would run after an edit."
    )
