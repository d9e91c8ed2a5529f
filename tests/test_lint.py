"""Warnings about numbers that are probably not meant."""

from pathlib import Path

import pytest

from trsim.scenario.lint import lint
from trsim.scenario.load import load, loads

from .small import SLIDER_CRANK

FOLDER = Path(__file__).parent.parent / "scenarios"

SCENARIO = """\
bodies:
  crank: {mass: 1, inertia: 0.01, at: [0.1, 0]}
  rod: {mass: 1, inertia: [0.001, 0.02, 0.02], at: [0.35, 0]}
joints:
  A: {type: revolute, bodies: [ground, crank], at: [0, 0]}
  B: {type: revolute, clearance: 0.3 mm, contact: pin, bodies: [crank, rod], at: [0.2, 0]}
  C: {type: revolute, bodies: [ground, rod], at: [0.5, 0]}
forces:
  stop: {type: limit_stop, joint: A, upper: 1, stiffness: 1e4, damping: 1}
contact_laws:
  pin: {normal: lankarani_nikravesh, stiffness: internal, bearing_radius: 10 mm, width: 15 mm,
        youngs_modulus: 207 GPa, poisson: 0.29, restitution: 0.9,
        friction: {law: modified_coulomb, coefficient: 0.3, v0: 1e-4, v1: 1e-3}}
solver: {end: 1 s}
"""
RK4 = "solver: {method: rk4, step: "


def found(*changes: tuple[str, str]) -> tuple[str, ...]:
    text = SCENARIO
    for old, new in changes:
        assert old in text
        text = text.replace(old, new)
    return lint(loads(text))


def test_silent():
    assert found() == ()


@pytest.mark.parametrize("metres, told", [("0.16, length: 0.04", False), ("160, length: 40", True)])
def test_a_heap_on_a_drum(metres, told):
    """What follows from a shape may be wide around its joint, but less than a wrong unit is."""
    notes = lint(
        loads(f"""
bodies: {{heap: {{mass: 4 kg, shape: [{{cylinder: {metres}, at: [0.01, 0, 0]}}]}}}}
joints: {{axle: {{type: revolute, bodies: [ground, heap], at: [0, 0]}}}}
""")
    )
    assert any("radius of gyration" in note for note in notes) == told


@pytest.mark.parametrize("path", sorted(FOLDER.rglob("*.yaml")), ids=lambda p: p.stem)
def test_silent_on_the_repository(path):
    notes = lint(load(path))
    if path.stem == "pendulum_a01":  # a point mass is meant, and told from a slip it cannot be
        assert len(notes) == 1 and "radius of gyration" in notes[0]
    elif (
        path.stem == "flexible_pendulum"
    ):  # fully integrated on purpose, as in what it is compared with
        assert len(notes) == 1 and "stretching: `full` locks" in notes[0]
    elif "flexible_rod" in path.stem:  # a short bar, as published; two with its mass too
        assert "6.3 times as long as thick" in notes[0]
        of_mass = ["the bar has 3.45 kg where `mass` says 0.5 kg"] * ("paper" in path.stem)
        assert [words in note for words, note in zip(of_mass, notes[1:], strict=True)] == (
            [True] * len(of_mass)
        )
    else:
        assert notes == ()


def test_points_too_near_for_a_volume():
    """The cube of their distance is zero."""
    slider = "slider: {mass: 0.14, inertia: 1e-4, at: [0.17, %s]}"
    assert slider % "0" in SLIDER_CRANK
    apart = [SLIDER_CRANK.replace(slider % "0", slider % y) for y in ("0", "-1e-300")]
    assert lint(loads(apart[0])) == lint(loads(apart[1]))


