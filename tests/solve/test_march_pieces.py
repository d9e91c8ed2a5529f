"""Pieces of the march, each by itself: as plain Python, with others for what they call."""

from math import cos, inf, log, nan, pi, sin
from types import SimpleNamespace

import numpy as np
import pytest

from trsim.assemble.travel import RATE_OF
from trsim.elements.contract import FLIGHT
from trsim.solve.march import record as rec
from trsim.solve.march import sections, sensed
from trsim.solve.march.complete import BEYOND, accept, leaked
from trsim.solve.march.corners import NONE
from trsim.solve.march.dense_output import measure_in
from trsim.solve.march.land import evaluate_inside
from trsim.solve.march.loop import next_step
from trsim.solve.march.norm import grow
from trsim.solve.march.openings import closed
from trsim.solve.march.openings import look as look_at_openings
from trsim.solve.march.own_rows import own
from trsim.solve.march.phases import evaluate_all
from trsim.solve.march.poles import first_of, met, root, unbounded
from trsim.solve.march.polynomials import factors, one_way
from trsim.solve.march.rounding import APART, remember
from trsim.solve.march.spread_rates import moved_apart
from trsim.solve.march.turns import fastest_in_loops, pulse
from trsim.solve.methods import dop853_tableau, radau_tableau

from ..pieces import nothing, piece


def test_own_rows_see_through_those_that_have_no_part():
    """d of the last row is e^T L^-1 B, though the one before it depends on nothing."""
    s = SimpleNamespace(
        r2=np.zeros(3), r=np.zeros(3), own=np.zeros((2, 6)), row=np.array([0, 2, 1, 2]),
        column_start=np.array([0, 2, 3, 4]), kept_factors=np.array([[1.0, 0.5, 1.0, 1.0]]),
        kept_rows=np.arange(1.0, 7.0)[None], n_r=2, hub=np.array([-1, -1]), d=3,
        frame_start=np.array([0, 0, 2]), slot_row=np.array([0, 2]),
    )  # fmt: skip
    piece(own)(s, 0, 2, 0)
    L = np.eye(3)
    L[2, 0] = 0.5
    B = np.vstack([s.kept_rows[0, :3], np.zeros(3), s.kept_rows[0, 3:]])
    assert s.own[0, 3:] == pytest.approx(np.linalg.solve(L, B)[2])


def test_a_force_that_is_chance_is_that_of_places_around_it():
    """On the polynomial through places beside it, each looked at where its time is."""
    start, h, p = 3.0, 0.4, np.polynomial.Polynomial([1.0, -2.0, 0.5, 0.3])
    s = SimpleNamespace(tolerance=1e-6, redundant=np.zeros((1, 2)), n_out=1, shared=np.array([0]))
    s.out = np.zeros(1)
    b = SimpleNamespace(mean=np.zeros((2, 1)), firm=np.zeros(3))

    def measure_at(s, r, b, step, time, theta):
        s.theta = theta
        s.out[0] = p(time) + (100.0 if theta == 0.5 else 0.0)

    alone = piece(
        measure_in, either_step=lambda *_: (None, None, start), measure_at=measure_at,
        firmness_of_extremes=lambda s: 1.0,
        smallest_pivot=lambda s: 0.0 if s.theta == 0.5 else 1.0,
        firmness_of_all=lambda s, pivot: pivot,
    )  # fmt: skip
    at = start + 0.5 * h
    alone(s, None, b, 0, at, 0.5)
    assert s.out[0] == pytest.approx(p(at), rel=1e-9)


@pytest.mark.parametrize(
    "turning, node, fastest", [(-3.0, 1.0, 3.0), (0.5, -20.0, 10.0), (0.5, 0.1, 1.0)]
)
def test_the_fastest_in_loops_whichever_way_it_goes(turning, node, fastest):
    s = SimpleNamespace(d=6, n_q=7, looped=np.array([1]), v_node=6, n_v=8, size=2.0)
    y = np.array([0.0] * 7 + [1.0, -2.0, 0.5, 0.1, turning, 0.2, 0.3, node])
    assert piece(fastest_in_loops)(s, y) == pytest.approx(fastest)


