"""The equations of motion of a model, on one screen.

    [ M  J^T ] [ V'  ]   [ F - gyroscopic ]
    [ J  0   ] [ lam ] = [ gamma          ]        gamma - 2 alpha Phi' - beta^2 Phi with Baumgarte

M is constant, a block for each body, so the multipliers come from the small sparse matrix
S = J M^-1 J^T,

    S lam = J M^-1 F - gamma,        V' = M^-1 (F - J^T lam)              [Nikravesh1988]

and the reactions on the bodies are -J^T lam.  `derivative` is the table of contents of the physics.
"""

from math import nan

from trsim.assemble.linear import (
    POOR,
    SINGULAR,
    SOUND,
    contradictory,
    independent,
    refactorise,
    solve,
)
from trsim.assemble.on_beams import FREE, KINETIC, POSES, PULL, RATES, RIGHT, call_beams
from trsim.assemble.schur import (
    plain_rows,
    pull,
    pull_planar,
    pull_spatial,
    velocity_residual,
)
from trsim.elements.contract import DRIVES, SCENE, call_kernel, compiled
from trsim.elements.scene import BAUMGARTE
from trsim.kernels.calls import caller
from trsim.kernels.lazy import internal
from trsim.kernels.signatures import A1, f8, float64, i8, void
from trsim.kernels.vectors import clear, clear_table
from trsim.laws.sine import sine_cosine

#                        scene  t   y   y'
DERIVATIVE = void(SCENE, f8, A1, A1)
call_derivative = caller(DERIVATIVE)
POSES_OF = void(SCENE, A1)
call_poses = caller(POSES_OF)
AT = void(SCENE, f8)


@compiled(DERIVATIVE)
def derivative(s, t, y, yd):
    """Fill yd = y' at (t, y)."""
    s.status[1] += 1
    poses(s, y)
    forces(s, t)
    free_accelerations(s)
    if s.n_r < s.n:
        call_beams(s.on_beams[FREE], s, y, yd, 0)
    if s.m > 0:
        constraints(s, t)
        refactorise(s)
        if s.rubbed_at != 0:
            call_derivative(s.rubbed_at, s, t, y, yd)
        power = 0.0
        for k in range(s.m, s.lam.size):  # what was measured last may have shared loads with them
            s.lam[k] = 0.0
        for again in range(2):
            right_hand_side(s, s.stabilisation == BAUMGARTE)
            solve(s, s.x)
            if contradictory(s, s.x) and masses_too_unequal(s):
                s.status[3] += 1
                s.x[0] = nan
            x, lam, phi_t = s.x, s.lam, s.phi_t
            for k in range(s.m):  # what follows in x is the motion of hubs
                lam[k] = x[k] if again == 0 else lam[k] + x[k]
                # a moving constraint is a drive: the power it gives to the mechanism
                power += x[k] * phi_t[k]
            if again == 1 or s.status[0] != POOR or s.unequal == 0 or s.n_r < s.n:
                break
            # x has too few digits for inertias so unequal: its last bit turns the small ones by
            # much.  What is left of the rows has digits of its own; x is then that alone.
            for f in range(1, s.n_r):
                pull(s, f, s.x)
        s.zd[DRIVES] += power
        if s.lightened != 0:
            call_derivative(s.lightened, s, t, y, yd)
    accelerations(s, y, yd)
    near = s.near > 0.0 or s.status[5] > 0
    if s.m > 0 and (s.status[0] == SINGULAR or (s.status[0] == POOR and near)):
        call_derivative(s.beside, s, t, y, yd)


@compiled(DERIVATIVE)
def without_feedback(s, t, y, yd):
    """lam, A and yd of the last evaluation, which was at (t, y), without Baumgarte's feedback.

    It brings the state back to the constraints and is no force of the mechanism: at rates far above
    those of the motion, and inside steps, where interpolation opens rows, it is many times what a
    reaction is wrong by otherwise.  Accelerations that are a limit (beside.py) have none.
    """
    if s.status[0] != SOUND:
        return
    free_accelerations(s)
    if s.n_r < s.n:
        call_beams(s.on_beams[FREE], s, y, yd, 0)
    right_hand_side(s, False)
    solve(s, s.x)
    for k in range(s.lam.size):
        s.lam[k] = s.x[k] if k < s.m else 0.0
    if s.lightened != 0:
        call_derivative(s.lightened, s, t, y, yd)
    accelerations(s, y, yd)


@internal
def evaluate(s, t, y, yd):
    """`derivative` called by its address: compiled once, not into every caller."""
    call_derivative(s.derivative, s, t, y, yd)


@internal
def set_poses(s, y):
    """`poses` called by its address: compiled once, not into every caller."""
    call_poses(s.poses, s, y)