CASES = [
    # kg*mm^2 typed as kg*m^2, and the other way
    (("inertia: 0.01", "inertia: 1e4"), "bodies.crank: radius of gyration", "100 m"),
    (("inertia: 0.01", "inertia: 1e-8"), "bodies.crank: radius of gyration", "0.0001 m"),
    (("mass: 1, inertia: 0.01", "mass: 0, inertia: 0.01"), "bodies.crank: inertia", "0.01"),
    (("[0.001, 0.02, 0.02]", "[0.001, 0.02, 0.03]"), "bodies.rod.inertia", "1.43 times"),
    (("[0.001, 0.02, 0.02]", "[0.001, 0.02, 0.02, 0.01, 0, 0]"), "bodies.rod.inertia", "below"),
    # sqrt((20 - 0.3) / 0.3)
    (("stiffness: internal", "stiffness: paper"), "joints.B: stiffness `paper`", "8.1 times"),
    (("clearance: 0.3 mm", "clearance: 3 mm"), "joints.B: the clearance, 3 mm", "30%"),
    (("clearance: 0.3 mm", "clearance: 0.005 mm"), "joints.B: clearance over radius", "5.0e-04"),
    # 207 / 1e9, and beyond diamond
    (("207 GPa", "207"), "contact_laws.pin.youngs_modulus: 207 Pa", "`207 GPa`"),
    (("207 GPa", "207e9 GPa"), "contact_laws.pin.youngs_modulus: 2.07e+20 Pa", "`2.07e+11 Pa`"),
    (("207 GPa", "3e12"), "contact_laws.pin.youngs_modulus: 3e+12 Pa", "check the unit"),
    (("207 GPa,", "207 GPa, journal_youngs_modulus: 3,"), "contact_laws.pin.journal_y", "`3 GPa`"),
    # 1.5 0.91 1e3 / sqrt(0.01 0.0097 / 0.0003) = 2400 Pa
    (("stiffness: internal", "stiffness: 1e3"), "joints.B: a stiffness of 1e+03", "2.4e+03 Pa"),
    (("coefficient: 0.3", "coefficient: 1e10"), "contact_laws.pin.friction.coeff", "1e+10"),
    # 300 kg / (0.2 m)^3, and 1e-8 kg / (0.2 m (0.002 m)^2)
    (("mass: 1, inertia: 0.01", "mass: 300, inertia: 0.01"), "bodies.crank: 300 kg", "3.7e+04"),
    (("mass: 1, inertia: 0.01", "mass: 1e-8, inertia: 1e-10"), "bodies.crank: 1e-08", "1.2e-02"),
    (("solver: {end: 1 s}", "solver: {end: 1 s}\noutput: {every: 0.3}"), "output.every", "0.9 s"),
    (("solver: {end: 1 s}", "solver: {end: 12 ms}\noutput: {every: 1}"), "output.every", "at 0 s"),
    # 60 / (2 pi)
    (("solver: {", "initial: {A: 60}\nsolver: {"), "initial.A: 60 rad are 9.55", "`60 deg`"),
    # from the implicit relation: see damping_factor
    (("restitution: 0.9", "restitution: 0.5"), "contact_laws.pin: lankarani", "0.725"),
    (("v0: 1e-4, v1: 1e-3", "v0: 0, v1: 1e-6"), "contact_laws.pin.friction", "1.0e-06"),
    # 2 sqrt(1e4 (0.01 + 1 0.1^2)) = 28.3
    (("damping: 1}", "damping: 50}"), "forces.stop: damping 50", "1.77 times"),
    # pi sqrt(0.02 / 1e4) = 4.4e-3 s
    (("solver: {", f"{RK4}1e-3, "), "forces.stop: a contact lasts 4.4e-03 s", "4.44 steps"),
    (("solver: {", f"{RK4}1e-4, "), "joints.B: a contact lasts", "steps of rk4"),
    (("solver: {", f"{RK4}1e-4, "), "joints.B: friction rises by", "unstable above"),
]


@pytest.mark.parametrize(("change", "start", "number"), CASES, ids=lambda c: str(c)[:40])
def test_warning(change, start, number):
    matching = [message for message in found(change) if message.startswith(start)]
    assert len(matching) == 1
    assert number in matching[0]


@pytest.mark.parametrize(
    "change",
    [
        ("[0.001, 0.02, 0.02]", "[0.001, 0.02, 0.02101]"),  # rounded
        ("normal: lankarani_nikravesh", "normal: identified"),
        ("207 GPa", "2 MPa"),
        ("stiffness: internal", "stiffness: 1e10"),
        ("coefficient: 0.3", "coefficient: 1.5"),
        ("mass: 1, inertia: 0.01", "mass: 60, inertia: 0.6"),  # a solid steel cube
        ("solver: {", f"{RK4}1e-7, "),
        ("contact: pin, ", ""),
        ("solver: {end: 1 s}", "solver: {end: 0.9}\noutput: {every: 0.1}"),
        ("solver: {end: 1 s}", "solver: {end: 1 s}\noutput: {every: 1 ms}"),
    ],
)
def test_no_warning(change):
    assert found(change) == ()


@pytest.mark.parametrize("method", ["auto", "radau", "generalized_alpha", "scipy:BDF"])
def test_a_step_that_counts_for_nothing(method):
    [told] = found(("solver: {", f"solver: {{method: {method}, step: 1e-5, "))
    assert told.startswith(f"solver.step: 1e-05 s has no influence: {method} chooses its steps")
    assert found(("solver: {", f"solver: {{method: {method}, max_step: 1e-5, ")) == ()


def test_nothing_is_joined_to_the_ground():
    text = SCENARIO.replace("[ground, crank], at", "[rod, crank], at")
    drifting = loads(text.replace("[ground, rod]", "[crank, rod]"))
    (found,) = [message for message in lint(drifting) if "ground" in message]
    assert found.startswith("joints: nothing is joined to `ground`")
    spring = "{type: spring_damper, bodies: [ground, rod], points: [[0, 0], [1, 0]], stiffness: 1}"
    held = text.replace("[ground, rod]", "[crank, rod]")
    held = held.replace("forces:", f"forces:\n  spring: {spring}")
    assert not any("ground" in message for message in lint(loads(held)))


INERTIA = "inertia: [0.001, 0.02, 0.02]"


@pytest.mark.parametrize("inertia, told", [
    ("[0, 0, 0]", ""), ("[0, 0, 0.02]", "only one inertia above zero"),
    ("[0.001, 0.02, 0.03]", "above the sum of the others"),
])  # fmt: skip
def test_inertias_of_a_body_that_has_hardly_any(inertia, told):
    """A body without any is one that is meant; with one alone there is none."""
    notes = [note for note in found((INERTIA, f"inertia: {inertia}")) if "rod.inertia" in note]
    assert len(notes) == bool(told) and all(told in note for note in notes)


@pytest.mark.parametrize("clearance, told", [("2 mm", False), ("2.1 mm", True)])
def test_a_bearing_that_is_loose(clearance, told):
    notes = found(("0.3 mm", clearance))
    assert any("of the bearing radius" in note for note in notes) == told


def test_a_decimal_comma_is_told():
    (note,) = found(("at: [0.5, 0]", "at: [0,5, 0]"))
    assert note.startswith("joints.C.at: [0,5, 0] is a list of 3 numbers")
