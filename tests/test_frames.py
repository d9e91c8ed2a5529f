"""The frame of a scenario: what is read in it, who may say it, and what is wrong with it."""

import json
from math import cos, pi, sin
from pathlib import Path

import numpy as np
import pytest

from trsim.assemble.assemble import assemble
from trsim.cli.check import frame_lines
from trsim.errors import TrsimError
from trsim.scenario.load import load, loads, valid
from trsim.scenario.memory import Memory
from trsim.sweeps.plan import faults, plan

FRAME = "{at: [0, 0.3, 0.4], y_axis: [0, 0.6, 0.8]}"
Y, Z = (0.0, 0.6, 0.8), (0.0, -0.8, 0.6)
TEXT = f"""\
frame: {FRAME}
parameters: {{m: 2}}
gravity: [0, 0, -9.81]
points:
  seat: {{body: ground, at: [1, 0, 0]}}
bodies:
  door: {{mass: m, inertia: [1, 2, 2.5], at: [0, 1, 0], velocity: [0, 1, 0]}}
  rod: {{mass: 1, inertia: [1, 1, 1]}}
joints:
  hinge: {{type: revolute, bodies: [ground, door], at: seat}}
  ball: {{type: spherical, bodies: [door, rod], at: {{in: seat, at: [0, 0, 1]}}}}
sensors:
  way: {{type: point, body: rod, at: [0, 0, 2], axis: [0, 0, 1]}}
forces:
  push: {{type: applied_load, body: rod, direction: [0, 1, 0], force: m}}
totals:
  all: {{bodies: [door, rod], mass: 5, at: [0, 0, 1], inertia: [30, 29, 28], remainder: rod}}
solver: {{end: 1}}
"""


def shown(text, sets=()):
    with pytest.raises(TrsimError) as caught:
        loads(text, sets, "a.yaml")
    return caught.value.show()


def test_what_is_read_in_the_frame():
    s = loads(TEXT)
    assert s.gravity == (0.0, 0.0, -9.81)  # the world's
    assert s.bodies["door"].at == pytest.approx((0.0, 0.9, 1.2))
    assert s.bodies["door"].velocity == pytest.approx(Y)
    assert s.joints["hinge"].at == pytest.approx((1.0, 0.3, 0.4))
    assert s.joints["hinge"].axis == pytest.approx(Z)  # left out: the z axis of the frame
    assert s.joints["ball"].at == pytest.approx((1.0, 0.3 - 0.8, 0.4 + 0.6))
    assert s.sensors["way"].origin == pytest.approx((0.0, 0.3, 0.4))
    assert s.forces["push"].direction == pytest.approx(Y)
    assert s.points["seat"].frame.y == pytest.approx(Y)
    straight, none = loads(TEXT.replace(FRAME, "{x_axis: [3, 0, 0]}")), loads(TEXT, ["frame=null"])
    assert (straight.bodies, straight.forces) == (none.bodies, none.forces)


def test_totals_are_of_the_frame():
    """Turned back, the remainder is that of the scenario without a frame."""
    ours, theirs = loads(TEXT).bodies["rod"], loads(TEXT, ["frame=null"]).bodies["rod"]
    assert ours.mass == theirs.mass == 3.0
    assert ours.inertia == pytest.approx(theirs.inertia, abs=1e-14)
    R = np.array([(1, 0, 0), Y, Z]).T
    assert ours.at == pytest.approx(tuple(R @ theirs.at + (0, 0.3, 0.4)))
    one = TEXT.replace("inertia: [1, 2, 2.5]", "inertia: 2").replace(
        "inertia: [1, 1, 1]", "inertia: 1"
    )
    one = one.replace("[30, 29, 28]", "20")
    turned, flat = (loads(text).bodies["rod"].inertia for text in (one, one.replace(FRAME, "null")))
    assert turned == pytest.approx(flat)


def test_instances_stand_in_the_frame():
    text = """
templates: {t: {bodies: {a: {mass: 1, inertia: [1, 2, 2], at: [1, 0, 0]}}}}
instances:
  here: {template: t}
  there: {template: t, frame: {at: [0, 2, 0], x_axis: [0, 0, 1]}}
frame: {at: [0, 0.3, 0.4], y_axis: [0, 0.6, 0.8]}
"""
    s = loads(text)
    assert s.bodies["here_a"].at == pytest.approx((1.0, 0.3, 0.4))
    assert s.bodies["there_a"].at == pytest.approx((0.0, 0.3 + 1.2 - 0.8, 0.4 + 1.6 + 0.6))
    assert s.bodies["there_a"].drawn_in.x == pytest.approx(Z)
    assert s.bodies["there_a"].drawn_in.y == pytest.approx(Y)  # left out: that of the frame
    about = text.replace("x_axis: [0, 0, 1]", "angle: 90 deg, about: [0, -1, 0]")
    assert loads(about).bodies["there_a"].drawn_in.x == pytest.approx(Z)


