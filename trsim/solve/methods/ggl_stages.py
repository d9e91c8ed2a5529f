"""What the stages of Radau leave of the equations, and their way on.

Two forms for one and the same matrix: the stabilised equations of ggl_equations.py, and those of
equations.py, whose constraints hold by their accelerations.
"""

from trsim.assemble.equations import evaluate
from trsim.assemble.schur import velocity_residual
from trsim.kernels.lazy import internal
from trsim.kernels.vectors import all_finite, clear, copy_to
from trsim.solve.methods.dense_lu import divide, squared
from trsim.solve.methods.displacements import twisted, w_index
from trsim.solve.methods.ggl_equations import across, add_product, mass_times, moving, pull
from trsim.solve.methods.ggl_newton import eigenvalue
from trsim.solve.methods.radau import F, W, at_stage, transformed
from trsim.solve.methods.radau_tableau import ALPHA, BETA, GAMMA, C, T

# rows of K after those of radau.py, three each: lam of the stages, mu, right-hand sides and
# increments of Phi and Phi'; three rows that stay zero
LAM, MU, RP, RR, NIL = 13, 16, 19, 22, 25
STAGES = 28


@internal
def residuals(s, r, b, t, h):
    """F, RP, RR <- what the stages leave of the equations, in the basis T.  False: not finite."""
    K, end = b.K, s.n_q + s.n_v
    for i in range(3):
        f = K[F + i]
        at_stage(r, b, i)
        pull(s, t + C[i] * h, b.y1, K[LAM + i], b.pull)
        x = b.slope[0]
        for k in range(s.n_v):
            x[k] = b.y1[s.n_q + k]
            f[s.n_q + k] = b.pull[k]
        across(s, s.B, s.W, K[MU + i], x)
        for k in range(s.m):
            K[RP + i, k], K[RR + i, k] = -s.phi[k], -velocity_residual(s, k)
        moving(s, b.y1, x, f)
        for k in range(s.n_z):
            f[end + k] = s.zd[k]
        if not all_finite(f):
            return False
    left_over(s, r, b, h, True)
    transformed(K, RP, s.m)
    transformed(K, RR, s.m)
    return True


@internal
def left_over(s, r, b, h, forces):
    """F <- T^-1 F less the rates of the stages; rows of v are forces, or accelerations."""
    K, n = b.K, r.y.size
    g, a, c = GAMMA / h, ALPHA / h, BETA / h
    transformed(K, F, n)
    for i in range(3):
        for k in range(n):
            w0, w1, w2 = K[W, k], K[W + 1, k], K[W + 2, k]
            rate = g * w0 if i == 0 else (a * w1 - c * w2 if i == 1 else c * w1 + a * w2)
            if forces and s.n_q <= k < s.n_q + s.n_v:
                b.move[0, k - s.n_q] = rate
            else:
                K[F + i, k] -= rate
        if forces:
            mass_times(s, b.move[0], b.slope[0])
            for k in range(s.n_v):
                K[F + i, s.n_q + k] -= b.slope[0, k]


@internal
def residuals_index1(s, r, b, t, h):
    """What stages leave of the equations of motion with multipliers of their own.

    False: not finite.
    """
    K = b.K
    for i in range(3):
        at_stage(r, b, i)
        evaluate(s, t + C[i] * h, b.y1, K[F + i])
        copy_to(K[LAM + i], s.lam)
        if not all_finite(K[F + i]):
            return False
    left_over(s, r, b, h, False)
    nothing(s, K)
    for part in range(2):
        unconstrained(s, r, b, sides(K, part), eigenvalue(part, h))
    return True


@internal
def sides(K, part):
    """Right-hand sides of the real system (part 0) or the complex one, two parts of each: of y, of
    Phi and of Phi'."""
    i, j = (F, NIL) if part == 0 else (F + 1, F + 2)
    p, q = (RP, NIL + 1) if part == 0 else (RP + 1, RP + 2)
    u, w = (RR, NIL + 2) if part == 0 else (RR + 1, RR + 2)
    return K[i], K[j], K[p], K[q], K[u], K[w]


@internal
def unconstrained(s, r, b, sides, mu):
    """Right-hand sides of `solved` that constrain nothing: what is across the rows stays.

    (p + i q, u + i w) <- B dx and B dv of mu dv = f_v, mu dx = f_x + dv; rows of v in f + i g
    change from accelerations to forces.
    """
    f, g, p, q, u, w = sides
    x, y, dx, dy = b.slope[0], b.slope[1], b.move[0], b.move[1]
    for k in range(s.n_v):
        x[k], y[k] = twisted(s, r, k, f), twisted(s, r, k, g)
        dx[k], dy[k] = f[s.n_q + k], g[s.n_q + k]
    clear(u)
    clear(w)
    add_product(s, r.at_rows, 1.0, dx, u)
    add_product(s, r.at_rows, 1.0, dy, w)
    divide(u, w, mu, 0, s.m)
    copy_to(p, u)
    copy_to(q, w)
    add_product(s, r.at_rows, 1.0, x, p)
    add_product(s, r.at_rows, 1.0, y, q)
    divide(p, q, mu, 0, s.m)
    for k in range(b.state_row.shape[0]):  # these rows hold the difference of place and state
        j, i = b.state_row[k, 0], w_index(s, b.state_row[k, 1])
        a, c, size = mu.real, mu.imag, squared(mu)
        p[j] += r.at_state[k] * (f[i] * a + g[i] * c) / size
        q[j] += r.at_state[k] * (g[i] * a - f[i] * c) / size
    as_forces(s, b, f)
    as_forces(s, b, g)


@internal
def constrained(s, b, sides):
    """Right-hand sides of `solved`, of a real system, whose solution is along the rows."""
    f, _, p, _, u, _ = sides
    clear(p)
    clear(u)
    as_forces(s, b, f)


@internal
def as_forces(s, b, f):
    """Rows of v in f from accelerations to forces."""
    forces, accelerations = b.slope[0], b.move[0]
    for k in range(s.n_v):
        accelerations[k] = f[s.n_q + k]
    mass_times(s, accelerations, forces)
    for k in range(s.n_v):
        f[s.n_q + k] = forces[k]


@internal
def nothing(s, K):
    """The imaginary parts of a real system."""
    for i in range(3):
        clear(K[NIL + i])


@internal
def multipliers_moved_on(s, K):
    """Add the increments in RP and RR to those of the stages."""
    for i in range(3):
        for k in range(s.m):
            for j in range(3):
                K[LAM + i, k] += T[i, j] * K[RP + j, k]
                K[MU + i, k] += T[i, j] * K[RR + j, k]
