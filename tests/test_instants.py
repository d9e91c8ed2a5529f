"""Instants of expressions, and pulses that no step passes over."""

import pytest

from trsim.expressions import parse
from trsim.instants import instants

from .runs import run


@pytest.mark.parametrize(
    "text, times",
    [
        ("1000*(t>5)*(t<5.001)", {5.0, 5.001}),
        ("(2*t - 1 >= 3) + step(t, 1, 0, 1.5, 2)", {2.0, 1.0, 1.5}),
        ("smoothstep((t - 0.2)/0.1)", {0.2, 0.3}),
        ("-step5(3 - t, 0, 1, 1, 0)", {3.0, 2.0}),
        ("(t**2 > 4) + (x > t) + sin(t)", set()),
    ],
)
def test_instants(text, times):
    assert sorted(instants(parse(text))) == pytest.approx(sorted(times), abs=1e-12)


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
