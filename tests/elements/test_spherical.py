"""Spherical joint: it holds a point and nothing else."""

import numpy as np
import pytest

from trsim.errors import TrsimError

from ..runs import built, energy_error, run

TOP = """
planar: false
gravity: [0, 0, -9.81]
bodies:
  top: {mass: 0.5, inertia: [1e-3, 1e-3, 4e-4], at: [0.03, 0, 0.05], angular_velocity: [1, 2, 60]}
joints: {foot: {type: spherical, bodies: [ground, top], at: [0, 0, 0]}}
solver: {end: 0.5, tolerance: 1e-10}
output: {every: 1 ms, channels: ["*", "*.rotation"]}
"""


def test_reaction_is_mass_times_acceleration_less_weight():
    r = run(TOP)
    inertial = 0.5 * (r["top.acceleration"] + [0, 0, 9.81])
    assert r["foot.reaction"] == pytest.approx(inertial, abs=1e-9)
    assert np.abs(r["foot.reaction_moment"]).max() < 1e-9


def test_heavy_top_keeps_its_energy_and_angular_momentum():
    r = run(TOP)
    R = r["top.rotation"].reshape(-1, 3, 3)
    omega = r["top.angular_velocity"]
    spin = np.einsum("tij,j,tkj,tk->ti", R, [1e-3, 1e-3, 4e-4], R, omega)
    orbital = 0.5 * np.cross(r["top.position"], r["top.velocity"])
    about_vertical = (spin + orbital)[:, 2]
    assert about_vertical == pytest.approx(about_vertical[0], rel=1e-9)
    assert np.abs(r["energy.residual"]).max() < 1e-9 * r["energy.kinetic"].max()
    assert np.linalg.norm(r["top.position"], axis=1) == pytest.approx(np.hypot(0.03, 0.05))


# --- friction of the ball -------------------------------------------------------------------------

RUB = "rub: {{type: joint_friction, joint: foot, radius: 25 mm{more}, friction: {law}}}"
SLIDING = "{law: modified_coulomb, coefficient: 0.3, v0: 0, v1: 1e-4}"
STICKS = """{law: sticking, coefficient: 0.3, stribeck_speed: 1 mm/s, bristle_stiffness: 1e5,
             bristle_damping: 300}"""
METHODS = {
    "dop853": ("tolerance: 1e-10", 1e-8),
    "radau": ("method: radau, formulation: index1, tolerance: 1e-9", 1e-6),
    "ggl": ("method: radau, formulation: ggl, tolerance: 1e-9", 1e-6),
    "generalized_alpha": ("method: generalized_alpha, tolerance: 1e-5", 2e-3),
}


def rough(
    joint,
    law=SLIDING,
    more="",
    spin=(0, -8, 0),
    bodies="ground, rod",
    solver="tolerance: 1e-10",
    end=1,
    planar="false",
    at=(1.5, 2, -3),
    g="[0, 0, -9.81]",
    inertia="[0.05, 0.05, 0.05]",
):
    """A rod that hangs from a rough ball at [1, 2, -3], which its centre of mass may be."""
    arm = np.array(at) - [1, 2, -3]
    return f"""
planar: {planar}
bodies: {{rod: {{mass: 2, inertia: {inertia}, at: {list(at)}, angle: 0.3,
               velocity: {np.cross(spin, arm).tolist()}, angular_velocity: {list(spin)}}}}}
joints: {{foot: {{bodies: [{bodies}], at: [1, 2, -3], {joint}}}}}
forces: {{{RUB.format(more=more, law=law)}}}
gravity: {g}
solver: {{end: {end}, {solver}}}
output: {{every: 0.01, channels: ["*"]}}
"""


@pytest.mark.parametrize("method", METHODS)
@pytest.mark.parametrize("bodies", ["ground, rod", "rod, ground"])
def test_a_pendulum_on_a_rough_ball_is_one_on_a_journal(method, bodies):
    solver, error = METHODS[method]
    wanted = run(rough("type: revolute, axis: [0, 1, 0]"))
    r = run(rough("type: spherical", bodies=bodies, solver=solver))
    assert r["rod.position"] == pytest.approx(wanted["rod.position"], abs=10 * error)
    assert r["rub.normal_force"] == pytest.approx(wanted["rub.normal_force"], rel=100 * error)
    assert r["rub.sliding_speed"] == pytest.approx(
        np.abs(wanted["rub.sliding_speed"]), abs=10 * error
    )
    sign = 1.0 if bodies == "ground, rod" else -1.0
    moment = sign * r["rub.moment"]
    assert moment[:, 1] == pytest.approx(wanted["rub.force"], abs=100 * error)
    assert np.abs(moment[:, [0, 2]]).max() < 10 * error
    assert energy_error(r) < 100 * error


