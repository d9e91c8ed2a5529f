"""Measured errors are the true ones; what a reference cannot tell is said."""

from dataclasses import replace
from statistics import median

import numpy as np
import pytest

from tests import mechanisms, small
from trsim.analyse import precision
from trsim.analyse.precision import Point, Setting, errors, point, reference, slope, slopes
from trsim.analyse.trajectory import problem, trajectory
from trsim.errors import SolverError, UsageError
from trsim.scenario.load import loads

TEXT, ANGLE = mechanisms.torsion_pendulum()
TOLERANCES = (1e-3, 1e-4, 1e-5, 1e-6, 1e-7)
TIGHT = Setting("radau", 1e-10)


@pytest.fixture(scope="module")
def pendulum():
    return problem(loads(TEXT), ["angle"])


@pytest.fixture(scope="module")
def tight(pendulum):
    return reference(pendulum, TIGHT)


def true_error(run):
    """Largest difference to the exact solution, over its range."""
    exact = ANGLE(run.time)
    return np.max(np.abs(run.values["angle"][:, 0] - exact)) / np.ptp(exact)


# --- errors ----------------------------------------------------------------------------------


def test_uncertainty_covers_the_error_of_the_reference(tight):
    assert true_error(tight.run) <= 2.0 * tight.uncertainty
    assert tight.uncertainty < 1e-9
    assert (tight.apart, tight.rows, tight.second_failed) == (None, len(tight.run.time), "")


@pytest.mark.parametrize("method", ["dop853", "radau", "generalized_alpha"])
def test_measured_errors_are_the_true_ones(method, pendulum, tight):
    for tolerance in TOLERANCES[:4]:
        setting = Setting(method, tolerance)
        found = point(pendulum, tight, setting, repeats=1)
        starts = precision.first_steps(pendulum, tight, setting)
        true = [true_error(trajectory(pendulum, setting, first)) for first in starts]
        assert abs(found.error - median(true)) <= 2.0 * tight.uncertainty
        assert abs(found.worst - max(true)) <= 2.0 * tight.uncertainty
        assert found.error > tight.uncertainty
        assert not found.unresolved
        assert found.cpu >= 0.0  # of a coarse clock
        assert found.steps > 0


def test_work_is_of_runs_without_rows(pendulum, tight):
    """A thousand rows cost dense outputs, and none of them is in what is timed."""
    setting = Setting("dop853", 1e-6)
    found = point(pendulum, tight, setting, repeats=1)
    starts = precision.first_steps(pendulum, tight, setting)
    with_rows = [trajectory(pendulum, setting, first).outcome.statistics for first in starts]
    assert found.steps == median(one["steps"] for one in with_rows)
    assert found.evaluations < median(one["evaluations"] for one in with_rows)


def test_an_error_below_the_uncertainty_is_marked(pendulum):
    loose = reference(pendulum, Setting("radau", 1e-5))
    assert point(pendulum, loose, Setting("dop853", 1e-9), repeats=1).unresolved
    assert not point(pendulum, loose, Setting("dop853", 1e-2), repeats=1).unresolved


def test_slopes(pendulum, tight):
    """An error proportional to the tolerance; to the fourth power of the step of rk4."""
    settings = precision.plan(["radau", "rk4"], TOLERANCES, [4e-3, 2e-3, 1e-3])
    fitted = slopes([point(pendulum, tight, one, repeats=1) for one in settings], tight)
    assert 0.8 < fitted["radau"] < 1.3
    assert fitted["rk4"] == pytest.approx(4.0, abs=0.3)


def test_slopes_are_of_peaks_where_the_references_part(tight):
    found = [Point(Setting("radau", 10.0**-k), 0.1, peak_error=10.0 ** (-2 * k)) for k in (3, 4)]
    assert slopes(found, tight)["radau"] == pytest.approx(0.0)
    assert slopes(found, replace(tight, apart=0.1))["radau"] == pytest.approx(2.0)


def test_slope_of_a_power():
    assert slope([1e-3, 1e-5, 1e-6], [2e-6, 2e-10, 2e-12]) == pytest.approx(2.0)
    assert np.isnan(slope([1e-3], [1e-3]))


