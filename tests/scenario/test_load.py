"""From file to Scenario: what it becomes, and what the user sees when it is wrong."""

import json
import re

import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

from trsim.errors import ModelError, Problems, ScenarioError, TrsimError
from trsim.scenario.initial import Initial
from trsim.scenario.load import load, loads, locate
from trsim.scenario.scenario import Scenario

from .conftest import CASE, MECHANISM

WHOLE = MECHANISM.replace("at: [-0.242, 0.241]}", "at: [0, 1], clearance: 3e-4, contact: pin}")
WHOLE += CASE.split("contact: pin}\n")[1].replace(
    "solver: {method: dop853, end: 1 s, tolerance: 1e-8}",
    "solver: {method: rk4, end: 1 s, step: 1e-5, first_step: 1e-6, max_step: 1e-4, max_steps: 9,"
    " stabilisation: baumgarte, baumgarte: {alpha: 5, beta: 5}, force: true, tolerance: 1e-8}",
)


def shown(text, sets=(), name="a.yaml"):
    with pytest.raises(TrsimError) as caught:
        loads(text, sets, name)
    return caught.value.show()


# --- what it becomes -------------------------------------------------------------------------


def test_load(project):
    s = load("case.yaml", ["joints.B.clearance=0.5mm"])
    assert s.title == "one chain"
    assert s.parameters == {"speed": 0.5}
    assert s.gravity == (0.0, 0.0, 0.0)
    assert s.planar is None
    assert s.bodies["door"].inertia == (1.0, 2.0, 1.584e-2)
    assert s.bodies["door"].at == (-0.144634, 0.235897, 0.0)
    assert {name: joint.type for name, joint in s.joints.items()} == {
        "guide": "prismatic",
        "B": "clearance_joint",
    }
    assert s.joints["B"].clearance == 0.0005
    assert s.drives["actuator"].velocity.value == 0.5
    assert s.drives["actuator"].compliance.stiffness == 1e7
    assert s.sensors["door_angle"].at_start == pytest.approx(0.0523598776)
    assert s.forces["air"].force.sensors == {"stroke"}
    assert s.contact_laws["pin"].friction.v1 == 1e-3
    assert s.contact_laws["pin"].stiffness == "internal"
    assert s.contact_laws["pin"].slowest_impact == 0.01
    assert s.initial == Initial(("B",), {})
    assert (s.solver.method, s.solver.end, s.solver.stabilisation) == ("dop853", 1.0, "projection")
    assert (s.output.every, s.output.channels) == (1e-4, ("door_angle", "B.*"))
    assert s.poincare["orbit"].plot == ("B.eccentricity_x", "B.eccentricity_y")
    assert s.sweep == {"joints.B.clearance": ["0.1 mm", "0.3 mm"]}
    assert s.report == {"units": {"angle": "deg"}}


def test_source_and_resolved(project):
    s = load("case.yaml")
    assert s.source.text == CASE
    assert list(s.source.files) == ["case.yaml", "mechanism.yaml"]
    assert s.resolved["joints"]["B"]["clearance"] == "0.3 mm"
    assert "extends" not in s.resolved
    again = loads(json.dumps(s.resolved))
    assert again.model_dump() == s.model_dump()
    assert again.resolved == s.resolved


def test_places(project):
    s = load("case.yaml", ["solver.end=2"])
    assert s.place(("joints", "B")).show() == "case.yaml:3:3"
    assert s.place(("joints", "B", "bodies", 1)).show() == "mechanism.yaml:8:41"
    assert s.place(("solver", "end")).show() == "--set"
    error = locate(ModelError("no body named 'x'", path=("joints", "B", "bodies", 1)), s)
    assert error.show().startswith("mechanism.yaml:8:41: joints.B.bodies.1: no body named 'x'\n")
    both = locate(Problems([ModelError("x", path=("joints", "guide")), ModelError("y")]), s)
    assert both.show().startswith("mechanism.yaml:7:3: joints.guide: x\n")


