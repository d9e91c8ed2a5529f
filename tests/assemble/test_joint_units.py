"""A number along a joint has the unit of that joint: rad where it turns, m where it slides."""

import pytest

from trsim.errors import ScenarioError

from ..runs import built

TEXT = """
planar: true
bodies: {{mass: {{mass: 1, inertia: 1, at: [1, 0]}}}}
joints: {{j: {{type: {joint}}}}}
sensors: {{s: {{joint: j{sensor}}}}}
drives: {{d: {{joint: j, {drive}}}}}
forces: {{stop: {{type: limit_stop, joint: j, stiffness: {stiffness}, {limit}}}}}
"""
SLIDES = "prismatic, bodies: [ground, mass], axis: [1, 0]"
TURNS = "revolute, bodies: [ground, mass], at: [0, 0]"
FITS = {"sensor": "", "drive": "velocity: 1", "stiffness": "1e5", "limit": "upper: 1"}
WRONG = {
    "velocity of a slide": (SLIDES, {"drive": "velocity: 10 rpm"}, "velocity"),
    "velocity of a hinge": (TURNS, {"drive": "velocity: 3 mm/s"}, "velocity"),
    "limit of a slide": (SLIDES, {"limit": "lower: -30 deg"}, "lower"),
    "limit of a hinge": (TURNS, {"limit": "lower: -3 mm"}, "lower"),
    "stiffness of a slide": (SLIDES, {"stiffness": "1e5 N*m/rad"}, "stiffness"),
    "sensor of a slide": (SLIDES, {"sensor": ", at_start: 3 deg"}, "at_start"),
    "sensor of a hinge": (TURNS, {"sensor": ", at_start: 3 mm"}, "at_start"),
    "compliance of a slide": (
        SLIDES, {"drive": "velocity: 1, compliance: {stiffness: 1e4 N*m/rad}"}, "stiffness"),
}  # fmt: skip


@pytest.mark.parametrize("case", WRONG)
def test_wrong_unit(case):
    joint, change, key = WRONG[case]
    with pytest.raises(ScenarioError, match="wrong unit") as caught:
        built(TEXT.format(joint=joint, **{**FITS, **change}))
    assert caught.value.path[-1] == key


@pytest.mark.parametrize("joint, drive, limit", [
    (SLIDES, "velocity: 3 mm/s", "lower: -3 mm"),
    (TURNS, "velocity: 10 rpm", "lower: -30 deg"),
    (TURNS, "velocity: 1.5", "lower: -0.5"),
])  # fmt: skip
def test_fitting_units_and_plain_numbers(joint, drive, limit):
    change = {"drive": drive, "limit": limit}
    columns = {
        c.name: c.unit for c in built(TEXT.format(joint=joint, **{**FITS, **change})).columns
    }
    turns = joint == TURNS
    assert columns["stop.normal_force"] == ("N*m" if turns else "N")
    assert columns["stop.penetration"] == ("rad" if turns else "m")


@pytest.mark.parametrize("type_", ["revolute", "prismatic"])
def test_zero_axis_is_refused(type_):
    at = "at: [0, 0], " if type_ == "revolute" else ""
    with pytest.raises(ScenarioError, match="axis must not be zero") as caught:
        built(f"""
bodies: {{mass: {{mass: 1, inertia: 1, at: [1, 0]}}}}
joints: {{j: {{type: {type_}, bodies: [ground, mass], {at}axis: [0, 0, 0]}}}}
""")
    assert caught.value.path == ("joints", "j", "axis")
