"""A run from Python has one thread of linear algebra, and leaves the number as it was."""

import numpy as np  # noqa: F401 - its BLAS is what is asked
import pytest
from threadpoolctl import threadpool_info, threadpool_limits

import trsim
from trsim.api.threads import ASKED, one_thread

PENDULUM = {
    "bodies": {"bob": {"mass": 1, "inertia": 0.01, "at": [1, 0]}},
    "joints": {"O": {"type": "revolute", "bodies": ["ground", "bob"], "at": [0, 0]}},
    "gravity": [0, -9.81, 0],
    "solver": {"end": 0.01},
}


def threads():
    """Of each BLAS."""
    return [one["num_threads"] for one in threadpool_info() if one["user_api"] == "blas"]


@pytest.fixture
def three(monkeypatch):
    """A program whose BLAS has three."""
    monkeypatch.delenv(ASKED, raising=False)
    with threadpool_limits(3, user_api="blas"):
        if set(threads()) != {3}:
            pytest.skip("this BLAS has no number of threads to set")
        yield


def test_one_within_as_many_as_before_afterwards(three):
    with one_thread():
        assert set(threads()) == {1}
    assert set(threads()) == {3}


@pytest.mark.parametrize("asked, does", [(trsim.run, "run.made"), (trsim.check, "check.checked")])
def test_what_is_asked_for_from_python_has_one(three, monkeypatch, asked, does):
    seen = []

    def noted(*_):
        seen.extend(threads())
        raise trsim.UsageError("seen")

    monkeypatch.setattr(f"trsim.api.{does}", noted)
    with pytest.raises(trsim.UsageError, match="seen"):
        asked(PENDULUM)
    assert set(seen) == {1} and set(threads()) == {3}
