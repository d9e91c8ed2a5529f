"""The dense output of a step, built when something asks for it."""

from trsim.assemble.equations import constraints, evaluate, set_poses
from trsim.assemble.least_norm import firmness_of_all
from trsim.assemble.linear import smallest_pivot
from trsim.assemble.outputs import measure
from trsim.elements.contract import SCENE, compiled
from trsim.kernels import signatures as types
from trsim.kernels.calls import caller
from trsim.kernels.lazy import internal
from trsim.kernels.packed import f8, i8
from trsim.kernels.vectors import clear_table, copy_to
from trsim.solve.march.accelerations import RUN, untouched
from trsim.solve.march.calls import DENSE_AT, LAST_AT, call_dense, call_interpolate
from trsim.solve.march.earlier import either_step
from trsim.solve.march.land import TORN, evaluate_inside, is_torn
from trsim.solve.march.record import BUFFERS, RECORD
from trsim.solve.march.samples import firmness_of_extremes
from trsim.solve.march.settle import answered, at_rest

# rows are closed to rounding, which is felt 1 / pivot^1.5 times in what they share
NOISE, PLAIN = 1e-12, 1e-2  # 100 times that; a pivot that always serves
NEAREST, FURTHEST = 1e-3, 0.1  # of a step
ASIDE = 1e-4  # of a step: between what rates are taken
# a pivot at the end of a step, far above that of any by which rows inside were 5 tolerances off
# [2e-5, of 62,397 steps of drawn mechanisms], and parts of the step: where that is looked at
SHARP, PARTS = 1e-4, 4
ASTRAY = 0.01  # of the largest acceleration so far: what is off by more says nothing of it
# weights of values at 1, 2 and 3 times a distance to either side
OF_FOUR, OF_SIX = (0.0, 2.0 / 3.0, -1.0 / 6.0, 0.0), (0.0, 0.75, -0.3, 0.05)

#                        scene  record  buffers earlier at theta
MEASURE_IN = types.void(SCENE, RECORD, BUFFERS, i8, f8, f8)
call_measure_in = caller(MEASURE_IN)


@internal
def build(s, r, b, method):
    """The dense output of the step at hand, into b.P, and count it."""
    fill(s, r, b, method)
    r.dense_built += 1
    b.built = 1


@internal
def fill(s, r, b, method):
    """The dense output of the step at hand, into b.P.

    Where its end was moved on along its tangent it is that of the end as it was before: no stage
    has moved with it.
    """
    copy_to(b.ends[0], r.y)
    copy_to(b.ends[1], b.unmoved[0] if b.moved > 0 else b.y1)
    if b.moved > 0:
        last = b.K[method[LAST_AT]]
        copy_to(b.unmoved[2], last)
        copy_to(last, b.unmoved[1])
        call_dense(method[DENSE_AT], s, b.K, b.t, b.h, b.ends, b.P)
        copy_to(last, b.unmoved[2])
    else:
        call_dense(method[DENSE_AT], s, b.K, b.t, b.h, b.ends, b.P)


@internal
def move_end(b, last, late):
    """Move the end of the step back by `late` s along its tangent; `build` knows where it was."""
    copy_to(b.unmoved[0], b.y1)
    copy_to(b.unmoved[1], b.K[last])
    b.moved = 1
    for i in range(b.y1.size):
        b.y1[i] -= late * b.K[last, i]


@internal
def measure_inside(s, r, b, at, theta):
    """`measure_in` of the step at hand."""
    call_measure_in(b.measure_in, s, r, b, 0, at, theta)


@internal
def torn_from_rows(s, r, b, method):
    """Whether the dense output of the step just landed is none of the motion.

    Where branches nearly meet the motion turns sharply.  A step that ends in the turn is brought to
    its rows, where velocities and accelerations are others than those that its stages saw: no
    estimate of its error knows of them, and the dense output is a polynomial through both.  It is
    off the rows by more than interpolation is.
    """
    if s.near_rows == 0.0 or s.redundant.shape[0] > 0:
        return False
    if r.driven > 0 or smallest_pivot(s) > SHARP:
        return False
    if b.built == 0:
        build(s, r, b, method)
    torn = False
    for k in range(1, PARTS):
        call_interpolate(b.interpolate, b.P, r.y, k / PARTS, b.y2)
        set_poses(s, b.y2)
        constraints(s, b.t + k / PARTS * b.h)
        torn = torn or is_torn(s, r)
    evaluate(s, b.t1, b.y1, b.rough[0])
    return torn


