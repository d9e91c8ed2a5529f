"""Pieces of what goes on around steps, and of methods, each by itself."""

from types import SimpleNamespace

import numpy as np
import pytest
from scipy.interpolate import BPoly
from scipy.spatial.transform import Rotation

from trsim.elements.contract import CONTACT, FLIGHT, N_BOOK
from trsim.solve import outcome, simulate
from trsim.solve.march import act, anew, impacts, load_steps, settle
from trsim.solve.march import record as rec
from trsim.solve.methods import dop853, generalized_alpha, scipy_ivp
from trsim.solve.methods.displacements import turn
from trsim.solve.methods.ggl_jacobian import sparse_jacobian

from ..pieces import nothing, piece


def test_what_flies_on_after_an_impact_has_no_speed_of_one(monkeypatch):
    """One of two contacts parts, the other one rests from now on."""
    memories = [SimpleNamespace(phase=CONTACT, impact_speed=3.0) for _ in range(2)]
    own = SimpleNamespace(slowest_impact=1e-3, stiffness=1e9, exponent=1.5, mass=1.0)
    for name, stand_in in {
        "poses": nothing, "gaps": nothing, "ContactNumbers": lambda *_: own,
        "Memory": lambda r, e: memories[e], "note_event": SimpleNamespace(python=nothing),
    }.items():  # fmt: skip
        monkeypatch.setattr(impacts, name, stand_in)
    work = SimpleNamespace(gap=np.array([[0.0, -0.5], [0.0, 0.0]]))
    r = SimpleNamespace(y=None, struck=np.array([1, 1]), events=0)
    alone = SimpleNamespace(work=work, r=r, b=None, t=0.2, found=[(0, 0), (1, 1)])
    impacts._Striking.parted(alone, SimpleNamespace(fixed_step=0.1, step_error=1e-6))
    assert (memories[0].phase, memories[0].impact_speed) == (FLIGHT, 0.0)
    assert (memories[1].phase, memories[1].impact_speed) == (CONTACT, 1e-3)
    assert r.events == 1 and not r.struck.any()


def test_the_work_of_a_change_is_in_the_line_of_its_event(monkeypatch):
    r = SimpleNamespace(t=0.5, event_rows=1, gap=np.zeros((1, 2)), watch=np.zeros((1, 32)))
    b = SimpleNamespace(events=np.zeros((4, rec.N_EVENT)), out=np.zeros(1))
    event = SimpleNamespace(role="", kind=-1, record=False, end=None, leads=-1)

    def noted(r, b, *_):
        r.event_rows += 1

    monkeypatch.setattr(act, "note_event", SimpleNamespace(python=noted))
    work = SimpleNamespace(contact=np.zeros(0), n_out=1)
    monkeypatch.setattr(act, "turned", lambda *_: (work, 7.0, "jump"))
    switches = SimpleNamespace(events=[event])
    mechanism = SimpleNamespace(instances=[], stages=SimpleNamespace(switches=switches))
    run = act._Acting(mechanism, work, r, b, None)
    assert run.happen(0) == -1 and run.jumps == ["jump"]
    assert b.events[:, rec.EVENT_WORK].tolist() == [0.0, 7.0, 0.0, 0.0]


def test_a_phase_is_over_when_nothing_moved_for_as_long_as_asked_for(monkeypatch):
    """Neither before nor much later: looks are a part of that time apart."""
    monkeypatch.setattr(load_steps, "at_rest", lambda *_: True)
    event = SimpleNamespace(lasts=2.0)
    work = SimpleNamespace(contact=np.zeros(0), watch_at=np.zeros((1, 8)))
    r = SimpleNamespace(t=0.0, watch=np.zeros((1, 32)), gap=np.zeros((1, 2)))
    while not load_steps.look(work, r, 0, event):
        r.t = r.watch[0, rec.DUE]
    assert 2.0 * (1.0 - 1e-12) <= r.t <= 2.0 + 2.0 / load_steps.LOOKS


@pytest.mark.parametrize("same", [True, False])
def test_a_record_put_back_knows_nothing_of_rows_from_before(monkeypatch, same):
    monkeypatch.setattr(anew, "same", lambda *_: same)
    monkeypatch.setattr(anew, "carried", lambda work, model: (work, model))
    choice = SimpleNamespace(dropped=[4], model="other")
    stages = SimpleNamespace(left_out=lambda _: np.array([0, 1]), choice=lambda *_: choice)
    r = SimpleNamespace(stage=None, left_out=np.array([1, 0]), kept=2)
    found = anew.resumed(SimpleNamespace(stages=stages), "scene", r)
    assert found == ("scene" if same else ("scene", "other")) and r.kept == 0


