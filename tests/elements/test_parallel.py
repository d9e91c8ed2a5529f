"""Parallel joint: a body that flies where it likes and turns about one axis only."""

import numpy as np
import pytest

from trsim.errors import TrsimError

from ..runs import built, energy_error, run

A = np.array([2.0, 1.0, 2.0]) / 3.0
TORQUE = np.array([0.3, -0.5, 0.2])
I = 0.05
FLYING = f"""
planar: false
bodies:
  lamp: {{mass: 2, inertia: [{I}, {I}, {I}], at: [5, 0, 1], angle: 0.9, velocity: [1, 2, 3],
         angular_velocity: {(8 * A).tolist()}}}
joints: {{upright: {{type: parallel, bodies: [ground, lamp], axis: {(3 * A).tolist()}}}}}
forces: {{twist: {{type: applied_load, body: lamp, frame: world, direction: {TORQUE.tolist()},
                torque: {np.linalg.norm(TORQUE)}}}}}
gravity: [0, 0, -9.81]
solver: {{end: 2, tolerance: 1e-10}}
output: {{every: 0.01, channels: ["*"]}}
"""


@pytest.mark.parametrize("method", ["dop853", "radau"])
def test_what_turns_it_about_other_axes_is_held(method):
    r = run(FLYING.replace("1e-10", f"1e-10, method: {method}"))
    t = r.t[:, None]
    fall = [5, 0, 1] + t * [1, 2, 3] - [0, 0, 9.81] * t**2 / 2
    assert r["lamp.position"] == pytest.approx(fall, abs=1e-7)
    rate = 8 + (TORQUE @ A) / I * t
    assert r["lamp.angular_velocity"] == pytest.approx(rate * A, abs=1e-7)
    held = (TORQUE @ A) * A - TORQUE
    assert r["upright.reaction_moment"] == pytest.approx(held + 0 * t, abs=1e-7)
    assert r["upright.reaction"] == pytest.approx(0 * fall, abs=1e-9)
    assert energy_error(r) < 1e-9


def test_the_first_body_turns():
    """The axis goes along with a base that is driven; about it the lamp does not turn."""
    r = run(f"""
planar: false
bodies:
  base: {{mass: 1, inertia: [1, 1, 1], angle: 0.3}}
  lamp: {{mass: 2, inertia: [{I}, {I}, {I}], at: [1, 1, 1], angle: -0.8}}
joints:
  hinge: {{type: revolute, bodies: [ground, base], at: [0, 0, 0], axis: [1, 0, 0]}}
  along: {{type: parallel, bodies: [base, lamp], axis: [0, 0, 1]}}
drives: {{turn: {{joint: hinge, velocity: 7*smoothstep(t)}}}}
solver: {{end: 3, tolerance: 1e-10}}
output: {{every: 0.01, channels: ["*"]}}
""")
    rate = 7 * np.where(r.t < 1, 3 * r.t**2 - 2 * r.t**3, 1.0)
    spin = rate[:, None] * [1.0, 0.0, 0.0]
    assert r["lamp.angular_velocity"] == pytest.approx(spin, abs=1e-7)
    assert r["lamp.position"] == pytest.approx(1.0 + 0 * spin, abs=1e-9)
    speed_up = 7 * np.where(r.t < 1, 6 * r.t - 6 * r.t**2, 0.0)
    assert r["along.reaction_moment"][:, 0] == pytest.approx(I * speed_up, abs=1e-7)
    assert energy_error(r) < 1e-9


def text(axis, planar):
    return f"""
planar: {planar}
bodies: {{rod: {{mass: 1, inertia: [0.1, 0.1, 0.1], at: [0.3, 0], angle: 1}}}}
joints: {{along: {{type: parallel, bodies: [ground, rod], axis: {axis}}}}}
forces: {{push: {{type: applied_load, body: rod, at: [0.3, 0.2], direction: [1, 0], force: 3}}}}
solver: {{end: 1}}
"""


@pytest.mark.parametrize("axis, mobility", [("[0, 0, 2]", 3), ("[3, -1, 0]", 2)])
def test_in_the_plane(axis, mobility):
    m = built(text(axis, "true"))
    assert m.planar and m.mobility == mobility
    r = run(text(axis, "true"))
    moment = 0.0 if mobility == 3 else 0.2 * 3
    assert r["along.reaction_moment"][0, 2] == pytest.approx(moment, abs=1e-9)


