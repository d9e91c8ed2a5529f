"""Compiled functions, called by address, their machine code kept between runs.

A function is compiled when it is first needed and never again: its machine code is kept in the
user's cache folder (kept.py) under a key made of its bytecode, of that of everything it reaches, of
the types it works on, of the compiler and of the processor (fingerprint.py).  Loading it takes
LLVM's loader and half a millisecond; numba, with half a second of imports, is not touched.
Whatever is edited gets another key, so nothing old is ever run.  What the cache does not have may
have come with the package (carried.py).

Every call, from Python or from other machine code, is numba's own calling convention,

    status = f(&result, &exception, arguments...)

with an array as (0, 0, size, bytes of an entry, data, shape, strides).
"""

import ctypes
from collections.abc import Callable
from contextlib import suppress
from ctypes import addressof, byref, c_void_p
from functools import cache, cached_property
from pathlib import Path
from typing import Any

from trsim.errors import FileError
from trsim.kernels import carried, fingerprint, kept
from trsim.kernels.buffer import address, at
from trsim.kernels.kept import folder
from trsim.kernels.lazy import PYTHON, Lazy
from trsim.kernels.lock import turn
from trsim.kernels.signatures import Kind, Signature

# what an object file may ask of the process: the C library's mathematics and memory
LIBRARY = frozenset(
    """acos acosh asin asinh atan atan2 atanh cbrt ceil copysign cos cosh erf exp exp2 expm1 fabs
    floor fma fmod frexp hypot ldexp lgamma log log10 log1p log2 memcpy memmove memset nearbyint
    pow rint round sin sincos sinh sqrt tan tanh tgamma trunc""".split()  # noqa: SIM905
)
LETTERS = {"float64": "d", "int64": "lq", "complex128": "D"}  # numpy's
RECORD, NUMBER = -1, 0  # instead of the dimensions of an argument
UNREAD = byref(c_void_p())  # where what a function raises is put: its status says enough
ERRORS = (-1,)  # of a status; above 0: an exception of the function's own
made: list["Compiled"] = []  # all functions of modules that were imported


def lock() -> Path:
    """The file that tells who is compiling what (lock.py)."""
    return folder() / "lock"


class Compiled(Lazy):
    """A function with a fixed signature that compiles, or is loaded, on first use."""

    def __init__(self, python: Callable, signature: Signature) -> None:
        super().__init__(python)
        self.signature = signature
        made.append(self)

    @cached_property
    def key(self) -> str:
        """Everything its machine code depends on, in one word."""
        return fingerprint.of(self.python, self.signature)

    @cached_property
    def inner(self) -> Any:
        """For compiled functions that call this one directly, and to compile it."""
        from trsim.kernels.compiler import dispatcher

        return dispatcher(self.python, self.key)

    @cached_property
    def file(self) -> Path:
        """Where its machine code is kept."""
        return folder() / f"{carried.name(self.python)}-{self.key}.code"

    @property
    def known(self) -> bool:
        """Whether its machine code is kept or carried, and whole, or none is needed."""
        return PYTHON or self._found() is not None

    def _found(self) -> tuple[str, bytes] | None:
        """Symbol and object file: from the cache, or as they came with the package."""
        kept_one = _read(self.file)
        return carried.code(self.python, self.signature) if kept_one is None else kept_one

    @cached_property
    def entry(self) -> int:
        """Where the machine code starts."""
        code = self._found()
        if code is None:
            with turn(lock(), self.key):  # another process may be compiling it
                code = _read(self.file) or self._compiled()
        return _loaded(*code)

    def keep(self) -> None:
        """Have the machine code in the cache, unless another process is at it."""
        with turn(lock(), self.key, wait=False) as ours:
            if ours and self._found() is None:
                self._compiled()

    def _compiled(self) -> tuple[str, bytes]:
        """Symbol and object file, just compiled; they are kept where that is possible."""
        carried.tell()
        code = self.translated()
        with suppress(OSError):  # a folder that cannot be written to: compiled again next time
            kept.store(self.file, [carried.sealed(*code)])
        return code

    def translated(self, processor: Any = None) -> tuple[str, bytes]:
        """Symbol and object file for a processor, LLVM's target machine; None: the one it is."""
        from trsim.kernels.compiler import machine_code

        code = machine_code(self.inner, self.signature, processor)
        foreign = set(code.needs) - LIBRARY
        if foreign:
            raise RuntimeError(f"{self.file.stem} needs {sorted(foreign)} of others")
        unseen = code.made_of - fingerprint.covered(self.python)
        if unseen:  # an edit to one of them would not be noticed
            names = sorted(one.co_qualname for one in unseen)
            raise RuntimeError(f"the key of {self.file.stem} does not cover {names}")
        return code.symbol, code.objects

    def address(self) -> int:
        """Where the machine code starts."""
        if PYTHON:
            from trsim.kernels.plain import address

            return address(self.python)
        return self.entry

    @cached_property
    def _plan(self) -> tuple[Any, Any, list[tuple[int, str]]]:
        """The function, the type of its result, and how each argument is passed: dimensions, and
        letters of its entries.  Asking the signature again took a third of a short call."""
        returns, wanted = self.signature
        flat = [part for kind in wanted for part in _parts(kind)]
        prototype = ctypes.CFUNCTYPE(ctypes.c_int32, ctypes.c_void_p, ctypes.c_void_p, *flat)
        passed = [
            (RECORD if kind.fields else kind.dimensions, LETTERS.get(kind.dtype, ""))
            for kind in wanted
        ]
        returned = ctypes.c_int64 if _is_int(returns) else ctypes.c_double
        return prototype(self.entry), returned, passed

    def __call__(self, *arguments: Any) -> Any:
        if len(arguments) != len(self.signature.arguments):
            raise TypeError(f"{self.__name__} takes {len(self.signature.arguments)} arguments")
        if PYTHON:
            value, returns = super().__call__(*arguments), self.signature.returns
            return None if value is None else int(value) if _is_int(returns) else float(value)
        call, returned, passed = self._plan
        flat: list[Any] = []
        for value, (dimensions, letters) in zip(arguments, passed, strict=True):
            if dimensions == RECORD:
                flat.append(value.address)
            elif dimensions == NUMBER:
                flat.append(value)
            elif dimensions == 1 and value.dtype.char in letters and value.ndim == 1:
                size, each = len(value), value.itemsize
                flat += (0, 0, size, each, _data(value), size, each)
            else:
                flat += _array(value, dimensions, letters)
        result = returned()
        status = call(byref(result), UNREAD, *flat)
        if status in ERRORS or status > 0:
            raise RuntimeError(f"{self.__name__} failed with status {status}")
        return None if self.signature.returns is None else result.value


