"""Functions that numba compiles the first time they are called or compiled code needs them.

Numba is imported when the first of them is: a scenario is read and checked without it.
With TRSIM_PYTHON=1 in the environment it never is: they run as they are written (plain.py).
"""

import os
from collections.abc import Callable
from functools import cached_property, partial
from typing import Any

PYTHON = os.environ.get("TRSIM_PYTHON") == "1"
# as in numpy x / 0 is inf; no reference counts: nothing compiled allocates
COMPILED = {"error_model": "numpy", "_nrt": False}
UNWRAPPED = {"no_cpython_wrapper": True, "no_cfunc_wrapper": True}  # not for Python to call


def inner(python: Callable) -> Any:
    """numba's of a function that only compiled code calls."""
    from trsim.kernels.way import way

    # isort: split
    from numba import njit

    return njit(**way.OPTIONS, **COMPILED, **UNWRAPPED)(python)


class Lazy:
    """A function that becomes numba's the first time it is called or compiled code needs it."""

    def __init__(self, python: Callable) -> None:
        self.python = python
        self.__name__, self.__doc__ = python.__name__, python.__doc__
        self.__module__ = python.__module__

    @cached_property
    def dispatcher(self) -> Any:
        """For Python to call."""
        if PYTHON:
            from trsim.kernels.plain import run

            return partial(run, self.python)
        import trsim.kernels.numba_quick  # noqa: F401 - before numba

        # isort: split
        from numba import njit

        return njit(**COMPILED)(self.python)

    @cached_property
    def inner(self) -> Any:
        """For compiled functions that call this one."""
        return inner(self.python)

    @property
    def _numba_type_(self) -> Any:
        """What compiled functions take this global for: the function itself."""
        return self.inner._numba_type_

    def __call__(self, *arguments: Any, **named: Any) -> Any:
        return self.dispatcher(*arguments, **named)


def internal(python: Callable) -> Lazy:
    """Decorator of functions that compiled code calls: laws, and parts of kernels and methods."""
    return Lazy(python)
