"""Accelerations where constraint rows nearly depend on each other, or do."""

import numpy as np
import pytest

from trsim.assemble.assemble import assemble
from trsim.assemble.equations import derivative
from trsim.elements.scene import scene
from trsim.scenario.load import load, loads
from trsim.solve.start.consistent import start

from ..linkages import REVERSER, flat_parallelogram

WINDOWS = REVERSER.parent / "validation" / "windows_2.yaml"  # three uprights, then two bars
GRAVITY, STIFFNESS = 9.81, 11.445  # m/s^2; theta'' = STIFFNESS sin(theta), 1/s^2, exact
RATE = 3.3  # rad/s


def ready(read):
    """Workspace and state of a scenario at its start."""
    mechanism = assemble(read)
    begun = start(read, mechanism, True)
    work = scene(mechanism.model)
    work.branch[:] = begun.branch
    return work, begun.y.copy()


def put(work, y, angle):
    """All uprights at one angle from the vertical, turning; their accelerations, exact, (n_v)."""
    s, c, turn = np.sin(angle), np.cos(angle), STIFFNESS * np.sin(angle)
    v = y[work.n_q :]
    exact = np.zeros(work.n_v)
    for k, (x, reach, turns) in enumerate(
        [(0, 0.5, 1), (1, 0.5, 1), (2, 0.5, 1), (0.5, 1, 0), (1.5, 1, 0)]
    ):
        at = slice(3 * k, 3 * k + 3)
        y[at] = x + reach * s, reach * c, -turns * angle
        v[at] = reach * c * RATE, -reach * s * RATE, -turns * RATE
        exact[at] = (
            reach * (c * turn - s * RATE**2),
            reach * (-s * turn - c * RATE**2),
            -turns * turn,
        )
    return exact


@pytest.mark.parametrize("away", [1.0, 1e-2, 1e-3, 1e-4, 2e-5])
def test_accelerations_near_a_singular_position(away):
    """Rounding is felt as eps / away: with residuals of S it would be as eps / away^2."""
    work, y = ready(load(WINDOWS))
    exact = put(work, y, np.pi / 2 + away)
    yd = np.zeros_like(y)
    derivative(work, 0.0, y, yd)
    error = np.max(np.abs(yd[work.n_q : work.n_q + work.n_v] - exact))
    print(f"{away:g} rad away: {error:.1e}")
    assert error < 5e-15 / away + 1e-12


def test_multipliers_of_dependent_rows():
    """In a parallelogram lying flat a row depends on the others: accelerations as by lstsq."""
    read = loads(flat_parallelogram(more="gravity: [0, -9.81, 0]"))
    work, y = ready(read)
    yd = np.zeros_like(y)
    derivative(work, 0.0, y, yd)
    rows, moved = np.zeros((work.m, work.n_v)), np.zeros((work.m, work.n_v))
    for f in range(1, work.n):
        at = slice(3 * (f - 1), 3 * f)
        for p in range(work.frame_start[f], work.frame_start[f + 1]):
            k = work.slot_row[p]
            rows[k, at], moved[k, at] = work.B[p, :3], work.W[p, :3]
    assert np.linalg.matrix_rank(rows) < work.m
    free = np.tile([0.0, -GRAVITY, 0.0], work.n - 1)
    found = np.linalg.lstsq(rows @ moved.T, rows @ free - work.gamma[: work.m], rcond=1e-10)[0]
    expected = free - moved.T @ found
    assert yd[work.n_q : work.n_q + work.n_v] == pytest.approx(expected, abs=1e-12 * GRAVITY)
