"""Distributed load: sag of a bar, the same as its weight, and its work."""

import numpy as np
import pytest

from trsim.errors import ScenarioError

from ..runs import built, run

BAR = """
bodies:
  bar: {type: ancf_cable, start: [0, 0], end: [1, 0], elements: 8, section: {width: 10 mm},
        youngs_modulus: 207e9, density: 7850}
joints:
  clamp: {type: fixed, bodies: [ground, bar], at: [0, 0]}
"""
LOAD = """
forces:
  wind: {type: distributed_load, body: bar, direction: [0, -2, 0], force_per_length: %s, frame: %s}
"""
REST = "initial: {equilibrium: all}\nsolver: {end: 1e-6}\n"
EI, EA = 207e9 * 0.01**4 / 12, 207e9 * 1e-4


def test_sag():
    """w = p L^4 / 8 EI of a cantilever, p L the force at its clamp."""
    r = run(BAR + LOAD % (1.0, "world") + REST)
    assert r["bar.tip"][0, 1] == pytest.approx(-1.0 / (8.0 * EI), rel=1e-5)
    assert r["clamp.reaction"][0, 1] == pytest.approx(1.0, rel=1e-9)
    assert r["clamp.reaction_moment"][0, 2] == pytest.approx(0.5, rel=1e-5)
    assert r["wind.load"][0] == pytest.approx([0.0, -1.0, 0.0])


def test_as_weight():
    weight = 7850 * 1e-4 * 9.81
    loaded = run(BAR + LOAD % (weight, "world") + REST)
    heavy = run(BAR + "gravity: [0, -9.81, 0]\n" + REST)
    assert loaded["bar.tip"][0] == pytest.approx(heavy["bar.tip"][0], abs=1e-12)


@pytest.mark.parametrize("frame", ["world", "bar"])
def test_its_work_is_booked(frame):
    text = BAR + LOAD % ('"50*sin(300*t)"', frame)
    r = run(text + "solver: {end: 20 ms, method: radau, tolerance: 1e-6}\n")
    assert np.abs(r["energy.work.loads"]).max() > 1e-6
    assert r.outcome.statistics["energy_residual_relative"] < 1e-6


def test_only_on_flexible_bars():
    text = BAR.replace("\nbodies:", "\nbodies:\n  block: {mass: 1, inertia: 1}")
    with pytest.raises(ScenarioError, match="'block' is not flexible"):
        built(text + (LOAD % (1.0, "world")).replace("body: bar", "body: block"))
