"""The end of a trial step: brought to the constraints, evaluated, its work booked."""

from math import nan

from trsim.assemble.equations import constraints, corners, evaluate, kinetic, set_poses
from trsim.assemble.linear import SINGULAR, SOUND, smallest_pivot
from trsim.assemble.on_beams import WORK, call_beams
from trsim.assemble.projection import (
    CLOSED,
    DOUBTFUL,
    NEWTON,
    newton_step,
    normalise,
    project_velocities,
    put_on_rows,
    set_poses_and_rows,
)
from trsim.assemble.schur import velocity_residual
from trsim.elements.contract import SCENE, compiled
from trsim.elements.scene import NONE, PROJECTION
from trsim.kernels import signatures as types
from trsim.kernels.calls import caller
from trsim.kernels.lazy import internal
from trsim.kernels.packed import A1, f8, i8
from trsim.kernels.vectors import copy_to
from trsim.solve.march.own_rows import ends_in, keep_roots, keep_rows, look_at
from trsim.solve.march.record import BUFFERS, RECORD
from trsim.solve.march.settle import AT_END, at_rest
from trsim.solve.march.watch import see
from trsim.solve.methods.displacements import quaternion, turned_by

PHI_SMALL = 1e-10  # of the mechanism's size: the next Newton step would be below rounding
# the same: the step just made left its square, as rows tell that are not factorised again, and
# velocities are brought to them with factors of the place that far away
PHI_SQUARED, PHI_BELOW = 1e-6, 1e-12
PHI_LOST = 1e-6  # still off by so much after NEWTON steps: there is no position to come back to
ASTRAY = 0.1  # of the fastest rate: by as much velocities of another branch are others
INTERPOLATED = 10.0  # tolerances: what a state inside a step is off by
TORN = 2  # what `evaluate_inside` found
UNKNOWN = 1e-15  # of the diagonal: rounding of a pivot
NOTHING = 1e-60  # m, rad, m/s, rad/s, J: far below the rounding of anything it is added to


#                    scene  record  buffers  t   y'  rest
LAND = types.float64(SCENE, RECORD, BUFFERS, f8, A1, i8)
call_land = caller(LAND)


@compiled(LAND)
def land(s, r, b, t, yd, rest):
    """Bring y, which is b.y1, to the constraints and evaluate y' there; gaps into b.gap1.

    Returns the work done by the projection (J): the change of kinetic energy, and minus the work
    of the applied forces on the small displacement.  Where no position is found y and y' are not
    finite.  rest: more than 0 at the end of the step just made by a method that knows what is
    stiff, which comes to rest then.
    """
    y, done = b.y1, 0.0
    normalise(s, y)
    if s.stabilisation == PROJECTION and s.m > 0:
        copy_to(b.y2, y)
        first, at_hand = 0.0, False
        for k in range(NEWTON):
            worst = newton_step(s, t, y)
            if k == 0:
                first = worst
            if not worst > (PHI_SMALL if s.status[0] == SOUND else CLOSED) * s.size:
                break
            near = worst <= PHI_SQUARED * s.size and s.status[0] == SOUND
            if near and smallest_pivot(s) > DOUBTFUL:  # velocities feel little of the factors
                worst = still_open(s, t, y)
                at_hand = worst <= PHI_BELOW * s.size
                if at_hand:
                    break
        if not worst <= PHI_LOST * s.size:
            s.status[3] += 1
            y[0] = nan
        else:
            r.worst_phi = max(r.worst_phi, first)
        r.off = first
        T0 = kinetic(s, y)
        if not at_hand:
            set_poses_and_rows(s, t, y)
        worst = r.off_rate = project_velocities(s, y)
        r.worst_phi_dot = max(r.worst_phi_dot, worst)
        done += kinetic(s, y) - T0
    flush(y)
    evaluate(s, t, y, yd)
    if rest > 0:
        T0 = kinetic(s, y)
        at_rest(s, r, b, (b.P, t - b.t, AT_END), (t, y, yd))
        done += kinetic(s, y) - T0
    if s.near_rows > 0.0:
        keep_roots(s, s.root[2])
        if s.status[0] == SINGULAR:  # its factors are shifted
            look_at(s, t, y)
        keep_rows(s, ends_in(r))
    if s.stabilisation == PROJECTION and s.m > 0:
        done += position_work(s, b.y2, y)
    else:
        for k in range(s.m):
            r.worst_phi = max(r.worst_phi, abs(s.phi[k]))
            off = abs(velocity_residual(s, k))
            r.worst_phi_dot = max(r.worst_phi_dot, off)
    see(s, t, y, b.gap1, b.branch1, b.turning1)
    if s.contact.size > 0:
        corners(s, t)
        for c in range(s.contact.size):
            b.corner1[c] = s.corner[s.contact[c], 0]
    return done


@internal
def still_open(s, t, y):
    """The largest |Phi| at y, whose rows take the place of the last ones; the factors stay."""
    set_poses(s, y)
    constraints(s, t)
    worst = 0.0
    for k in range(s.m):
        worst = max(worst, abs(s.phi[k]))
    return worst


