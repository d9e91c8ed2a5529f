"""Corners of loads and drives: steps end there, and none is passed over."""

import math
from itertools import pairwise

import numpy as np
import pytest
from scipy.optimize import brentq
from scipy.special import i0e

from tests.runs import run
from trsim.laws.functions import table, value

PUSHED = """
bodies: {{slider: {{mass: 2, inertia: 1}}}}
joints: {{guide: {{type: prismatic, bodies: [ground, slider], axis: [1, 0, 0]}}}}
forces: {{kick: {{type: applied_load, body: slider, direction: [1, 0], force: {}}}}}
solver: {{end: {} s, {}}}
output: {{every: 1 s}}
"""
METHODS = ["method: dop853", "method: radau", "method: auto", "method: 'scipy:RK45'",
           "method: rk4, step: 30 ms", "method: generalized_alpha, tolerance: 1e-6"]  # fmt: skip


def speed(r):
    return r.outcome.record.y[3]


@pytest.mark.parametrize("method", METHODS)
def test_a_narrow_triangle_of_a_table(method):
    """Its impulse is the integral of the cubics, each exact with two points of Gauss."""
    x = [0, 2.9995, 3, 3.0005, 3.001, 3.0015, 10]
    y = [0, 0, 0, 1e4, 0, 0, 0]
    tab, none = np.array(table(x, y)), np.zeros((0, 2))
    impulse = 0.0
    for a, b in pairwise(x):
        for side in (-1, 1):
            at = 0.5 * (a + b) + side * (b - a) / math.sqrt(12)
            impulse += 0.5 * (b - a) * value(tab, 0, at, none)
    r = run(PUSHED.format(f"{{table: {[list(p) for p in zip(x, y, strict=True)]}}}", 10, method))
    accuracy = 1e-3 if "alpha" in method else 1e-9  # of second order
    assert speed(r) == pytest.approx(impulse / 2, rel=accuracy)


@pytest.mark.parametrize("method", METHODS)
def test_extremes_absolute_values_and_smooth_steps(method):
    """Pieces of low degree are exact with any method of order 4, whatever the step."""
    pieces = {
        "max(0, 1 - abs(t - 4.321)/1e-3)*1e4": 10.0,  # triangle: half its width times its height
        "1e4*step(t, 2, 0, 2.001, 1)*(t < 2.002)": 15.0,
        "min(max(1e6*(t - 7), 0), 500)*(t < 7.001)": 500 * 1e-3 - 0.5 * 500 * 5e-4,
    }
    for text, impulse in pieces.items():
        r = run(PUSHED.format(f'"{text}"', 10, method))
        assert speed(r) == pytest.approx(impulse / 2, rel=1e-3 if "alpha" in method else 1e-8)


@pytest.mark.parametrize("method", METHODS[:3])
def test_two_loads_that_meet(method):
    """One pulse ends where another begins, up to rounding: nothing is lost between."""
    pulses = "1000*(t >= 0.1)*(t <= 0.3) + 1000*(t > 0.1 + 0.2)*(t < 0.4)"
    r = run(PUSHED.format(f'"{pulses}"', 1, method))
    assert speed(r) == pytest.approx(150.0, rel=1e-9)


@pytest.mark.parametrize("method", METHODS[:3])
def test_what_an_event_sets_counts_from_the_event(method):
    """A velocity with a pulse 1 ms after the event, 1 ms long: the slider moves 2 mm."""
    r = run(
        f"""
bodies: {{slider: {{mass: 2, inertia: 1}}}}
joints: {{guide: {{type: prismatic, bodies: [ground, slider], axis: [1, 0, 0]}}}}
drives: {{motor: {{joint: guide, velocity: 0}}}}
events: {{go: {{when: t, value: 3.21, do: {{set: {{motor: {{velocity:
  "2*(t > 1 ms)*(t < 2 ms)"}}}}}}}}}}
parameters: {{ms: 1e-3}}
solver: {{end: 10 s, {method}}}
output: {{every: 1 s}}
""".replace("1 ms", "ms").replace("2 ms", "2*ms")
    )
    assert r.outcome.record.y[0] == pytest.approx(2e-3, rel=1e-9)


