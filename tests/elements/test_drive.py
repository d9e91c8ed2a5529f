"""Drive: compliant ones are springs with a moving end; rigid ones give their power to the book."""

import numpy as np
import pytest

from trsim.errors import ScenarioError

from ..mechanisms import driven_slide
from ..runs import built, run
from .bench import (
    TWO_BODIES,
    bench,
    check_action_is_reaction,
    check_gradient,
    check_power,
    now,
    put_right,
)

AXIS, PLACE = np.array([0.48, 0.6, 0.64]), np.array([0.2, 0.1, 0.0])
COMPLIANT = """
joints: {{joint: {{type: {}, bodies: [left, right], at: [0.2, 0.1, 0], axis: [0.48, 0.6, 0.64]}}}}
drives: {{drive: {{joint: joint, {}, compliance: {{stiffness: 500, damping: 30}}}}}}
"""
RNG = np.random.default_rng(0)
MOTIONS = {"position": "position: 0.2 + sin(3*t)", "velocity": "velocity: 2*cos(3*t)"}


def stretched(kind, motion, seed=1):
    """A compliant drive away from its prescribed position, both bodies thrown about."""
    rng = np.random.default_rng(seed)
    b = bench(COMPLIANT.format(kind, MOTIONS[motion]), rng)
    turn, shift = (0.9, 0.0) if kind == "revolute" else (0.0, 0.9)
    # a slide also off its line: only there the lever on the left body shows
    aside = 0.3 * shift * np.cross(AXIS, [1.0, 0.0, 0.0])
    put_right(b, PLACE, turn * AXIS, shift * AXIS + aside)
    if motion == "velocity":
        b.z[-1] = 0.4
    return b


@pytest.mark.parametrize("kind", ["revolute", "prismatic"])
@pytest.mark.parametrize("motion", MOTIONS)
def test_compliant_drive_is_a_spring_with_a_moving_end(kind, motion):
    b = stretched(kind, motion)
    check_action_is_reaction(b)
    check_power(b)
    assert b.book[2] < 0.0
    b.mechanism = bench(COMPLIANT.format(kind, MOTIONS[motion]).replace("30", "0"), RNG).mechanism
    check_gradient(b)


@pytest.mark.parametrize("kind", ["revolute", "prismatic"])
def test_force_of_a_compliant_drive(kind):
    b = stretched(kind, "velocity")
    axis = now(b, AXIS)
    b.V[2, 3:] = b.V[1, 3:]
    b.V[2, :3] = b.V[1, :3] + np.cross(b.V[1, 3:], b.r[2] - b.r[1])
    on_right = b.wrenches()[2, 3:] if kind == "revolute" else b.wrenches()[2, :3]
    assert on_right @ axis == pytest.approx(-500 * (0.9 - 0.4) + 30 * 2 * np.cos(3 * b.t))


@pytest.mark.parametrize("kind", ["revolute", "prismatic"])
@pytest.mark.parametrize("bodies", ["[ground, right]", "[right, ground]"])
def test_damping_ratio_takes_the_mass_of_the_driven_body(kind, bodies):
    text = COMPLIANT.format(kind, "velocity: 1").replace("[left, right]", bodies)
    m = built(TWO_BODIES + text.replace("damping: 30", "damping_ratio: 0.1"))
    (par,) = [i.row.par for i in m.instances if i.element.key == "drive"]
    I = np.array([[0.05, 0.001, 0.002], [0.001, 0.04, -0.003], [0.002, -0.003, 0.03]])
    c, s = np.cos(-0.4), np.sin(-0.4)
    a = np.array([[c, s, 0], [-s, c, 0], [0, 0, 1]]) @ AXIS
    away = np.cross(PLACE - np.array([0.5, 0.2, -0.1]), AXIS)
    inertia = 3.0 if kind == "prismatic" else a @ I @ a + 3.0 * away @ away
    assert par[10] == pytest.approx(0.2 * np.sqrt(500 * inertia), rel=1e-12)


HINGED = """
{flat}
bodies: {{rod: {{mass: 2 kg, inertia: {inertia}, at: [0.3, 0.4, {z}]}}}}
joints: {{hinge: {{type: revolute, bodies: {bodies}, at: [0, 0, 0], axis: {axis}}}}}
sensors: {{turn: {{joint: hinge}}}}
drives:
  drive: {{joint: hinge, position: 0, compliance: {{stiffness: 600, damping_ratio: 0.2}}}}
initial: {{hinge: 1e-3}}
solver: {{end: 0.6 s, tolerance: 1e-10}}
output: {{every: 0.1 ms}}
"""


