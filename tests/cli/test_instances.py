"""Scenarios with templates on the command line, from the text to what is read of the file."""

import numpy as np
import pytest

from tests import drawn
from trsim.report.animation import turns
from trsim.report.animation.motion import motion
from trsim.store.read import read

TEXT = """
templates:
  part:
    parameters: {push: 1}
    bodies:
      rod: {mass: 1, inertia: [0.01, 0.02, 0.03], at: [0.2, 0], angle: 0.3}
    joints:
      pin: {type: revolute, bodies: [ground, rod], at: [0, 0], clearance: 1 mm, contact: steel}
    forces:
      air: {type: applied_load, body: rod, frame: rod, direction: [0, 1], force: "5*push*cos(20*t)"}
instances:
  a: {template: part}
  b: {template: part, parameters: {push: 2}, frame: {at: [0, 0, 1], x_axis: [1, 2, 2]}}
contact_laws:
  steel: {normal: identified, stiffness: 1e8, bearing_radius: 10 mm, restitution: 0.5}
solver: {end: 0.02, tolerance: 1e-6}
output: {channels: ["*", "*.rotation"]}
"""


@pytest.fixture
def result(tmp_path, monkeypatch, trsim):
    monkeypatch.chdir(tmp_path)
    (tmp_path / "a.yaml").write_text(TEXT)
    assert trsim("run", "a.yaml", "-o", "a.h5")[0] == 0
    return tmp_path


def test_a_result_runs_again(result, trsim):
    assert trsim("run", "a.h5", "-o", "b.h5")[0] == 0
    a, b = read(result / "a.h5"), read(result / "b.h5")
    assert np.array_equal(a.channel("b_rod.position"), b.channel("b_rod.position"))
    assert "templates" in a.text("scenario/resolved")


def test_commands(result, trsim, monkeypatch):
    drawn.coarse(monkeypatch)
    assert "b_pin (clearance_joint)" in trsim("check", "a.yaml")[1]
    assert "b_rod.position" in trsim("show", "a.h5", "--json")[1]
    for words in ((), ("--animate",)):
        code, _, err = trsim("report", "a.h5", "-o", "figures", *words)
        assert code == 0, err
    assert "b_pin" in " ".join(path.name for path in (result / "figures").rglob("*"))
    for word in ("templates", "instances", "instances.frame", "y_axis"):
        assert trsim("explain", word)[0] == 0
    code, _, err = trsim("check", "a.yaml", "--set", "instances.b.parameters.puhs=1")
    assert code == 3
    assert "template 'part' has no parameter 'puhs'" in err
    code, _, err = trsim("check", "a.yaml", "--set", "instances.c.parameters.push=1")
    assert "nothing named 'c' in instances" in err


def test_an_animation_has_the_axes_of_the_frame(result):
    """Bodies are drawn as at the start: their turns since then are none at the first frame."""
    found = motion(read(result / "a.h5"))
    for name in ("a_rod", "b_rod"):
        turn = found.turns[name][0]
        assert np.abs(turn * np.sign(turn[3]) - turns.STILL).max() < 1e-9
    last = found.turns["b_rod"][-1]
    axis = np.cross([1, 2, 2], [0, 1, 0]) / np.linalg.norm(np.cross([1, 2, 2], [0, 1, 0]))
    assert np.abs(np.cross(last[:3], axis)).max() < 1e-9
    assert np.abs(last[:3]).max() > 1e-3
