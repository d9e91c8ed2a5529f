"""What of functions may have no value: what is proved to be all right is not looked at in a run."""

import pytest

from trsim.assemble.poles import DOMAIN, POLE, certain, doubts
from trsim.expressions import parse, substitute

from ..runs import built

SAFE = (
    "1/(0.1 + abs(x))",
    "x/sqrt(x*x + 1e-6)",
    "atan2(y, x)",
    "log(1 + t*t)",
    "sqrt(t)",
    "asin(sin(x))",
    "1/(2 + cos(50*x))",
    "1/(1 + exp(-x/0.01))",
    "x**3 + 2**x + x/3 + max(x, 0)**1.5",
    "1/(3 - t)",
    "tan(0.5*t)",
    "sqrt(smoothstep(x))/(1 + x**2)",
    "(1 + x*x*(y*y))**-0.5",
    "1/(1 + (x - 1)*(x - 1))",
)
DOUBTFUL = {
    "1/x": [POLE],
    "1/(t - 1)": [POLE],
    "tan(x)": [POLE],
    "tan(t)": [POLE],
    "x**-2": [POLE],
    "log(x)/y": [DOMAIN, POLE],
    "sqrt(1 - t)": [DOMAIN],
    "x**1.5": [DOMAIN],
    "x**y": [DOMAIN],
    "acos(x)": [DOMAIN],
    "1/sin(t)": [POLE],  # at pi, and at the start
    "1/(1/x)": [POLE, POLE],
}


def left(text, end=2.0):
    return [doubt.kind for doubt in doubts(substitute(parse(text), {})) if not certain(doubt, end)]


@pytest.mark.parametrize("text", SAFE)
def test_what_is_proved(text):
    assert left(text) == []


@pytest.mark.parametrize("text", DOUBTFUL)
def test_what_is_looked_for(text):
    assert left(text) == DOUBTFUL[text]


def test_only_functions_in_doubt_are_in_the_tables():
    text = """
bodies: {{b: {{mass: 1, inertia: 0.01}}}}
joints: {{g: {{type: prismatic, bodies: [ground, b], axis: [1, 0, 0]}}}}
sensors: {{x: {{joint: g}}}}
forces: {{p: {{type: applied_load, body: b, direction: [1, 0], force: "{}"}}}}
solver: {{end: 2}}
"""
    assert len(built(text.format("1/(1 + x**2)")).model.pole) == 0
    two = built(text.format("1/(x - 3) + tan(x) + 2/(x - 3)"))
    assert len(two.model.pole) == len(two.guards) == 2
    assert "x - 3" in two.guards[0].text and "tan(x)" in two.guards[1].text
