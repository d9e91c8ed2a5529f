import csv
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest
from matplotlib.image import imread
from matplotlib.text import Text

from tests import small
from trsim.errors import FileError
from trsim.report import analysed, report, style
from trsim.report.asked import Asked
from trsim.report.display import compared, differences, display_units, short, written
from trsim.report.figures import contact_force, contact_history, motion
from trsim.report.looks import Looks
from trsim.report.orbits import orbit
from trsim.report.style import STRETCHES, look, thinned
from trsim.report.tables import peak_loads
from trsim.store.read import read

EXPECTED = {
    *("motion_stroke", "motion_crank_angle", "drive_motor", "contact_B", "orbit_B", "impact_B"),
    *("phase_B", "phase_stroke", "phase_crank_angle", "poincare_journal", "energy", "peaks"),
    *("body_crank", "body_rod", "body_slider"),
}
COARSE = Looks(dpi=75)  # pixels are looked at in shares only
MORE = {"phase_B", "phase_crank_angle", "body_rod", "body_slider"}  # of a kind that is there too


def drawn(path):
    """Share of the pixels of a picture that are not background."""
    picture = imread(path)[..., :3]
    assert min(picture.shape[:2]) > 100
    return float(np.mean(np.any(picture < 0.9, axis=2)))


@pytest.fixture(scope="module")
def few(tmp_path_factory):
    """Two runs with a figure of each kind."""
    folder = tmp_path_factory.mktemp("few")
    two = [folder / "a.h5", folder / "b.h5"]
    for path, clearance in zip(two, ("0.5mm", "0.1mm"), strict=True):
        small.run(path, f"joints.B.clearance={clearance}", *small.FEW)
    return two


@pytest.fixture(scope="module")
def reports(paths, few, tmp_path_factory):
    """What is written of one run, and of two."""
    folder = tmp_path_factory.mktemp("figures")
    return report(paths[0], folder / "one", COARSE), report(few, folder / "two", COARSE)


@pytest.mark.parametrize("several", [False, True])
def test_every_figure_is_drawn(several, reports):
    written = reports[several]
    pictures = [path for path in written if path.suffix == ".png"]
    assert {path.stem for path in pictures} == (EXPECTED - MORE if several else EXPECTED)
    for path in pictures:
        assert 0.005 < drawn(path) < 0.5, path.name


def test_run_without_sensors_contacts_or_drives(tmp_path):
    text = """\
gravity: [0, -9.81, 0]
bodies: {bob: {mass: 1, inertia: 0.01, at: [1, 0]}}
joints: {pivot: {type: revolute, bodies: [ground, bob], at: [0, 0]}}
solver: {end: 1 s, tolerance: 1e-6}
"""
    small.run(tmp_path / "run.h5", text=text)
    written = {path.name for path in report(tmp_path / "run.h5", tmp_path, COARSE)}
    assert written == {"body_bob.png", "energy.png", "peaks.csv", "peaks.png", "index.html"}


def test_failed_run_is_reported_as_far_as_it_came(tmp_path):
    text = small.SLIDER_CRANK.replace("method: dop853", "method: rk4, force: true, step: 0.05 ms")
    small.run(tmp_path / "run.h5", *small.FEW, text=text)
    assert len(report(tmp_path / "run.h5", tmp_path / "figures", COARSE)) > 5
    [shown] = compared([read(tmp_path / "run.h5")])
    with look():
        assert "(failed)" in motion([shown], "stroke").get_suptitle()


def test_figures_have_units_and_labels(paths):
    runs = compared([read(path) for path in paths])
    assert [shown.label for shown in runs] == ["clearance at B 0.5mm", "clearance at B 0.1mm"]
    with look():
        figure = motion(runs, "crank_angle")
        labels = [axes.get_ylabel() for axes in figure.axes]
        assert labels == [
            "crank angle\n(deg)", "angular velocity\n(deg/s)", "angular acceleration\n(deg/s²)",
        ]  # fmt: skip
        assert figure.axes[-1].get_xlabel() == "time (ms)"
        texts = [text.get_text() for text in figure.legends[0].get_texts()]
        assert texts == [shown.label for shown in runs]
        curve = figure.axes[1].lines[0].get_ydata()
        np.testing.assert_allclose(curve, 30000.0, rtol=1e-9)  # 5000 rpm
        panels = contact_force(runs, "B").axes
        assert panels[0].get_ylim() == panels[1].get_ylim()


