"""What is said of accelerations that a tolerance is too coarse for."""

from types import SimpleNamespace

import numpy as np
import pytest

from trsim.solve.diagnose import faint


@pytest.mark.parametrize(
    "mobility, says, never",
    [(1, "vibrates at about 8e+03 Hz", "driven"), (0, "what is driven changes", "vibrat")],
)
def test_where_nothing_is_free_nothing_vibrates(mobility, says, never, monkeypatch):
    for name in ("furthest", "unknown"):
        monkeypatch.setattr(faint, name, SimpleNamespace(python=lambda *_: 0.0))
    record = SimpleNamespace(
        blurred=1.0, blurred_sum=1.0, blurred_w=5e4, top_acceleration=10.0, y=np.zeros(1)
    )
    outcome = SimpleNamespace(record=record, start=SimpleNamespace(speed=1.0), statistics={})
    model = SimpleNamespace(size=1.0)
    mechanism = SimpleNamespace(model=model, mobility=mobility, instances=[])
    scenario = SimpleNamespace(solver=SimpleNamespace(tolerance=1e-9))
    (said,) = faint.of_vibrations(scenario, mechanism, outcome)
    assert says in said and never not in said