class Caller:
    """call(address, *arguments) for compiled functions of one signature, in compiled code."""

    def __init__(self, signature: Signature) -> None:
        self.signature = signature

    def __call__(self, address: int, *arguments: Any) -> Any:
        from trsim.kernels.plain import BY_ADDRESS

        return BY_ADDRESS[address](*arguments)

    @cached_property
    def _numba_type_(self) -> Any:
        from trsim.kernels.compiler import caller, type_of

        self._intrinsic = caller(self.signature)
        return type_of(self._intrinsic)


# --- arguments -------------------------------------------------------------------------------


def _is_int(kind: Kind | None) -> bool:
    return kind is not None and kind.dtype == "int64"


def _parts(kind: Kind) -> list[Any]:
    """C types of an argument.  ctypes passes a word as a pointer in half the time of an integer."""
    if kind.dimensions:
        return [c_void_p] * (5 + 2 * kind.dimensions)
    if kind.fields:
        return [c_void_p]
    return [ctypes.c_double if kind.dtype == "float64" else ctypes.c_int64]


def _data(value: Any) -> int:
    """The address of the first entry of an array."""
    try:
        return addressof(at(value))  # refused unless it is contiguous and may be written to
    except TypeError:
        if not value.flags.c_contiguous:
            raise TypeError("an array must be contiguous") from None
        return address(value)


def _array(value: Any, dimensions: int, letters: str) -> tuple[int, ...]:
    """The parts of an array.  What an array is asked for costs more than most calls take."""
    kind, shape = value.dtype, value.shape
    if len(shape) != dimensions or kind.char not in letters:
        raise TypeError(f"wanted {dimensions} of {letters}, got {len(shape)} dimensions of {kind}")
    data, each = _data(value), kind.itemsize
    if dimensions == 2:
        rows, columns = shape
        return 0, 0, rows * columns, each, data, rows, columns, each * columns, each
    return (0, 0, value.size, each, data, *shape, *value.strides)


# --- files -----------------------------------------------------------------------------------


def _read(path: Path) -> tuple[str, bytes] | None:
    """Symbol and object file; None where there is none, a damaged one or not one of the user's."""
    try:
        return carried.opened(kept.content(path))
    except OSError:
        return None


# --- LLVM's loader ---------------------------------------------------------------------------


@cache
def _engine() -> Any:
    """The loader: an execution engine with nothing in it."""
    import llvmlite.binding as llvm

    llvm.initialize_native_target()
    llvm.initialize_native_asmprinter()
    machine = llvm.Target.from_default_triple().create_target_machine(jit=True)
    return llvm.create_mcjit_compiler(llvm.parse_assembly(""), machine)


def _loaded(symbol: str, objects: bytes) -> int:
    """Put an object file into memory; the address of a function of it."""
    import llvmlite.binding as llvm

    engine = _engine()
    engine.add_object_file(llvm.ObjectFileRef.from_data(objects))
    engine.finalize_object()
    address = engine.get_function_address(symbol)
    if not address:
        raise FileError(f"no '{symbol}' in the machine code that was kept")
    return int(address)
