"""Time scales of a start: the bounds hold in a run."""

from math import inf, pi, sqrt

import numpy as np
import pytest

from trsim.errors import ScenarioError
from trsim.scenario.load import load
from trsim.solve.diagnose.scales import scales
from trsim.solve.diagnose.skipped import skipped
from trsim.solve.start.consistent import start
from trsim.solve.start.projected import projected

from ..linkages import REVERSER, slider_crank
from ..mechanisms import SPEED, central_impact, p1_slider_crank
from ..runs import assemble, run, scenario
from .test_linearised import oscillator


def begun(text, *sets):
    """Scenario, mechanism and start."""
    read = scenario(text, *sets)
    mechanism = assemble(read)
    return read, mechanism, start(read, mechanism, located=True)


END = "solver: {end: 1}"


def test_frequency_and_decay():
    found = scales(*begun(oscillator(2.0, 450.0, 6.0) + END))
    assert found.frequency == pytest.approx(sqrt(225 - 1.5**2), rel=1e-6)
    assert found.decay == pytest.approx(1.5, rel=1e-6)
    assert found.growth == 0.0 and found.zeros == 0
    assert found.natural_time == pytest.approx(2 * pi / found.frequency, rel=1e-12)
    assert found.fastest_is == "the linearised motion at the start"


@pytest.mark.parametrize("damping", [0.0, 4000.0])
def test_rk4_is_stable_below_the_bound_and_not_above(damping):
    text = oscillator(2.0, 45.0, damping).replace("inertia", "velocity: [1, 0], inertia")
    h = scales(*begun(text + END)).explicit_step
    largest, steps = [], 400 if damping else 3000
    for factor in (0.99, 1.01):
        rk4 = f"method: rk4, force: true, step: {factor * h!r}, end: {steps * h!r}"
        r = run(text + f"output: {{every: {3 * h!r}}}\nsolver: {{{rk4}}}")
        largest.append(np.abs(r["mass.velocity"]).max())
    assert largest[0] < 1.001 < 3.0 < largest[1]  # the spring is linear up to 5


def test_a_step_beyond_the_bound_is_refused_by_name():
    text = oscillator(2.0, 45.0, 0.1).replace("inertia", "velocity: [1, 0], inertia") + END
    h = scales(*begun(text)).explicit_step
    rk4 = ("solver.method=rk4", "solver.end=1", f"solver.step={1.01 * h!r}")
    with pytest.raises(ScenarioError, match="not stable: rk4 needs at most") as caught:
        run(text, *rk4)
    assert caught.value.path == ("solver", "step")
    assert run(text, *rk4, "solver.force=true").outcome.time == 1.0
    assert run(text, *rk4[:2], f"solver.step={0.99 * h!r}").outcome.status == "done"


def test_contact_of_a_slider():
    """Mass, stiffness and duration of an impact, against a run."""
    text = central_impact().replace("restitution:", f"slowest_impact: {SPEED}, restitution:")
    [contact] = scales(*begun(text)).contacts
    assert contact.mass == pytest.approx(1.0, rel=1e-12) and not contact.closed
    assert contact.stiffness == pytest.approx(1.5e9 * sqrt(contact.depth), rel=1e-12)
    assert contact.half_period == pytest.approx(pi * sqrt(1.0 / contact.stiffness), rel=1e-12)
    r = run(text)
    onset, separation = r.events[:2, 0]
    assert contact.impact_time == pytest.approx(separation - onset, rel=1e-6)


def test_friction_ramp():
    [contact] = scales(*begun(p1_slider_crank(friction=True))).contacts
    # the pin drives the slider sideways against its guide: only the rod turns and moves
    assert contact.friction_rate > 0.01 * contact.force / 9e-4 / 0.21
    [smooth] = scales(*begun(p1_slider_crank())).contacts
    assert smooth.friction_rate == 0.0 and smooth.half_period == contact.half_period


def test_a_contact_that_nothing_can_move():
    text = slider_crank("true", "drives: {motor: {joint: A, velocity: 5}}\nforces: {stop: {type: "
                        "limit_stop, joint: track, lower: -1, stiffness: 1e6}}")  # fmt: skip
    found = scales(*begun(text))
    assert found.contacts[0].half_period == inf and found.explicit_step == inf
    assert found.eigenvalues == () and found.fastest_is == ""


def test_the_reverser_is_limited_by_its_friction():
    found = scales(*begun(load(REVERSER / "clearance_ab_0.3mm.yaml")))
    assert found.fastest_is == "friction of A"
    assert [c.name for c in found.contacts if c.closed] == ["B", "seat"]
    assert found.explicit_step < 0.1 * min(c.half_period for c in found.contacts) * 2


# --- what the start changed ------------------------------------------------------------------


def test_projected_residuals():
    exact = slider_crank("true", "drives: {motor: {joint: A, velocity: 5}}")
    found = projected(*begun(exact)[1:])
    assert found.position_before < 1e-15 and found.shift < 1e-15
    assert found.velocity_before == pytest.approx(5.0) and found.velocity_row == "motor.motion"
    assert found.velocity_after < 1e-12


def test_projected_distance():
    text = slider_crank("true", "initial: {track: 0.05}")
    found = projected(*begun(text)[1:])
    assert found.position_before < 1e-15 and found.position_after < 1e-12
    # all of the slider, and more of the rod's centre than nothing; the crank turns most
    assert found.shift >= 0.05 - 1e-12
    assert found.turn_body == "crank" and found.turn > 0.1


# --- what is left out ------------------------------------------------------------------------


def left_out(text, *sets):
    read, mechanism, _ = begun(text, *sets)
    return " | ".join(skipped(read, mechanism))


def test_skipped():
    plane = left_out(slider_crank("true"))
    assert "3 of 6 unknowns of a body" in plane and "12 rows of the joints" in plane
    assert "contact events: no joint has clearance" in plane and "weight" in plane
    space = left_out(slider_crank("false"))
    assert "out of the plane" not in space and "3 redundant rows (B.tilt 2" in space
    assert "rk4 has a fixed step" in left_out(
        p1_slider_crank(), "solver.method=rk4", "solver.step=1e-6"
    )
    assert "friction: no contact law has any" in left_out(p1_slider_crank())
    assert "friction" not in left_out(p1_slider_crank(friction=True))
    assert "play of C: clearance 0" in left_out(p1_slider_crank(clearance="0 mm"))
    assert "`sweep`" in left_out(slider_crank("true", "sweep: {solver.end: [1, 2]}"))
    free = "bodies: {a: {mass: 1, inertia: 1}}\n"
    assert "nothing is factorised" in left_out(free + END)
    assert "a run" not in left_out(free + END)
    endless = scenario(free)
    assert "a run: `solver.end` is not given" in " | ".join(skipped(endless, assemble(endless)))