def test_the_least_scenario():
    s = loads("title: nothing")
    assert isinstance(s, Scenario)
    assert s.bodies == {} and s.initial == Initial() and s.solver.end is None
    assert s.output.channels == ("*",)


def test_clearance_makes_a_revolute_a_clearance_joint():
    joint = "joints: {A: {type: %s, bodies: [a, b], at: [0, 0]%s}}"
    assert loads(joint % ("revolute", "")).joints["A"].type == "revolute"
    for word in ("revolute", "clearance_joint"):
        assert loads(joint % (word, ", clearance: 0")).joints["A"].type == "clearance_joint"


def test_initial():
    text = "joints: {A: {type: revolute, bodies: [a, b], at: [0, 0]}}\nparameters: {p: 2}\n"
    assert loads(text + "initial: {A: 90 deg}").initial.values["A"] == pytest.approx(1.5707963)
    assert loads(text + "initial: {A: p/4}").initial == Initial((), {"A": 0.5})
    assert loads(text + "initial: {A: 0.3, equilibrium: [A]}").initial == Initial(
        ("A",), {"A": 0.3}
    )
    with pytest.raises(ScenarioError, match="'mm' is a length; this number is an angle"):
        loads(text + "initial: {A: 5 mm}")


# --- what the user sees ----------------------------------------------------------------------

SMALL = """\
title: broken
parameters: {ratio: 2}
bodies:
  rod: {mass: 1, inertia: 1}
joints:
  wrist: {type: revolute, bodies: [ground, rod], at: [0, 0]}
forces:
  spring:
    type: torsion_spring
    joint: wrist
    stiffness: 1.0
solver: {end: 1}
"""


@pytest.mark.parametrize(
    "old, new, message",
    [
        (
            "stiffness: 1.0",
            "stiffness: -3.0",
            "a.yaml:11:16: forces.spring.stiffness: must be >= 0, got -3.0\n"
            "        stiffness: -3.0\n"
            "                   ^\n"
            "  This number is a torsional stiffness, in N*m/rad.",
        ),
        (
            "stiffness: 1.0",
            "stifness: 1.0",
            "a.yaml:11:5: forces.spring: unknown key 'stifness'\n"
            "        stifness: 1.0\n"
            "        ^\n"
            "  Did you mean 'stiffness'?  Known: joint, stiffness, preload, type.",
        ),
        (
            "    stiffness: 1.0\n",
            "",
            "a.yaml:8:3: forces.spring: field required: stiffness (N*m/rad)\n"
            "      spring:\n"
            "      ^",
        ),
        (
            "torsion_spring",
            "torsion_sprin",
            "a.yaml:9:11: forces.spring.type: unknown type 'torsion_sprin'\n"
            "        type: torsion_sprin\n"
            "              ^\n"
            "  Did you mean 'torsion_spring'?  Known: applied_load, torsion_spring.",
        ),
        (
            "stiffness: 1.0",
            "stiffness: 3 N/m",
            "a.yaml:11:16: forces.spring.stiffness: wrong unit: 'N/m' is a stiffness;"
            " this number is a torsional stiffness, in N*m/rad\n"
            "        stiffness: 3 N/m\n"
            "                   ^",
        ),
        (
            "stiffness: 1.0",
            "stiffness: 2*rato",
            "a.yaml:11:16: forces.spring.stiffness: no parameter named 'rato'\n"
            "        stiffness: 2*rato\n"
            "                   ^\n"
            "  Did you mean 'ratio'?  Known: ratio.",
        ),
        (
            "joint: wrist",
            "joint: 5",
            "a.yaml:10:12: forces.spring.joint: must be text, got 5\n"
            "        joint: 5\n"
            "               ^\n"
            "  Quote a text that looks like a number or like true, false, null.",
        ),
        (
            "inertia: 1}",
            "inertia: [1, 2]}",
            "a.yaml:4:27: bodies.rod.inertia: must be a number or a list of 3, got a list of 2\n"
            "      rod: {mass: 1, inertia: [1, 2]}\n"
            "                              ^\n"
            "  This number is a moment of inertia, in kg*m^2.",
        ),
        (
            "inertia: 1}",
            "inertia: [1, 2 N, 3]}",
            "a.yaml:4:31: bodies.rod.inertia.1: wrong unit: 'N' is a force;"
            " this number is a moment of inertia, in kg*m^2\n"
            "      rod: {mass: 1, inertia: [1, 2 N, 3]}\n"
            "                                  ^",
        ),
        (
            "[ground, rod]",
            "[ground]",
            "a.yaml:6:35: joints.wrist.bodies: must be a list of 2, got a list of 1\n"
            "      wrist: {type: revolute, bodies: [ground], at: [0, 0]}\n"
            "                                      ^",
        ),
        (
            "{end: 1}",
            "{end: 1, method: rk5}",
            "a.yaml:12:26: solver.method: must be one of auto, dop853, radau, generalized_alpha,"
            " rk4, kinematic, static_path, scipy:BDF, scipy:Radau, scipy:RK45, got 'rk5'\n"
            "    solver: {end: 1, method: rk5}\n"
            "                             ^\n"
            "  Did you mean 'rk4'?",
        ),
        (
            "  rod:",
            "  wrist:",
            "a.yaml:6:3: joints.wrist: the name 'wrist' is taken by bodies.wrist\n"
            "      wrist: {type: revolute, bodies: [ground, rod], at: [0, 0]}\n"
            "      ^\n"
            "  All names share one name space.",
        ),
        (
            "{ratio: 2}",
            "{rod: 2}",
            "a.yaml:4:3: bodies.rod: the name 'rod' is taken by parameters.rod\n"
            "      rod: {mass: 1, inertia: 1}\n"
            "      ^\n"
            "  All names share one name space.",
        ),
        (
            "title: broken",
            "title: broken\nsolvr: {end: 1}",
            "a.yaml:2:1: unknown key 'solvr'\n"
            "    solvr: {end: 1}\n"
            "    ^\n"
            "  Did you mean 'solver'?  Known: title, planar, gravity, frame, parameters, points,"
            " bodies, joints, drives, sensors, forces, contact_laws, initial, solver"
            " ... (16 more)",
        ),
    ],
)
def test_message(old, new, message):
    assert old in SMALL
    assert shown(SMALL.replace(old, new)) == message


