"""Radau IIA, three stages, order 5, on sparse stabilised index-2 equations.

    Z_i = h sum_j a_ij y'(t + c_j h, y + Z_j, lam_j, mu_j)      Phi = 0 and Phi' = 0 at every stage

The equations are those of ggl_equations.py.  As in radau.py, with the multipliers of each stage as
further unknowns and one real and one complex sparse system in place of dense ones: the cost of a
step grows like the number of bodies of a chain.  Meant for stiff mechanisms of many bodies.  The
multipliers are left out of Newton's test and of the error estimate, where they would stand
multiplied by h [HairerWanner1996]; they are what Newton starts from in the next step.  The
derivative at the ends of a step is that of equations.py, as is everything that is recorded.
"""

from math import isfinite, sqrt

import numpy as np

from trsim.assemble.equations import evaluate
from trsim.elements.contract import DRIVES, FRICTION, SCENE, compiled
from trsim.kernels.lazy import internal
from trsim.kernels.packed import A1, f8
from trsim.kernels.signatures import float64
from trsim.kernels.vectors import clear, copy_to
from trsim.solve.march.accelerations import (
    ROUNDED,
    apart,
    doubted,
    furthest,
    held,
    in_units,
    jumped,
    settles,
)
from trsim.solve.march.calls import DENSE
from trsim.solve.march.record import NO_JACOBIAN, OLD, SETTINGS
from trsim.solve.methods import ggl_stages, ggl_tables, radau
from trsim.solve.methods.ggl_equations import across, moving
from trsim.solve.methods.ggl_jacobian import sparse_jacobian
from trsim.solve.methods.ggl_newton import eigenvalue, solved, sparse_factors
from trsim.solve.methods.ggl_stages import (
    LAM,
    MU,
    NIL,
    constrained,
    multipliers_moved_on,
    nothing,
    residuals,
    residuals_index1,
    sides,
    unconstrained,
)
from trsim.solve.methods.ggl_tables import SparseBuffers, SparseRecord
from trsim.solve.methods.jacobian import missing
from trsim.solve.methods.newton import resolution, size_of_change
from trsim.solve.methods.radau import (
    HALVE,
    KAPPA,
    MOST_ITERATIONS,
    F,
    W,
    Z,
    at_stage,
    collocation,
    guess,
    moved_on,
    norm,
    of_accelerations,
    of_works,
)
from trsim.solve.methods.radau_tableau import A, C, E

ESTIMATE, LAST = radau.ESTIMATE, radau.LAST
IMPLICIT = True
STAGES = ggl_stages.STAGES
SPARSE = ggl_tables  # its records have tables of their own
interpolate, rate = radau.interpolate, radau.rate

QUICK = 0.02  # contraction with which a matrix is kept: a new one is cheap
# where no row of a constraint turns with its bodies: the same, and what Newton may leave, as a part
# of the error allowed [HairerWanner1996]
QUICK_FIXED, KAPPA_FIXED = 0.06, 0.03
# a place is off its collocation polynomial by a part of x (x - c_1) (x - c_2) (x - c_3), so that mu
# of stage i is TURNED_BY[i] times what changes slowly: mu of the end from the first two stages, as
# it would be seen from the start of the step
TURNED_BY = C * (C - np.roll(C, 1)) * (C - np.roll(C, 2))
SEEN_FROM_START = TURNED_BY[2] / (C[1] - C[0]) * np.array([C[1], -C[0]]) / TURNED_BY[:2]
# times the tolerance as written: what mu may make of accelerations, at most half of what they are
# off by [measured: a third to all of it]; it dies out from step to step and does not add up
BY_MULTIPLIERS = 10.0
UNKNOWN = 1e-2  # error of a first step, as a part of that allowed
KEPT = radau.DENSE_ROWS  # rows of the dense output from which on lam of the stages is kept
DENSE_ROWS = KEPT + 3
DENSE_DEGREE = 3

#                   scene  record  buffers  setting t h
STEP = float64(SCENE, SparseRecord.kind, SparseBuffers.kind, SETTINGS, f8, f8)
SOFTEN = float64(SCENE, SparseRecord.kind, SparseBuffers.kind, A1)