@compiled(POSES_OF)
def poses(s, y):
    """X, V, S and z from the state: the only place that knows the generalised coordinates."""
    X, V, S, branch, turn = s.X, s.V, s.S, s.branch, s.turn
    for k in range(s.n_z):
        s.z[k] = y[s.n_q + s.n_v + k]
    if s.d == 3:
        for f in range(1, s.n_r):
            q, v = 3 * (f - 1), s.n_q + 3 * (f - 1)
            sine, cosine = sine_cosine(y[q + 2])
            X[f, 0], X[f, 1] = y[q], y[q + 1]
            X[f, 3], X[f, 4], X[f, 6], X[f, 7] = cosine, -sine, sine, cosine
            V[f, 0], V[f, 1], V[f, 5] = y[v], y[v + 1], y[v + 2]
        for k in range(turn.shape[0]):
            # planar angles are unwrapped by nature: the branch is the value itself
            i, j, sign = turn[k, 1], turn[k, 2], turn[k, 3]
            angle_i = y[3 * (i - 1) + 2] if i > 0 else 0.0
            angle_j = y[3 * (j - 1) + 2] if j > 0 else 0.0
            branch[turn[k, 0]] = sign * (angle_j - angle_i) + s.parallel[k]
    else:
        for f in range(1, s.n_r):
            spatial_pose(X, V, f, y, 7 * (f - 1), s.n_q + 6 * (f - 1))
    if s.n_r < s.n:
        call_beams(s.on_beams[POSES], s, y, y, 0)
    for k in range(s.n_s):
        S[k, 0] = branch[k]
    call_all(s, s.coordinate, 0.0)
    for k in range(s.rated.shape[0]):
        S[s.rated[k, 0], 0] = S[s.rated[k, 1], 1]


@internal
def spatial_pose(X, V, f, y, q, v):
    """Rotation matrix R(p) / |p|^2 of the quaternion and world-axes angular velocity R omega."""
    e0, e1, e2, e3 = y[q + 3], y[q + 4], y[q + 5], y[q + 6]
    f2 = 2.0 / (e0 * e0 + e1 * e1 + e2 * e2 + e3 * e3)
    for c in range(3):
        X[f, c] = y[q + c]
        V[f, c] = y[v + c]
    X[f, 3] = 1.0 - f2 * (e2 * e2 + e3 * e3)
    X[f, 4] = f2 * (e1 * e2 - e0 * e3)
    X[f, 5] = f2 * (e1 * e3 + e0 * e2)
    X[f, 6] = f2 * (e1 * e2 + e0 * e3)
    X[f, 7] = 1.0 - f2 * (e1 * e1 + e3 * e3)
    X[f, 8] = f2 * (e2 * e3 - e0 * e1)
    X[f, 9] = f2 * (e1 * e3 - e0 * e2)
    X[f, 10] = f2 * (e2 * e3 + e0 * e1)
    X[f, 11] = 1.0 - f2 * (e1 * e1 + e2 * e2)
    o0, o1, o2 = y[v + 3], y[v + 4], y[v + 5]
    V[f, 3] = X[f, 3] * o0 + X[f, 4] * o1 + X[f, 5] * o2
    V[f, 4] = X[f, 6] * o0 + X[f, 7] * o1 + X[f, 8] * o2
    V[f, 5] = X[f, 9] * o0 + X[f, 10] * o1 + X[f, 11] * o2


@compiled(AT)
def forces(s, t):
    """Sum the wrenches F and the powers and rates z'."""
    F = s.F
    for f in range(s.n):  # one by one: a call that clears 48 bytes takes longer
        F[f, 0] = F[f, 1] = F[f, 2] = F[f, 3] = F[f, 4] = F[f, 5] = 0.0
    if s.n_r < s.n:
        clear_table(s.Q)
    clear(s.zd)
    call_all(s, s.force, t)


@internal
def call_all(s, kernels, t):
    """Call every kernel of a table."""
    for k in range(kernels.shape[0]):
        call_kernel(kernels[k, 0], t, s, kernels[k, 1], kernels[k, 2])


@internal
def call_one(s, kernels, t, e):
    """Call the kernel of a table that instance e has, for e alone."""
    for k in range(kernels.shape[0]):
        if kernels[k, 1] <= e < kernels[k, 2]:
            call_kernel(kernels[k, 0], t, s, e, e + 1)


@compiled(float64(SCENE, f8))
def largest_wrench(s, t):
    """The largest force, or moment by the mechanism's size, that one element puts on one frame."""
    most = 0.0
    for k in range(s.force.shape[0]):
        for e in range(s.force[k, 1], s.force[k, 2]):
            clear_table(s.F)
            call_kernel(s.force[k, 0], t, s, e, e + 1)
            for f in range(1, s.n):
                for c in range(6):
                    most = max(most, abs(s.F[f, c]) / (1.0 if c < 3 else s.size))
    forces(s, t)
    return most