@pytest.mark.parametrize(
    "text, message",
    [
        ("planar: no", "1:9: planar: must be true or false, got 'no'"),
        ("gravity: 9.81", "1:10: gravity: must be [x, y] or [x, y, z], got 9.81"),
        ("gravity: [0, -9.81 m]", "1:14: gravity.1: wrong unit: 'm' is a length"),
        ("bodies: [a]", "1:9: bodies: must be a mapping, got a list of 1"),
        ("bodies: {a: 5}", "1:13: bodies.a: must be a mapping of keys, got 5"),
        ("joints: {a: {at: [0, 0]}}", "1:10: joints.a: field required: type"),
        ("joints: {a: {tpye: revolute}}", "1:14: joints.a: unknown key 'tpye'"),
        ("joints: {a: {type: drive}}", "1:20: joints.a.type: unknown type 'drive'"),
        ("joints: {a: {type: [x]}}", "1:20: joints.a.type: unknown type a list of 1"),
        ("drives: {a: {joint: b}}", "1:10: drives.a: give `velocity`"),
        ("bodies: {1a: {mass: 1, inertia: 1}}", "1:10: bodies.1a: not a name: '1a'"),
        (
            "bodies: {ground: {mass: 1, inertia: 1}}",
            "1:10: bodies.ground: the name 'ground' is res",
        ),
        ("bodies: {sin: {mass: 1, inertia: 1}}", "1:10: bodies.sin: the name 'sin' is reserved"),
        (
            "bodies: {lambda: {mass: 1, inertia: 1}}",
            "1:10: bodies.lambda: the name 'lambda' is res",
        ),
        ("parameters: {t: 1}", "1:14: parameters.t: the name 't' is reserved"),
        ("solver: {end: 0}", "1:15: solver.end: must be > 0, got 0.0"),
        ("solver: {tolerance: 1}", "1:21: solver.tolerance: must be <= 0.1, got 1.0"),
        ("solver: {max_steps: 1.5}", "1:21: solver.max_steps: must be a whole number, got 1.5"),
        ("solver: {method: rk4}", "1:1: solver: method rk4 needs a step"),
        ("solver: {baumgarte: {alpha: 1, beta: 1}}", "1:10: solver.baumgarte: baumgarte is not"),
        ("solver: {baumgarte: {alpha: 1}}", "1:10: solver.baumgarte: field required: beta (1/s)"),
        ("output: {channels: A}", "1:20: output.channels: must be a list, got 'A'"),
        ("poincare: {p: {when: a, crosses: upp, plot: [a, b]}}", "1:34: poincare.p.crosses: must"),
        ("initial: {equilibrium: B}", "1:24: initial.equilibrium: must be a list of joints"),
        ("initial: {wrost: 1}", "1:11: initial: unknown key 'wrost'"),
        ("initial: 5", "1:10: initial: must be a mapping of keys, got 5"),
        ("sweep: {solver.end: [1]}", "1:9: sweep.solver.end: nothing to vary at 'solver.end'"),
        ("phase_portraits: {p: {x: a}}", "1:19: phase_portraits.p: field required: y"),
        ("contact_laws: {p: {normal: hertz, restitution: 1}}", "1:28: contact_laws.p.normal: must"),
        (
            "contact_laws: {p: {normal: flores, restitution: 1}}",
            "1:16: contact_laws.p: stiffness internal needs bearing_radius, youngs_modulus, poi",
        ),
        (
            "contact_laws: {p: {normal: flores, restitution: 1, stiffness: intrnal}}",
            "1:63: contact_laws.p.stiffness: must be a number or one of the words, got 'intrnal'",
        ),
        (
            "contact_laws: {p: {normal: flores, restitution: 1, stiffness: 1,"
            " friction: {law: coulomb}}}",
            "1:66: contact_laws.p.friction: friction law coulomb needs coefficient",
        ),
        (
            "contact_laws: {p: {normal: flores, restitution: 1, stiffness: 1,"
            " friction: {law: modified_coulomb, coefficient: 1, v0: 1, v1: 1}}}",
            "1:66: contact_laws.p.friction: v0 must be < v1",
        ),
        (
            "forces: {a: {type: applied_load, body: b, direction: [1, 0], force: {tabel: 1}}}",
            "1:70: forces.a.force: unknown key 'tabel'",
        ),
        (
            "forces: {a: {type: applied_load, body: b, direction: [1, 0],"
            " force: {table: [[0, 1], [0, 2]]}}}",
            "1:86: forces.a.force.table.1: x must rise, got 0 after 0",
        ),
    ],
)
def test_first_line(text, message):
    assert shown(text).startswith(f"a.yaml:{message}")


