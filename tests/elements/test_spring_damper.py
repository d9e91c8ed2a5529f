"""Spring and damper: force is minus the gradient of the energy, the pair adds no moment."""

import numpy as np
import pytest

from ..runs import run
from .bench import bench, check_action_is_reaction, check_gradient, check_power

SPRING = """
forces:
  spring: {type: spring_damper, bodies: [left, right], points: [[0.3, 0, 0.1], [0.6, 0.1, 0]],
           stiffness: 300, damping: 20, preload: 5, free_length: 0.2}
"""
SEEDS = range(4)


@pytest.mark.parametrize("seed", SEEDS)
def test_force_is_minus_the_gradient_of_the_energy(seed):
    check_gradient(bench(SPRING, np.random.default_rng(seed)))


@pytest.mark.parametrize("seed", SEEDS)
def test_action_is_reaction_and_the_book_closes(seed):
    b = bench(SPRING, np.random.default_rng(seed))
    check_action_is_reaction(b)
    check_power(b)
    assert b.book[2] < 0.0  # dampers only take


def test_pulls_the_bodies_together_when_stretched():
    b = bench(SPRING.replace("damping: 20", "damping: 0"), np.random.default_rng(0))
    b.r[1:], b.p[1:], b.V[:] = [[0, 0, 0], [5, 0, 0]], [1, 0, 0, 0], 0.0
    assert b.wrenches()[1, 0] > 0.0 > b.wrenches()[2, 0]


def test_preload_is_the_tension_at_the_free_length():
    b = bench(SPRING.replace(", free_length: 0.2", ""), np.random.default_rng(0))
    b.r[1], b.r[2] = (0.1, -0.2, 0.3), (0.5, 0.2, -0.1)  # as drawn
    b.p[1], b.p[2] = [(np.cos(a / 2), 0, 0, np.sin(a / 2)) for a in (0.7, -0.4)]
    b.V[:] = 0.0
    assert np.linalg.norm(b.wrenches()[2, :3]) == pytest.approx(5.0, rel=1e-12)


def test_no_direction_no_force():
    b = bench(SPRING.replace("[0.3, 0, 0.1], [0.6, 0.1, 0]", "[0.1, -0.2, 0.3], [0.5, 0.2, -0.1]"),
              np.random.default_rng(0))  # fmt: skip
    b.r[2] = b.r[1]
    assert not b.wrenches().any()


DRAWN_OUT = """
bodies: {block: {mass: 2, inertia: 0.01}}
joints: {slide: {type: prismatic, bodies: [ground, block], axis: [1, 0, 0]}}
drives: {pull: {joint: slide, velocity: 0.5}}
forces:
  spring: {type: spring_damper, bodies: [ground, block], points: [[-0.3, 0.4], [0, 0]],
           stiffness: 500, damping: 20, preload: 10, free_length: 0.45}
solver: {end: 1, tolerance: 1e-9}
output: {every: 0.1}
"""


def test_channels_are_tension_and_length():
    r = run(DRAWN_OUT)
    x = 0.3 + 0.5 * r.t
    length = np.hypot(x, 0.4)
    tension = 10.0 + 500.0 * (length - 0.45) + 20.0 * 0.5 * x / length
    np.testing.assert_allclose(r["spring.length"], length, rtol=1e-8)
    np.testing.assert_allclose(r["spring.force"], tension, rtol=1e-7)