@pytest.mark.parametrize("about, x, z", [
    ("[0, 1, 0]", (cos(0.1), 0, -sin(0.1)), (sin(0.1), 0, cos(0.1))),  # x aft, z up: nose up
    ("[0, 0, 2]", (cos(0.1), sin(0.1), 0), (0, 0, 1)),
    ("[-1, 0, 0]", (1, 0, 0), (0, sin(0.1), cos(0.1))),
])  # fmt: skip
def test_an_angle_turns_right_handed(about, x, z):
    frame = loads(f"frame: {{angle: 0.1, about: {about}}}\nbodies: {{}}").frame.moved
    assert frame.x == pytest.approx(x, abs=1e-15)
    assert frame.z == pytest.approx(z, abs=1e-15)


def test_axes_are_turned_by_an_angle_about_their_z_unless_told():
    frame = loads("frame: {x_axis: [0, 0, -1], angle: 90 deg}\nbodies: {}").frame.moved
    assert frame.x == pytest.approx((0, 1, 0), abs=1e-15)  # about z = [1, 0, 0]
    assert frame.z == pytest.approx((1, 0, 0), abs=1e-15)


def test_parameters_sets_and_sweeps(tmp_path):
    text = TEXT.replace(FRAME, "{about: [0, 1, 0], angle: pitch}").replace(
        "m: 2", "m: 2, pitch: 5 deg"
    )
    assert loads(text).frame.angle == pytest.approx(pi / 36)
    assert loads(text, ["parameters.pitch=90deg"]).bodies["door"].at == pytest.approx((0, 1, 0))
    assert loads("bodies: {}", ["frame.angle=90deg"]).frame.moved.x == pytest.approx((0, 1, 0))
    path = tmp_path / "a.yaml"
    path.write_text(text + "sweep: {frame.angle: [0 deg, 3 deg], parameters.m: [1, 2]}\n")
    found = plan(str(path))
    assert list(faults(found)) == []
    assert found.units["frame.angle"] == "rad" or found.units["frame.angle"] == "deg"
    assert len({case.digest for case in found.cases}) == 4
    last = found.scenario(found.cases[-1])
    assert last.frame.angle == pytest.approx(pi / 60)
    data, memory = loads(text).resolved, Memory()
    assert valid(data, memory)
    assert valid({**data, "frame": {"angle": 1}}, memory)
    places = {spec.at for key, spec in memory.made.items() if '"mass": "m"' in key[1]}
    assert len(places) == 2  # what is known of a piece depends on the frame
    assert not valid({**data, "frame": {"angle": "1 kg"}}, memory)


BASE = "bodies: {a: {mass: 1, inertia: [1, 1, 1], at: [1, 0, 0]}}\n"


def put(tmp_path, **files):
    for name, text in files.items():
        (tmp_path / f"{name}.yaml").write_text(text)
    return tmp_path / "a.yaml"


def test_a_file_that_extends_is_in_the_frame_of_its_base(tmp_path):
    more = "extends: base.yaml\nbodies: {b: {mass: 1, inertia: [1, 1, 1], at: [0, 1, 0]}}\n"
    path = put(tmp_path, base="frame: {angle: 90 deg}\n" + BASE, a=more)
    s = load(path)
    assert s.bodies["a"].at == pytest.approx((0, 1, 0))
    assert s.bodies["b"].at == pytest.approx((-1, 0, 0))
    s = load(put(tmp_path, base=BASE, a="extends: base.yaml\nframe: {angle: 90 deg}\n"))
    assert s.bodies["a"].at == pytest.approx((0, 1, 0))
    s = load(
        put(tmp_path, base=BASE, up="frame: {angle: 90 deg}", a="extends: [base.yaml, up.yaml]")
    )
    assert s.bodies["a"].at == pytest.approx((0, 1, 0))


OTHER = "bodies: {b: {mass: 1, inertia: [1, 1, 1], at: [1, 0, 0]}}\n"


@pytest.mark.parametrize("one, two, agree", [
    ("", "frame: {angle: 1}\n", False),
    ("frame: {angle: 1}\n", "", False),
    ("frame: {angle: 1}\n", "frame: {angle: 2}\n", False),
    ("frame: {angle: 1}\n", "frame: {angle: 1}\n", True),
    ("", "", True),
])  # fmt: skip
def test_files_side_by_side_are_in_one_frame(tmp_path, one, two, agree):
    both = "extends: [one.yaml, two.yaml]\n"
    path = put(tmp_path, one=one + BASE, two=two + OTHER, a=both)
    if agree:
        assert set(load(path).bodies) == {"a", "b"}
        return
    with pytest.raises(TrsimError) as caught:
        load(path)
    found = caught.value.show()
    assert "a.yaml:1:21: extends.1: 'two.yaml' and 'one.yaml' are not given in the same" in found


def test_a_law_has_no_frame(tmp_path):
    law = "contact_laws: {pin: {normal: hunt_crossley, restitution: 0.5, stiffness: 1e9}}\n"
    path = put(tmp_path, one="frame: {angle: 1}\n" + BASE, two=law + "bodies: {a: {mass: 2}}\n",
               a="extends: [one.yaml, two.yaml]\n")  # fmt: skip
    assert load(path).bodies["a"].mass == 2.0


