"""Phases as they are written: names, mistakes with their lines, merging, --set and sweeps."""

import pytest

from trsim.assemble.assemble import assemble
from trsim.errors import TrsimError
from trsim.scenario.cases import cases
from trsim.scenario.expand import expand_text
from trsim.scenario.load import load, loads, of_tree
from trsim.solve.simulate import simulate
from trsim.sweeps.plan import faults, plan

TEXT = """\
bodies: {arm: {mass: 2, inertia: 0.1, at: [0.2, 0]}, tip: {mass: 1, inertia: 0.1, at: [0.6, 0]}}
joints:
  hinge: {type: revolute, bodies: [ground, arm], at: [0, 0]}
  elbow: {type: revolute, bodies: [arm, tip], at: [0.4, 0]}
drives: {motor: {joint: hinge, velocity: 0}}
sensors: {angle: {joint: hinge}}
forces:
  push: {type: applied_load, body: tip, direction: [1, 0, 0], force: 6 N}
  stop: {type: limit_stop, joint: elbow, upper: 1, stiffness: 1e4}
solver: {end: 1}
phases:
  - {name: one, drive: {motor: {velocity: 1 rad/s}}, until: {when: angle, value: 10 deg}}
  - {name: two, release: [motor], lock: [elbow], for: 0.1 s}
"""
ONE, TWO = TEXT.splitlines()[11:13]


def refused(old, new, text=TEXT):
    """What is said of a text with a mistake, and the line it is said of."""
    assert old in text
    with pytest.raises(TrsimError) as caught:
        scenario = loads(text.replace(old, new), name="a.yaml")
        try:
            list(simulate(scenario, assemble(scenario)))
        except TrsimError as error:
            from trsim.scenario.load import locate

            raise locate(error, scenario) from None
    return caught.value.show()


MISTAKES = {
    "drive": ("{motor: {v", "{moter: {v", "12:", "no drive named 'moter'"),
    "unit of a drive": ("1 rad/s", "1 m/s", "12:", "wrong unit: 'm/s'; the joint turns"),
    "two motions": ("velocity: 1 rad/s", "velocity: 1, position: 0", "12:", "give either"),
    "sensor": ("when: angle", "when: angel", "12:", "no sensor named 'angel'"),
    "unit of a value": ("10 deg", "10 mm", "12:", "wrong unit: 'mm'; 'angle' is in rad"),
    "key": ("until", "untill", "12:", "unknown key 'untill'"),
    "key of until": ("crosses", "crossess", "12:", "unknown key"),
    "joint": ("[elbow], for", "[elbo], for", "13:", "no joint named 'elbo'"),
    "release": ("[motor], lock", "[moter], lock", "13:", "no joint or drive named 'moter'"),
    "release of a force": ("[motor], lock", "[push], lock", "13:", "`remove: [push]` makes it act"),
    "body": ("lock: [elbow]", "park: [tipp]", "13:", "no body named 'tipp'"),
    "unpark": ("lock: [elbow]", "unpark: [tip]", "13:", "no event parks a body 'tip'"),
    "unlock": ("lock: [elbow]", "unlock: [elbow]", "13:", "no event locks the joint 'elbow'"),
    "force": ("lock: [elbow]", "apply: [pish]", "13:", "no force or load set named 'pish'"),
    "a stop": ("lock: [elbow]", "remove: [stop]", "13:", "is a contact, a limit or a friction"),
    "no rope": ("lock: [elbow]", "taut: [push]", "13:", "'push' is no rope"),
    "both": ("lock: [elbow]", "lock: [elbow], unlock: [elbow]", "13:", "stands under lock and"),
    "driven and let go": ("lock: [elbow]", "drive: {motor: {velocity: 2}}", "13:", "under drive"),
    "no end": (", until: {when: angle, value: 10 deg}", "", "12:", "nothing ends this phase"),
    "end of the first": ("{name: one,", "{name: one, end: done,", "12:", "`end` is the status"),
    "word of the end": ("for: 0.1 s", "for: 0.1 s, end: stuck", "13:", "must be"),
    "no time": ("for: 0.1 s", "for: 0 s", "13:", "must be > 0, got 0"),
    "unit of a time": ("for: 0.1 s", "for: 0.1 m", "13:", "wrong unit"),
    "energy": ("for: 0.1 s", "stall: {for: 1 s}", "13:", "field required: energy (J)"),
    "time of rest": ("for: 0.1 s", "stall: {energy: 1}", "13:", "field required: for (s)"),
    "name twice": ("name: two", "name: one", "13:", "the name 'one' is that of another phase"),
    "no name": ("name: two", "name: a b", "13:", "not a name: 'a b'"),
}


