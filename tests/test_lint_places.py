"""Warnings of sizes count grooves, profiles, pins in slots, links and ropes as places of a body."""

import numpy as np
import pytest

from trsim.scenario.lint import lint
from trsim.scenario.load import loads
from trsim.scenario.plausible import rim

# a disc with a bearing at its centre, of a radius of gyration of 71 mm
DISC = """
frame: {{at: [3, 1], angle: -20 deg}}
bodies:
  disc: {{mass: 6, inertia: {inertia}, at: [0.01, 0.002]}}
  arm: {{mass: 1.2, inertia: 0.006, at: [0.08, 0.1]}}
joints:
  d: {{type: revolute, bodies: [disc, ground], at: [0.01, 0]}}
  a: {{type: revolute, bodies: [ground, arm], at: [0.16, 0.12]}}
{joint}
forces:
  none: {{type: torsion_spring, joint: a, stiffness: 0}}
{force}
contact_laws:
  k: {{normal: impact, stiffness: 1e6, exponent: 1.5, damping: 1, ramp: 0.01 mm}}
solver: {{end: 1}}
"""
PLACES = [[0.068, 0], [0, 0.058], [-0.063, 0], [0, -0.06]]
CURVE = "closed: true, at: [10 mm, 0], x_axis: [0, 1], y_axis: [-1, 0]"
SLOT = "  slot: {{type: {}, bodies: [disc, arm], at: [10 mm, 68 mm], {}}}"
JOINTS = {
    "groove": SLOT.format("point_on_curve", f"curve: {{{CURVE}, points: {PLACES}}}"),
    "formula": SLOT.format(
        "point_on_curve",
        f'curve: {{{CURVE}, x: 0.068*cos(s), y: 0.06*sin(s), range: [0, "2*pi"]}}',
    ),
    "cam": SLOT.format("cam", f"radius: 2 mm, curve: {{{CURVE}, points: {PLACES}}}").replace(
        "68 mm", "70 mm"
    ),
    "link": "  l: {type: link, bodies: [disc, arm], points: [[10 mm, 68 mm], [0.08, 0.2]]}",
    "rope": "  l: {type: rope, through: [{body: disc, at: [10 mm, 68 mm]}, "
    "{body: arm, at: [0.08, 0.2]}]}",
}
WHEEL = "  x: {type: prismatic, bodies: [ground, arm], axis: [1, 0], at: [0.05, -0.068]}\n"
JOINTS |= {
    "gear": "  l: {type: gear, joints: [d, a], radii: [0.068, 0.124]}",
    "belt": "  l: {type: belt, joints: [a, d], radii: [0.01, 0.068]}",
    "rack": WHEEL + "  l: {type: rack_and_pinion, joints: [d, x], radius: 0.068}",
    "drum": "  l: {type: rope, through: [{body: disc, at: [10 mm, 0], radius: 68 mm, turn: left},"
    " {body: arm, at: [0.08, 0.2]}]}",
    "roller": "  l: {type: cam, bodies: [arm, disc], at: [10 mm, 0], radius: 68 mm, "
    "curve: {at: [0, 0], points: [[-0.1, 0.068], [0, 0.0681], [0.1, 0.068]]}}",
}
PROFILE = f"""  c: {{type: surface_contact, contact: k,
     surface: {{body: disc, shape: profile, closed: true, at: [10 mm, 0], points: {PLACES}}},
     ball: {{body: arm, at: [0.08, 0.2], radius: 2 mm}}}}"""


def notes(joint="", force="", inertia="0.03"):
    found = lint(loads(DISC.format(joint=joint, force=force, inertia=inertia)))
    return [note for note in found if note.startswith("bodies.disc: ")]


def test_without_them_the_warning_comes():
    (note,) = notes()
    assert "its points lie within 0.002 m" in note


@pytest.mark.parametrize("kind", JOINTS)
def test_places_of_joints(kind):
    assert not notes(JOINTS[kind])
    # and what is too small for them is told
    (note,) = notes(JOINTS[kind], inertia="1e-6")
    assert "its points lie up to 0.0" in note


@pytest.mark.parametrize("axis", [None, (0, 0, -2), (1, 0, 0), (1, -2, 3)])
def test_a_rim_lies_across_its_axis(axis):
    way, centre = np.array(axis or (0, 0, 1)), (1.0, 2.0, -0.5)
    places = np.array(list(rim(centre, 0.3, axis))) - centre
    np.testing.assert_allclose(places @ way, 0, atol=1e-15)
    np.testing.assert_allclose(np.linalg.norm(places, axis=1), 0.3)
    np.testing.assert_allclose(places.sum(axis=0), 0, atol=1e-15)
    assert abs(places[0] @ places[2]) < 1e-15


def test_places_of_a_mesh():
    mesh = "  m: {type: gear_mesh, joints: [d, a], radii: [0.068, 0.124], stiffness: 1e6}"
    assert not notes(force=mesh)


def test_places_of_a_profile():
    assert not notes(force=PROFILE)
    (note,) = notes(force=PROFILE, inertia="1e-6")
    assert "its points lie up to 0.0" in note


@pytest.mark.parametrize("kind", ["inplane", "inline"])
def test_a_pin_in_a_slot_is_a_place_of_what_carries_it(kind):
    """2 kg within 10 mm would be denser than any metal; its pin is 58 mm away."""
    text = """
bodies:
  crank: {mass: 2, inertia: [0.005, 0.006, 0.01], at: [0.01, 0, 0]}
  yoke: {mass: 4, inertia: [0.05, 0.02, 0.06], at: [0.25, 0.03, 0.02]}
joints:
  c: {type: revolute, bodies: [ground, crank], at: [0, 0, 0]}
  guide: {type: prismatic, bodies: [ground, yoke], axis: [1, 0, 0]}
  slot: {type: inplane, bodies: [yoke, crank], at: [0.06, 0.03, 0.01], axis: [1, 0, 0]}
solver: {end: 1}
""".replace("inplane", kind)
    assert not lint(loads(text))
    assert any("as a solid cube" in note for note in lint(loads(text.replace("0.06,", "0.01,"))))
