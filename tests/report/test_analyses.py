"""Analyses as figures and tables: what is written, what it says, what makes no sense."""

import csv
import json
from pathlib import Path

import numpy as np
import pytest

from tests import small
from tests.report.test_figures import drawn
from tests.report.test_plots import DOOR
from trsim.analyse.compare import curve, difference
from trsim.analyse.outputs import scalar
from trsim.analyse.scaling import Line
from trsim.errors import FileError, UsageError
from trsim.report import analysed, exponents, spectra
from trsim.report.asked import Asked, file_name, words
from trsim.report.compared import chosen, figure
from trsim.report.display import compared
from trsim.report.keys import in_words, readable
from trsim.report.style import look
from trsim.store.read import read


def rows(path):
    with path.open(newline="") as file:
        return list(csv.DictReader(file))


def named(found):
    return {path.name for path in found.files}


@pytest.mark.parametrize("several", [False, True])
def test_portrait(several, paths, tmp_path):
    """A force over a coordinate that turns back, of several runs, in a window too."""
    given = paths if several else paths[:1]
    words = ("stroke:B.normal_force", "crank_angle.rate:slider.velocity.x@1ms..")
    found = analysed(given, tmp_path, Asked(portrait=words))
    names = {"portrait_stroke_B_normal_force.png",
             "portrait_crank_angle_rate_slider_velocity_x_1ms_to.png"}  # fmt: skip
    assert named(found) == names
    for word, what in (("stroke", "over what"), ("stroke:strake", "no channel"),
                       ("stroke:slider.velocity", "3 components")):  # fmt: skip
        with pytest.raises(UsageError, match=what):
            analysed(given, tmp_path, Asked(portrait=(word,)))


@pytest.mark.parametrize("several", [False, True])
def test_spectrum(several, paths, tmp_path):
    given = paths if several else paths[:1]
    found = analysed(given, tmp_path, Asked(spectrum=("crank_angle.rate@1ms..",)))
    assert named(found) == {f"spectrum_crank_angle_rate_1ms_to.{kind}" for kind in ("png", "csv")}
    picture, table = sorted(found.files, key=lambda path: path.suffix, reverse=True)
    assert 0.005 < drawn(picture) < 0.5
    assert len({row["run"] for row in rows(table)}) == len(given)
    assert "Hann window" in found.lines[0]
    with look():
        runs = compared([read(path) for path in given])
        one = [spectra.of_channel(s.run, "stroke", spectra.window(s.run)) for s in runs]
        axes = spectra.figure(runs, one, "stroke").axes[0]
    assert axes.get_ylabel() == "stroke\n(mm/\u221aHz)"
    assert axes.get_xlabel() == "frequency (Hz)"


def test_a_spectrum_without_most_of_the_motion_says_so(tmp_path):
    """Half a period in 0.5 s: segments of 0.11 s have next to nothing of it."""
    small.run(tmp_path / "run.h5", text=DOOR)
    found = analysed([tmp_path / "run.h5"], tmp_path, Asked(spectrum=("door_angle",)))
    run = read(tmp_path / "run.h5")
    one = spectra.of_channel(run, "door_angle", spectra.window(run))
    rms = np.std(run.channel("door_angle"))
    [text] = [line for line in found.lines if "lacks" in line]
    assert f"lacks {one.lacks:.0%} of the variance of the rows, " in text
    assert f"whose rms about a straight line is {rms:.4g} rad" in text
    assert "segments of 0.11 s" in text
    with look():
        title = spectra.figure(compared([run]), [one], "door_angle").get_suptitle()
    assert f"lacks {one.lacks:.0%} of the variance, in motion slower than 0.11 s" in " ".join(
        title.split()
    )


def test_a_single_stroke_has_no_exponent(paths, tmp_path):
    found = analysed(paths, tmp_path, Asked(lyapunov=("stroke",)))
    assert named(found) == {"lyapunov_stroke.png", "parting.png"}
    assert "undetermined: " in found.lines[0]
    assert all(np.isnan(value.value) for value in found.values[:2])
    assert "both runs" in found.lines[2]


