"""Mechanisms that can move to first order only: two bars stretched on one line.

With J the rows of the joints, N a basis of the motions they allow (J N = 0) and w the self-stresses
(w^T J = 0), a motion v = N x goes on to second order where some acceleration a has
J a + v^T H v = 0, H the second derivatives of the rows; that is where

    w . (v^T H v) = x^T B_w x = 0        for every self-stress w        [ConnellyWhiteley1996]

On every true motion the first derivative that does not vanish obeys this.  If some B_w is definite
there is none: the mechanism is rigid, whatever its rank says.  If it is definite but for the k
directions in which every B_w vanishes (a bar that turns about itself), at most k freedoms are left.
Where no B_w is found that is definite nothing is proved: dead centres, flat parallelograms and
linkages that are movable by their symmetry have forms without a sign, or none.  Rows of drives
have no part in this: they are moved on purpose, not held.
"""

from collections.abc import Sequence
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from trsim.assemble.equations import constraints, poses
from trsim.assemble.instances import RowName
from trsim.assemble.rank import DEPENDENT
from trsim.assemble.reduce import in_solve_axes, jacobian, moves, weights
from trsim.elements.scene import Model, Scene, scene

Array = NDArray[np.float64]

PLAINLY = 1e-3  # curvature, times the mechanism's size: less is that of a drawing with few digits
DEFINITE = 1e-4  # smallest eigenvalue of a form, of its norm
MOST = 40  # motions that are looked at: their forms need half its square of evaluations
TURNS = 500  # trials at a definite form
SPANS = 1e-9  # singular values of forms, of the largest: less is rounding
TAKES_PART = 0.1  # of the largest force of a self-stress


class Shaky(NamedTuple):
    """Joints that are proved to allow fewer motions than their rank says."""

    rows: list[int]  # that hold them
    first_order: int  # motions by rank
    at_most: int  # motions there are


def shaky(
    full: Model, y: Array, rows: Sequence[RowName], geometric: list[int], dropped: set[int],
    planar: bool,
) -> Shaky | None:  # fmt: skip
    """The first group of joined bodies that is proved not to move as its rows would let it.

    geometric: rows of joints, in the plane of a planar scene; dropped: those that are not solved.
    """
    J = jacobian(full, 0.0, y)[2]
    moving = moves(full, planar)
    for frames, own in groups(rows, geometric):
        if max(frames) >= full.n_r:  # a flexible bar gives way
            continue
        columns = np.zeros((full.n - 1, 6), bool)
        columns[np.array(frames) - 1] = True
        at = np.flatnonzero(columns.ravel() & moving)
        solved = len(at) - len(own) + len(dropped & set(own))
        found = stopped(full, y, J, own, at, solved)
        if found is not None:
            return found
    return None


def groups(rows: Sequence[RowName], geometric: list[int]) -> list[tuple[list[int], list[int]]]:
    """Moving frames that rows join, and these rows."""
    group: dict[int, int] = {}

    def top(frame: int) -> int:
        while group.setdefault(frame, frame) != frame:
            frame = group[frame]
        return frame

    for k in geometric:
        ends = [frame for frame in rows[k].frames if frame > 0]
        for frame in ends[1:]:
            group[top(frame)] = top(ends[0])
    found: dict[int, tuple[set[int], list[int]]] = {}
    for k in geometric:
        ends = [frame for frame in rows[k].frames if frame > 0]
        if ends:
            frames, own = found.setdefault(top(ends[0]), (set(), []))
            frames.update(ends)
            own.append(k)
    return [(sorted(frames), own) for frames, own in found.values()]


