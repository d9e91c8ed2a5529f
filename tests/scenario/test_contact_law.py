"""Contact laws as they are written."""

import pytest

from trsim.errors import ScenarioError
from trsim.scenario.contact_law import ContactLaw
from trsim.scenario.load import loads

SCENE = """
parameters: {{K: 2 kN/m, n: 1}}
bodies: {{ball: {{mass: 1 kg, inertia: 0.01, at: [0, 1]}}}}
contact_laws: {{law: {{normal: impact, stiffness: {}, exponent: {}, damping: 10, ramp: 1 mm}}}}
solver: {{end: 1}}
"""


def law(stiffness, exponent) -> ContactLaw:
    return loads(SCENE.format(stiffness, exponent)).contact_laws["law"]


@pytest.mark.parametrize(
    "stiffness, exponent",
    [("2 kN/m", 1), ("K", 1), ("K", "n"), ("2*n*1000", 1), (2000, 1), (".02 N/cm^1.5", 1.5),
     ("2e3 N/m^2", 2)],
)  # fmt: skip
def test_a_stiffness_has_the_unit_of_its_exponent(stiffness, exponent):
    found = law(stiffness, exponent).stiffness
    assert found == pytest.approx(20.0 if "cm" in str(stiffness) else 2000.0, rel=1e-14)


@pytest.mark.parametrize(
    "stiffness, exponent, told",
    [("2 kN/m^1.5", 1, "(?m)a stiffness, in N/m$"), ("2 kN/m", 1.5, "this number is in N/m.1.5"),
     ("K", 2, "in N/m.2"), ("hertzz", 1, "one of the words")],
)  # fmt: skip
def test_another_unit_is_refused(stiffness, exponent, told):
    with pytest.raises(ScenarioError, match=told):
        law(stiffness, exponent)
