"""Modes with a known answer."""

from math import pi, sqrt

import numpy as np
import pytest

from trsim.solve.diagnose.modes import modes
from trsim.solve.start.consistent import start

from ..mechanisms import free_top
from ..runs import assemble, scenario
from .test_linearised import chain, oscillator


def found(text):
    read = scenario(text, "solver.end=1")
    mechanism = assemble(read)
    return modes(mechanism, start(read, mechanism, located=True))


def test_damped_oscillator():
    [mode] = found(oscillator(2.0, 450.0, 6.0))
    assert mode.kind == "oscillates"
    assert mode.damping_ratio == pytest.approx(6.0 / (2 * sqrt(450.0 * 2.0)), rel=1e-6)
    assert mode.frequency == pytest.approx(15 * sqrt(1 - 0.1**2) / (2 * pi), rel=1e-6)
    assert mode.shape[0].translation == pytest.approx((1.0, 0.0, 0.0), abs=1e-9)


def test_overdamped_oscillator():
    slow, fast = found(oscillator(1.0, 100.0, 50.0))
    assert (slow.kind, fast.kind) == ("decays", "decays")
    assert sorted((slow.rate, fast.rate)) == pytest.approx(
        [-25 - sqrt(525), -25 + sqrt(525)], rel=1e-6
    )


def test_chain_of_equal_masses_and_springs():
    """f_j = sqrt(k/m) / pi sin(j pi / (2 n + 2)), shape sin(j pi i / (n + 1)), both ends fixed."""
    n, m, k = 5, 0.7, 1e4
    every = found(chain(n, m, k))
    exact = [sqrt(k / m) / pi * np.sin(j * pi / (2 * n + 2)) for j in range(1, n + 1)]
    assert [mode.frequency for mode in every] == pytest.approx(exact, rel=1e-6)
    for j, mode in enumerate(every, 1):
        moved = np.array([max(x.translation, key=abs) for x in mode.shape])
        sine = np.sin(j * pi * np.arange(1, n + 1) / (n + 1))
        sine = sine[np.abs(sine) > 1e-9]
        assert np.abs(moved / moved[0]) == pytest.approx(np.abs(sine / sine[0]), rel=1e-5)


def test_a_body_in_space_is_free():
    assert [mode.kind for mode in found(free_top(omega=(0.0, 0.0, 0.0))[0])] == ["free"] * 6


def test_as_many_modes_as_freedoms():
    """Two bodies on a spring: five motions are free, also across the spring, each told once."""
    every = found("""
        bodies: {a: {mass: 1, inertia: 1}, b: {mass: 2, inertia: 1, at: [1, 0]}}
        forces: {s: {type: spring_damper, bodies: [a, b], points: [[0, 0], [1, 0]], stiffness: 100}}
        """)
    assert [mode.kind for mode in every] == ["free"] * 5 + ["oscillates"]
    assert every[-1].frequency == pytest.approx(sqrt(150.0) / (2 * pi), rel=1e-9)
    moved = np.zeros((5, 2, 3))
    for told, mode in zip(moved, every, strict=False):
        for body in mode.shape:
            told["ab".index(body.body)] = (*body.translation[:2], body.rotation[2])
    assert np.linalg.svd(moved.reshape(5, 6))[1].min() > 0.3  # in different directions


def test_a_damped_free_motion_is_one_that_is_free_and_one_that_decays():
    still, slows = found(oscillator(2.0, 0.0, 6.0))
    assert (still.kind, slows.kind) == ("free", "decays")
    assert slows.rate == pytest.approx(-3.0, rel=1e-6)


def test_of_motions_without_swings_the_slowest_comes_first():
    slow, fast = found(oscillator(1.0, 100.0, 50.0))
    assert (slow.rate, fast.rate) == pytest.approx((-25 + sqrt(525), -25 - sqrt(525)), rel=1e-6)
