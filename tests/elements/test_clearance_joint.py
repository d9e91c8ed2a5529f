"""Clearance joint: contact of journal and bearing in space, with friction at the contact point."""

import numpy as np
import pytest

from trsim.assemble.outputs import measured
from trsim.elements.contract import FLIGHT, PHASE
from trsim.errors import ScenarioError

from ..runs import built
from .bench import (
    TWO_BODIES,
    bench,
    check_action_is_reaction,
    check_gradient,
    check_power,
    now,
    put_right,
)

AXIS, PIN, C, R_B = np.array([0.48, 0.6, 0.64]), np.array([0.2, 0.1, 0.0]), 0.03, 0.2
JOINT = """
joints:
  pin: {{type: revolute, bodies: [left, right], at: [0.2, 0.1, 0], axis: [0.48, 0.6, 0.64],
        clearance: 0.03, contact: law}}
contact_laws:
  law: {{normal: lankarani_nikravesh, stiffness: {stiffness}, restitution: {restitution},
        bearing_radius: 0.2, width: 0.1, youngs_modulus: 1e7, poisson: 0.3,
        friction: {{{friction}}}}}
"""
FRICTION = {
    "none": "law: none",
    "coulomb": "law: coulomb, coefficient: 0.3",
    "modified": "law: modified_coulomb, coefficient: 0.3, v0: 1e-4, v1: 1e-3",
    "sticking": "law: sticking, coefficient: 0.3, stribeck_speed: 0.1, bristle_stiffness: 1e3",
}


def pressed(seed, stiffness="1e6", restitution=0.6, friction="none", depth=0.01):
    """The journal pressed into its bearing, shifted along its axis, both bodies thrown about."""
    rng = np.random.default_rng(seed)
    text = JOINT.format(stiffness=stiffness, restitution=restitution, friction=FRICTION[friction])
    b = bench(text, rng)
    radial = np.cross(AXIS, rng.normal(size=3))
    radial *= (C + depth) / np.linalg.norm(radial)
    put_right(b, PIN, 0.3 * rng.normal(size=3), radial + 0.05 * AXIS)
    return b


def offset(b):
    """Journal centre from bearing centre in the plane of the bearing, world axes."""
    w = b.scene()
    arms = [np.array(s) for s in (w.par[2][0:3], w.par[2][3:6])]
    centres = [X[:3] + X[3:].reshape(3, 3) @ s for X, s in zip(w.X[1:], arms, strict=True)]
    axis = now(b, AXIS)
    d = centres[1] - centres[0]
    return d - (d @ axis) * axis, centres


@pytest.mark.parametrize("stiffness", ["1e6", "internal", "paper", "cylinder"])
@pytest.mark.parametrize("seed", range(3))
def test_elastic_force_is_minus_the_gradient_of_the_energy(seed, stiffness):
    check_gradient(pressed(seed, stiffness, restitution=1.0), h=1e-6)


@pytest.mark.parametrize("friction", FRICTION)
@pytest.mark.parametrize("seed", range(3))
def test_action_is_reaction_and_the_book_closes(seed, friction):
    b = pressed(seed, friction=friction)
    b.z[-1] = 1e-4 if friction == "sticking" else 0.0
    b.V *= 0.1  # slow enough for the bodies to part without the force being cut
    check_action_is_reaction(b)
    check_power(b, h=1e-6)
    assert b.book[3] <= 0.0
    assert friction == "none" or b.book[4] < 0.0


def test_normal_force_of_the_law_along_the_line_of_centres():
    b = pressed(4, restitution=1.0)
    b.V[:] = 0.0
    e, _ = offset(b)
    depth = np.linalg.norm(e) - C
    force = -1e6 * depth**1.5 * e / np.linalg.norm(e)
    np.testing.assert_allclose(b.wrenches()[2, :3], force, rtol=1e-9)