def test_a_drive_takes_the_mechanism_along_at_once():
    """Its velocity jumps at 0.5 s: no part of a step is made with the old one."""
    r = run("""
bodies: {slider: {mass: 2, inertia: 1}}
joints: {guide: {type: prismatic, bodies: [ground, slider], axis: [1, 0, 0]}}
drives: {motor: {joint: guide, position: "max(0, t - 0.5)"}}
solver: {end: 1 s}
output: {every: 0.1 s}
""")
    assert r["slider.velocity"][:, 0] == pytest.approx([0.0] * 6 + [1.0] * 5, abs=1e-12)
    assert r.outcome.statistics["position_residual"] < 1e-12


def test_many_pulses_are_met_once_each():
    """A thousand of them: two steps' ends each, and few steps more."""
    text = '"(sin(2*pi*100*t) > 0.9)"'
    r = run(PUSHED.format(text, 10, "method: dop853"))
    assert speed(r) == pytest.approx(0.5 * 1000 * math.acos(0.9) / (100 * math.pi), rel=1e-9)
    assert 2000 <= r.outcome.statistics["steps"] < 5000


def test_peaks_of_both_sides_of_a_jump():
    r = run(PUSHED.format('"100*t*(t < 0.5) - 7*(t > 0.5)"', 1, "method: dop853"))
    assert r.largest("kick.magnitude") == pytest.approx((50.0, 0.5), rel=1e-9)
    start = r.place["kick.magnitude"][0]
    assert r.outcome.peaks[start, 2] == -7.0


def test_a_model_is_not_changed_by_a_run():
    """What functions are held on belongs to a run: a second one begins like the first."""
    from trsim.assemble.assemble import assemble
    from trsim.scenario.load import loads
    from trsim.solve.simulate import simulate

    scenario = loads(PUSHED.format('"(t > 0.5)*(t < 0.75)"', 1, "method: dop853"), ())
    mechanism = assemble(scenario)
    before, ends = mechanism.model.tab.copy(), []
    for _ in range(2):
        running = simulate(scenario, mechanism)
        while True:
            try:
                next(running)
            except StopIteration as stop:
                ends.append(stop.value.record.y)
                break
    np.testing.assert_array_equal(mechanism.model.tab, before)
    np.testing.assert_array_equal(*ends)


# --- corners that sensors meet ---------------------------------------------------------------

SLIDING = """
bodies: {{slider: {{mass: 2, inertia: 1, velocity: [{}, 0]}}}}
joints: {{guide: {{type: prismatic, bodies: [ground, slider], axis: [1, 0, 0]}}}}
sensors: {{x: {{joint: guide}}, y: {{joint: guide, sign: -1, at_start: 0.3}}}}
forces: {{wall: {{type: applied_load, body: slider, direction: [1, 0], force: {}}}}}
solver: {{end: {} s, {}}}
output: {{every: 1 s}}
"""
TURNING = """
bodies: {{disc: {{mass: 2, inertia: {}, angular_velocity: [0, 0, {}]}}}}
joints: {{bearing: {{type: revolute, bodies: [ground, disc], at: [0, 0], axis: {}}}}}
sensors: {{x: {{joint: bearing}}}}
forces: {{detent: {{type: applied_load, body: disc, direction: {}, torque: {}}}}}
solver: {{end: {} s, {}}}
output: {{every: 1 s}}
"""
ADAPTIVE = METHODS[:4]


@pytest.mark.parametrize("method", METHODS)
@pytest.mark.parametrize("v", [2.0, -2.0, 30.0])
def test_a_wall_of_a_millimetre(method, v):
    """-1000 N over 1 mm takes 1 J of m v^2 / 2, whatever the speed and the way."""
    load = f'"-1000*{math.copysign(1, v)}*(abs(x) > 0.5)*(abs(x) < 0.501)"'
    r = run(SLIDING.format(v, load, 3 / abs(v), method))
    assert speed(r) == pytest.approx(math.copysign(math.sqrt(v * v - 1.0), v), rel=1e-9)
    book = r.outcome.statistics["energy_residual_relative"]
    assert book < 1e-9


@pytest.mark.parametrize("method", METHODS)
def test_turning_back_inside_it(method):
    """Half a joule does not suffice: it comes back as fast as it came."""
    r = run(SLIDING.format(math.sqrt(0.5), '"-1000*(x > 0.5)*(x < 0.501)"', 3, method))
    assert speed(r) == pytest.approx(-math.sqrt(0.5), rel=1e-9)


