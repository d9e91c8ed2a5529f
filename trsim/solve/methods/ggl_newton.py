"""Newton systems of the equations of ggl_equations.py, sparse.

With c an eigenvalue of the method over h, real or complex, a Newton step solves

    c dx - dv + M^-1 B^T dmu = r_x                          B dx + Phi_z dz = r_p
    c M dv - f_x dx - f_v dv - f_z dz + B^T dlam = r_v      B dv + C dx     = r_r
    c dz - g_x dx - g_v dv - g_z dz = r_z

C is the change of B v + Phi_t.  dv is eliminated; dmu follows from S = B M^-1 B^T, at first without
C, which leaves a constrained system for (dx, dz) and dlam,

    [ c^2 M - c f_v - f_x    -f_z     B^T   ]
    [ -c g_v - g_x            c - g_z  0    ]
    [ B                       Phi_z    0    ]

as sparse as the mechanism, and then with C: what that changes in the row of v is M c M^-1 B^T dmu,
taken into dlam, and damping of dmu, left to the next iteration.  Where friction is made by lam the
B^T of the first row, not that of mu, is less by what it changes.  f_x holds the change of B^T lam;
all derivatives are differences, many columns at a time [CurtisPowellReid1974].
"""

from trsim.assemble.beams import node_products
from trsim.assemble.linear import factorise_alone, substitute
from trsim.assemble.schur import hub_mass, hub_rows
from trsim.elements.contract import N_BOOK
from trsim.kernels.lazy import internal
from trsim.kernels.vectors import clear, copy_to
from trsim.solve.methods.dense_lu import divide, quotient
from trsim.solve.methods.displacements import active, moved_by, twisted, w_index, width_of
from trsim.solve.methods.ggl_equations import across, add_product, block_times, mass_times
from trsim.solve.methods.ggl_jacobian import fastest
from trsim.solve.methods.radau_tableau import ALPHA, BETA, GAMMA
from trsim.solve.methods.sparse_lu import factorise_sparse, factorise_sparse_complex, solve_sparse


@internal
def sparse_factors(s, r, b, setting, h):
    """Factors of both systems of a step h, of the Jacobian in r.  False: not finite."""
    if b.made_of != r.jacobians:
        schur(s, r, b)
        b.made_of, b.made_for = r.jacobians, 0.0
        b.resisted, b.turns = int(some(r.at_rate)), int(some(r.at_turn))
        if setting.chooses > 0:
            r.jacobian_rate = fastest(s, r, b)
    if b.made_for == h:
        return True
    assembled(s, r, b, eigenvalue(0, h))
    real = factorise_sparse(b, b.value, b.real_l, b.real_u, b.real_d, b.side[0])
    assembled(s, r, b, eigenvalue(1, h))
    pair = factorise_sparse_complex(b, b.value, b.complex_l, b.complex_u, b.complex_d, b.pair)
    b.made_for = h if real >= 0 and pair >= 0 else 0.0
    return real >= 0 and pair >= 0


@internal
def eigenvalue(part, h):
    """Of the method over h: that of the real system, or of the complex one."""
    return complex(ALPHA / h, BETA / h) if part > 0 else complex(GAMMA / h, 0.0)


@internal
def some(table):
    """Whether an entry is not zero."""
    for x in table.flat:  # noqa: SIM110 - a generator does not compile
        if x != 0.0:
            return True
    return False


@internal
def schur(s, r, b):
    """M^-1 B^T and the factors of S of the Jacobian, into b."""
    clear(s.value)
    clear(s.through)
    pair = 0
    for f in range(1, s.n_r):
        for p in range(s.frame_start[f], s.frame_start[f + 1]):
            W = b.across[p]
            block_times(s, s.mass_inverse[f], s.inertia_inverse[f], r.at_rows[p], 0, W)
            if s.hub[f] < 0:
                for o in range(s.frame_start[f], p + 1):
                    for k in range(s.d):
                        s.value[s.entry[pair]] += r.at_rows[o, k] * W[k]
                    pair += 1
        if s.hub[f] >= 0:
            pair = hub_mass(s, f, hub_rows(s, f, r.at_rows, b.across, pair))
    if s.n_r < s.n:
        node_products(s, r.at_rows, pair)
    factorise_alone(s)
    s.status[2] -= 1  # a run that goes on makes them again: not counted
    copy_to(b.schur, s.value)


