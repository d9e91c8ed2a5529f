"""Plots of any channel over any other, beside tables: what is drawn, written and told."""

import csv

import numpy as np
import pytest

from tests import small
from tests.report.test_figures import drawn
from trsim.analyse.plotted import Plotted, limits, plotted
from trsim.errors import FileError, UsageError
from trsim.report import analysed, plots
from trsim.report.asked import Asked, file_name, table
from trsim.report.display import compared
from trsim.report.looks import Looks
from trsim.report.style import look
from trsim.store.read import read
from trsim.store.target import headed, together

DOOR = """\
title: Door that swings
bodies: {door: {mass: 2, inertia: 0.1, at: [0.5, 0]}}
joints: {hinge: {type: revolute, bodies: [ground, door], at: [0, 0]}}
drives: {handle: {joint: hinge, position: 0.6*sin(2*pi*t)}}
sensors: {door_angle: {joint: hinge}}
solver: {end: 0.5 s, tolerance: 1e-9}
output: {every: 1 ms}
"""


@pytest.fixture(scope="module")
def door(tmp_path_factory):
    """phi = 0.6 sin(2 pi t) for half a turn: forth and back to where it was."""
    path = tmp_path_factory.mktemp("plots") / "door.h5"
    small.run(path, text=DOOR)
    return path


def columns(path):
    with path.open(newline="") as file:
        titles, *rows = csv.reader(file)
    return titles, np.array([[float(x) for x in row] for row in rows])


def lines(path):
    with path.open(newline="") as file:
        return list(csv.DictReader(file))


def test_words():
    assert plotted("a") == Plotted(("a",), "time", "")
    assert plotted(" a.rate , b : c @0.1..0.2") == Plotted(("a.rate", "b"), "c", "0.1..0.2")
    assert plotted("|F|:t.x") == Plotted(("|F|",), "t.x", "")
    for word in ("", ":a", "a:", "a:b:c", "a,:b", "a,b:c,d", "a,a:b"):
        with pytest.raises(UsageError):
            plotted(word)
    assert limits("90deg..", "rad") == (pytest.approx(np.pi / 2), np.inf)
    for text in ("1", "2..1", "1kg..2kg", "a..b"):
        with pytest.raises(UsageError, match="window"):
            limits(text, "rad")


def test_figure_and_rows(door, tmp_path):
    """Rows of the closed form, SI, the abscissa first; the figure in the units of the scenario."""
    found = analysed([door], tmp_path, Asked(plot=("door_angle.rate, handle.force : door_angle",)))
    picture, rows = found.files
    assert picture.name == "plot_door_angle_rate_handle_force_door_angle.png"
    assert 0.005 < drawn(picture) < 0.5
    titles, values = columns(rows)
    assert titles == ["door_angle [rad]", "time [s]", "door_angle.rate [rad/s]",
                      "handle.force [N*m]"]  # fmt: skip
    w, t = 2.0 * np.pi, values[:, 1]
    np.testing.assert_allclose(values[:, 0], 0.6 * np.sin(w * t), atol=1e-9)
    np.testing.assert_allclose(values[:, 2], 0.6 * w * np.cos(w * t), atol=1e-8)
    inertia = 0.1 + 2.0 * 0.5**2
    np.testing.assert_allclose(values[:, 3], -inertia * 0.6 * w**2 * np.sin(w * t), atol=1e-6)
    with look():
        shown = compared([read(door)])
        of = plotted("door_angle.rate, handle.force : door_angle")
        every = [plots.Curves(shown[0], plots.rows(shown[0].run, of))]
        made = plots.figure(every, [], of, (-np.inf, np.inf), [])
    upper, lower = made.axes
    assert upper.get_ylabel() == "door angle rate\n(deg/s)"
    assert lower.get_ylabel() == "handle force\n(N·m)"
    assert lower.get_xlabel() == "door angle (deg)"
    assert upper.lines[0].get_xdata().max() == pytest.approx(np.degrees(0.6), abs=1e-3)
    assert "dot: begin" in made.get_suptitle()


def test_time_unless_an_abscissa_is_named(door, tmp_path):
    found = analysed([door], tmp_path, Asked(plot=("|door.position|@0.1..0.2",)))
    titles, values = columns(found.files[1])
    assert titles == ["time [s]", "|door.position| [m]"]
    assert (values[0, 0], values[-1, 0]) == (pytest.approx(0.1), pytest.approx(0.2))
    np.testing.assert_allclose(values[:, 1], 0.5, rtol=1e-9)