@compiled(STEP)
def step(s, r, b, setting, t, h):
    stabilised = True
    for attempt in range(3):
        if missing(r) or (attempt > 0 and r.jacobian == OLD):
            sparse_jacobian(s, r, b, setting, b.K[Z], b.K[W])
        elif not stabilised:
            return HALVE
        elif attempt > 0:
            # past a singular position: rows that change their sense cannot be brought to zero with
            # those of the start, but accelerations are there on both sides
            stabilised = False
        if not sparse_factors(s, r, b, setting, h):
            return HALVE
        guess(s, r, b, h)
        guess_multipliers(s, r, b, t, h)
        converged = newton(s, r, b, setting, h, stabilised)
        if converged > 0:
            break
        if converged < 0 and not stabilised:
            return np.inf
    else:
        return HALVE
    if stabilised and (s.rubs_with != 0 or driven(s)):
        works_of_multipliers(s, r, b, t, h)
    at_stage(r, b, 2)
    error = estimate(s, r, b, setting, t, h)
    quick = QUICK if b.turns > 0 else QUICK_FIXED
    r.next_jacobian = OLD if r.newton_rate < quick else NO_JACOBIAN
    return error


@internal
def driven(s):
    """Whether a constraint moves, at the last evaluation."""
    for k in range(s.m):  # noqa: SIM110 - a generator does not compile
        if s.phi_t[k] != 0.0:
            return True
    return False


@internal
def works_of_multipliers(s, r, b, t, h):
    """The work of rigid drives and of friction in joints again, with the multipliers that go with
    each stage's state.

    Those of the stages are of order 3, which would be all that the energy book shows.
    """
    K, first = b.K, s.n_q + s.n_v
    for i in range(3):
        at_stage(r, b, i)
        evaluate(s, t + C[i] * h, b.y1, K[F + i])
    for i in range(3):
        again(K, i, h, first + DRIVES)
        if s.rubs_with != 0:
            again(K, i, h, first + FRICTION)


@internal
def again(K, i, h, entry):
    """One work at stage i, from its powers at all of them."""
    total = 0.0
    for j in range(3):
        total += A[i, j] * K[F + j, entry]
    K[Z + i, entry] = h * total


@internal
def guess_multipliers(s, r, b, t, h):
    """lam of the stages from the parabola of the step before, or as it is now; mu = 0."""
    K = b.K
    if r.history > 0:
        ratio = h / r.past_h
        for i in range(3):
            theta = 1.0 + C[i] * ratio
            clear(K[LAM + i])
            for j in range(3):
                p, q = C[(j + 1) % 3], C[(j + 2) % 3]
                part = (theta - p) * (theta - q) / ((C[j] - p) * (C[j] - q))
                for k in range(s.m):
                    K[LAM + i, k] += part * r.past[KEPT + j, k]
    else:
        evaluate(s, t, r.y, K[F])
        for i in range(3):
            copy_to(K[LAM + i], s.lam)
    for i in range(3):
        clear(K[MU + i])


@internal
def newton(s, r, b, setting, h, stabilised):
    """Simplified Newton on the stages.  1: converged, 0: not, -1: a value is not finite.

    stabilised: on the equations of ggl_equations.py; on those of equations.py otherwise.
    """
    K, weight, t = b.K, b.weight, r.t
    floor = resolution(r, weight, h)
    strict = stabilised and b.turns > 0
    enough = max(KAPPA_FIXED if stabilised and not strict else KAPPA, floor)
    # rows that turn with their bodies leave more in an iteration than those of radau.py: to make
    # errors as small, less is wanted, and what the method errs, h^6, where its estimate, h^4, is
    # small
    made = r.moved_off[0] if r.past_error > 0.0 else UNKNOWN
    made = min(made * sqrt(made), 1.0)
    wanted = max(min(KAPPA, sqrt(setting.step_error)) * made, floor) if strict else enough
    before, rate, held = 0.0, 1.0, 1.0 if stabilised else 0.0
    for iteration in range(MOST_ITERATIONS):
        r.iterations += 1
        sound = residuals(s, r, b, t, h) if stabilised else residuals_index1(s, r, b, t, h)
        if not sound:
            return -1
        nothing(s, K)
        for part in range(2):
            solved(s, r, b, sides(K, part), eigenvalue(part, h), held)
        moved = size_of_change(s, K, F, weight)
        moved_on(K, r.y.size)
        if stabilised:
            multipliers_moved_on(s, K)
        if not isfinite(moved):
            return -1
        if moved == 0.0:
            return 1
        if iteration > 0:
            rate = moved / before if before > 0.0 else 0.0
            r.newton_rate = rate
            left = MOST_ITERATIONS - 1 - iteration
            less = moved / (1.0 - rate) if rate < 1.0 else moved  # times rate: what is left
            if rate < 1.0 and less * rate < wanted:
                return 1
            if less * min(rate, 1.0) < enough:
                if left == 0 or rate >= 1.0:  # as far as it goes
                    return 1
            elif rate >= 2.0 or (rate < 1.0 and less * rate**left > enough):
                return 0
        before = moved
    return 0