@pytest.mark.parametrize("law", [SLIDING, STICKS])
@pytest.mark.parametrize("planar", ["true", "false"])
@pytest.mark.parametrize("more, extra", [("", 0.0), (", constant: 0.04 N*m", 0.04)])
def test_a_ball_slows_evenly(law, planar, more, extra):
    """Balanced on the ball: |omega| falls by (mu r m g + constant)/I, in the plane as in space."""
    spin = (0, 0, 6) if planar == "true" else (2, -4, 4)
    g = "[0, -9.81, 0]"
    r = run(rough("type: spherical", law, more, spin, at=(1, 2, -3), planar=planar, g=g, end=0.5))
    slower = (0.3 * 0.025 * 2 * 9.81 + extra) / 0.05
    near = 1e-6 if law is SLIDING else 2e-3  # bristles bend first
    spins = np.outer(6 - slower * r.t, np.array(spin) / 6)
    assert r["rod.angular_velocity"] == pytest.approx(spins, abs=near)
    assert r["rub.normal_force"] == pytest.approx(2 * 9.81, rel=1e-9)
    late = r.t > 0.1
    moment = -0.05 * slower * np.array(spin) / 6
    assert r["rub.moment"][late] == pytest.approx(moment + 0 * r["rub.moment"][late], abs=1e-5)
    assert energy_error(r) < 1e-6


@pytest.mark.parametrize("law", [SLIDING, STICKS])
@pytest.mark.parametrize("bodies", ["base, rod", "rod, base"])
def test_a_ball_between_two_bodies_that_turn(law, bodies):
    """M = -mu r |R| omega/|omega| of their relative spin, and its power is what is lost."""
    r = run(f"""
planar: false
bodies:
  base: {{mass: 3, inertia: [0.2, 0.3, 0.4], at: [0, 0, 0], angular_velocity: [3, -1, 2]}}
  rod: {{mass: 2, inertia: [0.05, 0.02, 0.04], at: [0.7, 0.1, 0.2], velocity: [0.5, 0.5, 1.45],
       angular_velocity: [-5, 4, 7]}}
joints:
  hold: {{type: spherical, bodies: [ground, base], at: [0, 0, 0]}}
  foot: {{type: spherical, bodies: [{bodies}], at: [0.5, 0, 0]}}
forces: {{{RUB.format(more="", law=law)}}}
gravity: [0, 0, -9.81]
solver: {{end: 0.5, tolerance: 1e-10}}
output: {{every: 1e-3, channels: ["*"]}}
""")
    w = r["rod.angular_velocity"] - r["base.angular_velocity"]
    w = w if bodies == "base, rod" else -w
    speed = np.linalg.norm(w, axis=1)[:, None]
    R = np.linalg.norm(r["foot.reaction"], axis=1)[:, None]
    assert speed.min() > 1.0
    near = 1e-9 if law is SLIDING else 0.02
    wanted = -0.3 * 0.025 * R * w / speed
    late = r.t > 0.05
    off = np.abs(r["rub.moment"] - wanted)[late].max()
    assert off < near * np.abs(wanted).max()
    power = np.sum(r["rub.moment"] * w, axis=1)
    work = np.append(0, np.cumsum(np.diff(r.t) * (power[1:] + power[:-1]) / 2))
    assert r["energy.work.friction"] == pytest.approx(work, abs=1e-3 * abs(work[-1]))
    assert energy_error(r) < 1e-7


@pytest.mark.parametrize("mu, holds", [(0.9, True), (0.5, False)])
def test_a_ball_holds_a_weight(mu, holds):
    """On a lever of 15 mm, which sticks where mu r is more."""
    law = STICKS.replace("coefficient: 0.3", f"coefficient: {mu}")
    r = run(rough("type: spherical", law, spin=(0, 0, 0), at=(1.012, 2.009, -3), end=0.5,
                  solver="tolerance: 1e-8"))  # fmt: skip
    turned = np.linalg.norm(r["rod.position"] - r["rod.position"][0], axis=1)
    if holds:
        moment = 2 * 9.81 * np.array([0.009, -0.012, 0])
        assert turned.max() < 1e-4 and np.ptp(turned[-10:]) < 1e-9
        assert r["rub.moment"][-1] == pytest.approx(moment, abs=1e-6)
    else:
        assert turned[-1] > 1e-3


def test_a_ball_of_which_nothing_is_known_or_too_much():
    for more, words in (
        (", length: 1", "a ball has no `length`"),
        (", thrust_radius: 1", "a ball has no `thrust_radius`"),
        (", constant: 3 N", "wrong unit: 'N'"),
    ):
        with pytest.raises(TrsimError, match=words):
            built(rough("type: spherical", more=more))
    with pytest.raises(TrsimError, match="friction of a ball needs `radius`"):
        built(rough("type: spherical").replace("radius: 25 mm, ", ""))


def test_a_ball_of_two_is_refused_where_its_load_is_not_unique():
    two = rough("type: spherical").replace(
        "joints: {", "joints: {far: {type: spherical, bodies: [ground, rod], at: [1, 3, -3]}, "
    )
    with pytest.raises(TrsimError, match="is not unique"):
        built(two)


def test_a_rough_ball_on_a_flexible_bar():
    """In space nobody knows how such a bar turns about itself; in the plane it is a journal."""
    bar = """
planar: PLANAR
bodies:
  bar: {mass: 2, inertia: [1e-4, 0.17, 0.17], at: [0.5, 0],
       flexible: {youngs_modulus: 70 GPa, area: 1e-4, second_moment: 1e-9, elements: 2}}
joints:
  foot: {type: spherical, bodies: [ground, bar], at: [0, 0]}
  far: {type: inline, bodies: [ground, bar], at: [1, 0], axis: [1, 0, 0]}
forces: {RUB}
gravity: [0, -9.81]
solver: {end: 0.01}
""".replace("RUB", RUB.format(more="", law=SLIDING))
    with pytest.raises(TrsimError, match="about itself"):
        built(bar.replace("PLANAR", "false"))
    run(bar.replace("PLANAR", "true"))
