"""A row that stands at the end of a window is in it, though 3 * 0.1 is more than 0.3."""

import numpy as np
import pytest

from trsim.analyse.fluctuation import fluctuation
from trsim.analyse.outputs import scalar
from trsim.analyse.reference import Given
from trsim.analyse.turning import differences
from trsim.analyse.window import Window, between, window
from trsim.report.curves import cut


class Rows:
    """Rows of a run with k * every for time, and a channel that falls as it rises."""

    path = "run.h5"
    time = np.arange(6) * 0.1
    reached = 0.5

    def kept(self, word):
        return None

    def unit(self, name):
        return "m"

    def channel(self, name):
        return self.time * (-1.0 if name == "down" else 1.0)


def test_rows_at_the_ends_of_a_window_in_time():
    assert Rows.time[3] > 0.3
    for text, rows in (("0..0.3", 4), ("..300 ms", 4), ("0.3..", 3), ("0..0.2999999", 3)):
        assert np.count_nonzero(window(Rows(), text).of(Rows.time)) == rows
    assert scalar(Rows(), "final:up@0..0.3")[0] == Rows.time[3]
    assert scalar(Rows(), "mean:up@0.1..0.3")[0] == pytest.approx(0.2, rel=1e-15)


@pytest.mark.parametrize(
    "text, rows", [("up=0.1..0.3", [1, 2, 3]), ("down=-0.3..-0.1", [1, 2, 3]), ("up=..0.3", [0, 3])]
)
def test_rows_at_the_ends_of_a_window_in_a_channel(text, rows):
    inside = np.flatnonzero(window(Rows(), text).of(Rows.time))
    assert [inside[0], inside[-1]] == [rows[0], rows[-1]]


def test_what_is_at_no_end_is_judged_as_it_stands():
    x = np.array([0.0, 0.3 - 1e-9, 0.3, 0.3 + 1e-12, np.nan, 1.0])
    assert between(x, (0.3, 1.0)).tolist() == [False, False, True, True, False, True]
    assert between(x, (-np.inf, 0.3)).tolist() == [True, True, True, False, False, False]
    assert not between(x[:0], (0.0, 1.0)).size
    assert Window(0.0, 0.3).has(3 * 0.1) and not Window(0.0, 0.3).has(0.3001)


def test_plots_and_tables_and_fluctuations_take_the_row_too():
    t, x = Rows.time, np.array([0.0, 0.0, 0.0, 1.0, 0.0, 0.0])
    assert np.count_nonzero(~np.isnan(cut(t, x, (0.0, 0.3), (1.0, 1.0))[0])) == 4
    table = Given("table", t, t, {"y": x}, ())
    (off,) = differences("time", (t, t, x), table, "y", (0.0, 0.3))
    assert off.rows == 4
    assert fluctuation(t, x, 0.0, 0.3, 0.4) > 2.0 * fluctuation(t, x, 0.0, 0.2, 0.4)
