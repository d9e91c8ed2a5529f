"""Static equilibrium of a mechanism with flexible bars, reached from that with stiff ones.

    F_e(q) / s + F(q) - J^T lam = 0,    Phi(q) = 0,    s from 0, rigid bars, to 1

F_e: elastic forces of the bars, F: all others.  Without others that bend them, bars softened by s
are as bent as under loads s F: the way is that of a load put on bit by bit, and keeps the branch.
Every s is reached by Newton's method,

    [ K  J^T ] [ dq      ]   [ F_e / s + F ]        K = -d(F_e / s + F - J^T lam)/dq
    [ J  0   ] [ lam new ] = [ -Phi        ]

with the tangent of the bars as it is, and of all else by differences.  A step that leaves more
motions unstable is too long: beyond, a bar has buckled.  Where something might pass through what is
thin, steps begin at the balance before, and are cut there (passages.py).
"""

from math import prod

import numpy as np
from numpy.typing import NDArray

from trsim.assemble.equations import constraints, poses
from trsim.assemble.mechanism import Mechanism
from trsim.assemble.projection import move_all
from trsim.assemble.reduce import (
    along_rates_of,
    displaced,
    in_solve_axes,
    jacobian,
    less_reactions,
    moves,
)
from trsim.elements.scene import Scene, workspace
from trsim.errors import ModelError
from trsim.solve.start.angles import remember
from trsim.solve.start.elastic import acted_on, elastic_stiffness, softened_bars, without_bars
from trsim.solve.start.passages import Passages
from trsim.solve.start.statics import (
    check_stable,
    free_motions,
    free_part,
    probe,
    static_forces,
    wrenches_at_rest,
)

Array = NDArray[np.float64]

FIRST = 1e-3  # softening: bars that are next to rigid
TURN = 0.5  # rad, or of a slope: as far as a correction may turn anything
ITERATIONS = 15
CLOSE = 1e-9  # of the mechanism's size, and rad: quadratic from here, the next step is rounding
HELD = 1e-14  # of the largest stiffness, added: what nothing holds and nothing pushes stays
NEGLIGIBLE = 1e-12  # of the largest eigenvalue
ORDER = 3  # of the polynomial that tells where a step begins
SHORTEST = 1e-7  # of the way from rigid to soft


def softened(mechanism: Mechanism, y: Array) -> tuple[Array, float]:
    """The equilibrium reached from y, straight bars, drives held at t = 0; and the force left, N.

    Raises ModelError where there is none, or where nothing holds a motion.
    """
    work = workspace(mechanism.model)
    passages = Passages(mechanism, work)
    lam: Array = np.zeros(work.m)
    done, ahead, allowed, failed = 0.0, FIRST, work.n_v, False
    way = [(done, y)]
    while done < 1.0:
        to = min(1.0, done + ahead)
        guess = y if passages.ways else drawn_on(way, to)
        found = balanced(Parts(mechanism, work, to, passages), guess, lam, allowed)
        if isinstance(found, float):
            ahead, failed = found * (to - done), True
            if ahead < SHORTEST:
                raise ModelError(
                    "no static equilibrium found: beyond "
                    f"{100 * done:.3g} % of the loads the flexible bars have none near by",
                    "do they buckle? a small load to one side shows them where to; are they very "
                    "slender (EA L^2/EI above 1e9)? more elements; or drop "
                    "`equilibrium` to start as drawn",
                    ("initial", "equilibrium"),
                )
            continue
        y, lam, allowed, turns = found
        way = [*way[-ORDER:], (to, y)] if done else [(to, y)]
        ahead = (to - done) * growth(turns, failed) if done else 1.0
        done, failed = to, False
        remember(work, y)
    return y, checked(mechanism, work, y, lam)


def drawn_on(way: list[tuple[float, Array]], s: float) -> Array:
    """The value at s of the polynomial through the last equilibria."""
    found = np.zeros_like(way[0][1])
    for a, y in way:
        found += y * prod((s - b) / (a - b) for b, _ in way if b != a)
    return found


def growth(turns: int, failed: bool) -> float:
    """How much longer the step is after one that took so many turns of Newton's method.

    Where it is nearly too long, twice as long would be tried in vain each time.
    """
    allowed = {6: 1.5, 7: 1.2, 8: 1.0}.get(turns, 2.0 if turns < 6 else 0.7)
    return min(allowed, 1.0) if failed else allowed


