"""What rows have of their own: angles between them in the metric of the inverse masses."""

from types import SimpleNamespace

import numpy as np
import pytest

from trsim.kernels.plain import run as as_python
from trsim.solve.march.own_rows import cosine

from ..runs import built

PAIR = """
planar: {}
bodies:
  one: {{mass: 4, inertia: [0.2, 0.3, 0.25], at: [0.5, 0, 0]}}
  two: {{mass: 0.5, inertia: [0.01, 0.02, 0.015], at: [1.5, 0, 0]}}
joints:
  shoulder: {{type: revolute, bodies: [ground, one], at: [0, 0, 0]}}
  elbow: {{type: revolute, bodies: [one, two], at: [1, 0, 0]}}
"""
MASSES = {
    "true": [4, 4, 0.25, 0.5, 0.5, 0.015],
    "false": [4, 4, 4, 0.2, 0.3, 0.25, 0.5, 0.5, 0.5, 0.01, 0.02, 0.015],
}


@pytest.mark.parametrize("size", [1e-6, 1.0, 1e6])
@pytest.mark.parametrize("planar", MASSES)
def test_the_cosine_is_that_of_an_angle_however_long_the_rows_are(planar, size):
    model, M = built(PAIR.format(planar)).model, np.array(MASSES[planar])
    s = SimpleNamespace(
        d=model.d, n_r=model.n_r, mass_inverse=model.mass_inverse,
        inertia_inverse=model.inertia_inverse, own=np.zeros((2, model.d * model.n_r)),
    )  # fmt: skip
    rng = np.random.default_rng(1)
    u = rng.normal(size=len(M))
    other = rng.normal(size=len(M))
    other -= u * (u @ (other / M)) / (u @ (u / M))
    other *= np.sqrt((u @ (u / M)) / (other @ (other / M)))
    for angle in (0.0, 1.0, 2.0, np.pi):
        s.own[0, s.d :] = size * u
        s.own[1, s.d :] = size * (np.cos(angle) * u + np.sin(angle) * other)
        assert as_python(cosine.python, s) == pytest.approx(np.cos(angle), abs=1e-12)
