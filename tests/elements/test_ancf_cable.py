"""What a user of flexible bars may get wrong: each slip is refused, or told, where it stands."""

import json
from math import pi, sqrt
from pathlib import Path

import numpy as np
import pytest
from click.testing import CliRunner

from trsim.assemble.assemble import assemble
from trsim.cli import program
from trsim.errors import ModelError, TrsimError
from trsim.scenario.lint import lint
from trsim.scenario.load import load, loads, locate
from trsim.solve.diagnose.bar_scales import bar_scales
from trsim.solve.diagnose.doubts import doubts
from trsim.solve.diagnose.scales import scales
from trsim.solve.start.consistent import start

from ..runs import built, run

BAR = """\
bodies:
  rod:
    type: ancf_cable
    start: [0, 0]
    end: [1, 0]
    elements: 4
    section: {diameter: 20 mm}
    youngs_modulus: 207 GPa
    density: 7850
  tip: {mass: 0.5, inertia: [1e-3, 1e-3, 1e-3], at: [1, 0]}
joints:
  pin: {type: spherical, bodies: [ground, rod], at: [0, 0]}
  weld: {type: fixed, bodies: [rod, tip], at: [1, 0]}
gravity: [0, -9.81]
solver: {end: 0.1}
"""
FLEXIBLE = """\
bodies:
  rod:
    mass: 2.466
    inertia: 0.2055
    at: [0.5, 0]
    flexible: {section: {diameter: 20 mm}, youngs_modulus: 207 GPa}
  tip: {mass: 0.5, inertia: 1e-3, at: [1, 0]}
joints:
  pin: {type: revolute, bodies: [ground, rod], at: [0, 0]}
  hinge: {type: revolute, bodies: [rod, tip], at: [1, 0]}
solver: {end: 0.1}
"""
SPACE = "planar: false\n"
LOAD = "forces: {{f: {{type: applied_load, body: rod, {}}}}}\n"


def refused(text: str, *changes: tuple[str, str], sets: tuple[str, ...] = ()) -> TrsimError:
    for old, new in changes:
        assert old in text
        text = text.replace(old, new)
    with pytest.raises(TrsimError) as caught:
        scenario = loads(text, sets)
        try:
            assemble(scenario)
        except TrsimError as error:
            raise locate(error, scenario) from None
    return caught.value


def told(text: str, *changes: tuple[str, str]) -> str:
    for old, new in changes:
        assert old in text
        text = text.replace(old, new)
    return "\n".join(lint(loads(text)))


@pytest.mark.parametrize(
    ("change", "path", "line", "words"),
    [
        (("7850", "-7850"), "rod.density", 9, "must be > 0"),
        (("end: [1", "end: [0"), "rod.end", 5, "a bar has a length"),
        (("diameter: 20 mm", "diameter: 20 mm, width: 3 mm"), "rod.section", 7, "either `diam"),
        (("{diameter: 20 mm}", "20 mm"), "rod.section", 7, "must be a mapping"),
        (("20 mm}", "20 mm}\n    area: 1e-4"), "rod.section", 7, "the section: leave the two out"),
        (("    section: {diameter: 20 mm}\n", ""), "rod", 2, "give a `section`, or `area`"),
        (("20 mm}", "20 mm, wall: 12 mm}"), "rod.section.wall", 7, "half of its diameter"),
        (("20 mm}", "20 mm, height: 12 mm}"), "rod.section.height", 7, "belongs to a width"),
        (("elements: 4", "elements: 0"), "rod.elements", 6, "must be >= 1"),
        (("elements: 4", "elements: 2.5"), "rod.elements", 6, "a whole number"),
        (("elements: 4", "strain: grean"), "rod.strain", 6, "Did you mean 'green'?"),
        (("elements: 4", "curvature: papr"), "rod.curvature", 6, "Did you mean 'paper'?"),
        (("elements: 4", "mass: 2"), "rod.mass", 6, "either `density` or `mass`"),
        (("    density: 7850\n", ""), "rod", 2, "give a `density` or a `mass`"),
        (("207 GPa", "207 mm"), "rod.youngs_modulus", 8, "wrong unit: 'mm' is a length"),
        (("7850", "7850 kg"), "rod.density", 9, "is a density, in kg/m^3"),
        (("elements: 4", "damping: 2 N"), "rod.damping", 6, "is a time, in s"),
        (("elements: 4", "damping: -1"), "rod.damping", 6, "must be >= 0"),
    ],
)
def test_words_of_a_bar(change, path, line, words):
    error = refused(BAR, change)
    assert ".".join(map(str, error.path)) == f"bodies.{path}"
    assert error.exit_code == 3 and error.place.line == line and words in error.show()


