"""Compiled functions as plain Python: a debugger steps through them, and coverage sees their lines.

What Python does otherwise than machine code is made the same.  Constants are numpy's numbers, as
entries of arrays are, and functions of `math` are numpy's: x / 0 is inf, sqrt(-1) nan.  A function
called by its address is found in a table.
"""

import math
from collections.abc import Callable
from dis import get_instructions
from functools import cache
from types import FunctionType
from typing import Any

import numpy as np

BY_ADDRESS: dict[int, Callable] = {}
LEAST = -(2**63)  # what a processor makes of what no integer can hold


def whole(x: Any) -> int:
    """int(x), of any number."""
    return int(x) if abs(x) < 2.0**63 else LEAST


BUILTINS = {"complex": np.complex128, "float": np.float64, "int": whole}
SAME = {
    math.acos: np.arccos, math.asin: np.arcsin, math.asinh: np.arcsinh, math.atan2: np.arctan2,
    math.copysign: np.copysign, math.cos: np.cos,
    math.exp: np.exp, math.isfinite: np.isfinite, math.log: np.log, math.log10: np.log10,
    math.sin: np.sin, math.sqrt: np.sqrt, math.tan: np.tan,
    math.ceil: lambda x: whole(np.ceil(x)), math.floor: lambda x: whole(np.floor(x)),
}  # fmt: skip


@cache
def plain(python: Any) -> Callable:
    """A function that calls others as they are in Python, with numbers of numpy."""
    code, scope = python.__code__, python.__globals__
    names = {step.argval for step in get_instructions(code) if step.opname == "LOAD_GLOBAL"}
    return FunctionType(
        code.replace(co_consts=same(code.co_consts)),
        BUILTINS | {name: same(scope[name]) for name in names if name in scope},
        python.__name__, same(python.__defaults__), python.__closure__,
    )  # fmt: skip


def same(value: Any) -> Any:
    """What takes the place of something that a function reads."""
    if isinstance(value, float):
        return np.float64(value)
    if isinstance(value, tuple):
        return tuple(map(same, value))
    if isinstance(function := getattr(value, "python", None), FunctionType):
        return plain(function)
    return SAME.get(value, value) if callable(value) else value


def run(python: Callable, *arguments: Any, **named: Any) -> Any:
    """Call a function from Python."""
    with np.errstate(all="ignore"):
        return plain(python)(*map(same, arguments), **named)


def address(python: Callable) -> int:
    """A number that is no other function's."""
    BY_ADDRESS[id(python)] = plain(python)
    return id(python)
