"""What rows allow of rates of bodies, against dense matrices."""

import numpy as np
import pytest

from benchmarks.problems import windows
from trsim.assemble.equations import derivative
from trsim.assemble.projection import onto_rows
from trsim.elements.contract import SCENE, compiled
from trsim.elements.scene import scene
from trsim.kernels.signatures import A1, void
from trsim.scenario.load import loads

from ..linkages import slider_crank
from ..runs import assemble

SCENES = {
    "planar": windows(3),
    "in space": slider_crank("false"),
}


@compiled(void(SCENE, A1))
def allowed(s, w):
    """w <- what the rows allow of it."""
    onto_rows(s, w)


def dense(work):
    """J (m, n_v) and M^-1 (n_v, n_v) of rigid bodies, in the axes of the solve."""
    J, inverse = np.zeros((work.m, work.n_v)), np.zeros((work.n_v, work.n_v))
    for f in range(1, work.n):
        at = slice(work.d * (f - 1), work.d * f)
        for p in range(work.frame_start[f], work.frame_start[f + 1]):
            J[work.slot_row[p], at] = work.B[p, : work.d]
        of_turns = work.inertia_inverse[f].reshape(3, 3)[-(work.d // 2) :, -(work.d // 2) :]
        moving = work.mass_inverse[f] * np.eye(work.d - len(of_turns))
        inverse[at, at] = np.block([
            [moving, np.zeros((len(moving), len(of_turns)))],
            [np.zeros((len(of_turns), len(moving))), of_turns],
        ])  # fmt: skip
    return J, inverse


@pytest.mark.parametrize("name", SCENES)
def test_rates_are_brought_to_the_rows(name):
    """The nearest ones with J w = 0, in the metric of M."""
    mechanism = assemble(loads(SCENES[name]))
    work, y = scene(mechanism.model), mechanism.y0.copy()
    derivative(work, 0.0, y, np.zeros_like(y))
    J, inverse = dense(work)
    S = J @ inverse @ J.T
    before = np.random.default_rng(3).normal(size=work.n_v)
    after = before.copy()
    allowed(work, after)
    expected = before - inverse @ J.T @ np.linalg.solve(S, J @ before)
    rounding = 1e-14 * np.linalg.cond(S)
    assert after == pytest.approx(expected, abs=rounding * np.abs(expected).max())
    assert np.abs(J @ after).max() < rounding * np.abs(J @ before).max()
