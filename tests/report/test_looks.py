"""Units, kinds of files, sizes and styles that a report is asked for, without running again."""

import csv
import os
import re

import numpy as np
import pytest

from tests import small
from tests.report.test_figures import drawn
from tests.report.test_plots import DOOR
from trsim.errors import FileError, ScenarioError, UsageError
from trsim.report import analysed, report, style
from trsim.report.asked import Asked
from trsim.report.display import compared, display_units
from trsim.report.figures import motion
from trsim.report.looks import Looks, chosen, inches
from trsim.report.style import look
from trsim.scenario.shown import MEANT, UNITS
from trsim.scenario.shown import report as section
from trsim.store.read import read


@pytest.fixture(scope="module")
def door(tmp_path_factory):
    """phi = 0.6 sin(2 pi t) for half a second."""
    path = tmp_path_factory.mktemp("looks") / "door.h5"
    small.run(path, text=DOOR)
    return path


def test_units_of_an_option():
    found = chosen(("angle: rad, speed: rpm", "speed: km/h, force: kN"))
    assert found == {
        "rad": (1.0, "rad"),
        "rad/s": (pytest.approx(60.0 / (2.0 * np.pi)), "rpm"),
        "m/s": (pytest.approx(3.6), "km/h"),
        "N": (pytest.approx(1e-3), "kN"),
    }
    for text, what in (("speed", "no units"), ("sped: rpm", "unknown key 'sped'"),
                       ("a:", "no units"), ("speed:", "no units"), ("velocity: m/s", "'velocity'"),
                       ("speed: N", "no unit of speed"), ("speed: rmp", "unknown unit"),
                       ("angle: deg, angle: rad", "two units for what is in rad")):  # fmt: skip
        with pytest.raises(UsageError, match=what):
            chosen((text,))


@pytest.mark.parametrize("word", MEANT)
def test_other_words_for_a_kind(word):
    """The option and the section of a scenario say which one is meant."""
    with pytest.raises(UsageError) as error:
        chosen((f"{word}: m",))
    assert f"Did you mean '{MEANT[word]}'?" in error.value.hint
    with pytest.raises(ScenarioError) as error:
        section({"units": {word: "m"}})
    assert f"Did you mean '{MEANT[word]}'?" in error.value.hint
    assert error.value.path == ("units", word)
    assert MEANT[word] in UNITS and word not in UNITS


def test_units_in_figures_and_their_tables(door, tmp_path):
    """0.6 * 2 pi cos(2 pi t) rad/s are 36 cos(2 pi t) rpm."""
    units = ("angle: rad, speed: rpm",)
    with look():
        made = motion(compared([read(door)], chosen(units)), "door_angle")
    labels = [axes.get_ylabel() for axes in made.axes]
    wanted = ["door angle\n(rad)", "angular velocity\n(rpm)", "angular acceleration\n(rad/s²)"]
    assert labels == wanted  # accelerations go with the angle, speeds as asked
    np.testing.assert_allclose(made.axes[1].lines[0].get_ydata()[0], 36.0, rtol=1e-9)
    words = Asked(plot=("door_angle.rate : door_angle",), table=("peak:door_angle.rate",))
    found = analysed([door], tmp_path, words, Looks(units))
    with (tmp_path / "plot_door_angle_rate_door_angle.csv").open() as file:
        titles, first = list(csv.reader(file))[:2]
    assert titles == ["door_angle [rad]", "time [s]", "door_angle.rate [rpm]"]
    assert float(first[2]) == pytest.approx(36.0, rel=1e-9)
    [value] = found.values
    assert (value.value, value.unit) == (pytest.approx(36.0, rel=1e-9), "rpm")
    with (tmp_path / "numbers.csv").open() as file:
        [row] = csv.DictReader(file)
    assert (float(row["value"]), row["unit"]) == (value.value, "rpm")


def test_units_of_a_scenario():
    units = display_units({"speed": "rpm", "angle": "rad", "energy": "kJ", "time": "ms"})
    assert units["rad/s"] == (pytest.approx(9.549296585513721), "rpm")
    assert units["rad/s^2"] == (1.0, "rad/s²")
    assert units["J"] == (pytest.approx(1e-3), "kJ")
    assert units["s"] == (pytest.approx(1e3), "ms")
    assert "m/s" not in units and "N*m" not in units


