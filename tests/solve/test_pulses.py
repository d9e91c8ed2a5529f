"""Short pulses of loads: no step passes over one, whatever it is made of and whatever tells it."""

import numpy as np
import pytest
from scipy.integrate import quad

from ..runs import run

# of the time or of the place X, at A, about W wide: its integral in units of W, and W
AT, FIFTH = 0.50217, "((X - A)/W)**5"
STEEP = 2.0 * quad(lambda u: (np.arctan(10 * (u**5 + 1)) - np.arctan(10 * (u**5 - 1))) / 2
                   / np.arctan(10), 0, np.inf, limit=1000)[0]  # fmt: skip
PULSES = {
    "1/(1 + ((X - A)/W)**2)": (np.pi, 1e-5),
    "1/(1 + ((X - A)/W)**8)": (np.pi / 4 / np.sin(np.pi / 8), 1e-5),
    "(1 + ((X - A)/W)**2)**-1.5": (2.0, 1e-5),
    "(1 - (X - A)**2)**10000000": (np.sqrt(np.pi), 1e-7**0.5),
    "cos(X - A)**20000000": (np.sqrt(np.pi), 1e-7**0.5),
    "exp(-((X - A)/W)**2)": (np.sqrt(np.pi), 1e-5),
    f"(atan2(0.1, {FIFTH} - 1) - atan2(0.1, {FIFTH} + 1))/(2*atan2(10, 1))": (STEEP, 1e-5),
}
BLOCK = """
planar: true
bodies: {block: {mass: 2, inertia: 1, velocity: [SPEED, 0]}}
joints: {rail: {type: JOINT, bodies: [ground, block]WHERE}}
SENSORS
forces: {push: {type: applied_load, body: block, direction: [1, 0], force: "LAW"}}
solver: {end: 1, tolerance: 1e-7, method: METHOD}
output: {every: 0.1}
"""
SLIDES = {"JOINT": "prismatic", "WHERE": ", axis: [1, 0, 0]"}
HELD = {"JOINT": "fixed", "WHERE": ", at: [0, 0]"}
METHODS = ("dop853", "radau", "scipy:RK45")


def pulsed(pulse, method, of="t", at=AT, size=None, **joint):
    """A run of a block that such a load pushes; its integral is that of the pulse unless sized."""
    wide = PULSES[pulse][1] if pulse in PULSES else 1.0
    law = pulse.replace("A)", f"{at!r})").replace("W", repr(wide)).replace("X", of)
    text = BLOCK.replace("LAW", f"{size or 1 / wide!r}*{law}").replace("METHOD", method)
    text = text.replace("SPEED", "1" if of == "x" else "0")
    text = text.replace("SENSORS", "sensors: {x: {joint: rail}}" if of == "x" else "")
    for key, value in (joint or SLIDES).items():
        text = text.replace(key, value)
    return run(text)


def given(pulse, got, error=2e-5):
    """Tails of the first pulse go beyond the run."""
    tails = 4e-5 * np.pi if pulse.startswith("1/") and pulse.endswith("**2)") else 0.0
    assert got == pytest.approx(PULSES[pulse][0], rel=error, abs=tails)


@pytest.mark.parametrize("method", METHODS)
@pytest.mark.parametrize("pulse", PULSES)
def test_of_the_time(pulse, method):
    """The impulse is what the block leaves with."""
    given(pulse, 2.0 * pulsed(pulse, method)["block.velocity"][-1, 0])


@pytest.mark.parametrize("method", METHODS[:2])
@pytest.mark.parametrize("pulse", PULSES)
def test_of_the_place(pulse, method):
    """What it gives to the block is its work, by which v^2 grows, m = 2."""
    given(pulse, pulsed(pulse, method, of="x")["block.velocity"][-1, 0] ** 2 - 1.0)


@pytest.mark.parametrize("method", METHODS[:2])
@pytest.mark.parametrize("pulse", PULSES)
def test_while_nothing_moves(pulse, method):
    """No error of a motion tells of it, and the reaction has its peak all the same."""
    r = pulsed(pulse, method, size=70.0, **HELD)
    assert r.largest("push.magnitude")[0] == pytest.approx(70.0, rel=1e-6)
    k = r.place["rail.reaction"][0]
    assert r.outcome.peaks[k, 2] == pytest.approx(-70.0, rel=1e-6)


@pytest.mark.parametrize("at", [0.4133, 0.4391, 0.4717, 0.5003, 0.5239])
@pytest.mark.parametrize("pulse", PULSES)
def test_wherever_it_falls(pulse, at):
    """Not by chance next to a stage of a step."""
    given(pulse, 2.0 * pulsed(pulse, "dop853", at=at)["block.velocity"][-1, 0])


def test_what_is_smooth_costs_nothing_more():
    """Quotients and powers that are no pulses leave steps as they are."""
    plain = pulsed("cos(X - A)", "dop853").outcome.statistics["steps"]
    for law in ("1/(2 + X)", "(1 + X)**-2", "log(3 + X)"):
        found = pulsed(f"cos(X - A)*{law}", "dop853").outcome.statistics["steps"]
        assert found <= plain + 5


@pytest.mark.parametrize("at, steps", [(0.31, 100), (2.0, 0)])
def test_of_a_motion_that_an_event_sets(at, steps):
    """Its clock begins at the event; one that nothing ever follows takes no steps."""
    text = """
planar: true
bodies: {wheel: {mass: 1, inertia: 1}}
joints: {pin: {type: revolute, bodies: [ground, wheel], at: [0, 0]}}
drives: {motor: {joint: pin, velocity: "0*t"}}
sensors: {angle: {joint: pin}}
events:
  go:
    {when: t, value: AT, do: {set: {motor: {velocity: "1e5/(1 + ((t - 0.2022)/1e-5)**8)"}}}}
solver: {end: 1, tolerance: 1e-7, method: dop853}
output: {every: 0.1}
"""
    r = run(text.replace("AT", str(at)))
    plain = run(text[: text.index("events")] + text[text.index("solver") :])
    more = r.outcome.statistics["steps"] - plain.outcome.statistics["steps"]
    assert more > steps if steps else more == 0
    turned = np.pi / 4 / np.sin(np.pi / 8) if steps else 0.0
    assert r["angle"][-1] == pytest.approx(turned, abs=1e-6)