class Parts:
    """The mechanism with bars softened by s, and what of it is differentiated how."""

    def __init__(
        self, mechanism: Mechanism, work: Scene, s: float, passages: Passages | None = None
    ) -> None:
        self.passages = passages or Passages(mechanism, work)
        self.work = softened_bars(mechanism, work, s)
        self.others = without_bars(self.work)
        self.acted = acted_on(mechanism, at_rest=True)


def balanced(
    parts: Parts, y: Array, lam: Array, allowed: int
) -> tuple[Array, Array, int, int] | float:
    """y and lam in equilibrium, how many motions are unstable there, at most `allowed`, and the
    turns it took; or which part of the way to try instead."""
    from scipy.sparse import csc_array
    from scipy.sparse.linalg import splu

    work = parts.work
    free = moves(work, work.d == 3)
    last = np.inf
    for turn in range(ITERATIONS):
        phi, _, J = jacobian(work, 0.0, y)
        J = J[:, free]
        K = tangent(parts, y, lam)[np.ix_(free, free)]
        K[np.diag_indices_from(K)] += HELD * np.abs(K).max()
        system = np.block([[K, J.T], [J, np.zeros((work.m, work.m))]])
        try:
            factors = splu(csc_array(system))
        except RuntimeError:  # singular
            return 0.5
        x = factors.solve(np.append(static_forces(work, y)[free], -phi))
        dq = np.zeros(free.size)
        dq[free] = x[: -work.m or None]
        each = np.abs(dq).reshape(-1, 6)
        far = max(float(each[:, :3].max()) / work.size, float(each[:, 3:].max()))
        if not far < TURN:  # not a number, too
            return max(0.1, 0.7 * TURN / far) if turn == 0 and np.isfinite(far) else 0.5
        part = free_part(parts.passages, y, dq)
        y, lam = displaced(work, y, part * dq), x[len(x) - work.m :]
        if part < 1.0:
            last = np.inf
            continue
        if far < CLOSE:
            count = unstable(K, J)
            return (y, lam, count, turn + 1) if count <= allowed else 0.5
        if turn > 4 and far > last:
            return 0.5
        last = far
    return 0.5


def unstable(K: Array, J: Array) -> int:
    """How many of the motions that J allows have a negative stiffness: Sylvester's law."""
    if len(J):
        J = J * (np.abs(K).max() / np.abs(J).max(initial=1e-300))  # of the size of K, or it is lost
    bordered = np.block([[0.5 * (K + K.T), J.T], [J, np.zeros((len(J), len(J)))]])
    values = np.linalg.eigvalsh(bordered)
    return int(np.sum(values < -NEGLIGIBLE * np.abs(values).max())) - len(J)


def checked(mechanism: Mechanism, work: Scene, y: Array, lam: Array) -> float:
    """The force left, N; refuses an equilibrium that is indifferent."""
    free = moves(work, work.d == 3)
    J, F = jacobian(work, 0.0, y)[2], static_forces(work, y)
    Z = free_motions(J, free, np.ones(free.size))
    K = Z.T @ tangent(Parts(mechanism, work, 1.0), y, lam) @ Z
    values, vectors = np.linalg.eigh(0.5 * (K + K.T))
    load = max(float(np.max(np.abs(F))), float(np.max(np.abs(lam), initial=0.0)))
    check_stable(mechanism, values, Z @ vectors, load, work)
    return float(np.linalg.norm((F - J.T @ lam)[free]))


def tangent(parts: Parts, y: Array, lam: Array) -> Array:
    """-d(F_e + F - J^T lam)/dq against the world-axes rates (6 (n-1), 6 (n-1))."""
    K, size = elastic_stiffness(parts.work, y), probe(parts.work)
    others = parts.others
    poses(others, y)
    changes = size * np.eye(6 * (others.n - 1))[parts.acted]
    steps = [in_solve_axes(others, change) for change in changes]
    ends = unbalanced(others, y, [sign * step for step in steps for sign in (1.0, -1.0)], lam)
    K[:, parts.acted] -= ((ends[::2] - ends[1::2]) / (2.0 * size)).T
    return K


def unbalanced(work: Scene, y: Array, steps: list[Array], lam: Array) -> Array:
    """F - J^T lam at rest along the world-axes rates, a step away from y, for each (k, 6 (n-1))."""
    told = work.F, work.J, work.G, work.Q
    all_told = [np.empty((len(steps), *one.shape)) for one in told]
    for k, step in enumerate(steps):
        near = y.copy()
        move_all(work, near, step)
        wrenches_at_rest(work, near)
        constraints(work, 0.0)
        for found, one in zip(all_told, told, strict=True):
            found[k] = one
    F, J, G, Q = all_told
    less_reactions(work, F, lam, J)
    return along_rates_of(work, F, G, Q)