def test_orbit_shows_the_clearance_circle(paths):
    runs = compared([read(path) for path in paths])
    with look():
        axes = orbit(runs, "B").axes[:2]
    for a, radius in zip(axes, (0.5, 0.1), strict=True):
        assert a.get_aspect() == 1.0
        [circle] = a.patches
        assert circle.get_radius() == pytest.approx(radius)
        assert a.get_xlim() == a.get_ylim() == axes[0].get_xlim()


def test_contact_history_is_zero_in_flight(paths):
    [shown] = compared([read(paths[0])])
    time, force = contact_history(shown, "B")
    assert np.all(np.diff(time) > 0.0)
    events = shown.run.events
    onset, separation = (events.time[events.kind == k] for k in ("onset", "separation"))
    assert not np.any(force[np.isin(time, onset)])
    for begin, end in zip(separation, onset[1:], strict=False):
        assert not np.any(force[(time > begin) & (time < end)])
    assert force.max() == shown.run.steps("B")["contact_force"].max()


def test_peak_loads(paths, reports):
    with (reports[True][0].parent / "peaks.csv").open() as file:
        rows = list(csv.DictReader(file))
    [row] = [r for r in rows if r["element"] == "B" and r["run"].endswith("0.5mm")]
    [peak] = [p for p in read(paths[0]).peaks if p[:2] == ("B.contact_force", "largest")]
    assert (row["load"], row["unit"], row["stroke_unit"]) == ("contact force", "N", "mm")
    assert float(row["value"]) == peak.value
    assert float(row["stroke"]) == pytest.approx(1e3 * peak.stroke)
    [shown] = compared([read(paths[0])])
    loads = [(load.element, load.load) for load in peak_loads(shown)]
    assert loads == [
        *(("O", "reaction"), ("A", "reaction"), ("B", "contact force"), ("guide", "reaction")),
        ("motor", "force"),
    ]


def test_display_units_are_chosen():
    units = display_units({"angle": "rad", "force": "kN"})
    assert units["N"] == (pytest.approx(1e-3), "kN")
    assert units["rad/s"] == (1.0, "rad/s")
    assert units["m"] == (pytest.approx(1e3), "mm")
    assert display_units({"length": "deg"}).get("m") is None  # nonsense is left in SI


def test_differences_are_named():
    one = {"parameters": {"speed": "0.5 m/s"}, "joints": {"A": {"clearance": "0.1 mm"}}}
    two = {"parameters": {"speed": "1 m/s"}, "joints": {"A": {"type": "revolute"}}}
    assert differences([one, two]) == [
        "speed 0.5 m/s; clearance at A 0.1 mm",
        "speed 1 m/s; clearance at A 0",
    ]


@pytest.mark.parametrize(
    "more, told",
    [
        ({"initial": {"pivot": "20deg"}}, "initial pivot 20deg; m 1kg"),
        ({"initial": {"pivot": {"rate": 2}}}, "initial rate at pivot 2; m 1kg"),
        ({"loads": {"gust": "limit"}, "planar": True}, "loads gust limit; planar True; m 1kg"),
        ({"output": {"every": "1 ms"}}, "output every 1 ms; m 1kg"),
        ({"solver": {"end": "8 s"}, "title": "x", "report": {"units": {}}}, "end 8 s; m 1kg"),
        ({"frame": {"at": [1, 0]}, "drives": {"d": {"position": "t" * 50}}}, ""),
        ({"phases": [{"until": "1 s", "lock": ["a", "b"], "drive": {"c": "t"}}]}, ""),
        ({"events": {"e": {"when": "a > 1", "do": {"release": "b"}, "once": True}}}, ""),
        ({"bodies": {"rod": {"type": "bar"}}}, "type at rod bar; m 1kg"),
    ],
)  # fmt: skip
def test_all_that_differs_is_named_or_nothing(more, told):
    """Nothing: it would take too many words, and files are named instead."""
    labels = differences([more | {"parameters": {"m": "1kg"}}, {"parameters": {"m": "2kg"}}])
    assert labels[0] == told


def test_what_is_written_otherwise_does_not_differ():
    one = {"bodies": {"a": {"mass": "1kg", "at": [0, "200 mm"]}}, "solver": {"end": 1}}
    same = {"bodies": {"a": {"mass": 1.0, "at": [0.0, 0.2]}}, "solver": {"end": "1 s"}}
    other = {"bodies": {"a": {"mass": "2 kg", "at": [0, "0.2 m"]}}, "solver": {"end": "1000 ms"}}
    assert differences([one, same]) == ["", ""]
    assert differences([one, other]) == ["mass at a 1kg", "mass at a 2 kg"]


