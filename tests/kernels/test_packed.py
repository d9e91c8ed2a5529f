"""Records whose numbers change: entries of their arrays, by name, in Python and compiled."""

import numpy as np
import pytest

from trsim.elements.contract import compiled
from trsim.kernels.packed import A1, A2, C1, C2, F8, I1, I8, Packed, f8
from trsim.kernels.signatures import float64, void


class Clock(Packed):
    clock: A1
    count: I1
    y: A1
    t: F8
    steps: I8
    h: F8
    end: f8


class Alarm(Clock):
    """More of them behind those of another record."""

    at: F8
    rings: I8


class Waves(Packed):
    """Complex numbers."""

    A: C2
    x: C1


class Table(Clock):
    """With an array of zeros."""

    cells: A2


@compiled(void(Table.kind))
def filled(r):
    r.cells[1, 2] = 7.0


@compiled(void(Waves.kind, C1))
def turned(w, out):
    for i in range(w.x.size):
        out[i] = complex(w.A[i, 0].imag, 0.0)
        for k in range(w.x.size):
            out[i] += w.A[i, k] * w.x[k]


@compiled(float64(Clock.kind, f8))
def moved_on(r, h):
    """Reads, writes, adds to, and reads again what was written."""
    r.h = h
    before = r.t
    for _ in range(3):
        r.t += r.h
        r.steps += 1
    r.steps = 10 * r.steps + (1 if r.t > before else 0)
    r.y[0] = r.t
    return r.t - before


@compiled(void(Alarm.kind))
def rung(r):
    r.rings += 1
    r.at = r.t


def fresh(kind=Clock, **values):
    return kind(y=np.zeros(1), end=1.0, **values)


def test_in_python():
    r = fresh()
    assert (r.t, r.h, r.steps) == (0.0, 0.0, 0)
    r.t, r.steps = 2.0, 3
    r.t += 0.5
    assert r.clock.tolist() == [2.5, 0.0]
    assert r.count.tolist() == [3]
    r.clock[1] = 7.0
    assert (r.t, r.h, r.steps) == (2.5, 7.0, 3)
    assert isinstance(r.t, np.float64)
    assert isinstance(r.steps, np.int64)


def test_compiled():
    r = fresh()
    r.t = 1.0
    assert moved_on(r, 0.25) == 0.75
    assert (r.t, r.h, r.steps, r.y[0]) == (1.75, 0.25, 31, 1.75)


def test_their_arrays_are_all_of_it():
    r = fresh()
    moved_on(r, 0.25)
    kept = {name: array.copy() for name, array in r.arrays().items()}
    again = fresh(**{k: v for k, v in kept.items() if k != "y"})
    assert set(kept) == {"clock", "count", "y"}
    assert (again.t, again.h, again.steps) == (0.75, 0.25, 31)


def test_those_of_a_record_made_of_another():
    r, other = fresh(Alarm), fresh()
    moved_on(r, 0.5)
    rung(r)
    assert (r.t, r.h, r.steps, r.at, r.rings) == (1.5, 0.5, 31, 1.5, 1)
    assert r.clock.tolist() == [1.5, 0.5, 1.5]
    assert not hasattr(other, "rings")
    with pytest.raises(TypeError, match="clock: 2 numbers instead of 3"):
        fresh(Alarm, clock=other.clock)


def test_arrays_of_zeros_are_those_that_compiled_code_has():
    """Seen before it writes or only after that, in the record itself or in one made of it."""
    r = Table(None, {"cells": (2, 3)}, y=np.zeros(1), end=1.0)
    before, other = Table(r), Table(r, end=2.0)
    assert before.cells.tolist() == [[0.0] * 3] * 2
    filled(r)
    assert r.cells[1, 2] == before.cells[1, 2] == other.cells[1, 2] == 7.0
    assert r.cells is r.cells and other.arrays().keys() == {"clock", "count", "y", "cells"}
    alone = Table(r, {"cells": (3, 3)})
    assert alone.cells.shape == (3, 3) and not alone.cells.any()
    assert not hasattr(r, "columns")


@pytest.mark.parametrize("shape", [(6,), (2, 3, 1)])
def test_arrays_of_zeros_have_their_dimensions(shape):
    with pytest.raises(TypeError, match=f"cells: {len(shape)} dimensions instead of 2"):
        Table(None, {"cells": shape}, y=np.zeros(1), end=1.0)


def test_complex_arrays():
    rng = np.random.default_rng(1)
    A, x = rng.normal(size=(3, 3, 2)).view(complex)[..., 0], rng.normal(size=6).view(complex)
    out = np.empty(3, complex)
    turned(Waves(A=A, x=x), out)
    assert out == pytest.approx(A[:, 0].imag + A @ x, rel=1e-14)


@pytest.mark.parametrize(
    "wrong", [lambda r: r.minutes, lambda r: setattr(r, "end", 2.0)], ids=["unknown", "constant"]
)
def test_what_compiled_code_refuses(wrong):
    with pytest.raises(Exception):  # noqa: B017 - numba's own
        compiled(float64(Clock.kind))(wrong).address()
