"""Rows left out as redundant are looked at: what they do not hold ends the run, by name."""

import numpy as np
import pytest

from trsim.assemble.assemble import assemble
from trsim.errors import ModelError
from trsim.solve.diagnose.doubts import doubts
from trsim.solve.simulate import simulate

from ..overconstrained import (
    METHODS,
    ORDINARY,
    TILTED,
    bennett,
    bricard,
    chain,
    cranks,
    sarrus,
    slider_crank_at_dead_centre,
    text,
)
from ..runs import run, scenario

# extremes of forces next to flat places are chance, and are sought for long
PLACES = "output.channels=['plate.position']"
TURN = "drives: {motor: {joint: F0, velocity: 1}}"


def three_cranks(longer, more=TURN, R=ORDINARY, end=1.0, angle=np.pi / 2):
    planar = "true" if R is ORDINARY else "false"
    parts = cranks((1, 1, 1 + longer), (0, 1, 2), angle)
    return text(parts, more, R, planar=planar, end=end)


def opening(longer, turned):
    """How far the tip of a longer third crank is from its pin, along its row that was dropped (y),
    after a turn from upright while the row across is kept."""
    across = np.sin(turned)  # the way of every pin of the plate
    return abs((1 + longer) * np.sqrt(1 - (across / (1 + longer)) ** 2) - longer - np.cos(turned))


@pytest.mark.parametrize("method", METHODS.values(), ids=METHODS)
def test_a_crank_of_another_length_ends_the_run_by_name(method):
    longer = 4e-4
    r = run(three_cranks(longer), *method, fails=True)
    told = r.outcome.statistics
    bound = 100 * r.scenario.solver.tolerance
    # the step that passes the bound is kept: what was computed until then is told
    assert told["redundant_open_relative"] > bound
    assert told["joints_open_relative"] == told["redundant_open_relative"]
    assert "joints.T2" in r.outcome.reason and "its row y is off by" in r.outcome.reason
    assert "only as drawn" in r.outcome.reason
    t = r.outcome.time
    worst = told["redundant_open_relative"] * r.mechanism.model.size
    assert worst == pytest.approx(opening(longer, t), rel=2e-2)
    before = r.t[r.t < t * 0.2]
    assert len(before) == 0 or opening(longer, before[-1]) < bound * r.mechanism.model.size


@pytest.mark.parametrize("longer", [1e-9, -1e-7, 1e-6, -1e-5, 1e-4])
def test_what_may_be_open_goes_with_the_tolerance(longer):
    """The same drawing runs, with a warning or without, or not, as its error is to the tolerance.

    It opens to `longer` (1 - cos), over the size of 3: a third of it at the end.
    """
    for tolerance in (1e-4, 1e-6, 1e-8, 1e-10):
        wrong = abs(longer) * 0.46 / 3.0  # turned by one radian
        allowed = max(100 * tolerance, 1e-8)
        if 0.1 < wrong / allowed < 10:
            continue
        r = run(three_cranks(longer), f"solver.tolerance={tolerance}", fails=wrong > allowed)
        said = [text for text in doubts(r.scenario, r.mechanism, r.outcome) if "redundant" in text]
        told = 0.01 * allowed
        if wrong > allowed:
            assert "opens" in r.outcome.reason
        elif wrong > 10 * told:
            assert said and "joints." in said[0]
        elif wrong < 0.1 * told:
            assert not said


@pytest.mark.parametrize("method", METHODS.values(), ids=METHODS)
@pytest.mark.parametrize("R", [ORDINARY, TILTED], ids=["plane", "tilted"])
def test_what_is_redundant_stays_closed(R, method):
    r = run(three_cranks(0.0, "gravity: [0, -9.81, 1]" if R is TILTED else "gravity: [0, -9.81]",
                         R=R, angle=1.0), *method)  # fmt: skip
    assert r.mechanism.redundant
    assert r.outcome.statistics["redundant_open_relative"] < 1e-5
    # where the cranks lie flat reactions have no extreme, which may be said
    said = doubts(r.scenario, r.mechanism, r.outcome)
    assert not [text for text in said if "are chance" not in text]


@pytest.mark.parametrize("stabilisation", ["none", "baumgarte"])
def test_drift_of_all_rows_is_not_taken_for_rows_that_do_not_hold(stabilisation):
    # it swings about 1.2 rad, and stays away from the flat positions at which branches meet
    r = run(three_cranks(0.0, "gravity: [3.55, 9.14]", angle=0.9, end=5.0),
            f"solver.stabilisation={stabilisation}", "solver.tolerance=1e-5")  # fmt: skip
    assert not any("redundant" in text for text in doubts(r.scenario, r.mechanism, r.outcome))


