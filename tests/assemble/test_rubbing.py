"""Friction made by reactions: what is learned of a joint that does not rub."""

from types import SimpleNamespace

import numpy as np
import pytest

from trsim.assemble import rubbing


@pytest.mark.parametrize("load, holding", [(0.0, True), (0.3, False)])
def test_what_does_not_rub_presses_nothing(monkeypatch, load, holding):
    """Whatever it did before."""
    s = SimpleNamespace(
        rubbing=np.array([[4], [2], [7]]), rubbed=np.ones(8), by_rubbing=np.full((3, 18), 7.0)
    )
    monkeypatch.setattr(rubbing, "clear", rubbing.clear.python)
    monkeypatch.setattr(rubbing, "Load", lambda s, e: SimpleNamespace(per_load=load))
    monkeypatch.setattr(rubbing, "holds", lambda s, l: holding)
    rubbing.slopes.python(s, 0.0, None, None, 1.0)
    assert not s.by_rubbing.any() and not s.rubbed.any()