def test_contact_law_with_a_number_needs_no_material():
    s = loads("contact_laws: {p: {normal: flores, restitution: 1, stiffness: 2 N/mm^1.5}}")
    assert s.contact_laws["p"].stiffness == pytest.approx(2 * 1000**1.5)


def test_all_problems_at_once_in_order():
    text = SMALL.replace("mass: 1", "mass: -1").replace("at: [0, 0]", "at: [0, 0], axs: [1, 0]")
    text = text.replace("ratio: 2", "ratio: 2*d").replace("end: 1", "end: 1 m")
    lines = [line for line in shown(text).splitlines() if line.startswith("a.yaml")]
    assert [line.split(": ")[1] for line in lines] == [
        "parameters.ratio",
        "bodies.rod.mass",
        "joints.wrist",
        "solver.end",
    ]


def test_problems_are_in_the_order_of_the_text_whatever_finds_them():
    """Sections upside down, and a name, which is looked at before all values."""
    text = """\
solver: {end: 1 m}
joints:
  wrist: {type: revolute, bodies: [ground, rod], at: [0, 0], axs: [1, 0]}
bodies:
  rod: {mass: -1, inertia: 1}
  sin: {mass: 1, inertia: 1}
parameters: {ratio: 2*d}
"""
    lines = [line for line in shown(text).splitlines() if line.startswith("a.yaml")]
    assert [line.split(": ")[0] for line in lines] == [
        f"a.yaml:{place}" for place in ("1:15", "3:62", "5:15", "6:3", "7:21")
    ]


