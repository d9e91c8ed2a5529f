"""Plots: what is enlarged, two axes, equal axes of paths, magnitudes, tables among the runs."""

import numpy as np
import pytest

from tests import small
from tests.report.test_figures import drawn
from tests.report.test_plots import DOOR, columns
from trsim.analyse.plotted import plotted, rows
from trsim.errors import UsageError
from trsim.report import analysed, plots
from trsim.report.asked import Asked
from trsim.report.curves import ALL, Curves, View, figure
from trsim.report.display import compared
from trsim.report.marks import heading
from trsim.report.style import look
from trsim.store.read import read

DISC = """\
title: Disc that is hit
bodies: {disc: {mass: 2, inertia: 0.5, at: [3, 4]}}
joints: {hinge: {type: revolute, bodies: [ground, disc], at: [3, 0]}}
sensors: {turned: {joint: hinge}}
forces: {hit: {type: applied_load, body: disc, at: [3, 4], direction: [1, 0], frame: disc,
               force: "100*(t > 1)*(t < 1.02)"}}
solver: {end: 2 s, tolerance: 1e-9}
output: {every: 1 ms}
"""


@pytest.fixture(scope="module")
def disc(tmp_path_factory):
    """At rest, hit for 20 ms, then turning about (3, 0) on a radius of 4 m."""
    path = tmp_path_factory.mktemp("curves") / "disc.h5"
    small.run(path, text=DISC)
    return path


def made(word, view=View(), *paths):  # noqa: B008
    of = plotted(word)
    every = [Curves(one, rows(one.run, of)) for one in compared([read(path) for path in paths])]
    with look():
        return figure(every, [], of, ALL, [], view)


def test_what_most_happens_in_is_enlarged(disc, tmp_path):
    """The speed changes between 1 and 1.02 s alone: a panel beside it shows just that."""
    left, right = made("turned.rate", View(), disc).axes
    low, high = right.get_xlim()
    assert 0.99 < low < 1.005 and 1.015 < high < 1.03
    assert left.get_xlim()[1] > 1.99
    x, y = right.lines[0].get_data()
    inside = np.isfinite(x)
    assert low <= x[inside].min() and x[inside].max() <= high  # and so its heights are those of it
    assert inside.sum() > 20 and np.diff(x[inside]).max() < 1.5e-3  # every row
    # I w' = -4 m * 100 N: pushed along x above the hinge
    w = np.degrees(-400.0 * np.clip(x[inside] - 1.0, 0.0, 0.02) / (0.5 + 2.0 * 16.0))
    np.testing.assert_allclose(y[inside], w, atol=1e-6)
    [path, _] = analysed([disc], tmp_path, Asked(plot=("turned.rate",))).files
    assert 0.005 < drawn(path) < 0.5
    for word in ("turned", "turned.rate : turned"):  # changes all over; over what it is made of
        assert len(made(word, View(), disc).axes) == 1
    assert len(made("turned.rate", View(zoom=None), disc).axes) == 1
    assert len(made("turned.rate, turned", View(), disc).axes) == 2  # of the angle it is little
    _, right = made("turned", View(zoom=(0.5, 0.75)), disc).axes
    assert right.get_xlim() == (0.5, 0.75)


def test_a_channel_reads_as_one_quantity(disc):
    """Without a comma where its name has a dot; a magnitude keeps its bars on the axis, too."""
    one = made("|disc.velocity| : turned.rate", View(zoom=None), disc)
    [axes] = one.axes
    assert axes.get_ylabel() == "|disc velocity|\n(m/s)"
    assert axes.get_xlabel() == "turned rate (deg/s)"
    title = one.get_suptitle().split("\n")[0]
    assert title.startswith("|disc velocity| over turned rate")
    left, _ = made("|disc.velocity|, turned", View(second_axis=True), disc).axes
    assert left.get_ylabel() == "|disc velocity| (m/s)"
    assert heading("crank_B.angle") == "Crank B angle"


def test_second_axis(disc, tmp_path):
    left, right = made("turned, turned.rate", View(second_axis=True), disc).axes
    assert (left.get_ylabel(), right.get_ylabel()) == ("turned (deg)", "turned rate (deg/s)")
    assert left.bbox.bounds == right.bbox.bounds
    assert left.lines[0].get_color() != right.lines[0].get_color()
    with pytest.raises(UsageError, match="for two units; these channels have rad"):
        made("turned", View(second_axis=True), disc)
    both = Asked(plot=("turned, turned.rate",), second_axis=True)
    assert 0.005 < drawn(analysed([disc], tmp_path, both).files[0]) < 0.5
    with pytest.raises(UsageError, match="does not go with"):
        analysed([disc], tmp_path, both._replace(zoom="0..1"))


def test_a_path_has_equal_axes(disc):
    """A circle is round: as many pixels for a metre up as along."""
    figure = made("disc.position.y : disc.position.x", View(), disc)
    [axes] = figure.axes
    figure.draw_without_rendering()
    (x0, y0), (x1, y1) = axes.transData.transform([(0.0, 0.0), (1.0, 1.0)])
    assert x1 - x0 == pytest.approx(y1 - y0, rel=1e-9)
    x, y = axes.lines[0].get_data()
    np.testing.assert_allclose(np.hypot(x - 3000.0, y), 4000.0, rtol=1e-9)
    for word in (
        "disc.position.x",
        "turned : disc.position.x",
        "disc.velocity.y : disc.velocity.x",
    ):
        assert made(word, View(), disc).axes[0].get_aspect() == "auto"


def test_magnitudes(disc, tmp_path):
    """Of the speed of a point on a circle, |v| = 4 m w."""
    asked = Asked(plot=("disc.velocity : turned",), magnitude=True)
    titles, values = columns(analysed([disc], tmp_path, asked).files[1])
    assert titles == ["turned [rad]", "time [s]", "|disc.velocity| [m/s]"]
    np.testing.assert_allclose(values[:, 2], 4.0 * np.abs(read(disc).channel("turned.rate")),
                               atol=1e-9)  # fmt: skip
    with pytest.raises(UsageError, match="3 components") as caught:
        analysed([disc], tmp_path, asked._replace(magnitude=False))
    assert "--magnitude" in caught.value.hint or "|disc.velocity|" in caught.value.hint


def test_tables_among_the_runs(tmp_path):
    small.run(tmp_path / "door.h5", text=DOOR)
    (tmp_path / "measured.csv").write_text("time [s],door_angle [deg]\n0,0\n0.25,30\n0.5,0\n")
    given = [tmp_path / "door.h5", tmp_path / "measured.csv"]
    found = analysed(given, tmp_path, Asked(plot=("door_angle",)))
    assert any("less measured.csv" in line for line in found.lines)
    assert found.values[0].value == pytest.approx(0.6 - np.radians(30.0), rel=1e-9)
    with pytest.raises(UsageError, match="is a table"):
        analysed(given, tmp_path, Asked(table=("peak:door_angle",)))
    with pytest.raises(UsageError, match="tables alone"):
        analysed(given[1:], tmp_path, Asked(plot=("door_angle",)))


def test_options_that_go_with_plots(disc, tmp_path):
    for asked in (Asked(zoom="off"), Asked(second_axis=True), Asked(magnitude=True)):
        with pytest.raises(UsageError, match="goes with --plot"):
            analysed([disc], tmp_path, asked._replace(table=("peak:turned",)))
    assert plots.named("a : b", "") == "plot_a_b"