def stopped(
    full: Model, y: Array, J: Array, own: list[int], at: NDArray[np.int64], solved: int
) -> Shaky | None:
    """What the rows `own` stop of the motions along the rates `at`; solved: motions of the run."""
    scale = weights(full)[at]
    R = J[own][:, at] * scale
    length = np.linalg.norm(R, axis=1)
    length[length == 0.0] = 1.0
    u, s, vt = np.linalg.svd(R / length[:, None], full_matrices=True)
    rank = int(np.sum(s > DEPENDENT * max(1.0, s.max(initial=0.0))))
    stresses, motions = u[:, rank:], vt[rank:].T
    number = motions.shape[1]
    if not 0 < number <= MOST or not stresses.shape[1]:
        return None
    V = np.zeros((6 * (full.n - 1), number))
    V[at] = scale[:, None] * motions
    H = curvatures(scene(full), y, V, own) * (full.size / length[:, None, None])
    forms = np.einsum("rw,rij->wij", stresses, H)
    _, bent, ways = np.linalg.svd(forms.reshape(-1, number), full_matrices=True)
    bends = int(np.sum(bent > PLAINLY))
    inside = ways[:bends].T
    combination = definite(np.einsum("ia,wij,jb->wab", inside, forms, inside))
    at_most = number - bends
    if combination is None or solved <= at_most > 0:
        return None
    force = np.abs(stresses @ combination)
    part = [own[k] for k in np.flatnonzero(force > TAKES_PART * force.max())]
    return Shaky(part, number, at_most)


def curvatures(work: Scene, y: Array, V: Array, rows: list[int]) -> Array:
    """v_i^T H v_j of the rows for the columns of V, world-axes rates: (rows, n, n).

    The kernels have v^T H v as -gamma, the terms of the second derivative without accelerations.
    """
    at, number = slice(work.n_q, work.n_q + work.n_v), V.shape[1]
    y = y.copy()
    poses(work, y)
    axes = np.array([in_solve_axes(work, v) for v in V.T])

    def along(v: Array) -> Array:
        y[at] = v
        poses(work, y)
        constraints(work, 0.0)
        return -work.gamma[rows]

    found = np.zeros((len(rows), number, number))
    for i in range(number):
        found[:, i, i] = along(axes[i])
    for i in range(number):
        for j in range(i):
            both = along(axes[i] + axes[j]) - found[:, i, i] - found[:, j, j]
            found[:, i, j] = found[:, j, i] = 0.5 * both
    return found


def definite(forms: Array) -> Array | None:
    """The combination c of forms (w, n, n) for which sum c_w B_w is positive definite, if found.

    A perceptron: a direction in which the form is not positive is added to it.  Where there is a
    definite combination, it is found; that there is none is seldom proved.
    """
    if not forms.size or none_is(forms):
        return None
    sizes = np.maximum(np.linalg.norm(forms, axis=(1, 2)), 1e-300)
    c = np.trace(forms, axis1=1, axis2=2) / sizes
    if not np.any(c):
        return None
    for _ in range(TURNS):
        c = c / np.linalg.norm(c)
        total = np.tensordot(c, forms, 1)
        values, ways = np.linalg.eigh(total)
        if values[0] > DEFINITE * np.abs(values).max():
            return np.asarray(c)
        if len(forms) == 1:
            return None
        x = ways[:, 0]
        step = np.einsum("i,wij,j->w", x, forms, x)
        if not np.any(step):
            return None
        c = c + 0.3 * step / np.linalg.norm(step)
    return None


def none_is(forms: Array) -> bool:
    """Whether it is proved that no combination is definite: X, which is I but for its part in the
    span of the forms, has tr(B X) = 0 for each of them, and X without a negative eigenvalue has
    tr(B X) > 0 for a definite B.  Of two motions, as where two branches meet, this is all proofs;
    each saves TURNS trials."""
    number = forms.shape[1]
    _, sizes, ways = np.linalg.svd(forms.reshape(len(forms), -1), full_matrices=False)
    span = ways[sizes > SPANS * sizes.max(initial=0.0)].reshape(-1, number, number)
    X = np.eye(number) - np.tensordot(np.trace(span, axis1=1, axis2=2), span, 1)
    values = np.linalg.eigvalsh(X)
    return bool(values[-1] > PLAINLY and values[0] >= -SPANS * values[-1])
