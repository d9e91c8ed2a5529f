"""The parts of DOP853 that are written for speed, against the same written plainly."""

from math import comb, exp

import numpy as np
import pytest
from scipy.integrate._ivp import dop853_coefficients as published

from trsim.assemble.equations import derivative
from trsim.elements.contract import SCENE, compiled
from trsim.elements.scene import scene
from trsim.kernels import signatures as types
from trsim.kernels.packed import A1, A2, f8, i8
from trsim.solve.march import record as rec
from trsim.solve.march.accelerations import share
from trsim.solve.march.calls import FIELDS, INTERPOLATE_AT, SAMPLE_AT, method_row
from trsim.solve.march.norm import weights
from trsim.solve.march.record import SETTINGS
from trsim.solve.methods import dop853, dop853_tableau
from trsim.solve.outcome import settings

from ..runs import run

# along x a vibration of w, at the slow end of its period; along y a decay of RATE that carries v
APART = """
gravity: [0, 0]
bodies: {{block: {{mass: 1, inertia: 1, velocity: [1, {v}]}}}}
forces:
  slow: {{type: bushing, bodies: [ground, block], at: [0, 0], stiffness: [{k}, 0, 0],
         damping: [0, {rate}, 0]}}
solver: {{end: 1, method: dop853, tolerance: 1e-6}}
"""
RATE, SLOW = 1000.0, 300.0


@compiled(types.void(A2, A1, f8, i8, A1))
def stage(K, y, h, s, out):
    dop853.stage(K, y, h, s, out)


@compiled(types.void(SCENE, rec.RECORD, rec.BUFFERS, SETTINGS, f8))
def weigh(s, r, b, setting, h):
    weights(s, r, b, setting, h)


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


@pytest.mark.parametrize("v", [1e-3, 1e-2])
@pytest.mark.parametrize("z", [5.0, 5.3, 5.5, 5.65, 5.8])
def test_the_error_at_the_limit_of_stability_is_not_hidden_by_a_slower_motion(z, v):
    """A decay that carries little, in a step of z = RATE h beside a vibration that carries much.

    The estimates of both orders see different motions there; each shrinks the other, and of the
    true error of the decay's acceleration one part in a hundred was left.
    """
    ended = run(APART.format(v=v, k=SLOW**2, rate=RATE))
    s, r = scene(ended.mechanism.model), ended.outcome.record
    setting, h = settings(ended.scenario, ended.mechanism), z / RATE
    b = rec.fresh_buffers(s, r.y.size, dop853.STAGES, dop853.DENSE_ROWS)
    r.y[:] = ended.outcome.start.y
    r.t, r.top_acceleration = 0.0, SLOW
    r.vibration, r.decay = SLOW**2, RATE
    derivative(s, 0.0, r.y, r.yd)
    weigh(s, r, b, setting, h)
    b.K[0] = r.yd
    estimate = dop853.step(s, r, b, setting, 0.0, h)
    missed = RATE * abs(b.y1[s.n_q + 1] - v * exp(-z))
    allowed = setting.tolerance * SLOW * share.python(s, setting, h, dop853.STEADY)
    assert missed > 10.0 * allowed  # so it must be refused
    assert estimate > 0.2 * missed / allowed


def test_the_coefficients_are_those_published():
    """As scipy has them, and the sums that any method of order 8 has."""
    for ours, theirs in (
        (dop853_tableau.A, published.A), (dop853_tableau.C, published.C),
        (dop853_tableau.E3, published.E3), (dop853_tableau.E5, published.E5),
        (dop853_tableau.D, published.D),
    ):  # fmt: skip
        np.testing.assert_allclose(ours, theirs, rtol=4e-16, atol=1e-15)
    A, C = dop853_tableau.A, dop853_tableau.C
    np.testing.assert_allclose(A.sum(axis=1), C, atol=1e-13)
    for k in range(8):
        assert A[12, :12] @ C[:12] ** k == pytest.approx(1 / (k + 1), abs=1e-14)
