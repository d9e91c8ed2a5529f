"""S = J M^-1 J^T and its factors, against dense matrices; what a chain costs."""

from types import SimpleNamespace

import numpy as np
import pytest

from benchmarks.problems import bending_chain, windows
from trsim.assemble import schur
from trsim.assemble.equations import derivative
from trsim.assemble.pattern import pattern
from trsim.assemble.reduce import jacobian
from trsim.assemble.schur import rows
from trsim.elements.contract import SCENE, compiled
from trsim.elements.scene import scene
from trsim.kernels.signatures import void
from trsim.scenario.load import loads

from ..linkages import DOOR, slider_crank
from ..runs import assemble

PRODUCTS = """
planar: false
bodies:
  upper: {mass: 2, inertia: [0.4, 0.5, 0.6, 0.03, -0.05, 0.07], at: [0.3, 0.1, 0.2], angle: 0.7}
  lower: {mass: 1, inertia: [0.2, 0.3, 0.4, 0.02, 0.01, -0.06], at: [0.9, 0.4, 0.1], angle: -0.2}
joints:
  hinge: {type: revolute, bodies: [ground, upper], at: [0, 0, 0], axis: [1, 2, 3]}
  ball: {type: spherical, bodies: [upper, lower], at: [0.6, 0.2, 0.3]}
"""
SCENES = {
    "products of inertia": PRODUCTS,
    "planar loops": windows(3),
    "planar, a guide": slider_crank("true"),
    "in space": slider_crank("false"),
    "redundant rows": DOOR,
    "chain": bending_chain(6),
}


@compiled(void(SCENE))
def filled(s):
    """S of the last evaluation into s.value, in place of its factors."""
    rows(s)


def evaluated(text):
    """Workspace after an evaluation of a scenario as drawn."""
    mechanism = assemble(loads(text))
    work, y = scene(mechanism.model), mechanism.y0.copy()
    derivative(work, 0.0, y, np.zeros_like(y))
    return work, y


def dense(work, y):
    """J M^-1 J^T (m, m) from world-axes twists."""
    J = jacobian(work, 0.0, y)[2]
    inverse = np.zeros((6 * (work.n - 1), 6 * (work.n - 1)))
    for f in range(1, work.n):
        R = work.X[f, 3:].reshape(3, 3)
        at = slice(6 * f - 6, 6 * f - 3), slice(6 * f - 3, 6 * f)
        inverse[at[0], at[0]] = work.mass_inverse[f] * np.eye(3)
        inverse[at[1], at[1]] = R @ work.inertia_inverse[f].reshape(3, 3) @ R.T
    return J @ inverse @ J.T


@pytest.mark.parametrize("name", SCENES)
def test_entries_and_factors(name):
    work, y = evaluated(SCENES[name])
    factors = work.value.copy()
    filled(work)
    found, L, D = np.zeros((work.m, work.m)), np.eye(work.m), np.zeros(work.m)
    order = work.row[work.column_start[:-1]]
    rank = np.argsort(order)
    for k, (start, end) in enumerate(zip(work.column_start, work.column_start[1:], strict=False)):
        k_rows = work.row[start:end]
        found[k_rows, k_rows[0]] = found[k_rows[0], k_rows] = work.value[start:end]
        D[k], L[rank[k_rows[1:]], k] = factors[start], factors[start + 1 : end]
    expected = dense(work, y)
    scale = np.abs(expected).max()
    assert found == pytest.approx(expected, abs=1e-13 * scale)
    assert L @ np.diag(D) @ L.T == pytest.approx(expected[np.ix_(order, order)], abs=1e-13 * scale)


def frames(n):
    """Frames of the rows of a chain of n ball joints."""
    return [(k, k + 1) for k in range(n) for _ in range(3)]


def test_a_chain_costs_in_proportion_to_its_length():
    """No fill: a joint's three rows meet each other and those of the next joint."""
    for n in (10, 100):
        made = pattern(frames(n), n + 1)
        assert len(made["row"]) == 6 * n + 9 * (n - 1)
        assert len(made["target"]) == 31 * n - 27
        assert len(made["entry"]) == 6 + 21 * (n - 1)


def test_a_chain_is_eliminated_from_both_ends():
    """Neighbours in the order do not wait for each other."""
    made = pattern(frames(6), 7)
    joints = made["row"][made["column_start"][:-1]] // 3
    assert joints[::3].tolist() == [0, 5, 1, 4, 2, 3]


@pytest.mark.parametrize("d, row, expected", [
    (6, [1.0, 2.0, 3.0, 4.0, 5.0, 6.0], 14.0 + 77.0 / 4.0),
    (6, [0.0, 0.0, 0.0, 1.0, 0.0, 0.0], 1.0 / 4.0),
    (6, [0.0, 0.0, 1.0, 0.0, 0.0, 0.0], 1.0),
    (3, [1.0, 2.0, 4.0], 5.0 + 16.0 / 4.0),
])  # fmt: skip
def test_rows_against_each_other_count_turns_at_the_size(monkeypatch, d, row, expected):
    """Of a row on a body: J J^T, a turn as far as it moves a place at the size, 2 m."""
    monkeypatch.setattr(schur, "clear", schur.clear.python)
    s = SimpleNamespace(
        B=np.array([row]), value=np.ones(1), through=np.ones(1), size=2.0, n_r=2, n=2, d=d,
        hub=np.array([-1, -1]), frame_start=np.array([0, 0, 1]), entry=np.array([0]),
    )  # fmt: skip
    schur.plain_rows.python(s)
    assert s.value[0] == pytest.approx(expected)