@pytest.mark.parametrize("pulled, held", [(3.0, 5.0), (5.0, 3.0)])
def test_the_energy_of_what_is_locked_goes_with_its_largest_force(monkeypatch, pulled, held):
    monkeypatch.setattr(outcome, "largest_reaction", lambda _: held)
    work = SimpleNamespace(
        n_v=3, m=3, column_energy=0, F=np.full((2, 6), -pulled), size=2.0, mass=np.ones(2)
    )
    r = SimpleNamespace(peak=np.zeros((4, 32)))
    assert outcome.of_what_is_locked(r, work, SimpleNamespace(speed=0.0)) == 10.0


@pytest.mark.parametrize("fixed, told", [(1e-3, True), (0.0, False)])
def test_only_a_step_that_was_asked_for_is_said_to_be_too_long(monkeypatch, fixed, told):
    for name, found in {
        "undecided": (None, ""),
        "unshown": "",
        "why": "",
        "on_a_corner": "",
    }.items():
        monkeypatch.setattr(simulate, name, lambda *_, found=found: found)
    scenario = SimpleNamespace(solver=SimpleNamespace(max_steps=100))
    mechanism = SimpleNamespace(in_stage=lambda *_: None)
    work = SimpleNamespace(status=np.zeros(9, int), out=np.zeros(1))
    r = SimpleNamespace(stage=None, left_out=None, t=0.0, y=np.zeros(1))
    setting = SimpleNamespace(fixed_step=fixed)
    status, text = simulate.ending(rec.NOT_FINITE, setting, scenario, mechanism, work, r)
    too_long = simulate.REASONS[simulate.STEP_TOO_LARGE].format(100)
    assert status == "failed" and (text == too_long) == told


def test_a_state_that_lags_behind_comes_to_rest_with_what_drives_it():
    """A' = J y of two rates and a state behind them, which the method knows by half."""
    n = 2 + N_BOOK + 1
    own, J = [0, 1, n - 1], np.array([[-3.0, 1.0, 0.0], [2.0, -5.0, 0.0], [1.0, 2.0, -4.0]])
    half = np.diag([-6.0, -9.0, -4.0])
    s = SimpleNamespace(
        n_q=0, n_v=2, v_node=2, n_z=N_BOOK + 1, m=0, scale=np.ones(2), tolerance=1e-6, size=1.0
    )
    K = np.full((5 + 2 * settle.CHANGES_KEPT + 1, n), np.nan)
    K[settle.SLOW] = 0.0
    b = SimpleNamespace(tried=K, soften=0, weight=np.ones(n))

    def soften(_, s, r, b, change):
        change[own] = np.linalg.solve(np.eye(3) - half, change[own])
        return 1.0

    def evaluate(s, t, y, yd):
        yd[own] = J @ y[own]

    others = {"call_soften": soften, "onto_rows": nothing, "normalise": nothing}
    remaining = piece(settle.remaining, onto_rows=nothing)
    next_change = piece(settle.next_change, call_soften=soften)
    alone = piece(
        settle.solved, evaluate=evaluate, remaining=remaining, next_change=next_change,
        apart=lambda s, yd, f, rate: np.abs(f * yd - rate).max(),
        largest=lambda s, left, least: np.abs(left).max(), **others,
    )  # fmt: skip
    y, yd = np.zeros(n), np.zeros(n)
    y[own] = first = np.array([1.0, -2.0, 0.7])
    evaluate(s, 0.0, y, yd)
    rest, _ = alone(s, None, b, 0.5, (0.0, y, yd), 1e-9)
    assert rest < 1e-9
    np.testing.assert_allclose(y[own], np.linalg.solve(np.eye(3) - J, first), atol=1e-8)


def test_control_points_are_those_of_the_dense_output_and_no_more():
    """Of its own degree: the last difference of them is not zero."""
    P, y = np.random.default_rng(2).normal(size=(dop853.DENSE_ROWS, 3)), np.zeros(3)
    net = np.zeros((dop853.DENSE_DEGREE + 1, 3))
    piece(dop853.control)(P, net)
    for theta in (0.0, 0.3, 0.8):
        piece(dop853.interpolate)(P, y, theta, y_at := np.zeros(3))
        whole = BPoly(net[:, None, :], [0.0, 1.0])(theta)
        assert whole - net[0] == pytest.approx(y_at, abs=1e-12)
    assert np.abs(np.diff(net, n=len(net) - 1, axis=0)).min() > 1e-3