@pytest.mark.parametrize(
    ("change", "words"),
    [
        (("area: A", "area: 1e-4 m"), "is an area, in m^2"),
        (("moment: I", "moment: 1e-9 m^3"), "is a second moment of area, in m^4"),
    ],
)
def test_units_of_a_section(change, words):
    text = BAR.replace("section: {diameter: 20 mm}", "area: A\n    second_moment: I")
    text = text.replace(*change).replace(": A", ": 1e-4").replace(": I", ": 1e-9")
    assert words in refused(text).show()


@pytest.mark.parametrize(
    ("at", "words"),
    [
        ("[0.9, 0]", "`elements: 10` puts nodes at all joints and loads of 'rod', and so do 20"),
        ("[0.3333333333, 0]", "`elements: 3` puts nodes"),
        ("[0.7071, 0]", "no number of elements up to 100"),
        ("[0.5, 0.1]", "is not on the line of 'rod', from [0, 0, 0] to [1, 0, 0]"),
        ("[1.5, 0]", "is not on the line of 'rod'"),
    ],
)
def test_a_joint_away_from_the_nodes(at, words):
    error = refused(BAR, ("bodies: [rod, tip], at: [1, 0]", f"bodies: [rod, tip], at: {at}"))
    assert error.place.line == 13 and error.path[:2] == ("joints", "weld")
    assert words in error.show() and "the nearest is at [" in error.show()


def test_the_count_that_is_proposed_is_accepted():
    text = BAR.replace("bodies: [rod, tip], at: [1, 0]", "bodies: [rod, tip], at: [0.9, 0]")
    assemble(loads(text, ["bodies.rod.elements=10"]))


def test_a_load_without_a_place_is_at_the_middle():
    text = BAR + LOAD.format("direction: [0, 1], force: 3")
    assert assemble(loads(text)).model.n
    error = refused(text, ("elements: 4", "elements: 3"))
    assert "without `at` this is at the middle of 'rod'" in error.what
    assert "`elements: 2` puts nodes" in error.hint


@pytest.mark.parametrize("key", ["points: [[0, 1], [0.3, 0]], stiffness: 3"])
def test_a_spring_away_from_the_nodes(key):
    text = BAR + f"forces: {{s: {{type: spring_damper, bodies: [ground, rod], {key}}}}}\n"
    assert "nearest node of 'rod'" in refused(text).what


@pytest.mark.parametrize(
    ("joint", "words"),
    [
        ("revolute", "a revolute holds the turning of a flexible bar about itself"),
        ("prismatic, axis: [0, 1, 0]", "a prismatic holds the turning"),
        ("revolute, clearance: 1 mm, contact: c", "a clearance_joint holds the turning"),
    ],
)
def test_joints_that_hold_torsion_in_space(joint, words):
    law = "contact_laws: {c: {normal: flores, stiffness: 1e9, restitution: 0.9, " + (
        "bearing_radius: 10 mm}}\n"
    )
    text = SPACE + BAR.replace("type: spherical", f"type: {joint}") + law
    error = refused(text)
    assert error.exit_code == 4 and error.path == ("joints", "pin") and words in error.what


def test_a_section_that_does_not_bend_alike_in_space():
    change = ("{diameter: 20 mm}", "{width: 20 mm, height: 30 mm}")
    assert "bends alike in all directions" in refused(SPACE + BAR, change).what
    assert assemble(loads(BAR.replace(*change))).planar