@pytest.mark.parametrize("old, new, line, what", MISTAKES.values(), ids=MISTAKES)
def test_mistakes_have_a_line(old, new, line, what):
    text = TEXT.replace("10 deg}", "10 deg, crosses: up}") if old == "crosses" else TEXT
    said = refused(old, new, text)
    assert f"a.yaml:{line}" in said and what in said


SEVERAL = """\
  - name: one
    until:
    - {when: angle, value: 10 deg}
    - {when: t, value: 3 mm}"""


def test_a_mistake_in_one_of_several_ends():
    said = refused(ONE, SEVERAL)
    assert "a.yaml:15:" in said and "wrong unit: 'mm'; 't' is in s" in said


DRIVEN = """\
bodies: {arm: {mass: 2, inertia: 0.1, at: [0.2, 0]}}
joints: {hinge: {type: revolute, bodies: [ground, arm], at: [0, 0]}}
drives: {motor: {joint: hinge, velocity: 0}}
solver: {end: 1, method: METHOD}
phases: [{drive: {motor: {velocity: 1}}, for: 0.1}, {release: [motor]}]
"""


@pytest.mark.parametrize(
    "method, line, what",
    [
        ("kinematic", 5, "kinematic analysis knows no phases"),
        ("'scipy:RK45'", 4, "scipy:RK45 knows no events"),
    ],
)
def test_methods_without_phases_say_so(method, line, what):
    said = refused("METHOD", method, DRIVEN)
    assert what in said and f"a.yaml:{line}:" in said


def names(scenario):
    return [phase.name for phase in scenario.phases]


def test_a_list_replaces_the_list(tmp_path):
    (tmp_path / "a.yaml").write_text(TEXT)
    (tmp_path / "b.yaml").write_text("extends: a.yaml\nphases: [{name: only, for: 1 s}]\n")
    (tmp_path / "c.yaml").write_text("extends: a.yaml\nphases: null\n")
    (tmp_path / "d.yaml").write_text("extends: a.yaml\nsolver: {end: 2}\n")
    assert names(load(tmp_path / "b.yaml")) == ["only"]
    assert names(load(tmp_path / "c.yaml")) == []
    assert names(load(tmp_path / "d.yaml")) == ["one", "two"]


def test_cases_replace_the_list_and_reach_numbers_by_parameters():
    text = (
        TEXT.replace("10 deg", "far")
        + """
parameters: {far: 10 deg}
cases:
  same: {}
  far: {parameters: {far: 20 deg}}
  other: {phases: [{name: rest, for: 1 s}]}
"""
    )
    found = {name: of_tree(tree, "") for name, tree in cases(expand_text(text)).items()}
    assert {name: names(one) for name, one in found.items()} == {
        "same": ["one", "two"], "far": ["one", "two"], "other": ["rest"]
    }  # fmt: skip
    values = [found[name].phases[0].until.value for name in ("same", "far")]
    assert values == pytest.approx([0.17453292519943295, 0.3490658503988659])


def test_numbers_are_set_by_their_place():
    scenario = loads(TEXT, ["phases.0.until.value=0.5", "phases.1.for=2 s"])
    assert scenario.phases[0].until.value == 0.5 and scenario.phases[1].time == 2.0


def test_a_sweep_reaches_numbers_of_phases(tmp_path):
    text = TEXT + "sweep: {phases.0.until.value: [10 deg, 20 deg]}\n"
    (tmp_path / "a.yaml").write_text(text)
    planned = plan(str(tmp_path / "a.yaml"))
    assert list(faults(planned)) == [] and len(planned.cases) == 2
    (tmp_path / "a.yaml").write_text(text.replace("phases.0.u", "phases.7.u"))
    with pytest.raises(TrsimError, match="phases: has no entry '7': it is a list of 2"):
        plan(str(tmp_path / "a.yaml"))


def test_the_first_phase_moves_the_drives_themselves():
    assert loads(TEXT).drives["motor"].velocity.value == 1.0
    assert loads(TEXT, ["phases=[]"]).drives["motor"].velocity.value == 0.0