def test_a_law_is_named_unless_it_comes_with_the_clearance():
    law = [{"clearance": 1, "contact": "a"}, {"clearance": 2, "contact": "b"}]
    assert (
        differences([{"joints": {"B": one}} for one in law])[0]
        == "clearance at B 1; contact at B a"
    )
    law = [{"clearance": 1, "contact": "a"}, {"clearance": 2, "contact": "a"}, {}]
    assert differences([{"joints": {"B": one}} for one in law])[0] == "clearance at B 1"


def test_runs_are_told_by_files_where_words_are_too_few(tmp_path):
    """Also where one label would do without a word; numbers.csv names the file always."""
    paths = [tmp_path / "a.h5", tmp_path / "b.h5"]
    many = ("initial.O=0", "joints.B.clearance=0.1mm", "output.every=1ms", "solver.tolerance=1e-7")
    for path, sets in zip(paths, ((), many), strict=True):
        small.run(path, *small.FEW, *sets)
    assert [shown.label for shown in compared([read(path) for path in paths])] == [*map(str, paths)]
    analysed(paths, tmp_path, Asked(table=("final:stroke",)))
    with (tmp_path / "numbers.csv").open(newline="") as file:
        assert [row["file"] for row in csv.DictReader(file)] == [*map(str, paths)]


def texts(made):
    """What is drawn, by whether it is set as mathematics."""
    found = {False: set(), True: set()}
    for one in made.findobj(Text):
        text, mathematics = one._preprocess_math(one.get_text())
        found[bool(mathematics)].add(text)
    return found


def test_titles_and_files_are_shown_as_they_are_written(tmp_path):
    r"""Dollars, one or more, with `\\` or without; powers of ten at ticks are mathematics."""
    made, axes = style.panels(1)
    title, name, third = "$x^2$ and $no end", r"\$a$_b.h5", r"$\wrong{$"
    axes[0, 0].plot([1.0, 2.0], [1e-8, 1e9], label=name)
    axes[0, 0].set(yscale="log", ylabel=f"{third} ({written('N/m^1.5')})")
    made.suptitle(title)
    made.legend()
    style.save(made, tmp_path / "a.png")
    found = texts(made)
    assert found[False] >= {title, name, f"{third} (N/m¹·⁵)"}
    assert found[True] and all("mathdefault{10^{" in text for text in found[True])


@pytest.mark.parametrize("form", ["png", "pdf", "svg"])
@pytest.mark.filterwarnings("error")
def test_letters_that_the_font_has_not(form, tmp_path):
    """Boxes, without a warning of another program that names its files."""
    with style.asked(Looks(form=form)), look():
        made, axes = style.panels(1)
        axes[0, 0].set_title("振り子")
        made.suptitle("नमस्ते")
        assert style.save(made, tmp_path / "振り子").stat().st_size > 1000


def test_thinned_curve_keeps_extremes_and_ends():
    x = np.sort(np.random.default_rng(0).random(100_000))
    y = np.sin(200.0 * x)
    y[70_001], y[12_345] = 5.0, -7.0
    a, b = thinned(x, y)
    assert len(a) <= 4 * STRETCHES + 2
    assert np.all(np.diff(a) > 0.0)
    assert (b.max(), b.min(), a[0], a[-1]) == (5.0, -7.0, x[0], x[-1])


@pytest.mark.parametrize(
    "value, text",
    [(45872.4, "45872"), (-333.71, "\u2212333.7"), (1e-9, "1e\u221209"), (0.25141, "0.2514")],
)
def test_short_numbers(value, text):
    assert short(value) == text


def test_what_cannot_be_reported_is_told(paths, tmp_path):
    with pytest.raises(FileError, match="no such file"):
        report(tmp_path / "none.h5", tmp_path)
    (tmp_path / "file").write_text("")
    with pytest.raises(FileError, match="file"):
        report(paths[0], tmp_path / "file" / "folder")


def test_a_report_is_the_same_every_time_and_needs_no_solver(few, reports, tmp_path):
    """In a process of its own.  Nor pyplot, which would look for a screen."""
    code = (
        "import sys; from trsim.report import report; from trsim.report.looks import Looks; "
        f"report(sys.argv[1:3], sys.argv[3], {COARSE!r}); "
        "assert not {'numba', 'pandas', 'matplotlib.pyplot', 'trsim.solve'} & set(sys.modules)"
    )
    root = Path(__file__).parents[2]
    command = [sys.executable, "-c", code, *map(str, few), str(tmp_path)]
    subprocess.run(command, check=True, cwd=root)  # noqa: S603
    names = {path.name for path in tmp_path.iterdir()}
    assert names == {path.name for path in reports[True]}
    for path in reports[True]:
        assert (tmp_path / path.name).read_bytes() == path.read_bytes()
