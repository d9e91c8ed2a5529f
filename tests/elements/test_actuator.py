"""Actuator: a spring with a moving end along its own line; rigid it is the row of a distance."""

import numpy as np
import pytest

from trsim.errors import ModelError, Problems, ScenarioError
from trsim.scenario.load import loads
from trsim.solve.diagnose.modes import modes
from trsim.solve.start.consistent import start

from ..runs import built, run
from .bench import bench, check_action_is_reaction, check_gradient, check_power

ENDS = "bodies: [left, right], points: [[0.3, 0, 0.1], [0.6, 0.1, 0]]"
DRAWN = np.sqrt(0.3**2 + 0.1**2 + 0.1**2)
MOTIONS = {"position": "position: 0.2 + 0.5*sin(3*t)", "velocity": "velocity: 2*cos(3*t)"}
SUPPLY = "supply: {stiffness: 900, damping: 12, mass: 0.7}"
SEEDS = range(3)


def between(seed, *keys):
    return bench(
        f"drives: {{jack: {{type: actuator, {ENDS}, {', '.join(keys)}}}}}",
        np.random.default_rng(seed),
    )


def with_piston(seed, motion="velocity"):
    """All its states away from rest."""
    b = between(seed, MOTIONS[motion], "stiffness: 500, damping: 30", SUPPLY)
    b.z[5:] = 0.1 * np.random.default_rng(seed).normal(size=b.z.size - 5)
    return b


@pytest.mark.parametrize("seed", SEEDS)
@pytest.mark.parametrize("motion", MOTIONS)
def test_derivatives_of_the_rigid_one(motion, seed):
    b, h = between(seed, MOTIONS[motion]), 1e-5
    w, ahead, behind = b.rows(), b.later(h).rows(), b.later(-h).rows()
    V = np.hstack([b.V[1], b.V[2]])
    phi_dot, later, before = (s.J.reshape(-1, 12) @ V + s.phi_t for s in (w, ahead, behind))
    assert phi_dot == pytest.approx((ahead.phi - behind.phi) / (2 * h), abs=1e-7)
    assert w.gamma == pytest.approx(-(later - before) / (2 * h), abs=1e-6)
    w.lam[:] = 1.0
    wrenches = np.vstack([np.zeros(6), -w.J[:2]])
    check_action_is_reaction(b, wrenches)


@pytest.mark.parametrize("seed", SEEDS)
@pytest.mark.parametrize("motion", MOTIONS)
def test_compliant_one_is_a_spring_with_a_moving_end(motion, seed):
    b = between(seed, MOTIONS[motion], "stiffness: 500, damping: 30")
    check_action_is_reaction(b)
    check_power(b)
    assert b.book[2] < 0.0  # dampers only take
    check_gradient(between(seed, MOTIONS[motion], "stiffness: 500"))


@pytest.mark.parametrize("seed", SEEDS)
@pytest.mark.parametrize("motion", MOTIONS)
def test_power_with_a_piston(motion, seed):
    b = with_piston(seed, motion)
    check_action_is_reaction(b)
    check_power(b)


def test_takes_no_moment_and_acts_along_its_line():
    b = between(1, "velocity: 0", "stiffness: 500")
    b.r[1:], b.p[1:], b.V[:] = [[0, 0, 0], [5, 0, 0]], [1, 0, 0, 0], 0.0
    F = b.wrenches()
    # 5 m apart, so the ends are DRAWN away from the drawn length: it pulls
    assert F[1, 0] > 0.0 > F[2, 0]


PRESS = """
bodies: {{block: {{mass: 20, inertia: 0.1}}}}
joints: {{slide: {{type: prismatic, bodies: [ground, block], axis: [1, 0, 0]}}}}
forces: {{wall: {{type: spring_damper, bodies: [ground, block], points: [[1, 0], [0, 0]],
                 stiffness: 4e4, damping: 400}}}}
drives: {{jack: {{type: actuator, bodies: [ground, block], points: [[-0.5, 0], [0, 0]], {}}}}}
solver: {{end: {}, tolerance: 1e-10}}
output: {{every: 1 ms}}
"""
RAMP = "position: '0.01*smoothstep(t/0.5)', stiffness: 1e5, damping: 50"


def test_springs_in_series_at_rest():
    """k (f - x) = k_wall x once all is quiet; with the supply in series behind the piston."""
    there = run(PRESS.format(RAMP, 2))
    x = 0.01 * 1e5 / (1e5 + 4e4)
    assert there["jack.stroke"][-1] == pytest.approx(x, rel=1e-8)
    assert there["jack.force"][-1] == pytest.approx(4e4 * x, rel=1e-8)
    assert there["jack.reaction"][-1] == pytest.approx([4e4 * x, 0, 0], rel=1e-8, abs=1e-9)
    piston = "supply: {stiffness: 1e5, damping: 100, mass: 2}"
    there = run(PRESS.format(f"{RAMP}, {piston}", 2))
    x = 0.01 * 5e4 / (5e4 + 4e4)
    assert there["jack.stroke"][-1] == pytest.approx(x, rel=1e-8)
    assert there["jack.piston"][-1] == pytest.approx(x + 4e4 * x / 1e5, rel=1e-8)
    assert abs(there["energy.residual"]).max() < 1e-8


