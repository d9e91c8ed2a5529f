"""Spherical joint: it holds a point and nothing else."""

import numpy as np
import pytest

from ..runs import run

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
