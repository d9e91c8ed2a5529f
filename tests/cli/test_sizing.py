"""trsim run of a scenario with `sizing`, as a command."""

import json

import numpy as np
import pytest

from tests import inside
from trsim.store.read import read

G = 9.81
LEVER = """
bodies:
  rod: {mass: 2 kg, inertia: 0.05 kg*m^2, at: [0.2, 0]}
joints:
  hinge: {type: revolute, bodies: [ground, rod], at: [0, 0]}
drives:
  motor: {joint: hinge, position: "1.2*t"}
sensors: {turn: {joint: hinge}}
forces:
  hand: {type: applied_load, body: rod, at: [0.4, 0], frame: rod, direction: [0, 1], force: 0}
sizing: {drive: motor, load: forces.hand.force, of: turn, below: 1e-9, passes: 8}
gravity: [0, -9.81, 0]
solver: {method: static_path, end: 1 s}
output: {every: 20 ms}
"""


def test_sizing(answer, tmp_path, monkeypatch):
    """Passes are told and stored, the load stands beside the result and in its scenario."""
    monkeypatch.chdir(tmp_path)
    (tmp_path / "lever.yaml").write_text(LEVER)
    code, document = answer("run", "lever.yaml")
    assert code == 0 and document["runs"][0]["sizing"][-1] < 1e-9
    stored = read("runs/lever.h5")
    assert json.loads(stored.text("scenario/resolved"))["forces"]["hand"]["force"]["of"] == "turn"
    assert float(stored.group("provenance")["sizing"].split(",")[-1]) < 1e-9
    x, F = np.loadtxt("runs/lever.sizing.csv", delimiter=",").T
    assert pytest.approx(2 * G * 0.2 * np.cos(x) / 0.4, abs=1e-9) == F
    assert answer("run", "runs/lever.h5")[0] == 0  # with the load as it was found


def test_errors(answer, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    (tmp_path / "lever.yaml").write_text(LEVER.replace("drive: motor", "drive: moter"))
    code, document = answer("run", "lever.yaml")
    assert code == 3 and "sizing.drive" in document["errors"][0]["path"]
    (tmp_path / "lever.yaml").write_text(LEVER)
    code, document = answer("run", "lever.yaml", "--certify")
    assert code == 2 and "many runs" in document["errors"][0]["what"]


def test_a_sweep_of_sizings(answer, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    inside.sweeps(monkeypatch)
    (tmp_path / "lever.yaml").write_text(LEVER)
    code, _ = answer("sweep", "lever.yaml", "--set", "bodies.rod.mass=[1, 3]", "-j", "1", "-o", "s")
    assert code == 0
    cases = sorted((tmp_path / "s").rglob("*.h5"))
    loads = [
        json.loads(read(c).text("scenario/resolved"))["forces"]["hand"]["force"] for c in cases
    ]
    found = sorted(load["table"][0][1] for load in loads)
    assert found == pytest.approx([m * G * 0.2 / 0.4 for m in (1, 3)], abs=1e-9)
