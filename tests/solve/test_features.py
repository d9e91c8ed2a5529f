"""Corners of loads and drives: steps end there, and none is passed over."""

import math
from itertools import pairwise

import numpy as np
import pytest

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
           "method: rk4, step: 30 ms", "method: generalized_alpha, step: 30 ms"]  # fmt: skip


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
    from trsim.solve.simulate import simulate
    from trsim.spec.load import loads

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