def test_a_torque_along_a_bar_in_space():
    text = SPACE + BAR + LOAD.format("at: [0.5, 0], direction: [1, 0, 0], torque: 3, frame: rod")
    error = refused(text)
    assert error.exit_code == 4 and "about itself" in error.what
    assert error.path == ("forces", "f", "direction") and error.place.line == 17
    for frame, direction, part in (("world", "[1, 0, 0]", ""), ("world", "[1, 4, 3]", "0.2 of it")):
        error = refused(text.replace("frame: rod", f"frame: {frame}"), ("[1, 0, 0]", direction))
        assert error.exit_code == 4 and "about itself" in error.what and part in error.what
    across = text.replace("[1, 0, 0]", "[0, 1, 0]")
    assert not assemble(loads(across)).notes


# --- `flexible` ------------------------------------------------------------------------------


@pytest.mark.parametrize(
    ("change", "path", "words"),
    [
        (("bodies: [rod, tip]", "bodies: [ground, tip]"), ("flexible",), "two of its joints"),
        (("at: [0.5, 0]", "at: [0.6, 0]"), ("flexible",), "0.1 m away from the middle"),
        (("mass: 2.466", "mass: 0"), ("mass",), "a flexible bar needs a mass"),
        (("{section: {diameter: 20 mm}, y", "{y"), ("flexible",), "give a `section`"),
        ((", youngs_modulus: 207 GPa", ""), ("flexible",), "field required: youngs_modulus (Pa)"),
    ],
)
def test_words_of_flexible(change, path, words):
    error = refused(FLEXIBLE, change)
    assert error.path == ("bodies", "rod", *path) and words in error.show()
    assert error.exit_code == 3 and error.place.line


def test_elements_are_set_on_the_command_line():
    scenario = loads(FLEXIBLE, ["bodies.rod.flexible.elements=8"])
    assert assemble(scenario).beams["rod"].nodes == 9
    error = refused(FLEXIBLE, sets=("bodies.rod.flexible.elemets=8",))
    assert "Did you mean 'elements'?" in error.hint


@pytest.mark.parametrize("off", ["false", "null"])
def test_a_file_that_extends_switches_it_on_and_off(off, tmp_path):
    rigid = FLEXIBLE.replace(
        "    flexible: {section: {diameter: 20 mm}, youngs_modulus: 207 GPa}\n", ""
    )
    (tmp_path / "rigid.yaml").write_text(rigid)
    words = "{elements: 2, section: {diameter: 20 mm}, youngs_modulus: 207 GPa}"
    on = f"extends: rigid.yaml\nbodies: {{rod: {{flexible: {words}}}}}\n"
    (tmp_path / "bars.yaml").write_text(on)
    assert assemble(loads(on, folder=tmp_path)).beams["rod"].nodes == 3
    again = f"extends: bars.yaml\nbodies: {{rod: {{flexible: {off}}}}}\n"
    assert not assemble(loads(again, folder=tmp_path)).beams


# --- magnitudes ------------------------------------------------------------------------------


def test_a_sound_bar_is_not_mentioned():
    assert told(BAR) == told(FLEXIBLE) == ""


@pytest.mark.parametrize(
    ("change", "words"),
    [
        (("207 GPa", "207"), "is `207 GPa` meant?"),
        (("7850", "0.5"), "steel has 7850: check mass, density and section"),
        (("density: 7850", "density: 7850\n    damping: 1"), "times critical for its slowest"),
        (("20 mm", "200 mm"), "only 5 times as long as thick; shear, which is left out, would add"),
        (("20 mm", "2 m"), "thicker (2e+03 mm) than long (1e+03 mm)"),
        (("elements: 4", "elements: 1"), "rod.elements: one element bends as one cubic"),
        (("elements: 4", "elements: 60"), "shorter (16.7 mm) than thick (20 mm)"),
        (("20 mm}", "5 mm}\n    stretching: full"), "stretching: `full` locks: an element with"),
        (("207 GPa", "1 MPa"), "under its own weight the bar bends within 0.069"),
    ],
)
def test_magnitudes_of_a_bar(change, words):
    assert words in told(BAR, change)


def test_too_many_elements():
    thin = BAR.replace("20 mm", "5 mm")
    assert "so that 8 to 32 are enough" in told(thin, ("elements: 4", "elements: 150"))