@pytest.mark.parametrize("method, tolerance", [
    (f"method: {method}", tolerance)
    for method in ("dop853", "radau", "generalized_alpha")
    for tolerance in (1e-2, 1e-4, 1e-8, 1e-10)
    if (method, tolerance) != ("generalized_alpha", 1e-10)  # of second order: nothing but steps
])  # fmt: skip
def test_work_of_features_at_any_tolerance(method, tolerance):
    """Several on one sensor, of all kinds; the work of each is an integral done by hand."""
    pieces = {
        "50*max(0, 1 - abs(x - 0.4)/1e-3)": 0.05,
        "-200*(x > 0.6)*(x < 0.6005)": -0.1,
        "100*step(x, 0.7, 0, 0.7001, 1)*(y > -0.4011)": 0.1 * 0.5 * 0.1 + 0.1,
        "min(max(1e4*(x - 0.9), 0), 10)*(1.0 - x > 0.098)": 0.5 * 10 * 1e-3 + 10e-3,
    }
    load = '"' + " + ".join(pieces) + '"'
    r = run(SLIDING.format(3.0, load, 1, f"tolerance: {tolerance}, {method}"))
    gained = sum(pieces.values())
    assert speed(r) == pytest.approx(math.sqrt(9.0 + gained), rel=max(1e-9, 1e-2 * tolerance))


@pytest.mark.parametrize("method", METHODS[:3])
@pytest.mark.parametrize("axis", ["[0, 0, 1]", "[0, 0, -1]"])
@pytest.mark.parametrize("omega", [20.0, -200.0])
def test_a_detent_of_a_degree_on_every_turn(method, axis, omega):
    """Its torque against the motion takes 2 w T from the energy each time it is passed."""
    w, torque, end = math.radians(0.5), 3.0, 2.0
    text = f'"{-math.copysign(torque, omega)}*(cos(x - 1) > {math.cos(w)!r})"'
    r = run(TURNING.format(1, -omega if "-" in axis else omega,
                           axis, axis, text, end, method))  # fmt: skip
    turned = r.outcome.record.y[2]
    first = 1.0 if omega > 0 else 2 * math.pi - 1.0
    passed = 1 + math.floor((abs(turned) - first) / (2 * math.pi))
    assert passed > 2
    expected = math.sqrt(omega**2 - 2 * passed * 2 * w * torque)
    assert abs(r.outcome.record.y[5]) == pytest.approx(expected, rel=1e-7)


@pytest.mark.parametrize("method", METHODS[:4])
def test_a_narrow_triangle_in_a_table_of_a_sensor(method):
    x = [0, 0.5, 0.5005, 0.501, 0.5015, 0.502, 10]
    y = [0, 0, 0, 1e3, 0, 0, 0]
    tab, none = np.array(table(x, y)), np.zeros((0, 2))
    work = 0.0
    for a, b in pairwise(x):
        for side in (-1, 1):
            at = 0.5 * (a + b) + side * (b - a) / math.sqrt(12)
            work += 0.5 * (b - a) * value(tab, 0, at, none)
    points = [list(p) for p in zip(x, y, strict=True)]
    r = run(SLIDING.format(3.0, f"{{table: {points}, of: x}}", 1, method))
    assert speed(r) == pytest.approx(math.sqrt(9.0 + work), rel=1e-7)


@pytest.mark.parametrize("method", METHODS[:3])
def test_an_oscillator_of_two_stiffnesses(method):
    """Half a period on each side of a corner where the force is zero, and none of it chatters."""
    r = run(
        SLIDING.format(1.0, '"-(200*max(x, 0) + 800*min(x, 0))"', 10, f"{method}, tolerance: 1e-8")
    )
    period = math.pi * (1 / 10 + 1 / 20)
    t = 10.0 % period
    expected = math.cos(10 * t) if t < math.pi / 10 else -math.cos(20 * (t - math.pi / 10))
    assert speed(r) == pytest.approx(expected, abs=1e-6)
    assert r.outcome.record.y[0] == pytest.approx(
        math.sin(10 * t) / 10 if t < math.pi / 10 else -math.sin(20 * (t - math.pi / 10)) / 20,
        abs=1e-6,
    )


