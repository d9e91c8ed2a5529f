"""Where a path turns back: the place at which t is largest, on the path by its length.

    [ K    G    -g_t  ] [ dq   ]   [ g    ]
    [ J    0    Phi_t ] [ dlam ] = [ -Phi ]       n along the path
    [ n_q  0    n_t   ] [ dt   ]   [ 0    ]

Near such a place t is no measure of the path, and its length is one.  t' by the length is zero
there; the place is found by halving between one before it and one behind.
"""

from dataclasses import replace
from typing import Any

import numpy as np
from numpy.typing import NDArray

from trsim.solve.path.place import Equations, Place

Array = NDArray[np.float64]

STEPS = 60
NEAR = 1e-4  # of the size: how far one step goes
ITERATIONS = 12
CLOSE = 1e-12


def fold(eq: Equations, place: Place, end: float) -> Place | None:
    """The place ahead where a path turns back; None where it is not found."""
    with eq.frozen():
        return turning(eq, place, end)


def turning(eq: Equations, place: Place, end: float) -> Place | None:
    found = tangent(eq, place, None, end)
    if found is None or found[-1] < 0.0:
        return None
    here, way, step = place, found, NEAR
    for _ in range(STEPS):
        ahead = along(eq, here, way, step, end)
        led = tangent(eq, ahead, way, end) if ahead is not None else None
        if ahead is None or led is None:
            step *= 0.5
            if step < 1e-9:
                return None
            continue
        if led[-1] <= 0.0:
            return between(eq, (here, way), step, end)
        here, way = ahead, led
    return None


def between(eq: Equations, start: tuple[Place, Array], step: float, end: float) -> Place:
    """The place at which t is largest, by halving."""
    here, way = start
    low, high, found = 0.0, step, here
    for _ in range(STEPS):
        middle = 0.5 * (low + high)
        ahead = along(eq, here, way, middle, end)
        led = tangent(eq, ahead, way, end) if ahead is not None else None
        if ahead is None or led is None:
            break
        if led[-1] > 0.0:
            low = middle
        else:
            high = middle
        found = ahead
    return found


def bordered(eq: Equations, place: Any, way: Array, end: float) -> Array:
    """The matrix above, in units of the size and of the path's time."""
    n, m = eq.n, eq.m
    B = np.zeros((n + m + 1, n + m + 1))
    B[:-1, :-1] = place.A
    B[:-1, -1] = -eq.forcing(place.t, place.y, place.lam) * end
    B[-1, :n], B[-1, -1] = way[:n] / eq.unit**2, way[-1]
    return B


def tangent(eq: Equations, place: Place, before: Array | None, end: float) -> Array | None:
    """(dq, dlam, dt / end) along the path, as long as one; None where there is none."""
    n = eq.n
    guess = before
    if guess is None:
        guess = np.zeros(n + eq.m + 1)
        guess[:n], guess[n:-1], guess[-1] = place.v * end, place.lam_rate * end, 1.0
        guess /= length(eq, guess)
    b = np.zeros(n + eq.m + 1)
    b[-1] = 1.0
    try:
        x: Array = np.asarray(np.linalg.solve(bordered(eq, place, guess, end), b))
    except np.linalg.LinAlgError:
        return None
    size = length(eq, x)
    return np.asarray(x / size) if np.isfinite(size) and size > 0.0 else None


def length(eq: Equations, x: Array) -> float:
    n = eq.n
    return float(np.sqrt(np.sum((x[:n] / eq.unit) ** 2) + x[-1] ** 2))


def along(eq: Equations, here: Place, way: Array, step: float, end: float) -> Place | None:
    """The place so far along the path."""
    n = eq.n
    t = here.t + step * way[-1] * end
    y = eq.at_time(eq.moved(here.y, step * way[:n]), here.t, t)
    lam = here.lam + step * way[n:-1]
    last = np.inf
    for _ in range(ITERATIONS):
        now = replace(here, t=t, y=y, lam=lam, A=eq.matrix(t, y, lam))
        g = eq.left(t, y, lam)
        g[n:] *= -1.0
        try:
            x = np.linalg.solve(bordered(eq, now, way, end), np.append(g, 0.0))
        except np.linalg.LinAlgError:
            return None
        far = length(eq, x)
        if not np.isfinite(far) or far > 10.0 * step + CLOSE:
            return None
        new = t + x[-1] * end
        y, lam, t = eq.at_time(eq.moved(y, x[:n]), t, new), lam + x[n:-1], new
        if far < CLOSE or (last < 1e-9 and far > 0.5 * last):
            A = eq.matrix(t, y, lam)
            inverse = eq.inverse(A)
            return replace(now, t=t, y=y, lam=lam, A=A,
                           inverse=here.inverse if inverse is None else inverse)  # fmt: skip
        last = far
    return None