@compiled(AT)
def constraints(s, t):
    """Phi, Phi_t, J and gamma of all rows."""
    call_all(s, s.constraint, t)


@internal
def free_accelerations(s):
    """M^-1 (F - omega x I omega) of the rigid bodies, in the axes of the solve."""
    X, V, F, a = s.X, s.V, s.F, s.free
    mass_inverse, inertia, inertia_inverse = s.mass_inverse, s.inertia, s.inertia_inverse
    if s.d == 3:
        for f in range(1, s.n_r):
            by_mass, by_inertia = mass_inverse[f], inertia_inverse[f, 8]
            a[f, 0] = F[f, 0] * by_mass
            a[f, 1] = F[f, 1] * by_mass
            a[f, 2] = F[f, 5] * by_inertia
        return
    for f in range(1, s.n_r):
        by_mass = mass_inverse[f]
        for c in range(3):
            a[f, c] = F[f, c] * by_mass
        # torque and angular velocity in body axes
        o0 = X[f, 3] * V[f, 3] + X[f, 6] * V[f, 4] + X[f, 9] * V[f, 5]
        o1 = X[f, 4] * V[f, 3] + X[f, 7] * V[f, 4] + X[f, 10] * V[f, 5]
        o2 = X[f, 5] * V[f, 3] + X[f, 8] * V[f, 4] + X[f, 11] * V[f, 5]
        I = inertia[f]
        h0 = I[0] * o0 + I[1] * o1 + I[2] * o2
        h1 = I[3] * o0 + I[4] * o1 + I[5] * o2
        h2 = I[6] * o0 + I[7] * o1 + I[8] * o2
        m0 = X[f, 3] * F[f, 3] + X[f, 6] * F[f, 4] + X[f, 9] * F[f, 5] - (o1 * h2 - o2 * h1)
        m1 = X[f, 4] * F[f, 3] + X[f, 7] * F[f, 4] + X[f, 10] * F[f, 5] - (o2 * h0 - o0 * h2)
        m2 = X[f, 5] * F[f, 3] + X[f, 8] * F[f, 4] + X[f, 11] * F[f, 5] - (o0 * h1 - o1 * h0)
        K = inertia_inverse[f]
        a[f, 3] = K[0] * m0 + K[1] * m1 + K[2] * m2
        a[f, 4] = K[3] * m0 + K[4] * m1 + K[5] * m2
        a[f, 5] = K[6] * m0 + K[7] * m1 + K[8] * m2


@internal
def masses_too_unequal(s):
    """Whether S is singular only to rounding: bodies so unequal that its small part is lost.

    Where J J^T is singular too the rows do depend on each other: a dead centre, at which a driven
    mechanism may well start with a velocity that is none of those on its way.  S is made anew.
    """
    plain_rows(s)
    unequal = independent(s)
    refactorise(s)
    return unequal


@internal
def right_hand_side(s, feedback):
    """x = J M^-1 F - gamma, with Baumgarte's terms where asked for."""
    B, free, x, gamma = s.B, s.free, s.x, s.gamma
    slot_row, frame_start = s.slot_row, s.frame_start
    for k in range(s.m):
        x[k] = -gamma[k]
        if feedback:
            x[k] += 2.0 * s.alpha * velocity_residual(s, k) + s.beta * s.beta * s.phi[k]
    if s.n_r < s.n:
        call_beams(s.on_beams[RIGHT], s, x, x, 0)
    spatial = s.d == 6
    for f in range(1, s.n_r):
        for p in range(frame_start[f], frame_start[f + 1]):
            total = B[p, 0] * free[f, 0] + B[p, 1] * free[f, 1] + B[p, 2] * free[f, 2]
            if spatial:
                total += B[p, 3] * free[f, 3] + B[p, 4] * free[f, 4] + B[p, 5] * free[f, 5]
            x[slot_row[p]] += total