@pytest.mark.parametrize("method", METHODS[:3])
def test_a_corner_that_moves(method):
    """What a sensor is compared with may depend on time: free fall of the corner itself."""
    r = run(SLIDING.format(1.0, '"-4*(x > 2*t - 0.5*t**2)*(x < 100)"', 3, method))
    # x = t is below 2 t - t^2/2 until t = 2, then -2 m/s^2; above until the parabolas meet again
    assert speed(r) == pytest.approx(1.0 - 2.0 * 1.0, abs=1e-8)


@pytest.mark.parametrize("method", METHODS[:3])
def test_at_rest_on_a_corner(method):
    """It stays where the forces of both sides hold it, and leaves where they do not."""
    r = run(SLIDING.format(0, '"10*(x < 0) - 10*(x > 0)"', 1, method))
    assert r.outcome.status == "done" and abs(r.outcome.record.y[0]) < 1e-9
    r = run(SLIDING.format(0, '"10*(x >= 0)*(x < 0.2)"', 1, method))
    assert speed(r) == pytest.approx(math.sqrt(2.0), rel=1e-7)


@pytest.mark.parametrize("method", METHODS[:2])
def test_ever_shorter_swings_about_a_corner(method):
    """m v' = -c v - F sign(x), from crossing to crossing by its closed form."""
    damper = (
        "damper: {type: spring_damper, bodies: [ground, slider], points: [[-1, 0], [0, 0]], "
        "stiffness: 0, damping: 20}"
    )
    text = SLIDING.format(1.0, '"10*(x < 0) - 10*(x > 0)"', 1, method)
    r = run(text.replace("forces: {", "forces: {" + damper + ", "))
    t, v, sign, k, a = 0.0, 1.0, 1.0, 10.0, 5.0  # c/m, F/m

    def place(tau):
        return (v + a / k) * (1.0 - math.exp(-k * tau)) / k - a / k * tau

    while True:
        top = math.log(1.0 + v * k / a) / k
        tau = brentq(place, top, 3.0 * top + 1e-9, xtol=1e-16)
        if t + tau > 1.0:
            break
        t, v, sign = t + tau, a / k - (v + a / k) * math.exp(-k * tau), -sign
    end = 1.0 - t
    assert r.outcome.record.y[0] == pytest.approx(sign * place(end), abs=1e-8)
    assert speed(r) == pytest.approx(sign * ((v + a / k) * math.exp(-k * end) - a / k), abs=1e-6)
    assert r.outcome.statistics["steps"] < 2000


SPATIAL = """
planar: false
bodies:
  arm: {{mass: 1, inertia: [0.01, 0.02, 0.02], at: [0.5, 0, 0], angular_velocity: [0, {0}, 0],
        velocity: [0, 0, {1}]}}
joints: {{hinge: {{type: revolute, bodies: [ground, arm], at: [0, 0, 0], axis: [0, 1, 0]}}}}
sensors: {{a: {{joint: hinge}}, s: {{type: displacement, bodies: [ground, arm], at: [0, 0, 0.0],
           axis: [0, 0, 1]}}}}
forces: {{detent: {{type: applied_load, body: arm, direction: [0, 1, 0], torque: "{2}"}}}}
solver: {{end: 2 s, {3}}}
output: {{every: 1 s}}
"""


@pytest.mark.parametrize("method", METHODS[:2])
def test_a_detent_about_another_axis(method):
    """About y, in space: the energy it takes is the same."""
    w, omega = math.radians(0.5), 17.0
    inertia = 0.02 + 0.25
    text = f"-1.5*(sin(a) > {math.cos(w)!r})"
    r = run(SPATIAL.format(omega, -0.5 * omega, text, f"{method}, tolerance: 1e-8"))
    turns = 0
    energy = 0.5 * inertia * omega**2
    left, at = 2.0, 0.0  # by hand: free turning from detent to detent
    while True:
        rate = math.sqrt(2 * energy / inertia)
        way = (math.pi / 2 - w if turns == 0 else 2 * math.pi - 2 * w) - at
        if left * rate < way:
            break
        left -= way / rate
        lost, slowed = 1.5 * 2 * w, math.sqrt(2 * (energy - 1.5 * 2 * w) / inertia)
        left -= 2 * w / (0.5 * (rate + slowed))
        energy -= lost
        turns += 1
    assert turns >= 5
    assert np.linalg.norm(r.outcome.record.y[10:13]) == pytest.approx(
        math.sqrt(2 * energy / inertia), rel=1e-6
    )


IMPLICIT = ["method: radau", "method: radau, tolerance: 1e-2", "method: generalized_alpha"]


