"""`approx` of long channels: pytest's compares one number after the other, in Python."""

from typing import Any

import numpy as np
import pytest


class Within:
    """Equal to arrays of which every number is as near as pytest.approx asks."""

    __array_ufunc__ = None  # arrays leave == to it
    __hash__ = None  # type: ignore[assignment]

    def __init__(self, wanted: Any, rel: float | None, abs: float | None) -> None:
        self.plain = pytest.approx(wanted, rel=rel, abs=abs)
        self.wanted = np.asarray(wanted)
        part = (1e-6 if abs is None else 0.0) if rel is None else rel
        self.allowed = np.maximum(part * np.abs(self.wanted), 1e-12 if abs is None else abs)

    def __eq__(self, found: object) -> bool:
        given = np.asarray(found)
        if self.wanted.ndim and given.shape != self.wanted.shape:
            return False
        # what is no number is nowhere near
        return bool(np.all(np.abs(given - self.wanted) <= self.allowed))

    def __repr__(self) -> str:
        return repr(self.plain)


def approx(wanted: Any, rel: float | None = None, abs: float | None = None) -> Within:
    """As pytest.approx of arrays, or of one number for all."""
    return Within(wanted, rel, abs)