def test_friction_acts_at_the_bearing_surface():
    """A spinning journal: friction against its surface, moments about both centres."""
    b = pressed(5, restitution=1.0, friction="coulomb")
    b.V[:] = 0.0
    b.V[2, 3:] = 40.0 * now(b, AXIS)
    b.V[2, :3] = -np.cross(b.V[2, 3:], offset(b)[1][1] - b.r[2])  # its centre stands still
    e, centres = offset(b)
    depth, n = np.linalg.norm(e) - C, e / np.linalg.norm(e)
    F_n = 1e6 * depth**1.5
    force = -F_n * n - 0.3 * F_n * np.cross(now(b, AXIS), n)
    at = centres[1] + (R_B - C) * n
    F = b.wrenches()
    np.testing.assert_allclose(F[2, :3], force, rtol=1e-9)
    for body, sign in ((2, 1.0), (1, -1.0)):
        np.testing.assert_allclose(F[body, 3:], np.cross(at - b.r[body], sign * force), rtol=1e-9)


def test_friction_opposes_either_way_of_sliding():
    for spin in (40.0, -40.0):
        b = pressed(5, friction="coulomb")
        b.V[:] = 0.0
        b.V[2, 3:] = spin * now(b, AXIS)
        b.V[2, :3] = -np.cross(b.V[2, 3:], offset(b)[1][1] - b.r[2])
        assert b.book[4] < 0.0


@pytest.mark.parametrize("speed", [-50.0, -5.0, -0.5])
def test_never_pulls(speed):
    b = pressed(6, restitution=0.1)
    b.V[:] = 0.0
    e, _ = offset(b)
    b.V[2, :3] = speed * e / np.linalg.norm(e)
    assert b.wrenches()[2, :3] @ e <= 0.0
    assert b.book[3] <= 0.0


def test_no_force_in_flight_or_without_penetration():
    b = pressed(7)
    b.mem[:, PHASE] = FLIGHT
    assert not b.wrenches().any()
    assert not pressed(7, depth=-0.01).wrenches().any()


def test_centred_journal_is_finite():
    b = pressed(8, depth=-C)
    assert np.isfinite(b.wrenches()).all()
    assert not b.wrenches().any()


@pytest.mark.parametrize(
    "old, new, what",
    [
        ("clearance: 0.03", "clearance: -0.03", "must be >= 0"),
        ("clearance: 0.03", "clearance: 0.3", "leaves no journal"),
        ("contact: law", "contact: lw", "no contact law named 'lw'"),
        ("bearing_radius: 0.2, ", "", "bearing_radius"),
        ("lankarani_nikravesh, stiffness: 1e6, restitution: 0.6", "flores, restitution: 0",
         "restitution 0"),
        ("law: none", "law: sticking, coefficient: 0, stribeck_speed: 1, bristle_stiffness: 1e3",
         "coefficient"),
    ],
)  # fmt: skip
def test_bad_input_is_refused_with_its_place(old, new, what):
    text = JOINT.format(stiffness="1e6", restitution=0.6, friction="law: none")
    assert old in text
    with pytest.raises(ScenarioError) as caught:
        built(TWO_BODIES + text.replace(old, new))
    assert what in str(caught.value)
    assert caught.value.path[:2] in (("joints", "pin"), ("contact_laws", "law"))


@pytest.mark.parametrize("friction", ["none", "modified"])
def test_what_is_recorded_is_what_acts(friction):
    """Forces as the journal feels them, and its place in the bearing."""
    b = pressed(4, friction=friction)
    w, columns = b.scene(), {c.name: c.start for c in b.mechanism.columns}
    measured(w, b.t, b.state(), 0.0, 0.0)
    told = {c: w.out[at] for name, at in columns.items() for c in [name.removeprefix("pin.")]}
    d, _ = offset(b)
    n = d / np.linalg.norm(d)
    force = w.out[columns["pin.force"] : columns["pin.force"] + 3]
    assert force == pytest.approx(w.F[2, :3], rel=1e-9)
    across = np.linalg.norm(force - (force @ n) * n)
    assert told["normal_force"] == pytest.approx(abs(force @ n), rel=1e-9)
    assert abs(told["friction_force"]) == pytest.approx(across, rel=1e-9, abs=1e-9)
    assert told["contact_force"] == pytest.approx(np.linalg.norm(force), rel=1e-9)
    assert told["penetration"] == pytest.approx(0.01, rel=1e-6)
    place = np.hypot(told["eccentricity_x"], told["eccentricity_y"])
    assert place == pytest.approx(np.linalg.norm(d), rel=1e-9)
