"""The parts of DOP853 that are written for speed, against the same written plainly."""

from math import comb

import numpy as np
import pytest

from trsim.elements.contract import compiled
from trsim.kernels import signatures as types
from trsim.kernels.packed import A1, A2, f8, i8
from trsim.solve.march.calls import FIELDS, INTERPOLATE_AT, SAMPLE_AT, method_row
from trsim.solve.methods import dop853


@compiled(types.void(A2, A1, f8, i8, A1))
def stage(K, y, h, s, out):
    dop853.stage(K, y, h, s, out)


@pytest.mark.parametrize("s", range(1, 16))
def test_a_stage_is_the_sum_of_those_before_it(s):
    rng = np.random.default_rng(s)
    K, y, out = rng.normal(size=(16, 7)), rng.normal(size=7), np.empty(7)
    stage(K, y, 0.3, s, out)
    terms = np.abs(dop853.A[s, :s]) @ np.abs(K[:s])
    rounding = 16 * np.finfo(float).eps * (np.abs(y) + 0.3 * terms)  # of 16 sums
    assert np.all(np.abs(out - (y + 0.3 * dop853.A[s, :s] @ K[:s])) <= rounding)


@pytest.mark.parametrize("theta", [0.0, 0.1, 0.5, 0.93, 1.0])
def test_control_points_are_those_of_the_dense_output(theta):
    rng = np.random.default_rng(1)
    P, net, inside = rng.normal(size=(7, 5)), np.zeros((9, 5)), np.empty(5)
    dop853.control(P, net)
    dop853.interpolate(P, np.zeros(5), theta, inside)
    n = dop853.DENSE_DEGREE
    basis = [comb(n, k) * theta**k * (1.0 - theta) ** (n - k) for k in range(n + 1)]
    assert inside == pytest.approx(basis @ net[: n + 1], abs=50 * np.finfo(float).eps * 7)
    assert np.all(net[n + 1 :] == 0.0)


def test_a_row_of_methods_is_made_by_name():
    row = method_row(interpolate=7, sample=3)
    assert (row.size, row[INTERPOLATE_AT], row[SAMPLE_AT], row.sum()) == (len(FIELDS), 7, 3, 10)
    with pytest.raises(TypeError, match="no field"):
        method_row(interpolated=7)
