"""Lines of the record."""

from types import SimpleNamespace

import numpy as np
import pytest

from trsim.solve.march import record as rec
from trsim.solve.march.features import tell

from ..pieces import piece


def test_an_event_is_noted_behind_those_before_it():
    r, b = SimpleNamespace(event_rows=1), SimpleNamespace(events=np.full((3, rec.N_EVENT), 7.0))
    piece(rec.note_event)(r, b, 0.25, rec.USER, 4, -3.0)
    assert r.event_rows == 2
    line = b.events[1]
    assert line[[rec.EVENT_TIME, rec.EVENT_KIND, rec.EVENT_ROW]] == pytest.approx(
        [0.25, rec.USER, 4]
    )
    assert line[[rec.EVENT_SPEED, rec.EVENT_WORK, rec.EVENT_IMPULSE]] == pytest.approx([-3, 0, 0])
    assert np.isnan(line[rec.EVENT_ANGLE])  # a mean that takes it for a number is none
    assert np.all(b.events[[0, 2]] == 7.0)


@pytest.mark.parametrize("before", [0, 2, rec.JOLTS_KEPT])
def test_jolts_are_counted_beyond_those_that_are_kept(before):
    """Three at one instant: their work goes into each line, the first ones are kept for the end."""
    r = SimpleNamespace(event_rows=4, n_jolts=before, jolt=np.zeros((rec.JOLTS_KEPT, 5)))
    b = SimpleNamespace(events=np.zeros((5, rec.N_EVENT)))
    b.events[1:4, rec.EVENT_ROW] = 5, 6, 7
    piece(tell)(r, b, 1, -0.5)
    assert r.n_jolts == before + 3
    assert b.events[:, rec.EVENT_WORK] == pytest.approx([0.0, -0.5, -0.5, -0.5, 0.0])
    kept = r.jolt[before : before + 3]
    assert kept[:, 1] == pytest.approx([5, 6, 7][: len(kept)])
