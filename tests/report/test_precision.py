"""The figure of work against precision."""

import csv
from dataclasses import replace

import numpy as np
import pytest
from matplotlib.figure import Figure

from tests import small
from tests.report.test_figures import drawn
from trsim.analyse import precision
from trsim.analyse.precision import Setting, Study
from trsim.analyse.trajectory import problem
from trsim.report.precision import decades, draw, figure
from trsim.report.style import look
from trsim.scenario.load import loads


@pytest.fixture(scope="module")
def study():
    scenario = loads(small.SLIDER_CRANK)
    of = problem(scenario)
    to = precision.reference(of, Setting("radau", 1e-7))
    settings = precision.plan(["dop853", "radau", "rk4"], [1e-3, 1e-5], [5e-5])
    measured = [precision.point(of, to, setting, repeats=1) for setting in settings]
    # times of its own: a clock of coarse ticks gives 0 for runs as short as these
    found = tuple(replace(p, cpu=1e-3 * k) for k, p in enumerate(measured, start=1))
    return Study(scenario.title, to, found, precision.slopes(found, to))


def test_figure_and_table_are_written(study, tmp_path):
    picture, table = draw(study, tmp_path)
    assert (picture.name, table.name) == ("work_precision.png", "work_precision.csv")
    assert 0.005 < drawn(picture) < 0.5
    with table.open() as file:
        rows = list(csv.DictReader(file))
    assert [row["method"] for row in rows] == ["dop853", "dop853", "radau", "radau", "rk4"]
    assert [float(row["error"]) for row in rows[:4]] == [p.error for p in study.points[:4]]
    assert "too large" in rows[4]["reason"]


def test_axes_are_labelled(study):
    with look():
        drawn_figure = figure(study)
    left, right = drawn_figure.axes
    assert left.get_xlabel() == "largest error / range (-)"
    assert right.get_xlabel() == "relative error of peak contact forces (-)"
    assert left.get_ylabel() == "CPU time of the integration (ms)"
    assert left.get_xscale() == left.get_yscale() == "log"
    names = [text.get_text() for text in drawn_figure.legends[0].get_texts()]
    assert [name.split(",")[0] for name in names[:2]] == ["dop853", "radau"]
    assert names[2] == "rk4 (nothing to show)"
    np.testing.assert_array_equal(
        left.lines[0].get_ydata(), [1e3 * p.cpu for p in study.points[:2]]
    )


def test_a_study_in_which_all_fail_is_drawn(study, tmp_path):
    failed = study.points[-1:]
    alone = Study("", study.reference, failed, precision.slopes(failed, study.reference))
    assert len(draw(alone, tmp_path)) == 2


def test_axes_without_points():
    """Peaks that are all right to the last bit have no place on logarithmic axes."""
    axes = Figure().subplots()
    axes.set(xscale="log", yscale="log")
    decades(axes)
    before = axes.get_xlim()
    axes.plot([3e-5, 2e-3], [1.0, 2.0])
    decades(axes)
    assert axes.get_xlim() == pytest.approx((1e-5, 1e-2)) and before != axes.get_xlim()
