"""trsim statics, as a command."""

import pytest

from trsim.store.read import read, verify

ROD = """
title: A rod that stands on its head
bodies:
  rod: {{mass: 2 kg, inertia: 0.05, at: [0, {y}], velocity: [3, 0, 0]}}
joints:
  hinge: {{type: revolute, bodies: [ground, rod], at: [0, 0]}}
forces:
  spring: {{type: torsion_spring, joint: hinge, stiffness: 1}}
{more}
gravity: [0, -9.81, 0]
"""


@pytest.fixture
def rod(tmp_path, monkeypatch):
    """A scenario file that is written in the current folder."""
    monkeypatch.chdir(tmp_path)

    def written(y, more=""):
        (tmp_path / "rod.yaml").write_text(ROD.format(y=y, more=more))

    return written


def test_stable(rod, answer, trsim):
    rod(-0.3)
    code, told = answer("statics", "rod.yaml")
    assert code == 0 and told["result"] == "runs/rod.statics.h5" and not told["warnings"]
    found = told["equilibrium"]
    assert (found["verdict"], found["freedoms"]) == ("stable", 1)
    assert found["stiffness"] == pytest.approx(2 * 9.81 * 0.3 + 1)
    assert told["channels"]["hinge.reaction"]["value"] == pytest.approx([0, 19.62, 0])
    assert told["turns"][0]["rotation"] == pytest.approx([0, 0, 0], abs=1e-9)
    run = read("runs/rod.statics.h5")
    assert verify(run.path) and run.rows == 1
    assert run.attributes["reason"] == "static equilibrium, stable"
    assert run.channel("hinge.reaction")[0] == pytest.approx([0, 19.62, 0])
    for still in ("rod.velocity", "rod.acceleration", "rod.angular_velocity"):
        assert not run.channel(still).any()
    code, out, _ = trsim("statics", "rod.yaml", "-o", "here.h5")
    assert code == 0 and "stable      1 freedom, lowest eigenvalue 29.9391 1/s^2" in out
    assert "hinge.reaction         0 19.62 0 N" in out and "rod turned by  0 0 0 rad" in out
    assert "static equilibrium, stable" in trsim("show", "here.h5")[1]
    assert trsim("export", "here.h5", "--csv")[0] == 0


def test_unstable(rod, answer, trsim):
    """Told with the direction it falls in: the run itself is a result."""
    rod(0.3)
    code, told = answer("statics", "rod.yaml")
    assert code == 0 and told["equilibrium"]["verdict"] == "unstable"
    assert told["equilibrium"]["frequency"] is None
    [moved] = told["equilibrium"]["direction"]
    assert moved["body"] == "rod" and abs(moved["rotation"][2]) == pytest.approx(1)
    _, out, err = trsim("statics", "rod.yaml")
    assert "falls: rod x" in out and "in balance but not stable" in err


def test_refused(rod, answer):
    rod(-0.3, "  push: {type: applied_load, body: rod, direction: [0, 0, 1], torque: 9 N*m}")
    code, told = answer("statics", "rod.yaml", "--set", "forces.spring.stiffness=0")
    assert code == 4 and "no static equilibrium found" in told["errors"][0]["what"]
    assert "equilibrium" not in told["errors"][0]["hint"]
    rod(-0.3, "  push: {type: applied_load, body: rood, torque: 9 N*m}")
    code, told = answer("statics", "rod.yaml")
    assert code == 3 and told["errors"][0]["line"] == 9


def test_of_another_load(rod, answer):
    rod(-0.3, "  push: {type: applied_load, body: rod, direction: [0, 0, 1], torque: 1 N*m}")
    turned = [
        answer("statics", "rod.yaml", "--set", f"forces.push.torque={torque}")[1]["turns"][0][
            "rotation"
        ][2]
        for torque in (0.0, 0.5, 2.0)
    ]
    assert turned[0] == pytest.approx(0, abs=1e-9)
    assert 0.06 < turned[1] < 0.08 and 0.25 < turned[2] < 0.35