def test_numbers_of_the_rigid_body_that_do_not_count():
    change = ("inertia: 0.2055", "inertia: 0.3")
    assert "an even bar has an inertia of 0.206 kg*m^2 where `inertia` says 0.3" in told(
        FLEXIBLE, change
    )
    change = ("207 GPa}", "207 GPa, mass: 4 kg}")
    assert "the bar has 4 kg where `mass` says 2.47 kg" in told(FLEXIBLE, change)


def test_a_clearance_larger_than_the_bar():
    law = "contact_laws: {c: {normal: identified, stiffness: 1e9, bearing_radius: 9, %s}}\n"
    text = FLEXIBLE + law % "restitution: 0.9"
    change = ("tip], at: [1, 0]}", "tip], at: [1, 0], clearance: 1.5 m, contact: c}")
    assert "is larger than 'rod' is long (1e+03 mm)" in told(text, change)


# --- check and run ---------------------------------------------------------------------------


def test_check_tells_what_a_bar_gives_way(tmp_path):
    """Compliances of a steel bar of 1 m and 20 mm, by hand; frequencies of the linearised run."""
    (tmp_path / "bar.yaml").write_text(BAR)
    ran = CliRunner().invoke(program, ["check", str(tmp_path / "bar.yaml"), "--json"])
    (found,) = json.loads(ran.output)["scenarios"]
    (bar,) = found["flexible"]
    EA, EI = 207e9 * pi * 0.01**2, 207e9 * pi / 4.0 * 0.01**4
    assert (bar["elements"], bar["length"]) == (4, 1.0)
    assert bar["mass"] == pytest.approx(7850 * pi * 0.01**2)
    assert bar["axial"] == pytest.approx(1.0 / EA)
    assert bar["bending"] == pytest.approx(1.0 / (48.0 * EI))
    assert bar["cantilever"] == pytest.approx(1.0 / (3.0 * EI))
    assert bar["lowest"] == pytest.approx(pi / 2.0 * sqrt(EI / bar["mass"]))
    assert bar["wave"] == pytest.approx(sqrt(7850 / 207e9))
    # bodies and joints that are added make nothing faster
    motion = found["scales"]["frequency"] / (2.0 * pi)
    assert 0.5 * bar["highest"] < motion < 1.0001 * bar["highest"]
    text = CliRunner().invoke(program, ["check", str(tmp_path / "bar.yaml")]).output
    assert "flexible    rod: 4 elements on 1 m, 2.47 kg" in text
    assert "gives way 1.54e-08 m/N along (L/EA)" in text


def test_a_free_bar_has_the_frequency_of_its_mesh():
    text = BAR.partition("  tip")[0] + "solver: {end: 0.1}\n"
    mechanism = assemble(loads(text))
    begun = start(loads(text), mechanism, located=True)
    found = scales(loads(text), mechanism, begun)
    (bar,) = bar_scales(loads(text), mechanism, found.contacts)
    assert found.frequency / (2.0 * pi) == pytest.approx(bar.highest, rel=1e-5)
    assert found.explicit_step == pytest.approx(bar.explicit_step, rel=1e-5)


def test_the_share_of_a_contact():
    law = "contact_laws: {c: {normal: identified, stiffness: 1e8, exponent: 1, restitution: 0.9, "
    text = FLEXIBLE + law + "bearing_radius: 20 mm}}\n"
    text = text.replace("tip], at: [1, 0]}", "tip], at: [1, 0], clearance: 1 mm, contact: c}")
    mechanism = assemble(loads(text))
    found = scales(loads(text), mechanism, start(loads(text), mechanism, located=True))
    (bar,) = bar_scales(loads(text), mechanism, found.contacts)
    assert bar.contact_shares == pytest.approx({"hinge": 1e-8 / (1e-8 + bar.axial)})


def test_so_many_elements_are_checked_without_a_linearisation():
    scenario = loads(BAR, ["bodies.rod.elements=300", "bodies.rod.section.diameter=1 mm"])
    mechanism = assemble(scenario)
    found = scales(scenario, mechanism, start(scenario, mechanism, located=True))
    assert not found.eigenvalues and found.fastest_is == "the mesh of 'rod'"
    (bar,) = bar_scales(scenario, mechanism, ())
    assert found.explicit_step == bar.explicit_step < 1e-5


