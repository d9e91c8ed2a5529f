"""What rows of J have of their own, and whether it turned round between two places.

    d_k = e_k^T L^-1 J,        D_k = |d_k|^2 = d_k M^-1 d_k^T        with S = L D L^T

is row k less what it shares with the rows eliminated before it; sigma_k is the root of D_k as a
share of the diagonal of S.
"""

from math import sqrt

from trsim.assemble.equations import constraints, set_poses
from trsim.assemble.linear import diagonal, eliminate
from trsim.assemble.schur import rows
from trsim.kernels.lazy import internal
from trsim.kernels.vectors import clear, copy_to

FINEST = 1e-15  # of the diagonal: rounding of a pivot
# cosine: below that a row turned by more than it does in half of a way on its branch.  One that
# changes it turns round by two right angles, less what it turns by anyhow, and half of that where
# the way ends between the branches
PLAINLY = 0.5


@internal
def look_at(s, t, y):
    """The rows at a place, and their factors."""
    set_poses(s, y)
    constraints(s, t)
    rows(s)
    diagonal(s)
    eliminate(s, FINEST)


@internal
def keep_roots(s, roots):
    """sigma of the rows just factorised."""
    for k in range(s.first.size):
        D = s.value[s.column_start[k]]
        roots[k] = sqrt(D / s.first[k]) if D * s.first[k] > 0.0 else 0.0
    for j in range(s.delayed[0]):
        roots[s.delayed[1 + j]] = sqrt(max(s.delayed_pivot[j], 0.0))


@internal
def keep(s, t, y, place, roots):
    """The rows at a place with their factors, in one of four places, and sigma of them."""
    look_at(s, t, y)
    keep_rows(s, place)
    keep_roots(s, roots)


@internal
def begun_in(r):
    """Which of the four places has the rows where the step begins; `ends_in`: where it ends."""
    return 3 if r.kept == 2 else 2


@internal
def ends_in(r):
    """Which of them has those where it ends: the two change places with every step."""
    return 5 - begun_in(r)


@internal
def keep_rows(s, place):
    """B and L of the rows just factorised, in one of four places."""
    B, n = s.kept_rows[place], 0
    for p in range(s.slot_row.size):
        for c in range(s.d):
            B[n] = s.B[p, c]
            n += 1
    copy_to(s.kept_factors[place], s.value)


@internal
def turned_round(s, k, one, other):
    """Whether what the row eliminated k-th has of its own points elsewhere at the other place."""
    own(s, 0, k, one)
    own(s, 1, k, other)
    return cosine(s) <= PLAINLY


@internal
def cosine(s):
    """Of the angle between what own() left of both ends, in the metric of M^-1."""
    u, v = s.own[0], s.own[1]
    along = first = second = 0.0
    for f in range(1, s.n_r):
        o = s.d * f
        along += product(s, f, u, v, o)
        first += product(s, f, u, u, o)
        second += product(s, f, v, v, o)
    return along / (sqrt(first * second) + 1e-300)


@internal
def own(s, end, k, place):
    """d of the row eliminated k-th, kept in that place, into s.own[end]: of bodies, and of hubs
    those eliminated before.

    Rows whose elimination changed others before it, but not this one, have no part in it: those the
    next of whose column has none.
    """
    w, has_part, L, B, d = s.r2, s.r, s.kept_factors[place], s.kept_rows[place], s.own[end]
    row, column_start = s.row, s.column_start
    clear(w)
    clear(has_part)
    w[row[column_start[k]]] = has_part[row[column_start[k]]] = 1.0
    for j in range(k - 1, -1, -1):
        start, beyond = column_start[j], column_start[j + 1]
        if beyond == start + 1 or has_part[row[start + 1]] == 0.0:
            continue
        total = 0.0
        for p in range(start + 1, beyond):
            total -= L[p] * w[row[p]]
        w[row[start]], has_part[row[start]] = total, 1.0
    clear(d)
    for f in range(1, s.n_r):
        if s.hub[f] < 0 or moves(s, w, f):
            for p in range(s.frame_start[f], s.frame_start[f + 1]):
                for c in range(s.d):
                    d[s.d * f + c] += B[s.d * p + c] * w[s.slot_row[p]]


@internal
def moves(s, w, f):
    """Whether a hub gives way, as its own unknowns say."""
    for c in range(s.d):  # noqa: SIM110 - a generator does not compile
        if w[s.hub[f] + c] != 0.0:
            return True
    return False


@internal
def product(s, f, u, v, o):
    """u M^-1 v^T of one body, whose part of both begins at o."""
    K = s.inertia_inverse
    if s.d == 3:
        along = u[o] * v[o] + u[o + 1] * v[o + 1]
        return s.mass_inverse[f] * along + K[f, 8] * u[o + 2] * v[o + 2]
    total = s.mass_inverse[f] * (u[o] * v[o] + u[o + 1] * v[o + 1] + u[o + 2] * v[o + 2])
    for i in range(3):
        for j in range(3):
            total += u[o + 3 + i] * K[f, 3 * i + j] * v[o + 3 + j]
    return total
