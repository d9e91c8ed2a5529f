"""Windows of a run: in time, and where a channel passes from one value to another."""

import numpy as np
import pytest

from tests import small
from trsim.analyse.window import Window, parted, scalar_channel, window
from trsim.errors import UsageError
from trsim.store.read import read


@pytest.fixture(scope="module")
def run(tmp_path_factory):
    path = tmp_path_factory.mktemp("window") / "run.h5"
    small.run(path)
    return read(path)


def test_window_in_time(run):
    assert window(run) == Window(0.0, run.time[-1])
    assert window(run, "1e-3..2 ms") == Window(1e-3, 2e-3)
    assert window(run, "..2ms") == Window(0.0, 2e-3)
    assert window(run, "0.002..").end == run.time[-1]
    assert parted("std:stroke@1..2") == ("std:stroke", "1..2")


def test_window_of_a_channel_has_the_times_at_which_it_passes(run):
    """The crank turns at 5000 rpm, so its angle tells the time."""
    rate = 5000.0 * 2.0 * np.pi / 60.0
    for text, begin, end in (("0.2..0.5", 0.2, 0.5), ("10 deg..45 deg", 10 / 57.29578, np.pi / 4)):
        found = window(run, f"crank_angle={text}")
        assert found.begin == pytest.approx(begin / rate, rel=1e-6)
        assert found.end == pytest.approx(end / rate, rel=1e-6)
    assert window(run, "crank_angle=0.3..").end == run.time[-1]


def test_falling_channel(tmp_path):
    small.run(tmp_path / "run.h5", "drives.motor.velocity=-5000 rpm")
    found = window(read(tmp_path / "run.h5"), "crank_angle=-0.5..-0.2")
    rate = 5000.0 * 2.0 * np.pi / 60.0
    assert found.begin == pytest.approx(0.2 / rate, rel=1e-6)
    assert found.end == pytest.approx(0.5 / rate, rel=1e-6)


@pytest.mark.parametrize(
    "text, what",
    [
        ("0.1", "no window"),
        ("=1..2", "no window"),
        ("a..b", "is no number"),
        ("1 mm..2 mm", "is not in s"),
        ("crank_angle=1 s..2 s", "is not in rad"),
        ("1e9..", "no row lies in"),
        ("2e-3..1e-3", "no row lies in"),
        ("strok=1..2", "no channel named"),
        ("B.force=1..2", "components"),
        ("crank_angle=500..600", "no row lies in"),
        ("B.eccentricity_x_rate=-1e9..0", "between these values"),
    ],
)
def test_windows_that_make_no_sense(text, what, run):
    with pytest.raises(UsageError, match=what):
        window(run, text)


def test_component_of_a_channel(run):
    x = scalar_channel(run, "B.force.x")
    np.testing.assert_array_equal(x, run.channel("B.force")[:, 0])