PULLED = """
bodies:
  rope: {{type: ancf_cable, start: [0, 0], end: [1, 0], section: {{diameter: 20 mm}},
         youngs_modulus: 1 MPa, density: 1000, strain: {}}}
joints: {{pin: {{type: revolute, bodies: [ground, rope], at: [0, 0]}}}}
forces:
  f: {{type: applied_load, body: rope, at: [1, 0], direction: [1, 0], force: "{}"}}
solver: {{end: 2, method: dop853, tolerance: 1e-6}}
"""


@pytest.mark.parametrize(
    ("strain", "force", "words"),
    [
        ("engineering", "-1000*t", "is squeezed to"),
        ("green", "-1000*t", "is squeezed to"),
        ("engineering", "1000*t", "is stretched to"),
        ("green", "2000*t", "is stretched to"),
    ],
)
def test_a_bar_that_collapses_ends_the_run(strain, force, words):
    r = run(PULLED.format(strain, force), fails=True)
    assert r.outcome.status == "failed" and len(r.rows) > 10
    assert r.outcome.reason.startswith("bodies.rope (<text>:3:")
    assert f"element 4 {words}" in r.outcome.reason
    assert f"t = {r.outcome.time:.6g} s" in r.outcome.reason


def test_a_bar_strained_beyond_its_law_is_told():
    text = PULLED.replace("end: 2", "end: 0.2")
    r = run(text.format("green", "100*smoothstep(t/0.1)"))
    (told,) = doubts(r.scenario, r.mechanism, r.outcome)
    assert told.startswith("bodies.rope: strained by 0.") and "along, at node" in told
    r = run(text.format("green", "10*smoothstep(t/0.1)"))
    assert not doubts(r.scenario, r.mechanism, r.outcome)


def test_a_bar_bent_beyond_its_law_is_told():
    text = PULLED.format("green", "3*smoothstep(t/0.1)").replace("[1, 0], force", "[0, 1], force")
    text = text.replace("revolute", "fixed").replace("end: 2", "end: 1")
    r = run(text)
    *_, told = doubts(r.scenario, r.mechanism, r.outcome)
    assert "at its surface by bending, at node 0" in told


def test_a_velocity_that_was_not_kept_is_told():
    text = BAR.replace("spherical", "revolute").replace("end: 0.1", "end: 1e-3")
    text = text.replace("at: [1, 0]}\njoints", "at: [1, 0], velocity: [0, 3], %s}\njoints")
    text %= "angular_velocity: [0, 0, 3]"
    fits = "elements: 4\n    velocity: [0, 1.5]\n    angular_velocity: [0, 0, 3]"
    r = run(text.replace("elements: 4", fits))
    assert not doubts(r.scenario, r.mechanism, r.outcome)
    r = run(text.replace("elements: 4", fits.replace("[0, 1.5]", "[2, 1.5]")))
    (told,) = doubts(r.scenario, r.mechanism, r.outcome)
    assert told.startswith("bodies.rod.velocity: given as [2, 1.5, 0], starts with [")


@pytest.mark.parametrize("do", ["release: [pin]", "release: [weld]", "lock: [pin]"])
def test_user_events_at_a_bar(do):
    text = BAR.replace("spherical", "revolute").replace("207 GPa", "2 GPa")
    r = run(text + f"events: {{e: {{when: t, value: 0.02, do: {{{do}}}}}}}\n")
    assert r.outcome.fired == {"e": 1}
    assert r.outcome.statistics["energy_residual_relative"] < 1e-9


def test_the_example_of_the_documentation_runs(pytestconfig):
    text = (pytestconfig.rootpath / "docs" / "scenarios.md").read_text("utf-8")
    example = next(block for block in text.split("```") if "type: ancf_cable" in block)
    r = run(example.partition("\n")[2])
    assert r.outcome.status == "done" and not lint(r.scenario)