@internal
def estimate(s, r, b, setting, t, h):
    """Error of order 3 as in radau.py: (GAMMA/h - J)^-1 of (f(y) + sum E_i Z_i / h), the real
    system; filtered once more if large.  Of accelerations as in radau.py, of what is along the rows
    alone: across them they are solved for from stages that are on them."""
    K, n, weight, g = b.K, r.y.size, b.weight, eigenvalue(0, h)
    e, error, booked, off = K[F], 0.0, 0.0, 0.0
    moved = of_multipliers(s, r, b, setting, h) if held(s, r, h) else 0.0
    copy_to(e, r.yd)
    for c in range(n):
        K[F + 1, c] = (E[0] * K[Z, c] + E[1] * K[Z + 1, c] + E[2] * K[Z + 2, c]) / h
    for turn in range(2):
        for c in range(n):
            e[c] += K[F + 1, c]
        copy_to(K[F + 2], e)  # as it is unfiltered
        nothing(s, K)
        unconstrained(s, r, b, sides(K, 0), g)
        solved(s, r, b, sides(K, 0), g, 0.0)
        error = norm(e, weight)
        if turn == 0:
            booked = of_works(s, r, b, setting, h)
            off = apart(s, K[F + 2], g.real, e) if settles(s) else 0.0
        if turn > 0 or error < 1.0 or (r.history > 0 and r.after_rejection == 0):
            break
        for c in range(n):
            K[F + 2, c] = r.y[c] + e[c]
        evaluate(s, t, K[F + 2], e)
    if error < 1.0:
        r.moved_off[0] = max(error, booked, 1e-10)
    if held(s, r, h):
        copy_to(e, K[F + 2])
        constrained(s, b, sides(K, 0))
        solved(s, r, b, sides(K, 0), g, 1.0)
        error = max(error, moved, of_accelerations(s, r, b, setting, h))
    jumped(s, r, setting, off)
    return max(error, booked, 1e-10)


@internal
def of_multipliers(s, r, b, setting, h):
    """The error of accelerations that mu makes; K[F] is scratch.

    M^-1 B^T mu moves bodies without their velocities, and what is stiff between them answers, by
    e = (GAMMA/h - J)^-1 (-M^-1 B^T mu, 0) and accelerations GAMMA/h e_v.  No error of places and
    speeds tells of it.  Bodies turn in a step, and what is stiff with them: J is that of its start,
    and so is mu.
    """
    K, g, mu, x = b.K, eigenvalue(0, h), b.mu[0], b.pull0
    for k in range(s.m):
        mu[k] = SEEN_FROM_START[0] * K[MU, k] + SEEN_FROM_START[1] * K[MU + 1, k]
    clear(x)
    across(s, r.at_rows, b.across, mu, x)
    clear(K[F])
    moving(s, r.y, x, K[F])
    nothing(s, K)
    unconstrained(s, r, b, sides(K, 0), g)
    solved(s, r, b, sides(K, 0), g, 0.0)
    off = apart(s, K[NIL], g.real, K[F])
    most = r.top_acceleration
    rounding = ROUNDED * furthest(s, r.y, s.size) * g.real**2
    if off <= rounding:  # of places, which mu takes for what joints are open by
        doubted(s, r, setting, h, (off, most, 0.0))
        return 0.0
    return in_units(s, r, setting, h, (off, most, 0.0), BY_MULTIPLIERS)


@compiled(SOFTEN)
def soften(s, r, b, c):
    """c <- (mu - J)^-1 c along the rows, with mu of the real system."""
    if b.made_for == 0.0:
        return 0.0
    K, mu = b.K, eigenvalue(0, b.made_for)
    copy_to(K[F], c)
    nothing(s, K)
    constrained(s, b, sides(K, 0))
    solved(s, r, b, sides(K, 0), mu, 1.0)
    copy_to(c, K[F])
    return mu.real


@compiled(DENSE)
def dense(scene, K, t, h, ends, P):
    """The collocation polynomial, and behind it lam of the stages for the next step."""
    collocation(K, ends[0], ends[1], P)
    for i in range(3):
        copy_to(P[KEPT + i], K[LAM + i])