# --- what does not work out ------------------------------------------------------------------


def test_a_method_that_fails_is_a_row():
    of = problem(loads(small.SLIDER_CRANK))
    to = reference(of, Setting("dop853", 1e-7))
    settings = precision.plan(["rk4", "dop853"], [1e-4], [5e-5])
    failed, good = (point(of, to, setting, repeats=1) for setting in settings)
    assert "the fixed step is too large" in failed.reason
    assert np.isnan(failed.error)
    assert not good.reason
    assert 0.0 < good.peak_error < 1e-3
    assert slopes([failed, good], to).keys() == {"rk4", "dop853"}


def test_a_reference_that_fails_is_an_error():
    of = problem(loads(TEXT, ["solver.max_steps=3"]))
    with pytest.raises(SolverError, match="the reference, radau at 1e-10, failed: more than 3"):
        reference(of, TIGHT)


def test_a_second_reference_that_fails_leaves_the_uncertainty_open():
    of = problem(loads(TEXT, ["solver.max_steps=100"]))
    to = reference(of, Setting("dop853", 1e-9))
    assert to.second_method == "radau"
    assert to.second_failed.startswith("more than 100 steps, at t = ")
    assert np.isnan(to.uncertainty)
    assert not point(of, to, Setting("dop853", 1e-4), repeats=1).unresolved


def test_motions_that_part():
    """Loose references of many impacts become two motions; rows after that count no more."""
    of = problem(loads(small.SLIDER_CRANK, ["solver.end=40ms", "output.every=0.05ms"]))
    to = reference(of, Setting("radau", 1e-2))
    assert 0.0 < to.apart < 0.04
    assert to.run.time[to.rows] == to.apart
    assert to.uncertainty <= precision.APART
    second = trajectory(of, Setting("dop853", 1e-2))
    beyond = errors(second, replace(to, rows=len(to.run.time)))
    assert max(beyond.values()) > precision.APART >= max(errors(second, to).values())


# --- what is compared ------------------------------------------------------------------------


def test_quantities():
    crank = loads(small.SLIDER_CRANK)
    names = [q.name for q in problem(crank).quantities]
    assert names == ["stroke", "stroke.rate", "crank_angle", "crank_angle.rate"]
    assert [q.name for q in problem(crank, ["rod.[pv]*", "stroke"]).quantities] == [
        "rod.position", "rod.velocity", "stroke"
    ]  # fmt: skip
    assert problem(crank).contacts.keys() == {"B"}
    with pytest.raises(UsageError, match="no channel fits 'strke'"):
        problem(crank, ["strke"])


def test_bodies_where_there_are_no_sensors():
    scenario = loads("bodies: {a: {mass: 1, inertia: 1, velocity: [1, 0]}}\nsolver: {end: 1}")
    of = problem(scenario)
    assert [q.name for q in of.quantities] == ["a.position"]
    assert reference(of, TIGHT).ranges == {"a.position": pytest.approx(1.0)}


def test_what_does_not_move_has_no_error():
    of = problem(loads(small.SLIDER_CRANK, ["solver.end=0.3ms"]))
    to = reference(of, Setting("dop853", 1e-6))
    assert to.still == ("crank_angle.rate",)  # the motor's
    still = problem(loads(small.SLIDER_CRANK, ["solver.end=0.3ms"]), ["crank_angle.rate"])
    with pytest.raises(UsageError, match="none of the quantities moves"):
        reference(still, Setting("dop853", 1e-6))


def test_reference_by_default():
    setting = precision.reference_setting
    assert setting(["dop853", "rk4"], [1e-3, 1e-6]) == ("radau", pytest.approx(1e-8), None)
    assert setting(["radau"], [1e-13]) == ("dop853", 1e-14, None)


def test_fixed_steps_are_of_rk4_alone():
    assert precision.plan(["rk4", "radau"], [1e-3], [1e-6, 1e-7]) == [
        ("rk4", None, 1e-6), ("rk4", None, 1e-7), ("radau", 1e-3, None)
    ]  # fmt: skip
