"""A run that is asked much reads nothing twice in a row, and tells the same."""

import numpy as np
import pytest

from tests import small
from trsim.store import read
from trsim.store.once import LAST, Once


@pytest.fixture(scope="module")
def path(tmp_path_factory):
    path = tmp_path_factory.mktemp("once") / "run.h5"
    small.copy(path)
    return path


@pytest.fixture
def opens(monkeypatch):
    """The files that are opened."""
    found, original = [], read._file
    monkeypatch.setattr(read, "_file", lambda path: found.append(path) or original(path))
    return found


def test_it_tells_the_same(path):
    run = read.read(path)
    once = Once.of(run)
    assert once.peaks == run.peaks
    for name in ("time", "stroke", "B.force", "B.force.x", "|B.force|"):
        np.testing.assert_array_equal(once.channel(name), run.channel(name))
    assert once.steps("B").keys() == run.steps("B").keys()
    for name, column in run.steps("B").items():
        np.testing.assert_array_equal(once.steps("B")[name], column)


def test_nothing_is_read_twice_in_a_row(path, opens):
    once = Once.of(read.read(path))
    opens.clear()
    for _ in range(3):
        assert len(once.time) and len(once.peaks) and len(once.steps("B")["time"])
        once.channel("B.force.x"), once.channel("B.force.y"), once.channel("|B.force|")
    assert len(opens) == 4


def test_only_the_last_channels_are_kept(path, opens):
    once = Once.of(read.read(path))
    opens.clear()
    names = once.names[: LAST + 1]
    for name in (*names, *names):
        once.channel(name)
    assert len(opens) == 2 * len(names)


def test_other_readers_stay_as_they_are(path):
    once = Once.of(read.read(path))
    assert Once.of(once) is once