def test_problems_are_file_by_file(project):
    """Those of the file that was asked for first, then those of what it extends."""
    (project / "case.yaml").write_text(CASE.replace("end: 1 s", "end: 1 m"))
    wrong = MECHANISM.replace("mass: ", "mass: -")
    assert wrong != MECHANISM
    (project / "mechanism.yaml").write_text(wrong)
    with pytest.raises(Problems) as caught:
        load("case.yaml")
    files = [problem.place.file for problem in caught.value.problems]
    assert files == sorted(files) and set(files) == {"case.yaml", "mechanism.yaml"}
    lines = [problem.place.line for problem in caught.value.problems[1:]]
    assert lines == sorted(lines) and len(lines) > 1


def test_a_faulty_parameter_is_reported_once():
    text = SMALL.replace("ratio: 2", "ratio: 2*d").replace("stiffness: 1.0", "stiffness: ratio")
    assert shown(text).count("a.yaml:") == 1


def test_set_is_typed_by_the_schema():
    assert loads(SMALL, ["forces.spring.stiffness=3 N*mm/rad"]).forces["spring"].stiffness == 3e-3
    assert shown(SMALL, ["forces.spring.stiffness=3N"]) == (
        "--set: forces.spring.stiffness: wrong unit: 'N' is a force;"
        " this number is a torsional stiffness, in N*m/rad\n"
        "    forces.spring.stiffness=3N\n"
        "                            ^"
    )
    assert shown(SMALL, ["forces.spring.stifness=3"]).startswith(
        "--set: forces.spring: unknown key 'stifness'\n"
        "    forces.spring.stifness=3\n    ^\n  Did you mean 'stiffness'?"
    )
    assert shown(SMALL, ["joints.wrist.clearence=3 mm"]).endswith(
        "Did you mean 'clearance'?  Known: bodies, at, axis, clearance, contact, type."
    )


def test_a_short_list_is_reported_once():
    assert shown(SMALL.replace("[ground, rod]", "[]")).count("a.yaml:") == 1


def test_the_branch_of_a_union_that_came_closest():
    text = shown(SMALL.replace("inertia: 1}", "inertia: [1, -2, 3]}"))
    assert text.startswith("a.yaml:4:31: bodies.rod.inertia.1: must be >= 0, got -2.0\n")
    assert text.count("a.yaml:") == 1


def test_a_fault_in_an_extended_file(project):
    mechanism = project / "mechanism.yaml"
    mechanism.write_text(MECHANISM.replace("mass: 50", "mass: -50"))
    with pytest.raises(ScenarioError) as caught:
        load("case.yaml")
    assert caught.value.show().startswith("mechanism.yaml:4:19: bodies.fairing.mass: must be >= 0")


# --- every key, misspelt ---------------------------------------------------------------------


def edits(word):
    """One of each kind of slip of the finger, in the middle of the word."""
    k = len(word) // 2
    yield word[:k] + word[k + 1 :]
    yield word[:k] + "q" + word[k + 1 :]
    yield word[:k] + "q" + word[k:]
    yield word[: k - 1] + word[k] + word[k - 1] + word[k + 1 :]


def keys_of(text):
    """Every key of the schema in a text, with its line and column; names of things left out."""
    names = set(loads(text).bodies) | {"guide", "B", "actuator", "stroke", "door_angle", "air"}
    names |= {"spring", "pin", "orbit", "speed", "angle", "units"}  # report is free
    for match in re.finditer(r"(?<![\w.])([a-z]\w*): ?", text):
        if match[1] not in names:
            yield match.start(), match[1]