def test_generalized_alpha_hands_on_the_rates_it_began_with():
    rng, P = np.random.default_rng(5), np.zeros((generalized_alpha.DENSE_ROWS, 4))
    K, ends = rng.normal(size=(generalized_alpha.STAGES, 4)), rng.normal(size=(2, 4))
    piece(generalized_alpha.dense)(None, K, 0.0, 0.1, ends, P)
    assert P[generalized_alpha.BEFORE].tolist() == K[0].tolist()
    assert P[generalized_alpha.FILTERED].tolist() == K[generalized_alpha.B1].tolist()


@pytest.mark.parametrize("by", [(0.3, 0.0, 0.0), (0.0, -0.4, 0.0), (0.0, 0.0, 0.5), (1, -2, 0.7)])
def test_a_quaternion_is_turned_in_body_axes(by):
    before = Rotation.from_rotvec([0.2, -0.5, 0.9])
    y = before.as_quat(scalar_first=True)
    piece(turn)(y, y1 := np.zeros(4), 0, *map(float, by))
    after = (before * Rotation.from_rotvec(by)).as_quat(scalar_first=True)
    assert y1 * np.sign(y1 @ after) == pytest.approx(after, abs=1e-14)


def test_columns_of_a_group_are_found_by_one_difference():
    """Of loads -k x - c v of three bodies, of which the first one touches no other."""
    k = np.array([[3.0, 0.0, 0.0], [0.0, 5.0, -2.0], [0.0, -2.0, 4.0]])
    c, row = 0.1 * k, np.array([0, 1, 2, 1, 2])
    column = np.array([0, 1, 1, 2, 2])
    none = np.zeros((0, 2), int)
    s = SimpleNamespace(n_v=3, m=0, lam=np.zeros(0), slot_row=np.zeros(0), rubbing=none, n_r=1, n=1)
    r = SimpleNamespace(
        t=0.0, y=np.linspace(0.1, 0.6, 6), jacobian=0, jacobians=0, at_place=np.zeros(5),
        at_rate=np.zeros(5),
    )  # fmt: skip
    b = SimpleNamespace(
        pull0=np.zeros(3), pull=np.zeros(3), state_row=none, group_start=np.array([0, 2, 3]),
        group=np.array([0, 2, 1]), column_start=np.array([0, 1, 3, 5]), row=row,
    )  # fmt: skip

    def displace(s, y, i, step):
        y[i] += step

    def pull(s, t, y, lam, out):
        out[:] = -k @ y[:3] - c @ y[3:]

    alone = piece(
        sparse_jacobian, evaluate=nothing, displace=displace, pull=pull, turning=nothing,
        step_of_place=lambda *_: 1e-3, step_of_rate=lambda *_: 1e-3, part_of=nothing,
        w_index=lambda s, i: 3 + i,
    )  # fmt: skip
    alone(s, r, b, SimpleNamespace(step_error=1e-6), np.zeros(6), np.zeros(0))
    assert r.at_place == pytest.approx(-k[row, column])
    assert r.at_rate == pytest.approx(-c[row, column])


def test_what_accelerations_allow_of_a_step_is_the_same_in_any_unit_of_time(monkeypatch):
    for name, found in {"settles": True, "share": 1e-6}.items():
        monkeypatch.setattr(scipy_ivp, name, SimpleNamespace(python=lambda *_, x=found: x))
    monkeypatch.setattr(scipy_ivp, "of_rounding", lambda _: 0.0)
    theta = scipy_ivp.NODES
    found = []
    for unit in (1.0, 1e-2, 1e3):
        monkeypatch.setattr(
            scipy_ivp, "largest", SimpleNamespace(python=lambda *_, u=unit: 40.0 / u**2)
        )
        s = SimpleNamespace(contact=np.zeros(0), n_q=1, v_node=1, size=1.0, n_r=2)
        r = SimpleNamespace(length=0.5, speed=2.0 / unit, yd=None, top_acceleration=0.0)
        x, v = np.sin(6.0 * theta), 60.0 / unit * np.cos(6.0 * theta)
        weight = np.array([1.0 / 0.5, unit / 2.0])
        b = SimpleNamespace(P=np.stack([x, v], axis=1), weight=weight / 1e-4)
        run = scipy_ivp.Run("DOP853", s, r, b, SimpleNamespace(step_error=1e-4))
        found.append(scipy_ivp.of_accelerations(run, 0.1 * unit, 1.0))
    assert 0.0 < found[0] < 1.0
    assert found == pytest.approx([found[0]] * 3, rel=1e-9)