def test_told_exponents():
    grows = exponents.Exponent(0.9, 0.1, "grows", "", np.arange(9.0), np.zeros(9), None, 3, 0.1,
                               1.0, 50)  # fmt: skip
    assert exponents.in_words(grows) == "0.9 +- 0.1 1/s, 3 dimensions, delay 0.1 s, 50 pairs"
    assert exponents.in_short(grows) == "0.9 \u00b1 0.1 1/s"


def test_the_legend_of_exponents_fits_and_a_line_is_told_where_there_is_one(paths):
    runs = compared([read(path) for path in paths])
    reason = "the series is too short: " + "of all that it would take there is but little " * 3
    none = exponents.Exponent(np.nan, np.nan, "undetermined", reason, np.zeros(0), np.zeros(0),
                              None, 0, np.nan, np.nan, 0)  # fmt: skip
    k = np.arange(9.0)
    grows = none._replace(value=0.9, half=0.1, verdict="grows", reason="", time=k, curve=k,
                          fit=Line(2, 8, 1.0, 0.0, 0.0))  # fmt: skip
    for each, dashed in (([none, none], False), ([none, grows], True)):
        with look():
            made = exponents.figure(runs, each, ["a", "label " * 30], "Neighbours", "y (-)")
            made.canvas.draw()
        assert ("dashed" in made.get_suptitle()) is dashed
        [legend] = made.legends
        box, whole = legend.get_window_extent(), made.bbox
        assert box.x0 >= whole.x0
        assert box.x1 <= whole.x1
        assert "too short" not in "".join(text.get_text() for text in legend.get_texts())
    assert reason in exponents.in_words(none)


def test_compare(paths, tmp_path):
    asked = Asked(compare=True, channels=("stroke*",), against="crank_angle")
    found = analysed(paths, tmp_path, asked)
    assert "compare_stroke_rate.png" in named(found)
    [row] = [r for r in rows(tmp_path / "compare.csv") if r["channel"] == "stroke"]
    a, b = (read(path).channel("stroke") for path in paths)
    k = np.argmax(np.abs(b - a))
    assert float(row["largest difference"]) == pytest.approx((b - a)[k], rel=1e-6)
    assert float(row["at"]) == read(paths[0]).channel("crank_angle")[k]
    assert row["apart from"] == "nan"  # they differ by design, not by chance
    runs = compared([read(path) for path in paths])
    assert "motor.force" in chosen(runs, ())
    with pytest.raises(UsageError, match="no common channel fits"):
        chosen(runs, ("strke",))
    with pytest.raises(UsageError, match="nothing to compare"):
        analysed(paths[:1], tmp_path, Asked(compare=True))


def test_overlay(paths, tmp_path):
    time = read(paths[0]).time
    x = read(paths[0]).channel("stroke")
    lines = [f"{1e3 * a!r},{1e3 * (b + 0.002)!r}" for a, b in zip(time, x, strict=True)]
    lines = [line.replace("np.float64(", "").replace(")", "") for line in lines]
    (tmp_path / "old.csv").write_text("\n".join(["time [ms],stroke [mm]", *lines]))
    word = f"{tmp_path / 'old.csv'}:stroke"
    found = analysed(paths[:1], tmp_path / "out", Asked(overlay=(word,)))
    assert named(found) == {"overlay_old_stroke.png", "overlay_old_stroke.csv"}
    assert found.values[0].value == pytest.approx(-0.002)
    with pytest.raises(UsageError, match="which channel"):
        analysed(paths[:1], tmp_path, Asked(overlay=("old.csv",)))


@pytest.mark.parametrize("coarse", [False, True])
def test_a_coarse_table_is_points(coarse, paths):
    runs = compared([read(path) for path in paths[:1]])
    given = curve(runs[0].run, "stroke")
    named = [("table", given, None), ("run", given, difference("stroke", "m", given, given))]
    with look():
        upper, lower = figure(runs, "stroke", "", named, coarse).axes
    markers = [line.get_marker() for line in (*upper.lines, lower.lines[0])]
    assert markers == (["o", "None", "o"] if coarse else ["None"] * 3)
    assert (upper.lines[0].get_linestyle() == "None") is coarse