def test_every_misspelt_key_is_found_and_corrected():
    wrong = []
    count = 0
    for start, key in keys_of(WHOLE):
        line = WHOLE.count("\n", 0, start) + 1
        column = start - WHOLE.rfind("\n", 0, start)
        for typo in set(edits(key)) - {key}:
            count += 1
            text = shown(WHOLE[:start] + typo + WHOLE[start + len(key) :])
            place = f"a.yaml:{line}:{column}: "
            about = [block for block in text.split("a.yaml:") if f"unknown key '{typo}'" in block]
            if place not in text or len(about) != 1 or f"Did you mean '{key}'?" not in about[0]:
                wrong.append((key, typo, text))
    assert count > 200
    assert wrong == []


# --- nothing but ScenarioError ---------------------------------------------------------------

# each but surrogates; drawn in less time than from a table of all
ANY = st.integers(0, 0x10F7FF).map(lambda k: chr(k if k < 0xD800 else k + 0x800))
PLAIN = st.recursive(
    st.none() | st.booleans() | st.integers() | st.floats() | st.text(ANY, max_size=8),
    lambda inner: (
        st.lists(inner, max_size=3)
        | st.dictionaries(
            st.sampled_from(["bodies", "rod", "type", "at", "force", "table", "inertia", "x"]),
            inner,
            max_size=4,
        )
    ),
    max_leaves=12,
)
CALM = settings(
    max_examples=150,
    deadline=None,
    suppress_health_check=[HealthCheck.function_scoped_fixture],
)


@CALM
@given(st.data())
def test_mutated_text(data):
    text = WHOLE
    for _ in range(data.draw(st.integers(1, 4))):
        k = data.draw(st.integers(0, len(text) - 1))
        piece = data.draw(
            st.sampled_from([*"{}[]:,-#&*!|'\"\n\t 0aé\0", "null", "1e999", "? ", "{a: "])
        )
        text = text[:k] + piece + text[k + data.draw(st.integers(0, 3)) :]
    try:
        loads(text)
    except TrsimError as error:
        assert error.exit_code == 3
        assert error.show()


@CALM
@given(st.sampled_from(sorted(set(Scenario.model_fields) | {"extends"})), PLAIN)
def test_any_structure(section, value):
    try:
        loads(json.dumps({section: value}))
    except TrsimError as error:
        assert error.exit_code == 3
        assert error.show()


@CALM
@given(PLAIN)
def test_any_value_of_any_key(value):
    for path in ("bodies.door.inertia", "forces.air.force", "solver", "joints.B.type", "initial"):
        try:
            loads(WHOLE, [f"{path}={json.dumps(value)}"])
        except TrsimError as error:
            assert error.exit_code == 3
            assert error.show()


@pytest.mark.parametrize(
    "units, path, told",
    [
        ("{angle: mm}", "report.units.angle", "'mm' is no unit of angle"),
        ("{length: deg}", "report.units.length", "'deg' is no unit of length"),
        ("{lenght: mm}", "report.units", "unknown key 'lenght'"),
        ("{force: kNn}", "report.units.force", "unknown unit 'kNn'"),
        ("{force: 3}", "report.units.force", "must be a unit, got 3"),
        ("mm", "report.units", "must be a mapping, got 'mm'"),
    ],
)
def test_units_of_figures(units, path, told):
    """What cannot be shown is refused where it stands, not left out of the figures."""
    with pytest.raises(ScenarioError) as wrong:
        loads(f"title: x\nreport: {{units: {units}}}")
    assert ".".join(wrong.value.path) == path
    assert wrong.value.what.startswith(told)
    assert wrong.value.place.line == 2
    loads("report: {units: {angle: rad, length: in, force: kN, torque: N*mm}}")
    with pytest.raises(ScenarioError, match="unknown key 'unts'"):
        loads("report: {unts: {}}")
