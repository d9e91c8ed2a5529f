"""What is left of a balance, and how it changes with places and multipliers.

    g = F - J^T lam                      forces along the axes of the solve, without inertia
    A = [ -dg/dq  -dg/dlam ]             -dg/dlam = J^T, and more where reactions make friction
        [  J       0       ]

Velocities decide directions only: those of a state are a tiny multiple of the way it has come from
a place before, too slow for any damper, and friction is a law whose ramp ends sooner still.
Derivatives are central differences, of forces against places at one velocity, then against
velocities: what is stuck gives way by the ramp.
"""

from trsim.assemble.equations import (
    call_derivative,
    constraints,
    forces,
    set_poses,
)
from trsim.assemble.projection import move_all
from trsim.elements.contract import SCENE, compiled
from trsim.kernels.calls import caller
from trsim.kernels.lazy import internal
from trsim.kernels.packed import A1, A2, F8, I1, I2, Packed, f8, i8
from trsim.kernels.signatures import void
from trsim.kernels.vectors import clear, clear_table, copy_to

BY_PLACE, BY_SPEED, BY_LOAD = range(3)  # of `steps`: of the differences
ROOM = 4  # rows of `room`
SLOW = 1e-12  # of the way: what velocities are while forces are asked for


class Balance(Packed):
    """What a balance is looked for with, and what is found."""

    y: A1  # (n_y) the state
    lam: A1  # (m) its multipliers
    anchor: A1  # (n_y) the state that directions are taken from
    unit: A1  # (n_v) m, rad: the size of places
    pressing: I1  # rows whose reactions make friction
    steps: A1  # (3) of the differences; see above
    moving: I2  # (k, 2) states that hold the place of a drive with a velocity, its function
    since: A1  # (k) s, when that began
    A: A2  # (n_v + m, n_v + m)
    inverse: A2  # the same
    order: I1  # (n_v + m) rows exchanged
    g: A1  # (n_v + m) what is left, and Phi
    x: A1  # (n_v + m) a step, or how the place moves with t
    body: A1  # (10) mass and inertia of one
    slip: A1  # (n) sliding speeds
    room: A2  # (ROOM, n_y or n_v + m)
    rates: A2  # (5, 3) of a function
    times: A1  # (5) s
    ask: i8  # addresses, see newton.py
    system: i8
    unbalanced: i8
    write_rates: i8
    rubs: i8  # 1: something rubs
    timed: i8  # 1: something is a function of t
    clock: A1  # all that follow
    small: F8  # s, of differences against t
    load: F8  # N, the largest force met
    stiffest: F8  # N*m, of the matrix made last
    sign: F8  # of its determinant
    frozen: F8  # 1: velocities of a state are as they are


BALANCE = Balance.kind


@internal
def ways(s, before, y, times, out, at):
    """out[at:] <- so many times the way to y from a place before, along the velocities."""
    for f in range(1, s.n_r):
        v = at + s.d * (f - 1)
        if s.d == 3:
            for c in range(3):
                out[v + c] = times * (y[3 * (f - 1) + c] - before[3 * (f - 1) + c])
            continue
        q = 7 * (f - 1)
        for c in range(3):
            out[v + c] = times * (y[q + c] - before[q + c])
        a0, a1, a2, a3 = before[q + 3], -before[q + 4], -before[q + 5], -before[q + 6]
        b0, b1, b2, b3 = y[q + 3], y[q + 4], y[q + 5], y[q + 6]
        w = 2.0 * times if a0 * b0 - a1 * b1 - a2 * b2 - a3 * b3 >= 0.0 else -2.0 * times
        out[v + 3] = w * (a0 * b1 + a1 * b0 + a2 * b3 - a3 * b2)
        out[v + 4] = w * (a0 * b2 - a1 * b3 + a2 * b0 + a3 * b1)
        out[v + 5] = w * (a0 * b3 + a1 * b2 - a2 * b1 + a3 * b0)