@pytest.mark.parametrize("method", IMPLICIT)
def test_an_implicit_step_does_not_rest_in_what_is_stiff_behind_a_corner(method):
    """A soft wall of 0.17 mm, a stop of 1e7 N/m, a spring switched on: none of them damps."""
    accuracy = 2e-3 if "1e-2" in method else 2e-4 if "alpha" in method else 1e-5
    wall = '"11661.6*step5(abs(x), 0.98521, 0, 0.985379, 1)*(abs(x) < 0.985379)"'
    r = run(SLIDING.format(-4.7585131, wall, 1, method))
    expected = math.sqrt(4.7585131**2 - 0.5 * 11661.6 * (0.985379 - 0.98521))
    assert speed(r) == pytest.approx(-expected, rel=accuracy)
    r = run(SLIDING.format(2.0, '"-1e7*max(0, x - 0.5)"', 1, method))
    assert speed(r) == pytest.approx(-2.0, rel=accuracy)
    r = run(SLIDING.format(0.1, '"-2e4*(x - 0.06)*(t > 0.7)"', 0.8, method))
    t = 0.1 * 100  # omega is 100/s; it begins 0.01 m beside its middle, with 0.1 m/s
    assert speed(r) == pytest.approx(0.1 * math.cos(t) - math.sin(t), abs=20 * accuracy)


# --- short events of smooth functions: exp ---------------------------------------------------

WIDTHS = [1e-1, 1e-2, 1e-3, 1e-4]  # of the way
LONG_STEPS = ["method: dop853", "method: radau", "method: auto", "method: 'scipy:RK45'",
              "method: generalized_alpha"]  # fmt: skip


def gauss(w, work, x="x", a=0.4321):
    """A bump that does a work, or gives an impulse, wherever it is passed."""
    return f"{work / (w * math.sqrt(math.pi))}*exp(-(({x} - {a})/{w})**2)"


@pytest.mark.parametrize("tolerance", [1e-3, 1e-6])
@pytest.mark.parametrize("w", WIDTHS)
@pytest.mark.parametrize("method", LONG_STEPS)
def test_a_bump_of_a_sensor(method, w, tolerance):
    """Half of its work is done at its top, all of it behind; nothing else acts."""
    solver = f"tolerance: {tolerance}, {method}"
    r = run(SLIDING.format(1.0, f'"{gauss(w, 0.6)}"', 0.8, solver))
    assert speed(r) == pytest.approx(math.sqrt(1.6), rel=10 * tolerance)
    if "scipy" not in method:  # which have no events
        ends = "events: {top: {when: x, value: 0.4321, do: {end: true}}}\n"
        r = run(SLIDING.format(1.0, f'"{gauss(w, 0.6)}"', 0.8, solver) + ends)
        assert speed(r) == pytest.approx(math.sqrt(1.3), rel=10 * tolerance)


@pytest.mark.parametrize("w", WIDTHS)
@pytest.mark.parametrize("method", LONG_STEPS)
def test_a_hill_that_is_too_high(method, w):
    """Of height 1.2 J, for a mass of 1 J: it goes back as fast as it came."""
    hill = f'"{2 * 1.2 / w**2}*(x - 0.4321)*exp(-((x - 0.4321)/{w})**2)"'
    r = run(SLIDING.format(1.0, hill, 1.2, f"tolerance: 1e-6, {method}"))
    assert speed(r) == pytest.approx(-1.0, rel=1e-5)


@pytest.mark.parametrize("w", [1e-3, 1e-5, 1e-7])
@pytest.mark.parametrize("method", LONG_STEPS)
def test_a_bump_of_t(method, w):
    """Its impulse, at any width.  Steps of scipy's grow in number as it is approached: in the end
    it is as narrow there, with less of a way before it."""
    unit = 0.01 if "scipy" in method else 1.0
    kick = f'"{gauss(w, 3.0, "t", 4.321 * unit)}"'
    r = run(PUSHED.format(kick, 10 * unit, f"tolerance: 1e-6, {method}"))
    assert speed(r) == pytest.approx(1.5, rel=1e-5)


