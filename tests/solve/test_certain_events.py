"""No touch, no crossing and no limit inside a long step is passed over: counts in closed form."""

from math import acos, asin, pi, tau

import numpy as np
import pytest

from trsim.solve.march.record import EVENT_KIND, EVENT_TIME, ONSET, SEPARATION, USER

from ..runs import run

R = 0.1  # m, of the rim's mark
AXES = {"plane": (0, 0, 1), "x": (1, 0, 0), "tilted": (1, 2, 2)}


def across(axis):
    """Two unit vectors across an axis, right-handed with it."""
    a = np.array(axis, float) / np.linalg.norm(axis)
    u = np.cross(a, [0.3, 0.2, 1.0] if abs(a[2]) < 0.9 else [0.0, 1.0, 0.0])
    u /= np.linalg.norm(u)
    return u, np.cross(a, u), a


def words(vector):
    return [float(x) for x in vector]


def rotor(axis, rate, end, more, tolerance=1e-6, method="auto", extra=""):
    """A balanced rotor with a mark on its rim, which starts along u; a(t) = rate t."""
    u, w, a = across(axis)
    text = f"""
bodies:
  rotor: {{mass: 2, inertia: [0.05, 0.05, 0.05], angular_velocity: {words(rate * a)}}}
joints:
  hinge: {{type: revolute, bodies: [ground, rotor], at: [0, 0, 0], axis: {words(a)}}}
sensors:
  turn: {{joint: hinge}}
  beside: {{type: displacement, bodies: [ground, rotor], at: {words(R * u)}, axis: {words(w)}}}
solver: {{end: {end}, tolerance: {tolerance}, method: {method}{extra}}}
{more}
"""
    return run(text), u, w


def times(r, kind):
    return r.events[r.events[:, EVENT_KIND] == kind][:, EVENT_TIME]


@pytest.mark.parametrize("axis", AXES.values(), ids=AXES)
@pytest.mark.parametrize("rate, tolerance", [(10, 1e-6), (100, 1e-6), (10, 1e-2), (30, 1e-10)])
def test_every_crossing_of_a_rim(axis, rate, tolerance):
    """Every turn the mark passes one place, upwards: sin(rate t) = 0.3."""
    more = "events: {over: {when: beside, value: 0.03, crosses: up, do: {record: true}}}"
    r, _, _ = rotor(axis, rate, 10.0, more, tolerance)
    want = (asin(0.3) + tau * np.arange(2000)) / rate
    want = want[want <= 10.0]
    # the sensor's turn is right to the tolerance: so is the time
    assert times(r, USER) == pytest.approx(want, abs=200 * tolerance / rate)


@pytest.mark.parametrize("axis", AXES.values(), ids=AXES)
@pytest.mark.parametrize("rate", [10, 100])
def test_every_touch_of_a_rim(axis, rate):
    """A soft stop the mark goes 0.1 mm into once a turn, too soft to be felt."""
    u, _, _ = across(axis)
    depth = 1e-4
    more = f"""
forces:
  stop: {{type: limit_stop, point: {{body: rotor, at: {words(R * u)}}}, stiffness: 1e-3,
         wall: {{body: ground, at: {words(-(R - depth) * u)}, normal: {words(u)}}}}}
"""
    r, _, _ = rotor(axis, rate, 10.0, more, 1e-6)
    half = acos(1 - depth / R)
    first = (pi - half + tau * np.arange(200)) / rate
    first = first[first < 10.0]
    # the touch is shallow: what the angle is off by is seen in the time as it is
    assert times(r, ONSET) == pytest.approx(first, abs=2e-4 / rate)
    last = first + 2 * half / rate
    assert times(r, SEPARATION) == pytest.approx(last[last < 10.0], abs=2e-4 / rate)


@pytest.mark.parametrize("method", ["dop853", "radau", "generalized_alpha", "rk4", "auto"])
def test_both_crossings_of_one_step(method):
    """A ball thrown up passes a height upwards and downwards within one step."""
    fixed = ", step: 0.125" if method in ("rk4", "generalized_alpha") else ""
    text = f"""
gravity: [0, -9.81]
bodies: {{ball: {{mass: 1, inertia: 1, velocity: [0, 4.905]}}}}
joints: {{rail: {{type: prismatic, bodies: [ground, ball], axis: [0, 1, 0]}}}}
sensors: {{height: {{joint: rail}}}}
solver: {{end: 1, method: {method}{fixed}}}
output: {{every: 1}}
events:
  up: {{when: height, value: 1.2258, crosses: up, do: {{record: true}}}}
  down: {{when: height, value: 1.2258, crosses: down, do: {{record: true}}}}
"""
    r = run(text)
    aside = np.sqrt(2 * (4.905**2 / (2 * 9.81) - 1.2258) / 9.81)
    assert times(r, USER) == pytest.approx([0.5 - aside, 0.5 + aside], abs=1e-7)