def test_cases_are_attitudes(tmp_path):
    text = (
        TEXT
        + """
cases:
  up: {frame: {angle: 10 deg, about: [1, 0, 0]}}
  far: {forces: {push: {direction: [1, 0, 0]}}}
  both: {extends: [far, up]}
  other: {frame: null}
"""
    )
    path = tmp_path / "a.yaml"
    path.write_text(text)
    found = plan(str(path))
    assert list(faults(found)) == []
    made = {case.name: found.scenario(case) for case in found.cases}
    assert made["both"].frame.angle == pytest.approx(pi / 18)
    assert made["both"].frame.y_axis == Y  # merged key by key
    assert made["other"].frame is None
    path.write_text(text.replace("extends: [far, up]", "extends: [up, down]")
                    + "  down: {frame: {angle: -5 deg}}\n")  # fmt: skip
    with pytest.raises(TrsimError, match="'down' and 'up' are not given in the same `frame`"):
        plan(str(path))


@pytest.mark.parametrize("old, new, message", [
    (FRAME, "{y_axis: [1, 0, 0]}", "a.yaml:1:17: frame.y_axis: y_axis is parallel to x_axis"),
    (FRAME, "{x_axis: [0, 0, 0]}", "a.yaml:1:17: frame.x_axis: an axis must not be zero"),
    (FRAME, "{about: [0, 0, 0], angle: 1}", "a.yaml:1:16: frame.about: an axis must not be zero"),
    (FRAME, "{about: [0, 1, 0]}", "a.yaml:1:16: frame.about: `about` needs an `angle`"),
    (FRAME, "{angle: 1 m}", "a.yaml:1:16: frame.angle: wrong unit: 'm'"),
    (FRAME, "{angle: pitch}", "a.yaml:1:16: frame.angle: no parameter named 'pitch'"),
    (FRAME, "{origin: [0, 0]}", "a.yaml:1:9: frame: unknown key 'origin'"),
    (FRAME, "{at: seat}", "a.yaml:1:13: frame.at: must be [x, y] or [x, y, z], got 'seat'"),
    (FRAME, "7", "a.yaml:1:8: frame: must be a mapping, got 7"),
    ("at: [0, 1, 0], v", "at: [0, 1 kg, 0], v", "a.yaml:7:49: bodies.door.at.1: wrong unit"),
    ("mass: 5,", "mass: 2,", "totals.all.mass: the other bodies weigh 2 kg"),
])  # fmt: skip
def test_messages(old, new, message):
    assert old in TEXT
    found = shown(TEXT.replace(old, new, 1))
    assert message in found
    assert found.count(" ^") == 1, found  # said once


FLAT = """
planar: true
frame: {at: [1, 2, 3], about: [0, 0, 1], angle: 30 deg}
gravity: [0, -9.81, 0]
bodies: {rod: {mass: 1, inertia: 1, at: [1, 0]}}
joints: {pin: {type: revolute, bodies: [ground, rod], at: [0, 0]}}
solver: {end: 1}
"""


def test_a_frame_turned_about_z_stays_in_the_plane():
    assert assemble(loads(FLAT)).planar
    with pytest.raises(TrsimError, match=r"bodies.rod is turned out of the x-y plane by its frame"):
        assemble(loads(FLAT, ["frame.about=[0, 1, 0]"]))
    with pytest.raises(TrsimError, match="its frame"):  # z the other way round is another plane
        assemble(loads(FLAT, ["frame.about=[1, 0, 0]", "frame.angle=180 deg"]))


def test_one_inertia_is_too_few_in_a_tilted_frame():
    text = FLAT.replace("planar: true\n", "")
    with pytest.raises(TrsimError, match=r"one inertia .* is not enough in a scene that is not"):
        assemble(loads(text, ["frame.about=[0, 1, 0]"]))


def test_the_documented_example():
    text = (Path(__file__).parents[1] / "docs/scenarios.md").read_text()
    s = loads(text.split("## The frame of a file")[1].split("```yaml scene\n")[1].split("```")[0])
    assert assemble(s).stages is not None
    forward = s.frame.frame.turned((-1.0, 0.0, 0.0))  # x goes aft
    assert forward[2] == pytest.approx(sin(pi / 60))  # the nose is up


def test_check_tells_it():
    frame = loads(TEXT).frame.moved._asdict()
    assert json.loads(json.dumps(frame)) == {
        "at": [0.0, 0.3, 0.4], "x": [1.0, 0.0, 0.0],
        "y": pytest.approx(Y), "z": pytest.approx(Z),
    }  # fmt: skip
    told = "\n".join(frame_lines(frame))
    assert "at [0, 0.3, 0.4] m, x [1, 0, 0], y [0, 0.6, 0.8], z [0, -0.8, 0.6]" in told
    assert frame_lines(None) == []