@internal
def astray(s, r, b, setting, earlier, theta):
    """Whether the forces measured last, at theta of a step in touch or with friction in joints, are
    none of the motion: its accelerations there are not the rates of what is interpolated.

    What dies out faster than a step, as sliding does in the ramp of friction, is right at its end
    long before it is right inside.
    """
    if untouched(s, r) and s.rubbing.shape[0] == 0:
        return False
    y, P, _, _, _ = either_step(r, b, earlier)
    h = r.earlier_h if earlier else b.h
    low, high = max(theta - ASIDE, 0.0), min(theta + ASIDE, 1.0)
    call_interpolate(b.interpolate, P, y, low, b.rough[1])
    call_interpolate(b.interpolate, P, y, high, b.rough[2])
    allowed = max(ASTRAY, RUN * setting.tolerance) * r.top_acceleration
    for c in range(s.n_q, s.n_q + s.v_node):
        rate = (b.rough[2, c] - b.rough[1, c]) / ((high - low) * h)
        if s.scale[c] * abs(rate - b.rough[0, c]) > allowed:
            return True
    return False


@compiled(MEASURE_IN)
def measure_in(s, r, b, earlier, at, theta):
    """All channels at the time `at`, theta of a step, into s.out; the state is in b.y2.

    earlier: 1 in the step that was kept, 0 in the one at hand (earlier.py).  Where some rows are
    redundant, those of the solve may depend on each other at a place where all of them together do
    not: what is shared between them is chance there.  A force is then that of the polynomial
    through six places around it, unless its own value is nearer to that than the one through four
    is.
    """
    step = either_step(r, b, earlier)
    measure_at(s, r, b, step, at, theta)
    b.firm[0] = firmness_of_extremes(s)
    if s.redundant.shape[0] == 0 or theta == 0.0:
        return
    least = min(PLAIN, (NOISE / s.tolerance) ** (2.0 / 3.0))
    if not firmness_of_all(s, smallest_pivot(s)) < least:
        return
    start, apart = step[2], NEAREST
    while apart < FURTHEST:
        nearest = 1.0
        for side in (-1, 1):
            beside = theta + side * apart
            time = start + (at - start) * (beside / theta)
            measure_at(s, r, b, step, time, beside)
            nearest = min(nearest, firmness_of_all(s, smallest_pivot(s)))
        if nearest >= least:
            break
        apart *= 2.0
    clear_table(b.mean)
    for k in range(-3, 4):
        if k == 0:
            continue
        beside = theta + k * apart
        time = start + (at - start) * (beside / theta)
        measure_at(s, r, b, step, time, beside)
        for c in range(s.n_out):
            b.mean[0, c] += OF_FOUR[abs(k)] * s.out[c]
            b.mean[1, c] += OF_SIX[abs(k)] * s.out[c]
    measure_at(s, r, b, step, at, theta)
    for c in s.shared:
        rough, fine = b.mean[0, c], b.mean[1, c]
        if abs(s.out[c] - fine) > abs(fine - rough):
            s.out[c] = fine


@internal
def measure_at(s, r, b, step, at, theta):
    """All channels at the place itself, wherever the polynomial through others would be taken."""
    y, P, start, work, projected = step
    call_interpolate(b.interpolate, P, y, theta, b.y2)
    moved = evaluate_inside(s, r, at, b.y2, b.rough)
    b.torn = int(moved == TORN)
    if b.rate == 0 and moved > 0:
        answered(s, r, b.rough[0], b.rough[2])
    if b.rate > 0 and theta > 0.0:
        place = (P, (at - start) / theta, theta)
        at_rest(s, r, b, place, (at, b.y2, b.rough[0]))
    measure(s, at, b.y2, work + theta * projected, r.energy_0)
