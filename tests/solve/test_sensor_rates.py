"""Loads that depend on rates of sensors: closed forms, and corners that no step passes over."""

import math

import numpy as np
import pytest

from tests.runs import built, run
from trsim.errors import ScenarioError

SLIDER = """
bodies: {{slider: {{mass: 2, inertia: 1, velocity: [{v}, 0]}}}}
joints: {{guide: {{type: prismatic, bodies: [ground, slider], axis: [1, 0, 0]}}}}
sensors: {{stroke: {{joint: guide}}}}
forces: {{load: {{type: applied_load, body: slider, direction: [1, 0], force: {f}}}}}
solver: {{end: {end} s, {method}}}
output: {{every: 0.25 s}}
"""
METHODS = ["method: dop853, tolerance: 1e-8", "method: radau, tolerance: 1e-8",
           "method: auto, tolerance: 1e-8", "method: 'scipy:RK45', tolerance: 1e-8",
           "method: rk4, step: 1 ms",
           "method: generalized_alpha, tolerance: 1e-8"]  # fmt: skip


def slide(f, v=0.0, end=10, method=METHODS[0]):
    return run(SLIDER.format(f=f, v=v, end=end, method=method), fails=None)


@pytest.mark.parametrize("method", METHODS)
def test_a_quadratic_damper(method):
    """v(t) = v0 / (1 + c v0 t / m), and what it takes is the kinetic energy that is lost."""
    c, v0 = 3.0, 4.0
    r = slide('"-3*stroke.rate*abs(stroke.rate)"', v0, 5, method)
    v = v0 / (1 + c * v0 * r.t / 2)
    accuracy = 1e-5 if "alpha" in method else 1e-7
    np.testing.assert_allclose(r["stroke.rate"], v, rtol=accuracy)
    lost = 0.5 * 2 * (v[-1] ** 2 - v0**2)
    assert r["energy.work.loads"][-1] == pytest.approx(lost, rel=10 * accuracy)
    assert np.abs(r["energy.residual"]).max() < 10 * accuracy * 16


@pytest.mark.parametrize("method", METHODS)
def test_a_damper_of_one_way(method):
    """Half swings inwards with c, outwards without: each from its own closed form."""
    k, m, c = 200.0, 2.0, 8.0
    w, d = math.sqrt(k / m), c / (2 * m)
    damped = math.sqrt(w * w - d * d)
    # from rest at x = 1 inwards for half a damped swing, and back out for half a free one
    loose = method.replace("1e-8", "1e-7") if "alpha" in method else method
    r = slide('"-200*(stroke - 1) - 8*min(stroke.rate, 0)"', 0.0, 2, loose)
    ratio = math.exp(-d * math.pi / damped)
    x, t, at = -1.0, 0.0, r.t
    expected = np.zeros_like(at)
    out = True  # it begins at -1 of the spring, and moves outwards
    while t < at[-1]:
        span = math.pi / (w if out else damped)
        inside = (at >= t) & (at <= t + span)
        tau = at[inside] - t
        if out:
            expected[inside] = x * np.cos(w * tau)
            x = -x
        else:
            wave = np.cos(damped * tau) + d / damped * np.sin(damped * tau)
            expected[inside] = x * np.exp(-d * tau) * wave
            x = -x * ratio
        t, out = t + span, not out
    accuracy = 1e-3 if "alpha" in method else 3e-7
    np.testing.assert_allclose(r["stroke"] - 1, expected, atol=accuracy)


@pytest.mark.parametrize("method", METHODS)
def test_a_narrow_band_of_a_rate(method):
    """Between 1 and 1.001 m/s it is pushed half as hard: 1 ms later at every speed behind."""
    r = slide('"2 - (stroke.rate > 1)*(stroke.rate < 1.001)"', 0.0, 10, method)
    accuracy = 1e-6 if "alpha" in method else 1e-9
    assert r["stroke.rate"][-1] == pytest.approx(10 - 1e-3, rel=accuracy)


