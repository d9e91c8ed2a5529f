"""Forces of the actuators of the thrust reverser in space beside the study and a linear model.

The linear model (benchmarks/fit_spatial.py) is a rigid fairing at rest at every stroke.
"""

from functools import cache

import numpy as np
import pytest

from benchmarks import fit_spatial as linear

from ..linkages import spatial
from ..mechanisms import DATA
from ..spatial import NAMES, RIGID, at_speeds, done, odd_peaks, peaks

TABLE = np.genfromtxt(DATA / "spatial_reverser.csv", delimiter=",")
PREDICTED, STUDY = TABLE[:, 1:4], TABLE[1:, 4:]


def test_peaks_lie_near_the_quasi_static_prediction():
    ours = [peaks(at_speeds()), *map(odd_peaks, (1, 2, 3))]
    for found, predicted in zip(ours, PREDICTED, strict=True):
        assert found == pytest.approx(predicted, rel=0.03, abs=40)


def test_orderings_of_the_study():
    one, two, three = map(odd_peaks, (1, 2, 3))
    together = peaks(at_speeds())
    for ours, theirs in zip((one, two, three), STUDY, strict=True):
        assert np.array_equal(np.argsort(ours), np.argsort(theirs))
        assert (ours > together).all()
    assert np.array_equal(np.argmax([one, two, three], 0), np.argmax(STUDY, 0))  # actuator 2's
    assert together[0] == pytest.approx(together[2], rel=0.04) and together[1] < together[2] / 2


def test_which_way_the_forces_go():
    """A slower actuator 1 or 3, a faster 2: more for the outer ones, less for the middle one."""
    together = peaks(at_speeds())
    more = ({"speed_1": 418}, {"speed_2": 422}, {"speed_3": 418})
    less = ({"speed_1": 422}, {"speed_2": 418}, {"speed_3": 422})
    for speeds, way in (*((one, 1) for one in more), *((one, -1) for one in less)):
        change = way * (peaks(at_speeds(**speeds)) - together)
        assert change[0] > 0 and change[2] > 0 and change[1] < 0, speeds


# --- the linear model of a fairing at rest -----------------------------------------------------


@cache
def chain_loads():
    """What the chains do to the fairing, from the planar run."""
    return linear.loads(linear.planar())


def test_coupling_of_the_rounded_stiffnesses():
    K = 1e5 * np.array([[2.30, -3.75, 1.44], [-3.75, 7.49, -3.75], [1.44, -3.75, 2.30]])
    assert linear.coupling(linear.ROUNDED) == pytest.approx(K, abs=0.006e5)
    # on free rails unequal strokes cost nothing: three ball ends strain no rigid fairing
    free = linear.coupling(linear.ROUNDED * [1, 1e-6, 1e-6])
    assert np.abs(free).max() < 10
    # nor do strokes that are longer by the same
    assert np.abs(K @ np.ones(3)).max() < 0.02e5


def test_linear_model_predicts_the_peaks():
    by = chain_loads()
    together = linear.forces(linear.ROUNDED, by, np.full(3, linear.SPEED)).max(0)
    assert peaks(at_speeds()) == pytest.approx(together, rel=0.01)
    predicted = linear.peaks(linear.ROUNDED, by)
    assert np.array([odd_peaks(j) for j in (1, 2, 3)]) == pytest.approx(predicted, rel=0.02)


def test_the_fit_is_the_best_and_the_rounded_set_is_near():
    by = chain_loads()
    best = linear.fitted(by)
    assert best == pytest.approx(linear.ROUNDED, rel=0.2)
    least = np.sum(linear.misfit(best, by) ** 2)
    for change in np.vstack([0.05 * np.eye(3), -0.05 * np.eye(3)]):
        assert np.sum(linear.misfit(best * (1 + change), by) ** 2) > least


def test_rounded_set_is_that_of_the_scenario():
    read = at_speeds().scenario
    assert {read.drives[name].stiffness for name in NAMES} == {linear.ROUNDED[0]}
    rails = [read.forces[f"rail_{k}_{end}"] for k in (1, 2) for end in ("front", "rear")]
    assert {rail.stiffness for rail in rails} == {(0.0, *linear.ROUNDED[1:])}
    places = np.array([read.drives[name].points[1] for name in NAMES])
    assert places[:, 1:] == pytest.approx(linear.ACTUATORS, abs=1e-6)
    edge = -0.272  # x of the leading edge
    assert sorted(rail.at for rail in rails) == [
        pytest.approx((edge + x, y, z)) for x, y, z in sorted(linear.RAILS, key=lambda r: r[0])
    ]


# --- actuators that do not give way ----------------------------------------------------------

# nothing else takes the fairing's bounce after the impact of the lugs where no actuator gives way
DAMPED = "".join(f"\n  rail_{k}_{end}: {{damping: [0, 5e3 N*s/m, 5e3 N*s/m]}}"
                 for k in (1, 2) for end in ("front", "rear"))  # fmt: skip


@pytest.mark.parametrize("slow", [420, 418])
def test_rigid_actuators_run_on_compliant_rails(slow):
    """Nothing but the rails takes the difference of the strokes; the linear model with k = oo."""
    r = done(spatial(f"{RIGID}\nforces:{DAMPED}"), f"parameters.speed_2={slow} mm/s")
    for name, v in zip(NAMES, (0.42, 1e-3 * slow, 0.42), strict=True):
        assert r[f"{name}.stroke"] == pytest.approx(v * r.t, abs=1e-10)
    stiffness = linear.ROUNDED * [1e5, 1, 1]
    expected = linear.forces(stiffness, chain_loads(), np.array([0.42, 1e-3 * slow, 0.42]))
    found = np.stack([r[f"{name}.force"] for name in NAMES], axis=1)
    late = chain_loads().t > 0.8
    ours = np.array([np.interp(chain_loads().t[late], r.t, column) for column in found.T]).T
    assert ours == pytest.approx(expected[late], abs=0.02 * np.abs(expected).max())