@pytest.mark.parametrize("w", [1e-2, 1e-4])
@pytest.mark.parametrize("method", LONG_STEPS)
def test_bumps_of_other_shapes(method, w):
    """A logistic switch on and off, and 1/cosh^2: works 0.5 J and 0.3 J, but for exp(-0.1/w)."""
    on, off = (f"1/(1 + exp(({a} - x)/{w}))" for a in (0.3, 0.5))
    pulse = f"2.5*({on} - {off})"
    sech = f"4*{0.15 / w}/(exp((x - 0.7)/{w}) + exp((0.7 - x)/{w}))**2"
    r = run(SLIDING.format(1.0, f'"{pulse} + {sech}"', 1.0, f"tolerance: 1e-6, {method}"))
    assert r.outcome.record.y[0] > 0.9
    assert speed(r) == pytest.approx(math.sqrt(1.8), rel=1e-5)


@pytest.mark.parametrize("method", METHODS[:3])
def test_a_detent_of_exp_on_every_turn(method):
    """exp(k (cos(x - 1) - 1)) against the motion: 2 pi exp(-k) I_0(k) of work a turn."""
    k, torque, omega, end = 4e6, 300.0, 20.0, 2.0
    text = f'"-{torque}*exp({k}*(cos(x - 1) - 1))"'
    r = run(TURNING.format(1, omega, "[0, 0, 1]", "[0, 0, 1]", text, end, method))
    passed = 1 + math.floor((r.outcome.record.y[2] - 1.0) / (2 * math.pi))
    assert passed > 2
    work = 2 * math.pi * i0e(k) * torque
    assert r.outcome.record.y[5] == pytest.approx(math.sqrt(omega**2 - 2 * passed * work), rel=1e-4)


@pytest.mark.parametrize("method", METHODS[:2])
@pytest.mark.parametrize("u", [-2.0, -2.0 - 1e-9, -1.999])
def test_swings_to_the_edge_of_a_well_and_back(method, u):
    """It turns back where exp has an edge: energy is kept, and no step is wasted there."""
    w, a, depth = 1e-2, 0.0, 5.0
    start = a + w * math.sqrt(-u)
    well = f'"{-2 * depth / w**2}*(x - {start})*exp(-((x - {start})/{w})**2)"'
    r = run(SLIDING.format(0.0, well, 0.05, method))
    assert r.outcome.statistics["energy_residual_relative"] < 1e-4
    assert abs(r.outcome.record.y[0] - start) <= w * math.sqrt(-u) * (1 + 1e-4)
    assert r.outcome.statistics["steps"] < 5000


@pytest.mark.parametrize("method", METHODS)
def test_floor_and_sign_of_t(method):
    """A staircase of nine steps, and a push that turns round three times."""
    accuracy = 1e-3 if "alpha" in method else 1e-9
    r = run(PUSHED.format('"floor(t)"', 10, method))
    assert speed(r) == pytest.approx(45 / 2, rel=accuracy)
    r = run(PUSHED.format('"sign(sin(t)) + 3*floor(0.3*t - 1)"', 10, method))
    push = (10 - 3 * math.pi) * -1 + math.pi  # + - + -
    stairs = 3 * (-10 / 3 + (10 - 20 / 3))
    assert speed(r) == pytest.approx((push + stairs) / 2, rel=accuracy)


@pytest.mark.parametrize("method", METHODS[:3])
def test_floor_and_sign_of_a_sensor(method):
    """Work over a staircase of strokes, there and back, and a jump of the force at zero."""
    text = PUSHED.replace("forces:", "sensors: {{x: {{joint: guide, at_start: -0.25}}}}\nforces:")
    r = run(text.format('"10 - floor(4*x)"', 2, f"{method}, tolerance: 1e-8"))
    # m v^2 / 2 = the work up to where it is: piece by piece
    x, v = r.outcome.record.y[0] - 0.25, speed(r)
    work = 11 * 0.25 + sum((10 - k) * 0.25 for k in range(math.floor(4 * x)))
    work += (10 - math.floor(4 * x)) * (x - math.floor(4 * x) / 4)
    assert x > 5
    assert v * v == pytest.approx(work, rel=1e-7)
    r = run(text.format('"-8*sign(x)"', 2, f"{method}, tolerance: 1e-8"))
    period = 4 * math.sqrt(2 * 0.25 / 4)  # parabolas with 4 m/s^2
    phase = 2 % period / period * 4
    at = {0: -1 + phase**2, 1: 1 - (2 - phase) ** 2, 2: 1 - (phase - 2) ** 2,
          3: (4 - phase) ** 2 - 1}[int(phase)]  # fmt: skip
    assert r.outcome.record.y[0] - 0.25 == pytest.approx(0.25 * at, abs=1e-7)