@pytest.mark.parametrize("implicit", [0, 1])
def test_no_pulse_is_lost_between_the_stages_of_the_longest_step(implicit):
    """Some stage sees a quarter of 1/(1 + u^2) at least, wherever the pulse is in the step."""
    c = radau_tableau.C if implicit else dop853_tableau.C[:12]
    u = np.linspace(0.0, 1.0, 1001)[:, None] - np.append(np.ravel(c), [0.0, 1.0])
    widest = np.abs(u).min(axis=1).max() * BEYOND * piece(pulse)(implicit)
    assert 1.0 / (1.0 + widest**2) > 0.25


def of_poles(kind=0, **more):
    """A step of length 1 that one u is followed in."""
    s = SimpleNamespace(pole=np.full((1, 8), kind))
    r = SimpleNamespace(branch=np.array([1.0, 2.0]), turning=np.array([3.0, 4.0]))
    b = SimpleNamespace(
        pole_first=np.zeros((2, 2)), pole_last=np.zeros((2, 2)), branch1=np.array([5.0, 6.0]),
        turning1=np.array([7.0, 8.0]), t=0.0, t1=1.0, h=1.0, built=1, **more,
    )  # fmt: skip
    return s, r, b


def test_a_step_is_clear_of_poles_from_what_sensors_show_at_both_ends():
    s, r, b = of_poles()
    seen = []

    def clear(s, b, what, part):
        seen.append((b.pole_first.copy(), b.pole_last.copy(), part))
        return True

    found = piece(first_of, began=lambda *_: 0.0, clear=clear)(s, r, b, None, 0)
    assert found == NONE
    ((first, last, part),) = seen
    assert first.tolist() == [[1.0, 3.0], [2.0, 4.0]] and part == (0.0, 1.0)
    assert last.tolist() == [[5.0, 7.0], [6.0, 8.0]]


def test_the_first_of_many_zeros_in_a_step_is_met():
    """cos 30 t, from bounds of its range, is looked at in parts that have one of them."""
    s, r, b = of_poles()

    def clear(s, b, what, part):
        middle, half = 0.5 * (part[0] + part[1]), 0.5 * (part[1] - part[0])
        return abs(cos(30.0 * middle)) > 30.0 * half

    def u_at(s, r, b, what, theta):
        return cos(30.0 * theta)

    sought = piece(met, u_at=u_at, root=piece(root, u_at=u_at))
    alone = piece(
        first_of, began=lambda *_: 0.0, clear=clear, look=nothing, met=sought,
        unbounded=lambda *_: True,
    )  # fmt: skip
    assert alone(s, r, b, None, 0) == pytest.approx(pi / 60.0, abs=1e-9)


@pytest.mark.parametrize(
    "f, grows",
    [
        (lambda u: 1.0 / u, True),
        (lambda u: sin(u) / u, False),
        (lambda u: 1.0, False),
        (lambda u: log(u) if u > 0.0 else nan, True),
        (lambda u: 2.0 if u > 0.0 else inf, True),
    ],
)
def test_a_function_is_without_bound_where_it_grows_as_1_over_u_or_is_no_number(f, grows):
    s, r, b = of_poles()
    alone = piece(unbounded, function_at=lambda s, r, b, what, theta: np.float64(f(theta - 0.5)))
    assert alone(s, r, b, (0, 0.0), 0.5) == grows


def test_a_dip_below_zero_is_two_crossings_where_it_is_lowest():
    """(t - 0.52)^2 - 0.0001, looked at in tenths of a step: none sees it below zero."""
    f = np.polynomial.Polynomial([0.52**2 - 1e-4, -1.04, 1.0])
    s = SimpleNamespace(section=np.zeros((1, 32), int))
    r = SimpleNamespace(section=np.zeros((1, 32)))
    r.section[0, rec.LAST], r.section[0, rec.ON] = f(0.0), 1.0
    b = SimpleNamespace(t=2.0, t1=3.0, h=1.0, out=np.full(1, f(1.0)))
    looked, found = [], []

    def dip(s, r, b, what, side, places):
        looked.append([x[0] for x in places])
        return 0.52

    alone = piece(
        sections.crossings, resolution=lambda b: 0.0, dip=dip, swung=nothing,
        value=lambda s, r, b, what, theta: f(theta), inner=lambda s, r, b, k, place: f(place[2]),
        crossed=lambda s, r, b, k, ends, side: found.append(([x[0] for x in ends], side)),
    )  # fmt: skip
    alone(s, r, b, 0, 10)
    assert looked == [pytest.approx([0.4, 0.5, 0.6])]
    assert found == [(pytest.approx([0.4, 0.52]), -1.0), (pytest.approx([0.52, 0.6]), 1.0)]