@pytest.mark.parametrize("seed", range(6))
def test_a_spinning_bar_falls_on_two_stops(seed):
    """The first touch of either end, in closed form: h - g t^2/2 + s sin(turn + spin t) = 0."""
    rng = np.random.default_rng(seed)
    spin, turn, h = rng.uniform(10, 200), rng.uniform(0, tau), rng.uniform(0.5, 5)
    x, y = 0.4 * float(np.cos(turn)), 0.4 * float(np.sin(turn))
    text = f"""
gravity: [0, -9.81]
bodies: {{bar: {{mass: 1, inertia: 0.02, at: [0, {h}], angle: {turn},
         angular_velocity: [0, 0, {spin}]}}}}
forces:
  a: {{type: limit_stop, point: {{body: bar, at: [{x}, {h + y}]}},
      wall: {{body: ground, at: [0, 0], normal: [0, 1]}}, stiffness: 1e5}}
  b: {{type: limit_stop, point: {{body: bar, at: [{-x}, {h - y}]}},
      wall: {{body: ground, at: [0, 0], normal: [0, 1]}}, stiffness: 1e5}}
solver: {{end: {float(np.sqrt(2 * h / 9.81))}}}
"""
    t = np.linspace(0, np.sqrt(2 * h / 9.81), 2_000_001)
    lowest = h - 9.81 * t**2 / 2 - 0.4 * np.abs(np.sin(turn + spin * t))
    first = t[np.argmax(lowest < 0)]
    assert times(run(text), ONSET)[0] == pytest.approx(first, abs=2e-6)


@pytest.mark.parametrize("deep, there", [(1e-7, True), (-1e-7, False)])
def test_grazing(deep, there):
    """A mark that goes a tenth of a micrometre through a value at its top, or stays short of it."""
    more = (
        f"events: {{over: {{when: beside, value: {R - deep}, crosses: up, do: {{record: true}}}}}}"
    )
    r, _, _ = rotor((0, 0, 1), 20, 3.0, more, 1e-9)
    assert len(times(r, USER)) == (int(3.0 * 20 / tau - 0.25) + 1 if there else 0)


def test_a_stop_between_two_limits():
    """A slider swings between two limits much faster than its steps: each is touched in turn."""
    text = """
bodies: {slider: {mass: 1, inertia: 1, velocity: [10, 0]}}
joints: {rail: {type: prismatic, bodies: [ground, slider], axis: [1, 0, 0]}}
forces: {ends: {type: limit_stop, joint: rail, lower: -0.01, upper: 0.01, stiffness: 1e9}}
solver: {end: 0.1}
"""
    r = run(text)
    omega = np.sqrt(1e9)
    stay, fly = pi / omega, 0.02 / 10
    first = 0.01 / 10 + (stay + fly) * np.arange(100)
    assert times(r, ONSET) == pytest.approx(first[first < 0.1], abs=1e-7)


@pytest.mark.parametrize("method", ["dop853", "radau"])
@pytest.mark.parametrize("gap", [1e-2, 1e-4, 1e-6])
def test_a_soft_stop_with_a_narrow_gap(gap, method):
    """It is left on one side and met on the other in much less than a step."""
    text = f"""
bodies: {{slider: {{mass: 1, inertia: 1, velocity: [1, 0]}}}}
joints: {{rail: {{type: prismatic, bodies: [ground, slider], axis: [1, 0, 0]}}}}
forces: {{ends: {{type: limit_stop, joint: rail, lower: -{gap}, upper: {gap}, stiffness: 1}}}}
solver: {{end: 20, method: {method}}}
"""
    touches = gap + (pi + 2 * gap) * np.arange(10)
    assert times(run(text), ONSET) == pytest.approx(touches[touches < 20], abs=1e-7)


@pytest.mark.parametrize("first", [1e-4, 3e-3, 7e-3, 0.02])
def test_a_stop_that_is_left_in_a_step_over_several_swings(first):
    """It begins on its upper limit and moves away from it: that is no touch."""
    text = f"""
bodies: {{slider: {{mass: 1, inertia: 1, velocity: [-10, 0]}}}}
joints: {{rail: {{type: prismatic, bodies: [ground, slider], axis: [1, 0, 0]}}}}
forces: {{ends: {{type: limit_stop, joint: rail, lower: -0.02, upper: 0, stiffness: 1e9}}}}
solver: {{end: 0.03, first_step: {first}}}
"""
    r = run(text)
    stay, fly = pi / np.sqrt(1e9), 0.02 / 10
    touches = fly + (stay + fly) * np.arange(100)
    assert times(r, ONSET) == pytest.approx(touches[touches < 0.03], abs=1e-7)


@pytest.mark.parametrize("axis", AXES.values(), ids=AXES)
@pytest.mark.parametrize("rate", [10, 100])
def test_every_point_of_a_section(axis, rate):
    """A section at the mark's place, and one at its rate, which goes through zero twice a turn."""
    more = """
poincare:
  over: {when: beside, crosses: up, plot: [turn, turn.rate]}
  tops: {when: beside.rate, crosses: both, plot: [turn, beside]}
"""
    r, _, _ = rotor(axis, rate, 10.0, more)
    want = tau * np.arange(1, 2000)
    want = want[want <= 10.0 * rate]
    assert r.section("over")[:, 1] == pytest.approx(want, abs=2e-4 * rate)
    tops = pi / 2 + pi * np.arange(2000)
    tops = tops[tops <= 10.0 * rate]
    assert r.section("tops")[:, 1] == pytest.approx(tops, abs=2e-4 * rate)


def test_two_points_close_together():
    """A ball just reaches a height: both points lie within a hundredth of the step."""
    text = """
gravity: [0, -9.81]
bodies: {ball: {mass: 1, inertia: 1, velocity: [0, 4.905]}}
joints: {rail: {type: prismatic, bodies: [ground, ball], axis: [0, 1, 0]}}
sensors: {height: {joint: rail, at_start: -1.22624}}
solver: {end: 1}
poincare: {there: {when: height, crosses: both, plot: [height, height.rate]}}
"""
    aside = np.sqrt(2 * (4.905**2 / (2 * 9.81) - 1.22624) / 9.81)
    assert run(text).section("there")[:, 0] == pytest.approx([0.5 - aside, 0.5 + aside], abs=1e-7)