@internal
def accelerations(s, y, yd):
    """V' = M^-1 (F - J^T x) into yd and, in world axes, into A; q' into yd."""
    X, A = s.X, s.A
    n_q, n_v = s.n_q, s.n_v
    for k in range(s.n_z):
        yd[n_q + n_v + k] = s.zd[k]
    if s.n_r < s.n:
        call_beams(s.on_beams[PULL], s, s.x, yd, 0)
        call_beams(s.on_beams[RATES], s, y, yd, 0)
    if s.d == 3:
        for f in range(1, s.n_r):
            a0, a1, a2 = pull_planar(s, f, s.x)
            q, v = 3 * (f - 1), n_q + 3 * (f - 1)
            yd[q], yd[q + 1], yd[q + 2] = y[v], y[v + 1], y[v + 2]
            yd[v], yd[v + 1], yd[v + 2] = a0, a1, a2
            A[f, 0], A[f, 1], A[f, 5] = a0, a1, a2
        return
    for f in range(1, s.n_r):
        a0, a1, a2, a3, a4, a5 = pull_spatial(s, f, s.x)
        q, v = 7 * (f - 1), n_q + 6 * (f - 1)
        yd[q], yd[q + 1], yd[q + 2] = y[v], y[v + 1], y[v + 2]
        yd[v], yd[v + 1], yd[v + 2], yd[v + 3], yd[v + 4], yd[v + 5] = a0, a1, a2, a3, a4, a5
        A[f, 0], A[f, 1], A[f, 2] = a0, a1, a2
        A[f, 3] = X[f, 3] * a3 + X[f, 4] * a4 + X[f, 5] * a5
        A[f, 4] = X[f, 6] * a3 + X[f, 7] * a4 + X[f, 8] * a5
        A[f, 5] = X[f, 9] * a3 + X[f, 10] * a4 + X[f, 11] * a5
        # p' = p o (0, omega) / 2 with omega in body axes
        e0, e1, e2, e3 = y[q + 3], y[q + 4], y[q + 5], y[q + 6]
        o0, o1, o2 = y[v + 3], y[v + 4], y[v + 5]
        yd[q + 3] = 0.5 * (-e1 * o0 - e2 * o1 - e3 * o2)
        yd[q + 4] = 0.5 * (e0 * o0 + e2 * o2 - e3 * o1)
        yd[q + 5] = 0.5 * (e0 * o1 + e3 * o0 - e1 * o2)
        yd[q + 6] = 0.5 * (e0 * o2 + e1 * o1 - e2 * o0)


@internal
def in_world(s, f):
    """The accelerations of a rigid body, from the axes of the solve into A."""
    X, A, a = s.X, s.A, s.free
    if s.d == 3:
        A[f, 0], A[f, 1], A[f, 5] = a[f, 0], a[f, 1], a[f, 2]
        return
    for c in range(3):
        A[f, c] = a[f, c]
        A[f, 3 + c] = (
            X[f, 3 + 3 * c] * a[f, 3] + X[f, 4 + 3 * c] * a[f, 4] + X[f, 5 + 3 * c] * a[f, 5]
        )


@compiled(AT)
def stiffnesses(s, t):
    """Stiffness and damping of the elements of beams, at the poses of the last evaluation."""
    call_all(s, s.stiffness, t)


@compiled(AT)
def gaps(s, t):
    """Penetration and its rate of every contact, at the poses of the last evaluation."""
    call_all(s, s.gaps, t)


@compiled(void(SCENE, f8, i8))
def strikes(s, t, e):
    """What an impact of a contact acts with, into `blow`, at the poses of the last evaluation."""
    call_one(s, s.strike, t, e)


@compiled(AT)
def corners(s, t):
    """Distance from the corners of every law that has some, at the poses of the last evaluation."""
    call_all(s, s.corners, t)


@compiled(float64(SCENE, A1))
def kinetic(s, y):
    """Kinetic energy, J."""
    T = 0.0
    if s.n_r < s.n:
        call_beams(s.on_beams[KINETIC], s, y, y, 0)
        T = s.moved[0, 0]
    for f in range(1, s.n_r):
        v = s.n_q + s.d * (f - 1)
        if s.d == 3:
            T += 0.5 * s.mass[f] * (y[v] * y[v] + y[v + 1] * y[v + 1])
            T += 0.5 * s.inertia[f, 8] * y[v + 2] * y[v + 2]
        else:
            T += 0.5 * s.mass[f] * (y[v] ** 2 + y[v + 1] ** 2 + y[v + 2] ** 2)
            for a in range(3):
                for b in range(3):
                    T += 0.5 * y[v + 3 + a] * s.inertia[f, 3 * a + b] * y[v + 3 + b]
    for q in range(s.light.shape[0]):  # these are solved with more than they have
        v, E = s.n_q + s.d * (s.light[q] - 1), s.lacking[q]
        if s.d == 3:
            T -= 0.5 * E[0] * (y[v] * y[v] + y[v + 1] * y[v + 1])
            T -= 0.5 * E[9] * y[v + 2] * y[v + 2]
        else:
            T -= 0.5 * E[0] * (y[v] ** 2 + y[v + 1] ** 2 + y[v + 2] ** 2)
            for a in range(3):
                for b in range(3):
                    T -= 0.5 * y[v + 3 + a] * E[1 + 3 * a + b] * y[v + 3 + b]
    return T


@compiled(float64(SCENE, f8))
def stored_energy(s, t):
    """Fill E and return its sum, J; at the poses of the last evaluation."""
    clear(s.E)
    call_all(s, s.energy, t)
    return s.E[0] + s.E[1] + s.E[2]