@internal
def evaluate_inside(s, r, t, y, rough):
    """y' at an interpolated y, brought to the constraints where rows depend on others, or nearly.

    With an eigenvalue of S of d^2 accelerations feel 1/d^2 times what interpolation opens rows by;
    redundant rows are held by others times their levers only.  With Baumgarte's stabilisation too:
    what interpolation opens is not drift.  Without any it would hide the drift.

    Where branches meet, nearer than interpolation is off the rows by, the nearest place on them may
    be on another branch, whose velocities are others: then y stays as it is.

    rough: y', room for y, and y' as it was before.  Returns whether y was brought there: TORN where
    it was further from there than interpolation is.
    """
    yd, kept = rough[0], rough[1]
    if r.driven > 0:  # interpolation knows no better than rows
        put_on_rows(s, t, y)
        evaluate_to_measure(s, t, y, yd)
        return 0
    evaluate(s, t, y, yd)
    if s.m == 0 or s.stabilisation == NONE:
        return 0
    past = s.status[4] > 0  # a place where branches meet: the interpolation may feel it
    if s.redundant.shape[0] == 0 and not past:
        pivot = smallest_pivot(s)
        if pivot > DOUBTFUL and not off_the_rows(s, r, pivot):
            return 0
    torn = is_torn(s, r)
    copy_to(kept, y)
    copy_to(rough[2], yd)
    put_on_rows(s, t, y)
    if s.near_rows > 0.0 and elsewhere(s, y, kept):
        copy_to(y, kept)
    evaluate_to_measure(s, t, y, yd)
    return TORN if torn else 1


@internal
def evaluate_stage(s, t, y, yd):
    """y' at a stage of the dense output alone, on the rows where these nearly depend on each other.

    No error estimate sees such a stage, and what it is off the rows by, less than the tolerance, is
    felt 1/d^2 times in accelerations.
    """
    evaluate(s, t, y, yd)
    if s.near_rows > 0.0 and s.stabilisation != NONE and smallest_pivot(s) < DOUBTFUL:
        put_on_rows(s, t, y)
        evaluate_to_measure(s, t, y, yd)


@internal
def elsewhere(s, y, kept):
    """Whether velocities were changed by what no interpolation is off by.

    Of a pivot no more is left than rounding: where that is felt more than interpolation, what it is
    off by is what velocities may change by.
    """
    felt = INTERPOLATED * s.tolerance * smallest_pivot(s) < UNKNOWN
    most, change = 0.0, 0.0
    for k in range(s.n_q, s.n_q + s.n_v):
        by = s.size if (k - s.n_q) % s.d < s.d // 2 + s.d % 2 and k - s.n_q < s.v_node else 1.0
        most, change = max(most, abs(kept[k]) / by), max(change, abs(y[k] - kept[k]) / by)
    return change > (INTERPOLATED * s.tolerance if felt else ASTRAY) * most


@internal
def evaluate_to_measure(s, t, y, yd):
    """`evaluate`; next to a place where branches meet the limit is taken by every method.

    Not at the end of a step: scipy takes differences of that derivative and others, for a Jacobian.
    """
    s.status[5] = 1
    evaluate(s, t, y, yd)
    s.status[5] = 0


@internal
def limits_to_measure(s, t, y, pivot, room):
    """Accelerations of the state y, which was evaluated last, become limits where its own are
    rounding, eps/d^3.  The step that begins there keeps its own."""
    if s.near < pivot <= s.near_rows:
        evaluate_to_measure(s, t, y, room)


@internal
def off_the_rows(s, r, share):
    """Whether the last state is off the rows by more than that share of the tolerance: a pivot,
    and it is felt beyond the tolerance.

    Stages of a long step past a place where branches meet feel what they are off the rows by.  The
    end of the step is brought back; what is interpolated is off along the other branch, and of that
    the rows see the less the nearer it is.
    """
    if s.near == 0.0 or s.stabilisation == NONE:
        return False
    allowed = s.tolerance * share / s.size
    length, speed = allowed * r.length, allowed * r.speed
    for k in range(s.m):
        if abs(s.phi[k]) > length * s.row_unit[k]:
            return True
        if abs(velocity_residual(s, k)) > speed * s.row_unit[k]:
            return True
    return False


@internal
def is_torn(s, r):
    """Whether the last state, of a dense output in a loop, is off the rows by more than
    interpolation is.

    Projection only: else the ends of steps are off them too.  Where rows are redundant what is
    measured inside steps is drawn through places around it (measure_in).
    """
    looked_at = s.near_rows > 0.0 and s.stabilisation == PROJECTION and s.redundant.shape[0] == 0
    return looked_at and off_the_rows(s, r, INTERPOLATED)


@internal
def flush(y):
    """Set to zero what no arithmetic on it can feel.

    Motion that only rounding began dies out exponentially where joints hold it; on its way below
    1e-308 every product with it costs the processor a hundred times more.
    """
    for k in range(y.size):
        if abs(y[k]) < NOTHING:
            y[k] = 0.0


@internal
def position_work(s, before, after):
    """- F . dx of the displacement from one q to another, with the forces of the second, J."""
    work, F, X = 0.0, s.F, s.X
    if s.n_r < s.n:
        call_beams(s.on_beams[WORK], s, before, after, 0)
        work -= s.moved[0, 0]
    for f in range(1, s.n_r):
        if s.d == 3:
            q = 3 * (f - 1)
            work -= F[f, 0] * (after[q] - before[q]) + F[f, 1] * (after[q + 1] - before[q + 1])
            work -= F[f, 5] * (after[q + 2] - before[q + 2])
            continue
        q = 7 * (f - 1)
        e, b = quaternion(after, q + 3), quaternion(before, q + 3)
        o = turned_by(e, (e[0] - b[0], e[1] - b[1], e[2] - b[2], e[3] - b[3]))
        for c in range(3):
            turn = X[f, 3 + 3 * c] * o[0] + X[f, 4 + 3 * c] * o[1] + X[f, 5 + 3 * c] * o[2]
            work -= F[f, c] * (after[q + c] - before[q + c]) + F[f, 3 + c] * turn
    return work
