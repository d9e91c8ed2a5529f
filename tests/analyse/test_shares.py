"""Shares of flight, impact and following from located events."""

import numpy as np
import pytest
import yaml

import trsim
from tests import small
from tests.mechanisms import sealed_door
from trsim.analyse.shares import intervals, maxima, shares, single
from trsim.analyse.window import Window, window
from trsim.errors import UsageError
from trsim.store.read import read

# closes at 1, opens at 2, closes at 4, opens at 4.5, closes at 7
TIMES, CLOSES = np.array([1.0, 2.0, 4.0, 4.5, 7.0]), np.array([True, False, True, False, True])


def test_intervals_reach_over_the_ends_of_a_window():
    begins, ends = intervals(TIMES, CLOSES, Window(1.5, 8.0))
    np.testing.assert_array_equal(begins, [1.0, 4.0, 7.0])
    np.testing.assert_array_equal(ends, [2.0, 4.5, np.inf])
    begins, ends = intervals(TIMES[1:], CLOSES[1:], Window(0.0, 4.2))
    np.testing.assert_array_equal(begins, [-np.inf, 4.0])
    assert intervals(TIMES, CLOSES, Window(5.0, 6.0))[0].size == 0
    assert intervals(np.zeros(0), np.zeros(0, bool), Window(0.0, 1.0))[0].size == 0


def test_maxima_of_a_penetration():
    s = np.linspace(0.0, np.pi, 2000)
    assert maxima(np.sin(s)) == 1
    assert maxima(np.sin(s) + 0.3 * np.sin(7 * s)) > 1
    assert maxima(np.sin(s) + 0.004 * (-1.0) ** np.arange(2000)) == 1  # ripple
    assert maxima(np.zeros(0)) == 0


def test_a_contact_that_goes_on_is_no_impact():
    time = np.linspace(0.0, 10.0, 1001)
    depth = np.abs(np.sin(np.pi * time))
    begins, ends = np.array([0.0, 2.0, 7.0]), np.array([1.0, 4.0, np.inf])
    assert single(time, depth, begins, ends).tolist() == [True, False, False]


@pytest.fixture(scope="module")
def run(tmp_path_factory):
    path = tmp_path_factory.mktemp("shares") / "run.h5"
    small.run(path, "solver.end=24 ms", "output.every=0.1 ms")
    return read(path)


def by_hand(run, begin, end):
    """Time in contact, from the events one by one."""
    events = run.events
    mine = events.element == "B"
    total, since = 0.0, None
    for time, kind in zip(events.time[mine], events.kind[mine], strict=True):
        if kind == "onset":
            since = time
        elif since is not None:
            total += max(0.0, min(time, end) - max(since, begin))
            since = None
    return total + (max(0.0, end - max(since, begin)) if since is not None else 0.0)


def test_shares_of_a_run(run):
    events = run.events
    onset, separation = (events.time[events.kind == kind] for kind in ("onset", "separation"))
    inside = [0.5 * (a + separation[separation > a][0]) for a in onset[[2, 5]]]  # of two contacts
    for within in (window(run), Window(5e-3, 9e-3), Window(*inside)):
        found = shares(run, "B", within)
        length = within.end - within.begin
        assert found.contact == pytest.approx(by_hand(run, *within) / length, abs=1e-12)
        assert found.flight + found.impact + found.following == pytest.approx(1.0)
        assert min(found.flight, found.impact, found.following) >= 0.0


def test_impacts_of_a_run(run):
    found = shares(run, "B", window(run))
    onsets = run.events.time[(run.events.element == "B") & (run.events.kind == "onset")]
    assert found.onsets == len(onsets) > 5
    assert 0 < found.impacts <= found.onsets
    assert found.mean_between == pytest.approx(np.mean(np.diff(onsets)))
    assert found.median_between == pytest.approx(np.median(np.diff(onsets)))


def test_a_joint_without_contact_is_refused(run):
    with pytest.raises(UsageError, match="no contact 'A'"):
        shares(run, "A", window(run))


@pytest.mark.filterwarnings("ignore")  # a seal that is pressed beyond its height
def test_a_seal_is_as_deep_as_its_compression():
    text, pressed = sealed_door()
    run = trsim.run(yaml.safe_load(text))
    assert run.number("contact:edge") == pytest.approx(pressed / 0.8, rel=1e-5)
    assert run.number("impacts:edge") == 1.0