@pytest.mark.parametrize("R", [ORDINARY, TILTED], ids=["drawn", "tilted"])
def test_bennett_keeps_the_relation_of_its_angles(R):
    more = (
        "drives: {motor: {joint: H0, velocity: 3}}\nsensors: {out: {joint: H1}, inlet: {joint: H0}}"
    )
    r = run(text(bennett(), more, R, end=2.5))
    product = np.tan((1.1 + r["inlet"]) / 2) * np.tan(
        np.arctan(np.tan(other_of_bennett() / 2)) + r["out"] / 2
    )
    at = np.abs(np.cos((1.1 + r["inlet"]) / 2)) > 0.1
    assert product[at] == pytest.approx(product[0], rel=1e-5)
    assert r.outcome.statistics["redundant_open_relative"] < 1e-6


def other_of_bennett():
    beta = np.arcsin(0.6 * np.sin(0.9))
    return 2 * np.arctan(np.sin((beta + 0.9) / 2) / np.sin((beta - 0.9) / 2) / np.tan(0.55))


@pytest.mark.parametrize("R", [ORDINARY, TILTED], ids=["drawn", "tilted"])
def test_bricard_keeps_the_relation_of_its_angles(R):
    more = "gravity: [0, -9.81, 1]\nsensors: {a: {joint: H0}, b: {joint: H1}}"
    r = run(text(bricard(), more, R, end=1.0))
    other = np.arccos(-np.cos(2.0) / (1 + np.cos(2.0)))
    left = []
    for sign in (1, -1):
        a, b = np.cos(2.0 + r["a"]), np.cos(sign * other + r["b"])
        left.append(np.abs(a * b + a + b).max())
    assert min(left) < 1e-6
    assert np.ptp(r["a"]) > 0.05


@pytest.mark.parametrize("R", [ORDINARY, TILTED], ids=["drawn", "tilted"])
def test_sarrus_rises_straight(R):
    r = run(text(sarrus(), "drives: {motor: {joint: A0, velocity: -1}}", R, end=0.3))
    way = (r["top.position"] - r["top.position"][0]) @ R
    assert np.abs(way[:, 2]).max() > 0.05
    assert np.abs(way[:, :2]).max() < 1e-6


@pytest.mark.parametrize("R", [ORDINARY, TILTED], ids=["drawn", "tilted"])
def test_a_slider_crank_goes_round_through_both_dead_centres(R):
    parts, more = slider_crank_at_dead_centre(), "drives: {motor: {joint: A, velocity: 5}}"
    r = run(text(parts, more, R, planar="true" if R is ORDINARY else "false", end=3.0))
    way = (r["slider.position"] - r["slider.position"][0]) @ R
    angle = 5 * r.t
    closed = 0.3 * np.cos(angle) + np.sqrt(1 - (0.3 * np.sin(angle)) ** 2) - 1.3
    assert way[:, 0] == pytest.approx(closed, abs=1e-6)


@pytest.mark.parametrize("R", [ORDINARY, TILTED], ids=["plane", "tilted"])
def test_cranks_pass_the_flat_position_on_their_branch(R):
    """Only a third crank leads a parallelogram past its flat position for certain."""
    parts = cranks((1, 1, 1), (0, 1.2, 2.5), 1.0)
    planar = "true" if R is ORDINARY else "false"
    turning = text(parts, "drives: {motor: {joint: F0, velocity: 7}}", R, planar=planar, end=3.0)
    r = run(turning, PLACES)
    way = (r["plate.position"] - r["plate.position"][0]) @ R
    turned = 1.0 + 7 * r.t
    assert way[:, 0] == pytest.approx(np.cos(turned) - np.cos(1.0), abs=1e-5)
    assert way[:, 1] == pytest.approx(np.sin(turned) - np.sin(1.0), abs=1e-5)


def test_a_later_stage_is_looked_at_too():
    more = """
drives: {motor: {joint: F0, velocity: 0}}
events: {go: {when: t, value: 0.3, do: {set: {motor: {velocity: 1}}}}}"""
    r = run(three_cranks(4e-4, more), fails=True)
    assert r.outcome.time > 0.3
    assert "joints.T2" in r.outcome.reason
    assert not run(three_cranks(0.0, more)).outcome.reason


def test_locks_that_hold_what_is_held_stay_closed():
    """A stage that has redundant rows where the start has none."""
    more = """
gravity: [0, -9.81]
events:
  one: {when: t, value: 0.1, do: {lock: [F0]}}
  two: {when: t, value: 0.2, do: {lock: [F1]}}"""
    parts = cranks((1, 1), (0, 1), 1.0)
    r = run(text(parts, more, planar="true"))
    assert not r.mechanism.redundant
    held = r["plate.position"][r.t > 0.11]
    assert np.ptp(held, axis=0) == pytest.approx(0.0, abs=1e-9)
    assert r.outcome.statistics["redundant_open_relative"] < 1e-9


def test_a_start_elsewhere_is_refused_where_rows_are_open_there():
    more = "initial: {F0: 0.5}"
    with pytest.raises(ModelError, match=r"off by .* where the run begins"):
        run(three_cranks(5e-4, more))
    run(three_cranks(0.0, more))


