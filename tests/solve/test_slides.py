"""A load that jumps where a rate passes a value, and drives it back from both sides, as dry
friction would: no function tells what holds it there, and the run ends with that."""

import numpy as np
import pytest

from ..runs import run

BLOCK = """
bodies: {{block: {{mass: 2 kg, inertia: 0.01, velocity: [{v}, 0, 0]}}}}
joints: {{guide: {{type: prismatic, bodies: [{bodies}], axis: [1, 0, 0], at: [0, 0, 0]}}}}
sensors: {{x: {{joint: guide, sign: {sign}}}}}
forces: {{drag: {force}}}
solver: {{end: 3, method: {method}}}
"""
LOAD = "{{type: applied_load, body: block, direction: [1, 0, 0], force: '{}'}}"


def of(force, v=1.0, bodies="ground, block", sign=1, method="dop853"):
    return BLOCK.format(force=force, v=v, bodies=bodies, sign=sign, method=method)


@pytest.mark.parametrize("method", ["dop853", "radau", "auto"])
@pytest.mark.parametrize("bodies, sign", [("ground, block", 1), ("block, ground", -1)])
@pytest.mark.parametrize(
    "force, v, when",
    [
        ("-4*sign(x.rate)", 1.0, 0.5),
        ("-4*sign(x.rate)", -1.0, 0.5),
        ("-4*sign(x.rate - 0.3)", 1.0, 0.35),
        ("-4*sign(x.rate - 0.3)", 0.0, 0.15),
        ("2 - 4*(x.rate > 0.5)", 0.0, 0.5),
        ("1 - 4*floor(x.rate)", 0.2, 1.6),
    ],
)
def test_it_ends_where_it_would_be_held(method, bodies, sign, force, v, when):
    r = run(of(LOAD.format(force), v, bodies, sign, method), fails=True)
    assert r.outcome.time == pytest.approx(when, rel=1e-6)
    assert r.outcome.reason.startswith("forces.drag.force: at t = ")
    assert "driven back to it from both sides" in r.outcome.reason


@pytest.mark.parametrize("sign", ["+", "-"])
def test_a_damper_of_a_joint_is_named(sign):
    spring = "{type: joint_spring, joint: guide, damper: '4*sign(rate)'}"
    r = run(of(spring, float(sign + "1")), fails=True)
    assert r.outcome.time == pytest.approx(0.5, rel=1e-6)
    assert r.outcome.reason.startswith("forces.drag.damper: at t = 0.5")


@pytest.mark.parametrize(
    "force, v, end",
    [
        ("-4*(x.rate > 0.5)", 1.0, 0.5),  # nothing drives it back from below
        ("-4*(x.rate > 0.5) - 1", 1.0, 0.5 - 2.8 / 2),
        ("4*sign(x.rate - 0.3)", 0.2, 0.2 - 6),  # away from both sides
        ("1 + 2*sign(x.rate - 0.5)", 1.0, 1.0 + 4.5),
        ("2 + sign(x.rate - 0.5)", 0.0, 0.5 + 2 * 1.5),  # through it
    ],
)
def test_what_passes_goes_on(force, v, end):
    r = run(of(LOAD.format(force), v))
    assert r["x.rate"][-1] == pytest.approx(end, abs=1e-6)


@pytest.mark.parametrize("v", [1.0, -1.0])
def test_a_jump_of_a_place_does_not_hold_it(v):
    """Driven back from both sides of a place it swings about that: parabolas."""
    r = run(of(LOAD.format("-4*sign(x)"), v))
    period = 2 * 1.0 / 2 * 2  # out and back on both sides, at 2 m/s^2
    assert r["x.rate"][-1] == pytest.approx(v * (1 if 3 % period == 0 else -1), abs=1e-6)


@pytest.mark.parametrize("method", ["dop853", "radau", "auto"])
@pytest.mark.parametrize("where, last", [("x", 0.0), ("x - 0.02*t", 0.06)])
def test_a_place_that_comes_to_rest_on_a_jump_is_told(where, last, method):
    """It swings about 0, less and less, in ever shorter times; or about what moves slowly."""
    text = of(LOAD.format(f"-2 - 4*floor({where}) - 40*x.rate"), 0.05, method=method)
    r = run(text, "solver.tolerance=1e-5", fails=True)
    assert r.outcome.reason.startswith("forces.drag.force: at t = ")
    assert "what it depends on rests at a corner" in r.outcome.reason
    assert 0.0 < r["block.position"][-1, 0] + 1e-4 < last + 2e-4
    assert r.outcome.statistics["steps"] < 10000


@pytest.mark.parametrize("method", ["dop853", "radau"])
def test_a_place_that_comes_to_rest_on_a_kink_goes_on(method):
    r = run(of(LOAD.format("-200*x - 600*max(x, 0) - 60*x.rate"), 0.05, method=method))
    assert np.abs(r["block.position"][-1]).max() < 1e-6


@pytest.mark.parametrize("method", ["dop853", "auto"])
def test_what_rests_where_nothing_pushes_takes_no_short_steps(method):
    """Nudges to either side say that a sign is stiff beyond bounds: steps were 1e-7 s."""
    r = run(of(LOAD.format("-5*sign(x.rate)"), 0.0, method=method))
    assert np.abs(r["block.position"]).max() == 0.0
    assert r.outcome.statistics["steps"] < 50