def test_sign_is_that_of_the_channel_only():
    pushing, holding = (run(PRESS.format(f"{RAMP}, sign: {s}", 0.3)) for s in (1, -1))
    assert pushing["jack.force"][-1] == -holding["jack.force"][-1] > 0.0
    assert np.array_equal(pushing["jack.reaction"], holding["jack.reaction"])


def test_rigid_one_moves_its_body_and_tells_the_force():
    """x = f: the force is that of the wall and of the mass."""
    there = run(PRESS.format("position: '0.01*smoothstep(t/0.5)'", 0.5))
    t = there.t / 0.5
    x, v = 0.01 * (3 * t**2 - 2 * t**3), 0.01 * (6 * t - 6 * t**2) / 0.5
    a = 0.01 * (6 - 12 * t) / 0.25
    assert there["jack.stroke"] == pytest.approx(x, abs=1e-12)
    force = 4e4 * x + 400 * v + 20 * a
    inside = slice(1, -1)  # the acceleration jumps at both ends
    assert there["jack.force"][inside] == pytest.approx(force[inside], rel=1e-9, abs=1e-7)


def test_speed_begins_where_it_stands():
    """By its velocity the stroke is the integral of it, and the start moves with it."""
    there = run(PRESS.format("velocity: 0.02, stiffness: 1e5", 0.1))
    assert there["jack.position"] == pytest.approx(0.02 * there.t, abs=1e-14)
    assert there["jack.stroke_rate"][0] == pytest.approx(0.02)
    piston = "supply: {stiffness: 1e5, mass: 2}"
    there = run(PRESS.format(f"velocity: 0.02, stiffness: 1e5, {piston}", 0.1))
    assert np.gradient(there["jack.piston"], there.t)[0] == pytest.approx(0.02, rel=1e-3)


def test_stalls_at_its_force():
    """The run ends where the thrust is 150 N, located between two rows of the run without."""
    there = run(PRESS.format("velocity: 0.02, stiffness: 1e5, damping: 50, stall: 150", 1))
    assert there.outcome.status == "jammed"
    assert "jack reached its stall force (150 N) at t = 0.2" in there.outcome.reason
    assert there.outcome.reason.endswith("jack.force 150 N")
    whole = run(PRESS.format("velocity: 0.02, stiffness: 1e5, damping: 50", 1))
    k = np.flatnonzero(whole["jack.force"] > 150.0)[0]
    assert whole.t[k - 1] < there.outcome.time <= whole.t[k]


def test_pulling_stalls_as_well():
    there = run(PRESS.format("velocity: -0.02, stiffness: 1e5, damping: 50, stall: 150", 1))
    assert there.outcome.status == "jammed"
    assert there.outcome.reason.endswith("jack.force -150 N")


def test_an_event_sets_another_speed_and_lets_go():
    text = PRESS.format("velocity: 0.02, stiffness: 1e5, damping: 50", 1)
    text += (
        "sensors: {x: {joint: slide}}\nevents: {slow: {when: t, value: 0.3, "
        "do: {set: {jack: {velocity: 0.01}}}}, off: {when: t, value: 0.6, do: {release: [jack]}}}"
    )
    there = run(text)
    assert there.at("jack.position", 0.5) == pytest.approx(0.02 * 0.3 + 0.01 * 0.2)
    assert there.at("jack.force", 0.8) == 0.0
    assert abs(there["energy.residual"]).max() < 1e-8


@pytest.mark.parametrize(
    ("keys", "told"),
    [
        ("velocity: 1, position: 0", "either `position` or `velocity`"),
        ("velocity: 1, stall: 3", "a rigid actuator has no stall"),
        ("velocity: 1, supply: {stiffness: 1, mass: 1}", "a rigid actuator has no supply"),
        ("velocity: 1, damping: 1", "a rigid actuator has no damping"),
        ("velocity: stroke, stiffness: 1", "no parameter named 'stroke'"),
    ],
)
def test_refused(keys, told):
    with pytest.raises((ScenarioError, Problems), match=told):
        run(PRESS.format(keys, 1))


def test_ends_must_differ():
    text = PRESS.format("velocity: 1", 1).replace("[-0.5, 0], [0, 0]", "[0, 0], [0, 0]")
    with pytest.raises(ScenarioError, match="coincide"):
        run(text)