def test_a_run_that_was_broken_off_knows_what_was_open_before():
    read = scenario(three_cranks(3e-6, end=0.6), "solver.max_step=1e-4")
    whole = run(read).outcome

    def from_state(state):
        march = simulate(read, assemble(read), state)
        while True:
            try:
                block = next(march)
            except StopIteration as stop:
                return stop.value
            if block.state is not None and state is None:
                return block.state

    again = from_state({k: np.copy(v) for k, v in from_state(None).items()})
    for name in ("redundant_open_relative", "redundant_open_rate", "joints_open_relative"):
        assert again.statistics[name] == whole.statistics[name] > 0.0
    assert [t for t in doubts(read, assemble(read), again) if "redundant" in t]


LOCKED = {
    "weld": ("{a: {mass: 1, inertia: [0.1, 0.1, 0.1], at: [0.5, 0.2, 0.3]}}",
             "{A: {type: fixed, bodies: [ground, a], at: [0.3, 0.1, 0.7]}}"),
    "truss": ("{a: {mass: 1, inertia: 0.1, at: [0.5, 0.2]}, "
              "b: {mass: 1, inertia: 0.1, at: [1.5, 0.5]}}",
              "{A: {type: revolute, bodies: [ground, a], at: [0, 0]}, "
              "B: {type: revolute, bodies: [a, b], at: [1, 1.13]}, "
              "C: {type: revolute, bodies: [ground, b], at: [2.17, 0]}}"),
}  # fmt: skip


@pytest.mark.parametrize("method", ["auto", "radau", "generalized_alpha", "scipy:RK45"])
@pytest.mark.parametrize("parts", LOCKED.values(), ids=LOCKED)
def test_the_book_of_what_cannot_move_is_closed(parts, method):
    loads = "{f: {type: applied_load, body: a, at: [0.7, 0], direction: [1, 2], force: 9*sin(3*t)}}"
    whole = f"bodies: {parts[0]}\njoints: {parts[1]}\nforces: {loads}\nsolver: {{end: 10}}"
    r = run(whole, f"solver.method={method}")
    assert r.outcome.statistics["energy_residual_relative"] < 1e-8
    assert r.outcome.statistics["work_of_projection_relative"] < 1e-8
    assert not doubts(r.scenario, r.mechanism, r.outcome)


def test_rows_of_the_solve_are_independent_as_drawn_where_that_can_be():
    """Of two rows either of which may go, as in a Sarrus linkage drawn along its axes."""
    read = scenario(text(sarrus()))
    assert len(assemble(read).redundant) == 1
    assert not assemble(read).singular


@pytest.mark.parametrize("method", ["auto", "dop853", "radau", "generalized_alpha", "scipy:BDF"])
@pytest.mark.parametrize("R", [ORDINARY, TILTED], ids=["plane", "tilted"])
def test_cranks_start_lying_flat(R, method):
    """Where branches meet velocities are those of one of them, and the rows left out are those that
    others hold on it: it used to start between the branches, with a book open by half."""
    parts = cranks((1, 1, 1), (0, 1.2, 2.5), 0.0, 0.0)
    planar = "true" if R is ORDINARY else "false"
    ways = (f"solver.method={method}", "solver.tolerance=1e-7", "solver.end=0.5")
    rows = ("output.every=0.01", PLACES)
    driven = "drives: {motor: {joint: F1, velocity: 3}}"
    r = run(text(parts, driven, R, planar=planar), *ways, *rows)
    assert r.mechanism.mobility == 0
    assert len(r.mechanism.redundant) == (1 if planar == "true" else 7)
    way = (r["plate.position"] - r["plate.position"][0]) @ R
    assert way[:, 0] == pytest.approx(np.cos(3 * r.t) - 1, abs=1e-5)
    assert way[:, 1] == pytest.approx(np.sin(3 * r.t), abs=1e-5)
    assert r.outcome.statistics["energy_residual_relative"] < 100 * r.scenario.solver.tolerance
    # rounding is large where rows are nearly dependent, which may be said
    said = doubts(r.scenario, r.mechanism, r.outcome)
    assert not any("rows" in text for text in said if "are chance" not in text)


def test_of_the_branches_that_meet_the_nearest_to_the_given_velocity_is_taken():
    """Both branches of a flat parallelogram, at rest without a drive: given by its bodies."""
    parts = chain([(0,), (1,), (3,), (2,)])
    bodies = text(parts, planar="true", end=0.1)
    for crank, rocker in ((1.0, 1.0), (1.0, -3.0)):
        # pins at 1 and 3 rise with crank and rocker; the second branch is that of opposed turns
        more = bodies.replace("bar1: {", f"bar1: {{angular_velocity: [0, 0, {crank}], ")
        more = more.replace("bar3: {", f"bar3: {{angular_velocity: [0, 0, {rocker}], ")
        r = run(more.replace("solver:", "sensors: {a: {joint: J0}, b: {joint: J3}}\nsolver:"))
        a, b = r["a"][-1], -r["b"][-1]
        assert b / a == pytest.approx(rocker / crank, rel=0.1)
        assert r.outcome.statistics["energy_residual_relative"] < 1e-6
