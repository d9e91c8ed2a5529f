"""Whether rows ask for different things: what is left of each of them counts."""

from types import SimpleNamespace

import numpy as np
import pytest

from trsim.assemble import linear


@pytest.mark.parametrize("order", [[3, 0, 1, 2], [0, 3, 1, 2], [0, 1, 2, 3]])
@pytest.mark.parametrize("left", [0.0, 0.5])
def test_rows_behind_a_hub_are_looked_at_too(monkeypatch, order, left):
    """Three rows and the motion of a hub (3), in some order of elimination; row 2 is left unmet."""
    monkeypatch.setattr(linear, "copy_to", lambda to, it: to.__setitem__(slice(None), it))
    monkeypatch.setattr(linear, "residual", lambda s, x, r: r.__setitem__(slice(None), unmet))
    unmet = np.array([0.0, 0.0, left, 0.0])
    s = SimpleNamespace(
        status=np.array([linear.SINGULAR]), first=np.ones(4), row=np.array(order), m=3,
        column_start=np.arange(5), r=np.array([1.0, 1.0, 1.0, 0.0]), r2=np.zeros(4),
    )  # fmt: skip
    assert linear.contradictory.python(s, np.zeros(4)) == (left > 0.0)
