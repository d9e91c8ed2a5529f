"""How fast functions swing, against the rates of their phases."""

import math

import numpy as np
import pytest

from trsim.expressions import parse
from trsim.laws.functions import expression, motion, slots_of
from trsim.laws.waves import swing, waves

PHASES = [
    "3 - t*t + 2*t",
    "1/(1 + t**2)",
    "t**3",
    "(1 + t)**-1.5",
    "2**t",
    "(t - 5)**3",
    "(t - 0.36)*(t - 0.36)",
    "-cos(3*t) + tan(t/2)",
    "atan2(t - 0.36, 0.01)",
    "exp(-((t - 0.36)/0.02)**2)",
    "1/(1 + ((t - 1.19)/0.02)**2)",
    "sin(3*t)*log(3 + t)",
    "sqrt(1 + t*t)",
    "min(t*t, 9, t + 40)",
    "smoothstep(t/3)",
    "step5(sin(t), -2, t, 3 + t, 7)",
    "asin(t/2)*t",
    "acos(t*t/3 - 0.4)",
]


def swung(text, t, length, inputs=(), before=(), behind=(), sines=1):
    """The bound of an expression over a stretch; of each sensor a pair at its ends."""
    code = expression(parse(text), {name: k for k, name in enumerate(inputs)})
    tab = np.array([0.0, 0.0, *code])
    box = np.zeros((slots_of(code), 4))
    ends = [[np.array([x[k] for x in end], float) for k in (0, 1)] for end in (before, behind)]
    return swing(tab, 2, (t, length), *map(tuple, ends), (sines, box))


@pytest.mark.parametrize("text", PHASES)
@pytest.mark.parametrize("t", [0.31, 1.13])
@pytest.mark.parametrize("length", [0.0, 0.1])
def test_a_wave_swings_as_fast_as_its_phase(text, t, length):
    """As the fastest rate of its phase in the stretch; at an instant as that and its waves."""
    phase = np.array(expression(parse(f"7*({text})"), {}))
    rates = [abs(motion(phase, 0, t + length * x)[1]) for x in np.linspace(0.0, 1.0, 101)]
    w = swung(f"sin(7*({text}))", t, length)
    assert max(rates) * (1 - 1e-9) <= w < math.inf
    if length == 0.0:
        assert w == pytest.approx(max(rates) + swung(text, t, 0.0), rel=1e-9)


@pytest.mark.parametrize(("text", "w"), [
    ("sin(5*t)*cos(3*t)", 8.0), ("sin(5*t)**3", 15.0), ("sin(5*t) + cos(3*t)", 5.0),
    ("exp(sin(5*t))", 5.0), ("2 + t", 0.0), ("max(sin(5*t), t)", 5.0), ("0*sin(5*t)", 0.0),
    ("1/(1 + (20*(t - 0.35))**2)", 40.0), ("log(1 + (20*(t - 0.35))**2)", 40.0),
    ("(2 - (2*(t - 0.35))**2)**20", 4.0), ("(1 + (20*(t - 0.35))**2)**-3", 120.0),
    ("(1 + 2*t)**8", 0.0), ("(0.1 + t)**1000", 0.0), ("atan2(t - 0.35, 0.01)", 100.0),
    ("1/(1 + 2*t)", 0.0), ("log(1 + 2*t)", 0.0), ("(1 + 2*t)**20", 0.0), ("(1 + 2*t)**-3", 0.0),
])  # fmt: skip
def test_of_what_waves_are_made(text, w):
    assert swung(text, 0.3, 0.1) == pytest.approx(w, rel=1e-9)


def test_waves_of_waves():
    """Of sin(100 sin(5 t)): as fast as 500 rad/s, though it is at rest where sin turns back."""
    turning = math.pi / 10
    assert swung("sin(100*sin(5*t))", turning, 0.0) == pytest.approx(5.0, rel=1e-6)
    assert swung("sin(100*sin(5*t))", turning - 0.3, 0.6) >= 500.0


def test_of_what_a_sensor_shows():
    """What begins and ends at rest went faster between."""
    sensed = {"inputs": ["x"], "before": [(1.0, 0.0)], "behind": [(2.0, 0.0)]}
    assert swung("sin(10*x)", 0.0, 0.5, **sensed) >= 10.0 * math.pi / 2 * 2.0
    turning = {"inputs": ["x"], "before": [(1.0, -3.0)], "behind": [(1.0, 2.0)]}
    assert swung("sin(10*x)", 0.0, 0.5, **turning) == pytest.approx(30.0, rel=1e-9)


def test_beside_a_pole_the_ends_say_how_fast():
    """1/(t - 1) from 0.9 to 1.05: no bound, -100 at its begin and -400 at its end."""
    assert swung("sin(1/(t - 1))", 0.9, 0.15) == pytest.approx(400.0, rel=1e-9)
    assert swung("sin(1/(t - 1))", 1.0, 0.0) == 0.0


def test_what_holds_a_wave():
    with_waves = "1 + sin(t)", "tan(t)", "1/t", "log(t)", "t**9", "t**-1.5"
    for text in with_waves:
        assert waves(expression(parse(text), {})), text
    for text in ("t*t", "t/2", "t**8", "2**t", "exp(t) + abs(t)", "acos(t)"):
        assert not waves(expression(parse(text), {})), text
    assert not waves([0.0, 3.0])
