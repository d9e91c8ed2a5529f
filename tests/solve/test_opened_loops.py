"""Runs that begin with closed loops and go on without: there are no rows for passes.py to keep."""

import numpy as np
import pytest

from trsim.elements.scene import Scene
from trsim.kernels.packed import WORDS, Packed

from ..overconstrained import cranks, text
from ..runs import run
from ..truth.judge import ran
from ..truth.trial import made

AROUND = 400
RELEASED = """
gravity: [2, -5, 0]
events: {apart: {when: t, value: 0.2, do: {release: [T1]}}}
"""


@pytest.fixture
def guards(monkeypatch):
    """What lies about the rows kept of scenes without loops: nobody may write there."""
    made, make = [], Packed._make

    def guarded(self, room, words):
        make(self, room, words)
        if isinstance(self, Scene) and room.get("root", (1,))[0] == 0:
            made.append(np.arange(2.0 * AROUND))
            words[WORDS * self.places["root"]] = made[-1][AROUND:].ctypes.data

    monkeypatch.setattr(Packed, "_make", guarded)
    return made


@pytest.mark.parametrize("method", ["dop853", "radau", "generalized_alpha"])
def test_a_loop_that_an_event_opens(guards, method):
    parts = cranks([1.0, 1.1], [0.0, 0.7], 0.9)
    r = run(text(parts, RELEASED), f"solver.method={method}", fails=False)
    assert r.outcome.time == 1.0
    assert guards
    assert all(np.all(np.diff(one) == 1.0) for one in guards)


@pytest.mark.parametrize("seed", [3944500610])
def test_a_loop_that_other_rows_open(guards, seed):
    """Two joints weld the same bodies to each other: first rows of both are kept, then of one."""
    r = ran(made("redundant", seed).scene.text())
    assert r.exit == 0
    assert guards
    assert all(np.all(np.diff(one) == 1.0) for one in guards)