def test_two_rigid_ones_on_one_slide_are_refused():
    text = PRESS.format("velocity: 1", 1).replace(
        "drives: {", "drives: {more: {type: actuator, bodies: [ground, block], "
        "points: [[-0.5, 0.1], [0, 0.1]], velocity: 1}, "
    )  # fmt: skip
    with pytest.raises(ModelError, match="already fix"):
        run(text)


WEIGHT = """
bodies: {{m: {{mass: 10, inertia: 0.5, at: [0, 1]}}}}
joints: {{s: {{type: prismatic, bodies: [ground, m], axis: [0, 1, 0]}}}}
drives: {{a: {{type: actuator, bodies: [ground, m], points: [[0, 0], [0, 1]], {}}}}}
gravity: [0, -9.81]
initial: {{equilibrium: all}}
solver: {{end: 0.2, tolerance: 1e-9}}
"""
SUPPLIED = "supply: {stiffness: 1e5, damping: 50, mass: 2}"


@pytest.mark.parametrize(("supply", "springs"), [("", 1), (f", {SUPPLIED}", 2)])
@pytest.mark.parametrize("motion", ["velocity: 0", "position: 0"])
def test_an_equilibrium_stays_one(motion, supply, springs):
    """The weight is held from the start, by springs that give way before it."""
    there = run(WEIGHT.format(f"{motion}, stiffness: 1e5, damping: 50{supply}"))
    assert there["a.force"][0] == pytest.approx(98.1, rel=1e-10)
    assert there["a.force"] == pytest.approx(98.1, rel=1e-6)
    assert there["a.stroke"] == pytest.approx(-springs * 98.1 / 1e5, rel=1e-6)
    assert np.abs(there["m.acceleration"][0]).max() < 1e-9


def test_a_drive_of_a_joint_holds_its_weight_as_well():
    text = WEIGHT.format("velocity: 0, stiffness: 1e5").replace(
        "type: actuator, bodies: [ground, m], points: [[0, 0], [0, 1]], velocity: 0, "
        "stiffness: 1e5",
        "joint: s, velocity: 0, compliance: {stiffness: 1e5, damping: 50}",
    )
    assert run(text)["a.force"] == pytest.approx(98.1, rel=1e-6)


def test_a_start_beyond_the_stall_force_is_refused():
    with pytest.raises(ModelError, match="reached its stall force before the run begins"):
        run(WEIGHT.format("position: 0, stiffness: 1e5, stall: 50"))


RELEASED = """
sensors: {{x: {{joint: slide}}}}
events: {{off: {{when: t, value: 0.3, do: {{release: [jack]}}}},
          on: {{when: t, value: 0.5, do: {{set: {{jack: {{{motion}}}}}}}}}}}
"""


@pytest.mark.parametrize(("motion", "after"), [
    ("velocity: 0.02", "velocity: 0.02"), ("position: 0.02*t", "position: 0.02*t"),
])  # fmt: skip
def test_a_supply_is_booked_when_its_actuator_lets_go_and_takes_hold(motion, after):
    keys = f"{motion}, stiffness: 1e5, damping: 50, {SUPPLY}"
    there = run(PRESS.format(keys, 1) + RELEASED.format(motion=after))
    assert np.abs(there["energy.residual"]).max() < 1e-7
    k = np.flatnonzero(there.t >= 0.5)[1]
    assert abs(there["jack.force"][k]) < 50.0  # no shock: the piston is where its end is
    assert there["jack.piston"][k] == pytest.approx(there["jack.stroke"][k], abs=1e-3)


def test_a_line_has_a_length():
    """Drawn in by 1 m/s a line of 0.5 m ends at 0.5 s; the run says whose it is."""
    text = PRESS.format("velocity: -1, stiffness: 1e5, damping: 50", 1)
    there = run(text.replace("stiffness: 4e4, damping: 400", "stiffness: 1"), fails=True)
    assert "drives.jack" in there.outcome.reason
    assert "no length" in there.outcome.reason
    assert there.outcome.time == pytest.approx(0.5, abs=5e-3)


def test_modes_know_the_piston():
    """Mass - spring - piston - spring - ground: the two roots of their quadratic."""
    text = PRESS.format("velocity: 0, stiffness: 1e5, supply: {stiffness: 2e5, mass: 3}", 1)
    text = text.replace("stiffness: 4e4, damping: 400", "stiffness: 1e-3")
    mechanism = built(text)
    found = sorted(m.frequency for m in modes(mechanism, start(loads(text), mechanism, True)))
    K, M = np.array([[1e5, -1e5], [-1e5, 3e5]]), np.diag([20.0, 3.0])
    expected = np.sqrt(np.sort(np.linalg.eigvals(np.linalg.inv(M) @ K).real)) / (2 * np.pi)
    assert found == pytest.approx(expected, rel=1e-5)