def test_against_time_is_the_usual_thing(paths, tmp_path):
    usual, told = (
        analysed(paths, tmp_path / name, Asked(compare=True, channels=("stroke",), against=name))
        for name in ("", "time")
    )
    assert [v.value for v in told.values] == [v.value for v in usual.values]


def test_table_of_numbers(paths, tmp_path):
    asked = Asked(table=("final:stroke,impacts:B", "peak:B.contact_force"))
    found = analysed(paths, tmp_path, asked)
    table = rows(tmp_path / "numbers.csv")
    assert len(table) == len(found.values) == 6
    expected = scalar(read(paths[1]), "peak:B.contact_force")[0]
    assert float(table[-1]["value"]) == expected
    with pytest.raises(UsageError, match="twice"):
        words(["a:b", "a:b"])


def test_what_does_not_fit_is_refused(paths, tmp_path):
    (tmp_path / "plan.json").write_text("{}")  # the folder of a sweep
    with pytest.raises(UsageError, match="--sobol is not for result files"):
        analysed(paths, tmp_path / "o", Asked(sobol=("a:b",)))
    with pytest.raises(UsageError, match="--spectrum is not for a sweep") as error:
        analysed([tmp_path], tmp_path / "o", Asked(spectrum=("stroke",)))
    assert str(Path("cases") / "*.h5") in error.value.hint
    assert f"`trsim run {tmp_path} CASE` makes one" in error.value.hint
    with pytest.raises(UsageError, match="not the only thing given"):
        analysed([tmp_path, *paths], tmp_path / "o", Asked())
    with pytest.raises(FileError, match="file"):
        (tmp_path / "file").write_text("")
        analysed(paths, tmp_path / "file" / "o", Asked(table=("final:stroke",)))


@pytest.mark.parametrize(
    "asked, what",
    [
        (Asked(over="joints.B.clearance"), "--over is not for result files"),
        (Asked(against="stroke"), "--against goes with --compare or --overlay"),
        (Asked(against="stroke", table=("final:stroke",)), "--against goes with"),
        (Asked(channels=("x*",)), "--channels goes with --compare"),
        (Asked(channels=("x*",), overlay=("a.csv:x",)), "--channels goes with --compare"),
    ],
)
def test_an_option_that_would_do_nothing_is_refused(asked, what, paths, tmp_path):
    with pytest.raises(UsageError, match=what):
        analysed(paths, tmp_path / "o", asked)
    assert not (tmp_path / "o").exists()


def test_an_option_that_would_do_nothing_to_a_sweep_is_refused(tmp_path):
    (tmp_path / "plan.json").write_text("{}")
    with pytest.raises(UsageError, match="--over goes with"):
        analysed([tmp_path], tmp_path / "o", Asked(over="a.b", sobol=("final:stroke",)))


def test_names():
    assert file_name("spectrum", "B.force.x@0.1..2") == "spectrum_B_force_x_0_1_to_2"
    assert in_words("peak:B.contact_force@0.3..") == "peak of B contact force (0.3..)"
    assert readable("joints.B.clearance") == "B clearance"


def test_the_same_every_time(paths, tmp_path):
    stroke = ("stroke",)
    asked = Asked(spectrum=("stroke",), compare=True, channels=stroke, table=("final:stroke",))
    first, second = (analysed(paths, tmp_path / name, asked) for name in "ab")
    assert [p.read_bytes() for p in first.files] == [p.read_bytes() for p in second.files]
    assert json.dumps(first.lines) == json.dumps(second.lines)


@pytest.mark.filterwarnings("error::UserWarning")
def test_the_spectrum_of_what_does_not_move_is_drawn(paths, tmp_path):
    """A logarithmic axis has no value to show, and a command would say so in Python's words."""
    told = analysed([paths[0]], tmp_path, Asked(spectrum=("slider.position.y",)))
    assert "slider.position.y: rms 0 m" in told.lines[0]
    assert (tmp_path / "spectrum_slider_position_y.png").exists()
