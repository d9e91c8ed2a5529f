"""A step whose end was moved along its tangent has the dense output of the end as it was."""

import numpy as np
import pytest

from trsim.assemble.equations import derivative
from trsim.elements.contract import SCENE, compiled
from trsim.elements.scene import scene
from trsim.kernels.packed import I1, f8
from trsim.kernels.signatures import void
from trsim.solve.march import record as rec
from trsim.solve.march.calls import method_row
from trsim.solve.march.dense_output import build, move_end
from trsim.solve.methods import dop853
from trsim.solve.outcome import settings

from ..mechanisms import torsion_pendulum
from ..runs import run


@compiled(void(SCENE, rec.RECORD, rec.BUFFERS, I1))
def built(s, r, b, method):
    """The dense output of the step at hand."""
    build(s, r, b, method)


@compiled(void(SCENE, rec.RECORD, rec.BUFFERS, f8))
def moved(s, r, b, late):
    """Its end moved back by a time."""
    move_end(b, dop853.LAST, late)


@pytest.mark.parametrize("late", [1e-4, -1e-4])
def test_dense_output_is_that_of_the_end_as_it_was(late):
    text, _ = torsion_pendulum(solver="end: 0.01, tolerance: 1e-8, method: dop853")
    ended = run(text)
    r, s = ended.outcome.record, scene(ended.mechanism.model)
    setting, t, h = settings(ended.scenario, ended.mechanism), r.t, 0.02
    b = rec.fresh_buffers(s, r.y.size, dop853.STAGES, dop853.DENSE_ROWS)
    method = method_row(dense=dop853.dense.address(), last=dop853.LAST)
    b.weight[:] = 1.0
    b.t, b.h = t, h
    derivative(s, t, r.y, b.K[0])
    dop853.step(s, r, b, setting, t, h)
    derivative(s, t + h, b.y1, b.K[dop853.LAST])
    end, rate = b.y1.copy(), b.K[dop853.LAST].copy()
    built(s, r, b, method)
    before = b.P.copy()
    assert np.abs(before).max() > 0.0

    moved(s, r, b, late)
    np.testing.assert_array_equal(b.y1, end - late * rate)
    derivative(s, t + h - late, b.y1, b.K[dop853.LAST])
    there = b.K[dop853.LAST].copy()
    assert not np.array_equal(there, rate)
    built(s, r, b, method)
    np.testing.assert_array_equal(b.P, before)
    np.testing.assert_array_equal(b.K[dop853.LAST], there)