@pytest.mark.parametrize("method", METHODS[:3])
def test_there_and_back_within_one_step(method):
    """A rate that comes into a band at its top and leaves it again: the impulse counts."""
    # v = 2 t - t^2 until it is 1 - 1e-4, at t = 0.99; then 0.5 (1 - t) more for as long as it is
    # above that, which is until t = 1.01: the load is a part of the push
    r = slide('"4*(1 - t)*(1 + 0.25*(stroke.rate > 0.9999))"', 0.0, 2, method)
    u0 = 0.01
    assert r["stroke.rate"][-1] == pytest.approx(0.9999 - (1 - u0 * u0), abs=1e-9)


@pytest.mark.parametrize("method", METHODS[:3])
@pytest.mark.parametrize("f", ["-1 - 5*((stroke.rate > 0) - (stroke.rate < 0))",
                               "1 - 5*(stroke.rate > 0.5)"])  # fmt: skip
def test_what_would_stick_ends_the_run_and_says_so(f, method):
    """v falls from 2 with 3 m/s^2 and would stay at 0, or with 2 m/s^2 and stay at 0.5."""
    r = slide(f'"{f}"', 2.0, 10, method)
    assert r.outcome.status == "failed"
    assert "forces.load.force: at t = " in r.outcome.reason and "friction" in r.outcome.reason
    at = float(r.outcome.reason.split("t = ")[1].split(" s")[0])
    assert at == pytest.approx(2 / 3 if "<" in f else 0.75, rel=1e-6)


def test_from_rest_on_a_jump_it_goes_or_ends_the_run():
    """5 N of friction by a function hold nothing back at rest: sign(0) is 0."""
    r = slide('"7 - 5*sign(stroke.rate)"', 0.0, 1)
    assert r["stroke.rate"][-1] == pytest.approx(1.0, rel=1e-6)
    r = slide('"3 - 5*sign(stroke.rate)"', 0.0, 1)
    assert r.outcome.status == "failed" and "forces.load.force" in r.outcome.reason
    # at rest on the jump it makes steps of 1e-7 s
    r = slide('"-5*sign(stroke.rate)"', 0.0, 0.01)
    assert r.outcome.status == "done" and not r["stroke"].any()


@pytest.mark.parametrize("limit", ["", "max_steps: 2000, "])
def test_what_a_jump_of_a_place_holds_is_named(limit):
    """1 N away from where the load leaps by 3 N: it can neither stay nor go; the other load has a
    function without corners."""
    even = "even: {{type: applied_load, body: slider, direction: [1, 0], force: 0*stroke}}, "
    text = SLIDER.replace("load:", f"{even}load:")
    f = '"1 - 3*(stroke > 0)"'
    r = run(text.format(f=f, v=0, end=1e6, method=f"{limit}{METHODS[0]}"), fails=None)
    assert r.outcome.status == "failed"
    assert "forces.load.force: what it depends on rests at a corner" in r.outcome.reason


@pytest.mark.parametrize("method", METHODS[:3])
def test_a_comparison_that_does_not_jump_is_no_friction(method):
    """A damper of one way by a comparison: swings die out about a rate of zero for a long time."""
    by_min = slide('"-200*stroke - 20*min(stroke.rate, 0)"', 1.0, 10, method)
    r = slide('"-200*stroke - 20*stroke.rate*(stroke.rate < 0)"', 1.0, 10, method)
    assert r.outcome.status == "done"
    np.testing.assert_allclose(r["stroke"], by_min["stroke"], atol=1e-7)


def test_a_table_of_a_rate_about_a_tilted_axis():
    """A rotor run up through a resistance that is there in a band of its speed only."""
    r = run("""
planar: false
bodies: {rotor: {mass: 1, inertia: [0.5, 0.5, 0.5]}}
joints: {axle: {type: revolute, bodies: [ground, rotor], at: [0, 0], axis: [1, 2, 3]}}
sensors: {turn: {joint: axle, sign: -1}}
forces:
  drag: {type: applied_load, body: rotor, direction: [1, 2, 3],
         torque: {table: [[0, 0], [19.98, 0], [19.99, 0], [20, 0.8], [20.01, 0],
                           [20.02, 0], [40, 0]], of: turn.rate}}
  motor: {type: applied_load, body: rotor, direction: [1, 2, 3], torque: -1}
solver: {end: 15 s, tolerance: 1e-9}
output: {every: 1 s}
""")
    from scipy.integrate import quad
    from scipy.interpolate import Akima1DInterpolator

    f = Akima1DInterpolator([0, 19.98, 19.99, 20, 20.01, 20.02, 40], [0, 0, 0, 0.8, 0, 0, 0])
    late = sum(quad(lambda v: 0.5 / (1 - f(v)) - 0.5, a, b, epsabs=1e-14)[0]
               for a, b in ((19.98, 19.99), (19.99, 20), (20, 20.01), (20.01, 20.02)))  # fmt: skip
    assert 1e-3 < late < 0.1  # s
    assert r["turn.rate"][-1] == pytest.approx(2 * (15 - late), rel=1e-8)