MADE_BY = {"pdf": b"/Creator (trsim)", "svg": b"<dc:title>trsim</dc:title>", "png": b"trsim"}


@pytest.fixture(scope="module")
def narrow(tmp_path_factory):
    """The same with what gives three figures: each is drawn twice of every kind."""
    path = tmp_path_factory.mktemp("narrow") / "door.h5"
    small.run(path, "output.channels=[door_angle, handle.force]", text=DOOR)
    return path


@pytest.mark.parametrize("form", MADE_BY)
def test_figures_made_again_are_the_same_to_the_byte(form, narrow, tmp_path, monkeypatch):
    first = report(narrow, tmp_path, Looks(form=form))
    pictures = {path: path.read_bytes() for path in first if path.suffix == f".{form}"}
    assert len(pictures) >= 3
    for path in pictures:
        os.utime(path, (1.0, 1.0))
    monkeypatch.setenv("SOURCE_DATE_EPOCH", "4000000000")
    assert report(narrow, tmp_path, Looks(form=form)) == first
    for path, data in pictures.items():
        assert path.stat().st_mtime > 1.0  # its own are replaced
        assert data == path.read_bytes()
        assert MADE_BY[form] in data
        assert not re.search(rb"CreationDate|<dc:date>", data)
    path, data = next(iter(pictures.items()))
    path.write_bytes(data[:20])
    with pytest.raises(UsageError, match="exists and is not a figure"):
        report(narrow, tmp_path, Looks(form=form))


def test_size_and_dots(door, tmp_path):
    from matplotlib.image import imread

    word = Asked(plot=("door_angle",))
    for size, dpi, pixels in (("127x63.5", 100, (250, 500)), ("12.7cm", 100, (None, 500)),
                              ("5 in x 2 in", None, (300, 750))):  # fmt: skip
        [path, _] = analysed([door], tmp_path, word, Looks(size=size, dpi=dpi)).files
        high, wide = imread(path).shape[:2]
        assert abs(wide - pixels[1]) <= 1 and (pixels[0] is None or abs(high - pixels[0]) <= 1)
        assert 0.005 < drawn(path) < 0.5
    assert inches("254 x 127") == (pytest.approx(10.0), pytest.approx(5.0))
    for text in ("a", "1x2x3", "5", "10kg", "3m", "-100", "100x"):
        with pytest.raises(UsageError, match="size"):
            inches(text)
    with pytest.raises(UsageError, match="dots per inch"), style.asked(Looks(dpi=5)):
        pass


def test_styles(door, tmp_path):
    (tmp_path / "mine.mplstyle").write_text(
        "# mine\nlines.linewidth: 3\naxes.prop_cycle: cycler('color', ['#ff0000', '0f0f0f'])\n"
    )
    with style.asked(Looks(style=str(tmp_path / "mine.mplstyle"))), look():
        line = motion(compared([read(door)]), "door_angle").axes[0].lines[0]
    assert (line.get_linewidth(), line.get_color()) == (3.0, "#ff0000")
    with look():  # and afterwards as before
        assert motion(compared([read(door)]), "door_angle").axes[0].lines[0].get_linewidth() == 0.8
    (tmp_path / "bad.mplstyle").write_text("lines.linewidth: 1\nlines.linewidht: 3\n")
    (tmp_path / "worse.mplstyle").write_text("lines.linewidth: thick\n")
    for name, kind, what in (("bad.mplstyle", FileError, r"bad.mplstyle:2: no setting"),
                             ("worse.mplstyle", FileError, "worse.mplstyle:1: "),
                             ("none.mplstyle", FileError, "no such file"),
                             ("slide", UsageError, "Say slides")):  # fmt: skip
        with pytest.raises(kind) as caught, style.asked(Looks(style=str(tmp_path / name))):
            pass
        assert re.search(what, caught.value.show())


def test_curves_of_a_vector_file_are_lines(door, tmp_path):
    [path, _] = analysed([door], tmp_path, Asked(plot=("door_angle",)), Looks(form="svg")).files
    assert path.suffix == ".svg" and b"<image" not in path.read_bytes()