@internal
def assembled(s, r, b, mu):
    """The entries of the constrained system for mu into b.value, row by row."""
    a, c = mu.real, mu.imag
    for k in range(active(s)):
        for e in range(b.column_start[k], b.column_start[k + 1]):
            if k < s.n_v:
                re = (a * a - c * c) * b.mass[e] - a * r.at_rate[e] - r.at_place[e]
                im = 2.0 * a * c * b.mass[e] - c * r.at_rate[e]
            else:
                re, im = a * b.mass[e] - r.at_rate[e], c * b.mass[e]
            b.value[b.entry[e]] = complex(re, im)
    for f in range(1, s.n):
        for p in range(s.frame_start[f], s.frame_start[f + 1]):
            for k in range(width_of(s, f)):
                b.value[b.entry_row[p, k]] = r.at_rows[p, k]
                b.value[b.entry_across[p, k]] = r.at_push[p, k]
    for k in range(b.entry_state.size):
        b.value[b.entry_state[k]] = r.at_state[k]


@internal
def multipliers(s, r, b, sides, mu, parts):
    """b.mu <- S^-1 (u + i w + B (x + i y) - mu (p + i q)), x and y in b.slope.

    parts: 1 where there is no imaginary one.
    """
    _, _, p, q, u, w = sides
    clear(b.mu[1])
    for j in range(s.m):
        b.mu[0, j] = u[j] - (mu.real * p[j] - mu.imag * q[j])
        if parts > 1:
            b.mu[1, j] = w[j] - (mu.real * q[j] + mu.imag * p[j])
    for part in range(parts):
        add_product(s, r.at_rows, 1.0, b.slope[part], b.mu[part])
        substitute(s, b.schur, b.mu[part])


@internal
def with_states(s, r, b, rates, f, sign):
    """rates += sign Phi_z r_z: how fast a drive's state moves what it prescribes."""
    for k in range(b.state_row.shape[0]):
        rates[b.state_row[k, 0]] += sign * r.at_state[k] * f[w_index(s, b.state_row[k, 1])]


@internal
def loaded(s, r, b, part, f, mu):
    """b.side[part] <- rows of w of f + the part of mu M (x + i y) - (f_v, g_v) times that of
    (x + i y), in rank order; x and y in b.move."""
    x, y, side = b.move[part], b.move[1 - part], b.side[part]
    a, c = mu.real, mu.imag if part == 0 else -mu.imag
    for i in range(active(s)):
        side[b.rank[i]] = f[w_index(s, i)]
    u, weighed = b.pull, b.pull0
    for k in range(s.n_v):
        u[k] = a * x[k] - c * y[k]
    mass_times(s, u, weighed)
    for k in range(s.n_v):
        side[b.rank[k]] += weighed[k]
    if b.resisted == 0:
        return
    for k in range(s.n_v):
        for e in range(b.column_start[k], b.column_start[k + 1]):
            side[b.rank[b.row[e]]] -= r.at_rate[e] * x[k]


