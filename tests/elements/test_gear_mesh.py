"""Gear mesh: vibration and rattling of teeth against closed forms and an integrator of its own."""

import math
from functools import cache

import numpy as np
import pytest
from scipy.integrate import solve_ivp

from trsim.errors import TrsimError
from trsim.scenario.load import loads

from ..runs import energy_error, run

TEXT = """
bodies:
  pinion: {{mass: 1 kg, inertia: 0.002, at: [0, 0], angular_velocity: [0, 0, {w}]}}
  wheel: {{mass: 3 kg, inertia: 0.02, at: [{at}, 0]}}
joints:
  first: {{type: revolute, bodies: {one}, at: [0, 0]}}
  second: {{type: revolute, bodies: {two}, at: [{at}, 0]{axis}}}
forces:
  teeth: {{type: gear_mesh, joints: [first, second], radii: [50 mm, 100 mm], stiffness: 1e6 N/m,
          {more}}}
solver: {{end: {end}, tolerance: 1e-9}}
"""
K, M = 1e6, 1 / (0.05**2 / 0.002 + 0.1**2 / 0.02)


def text(more="backlash: 0", w=5, end=0.02, at=0.15, **changes):
    given = {"one": "[ground, pinion]", "two": "[ground, wheel]", "axis": ""} | changes
    return TEXT.format(more=more, w=w, end=end, at=at, **given)


@pytest.mark.parametrize("internal", [False, True])
@pytest.mark.parametrize("changes", [
    {}, {"one": "[pinion, ground]"}, {"two": "[wheel, ground]"}, {"axis": ", axis: [0, 0, -1]"},
    {"one": "[pinion, ground]", "two": "[wheel, ground]", "axis": ", axis: [0, 0, -1]"},
])  # fmt: skip
def test_wheels_without_play_vibrate(internal, changes):
    more = "internal: true" if internal else "backlash: 0"
    r = run(loads(text(more, at=0.05 if internal else 0.15, **changes)))
    w = np.sqrt(K / M)
    ahead = np.abs(r["teeth.play"])
    np.testing.assert_allclose(ahead, 0.25 / w * np.abs(np.sin(w * r.t)), atol=1e-9)
    # together they go on as geared: the wheel half as fast, the other way unless internal
    first, second = r["pinion.angular_velocity"][:, 2], r["wheel.angular_velocity"][:, 2]
    way = 1.0 if internal else -1.0
    np.testing.assert_allclose(0.002 * first / 0.05 + way * 0.02 * second / 0.1, 0.2, atol=1e-9)
    assert energy_error(r) < 1e-9


@cache
def rattled(c, b, v, end):
    """x(t) of one mass between two flanks, by scipy."""

    def force(x, rate):
        d = x - b / 2 if x > b / 2 else x + b / 2 if x < -b / 2 else 0.0
        s = min(1.0, abs(d) / 1e-5)
        T = K * d + c * s * s * (3 - 2 * s) * rate
        return T if T * d > 0.0 else 0.0

    found = solve_ivp(
        lambda _, y: (y[1], -force(*y) / M), (0, end), (0, v), rtol=1e-10, atol=1e-14,
        method="DOP853", max_step=1e-5, dense_output=True,
    )  # fmt: skip
    return lambda t: found.sol(t)[0]


@pytest.mark.parametrize("method", ["dop853", "radau", "scipy:RK45"])
@pytest.mark.parametrize("c", [0, 300])
def test_teeth_rattle_in_their_play(c, method):
    more = f"damping: {c}, backlash: 0.4 mm"
    r = run(loads(text(more, end=0.02), [f"solver.method={method}"]))
    wanted = rattled(c, 4e-4, 0.25, 0.02)(r.t)
    assert np.ptp(np.sign(np.diff(wanted))) == 2  # to and fro
    np.testing.assert_allclose(r["teeth.play"], wanted, atol=2e-8)
    force = r["teeth.force"]
    free = np.abs(r["teeth.play"]) < 2e-4 - 1e-8
    assert not force[free].any() and np.abs(force).max() > 100
    assert np.all(force * r["teeth.play"] >= 0.0)  # pushed, never pulled
    assert energy_error(r) < 1e-7
    np.testing.assert_allclose(r["teeth.torque_1"], -0.05 * force, atol=1e-9)