@pytest.mark.parametrize("whose", [0, 1])
def test_whichever_contact_is_first_touches(whose):
    s = SimpleNamespace(contact=np.array([4, 7]))
    b = SimpleNamespace(root=np.array([NONE, NONE]), corner_root=np.array([NONE, NONE]))
    alone = piece(sections.touches, Memory=lambda r, e: SimpleNamespace(phase=FLIGHT))
    b.root[whose] = 0.3
    assert alone(s, None, b, s.contact[whose])
    assert not alone(s, None, b, s.contact[1 - whose])
    b.corner_root[1] = 0.2
    assert not alone(s, None, b, s.contact[whose])


@pytest.mark.parametrize("redundant, moved", [(0, False), (1, True)])
def test_an_interpolated_place_is_brought_to_rows_that_others_depend_on(redundant, moved):
    s = SimpleNamespace(m=2, stabilisation=1, status=np.zeros(5, int), near_rows=0.0)
    s.redundant = np.zeros((redundant, 2))
    y, rough = np.ones(3), np.zeros((3, 3))

    def put_on_rows(s, t, y):
        y[:] = 2.0

    alone = piece(
        evaluate_inside, NONE=0, evaluate=nothing, smallest_pivot=lambda s: 1.0,
        off_the_rows=lambda *_: False, put_on_rows=put_on_rows, evaluate_to_measure=nothing,
    )  # fmt: skip
    assert alone(s, SimpleNamespace(driven=0), 0.0, y, rough) == moved
    assert y.tolist() == [2.0 if moved else 1.0] * 3


@pytest.mark.parametrize("opening, changed", [(1e-12, 0), (3e-7, 1), (1e-3, 1)])
def test_openings_below_what_is_told_leave_the_state(opening, changed):
    s = SimpleNamespace(m=1, redundant=np.zeros((1, 2), int))
    r = SimpleNamespace(
        worst_open=0.0, worst_open_rate=0.0, apart=0.0, apart_t=0.0, opened=0, open_row=-1,
        open_index=-1,
    )  # fmt: skip
    b = SimpleNamespace(y1=np.ones(2), y2=np.zeros(2))
    alone = piece(
        look_at_openings, look_at_pivots=nothing, opening=lambda *_: opening,
        rate=lambda *_: 0.0, closed=lambda *_: 0.0,
    )  # fmt: skip
    assert alone(s, r, b, SimpleNamespace(held_to=1e-5), 0.5, 1) == changed
    assert b.y2[0] == changed and r.worst_open == opening and r.opened == (opening > 1e-5)


def test_what_is_counted_is_of_the_run_not_of_looking_at_rows():
    s = SimpleNamespace(status=np.array([1, 2, 3, 4, 50]), size=1.0, m=2)

    def close_positions(s, *_):
        s.status += 10

    alone = piece(
        closed, close_positions=close_positions, set_poses=nothing, constraints=nothing,
        opening=lambda s, row: 0.1 * row,
    )  # fmt: skip
    assert alone(s, 0.0, None) == pytest.approx(0.1)
    assert s.status[:4].tolist() == [1, 2, 3, 4]


