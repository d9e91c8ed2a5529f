"""Differences of runs."""

import numpy as np
import pytest

from tests import small
from trsim.analyse.compare import (
    Curve,
    alike,
    channels,
    curve,
    difference,
    parting,
)
from trsim.errors import UsageError
from trsim.store.read import read

s = np.linspace(0.0, 1.0, 101)


def test_difference_of_two_curves():
    other = np.linspace(-0.5, 0.8, 400)
    found = difference("x", "m", Curve(s, s**2), Curve(other, other**2 + 0.1 * other))
    assert found.largest == pytest.approx(0.08, abs=1e-4)
    assert found.at == pytest.approx(0.8)
    assert found.of_range == pytest.approx(0.08 / 0.64, abs=1e-3)
    assert found.rms == pytest.approx(0.08 / np.sqrt(3.0), rel=0.01)
    assert np.isnan(found.apart)


def test_only_what_comes_before_is_compared_value_by_value():
    x = np.sin(20.0 * s)
    found = difference("x", "m", Curve(s, x), Curve(s, np.where(s < 0.5, x + 0.001, -x)), 0.5)
    assert found.largest == pytest.approx(0.001)
    assert found.apart == pytest.approx(0.5)
    late = x[s >= 0.5]
    assert found.levels == (pytest.approx(np.sqrt(np.mean(late**2))),) * 2
    assert found.means[0] == pytest.approx(-found.means[1])


def test_curves_without_a_common_stretch_are_refused():
    with pytest.raises(UsageError, match="no stretch in common"):
        difference("x", "m", Curve(s, s), Curve(s + 5.0, s))


@pytest.fixture(scope="module")
def runs(tmp_path_factory):
    folder = tmp_path_factory.mktemp("compare")
    sets = {
        "a": [],
        "b": ["joints.B.clearance=0.5000005 mm"],
        "c": ["joints.B.clearance=0.1 mm"],
        "d": ["solver.tolerance=1e-9"],
    }
    for name, values in sets.items():
        small.run(folder / f"{name}.h5", "solver.end=60 ms", "output.every=0.05 ms", *values)
    return {name: read(folder / f"{name}.h5") for name in sets}


def test_curve_over_another_channel(runs):
    found = curve(runs["a"], "stroke", "crank_angle")
    np.testing.assert_array_equal(found.s, runs["a"].channel("crank_angle"))
    with pytest.raises(UsageError, match="turns back"):
        curve(runs["a"], "crank_angle", "stroke")


def test_usual_channels(runs):
    found = channels([runs["a"], runs["c"]])
    sensors = {"stroke", "stroke.rate", "crank_angle", "crank_angle.rate"}
    assert set(found) == sensors | {"motor.force", "B.contact_force", "B.normal_force"}


def test_chance_parts_runs_of_one_scenario_alone(runs):
    """At 5000 rpm the motion is chaotic: runs of nearly one clearance part after some turns."""
    assert alike(runs["a"].scenario, runs["b"].scenario)
    assert alike(runs["a"].scenario, runs["d"].scenario)
    assert not alike(runs["a"].scenario, runs["c"].scenario)
    at = parting(runs["a"], runs["b"])
    assert 1e-3 < at < 0.06
    turns = parting(runs["a"], runs["b"], "crank_angle")
    assert turns == pytest.approx(5000 * 2 * np.pi / 60 * at, rel=1e-9)
    assert np.isnan(parting(runs["a"], runs["c"]))
    assert np.isnan(parting(runs["a"], runs["a"]))


@pytest.mark.parametrize(
    "one, two, same",
    [
        ({"a": "0.3 mm"}, {"a": "300.0001 um"}, True),
        ({"a": "0.3 mm"}, {"a": "0.31 mm"}, False),
        ({"a": [1, 2]}, {"a": [1, 2.000001]}, True),
        ({"a": [1, 2]}, {"a": [1, 2, 3]}, False),
        ({"solver": {"end": 1}}, {"solver": {"end": 2}}, True),
        ({"a": {"solver": 1}}, {"a": {"solver": 2}}, False),
        ({"a": "2*t"}, {"a": "3*t"}, False),
    ],
)
def test_alike(one, two, same):
    assert alike(one, two) is same
