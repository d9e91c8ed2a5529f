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


def pressed(n, width, slope):
    """Frictions 0..n-1 in rows 0..n-1, each pressed by `slope` times its own force."""
    by = np.zeros((n, 6 * n))
    for k in range(n):
        by[k, 6 * k] = slope[k]
    return SimpleNamespace(
        rubbing=np.array([[k] + [0] * (width - 1) for k in range(n)]), load=None,
        unpressed=np.ones((n, 6)), pressed=np.zeros((n, 6)), by_rubbing=by,
        rub_room=np.zeros((rubbing.MATRIX + n, max(n, 1))),
    )  # fmt: skip


@pytest.mark.parametrize("n", [1, 2, 5])
def test_reactions_are_those_without_friction_and_what_it_adds(monkeypatch, n):
    monkeypatch.setattr(rubbing, "call_all", lambda s, load, t: None)
    s = pressed(n, 4, 0.5 * np.arange(1, n + 1))
    s.rub_room[rubbing.FORCE] = forces = 1.0 + np.arange(n)
    rubbing.press.python(s, 0.0)
    expected = np.ones((n, 6))
    expected[:, 0] += 0.5 * np.arange(1, n + 1) * forces
    assert s.pressed == pytest.approx(expected)


@pytest.mark.parametrize("slope", [(0.5, 0.5), (2.0, 0.5), (0.5, 2.0), (2.0,), (0.5,)])
def test_friction_that_presses_itself_by_as_much_may_lock(monkeypatch, slope):
    """f = slope f + c has one solution, and 1 - slope is above zero, where the slope is below 1."""
    monkeypatch.setattr(rubbing, "call_one", lambda s, load, t, e: None)
    n = len(slope)
    s = pressed(n, 4, slope)
    monkeypatch.setattr(
        rubbing, "Load", lambda s, e: SimpleNamespace(per_load=1.0, normal=s.pressed[e, 0])
    )
    culprit = rubbing.proved.python(s, 0.0)
    assert culprit == next((1 + k for k in range(n) if slope[k] >= 1.0), 0)
