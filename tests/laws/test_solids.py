"""Volume, centre and second moments against integrals over small cubes, and closed forms."""

from math import pi, sqrt

import numpy as np
import pytest

from trsim.laws import solids

L_SHAPE = ((0.0, 0.0), (3.0, 0.0), (3.0, 1.0), (1.0, 1.0), (1.0, 2.0), (0.0, 2.0))


def summed(inside, low, high, n=60):
    """Moments of what a function says is inside, by cubes: right to about 1/n^2."""
    axes = [np.linspace(a, b, n, endpoint=False) + 0.5 * (b - a) / n
            for a, b in zip(low, high, strict=True)]  # fmt: skip
    points = np.stack(np.meshgrid(*axes, indexing="ij"), axis=-1).reshape(-1, 3)
    points = points[inside(*points.T)]
    cube = np.prod((np.array(high) - low) / n)
    centre = points.mean(axis=0)
    d = points - centre
    inertia = cube * (np.sum(d * d) * np.eye(3) - d.T @ d)
    return cube * len(points), centre, inertia


@pytest.mark.parametrize(
    ("made", "inside", "low", "high", "near"),
    [
        (solids.box(1.0, 2.0, 3.0), lambda x, y, z: x < 9.0, (-0.5, -1, -1.5), (0.5, 1, 1.5), 1e-3),
        (
            solids.cylinder(1.0, 0.6, 3.0),
            lambda x, y, z: (np.hypot(x, y) < 1.0) & (np.hypot(x, y) > 0.6),
            (-1, -1, -1.5),
            (1, 1, 1.5),
            1e-2,
        ),
        (
            solids.sphere(1.0, 0.5),
            lambda x, y, z: (x * x + y * y + z * z < 1.0) & (x * x + y * y + z * z > 0.25),
            (-1, -1, -1),
            (1, 1, 1),
            1e-2,
        ),
        (
            solids.prism(L_SHAPE, 0.4),
            lambda x, y, z: ~((x > 1.0) & (y > 1.0)),
            (0, 0, -0.2),
            (3, 2, 0.2),
            1e-3,
        ),
    ],
    ids=["box", "tube", "shell", "prism"],
)
def test_moments_are_those_of_many_small_cubes(made, inside, low, high, near):
    volume, centre, inertia = summed(inside, low, high)
    assert made.mass == pytest.approx(volume, rel=near)
    np.testing.assert_allclose(made.centre, centre, atol=near)
    np.testing.assert_allclose(made.inertia, inertia, atol=near * np.trace(inertia))


def test_prism_of_a_rectangle_is_a_box_wherever_and_whichever_way_round():
    corners = ((100.0, 50.0), (102.0, 50.0), (102.0, 53.0), (100.0, 53.0))
    box = solids.box(2.0, 3.0, 0.1)
    for order in (corners, corners[::-1]):
        made = solids.prism(order, 0.1)
        assert made.mass == pytest.approx(box.mass, rel=1e-13)
        np.testing.assert_allclose(made.centre, (101.0, 51.5, 0.0), rtol=1e-14)
        np.testing.assert_allclose(made.inertia, box.inertia, atol=1e-12)


def test_a_hole_is_a_negative_part():
    tube = solids.cylinder(1.0, 0.4, 2.0)
    full, core = solids.cylinder(1.0, 0.0, 2.0), solids.cylinder(0.4, 0.0, 2.0)
    there = np.eye(3)
    made = solids.together(
        [solids.placed(full, 5.0, (1, 2, 3), there), solids.placed(core, -5.0, (1, 2, 3), there)]
    )
    assert made.mass == pytest.approx(5.0 * tube.mass, rel=1e-14)
    np.testing.assert_allclose(made.inertia, 5.0 * tube.inertia, atol=1e-12)


def test_two_halves_of_a_turned_box_are_the_box():
    c, s = 0.6, 0.8
    axes = np.array(((c, -s, 0.0), (s, c, 0.0), (0.0, 0.0, 1.0)))
    whole = solids.placed(solids.box(4.0, 1.0, 2.0), 3.0, (1.0, -2.0, 0.5), axes)
    half = solids.box(2.0, 1.0, 2.0)
    ends = [np.array((1.0, -2.0, 0.5)) + axes @ (x, 0.0, 0.0) for x in (-1.0, 1.0)]
    made = solids.together(solids.placed(half, 3.0, end, axes) for end in ends)
    assert made.mass == pytest.approx(whole.mass, rel=1e-15)
    np.testing.assert_allclose(made.centre, whole.centre, atol=1e-14)
    np.testing.assert_allclose(made.inertia, whole.inertia, atol=1e-12)


def test_full_cylinder_and_sphere_in_closed_form():
    disc = solids.cylinder(0.5, 0.0, 0.1)
    assert disc.inertia[2, 2] == pytest.approx(0.5 * disc.mass * 0.25, rel=1e-15)
    ball = solids.sphere(0.5, 0.0)
    assert ball.mass == pytest.approx(pi / 6.0, rel=1e-15)
    assert ball.inertia[0, 0] == pytest.approx(0.4 * ball.mass * 0.25, rel=1e-14)


def test_what_no_body_can_have_is_told():
    assert solids.possible(np.diag((1.0, 1.0, 2.0)))  # a plate
    assert solids.possible(solids.cylinder(sqrt(2.0), 0.0, 1e-9).inertia)
    assert not solids.possible(np.diag((1.0, 1.0, 2.001)))
    assert not solids.possible(np.diag((-1.0, 1.0, 1.0)))