@internal
def into_axes(s, F, out):
    """Wrenches on the frames (n, 6) along the velocities of the solve."""
    X = s.X
    for f in range(1, s.n_r):
        o = s.d * (f - 1)
        if s.d == 3:
            out[o], out[o + 1], out[o + 2] = F[f, 0], F[f, 1], F[f, 5]
            continue
        for c in range(3):
            out[o + c] = F[f, c]
            out[o + 3 + c] = X[f, 3 + c] * F[f, 3] + X[f, 6 + c] * F[f, 4] + X[f, 9 + c] * F[f, 5]


UNBALANCED = void(SCENE, f8, A1, A1, A1)
call_unbalanced = caller(UNBALANCED)


@compiled(UNBALANCED)
def unbalanced(s, t, y, lam, g):
    """g and, behind it, Phi at a state with its multipliers."""
    s.status[1] += 1
    set_poses(s, y)
    constraints(s, t)
    forces(s, t)
    for k in range(s.lam.size):
        s.lam[k] = lam[k] if k < s.m else 0.0
    if s.rubs_with != 0:
        call_derivative(s.rubs_with, s, t, lam, lam)
    for k in range(s.m):
        for l in range(s.row_start[k], s.row_start[k + 1]):
            for c in range(6):
                s.F[s.line_frame[l], c] -= s.J[l, c] * lam[k]
        g[s.n_v + k] = s.phi[k]
    into_axes(s, s.F, g)


@internal
def put_rows(s, A):
    """J and J^T of the last evaluation."""
    X, J = s.X, s.J
    for k in range(s.m):
        row = s.n_v + k
        for l in range(s.row_start[k], s.row_start[k + 1]):
            f = s.line_frame[l]
            if f == 0:
                continue
            o = s.d * (f - 1)
            if s.d == 3:
                A[row, o], A[row, o + 1], A[row, o + 2] = J[l, 0], J[l, 1], J[l, 5]
            else:
                for c in range(3):
                    A[row, o + c] = J[l, c]
                    A[row, o + 3 + c] = (
                        X[f, 3 + c] * J[l, 3] + X[f, 6 + c] * J[l, 4] + X[f, 9 + c] * J[l, 5]
                    )
            for c in range(s.d):
                A[o + c, row] = A[row, o + c]


@internal
def put_difference(s, A, c, room, size):
    """Column c of A, += minus a central difference of what is left of the balance."""
    for k in range(s.n_v):
        A[k, c] -= (room[2, k] - room[3, k]) / size


@internal
def evaluate(s, b, t, y, lam, g):
    """`unbalanced` called by its address: compiled once, not into every caller."""
    call_unbalanced(b.unbalanced, s, t, y, lam, g)


@compiled(void(SCENE, BALANCE, f8))
def system(s, b, t):
    """A at the state of b with its multipliers, where the scene was evaluated last."""
    n, away, y, lam, A = s.n_v, b.room[1], b.y, b.lam, b.A
    clear_table(A)
    put_rows(s, A)
    for c in range(n):
        for side in range(2):
            copy_to(b.room[0], y)
            clear(away)
            turns = c % s.d > 1 if s.d == 3 else c % s.d > 2
            away[c] = b.steps[BY_PLACE] * (1.0 - 2.0 * side) * (1.0 if turns else s.size)
            move_all(s, b.room[0], away)
            evaluate(s, b, t, b.room[0], lam, b.room[2 + side])
        put_difference(s, A, c, b.room, 2.0 * abs(away[c]))
    if b.steps[BY_SPEED] > 0.0:
        for c in range(n):
            for side in range(2):
                copy_to(b.room[0], y)
                b.room[0, s.n_q + c] += b.steps[BY_SPEED] * (1.0 - 2.0 * side)
                evaluate(s, b, t, b.room[0], lam, b.room[2 + side])
            put_difference(s, A, c, b.room, 2.0 * b.steps[BY_SPEED] / SLOW)
    for p in range(b.pressing.size):
        k = b.pressing[p]
        for side in range(2):
            copy_to(away, lam)
            away[k] += b.steps[BY_LOAD] * (1.0 - 2.0 * side)
            evaluate(s, b, t, y, away, b.room[2 + side])
        for c in range(n):
            A[c, n + k] = 0.0
        put_difference(s, A, n + k, b.room, 2.0 * b.steps[BY_LOAD])