# --- the cross-section of a bar in space ------------------------------------------------------

ANGLED = """
planar: false
bodies:
  a: {type: ancf_cable, start: [0, 0, 0], end: [0, 1, 0], section: {width: 20 mm},
      youngs_modulus: 210e9, density: 7850}
  b: {type: ancf_cable, start: [0, 1, 0], end: [1, 1, 0], section: {width: 20 mm},
      youngs_modulus: 210e9, density: 7850}
  m: {mass: 1, inertia: [0.01, 0.01, 0.01], at: [0.3, 0.5, 0]}
joints:
  clamp: {type: fixed, bodies: [ground, a], at: [0, 0, 0]}
  %s
forces:
  %s
solver: {end: 1 ms}
"""
BALL = "ball: {type: spherical, bodies: [a, b], at: [0, 1, 0]}"
NONE = "pull: {type: applied_load, body: m, direction: [1, 0, 0], force: 1}"


@pytest.mark.parametrize(
    ("joint", "force", "what"),
    [
        ("weld: {type: fixed, bodies: [a, b], at: [0, 1, 0]}", NONE, "at an angle"),
        (BALL, "stop: {type: limit_stop, point: {body: m, at: [0.1, 0.5, 0]}, stiffness: 1e4, "
         "wall: {body: a, at: [0, 0.5, 0], normal: [1, 0, 0]}}", "turns with 'a'"),
        (BALL, "push: {type: applied_load, body: m, at: [0.3, 0.5, 0], frame: a, "
         "direction: [1, 0, 0], force: 1}", "turns with 'a'"),
        (BALL, "wind: {type: distributed_load, body: b, frame: a, direction: [1, 0, 0], "
         "force_per_length: 1}", "turns with 'a'"),
    ],
)  # fmt: skip
def test_nothing_turns_with_a_cross_section_in_space(joint, force, what):
    with pytest.raises(ModelError, match=what):
        built(ANGLED % (joint, force))


def test_along_a_bar_is_known():
    built(ANGLED % (BALL, "push: {type: applied_load, body: m, at: [0.3, 0.5, 0], frame: a, "
                    "direction: [0, 1, 0], force: 1}"))  # fmt: skip


CLAMPED = """
planar: false
bodies:
  a: {type: ancf_cable, start: [0, 0, 0], end: %(end)s, section: {width: 20 mm}, elements: 2,
      youngs_modulus: 210e9, density: 7850}
joints: {r: {type: fixed, bodies: [%(bodies)s], at: [0, 0, 0]}}
forces:
  t1: {type: applied_load, body: a, at: %(end)s, direction: %(across)s, force: 100*sin(13*t)}
  t2: {type: applied_load, body: a, at: %(end)s, direction: [0, 1, 0], force: 100*sin(17*t)}
solver: {end: 20 ms, tolerance: 1e-6, method: radau}
"""


def test_a_clamp_holds_whatever_way_a_bar_is_drawn():
    """Every cantilever gives way alike across, in both orders of the weld."""
    found = []
    for end in ([1.0, 0.0, 0.0], [-1.0, 0.0, 0.0], [0.0, 0.0, -1.0], [0.6, 0.0, 0.8]):
        across = np.cross(end, [0.0, 1.0, 0.0])
        for bodies in ("ground, a", "a, ground"):
            r = run(CLAMPED % {"end": end, "bodies": bodies, "across": across.tolist()})
            tip = r["a.tip"][-1] - end
            found.append([tip @ across, tip[1], tip @ end])
            assert r.outcome.statistics["energy_residual_relative"] < 1e-6
    assert found[0][0] > 1e-4 and found[0][1] > 1e-4
    assert np.abs(np.array(found) - found[0]).max() < 1e-8


def test_the_end_of_a_short_run_is_looked_at():
    """Fewer steps than there are between two looks, and the bar is four times as long."""
    file = Path(__file__).parents[2] / "scenarios" / "validation" / "flexible_pendulum.yaml"
    r = run(load(file, ["bodies.rod.youngs_modulus=10"]), fails=True)
    assert r.outcome.statistics["steps"] < 100
    assert "stretched to" in r.outcome.reason
