"""Reactions that the motion does not determine: of least norm, whichever rows are left out."""

from pathlib import Path

import numpy as np
import pytest

from trsim.assemble.assemble import assemble
from trsim.assemble.equations import derivative
from trsim.assemble.least_norm import least_norm
from trsim.elements.scene import scene
from trsim.scenario.load import load, loads
from trsim.solve.start.consistent import start

from ..runs import run

VALIDATION = Path(__file__).parents[2] / "scenarios" / "validation"
YOKE = VALIDATION / "yoke_on_three_links.yaml"
DOOR = VALIDATION / "kitchen_door.yaml"


def all_rows(s):
    """J of all rows against the world-axes twists of all frames, and what makes it forces."""
    J = np.zeros((s.m + len(s.redundant), 6 * s.n))
    for k in range(len(J)):
        for l in range(s.row_start[k], s.row_start[k + 1]):
            f = s.line_frame[l]
            if f > 0:
                J[k, 6 * f : 6 * f + 6] += s.J[l]
    return J, s.row_unit[: len(J)] / s.size


@pytest.mark.parametrize("planar", ["true", "false"])
def test_multipliers_are_those_of_the_pseudoinverse(planar):
    scenario = load(YOKE, [f"planar={planar}"])
    mechanism = assemble(scenario)
    begun = start(scenario, mechanism, located=True)
    s = scene(mechanism.model)
    yd = np.zeros_like(begun.y)
    y = begun.y
    derivative(s, 0.0, y, yd)
    J, unit = all_rows(s)
    before = J.T @ s.lam
    least_norm(s)
    np.testing.assert_allclose(J.T @ s.lam, before, atol=1e-9 * np.abs(before).max())
    weighted = J / unit[:, None]
    wanted = np.linalg.lstsq(weighted.T, before, rcond=1e-10)[0] / unit
    np.testing.assert_allclose(s.lam, wanted, atol=1e-8 * np.abs(wanted).max())
    least_norm(s)  # once more changes nothing
    np.testing.assert_allclose(s.lam, wanted, atol=1e-8 * np.abs(wanted).max())


def test_reactions_do_not_depend_on_the_order_of_the_joints():
    text = YOKE.read_text()
    lines = [line for line in text.splitlines() if line.startswith("  ") and "revolute" in line]
    other = text
    for line in lines:
        other = other.replace(line + "\n", "")
    other = other.replace("joints:\n", "joints:\n" + "\n".join(reversed(lines)) + "\n")
    one, two = run(loads(text)), run(loads(other))
    assert one.mechanism.redundant != two.mechanism.redundant
    for joint in "ABCabc":
        np.testing.assert_allclose(one[f"{joint}.reaction"], two[f"{joint}.reaction"], atol=1e-6)


def test_two_hinges_share_the_weight():
    """Hinges alike, above and below the centre of mass: each carries half of the weight."""
    text = """
planar: false
bodies:
  door: {mass: 20 kg, inertia: [1, 2, 3], at: [0.4, 0, 1]}
joints:
  low: {type: revolute, bodies: [ground, door], at: [0, 0, 0.2]}
  high: {type: revolute, bodies: [ground, door], at: [0, 0, 1.8]}
gravity: [0, 0, -9.81]
solver: {end: 0.1 s}
"""
    r = run(loads(text))
    weight = 20 * 9.81
    for hinge in ("low", "high"):
        np.testing.assert_allclose(r[f"{hinge}.reaction"][:, 2], weight / 2, rtol=1e-9)
    # and the moment of the weight is a pair of forces and moments of the hinges
    pair = r["high.reaction"][:, 0] - r["low.reaction"][:, 0]
    moment = r["high.reaction_moment"] + r["low.reaction_moment"]
    np.testing.assert_allclose(0.8 * pair + moment[:, 1], -0.4 * weight, rtol=1e-9)


def test_a_flexible_bar_between_welds():
    """A bar clamped at both ends in the plane, pulled across in its middle: its ends are alike.

    Between a ground and a sledge two slides hold the sledge, so that rows at the bar are redundant.
    """
    text = """
bodies:
  sledge: {mass: 2 kg, inertia: 0.1, at: [1, 0]}
  bar: {type: ancf_cable, start: [0, 0], end: [1, 0], elements: 4, section: {width: 20 mm},
        youngs_modulus: 70 GPa, density: 2700 kg/m^3}
joints:
  left: {type: revolute, bodies: [ground, bar], at: [0, 0]}
  right: {type: revolute, bodies: [sledge, bar], at: [1, 0]}
  again: {type: revolute, bodies: [sledge, bar], at: [1, 0]}
  low: {type: prismatic, bodies: [ground, sledge], at: [1, 0], axis: [1, 0, 0]}
gravity: [0, -9.81]
solver: {end: 5 ms, tolerance: 1e-6}
"""
    r = run(loads(text))
    assert len(r.mechanism.redundant) == 2
    np.testing.assert_allclose(r["right.reaction"], r["again.reaction"], atol=1e-7)
    alone = run(loads(text.replace("  again:", "  # again:")))
    together = r["right.reaction"] + r["again.reaction"]
    np.testing.assert_allclose(together, alone["right.reaction"], atol=1e-3)
    assert np.abs(together).max() > 1.0


def test_kitchen_door_carries_the_same_by_other_rows():
    r = run(load(DOOR, ["output.channels=['*']", "solver.end=0.5"]))
    assert np.abs(r["bottom.reaction"]).max() < 500
    assert np.abs(np.diff(r["bottom.reaction"], axis=0)).max() < 5  # smooth
