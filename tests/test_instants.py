"""Instants of expressions, and pulses that no step passes over."""

import math

import numpy as np
import pytest
from hypothesis import assume, given, settings
from hypothesis import strategies as st

from trsim.errors import ScenarioError
from trsim.expressions import parse, substitute
from trsim.instants import instants, peaked

from .runs import run
from .sizes import size

AROUND = (math.pi / 2 - math.acos(0.99), math.pi / 2 + math.acos(0.99))


@pytest.mark.parametrize(
    "text, times",
    [
        ("1000*(t>5)*(t<5.001)", [5.0, 5.001]),
        ("(2*t - 1 >= 3) + step(t, 1, 0, 1.5, 2)", [1.0, 1.5, 2.0]),
        ("smoothstep((t - 0.2)/0.1)", [0.2, 0.3]),
        ("sign(t - 0.3)", [0.3]),
        ("floor(0.4*t)", [2.5, 5.0, 7.5]),
        ("floor(0.08*t*t)", [math.sqrt(k / 0.08) for k in range(1, 8)]),
        ("acos(cos(t - 1))", [1.0, 1 + math.pi, 1 + 2 * math.pi]),
        ("-step5(3 - t, 0, 1, 1, 0)", [2.0, 3.0]),
        ("havsin(t*t, 4, 0, 9, 2)", [2.0, 3.0]),
        ("(x > t) + sin(t)", []),
        # whatever stands inside
        ("(t**2 > 4) + (x > t) + sin(t)", [2.0]),
        ("t*t*t - 3*t*t + 2*t > 0", [1.0, 2.0]),
        ("abs(sin(t))", [math.pi, 2 * math.pi, 3 * math.pi]),
        ("max(0, sin(t) - 0.99)*(t < 6)", [*AROUND, 6.0, *(2 * math.pi + t for t in AROUND)]),
        ("atan2(sin(t), cos(t))", [math.pi, 2 * math.pi, 3 * math.pi]),
        ("sqrt(t) > 1", [1.0]),
        ("log(1 + t) > exp(-1)", [math.exp(math.exp(-1)) - 1]),
        ("1/(t - 1) > 100", [1.0, 1.01]),  # at the pole, and where it comes back
        ("max(t - 1, 0) > 0", [1.0]),  # zero all the time before
        ("sin(t) >= 1", [math.pi / 2, 5 * math.pi / 2]),  # touches and turns back
        # linear to three samples a second apart
        ("sin(2*pi*t) + t - 0.5 > 0", [0.0706318548, 0.5, 0.9293681452]),
        ("(min(t, 2, 4 - t) > 1) + x", [1.0, 2.0, 3.0]),
        ("tan(t/2) > 0", [math.pi, 2 * math.pi, 3 * math.pi]),
    ],
)
def test_instants(text, times):
    assert instants(parsed(text), 10.0) == pytest.approx([t for t in times if t < 10.0], abs=1e-7)


def parsed(text):
    return substitute(parse(text), {})


def test_no_pulse_of_many_is_missed():
    """Narrow ones too: the roots of sin(w t) = c are known."""
    w, c, end = 2 * math.pi * 997.0, 0.9999, 10.0
    found = np.array(instants(parsed(f"sin({w!r}*t) > {c}"), end))
    first = (np.arange(9970) * 2 * math.pi + math.asin(c)) / w
    last = (np.arange(9970) * 2 * math.pi + math.pi - math.asin(c)) / w
    assert found == pytest.approx(np.sort(np.concatenate((first, last))), abs=1e-9)


def test_more_than_can_be_certain_is_refused():
    with pytest.raises(ScenarioError, match="changes its course more than"):
        instants(parsed("sin(1e6*t) > 0.99"), 10.0)


@settings(max_examples=min(settings().max_examples, size(30, 100)))
@given(st.lists(st.floats(0.01, 9.9), min_size=1, max_size=6), st.floats(-3.0, 3.0))
def test_every_root_of_a_polynomial(places, scale):
    """However near to each other they lie; twofold ones are touched."""
    assume(abs(scale) > 0.01)
    text = "*".join(f"(t - {a!r})" for a in places)
    found = np.array(instants(parsed(f"{scale!r}*{text} > 0"), 10.0))
    for a in places:
        assert np.min(np.abs(found - a)) < 1e-4


PUSHED = """
bodies: {{slider: {{mass: 2, inertia: 1}}}}
joints: {{guide: {{type: prismatic, bodies: [ground, slider], axis: [1, 0, 0]}}}}
forces: {{kick: {{type: applied_load, body: slider, direction: [1, 0], force: "{}"}}}}
solver: {{end: 10 s, method: {}}}
output: {{every: 1 s}}
"""


@pytest.mark.parametrize("method", ["auto", "radau", "generalized_alpha"])
@pytest.mark.parametrize("start", [5.0, 5.0123, 9.998])
def test_a_short_pulse_is_felt(method, start):
    """1000 N for 1 ms gives 2 kg half a metre per second, wherever the steps would have been."""
    r = run(PUSHED.format(f"1000*(t>{start})*(t<{start + 1e-3})", method))
    assert r.outcome.record.y[3] == pytest.approx(0.5, rel=1e-3)


@pytest.mark.parametrize("method", ["dop853", "radau", "auto", "scipy:RK45", "rk4"])
@pytest.mark.parametrize("tolerance", [1e-2, 1e-6, 1e-10])
def test_pulses_of_any_shape_of_t(method, tolerance):
    """Ten pulses, each acos(0.9999)/pi s long: their impulse is force times time."""
    if method == "scipy:RK45" and tolerance < 1e-6:
        pytest.skip("slow")
    text = PUSHED.format("1000*(cos(2*pi*t - 1) > 0.9999)", method)
    solver = f"tolerance: {tolerance}" if method != "rk4" else "step: 10 ms"
    r = run(text.replace("solver: {end: 10 s,", f"solver: {{end: 10 s, {solver},"))
    impulse = 1000 * 10 * math.acos(0.9999) / math.pi
    assert r.outcome.record.y[3] == pytest.approx(impulse / 2, rel=1e-9)


@pytest.mark.parametrize(
    "text, expected",
    [
        ("1/(1 + (t/1e-4)**2)", True),
        ("cos(t)**1000", True),
        ("0.5**(t**2)", True),
        ("2*abs(t)**0.5", True),
        ("1/(1 + exp(-t/1e-4))", False),
        ("(t/3)**2*exp(-((t - 1)/1e-4)**2)", False),
        ("sin(t)**2/7", False),
        ("2**pi*t", False),
    ],
)
def test_what_may_be_a_short_event_without_a_corner(text, expected):
    assert peaked(parse(text)) is expected


def test_a_check_names_loads_that_may_be_short_events():
    from trsim.assemble.assemble import assemble
    from trsim.scenario.load import loads
    from trsim.solve.diagnose.skipped import skipped

    for force, named in (("1/(1 + (t/1e-4)**2)", True), ("exp(-(t/1e-4)**2)", False)):
        scenario = loads(
            "bodies: {slider: {mass: 2, inertia: 1}}\n"
            f"forces: {{kick: {{type: applied_load, body: slider, direction: [1, 0], "
            f'force: "{force}"}}}}\n'
            "solver: {end: 1 s}\noutput: {every: 1 s}\n",
            (),
        )
        told = [text for text in skipped(scenario, assemble(scenario)) if "kick" in text]
        assert bool(told) is named
