"""A run beside a table where the abscissa turns back; all against closed forms."""

import numpy as np
import pytest

from trsim.analyse.reference import Given
from trsim.analyse.turning import Branch, branches, differences
from trsim.errors import UsageError

ALL = (-np.inf, np.inf)
t = np.linspace(0.0, 1.0, 2001)
forth = 2.0 * t
back = np.where(t < 0.5, 2.0 * t, 2.0 - 2.0 * t)  # up to 1 and down again
x = np.where(t < 0.5, back**2, back)  # another curve on the way back


def table(s, y, time=None):
    return Given("old.csv", time, np.asarray(s, float), {"F": np.asarray(y, float)}, ())


def test_branches():
    assert branches(forth) == [Branch(0, 2001, 1)]
    assert branches(-forth) == [Branch(0, 2001, -1)]
    assert branches(np.zeros(9)) == []
    [up, down] = branches(back)
    assert (up.way, down.way) == (1, -1)
    assert up.end - 1 == down.begin == 1000
    swings = branches(np.sin(2.0 * np.pi * 3.0 * t))
    assert [b.way for b in swings] == [1, -1, 1, -1, 1, -1, 1]
    trembling = forth + 9e-4 * (-1.0) ** np.arange(2001)
    assert np.any(np.diff(trembling) < 0.0)
    assert len(branches(trembling)) == 1


def test_rows_that_stand_still_belong_to_both_sides_of_a_turn():
    s = np.array([0.0, 1.0, 2.0, 2.0, 2.0, 1.0, 0.0])
    assert branches(s) == [Branch(0, 5, 1), Branch(2, 7, -1)]


def test_over_an_abscissa_that_goes_one_way():
    s = np.linspace(0.2, 1.8, 17)
    [found] = differences("a", (t, forth, forth**2), table(s, s**2 + 0.1 * s), "F", ALL)
    assert found.largest == pytest.approx(-0.18, abs=1e-6)
    assert found.at == pytest.approx(1.8)
    assert found.value == pytest.approx(3.24, abs=1e-6)
    assert (found.rows, found.asked) == (17, 17)
    assert found.how == "over all of it"
    assert found.of_range == pytest.approx(0.18 / (3.24 + 0.18 - 0.04 - 0.02), rel=1e-5)
    [part] = differences("a", (t, forth, forth**2), table(s, s**2 + 0.1 * s), "F", (0.0, 1.05))
    assert (part.at, part.rows, part.asked) == (pytest.approx(1.0), 9, 9)
    assert part.largest == pytest.approx(-0.1, abs=1e-6)
    # whichever way each of them goes
    for s_own, s_its in ((forth, s[::-1]), (forth[::-1], s), (forth[::-1], s[::-1])):
        y = s_its**2 + 0.1 * s_its
        [same] = differences("a", (t, s_own, s_own**2), table(s_its, y), "F", ALL)
        assert same.largest == pytest.approx(found.largest, abs=1e-12)
        assert same.at == found.at


def test_branch_by_branch():
    """Forth and back are two curves, 0.05 and -0.2 off: mixed up they would be 0.25 and more."""
    s = np.concatenate([np.linspace(0.0, 1.0, 21), np.linspace(0.95, 0.0, 20)])
    y = np.where(np.arange(41) < 21, s**2 - 0.05 * s, s + 0.2 * s)
    up, down = differences("a", (t, back, x), table(s, y), "F", ALL)
    assert up.how == "branch 1 of 2, rising"
    assert down.how == "branch 2 of 2, falling"
    assert up.largest == pytest.approx(0.05, abs=1e-5)
    assert down.largest == pytest.approx(-0.2 * 0.95, abs=1e-5)
    assert (up.rows, down.rows) == (21, 21)


def test_each_branch_beside_the_only_one_of_a_table():
    s = np.linspace(0.0, 1.0, 21)
    up, down = differences("a", (t, back, x), table(s, s), "F", ALL)
    assert up.largest == pytest.approx(-0.25, abs=1e-5)
    assert up.at == pytest.approx(0.5)
    assert abs(down.largest) < 1e-9
    assert "the only one of the table" in up.how