def test_a_touch_is_not_passed_over_in_a_long_flight():
    """Play of a metre, and hours of steps if need be: the flank is where it is."""
    r = run(loads(text("backlash: 0.5 m", w=5, end=2.05)))
    touch = 0.25 / 0.25
    before, after = r.t < touch - 0.01, (r.t > touch + 0.02)
    rate = np.gradient(r["teeth.play"], r.t)
    np.testing.assert_allclose(rate[before][1:], 0.25, rtol=1e-6)
    np.testing.assert_allclose(rate[after][1:-2], -0.25, rtol=1e-6)


def test_a_flank_that_is_touched_inside_a_step_is_found():
    """A driven pinion that goes a thousandth beyond the play, and back; its wheel is heavy."""
    more = "backlash: 0.2 mm"
    drive = "drives: {motor: {joint: first, position: '0.002002*sin(300*t)'}}\n"
    r = run(loads(text(more, w=0, end=0.3) + drive))

    def rate(t, y):
        x = 0.05 * 0.002002 * math.sin(300 * t) + 0.1 * y[0]
        d = x - 1e-4 if x > 1e-4 else x + 1e-4 if x < -1e-4 else 0.0
        return y[1], -0.1 * K * d / 0.02

    found = solve_ivp(rate, (0, 0.3), (0, 0), rtol=1e-11, atol=1e-16, method="DOP853",
                      max_step=6e-5, t_eval=r.t)  # fmt: skip
    assert r["teeth.force"].max() > 0.0 or np.abs(found.y[1]).max() > 0.0
    np.testing.assert_allclose(
        r["wheel.angular_velocity"][:, 2], found.y[1], atol=2e-6 * np.abs(found.y[1]).max()
    )


def test_stiff_teeth_on_a_moving_carrier_are_a_gear():
    planet = """
bodies:
  arm: {mass: 1 kg, inertia: 0.01, at: [0.07, 0], angular_velocity: [0, 0, 10]}
  sun: {mass: 1 kg, inertia: 0.002, at: [0, 0]}
  planet: {mass: 0.5 kg, inertia: 0.001, at: [0.15, 0]}
joints:
  bearing: {type: revolute, bodies: [ground, arm], at: [0, 0]}
  middle: {type: revolute, bodies: [arm, sun], at: [0, 0]}
  pin: {type: revolute, bodies: [arm, planet], at: [0.15, 0]}
%s
forces:
  turn: {type: applied_load, body: sun, direction: [0, 0, 1], torque: "3*smoothstep(t/0.1)"}
%s
solver: {end: 0.3 s, tolerance: 1e-9}
"""
    gear = "  teeth: {type: gear, joints: [middle, pin], radii: [0.1, 0.05]}"
    mesh = ("  teeth: {type: gear_mesh, joints: [middle, pin], radii: [0.1, 0.05], "
            "stiffness: 1e9, damping: 1e4}")  # fmt: skip
    # all turn alike at the start, so that no teeth are pressed then
    same = planet.replace(", angular_velocity: [0, 0, 10]", "")
    same += "initial: {bearing.rate: 4, middle.rate: 0, pin.rate: 0}\n"
    rigid = run(loads(same.replace(", pin.rate: 0", "") % (gear, "")))
    soft = run(loads(same % ("", mesh)))
    for name in ("arm", "sun", "planet"):
        np.testing.assert_allclose(
            soft[f"{name}.angular_velocity"], rigid[f"{name}.angular_velocity"], atol=1e-4
        )
    late = rigid.t > 0.12
    np.testing.assert_allclose(
        soft["teeth.torque_1"][late], rigid["teeth.torque_1"][late], rtol=1e-3
    )


@pytest.mark.parametrize(
    ("more", "said"),
    [
        ("backlash: -1 mm", ">= 0"),
        ("backlash: 1 N", "1 N"),
        ("internal: true", "touch"),
        ("damping: -3", ">= 0"),
    ],
)
def test_what_is_no_mesh_is_refused(more, said):
    with pytest.raises(TrsimError) as error:
        run(loads(text(more)))
    assert said in str(error.value)