@internal
def solved(s, r, b, sides, mu, held):
    """(f + i g, p + i q, u + i w) <- the Newton step for mu of the right-hand sides there.

    sides: f, g of y (n_y), with rows of v as forces; p, q of Phi, then dlam; u, w of Phi', then
    dmu.  A real mu takes the real factors; g, q, w are zero then, and stay so.  held: 1.0; 0.0
    leaves C out, for right-hand sides of ggl_stages.unconstrained.
    """
    f, g, p, q, u, w = sides
    a, c = mu.real, mu.imag
    n_w, x, y = active(s), b.slope[0], b.slope[1]
    for k in range(s.n_v):
        x[k], y[k] = twisted(s, r, k, f), twisted(s, r, k, g)
    with_states(s, r, b, u, f, 1.0)
    with_states(s, r, b, w, g, 1.0)
    multipliers(s, r, b, sides, mu, 2 if c != 0.0 else 1)
    with_states(s, r, b, u, f, -1.0)
    with_states(s, r, b, w, g, -1.0)
    dx, dy = b.move[0], b.move[1]  # u = r_x - M^-1 B^T dmu for now
    for k in range(s.n_v):
        dx[k], dy[k] = x[k], y[k]
    across(s, r.at_rows, b.across, b.mu[0], dx)
    if c != 0.0:
        across(s, r.at_rows, b.across, b.mu[1], dy)
        loaded(s, r, b, 1, g, mu)
    loaded(s, r, b, 0, f, mu)
    for j in range(s.m):
        b.side[0, b.rank[n_w + j]], b.side[1, b.rank[n_w + j]] = p[j], q[j]
    if c == 0.0:
        solve_sparse(b, b.real_l, b.real_u, b.real_d, b.side[0])
        clear(b.side[1])
    else:
        for k in range(b.pair.size):
            b.pair[k] = complex(b.side[0, k], b.side[1, k])
        solve_sparse(b, b.complex_l, b.complex_u, b.complex_d, b.pair)
        for k in range(b.pair.size):
            b.side[0, k], b.side[1, k] = b.pair[k].real, b.pair[k].imag
    for k in range(s.n_v):
        dx[k], dy[k] = b.side[0, b.rank[k]], b.side[1, b.rank[k]]
        x[k] -= a * dx[k] - c * dy[k]  # r_x - (a + i c) dx
        y[k] -= a * dy[k] + c * dx[k]
    corrected_multipliers(s, r, b, sides, mu, held)
    across(s, r.at_rows, b.across, u, x)
    if c != 0.0:
        across(s, r.at_rows, b.across, w, y)
    advanced(s, r, b, f, g, mu)


@internal
def corrected_multipliers(s, r, b, sides, mu, held):
    """u + i w <- dmu of the velocities as found; p + i q <- dlam with what that changes."""
    _, _, p, q, u, w = sides
    a, c = mu.real, mu.imag
    n_w, parts = active(s), 2 if c != 0.0 else 1
    for j in range(s.m):
        k = b.rank[n_w + j]
        p[j] = b.side[0, k] + a * b.mu[0, j] - c * b.mu[1, j]
        q[j] = b.side[1, k] + a * b.mu[1, j] + c * b.mu[0, j]
    add_product(s, r.at_turn, -held, b.move[0], u)
    if parts > 1:
        add_product(s, r.at_turn, -held, b.move[1], w)
    multipliers(s, r, b, sides, complex(0.0, 0.0), parts)
    for j in range(s.m):
        u[j], w[j] = b.mu[0, j], b.mu[1, j]
        p[j] -= a * u[j] - c * w[j]
        q[j] -= a * w[j] + c * u[j]


@internal
def advanced(s, r, b, f, g, mu):
    """Increments of y into f + i g; b.slope holds r_x - mu dx - M^-1 B^T dmu = -dv."""
    x, y, dx, dy = b.slope[0], b.slope[1], b.move[0], b.move[1]
    for k in range(s.n_v):
        f[s.n_q + k], g[s.n_q + k] = -x[k], -y[k]
    for k in range(s.n_v, active(s)):
        i = w_index(s, k)
        f[i], g[i] = b.side[0, b.rank[k]], b.side[1, b.rank[k]]
    divide(f, g, mu, s.n_q + s.n_v, s.n_q + s.n_v + N_BOOK)
    # a quaternion has a fourth number: what no displacement means, r_q without r_x
    for k in range(s.n_v):
        z = quotient(complex(twisted(s, r, k, f), twisted(s, r, k, g)), mu)
        x[k], y[k] = dx[k] - z.real, dy[k] - z.imag
    for k in range(s.n_q):
        z = quotient(complex(f[k], g[k]), mu)
        f[k], g[k] = z.real + moved_by(s, r.y, k, x), z.imag + moved_by(s, r.y, k, y)
