"""Messages about small slips: each names the thing that is wrong and what to write instead."""

from pathlib import Path

import pytest

from tests.small import SLIDER_CRANK
from trsim.assemble.assemble import assemble
from trsim.cli.check import contact_line
from trsim.errors import ModelError, TrsimError
from trsim.scenario.load import load, loads
from trsim.solve.diagnose.scales import scales
from trsim.solve.start.consistent import start

REVERSER = Path(__file__).parent.parent / "scenarios" / "thrust_reverser"
PUSHED = """
bodies: {{b: {{mass: 1, inertia: 1}}}}
joints: {{g: {{type: prismatic, bodies: [ground, b], axis: [1, 0, 0]}}}}
drives: {{d: {{joint: g, velocity: {}}}}}
"""


def shown(make) -> str:
    with pytest.raises(TrsimError) as caught:
        make()
    return caught.value.show()


@pytest.mark.parametrize(
    "text, words",
    [
        ("speed*2", ["no parameter named 'speed'", "Known: t."]),
        ("2/12 mm/s", ["a unit stands behind one number: '2/12 mm/s'", "in SI"]),
        ("0.9 m*cos(t)", ["a unit stands behind one number alone", "in SI", "{x: 0.9 m}"]),
        ("10*deg*t", ["no parameter named 'deg'", "is a unit", "{x: 10 deg}"]),
        ("sin(90 deg)", ["A unit cannot stand inside an expression", "{x: 90 deg}"]),
        ("2*3 mm/s", ["A unit cannot stand inside an expression", "{x: 3 mm/s}"]),
        ("010", ["a number does not begin with 0", "drop the zero"]),
        ("-007 mm/s", ["a number does not begin with 0"]),
    ],
)
def test_velocity(text, words):
    told = shown(lambda: assemble(loads(PUSHED.format(text))))
    assert all(word in told for word in words), told


@pytest.mark.parametrize("text", ["0", "0.5", "0e3", "0.0 m/s", "10 mm/s", "-0.25 + 0.5*t"])
def test_zeros_that_may_stand(text):
    assemble(loads(PUSHED.format(text)))


def test_a_leading_zero_in_parameters():
    told = shown(lambda: loads("parameters: {a: 010}\n" + PUSHED.format("a")))
    assert "parameters.a: a number does not begin with 0" in told


@pytest.mark.parametrize(
    "content, words",
    [
        (b"0, 1\n1, nan\n", ["row 2 of t.csv: 'nan' in column 2 is not a finite number"]),
        (b"0, 1\n1e400, 2\n", ["row 2", "'1e400' in column 1"]),
        (b"0, 1\n1, two\n", ["row 2", "'two' in column 2"]),
        (b"0; 1\n1; 2\n", ["row 1 of t.csv is not two numbers", "separated by commas"]),
        (b"0, 1, 2\n", ["row 1 of t.csv is not two numbers, but 3 columns"]),
        (None, ["there is no file 't.csv'", "There is no .csv file in that folder."]),
        (b"1, 2\n" * 250_000, ["larger than 1 MB", "Thin it out"]),
    ],
)
def test_tables(content, words, tmp_path):
    if content is not None:
        (tmp_path / "t.csv").write_bytes(content)
    told = shown(lambda: loads(PUSHED.format("{table: t.csv}"), folder=tmp_path))
    assert all(word in told for word in words), told


def test_a_large_scenario():
    told = shown(lambda: loads("a: 1\n" * 250_000))
    assert "larger than 1 MB" in told and "`table: name.csv`" in told


def test_extends_is_no_value_to_set():
    told = shown(lambda: loads(PUSHED.format(1), ["extends=other.yaml"]))
    assert "--set changes values once all files are merged" in told


def test_a_curve_that_leaves_its_data_has_a_line():
    table = "{table: [[0, 0], [1, 0], [2, 1], [3, 1.2]]}"
    (note,) = assemble(loads(PUSHED.format(table))).notes
    assert note.startswith("<text>:4:") and "drives.d.velocity: the Akima curve reaches" in note


def test_a_joint_out_of_reach_is_the_one_that_is_named():
    text = SLIDER_CRANK.replace("velocity: 5000 rpm", "position: t")
    far = text.replace("clearance: 0.5 mm, contact: pin", "clearance: 0")
    far = far.replace("joint: O, position: t", "joint: guide, position: 1 + t")
    scenario = loads(far)
    mechanism = assemble(scenario)
    with pytest.raises(ModelError) as caught:
        start(scenario, mechanism, True)
    assert caught.value.path[0] == "joints" and "stay open by up to" in caught.value.what


@pytest.fixture(scope="module")
def stow():
    scenario = load(REVERSER / "stow.yaml")
    mechanism = assemble(scenario)
    return scales(scenario, mechanism, start(scenario, mechanism, True))


def test_what_nothing_can_move_is_told_so(stow):
    (seat,) = [c for c in stow.contacts if c.name == "seat"]
    assert seat.mass == float("inf")
    told = contact_line({**vars(seat)})
    assert told == "seat: joints and drives fix it, it cannot vibrate"


def test_forces_have_a_unit(stow):
    (lug,) = [c for c in stow.contacts if c.name == "lug"]
    assert f"{lug.force:.2g} N (" in contact_line({**vars(lug)})


def test_rounding_is_no_motion():
    scenario = load(REVERSER / "clearance_ap_0.1mm.yaml")
    mechanism = assemble(scenario)
    found = scales(scenario, mechanism, start(scenario, mechanism, True))
    assert found.growth == found.decay == 0.0 and found.zeros > 0
