"""Pieces of compiled code as plain Python: in milliseconds, with others for what they call."""

from collections.abc import Callable
from functools import partial
from types import FunctionType
from typing import Any

from trsim.kernels.plain import run


def piece(function: Any, **others: Any) -> Callable:
    """A compiled function, or a part of one, as plain Python; `others` take the place of functions
    and constants that it reads by these names."""
    python = function.python
    unknown = set(others) - set(python.__globals__)
    assert not unknown, f"{python.__module__} has no {unknown}"
    scope = python.__globals__ | others
    return partial(run, FunctionType(python.__code__, scope, python.__name__, python.__defaults__))


def nothing(*_: Any) -> int:
    """In the place of a function that is not to do anything."""
    return 0