@pytest.mark.parametrize("bodies", ["[ground, rod]", "[rod, ground]"])
@pytest.mark.parametrize(
    "flat, inertia, z, axis", [
        ("", "0.1", "0", "[0, 0, 1]"),
        ("planar: false", "[0.05, 0.07, 0.1]", "0.7", "[0, 0, 1]"),  # the same beside the plane
    ],
)  # fmt: skip
def test_damping_ratio_on_a_hinge_is_that_of_the_decay(bodies, flat, inertia, z, axis):
    """A body off its hinge: by I alone 0.2 became 0.08.  m = 0.1 + 2 * 0.5^2 kg*m^2."""
    text = HINGED.format(flat=flat, inertia=inertia, z=z, axis=axis, bodies=bodies)
    r = run(text)
    (par,) = [i.row.par for i in r.mechanism.instances if i.element.key == "drive"]
    assert par[10] == pytest.approx(0.4 * np.sqrt(600 * 0.6), rel=1e-12)
    x = np.abs(r["turn"])
    tops = x[1:-1][(x[1:-1] > x[:-2]) & (x[1:-1] >= x[2:])]
    decrement = 2.0 * np.log(tops[0] / tops[1])  # of a whole period
    assert decrement / np.hypot(2.0 * np.pi, decrement) == pytest.approx(0.2, rel=1e-3)


def test_damping_ratio_of_a_flexible_bar_on_a_hinge():
    """A slender bar about its end: m L^2 / 3."""
    m = built("""
bodies:
  bar: {type: ancf_cable, start: [0, 0], end: [0.6, 0], elements: 4, youngs_modulus: 2e11,
        density: 7800, section: {width: 10 mm, height: 10 mm}}
joints: {hinge: {type: revolute, bodies: [ground, bar], at: [0, 0]}}
drives: {drive: {joint: hinge, position: 0, compliance: {stiffness: 600, damping_ratio: 0.5}}}
""")
    (par,) = [i.row.par for i in m.instances if i.element.key == "drive"]
    inertia = 7800 * 1e-4 * 0.6 * 0.6**2 / 3.0
    assert par[10] == pytest.approx(np.sqrt(600 * inertia), rel=1e-12)


@pytest.mark.parametrize("motion", ["position", "velocity"])
@pytest.mark.parametrize("compliance", ["", ", compliance: {stiffness: 1e9, damping_ratio: 1}"])
def test_force_and_work_of_a_drive_on_a_slide(motion, compliance):
    """m x'' = F: the force from the prescribed motion, its sign turned by `sign`."""
    text, exact = driven_slide(motion, compliance)
    r = run(text)
    x, v, a = exact(r.t)
    rel = 1e-9 if not compliance else 1e-3  # N: 1e9 N/m times the tolerance
    assert r["slider.position"][:, 0] == pytest.approx(x, abs=1e-9 if not compliance else 1e-6)
    late = r.t > 0.02  # a compliant drive starts with a transient
    assert r["drive.force"][late] == pytest.approx(-3.0 * a[late], abs=rel * 3 * np.abs(a).max())
    assert r["drive.power"][late] == pytest.approx((3.0 * a * v)[late], abs=10 * rel * 3)
    work = r["energy.work.drives"] + r["energy.work.dampers"]
    assert work == pytest.approx(0.5 * 3.0 * (v**2 - v[0] ** 2), abs=1e-6)
    assert np.abs(r["energy.residual"]).max() < 1e-8


@pytest.mark.parametrize(
    "drive, what",
    [
        ("{joint: joint, velocity: x}", "a drive depends on t only"),
        ("{joint: joint}", "give either"),
        ("{joint: ball, velocity: 1}", "has no coordinate"),
        ("{joint: joit, velocity: 1}", "Did you mean 'joint'"),
        ("{joint: joint, velocity: 1, position: t}", "give either"),
    ],
)
def test_bad_drives_are_refused_with_their_place(drive, what):
    text = f"""
joints:
  joint: {{type: revolute, bodies: [ground, left], at: [0, 0]}}
  ball: {{type: spherical, bodies: [ground, right], at: [0, 0]}}
sensors: {{x: {{joint: joint}}}}
drives: {{drive: {drive}}}
"""
    with pytest.raises(ScenarioError) as caught:
        built(TWO_BODIES + text)
    assert what in str(caught.value)
    assert caught.value.path[:2] == ("drives", "drive")