def test_along_time_where_branches_do_not_belong_together():
    s = np.concatenate([np.linspace(0, 1, 11), np.linspace(0.9, 0, 10), np.linspace(0.1, 1, 10)])
    with pytest.raises(UsageError, match=r"2 branches in the run and 3 branches in old.csv"):
        differences("a", (t, back, x), table(s, s), "F", ALL)
    time = np.linspace(0.0, 1.2, 31)
    y = np.interp(time, t, x) + 0.01
    [found] = differences("a", (t, back, x), table(s, y, time), "F", ALL)
    assert found.largest == pytest.approx(-0.01)
    assert found.how.startswith("along time")
    assert (found.rows, found.asked) == (np.count_nonzero(time <= 1.0), 31)
    other = np.concatenate([np.linspace(1, 0, 11), np.linspace(0.1, 1, 10)])
    with pytest.raises(UsageError, match="in other directions"):
        differences("a", (t, back, x), table(other, other), "F", ALL)


def test_an_upright_curve_is_an_interval():
    """A force that builds up before anything moves, and an event that repeats a time."""
    s = np.array([0.0, 0.0, 0.0, 1.0, 2.0])
    force = np.array([0.0, 4.0, 8.0, 8.0, 8.0])
    time = np.arange(5.0)
    [found] = differences("a", (time, s, force), table([0.0, 0.5, 2.0], [6.0, 8.0, 8.0]), "F", ALL)
    assert found.largest == 0.0
    [found] = differences("a", (time, s, force), table([0.0, 0.5, 2.0], [9.0, 8.0, 8.0]), "F", ALL)
    assert (found.largest, found.at) == (-1.0, 0.0)
    trembling = s + np.array([0.0, 1e-12, -1e-12, 0.0, 0.0])
    [found] = differences("a", (time, trembling, force), table([0.0, 2.0], [6.0, 8.0]), "F", ALL)
    assert found.largest == 0.0
    twice = np.array([0.0, 1.0, 1.0, 2.0])
    jumps = np.array([0.0, 1.0, 5.0, 5.0])
    rows = table([0.5, 1.0, 1.0, 1.5], [0.5, 1.0, 5.0, 5.0])
    [found] = differences("time", (twice, twice, jumps), rows, "F", ALL)
    assert found.largest == 0.0
    assert found.rows == 4


def test_rows_that_go_back_a_little_are_left_out():
    trembling = forth + 9e-4 * (-1.0) ** np.arange(2001)
    wild = np.where(np.append(0.0, np.diff(trembling)) < 0.0, 99.0, trembling)
    [found] = differences("a", (t, trembling, wild), table([0.5, 1.0], [0.5, 1.0]), "F", ALL)
    assert abs(found.largest) < 1e-12


def test_what_cannot_be_compared_is_told():
    s = np.linspace(0.0, 100.0, 11)  # degrees read as radians
    [found] = differences("a", (t, forth, forth), table(s, s), "F", ALL)
    assert (found.rows, found.asked) == (1, 11)
    with pytest.raises(UsageError, match="no stretch in common"):
        differences("a", (t, forth, forth), table(s + 5.0, s), "F", ALL)
    with pytest.raises(UsageError, match="no row in the window"):
        differences("a", (t, forth, forth), table(s, s), "F", (200.0, 300.0))
    with pytest.raises(UsageError, match="stands still in the run"):
        differences("a", (t, 0.0 * t, t), table(s, s), "F", ALL)
    lost = np.where(t == 0.5, np.nan, forth)
    [found] = differences("a", (t, lost, forth), table([0.2, 1.0, 1.6], [0, 1, 1.6]), "F", ALL)
    assert (found.largest, found.rows) == (pytest.approx(0.2), 3)
    gaps = np.where((t > 0.2) & (t < 0.6), np.nan, forth)
    [found] = differences("a", (t, forth, gaps), table([0.2, 0.8, 1.6], [0.2, 0.8, 1.5]), "F", ALL)
    assert (found.rows, found.asked) == (2, 3)
    assert found.largest == pytest.approx(0.1)