def test_an_axis_at_an_angle_is_not_planar():
    with pytest.raises(TrsimError, match="leave the x-y plane"):
        built(text("[1, 0, 1]", "true"))


def test_refused():
    with pytest.raises(TrsimError, match="must not be zero") as caught:
        built(text("[0, 0, 0]", "true"))
    assert caught.value.path == ("joints", "along", "axis")


def test_where_it_goes_and_how_it_turns():
    """Along three axes of a base that turns about z at 2 rad/s, and about that as well."""
    for pair, sign in (("base, lamp", 1.0), ("lamp, base", -1.0)):
        r = run(f"""
planar: false
bodies:
  base: {{mass: 1, inertia: [1, 1, 1], at: [4, 0, 0], angle: 0.3, angular_velocity: [0, 0, 2]}}
  lamp: {{mass: 2, inertia: [{I}, {I}, {I}], at: [5, 0, 1], angle: 0.9, velocity: [1, 2, 3],
         angular_velocity: [0, 0, -5]}}
joints:
  hinge: {{type: revolute, bodies: [ground, base], at: [4, 0, 0]}}
  along: {{type: parallel, bodies: [{pair}], axis: [0, 0, 1], x_axis: [0, 7, 0], at: [5, 0, 1]}}
sensors:
  turn: {{joint: along.angle}}
  up: {{joint: along.stroke}}
  x: {{joint: along.x}}
  y: {{joint: along.y}}
solver: {{end: 3, tolerance: 1e-10}}
output: {{every: 0.01, channels: ["*"]}}
""")
        t = r.t
        assert r["turn"] == pytest.approx(-7 * sign * t, abs=1e-8)
        assert r["up"] == pytest.approx(3 * sign * t, abs=1e-8)
        mark = np.stack([4 + np.cos(2 * t), np.sin(2 * t)], 1)  # the point on the base
        apart = sign * (np.stack([5 + t, 2 * t], 1) - mark)
        turned = 2 * t if sign > 0 else -5 * t  # of the first body
        x = np.stack([-np.sin(turned), np.cos(turned)], 1)
        y = np.stack([-np.cos(turned), -np.sin(turned)], 1)
        assert r["x"] == pytest.approx(np.sum(apart * x, 1), abs=1e-8)
        assert r["y"] == pytest.approx(np.sum(apart * y, 1), abs=1e-8)


RUBS = "friction: {law: modified_coulomb, coefficient: 0.2, v0: 0, v1: 1e-4}"


def test_friction_by_its_moment():
    """Two ends 50 mm apart carry the moment M = 2 N m across the axis: N = 2 M/l = 80 N."""
    r = run(f"""
planar: false
bodies: {{lamp: {{mass: 2, inertia: [{I}, {I}, {I}], at: [0, 0, 0], velocity: [0, 0, 3],
                angular_velocity: [0, 0, 9]}}}}
joints: {{up: {{type: parallel, bodies: [ground, lamp], axis: [0, 0, 1]}}}}
forces:
  tilt: {{type: applied_load, body: lamp, frame: world, direction: [1, 0, 0], torque: 2}}
  rub: {{type: joint_friction, joint: up.angle, radius: 10 mm, length: 50 mm, {RUBS}}}
solver: {{end: 0.5, tolerance: 1e-10}}
output: {{channels: ["*"]}}
""")
    assert r["rub.normal_force"] == pytest.approx(80.0, rel=1e-9)
    slower = 0.2 * 0.010 * 80 / I
    assert r["lamp.angular_velocity"][:, 2] == pytest.approx(9 - slower * r.t, abs=1e-7)
    assert energy_error(r) < 1e-9


@pytest.mark.parametrize(
    "keys, words",
    [
        ("joint: up.stroke", "passes on moments only"),
        ("joint: up.angle, radius: 0.1, thrust_radius: 0.1", "passes on moments only"),
        ("joint: up, radius: 0.1", "slides in more than 3 ways"),
    ],
)
def test_friction_that_nothing_presses(keys, words):
    with pytest.raises(TrsimError, match=words):
        built(f"""
planar: false
bodies: {{lamp: {{mass: 2, inertia: [{I}, {I}, {I}]}}}}
joints: {{up: {{type: parallel, bodies: [ground, lamp], axis: [0, 0, 1]}}}}
forces: {{rub: {{type: joint_friction, {keys}, {RUBS}}}}}
""")
