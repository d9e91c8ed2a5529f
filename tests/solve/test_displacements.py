"""Displacements of implicit methods stand where the coordinates they move do."""

import numpy as np
import pytest

from trsim.assemble.equations import derivative
from trsim.elements.scene import scene
from trsim.kernels.plain import run as as_python
from trsim.solve.methods.displacements import displace, place_of

from ..runs import built

TEXT = """
planar: {planar}
bodies:
  one: {{mass: 2, inertia: [0.02, 0.03, 0.04], at: [0.1, -0.2, 0]}}
  bar: {{type: ancf_cable, start: [0, 0], end: [1, 0], elements: 2, section: {{diameter: 20 mm}},
        youngs_modulus: 10 MPa, density: 1000 kg/m^3}}
  two: {{mass: 3, inertia: [0.05, 0.04, 0.03], at: [0.5, 0.2, 0]}}
"""


@pytest.mark.parametrize("planar", ["true", "false"])
def test_a_displacement_moves_what_its_velocity_moves(planar):
    """Its weight is that of the coordinate that moves with it; of a turn, one of its attitude."""
    mechanism = built(TEXT.format(planar=planar))
    s, places = scene(mechanism.model), []
    for k in range(s.n_v):
        y, yd = mechanism.y0.copy(), np.zeros(len(mechanism.y0))
        y[s.n_q : s.n_q + s.n_v] = 0.0
        y[s.n_q + k] = 1.0
        derivative(s, 0.0, y, yd)
        moved = y.copy()
        as_python(displace.python, s, moved, k, 1e-3)
        assert moved[: s.n_q] - y[: s.n_q] == pytest.approx(1e-3 * yd[: s.n_q], abs=1e-15)
        places.append(as_python(place_of.python, s, k))
        if s.d == 3 or k >= s.v_node or k % 6 < 3:
            assert np.flatnonzero(yd[: s.n_q]).tolist() == [places[-1]]
        else:
            assert set(np.flatnonzero(yd[: s.n_q])) < set(range(7 * (k // 6) + 3, 7 * (k // 6) + 7))
            assert places[-1] == 7 * (k // 6) + k % 6
    assert len(set(places)) == s.n_v