SWUNG = """
planar: false
bodies: {{rod: {{mass: 1, inertia: [0.02, 0.02, 0.02], at: [0.3, 0.2, 0.1], velocity: [0, 0, 1]}}}}
joints: {{pin: {{type: spherical, bodies: [ground, rod], at: [0, 0, 0]}}}}
sensors: {{way: {{type: displacement, bodies: [ground, rod], at: [0.5, 0.1, 0.3],
                 axis: [1, 1, 0]}}}}
forces: {{load: {{type: applied_load, body: rod, direction: [0, 0, 1],
         torque: "0.2*(way.rate > 0.5)*(way.rate < 0.501)"}}}}
gravity: [0, 0, -9.81]
solver: {{end: 4 s, tolerance: {}, {}}}
output: {{every: 4 s}}
"""


@pytest.mark.parametrize("tolerance", [1e-8, 1e-9])
def test_a_band_of_the_rate_of_a_point_in_space(tolerance):
    """With the steps the method chooses it is what it is with a thousand times as many."""
    free = run(SWUNG.format(tolerance, ""))
    short = run(SWUNG.format(1e-10, "max_step: 0.2 ms"))
    last = [x["way"][-1] for x in (free, short)]
    assert last[0] == pytest.approx(last[1], abs=300 * tolerance)
    assert free.outcome.record.steps < short.outcome.record.steps / 20
    none = run(SWUNG.replace("0.2*", "0*").format(1e-10, ""))
    assert abs(none["way"][-1] - last[1]) > 3e-5  # it matters


def test_what_cannot_stand_in_a_function():
    for text, what in (
        ("stroke.acceleration", "'stroke.acceleration' cannot stand in a function"),
        ("stroke.rates", "'stroke.rates' cannot stand in a function"),
        ("strike.rate", "no parameter or sensor named 'strike.rate'"),
    ):
        with pytest.raises(ScenarioError, match=what):
            built(SLIDER.format(f=f'"{text}"', v=0, end=1, method=""))
    with pytest.raises(ScenarioError, match=r"wrong unit: 'mm'; 'stroke\.rate' is in m/s"):
        built(SLIDER.format(f="{table: [[0 mm, 0], [1 mm, 1]], of: stroke.rate}", v=0, end=1,
                            method=""))  # fmt: skip


def test_rates_in_templates_are_those_of_the_instance():
    r = run("""
templates:
  cart:
    parameters: {c: 1}
    bodies: {block: {mass: 2, inertia: 1, velocity: [4, 0]}}
    joints: {guide: {type: prismatic, bodies: [ground, block], axis: [1, 0, 0]}}
    sensors: {way: {joint: guide}}
    forces:
      drag: {type: applied_load, body: block, direction: [1, 0], force: "-c*way.rate*abs(way.rate)"}
      more: {type: applied_load, body: block, direction: [1, 0],
             force: {table: [[-5, 5], [5, -5]], of: way.rate}}
instances: {one: {template: cart}, two: {template: cart, parameters: {c: 3}}}
solver: {end: 1 s, tolerance: 1e-9}
output: {every: 1 s}
""")
    # v' = -(c v^2 + v) / 2
    for name, c in (("one", 1), ("two", 3)):
        x = math.exp(-0.5) * 4 / (1 + 4 * c)
        assert r[f"{name}_way.rate"][-1] == pytest.approx(x / (1 - c * x), rel=1e-8)