def test_a_sensor_that_left_its_piece_is_seen_at_the_end_of_the_part():
    s = SimpleNamespace(feature=np.zeros((1, 16), int), held=np.array([0]), tab=np.array([1.0]))
    s.feature[0, sensed.SENSED] = s.feature[0, sensed.HELD_TO] = 1
    b = SimpleNamespace(met=np.full((1, 8), NONE), t=0.0, h=1.0)
    at = SimpleNamespace(theta=0.0)

    def show(s, r, b, theta):
        at.theta = theta

    alone = piece(
        sensed.roots, show=show, sensed=lambda *_: True, FREE=-7.0,
        corner_at=lambda *_: (3.0 * at.theta, 0.0, 0.0), ends_of=lambda *_: (-1.0, 1.0),
        root=lambda *_: 1.0 / 3.0, neighbour=lambda *_: 5,
    )  # fmt: skip
    assert alone(s, None, b, 0.0, 0.25) == NONE
    assert alone(s, None, b, 0.25, 0.5) == pytest.approx(1.0 / 3.0)


def test_nothing_is_taken_for_the_fastest_that_a_place_goes():
    """Of a place there are bounds of how it bends: its rate is not held to a number."""
    s = SimpleNamespace(feature=np.zeros((0, 4), int), sensed=np.zeros((1, 8), int))
    s.S, s.status = np.full((1, 2), 30.0), np.zeros(5, int)
    s.sensed[0, sensed.KIND] = RATE_OF - 1
    b = SimpleNamespace(
        met=np.zeros((0, 4)), shown=np.zeros((1, 2)), seen=np.zeros((1, 4)), h=1.0, t=0.0, built=0,
    )  # fmt: skip
    method = np.ones(64, int)
    alone = piece(
        sensed.corners_ahead, spread_at_stages=lambda *_: (40.0, 8.0),
        verdict=lambda *_: sensed.CLEAR,
    )  # fmt: skip
    r = SimpleNamespace(sight=np.array([10.0]))
    assert alone(s, r, b, None, method) == NONE
    assert b.seen[0] == pytest.approx([9.0, 31.0, 16.0, 24.0])


@pytest.mark.parametrize("before, after", [(1.0, 1.0), (1.0, 0.02), (0.02, 1.0)])
def test_energy_leaks_by_what_the_tolerance_allows_of_the_larger_one(before, after):
    s = SimpleNamespace(n_out=1, out=np.zeros(1))
    r = SimpleNamespace(y=before, work_projection=0.0, energy_0=0.0)
    setting = SimpleNamespace(fixed_step=0.0, t_end=1.0, step_error=1e-4)
    alone = piece(leaked, kinetic=lambda s, y: y, measure=nothing)
    for lost, found in ((1e-6, False), (1e-3, True)):
        b = SimpleNamespace(y1=after, h=0.1, projected=0.0, t1=0.1, out=np.array([lost]))
        assert alone(s, r, b, setting) == found


def test_a_touch_that_was_accepted_is_known_to_the_norm():
    """The deepest one met so far, of what is in touch."""
    s = SimpleNamespace(
        status=np.zeros(5, int), contact=np.array([0, 1]), wanted=np.array([-1, -1]),
        column_energy=-1, near_rows=0.0,
    )  # fmt: skip
    r = SimpleNamespace(
        t=0.0, y=np.zeros(1), yd=np.zeros(1), gap=np.zeros((2, 2)), corner=np.zeros(2),
        branch=np.zeros(1), turning=np.zeros(1), steps=0, same_time=0, work_projection=0.0,
        impact=np.array([1e-4, 1e-4]),
    )  # fmt: skip
    b = SimpleNamespace(
        t1=0.1, firm=np.zeros(3), projected=0.0, y1=np.zeros(1), K=np.zeros((1, 1)),
        gap1=np.array([[3e-4, 0.0], [-1.0, 0.0]]), corner1=np.zeros(2), branch1=np.zeros(1),
        turning1=np.zeros(1), steps=np.zeros((4, 2)),
    )  # fmt: skip
    touching = SimpleNamespace(phase=FLIGHT + 1)
    alone = piece(accept, Memory=lambda r, e: touching, grow=piece(grow, units=nothing))
    alone(s, r, b, 0)
    assert r.t == 0.1 and r.impact.tolist() == [3e-4, 1e-4]