def test_an_arc_beyond_its_end_ends_the_run():
    """x = t^2/4 m leaves [-1, 1] at t = 2 s; the speed then is that of the push until there."""
    text = PUSHED.replace("forces:", "sensors: {{x: {{joint: guide}}}}\nforces:")
    r = run(text.format('"1 + 0*asin(x)"', 10, "method: dop853"), fails=True)
    assert "forces.kick" in r.outcome.reason and "of x, which goes beyond" in r.outcome.reason
    assert r.outcome.record.t == pytest.approx(2, abs=1e-4)


@pytest.mark.parametrize("method", METHODS)
def test_tables_by_straight_lines_and_by_splines(method):
    """The impulse of a table of t is its integral, whatever stands outside of it."""
    from scipy.interpolate import CubicSpline

    x, y = [1, 2, 2.001, 4, 7], [0, 5, -5, -4, 3]
    rows = [list(p) for p in zip(x, y, strict=True)]
    spline = CubicSpline([1, 2, 4, 7], [0, 3, 4, 3])
    smooth = float(spline.integrate(1, 7))
    start, end = float(spline(1, 1)), float(spline(7, 1))
    cases = {
        f"{{table: {rows}, interpolation: linear}}": np.trapezoid(y, x) + 3 * 3,
        f"{{table: {rows}, interpolation: linear, outside: extend}}":
            np.trapezoid(y, x) - 0.5 * 5 + 3 * 3 + 0.5 * 9 * 7 / 3,
        "{table: [[1, 0], [2, 3], [4, 4], [7, 3]], interpolation: spline, outside: extend}":
            smooth - 0.5 * start + 3 * 3 + 0.5 * 9 * end,
    }  # fmt: skip
    for text, impulse in cases.items():
        r = run(PUSHED.format(text, 10, method))
        accuracy = 1e-3 if "alpha" in method else 1e-8
        assert speed(r) == pytest.approx(impulse / 2, rel=accuracy)


def test_a_table_that_ends_ends_the_run_where_it_is_told_to():
    text = PUSHED.replace("forces:", "sensors: {{x: {{joint: guide}}}}\nforces:")
    table = "{table: [[0, 1], [0.5, 1], [1, 1]], of: x, interpolation: linear, outside: error}"
    r = run(text.format(table, 10, "method: dop853"), fails=True)
    assert "forces.kick" in r.outcome.reason and "a table that ends" in r.outcome.reason
    assert r.outcome.record.t == pytest.approx(2, abs=1e-4)


@pytest.mark.parametrize("kind", ["akima", "linear", "spline"])
def test_the_end_of_a_table_is_named_where_it_drives_beyond(kind):
    """Of a component of a wrench, too; whatever the accelerations there were."""
    r = run(
        f"""
bodies: {{a: {{mass: 1, inertia: 1, velocity: [1, 0]}}}}
sensors: {{x: {{type: point, body: a, at: [0, 0], axis: [1, 0, 0]}}}}
forces: {{push: {{type: wrench, body: a, force: [{{table: [[0, 1], [0.5, 2]], of: x,
          interpolation: {kind}, outside: error}}, 0]}}}}
solver: {{end: 1}}
""",
        fails=True,
    )
    assert "forces.push" in r.outcome.reason and "a table that ends" in r.outcome.reason
    assert r["x"][-1] == pytest.approx(0.5, abs=1e-3)


def test_a_drive_along_straight_lines_is_jolted_at_each_of_their_ends():
    """2 kg from 1 to 3 m/s: an impulse of 4 N s and 8 J."""
    r = run("""
bodies: {slider: {mass: 2, inertia: 1}}
joints: {guide: {type: prismatic, bodies: [ground, slider], axis: [1, 0, 0]}}
drives: {motor: {joint: guide, position: {table: [[0, 0], [1, 1], [2, 4]], interpolation: linear,
                                          outside: extend}}}
solver: {end: 3 s}
output: {every: 0.5 s}
""")
    np.testing.assert_allclose(r["slider.position"][:, 0], [0, 0.5, 1, 2.5, 4, 5.5, 7], atol=1e-9)
    assert r["energy.work.events"][-1] == pytest.approx(8.0, rel=1e-9)
