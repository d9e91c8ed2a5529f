"""On which side of a singular position a mechanism is: the sign of det J, by LU factors."""

from types import SimpleNamespace

import numpy as np
import pytest

from trsim.assemble.equations import constraints, poses
from trsim.assemble.reduce import jacobian
from trsim.assemble.schur import rows
from trsim.elements.scene import workspace
from trsim.kernels.plain import run as as_python
from trsim.solve.march.sides import side

from ..runs import built

ARM = """
planar: true
bodies:
  upper: {mass: 1, inertia: 0.1, at: [0.5, 0]}
  lower: {mass: 1, inertia: 0.1, at: [1.5, 0]}
joints:
  shoulder: {type: revolute, bodies: [ground, upper], at: [0, 0]}
  elbow: {type: revolute, bodies: [upper, lower], at: [1, 0]}
  slot: {type: inline, bodies: [ground, lower], at: [2, 0], axis: [1, 0, 0]}
drives: {turn: {joint: shoulder, position: t}}
"""


@pytest.mark.parametrize("before", [1e3, -1e3])
@pytest.mark.parametrize("bent", [1, -1])
def test_the_sign_is_that_of_the_determinant(bent, before):
    """Whichever way the elbow bends, and whatever was in the room before."""
    mechanism = built(ARM)
    model, n = mechanism.model, mechanism.model.n_v
    # the triangle of both links: the elbow above or below the slot
    turn = bent * 0.4
    y = mechanism.y0.copy()
    y[: model.n_q] = [
        0.5 * np.cos(turn), 0.5 * np.sin(turn), turn,
        1.5 * np.cos(turn), 0.5 * np.sin(turn), -turn,
    ]  # fmt: skip
    s = workspace(model)
    poses(s, y)
    constraints(s, 0.0)
    as_python(rows.python, s)
    left = before * np.random.default_rng(0).normal(size=(n, n))
    b = SimpleNamespace(square=left, swaps=np.zeros(n, np.int64))
    J = jacobian(model, 0.0, y)[2]
    J = J[:, np.abs(J).max(axis=0) > 0.0]
    assert J.shape == (n, n)
    assert as_python(side.python, s, b) == np.sign(np.linalg.det(J))