def test_what_was_drawn_is_its_own_reference(door, tmp_path):
    """Read back it differs by nothing, forth and back, and the second time it is replaced."""
    word = "handle.force : door_angle"
    first = analysed([door], tmp_path, Asked(plot=(word,))).files[1]
    with pytest.raises(UsageError, match="made of it"):
        analysed([door], tmp_path, Asked(plot=(word,), overlay=(str(first),)))
    old = first.rename(tmp_path / "old.csv")
    for _ in range(2):
        found = analysed([door], tmp_path, Asked(plot=(word,), overlay=(str(old),)))
    up, down = lines(found.files[2])
    assert up["compared"] == "branch 1 of 2, rising"
    assert [float(one["largest difference"]) for one in (up, down)] == [0.0, 0.0]
    assert (up["rows"], up["unit"], up["unit of at"]) == ("251", "N*m", "rad")


def test_largest_difference_to_an_analytical_curve(door, tmp_path):
    """-I phi'' over phi is I w^2 phi, a straight line; one 2 % steeper is off at the end."""
    phi = np.linspace(-0.5, 0.5, 101)
    slope = 0.6 * (2.0 * np.pi) ** 2
    text = "\n".join(f"{float(np.degrees(a))!r},{-1.02e-3 * slope * a!r}" for a in phi.tolist())
    reference = tmp_path / "line.csv"
    reference.write_text(f"door_angle [deg],handle.force [kN*m]\n{text}\n")
    asked = Asked(plot=("handle.force : door_angle",), overlay=(str(reference),))
    found = analysed([door], tmp_path, asked)
    up, down = lines(tmp_path / "plot_handle_force_door_angle_difference.csv")
    for one in (up, down):
        assert float(one["largest difference"]) == pytest.approx(0.02 * slope * 0.5, rel=1e-4)
        assert float(one["at"]) == pytest.approx(0.5)
        assert (one["rows"], one["rows in the window"]) == ("51", "101")
    assert "compared at 51 of 101 rows" in found.lines[0]
    assert found.values[0].value == float(up["largest difference"])
    found = analysed([door], tmp_path, asked._replace(window="-1deg..20deg"))
    [name] = [path for path in found.files if path.name.endswith("difference.csv")]
    for one in lines(name):
        assert float(one["at"]) == pytest.approx(0.34)  # the last row below 20 deg
    assert 0.005 < drawn(found.files[0]) < 0.5


def test_tables_that_say_too_little(door, tmp_path):
    (tmp_path / "a.csv").write_text("door_angle,door_angle.rate\n0.1,1\n0.2,2\n0.3,1\n")
    asked = Asked(plot=("door_angle.rate, handle.force : door_angle",))
    found = analysed([door], tmp_path, asked._replace(overlay=(str(tmp_path / "a.csv"),)))
    assert any("no column handle.force: not compared" in line for line in found.lines)
    assert any("door_angle, door_angle.rate without a unit" in line for line in found.lines)
    (tmp_path / "b.csv").write_text("door_angle,other,third\n0.1,1,1\n0.2,2,2\n")
    (tmp_path / "c.csv").write_text("0.1,1\n0.2,2\n")
    (tmp_path / "d.csv").write_text("a,a\n0.1,1\n0.2,2\n")
    (tmp_path / "e.csv").write_text("door_angle [mm],handle.force [N*m]\n0.1,1\n0.2,2\n")
    for name, kind, what in (("b", UsageError, "no column named"), ("c", FileError, "no table"),
                             ("d", FileError, "two columns named 'a'"),
                             ("e", UsageError, "no unit of what is in rad"),
                             ("f", FileError, "no such file")):  # fmt: skip
        with pytest.raises(kind, match=what):
            analysed([door], tmp_path, asked._replace(overlay=(str(tmp_path / f"{name}.csv"),)))
    for asked, what in ((Asked(window="0..1", portrait=("stroke:stroke",)), "goes with --plot"),
                        (Asked(plot=("door.position : door_angle",)), "3 components"),
                        (Asked(plot=("door_angle",), against="door_angle"), "--against"),
                        (Asked(plot=("nothing",)), "no channel named 'nothing'")):  # fmt: skip
        with pytest.raises(UsageError, match=what):
            analysed([door], tmp_path, asked)


def test_a_window_that_no_run_reaches(door, tmp_path):
    """Refused as `@5..6` is, with what there is, before anything is written."""
    asked = Asked(plot=("door_angle.rate",))
    over = Asked(plot=("door_angle.rate : door_angle",))
    (tmp_path / "a.csv").write_text("time [s],door_angle.rate [rad/s]\n0.1,1\n5.5,2\n6,2\n")
    for one, where in (
        (asked._replace(window="5..6"), "'5..6'; time goes from 0 to 0.5 s"),
        (asked._replace(zoom="5..6"), "'5..6'; time goes from 0 to 0.5 s"),
        (asked._replace(window="5..6", second_axis=True), "'5..6'"),
        (asked._replace(window="5..6", overlay=(str(tmp_path / "a.csv"),)), "'5..6'"),
        (over._replace(window="50deg.."), "door_angle goes from .* to 0.6 rad"),
    ):
        with pytest.raises(UsageError, match=f"door.h5: no row lies in .*{where}"):
            analysed([door], tmp_path / "out", one)
    assert not (tmp_path / "out").exists()
    assert analysed([door], tmp_path / "out", asked._replace(window="0.5..6")).files