@pytest.mark.parametrize("calm, h", [(0.01, 0.01), (100.0, 1.0)])
def test_a_step_is_held_to_where_vibrations_die_out(calm, h):
    none = np.zeros(0)
    s = SimpleNamespace(
        section=none, heard=none, wound=none, looped=none, judged=none, pulse=none
    )  # fmt: skip
    r = SimpleNamespace(after_rejection=0, h=1.0, t=0.0, vibration=1.0)
    setting = SimpleNamespace(t_end=50.0, at_rows=0, h_max=20.0, every=1.0, fixed_step=0.0)
    alone = piece(
        next_step, next_instant=lambda *_: 50.0, longest_calm=lambda r: calm
    )  # fmt: skip
    b = SimpleNamespace(rows=np.zeros((1024, 1)))
    assert alone(s, r, b, setting, np.ones(64, int)) == h


def test_the_branches_of_all_contacts_are_taken_over():
    s = SimpleNamespace(
        rated=np.zeros((0, 2)), feature=np.zeros((0, 2)), contact=np.array([2, 0]),
        corner=np.array([[5.0], [6.0], [7.0]]),
    )  # fmt: skip
    r = SimpleNamespace(corner=np.zeros(2), y=0, yd=0, gap=0, branch=0, turning=0)
    alone = piece(evaluate_all, evaluate=nothing, see=nothing, look=nothing, corners=nothing)
    alone(s, r, SimpleNamespace(locate=1), 0.0)
    assert r.corner.tolist() == [7.0, 5.0]


def test_noise_that_is_not_seen_again_is_forgotten():
    """In time, without a look: less and less of it."""
    r = SimpleNamespace(
        longest=0.0, noisy=1.0, rounded=1e9, passing=0.0, noise=np.ones(2), steps=0, looked=0
    )  # fmt: skip
    alone = piece(remember, largest=nothing)
    for steps in range(1, 10 * APART + 1):
        r.steps = steps
        alone(SimpleNamespace(), r, None, 1e-3)
    assert np.all(r.noise < 0.01)


def test_how_fast_two_points_part_between_control_points():
    """Rates of their Bernstein polynomials never exceed the bounds, and these are near."""
    net = np.array([[0.0, 0.0, 1.0], [0.0, 1.5, 1.0], [0.0, 1.0, 3.0], [0.0, 4.0, 2.0]])
    s, b = SimpleNamespace(d=3), SimpleNamespace(curve=net[:, 1:])
    length = 0.5
    once, twice = piece(moved_apart)(s, b, 4, (0, 1, 0), length)
    t, d1 = np.linspace(0.0, 1.0, 101)[:, None], np.diff(net[:, 1:], axis=0)
    d2 = np.diff(d1, axis=0)
    rate = 3.0 / length * ((1 - t) ** 2 * d1[0] + 2.0 * t * (1 - t) * d1[1] + t**2 * d1[2])
    bend = 6.0 / length**2 * ((1 - t) * d2[0] + t * d2[1])
    for bound, real in ((once, rate), (twice, bend)):
        most = np.sqrt((real**2).sum(axis=1)).max()
        assert most * (1.0 - 1e-12) <= bound <= 1.5 * most


def test_factors_are_bounds_of_products_of_distances():
    """Of those from all nodes but the first two, too: nodes far apart make them larger."""
    times, size = np.array([0.0, 1.0, -3.0, 5.0, 9.0]), np.zeros(5)
    piece(factors)(times, size, 5)
    t = np.linspace(0.0, 1.0, 201)
    for k in range(2, 5):
        most = np.abs(np.prod([t - x for x in times[:k]], axis=0)).max()
        assert most * (1.0 - 1e-12) <= size[k] <= 4.0 * most


@pytest.mark.parametrize("doubt, goes", [(0.0, True), (5.0, False)])
def test_what_may_bend_does_not_plainly_go_one_way(doubt, goes):
    node = np.zeros((5, 3))
    node[0], node[2] = [0.0, 1.0, 0.5], [0.0, 1.0, 0.01]
    assert piece(one_way)(SimpleNamespace(node=node, doubt=doubt), 3) == goes
