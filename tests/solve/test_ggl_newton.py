"""Newton systems of Radau's method with sparse rows: what they are made of."""

import numpy as np
import pytest

from trsim.solve.methods.ggl_newton import some

from ..pieces import piece


@pytest.mark.parametrize("shape", [(0, 6), (5,), (3, 6)])
def test_whether_a_table_has_an_entry(shape):
    """Damping, and rows that turn, are looked for once: of none the systems are simpler."""
    table = np.zeros(shape)
    assert not piece(some)(table)
    if table.size:
        table.flat[-1] = -1e-30
        assert piece(some)(table)
