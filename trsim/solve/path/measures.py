"""What is measured at a place in balance: channels, works on a way, what inertia would add."""

from trsim.assemble.outputs import measure
from trsim.elements.contract import DRIVES, FRICTION, LOADS, SCENE, compiled
from trsim.kernels.lazy import internal
from trsim.kernels.packed import A1, A2, I1, f8
from trsim.kernels.signatures import float64, void
from trsim.kernels.vectors import copy_to
from trsim.solve.path.balance import BALANCE, SLOW, evaluate, unbalanced


@compiled(void(SCENE, f8, A1, A1, A1))
def measured_with(s, t, y, lam, a):
    """All channels at a state with its multipliers, those of redundant rows too, and its
    accelerations along the velocities of the solve; no kinetic energy."""
    unbalanced(s, t, y, lam, s.aside[0])
    for k in range(s.lam.size):
        s.lam[k] = lam[k]
    for f in range(1, s.n_r):
        o = s.d * (f - 1)
        if s.d == 3:
            s.A[f, 0], s.A[f, 1], s.A[f, 5] = a[o], a[o + 1], a[o + 2]
            continue
        X = s.X
        for c in range(3):
            r = 3 + 3 * c
            s.A[f, c] = a[o + c]
            s.A[f, 3 + c] = X[f, r] * a[o + 3] + X[f, r + 1] * a[o + 4] + X[f, r + 2] * a[o + 5]
    measure(s, t, y, 0.0, 0.0)


@compiled(float64(SCENE, BALANCE, f8, A1, A2, A1))
def works(s, b, t, way, A, book):
    """What drives do on a way through the state of b by their rows, with the forces there, J; of
    the book their power, and the works of loads and friction."""
    n, total = s.n_v, 0.0
    copy_to(b.room[0], b.y)
    for k in range(n):
        b.room[0, s.n_q + k] = SLOW * way[k]
    evaluate(s, b, t, b.room[0], b.lam, b.g)
    book[DRIVES], book[LOADS], book[FRICTION] = (
        s.zd[DRIVES],
        s.zd[LOADS] / SLOW,
        s.zd[FRICTION] / SLOW,
    )
    for i in range(s.m):
        for k in range(n):
            total -= b.lam[i] * A[n + i, k] * way[k]
    return total


@internal
def own(s, f, body):
    """body (10) <- mass and inertia of the body of a frame, without what it is solved with because
    it has none."""
    body[0] = s.mass[f]
    for c in range(9):
        body[1 + c] = s.inertia[f, c]
    for k in range(s.light.size):
        if s.light[k] == f:
            for c in range(10):
                body[c] -= s.lacking[k, c]


@internal
def inertia_forces(s, b, y, a, out):
    """M a and what turning bodies resist with, along the velocities of the solve."""
    I = b.body
    for f in range(1, s.n_r):
        o, v = s.d * (f - 1), s.n_q + s.d * (f - 1)
        own(s, f, I)
        if s.d == 3:
            out[o], out[o + 1], out[o + 2] = I[0] * a[o], I[0] * a[o + 1], I[9] * a[o + 2]
            continue
        w0, w1, w2 = y[v + 3], y[v + 4], y[v + 5]
        h0 = I[1] * w0 + I[2] * w1 + I[3] * w2
        h1 = I[4] * w0 + I[5] * w1 + I[6] * w2
        h2 = I[7] * w0 + I[8] * w1 + I[9] * w2
        for c in range(3):
            k = 1 + 3 * c
            out[o + c] = I[0] * a[o + c]
            out[o + 3 + c] = I[k] * a[o + 3] + I[k + 1] * a[o + 4] + I[k + 2] * a[o + 5]
        out[o + 3] += w1 * h2 - w2 * h1
        out[o + 4] += w2 * h0 - w0 * h2
        out[o + 5] += w0 * h1 - w1 * h0


@compiled(void(SCENE, BALANCE, f8, I1, A2))
def added(s, b, t, rows, found):
    """found (n, 2) <- what inertia, and what dampers, would add to the multipliers of rows.

    b: state, multipliers and inverse of a place, its velocities x and its accelerations g.
    """
    n, y, force, moving = s.n_v, b.room[0], b.room[1], b.room[2]
    copy_to(y, b.y)
    for k in range(n):
        y[s.n_q + k] += b.x[k]  # what rests there rubs as on its way to the place
    inertia_forces(s, b, y, b.g, force)
    evaluate(s, b, t, y, b.lam, moving)
    evaluate(s, b, t, b.y, b.lam, b.room[3])
    for i in range(rows.size):
        row = n + rows[i]
        found[i, 0] = found[i, 1] = 0.0
        for k in range(n):
            found[i, 0] -= b.inverse[row, k] * force[k]
            found[i, 1] += b.inverse[row, k] * (moving[k] - b.room[3, k])