def test_words_of_the_same_letters_have_files_of_their_own(door, tmp_path):
    both = ("door_angle : door_angle.rate", "door_angle, door_angle.rate")
    found = analysed([door], tmp_path, Asked(plot=both))
    assert len({*found.files}) == 4
    assert columns(found.files[1])[0][0] == "door_angle.rate [rad/s]"
    assert columns(found.files[3])[0][0] == "time [s]"


def test_names_tell_words_apart():
    """Magnitudes, signs and ends: what one word makes does not replace what another one made."""
    words = ("angle", "|angle|", "a@-3..-1", "a@3..1", "a@-3..1", "a@0.1..2", "a@0..1.2",
             "a@1e-3..", "a@1e3..")  # fmt: skip
    assert len({file_name("plot", word) for word in words}) == len(words)
    assert file_name("plot", "|B.force| -3..-1") == "plot_magnitude_B_force_minus3_to_minus1"
    assert file_name("plot", "a, b : c") == "plot_a_b_c"


@pytest.mark.parametrize("asked", [
    Asked(plot=("door_angle", "door_angle.rate")),
    Asked(spectrum=("door_angle.rate",), table=("final:door_angle",)),
])  # fmt: skip
def test_all_or_nothing_is_written(asked, door, tmp_path):
    """A table of somebody else: no picture beside it is written or replaced either."""
    last = analysed([door], tmp_path, asked).files[-1]
    last.write_text("of somebody else")
    before = {path: path.read_bytes() for path in tmp_path.iterdir() if path.suffix != ".png"}
    for path in tmp_path.glob("*.png"):
        path.unlink()
    with pytest.raises(UsageError, match=f"{last.name} exists and is not a table"):
        analysed([door], tmp_path, asked)
    assert {path: path.read_bytes() for path in tmp_path.iterdir()} == before


def test_a_table_in_other_units_is_replaced(door, tmp_path):
    asked = Asked(plot=("handle.force : door_angle", "door_angle"), table=("final:door_angle",))
    for units in ((), ("angle: deg",), ("time: ms, torque: kN*m",), ()):
        first, second = (
            columns(path)[0]
            for path in analysed([door], tmp_path, asked, Looks(units)).files
            if path.name.startswith("plot") and path.suffix == ".csv"
        )
    assert (first[0], second[0]) == ("door_angle [rad]", "time [s]")


@pytest.mark.parametrize(
    "start, fits",
    [
        (b"a [mm],b [s]\r\n1,2\r\n", True),
        (b'"a [mm]",b,c\r\n', True),
        (b"a [mm],c [s]\r\n1,2\r\n", False),
        (b"a [mm]\r\n", False),
        (b"a,b\n1,2\n", False),  # as editors write it
        (b"a [m] of [s],b\r\n", False),
        (b"\r\n", False),
        (b"a\0,b\xff\r\n", False),
    ],
)
def test_tables_are_known_by_titles_without_units(start, fits):
    assert headed("a [m]", "b").fits(start) == fits


def test_an_empty_title_stands_for_any():
    assert headed("", "b").fits(b"x [mm],b\r\n")
    assert not headed("", "b").fits(b"x [mm]\r\n")


def test_two_words_that_make_one_file(tmp_path):
    with together():
        for _ in range(2):  # the same again takes its place
            table(tmp_path / "a.csv", ("x", "y"), [(1.0, 2.0)])
    with pytest.raises(UsageError, match=r"b\.csv would be written twice"), together():
        table(tmp_path / "b.csv", ("x", "y"), [])
        table(tmp_path / "b.csv", ("z", "y"), [])
    assert [path.name for path in tmp_path.iterdir()] == ["a.csv"]
    assert (tmp_path / "a.csv").read_bytes() == b"x,y\r\n1.0,2.0\r\n"


def test_several_runs(paths, tmp_path):
    asked = Asked(plot=("B.contact_force, stroke.rate : stroke", "stroke"))
    found = analysed(paths, tmp_path, asked)
    assert len(found.files) == 6
    assert all(0.005 < drawn(path) < 0.5 for path in found.files if path.suffix == ".png")
    assert columns(found.files[2])[0][0] == "stroke [m]"
    with look():
        shown = compared([read(path) for path in paths])
        of = plotted(asked.plot[0])
        every = [plots.Curves(one, plots.rows(one.run, of)) for one in shown]
        made = plots.figure(every, [], of, (-np.inf, np.inf), [])
    [legend] = made.legends
    names = [text.get_text() for text in legend.get_texts()]
    assert len(names) == 4 == len({*names})
