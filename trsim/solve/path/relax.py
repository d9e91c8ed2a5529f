"""Where what moves, or does not balance, comes to rest: a flow downhill to a balance.

    M q' = F - J^T lam,    Phi = 0          by implicit Euler steps that grow     [Kelley1998]

Newton's method alone would go to any balance, one on the top as well; the flow leaves that one.
"""

from typing import Any

import numpy as np
from numpy.typing import NDArray

from trsim.assemble.equations import poses
from trsim.elements.contract import IMPACT_SPEED, PHASE, UNLOCATED
from trsim.solve.diagnose.linearised import mass_matrix
from trsim.solve.path.place import Equations
from trsim.solve.start.passages import Passages

Array = NDArray[np.float64]

STEPS = 400
FAR = 0.1  # rad, or of the mechanism's size: a step of the flow goes no further
NEAR = 1e-7  # the same: Newton's method finds it from here
GROW, SHRINK = 3.0, 0.25  # of the step in time


def relaxed(eq: Equations, t: float, y: Array) -> Array:
    """A place next to a balance, from y; wherever it came to after STEPS of the flow.

    Contacts press wherever they are in.
    """
    w, n = eq.work, eq.n
    w.mem[w.contact, PHASE], w.mem[w.contact, IMPACT_SPEED] = UNLOCATED, 1.0
    lam, dt = eq.multipliers(t, y), 0.0
    passages = Passages(eq.mechanism, w)
    for _ in range(STEPS):
        g = eq.left(t, y, lam)
        A = eq.matrix(t, y, lam)
        poses(w, y)
        M = mass_matrix(w)
        if dt == 0.0:
            pull = np.linalg.lstsq(M, g[:n], rcond=None)[0]
            dt = FAR / max(float(np.abs(pull / eq.unit).max(initial=0.0)), 1e-300)
        x = step_of(eq, A, M / dt, g)
        far = float(np.abs(x[:n] / eq.unit).max(initial=0.0))
        if not np.isfinite(far):
            return y
        if far > FAR:
            dt *= SHRINK
            continue
        part = free_part(eq, passages, y, x[:n])
        y, lam = eq.moved(y, part * x[:n]), lam + part * x[n:]
        if part < 1.0:
            dt *= part
            continue
        if far < NEAR and dt > 1e3:
            break
        dt *= GROW if far < 0.5 * FAR else 1.0
    return y


def free_part(eq: Equations, passages: Passages, y: Array, dx: Array) -> float:
    """The part of a step dx, in the axes of the solve, in which nothing is passed through."""
    return passages.free(lambda part: eq.moved(y, part * dx), lambda: dx)


def step_of(eq: Equations, A: Array, drag: Array, g: Array) -> Array:
    """One step of the flow, with multipliers."""
    n, B, right = eq.n, A.copy(), g.copy()
    B[:n, :n] += drag
    right[n:] *= -1.0
    inverse = eq.inverse(B)
    found: Any = np.full_like(right, np.nan) if inverse is None else inverse @ right
    return np.asarray(found)
