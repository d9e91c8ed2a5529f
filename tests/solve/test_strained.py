"""Bars whose elements have no length left, or twice as much as they had."""

from types import SimpleNamespace

import numpy as np
import pytest

from trsim.solve.diagnose import strained


@pytest.mark.parametrize(
    "value, does",
    [(0.5, ""), (1.9, ""), (1e-9, "squeezed to 1e-07 %"), (3.0, "stretched to 300 %")],
)
def test_what_a_bar_is_driven_to_is_said(monkeypatch, value, does):
    monkeypatch.setattr(strained, "stretches", lambda *_: [strained.Stretch("rope", 4, value)])
    scenario = SimpleNamespace(entry=lambda *path: ".".join(path))
    told = strained.collapsed(scenario, None, 0.2, np.zeros(3))
    assert told.startswith(f"bodies.rope: element 4 is {does} of its length" if does else "")
    assert bool(told) == bool(does)
    assert strained.collapsed(scenario, None, 0.2, np.array([np.nan])) == ""
