"""Sweeps as figures and tables: numbers over keys, maps, bifurcations, indices of Sobol."""

import csv
from dataclasses import replace

import numpy as np
import pytest

from tests import small
from tests.analyse.studies import Case, Study
from tests.report.test_figures import drawn
from trsim.analyse.bifurcation import diagram
from trsim.analyse.cases import numbers
from trsim.analyse.outputs import scalar
from trsim.analyse.sobol import Index, Indices, places
from trsim.errors import FileError, UsageError
from trsim.report import analysed, maps, studies
from trsim.report.asked import Asked
from trsim.report.diagrams import bifurcated
from trsim.report.sobol import indexed
from trsim.report.style import look, panels


def rows(path):
    with path.open(newline="") as file:
        return list(csv.DictReader(file))


def named(found):
    return {path.name for path in found.files}


@pytest.fixture(scope="module")
def study(paths):
    keys = ("case", "joints.B.clearance")
    cases = [
        Case(f"{name}{k}", {"case": name, keys[1]: c}, path)
        for name in ("rigid", "flexible")
        for k, (c, path) in enumerate(zip((0.5e-3, 0.1e-3), paths, strict=True))
    ]
    cases.append(Case("lost", {"case": "rigid", keys[1]: 0.3e-3}, paths[0], "failed"))
    return Study(tuple(cases), keys, {"case": "-", keys[1]: "m"})


def test_numbers_of_a_study(study, tmp_path):
    found = studies.draw(study, Asked(), ["peak:B.contact_force"], tmp_path)
    assert named(found) == {"sweep.csv", "sweep_peak_B_contact_force.png"}
    table = rows(tmp_path / "sweep.csv")
    assert [row["case"] for row in table] == ["rigid0", "rigid1", "flexible0", "flexible1", "lost"]
    assert table[-1]["peak:B.contact_force [N]"] == "nan"
    expected = scalar(study.cases[1].run(), "peak:B.contact_force")[0]
    assert float(table[1]["peak:B.contact_force [N]"]) == expected
    assert found.lines == ["1 of 5 cases did not end well and are left out: lost"]


@pytest.fixture
def grid(paths):
    """Two by two cases; one of them jammed, one failed."""
    keys = ("joints.B.clearance", "a.b")
    ends = ("done", "jammed", "done", "failed")
    places = [(c, b) for c in (0.5e-3, 0.1e-3) for b in (1.0, 2.0)]
    cases = tuple(
        Case(f"{end}{k}", dict(zip(keys, place, strict=True)), paths[k % 2], end)
        for k, (place, end) in enumerate(zip(places, ends, strict=True))
    )
    return Study(cases, keys, {keys[0]: "m", "a.b": "-"})


def test_jammed_runs_are_results(grid, tmp_path):
    found = studies.draw(grid, Asked(), ["peak:B.contact_force"], tmp_path)
    given = [row["peak:B.contact_force [N]"] != "nan" for row in rows(tmp_path / "sweep.csv")]
    assert given == [True, True, True, False]
    assert found.lines[-1] == "1 of 4 cases did not end well and are left out: failed3"


def test_map(grid, tmp_path):
    word = "peak:B.contact_force"
    found = studies.draw(grid, Asked(map=(word,)), [], tmp_path)
    assert named(found) == {f"map_peak_B_contact_force.{kind}" for kind in ("png", "csv")}
    assert 0.005 < drawn(tmp_path / "map_peak_B_contact_force.png") < 0.8
    table = rows(tmp_path / "map_peak_B_contact_force.csv")
    assert [row["status"] for row in table] == ["done", "jammed", "done", "failed"]
    of = numbers(grid, [word])[word]
    place = maps.gridded(grid, of, None)
    assert (place.across, place.up) == ([0.1e-3, 0.5e-3], [1.0, 2.0])
    values = [scalar(case.run(), word)[0] for case in grid.cases]
    np.testing.assert_allclose(place.values, [[values[2], values[0]], [np.nan, values[1]]])
    assert place.ends == [["", ""], ["failed", "jammed"]]
    turned = maps.gridded(grid, of, "a.b")
    np.testing.assert_array_equal(turned.values, place.values.T)


def test_what_was_not_needed_is_drawn_as_what_is_near(grid, tmp_path):
    """A map has the number and the end of the nearest case; no other figure has the case."""
    word, spared = "peak:B.contact_force", grid.cases[2]
    some = replace(spared, status="not needed", file=tmp_path / "none.h5")
    some = replace(grid, cases=(*grid.cases[:2], some, replace(grid.cases[3], status="not needed")))
    found = studies.draw(some, Asked(map=(word,)), [word], tmp_path)
    table = rows(tmp_path / "map_peak_B_contact_force.csv")
    assert [row[f"{word} [N]"] == "nan" for row in table] == [False, False, True, True]
    assert found.lines == [
        "2 of 4 cells were not run and have the colour of the nearest one that was",
        "2 of 4 cases were not needed and are left out",
    ]
    assert [row["case"] for row in rows(tmp_path / "sweep.csv")] == ["done0", "jammed1"]
    place = maps.gridded(some, numbers(some, [word])[word], None)
    assert place.filled.tolist() == [[True, False], [True, False]]
    np.testing.assert_array_equal(place.values[:, 0], place.values[:, 1])
    assert place.ends == [["", ""], ["jammed", "jammed"]]
    with look():
        axes = panels(1)[1][0, 0]
        maps.cells(axes, "ab", "cd", place.values, place.ends, place.filled)
        assert len(axes.texts) == 2  # the numbers of those that were run
        wide = np.zeros((2, 20), bool)
        wide[1, 3:] = True
        maps.cells(axes, ["a"] * 20, "cd", np.ones((2, 20)), [[""] * 20] * 2, wide)
        assert len(axes.lines[0].get_xdata()) == 23  # a dot for each


def test_maps_that_make_no_sense(grid, study, paths, tmp_path):
    word = "peak:B.contact_force"
    of = numbers(grid, [word])[word]
    twice = replace(grid, cases=(*grid.cases, grid.cases[0]))
    three = replace(grid, keys=(*grid.keys, "c.d"))
    for plan, over, what in ((twice, None, "several cases"), (three, None, "varies 3"),
                             (grid, "c.d", "does not sweep")):  # fmt: skip
        with pytest.raises(UsageError, match=what):
            maps.gridded(plan, of, over)
    with pytest.raises(UsageError, match="--map is not for result files"):
        analysed(paths, tmp_path / "o", Asked(map=(word,)))


def test_a_curve_for_each_family_in_order_of_the_swept_key(study):
    one = studies.shown(study)
    y = np.array([1.0, 2.0, 3.0, 4.0, np.nan])
    with look():
        axes = studies.figure(study, one, "peak:B.contact_force", "N", y, None).axes[0]
    assert axes.get_xlabel() == "B clearance (mm)"
    curves = {line.get_label(): line.get_xydata() for line in axes.lines}
    np.testing.assert_allclose(curves["rigid"][[0, 2]], [[0.1, 2.0], [0.5, 1.0]])
    np.testing.assert_allclose(curves["flexible"], [[0.1, 4.0], [0.5, 3.0]])
    with look():
        words_axis = studies.figure(study, one, "impacts:B", "-", y, "case").axes[0]
    assert [t.get_text() for t in words_axis.get_xticklabels()] == ["rigid", "flexible"]


def test_usual_numbers(study):
    found = studies.usual(studies.shown(study))
    assert found[0] == "peak:B.contact_force"
    assert "fluctuation:stroke.rate" in found


def test_samples_have_a_panel_for_each_key(study):
    keys = ("a.b", "joints.B.clearance")
    cases = tuple(
        Case(case.name, {"a.b": float(k), keys[1]: case.values[keys[1]]}, case.file)
        for k, case in enumerate(study.cases)
    )
    sampled = Study(cases, keys, {"a.b": "-", keys[1]: "m"}, "monte_carlo", 5)
    with look():
        y = np.arange(5.0)
        made = studies.figure(sampled, studies.shown(study), "impacts:B", "-", y, None)
    assert [axes.get_xlabel() for axes in made.axes] == ["a b (-)", "B clearance (mm)"]


def test_bifurcation(study, tmp_path):
    """A table over another key is one of trsim, too, and is replaced."""
    older = b"case,another [mm],period,x,y\r\n"
    (tmp_path / "bifurcation_journal_y.csv").write_bytes(older)
    found = studies.draw(study, Asked(bifurcation=("journal:y",)), [], tmp_path)
    assert named(found) == {"bifurcation_journal_y.png", "bifurcation_journal_y.csv"}
    assert 0.002 < drawn(tmp_path / "bifurcation_journal_y.png") < 0.5
    table = rows(tmp_path / "bifurcation_journal_y.csv")
    points = sum(len(c.run().poincare["journal"].x) for c in study.cases[:4])
    assert len(table) == points
    assert found.lines[-1] == "1 of 5 cases did not end well and are left out: lost"
    with look():
        upper, lower = bifurcated(studies.shown(study), diagram(study, "journal:y")).axes
    assert (upper.get_ylabel(), lower.get_xlabel()) == (
        "B eccentricity y\n(mm)", "B clearance (mm)",
    )  # fmt: skip


def test_sobol(paths, tmp_path):
    """Of eight rows made of two runs: which one is where the first key is small."""
    from tests.analyse.studies import of_blocks

    rng = np.random.default_rng(3)
    a, b = rng.random((8, 2)), rng.random((8, 2))
    plan = of_blocks(a, b, ("joints.B.clearance", "solver.tolerance"), 8)
    cases = tuple(
        Case(c.name, c.values, paths[int(c.values["joints.B.clearance"] > 0.5)]) for c in plan.cases
    )
    plan = Study(cases, plan.keys, plan.units, "sobol", 8)
    found = studies.draw(plan, Asked(sobol=("peak:B.contact_force",)), [], tmp_path)
    assert named(found) == {f"sobol_peak_B_contact_force.{kind}" for kind in ("png", "csv")}
    table = rows(tmp_path / "sobol_peak_B_contact_force.csv")
    f_a, f_b, f_ab = ((block[:, 0] > 0.5).astype(float) for block in (a, b, b))
    total = np.mean((f_a - f_ab) ** 2) / (2.0 * np.var(np.concatenate([f_a, f_b])))
    assert float(table[0]["total"]) == pytest.approx(total)
    assert float(table[1]["total"]) == 0.0
    assert found.lines[1].endswith("(ought to have none: noise)")


def test_rows_that_were_not_needed_are_no_part_of_a_design():
    from tests.analyse.studies import of_blocks

    drawn = np.random.default_rng(3).random((16, 4))
    plan = of_blocks(drawn[:, :2], drawn[:, 2:], ("a.b", "c.d"), 16)
    cases = tuple(replace(case, status="done" if k % 16 < 8 else "not needed")
                  for k, case in enumerate(plan.cases))  # fmt: skip
    table = places(replace(plan, cases=cases), cases)
    assert [[case.name for case in block] for block in table] == [
        [f"{name}{k:04d}" for k in range(8)] for name in ("A", "B", "AB1_", "AB2_")
    ]


def test_the_title_of_sobol_indices_is_in_display_units(study):
    one = studies.shown(study)
    index = Index("a.b", *np.full(6, 0.5), False)
    of = Indices("range:stroke", "m", 8, 0, 0.0123, 1.745e-05, (index,), ((8, [0.5], [0.5]),), 0.0)
    with look():
        title = indexed(of, "", one).get_suptitle()
        plain = indexed(of._replace(unit="-"), "", one).get_suptitle()
    assert title.endswith("\nmean 12.3, standard deviation 0.0175 mm")
    assert plain.endswith("\nmean 0.0123, standard deviation 1.75e\u221205")


# --- studies whose cases are not all alike ---------------------------------------------------


@pytest.fixture(scope="module")
def uneven(paths, tmp_path_factory):
    """Cases: without the key; two with it; one of these ends early, has no section, no sensor."""
    folder, key = tmp_path_factory.mktemp("uneven"), "joints.B.clearance"
    text = small.SLIDER_CRANK.partition("poincare:")[0].replace("  stroke: {joint: guide}\n", "")
    small.run(folder / "early.h5", "solver.end=1ms", text=text)
    (folder / "cut.h5").write_bytes(paths[0].read_bytes()[:3000])
    cases = (
        Case("cut", {"case": "fast", key: 0.2e-3}, folder / "cut.h5"),
        Case("rigid", {"case": "rigid"}, paths[0]),
        Case("fast0", {"case": "fast", key: 0.5e-3}, paths[0]),
        Case("fast1", {"case": "fast", key: 0.1e-3}, paths[1]),
        Case("early", {"case": "fast", key: 0.9e-3}, folder / "early.h5"),
        Case("gone", {"case": "fast", key: 0.7e-3}, folder / "none.h5", "missing"),
    )
    return Study(cases, ("case", key), {"case": "-", key: "m"})


def test_cases_without_a_number_do_not_stop_the_others(uneven, tmp_path):
    asked = ["range:stroke", "peak:B.contact_force@2ms..", "dispersion:journal@2.9ms.."]
    found = studies.draw(uneven, Asked(), asked, tmp_path)
    table = rows(tmp_path / "sweep.csv")
    assert [row["joints.B.clearance [m]"] for row in table][:3] == ["0.0002", "", "0.0005"]
    assert [row["range:stroke [m]"] == "nan" for row in table] == [True, *[False] * 3, True, True]
    assert [line for line in found.lines if line.startswith("cut: is truncated: ")] == [
        found.lines[0]
    ]
    told = "\n".join(found.lines)
    assert "early: no channel named 'stroke'" in told
    assert "early: no row lies in '@2ms..'; it has rows from 0 to 0.001 s" in told
    assert "rigid: without joints.B.clearance, left out of figures over it" in found.lines
    assert found.lines[-1] == "1 of 6 cases have no result and are left out: gone"
    with pytest.raises(UsageError, match="no channel named 'strke'"):
        studies.draw(uneven, Asked(), ["peak:strke"], tmp_path)
    only = Study(uneven.cases[:1], uneven.keys, uneven.units)
    with pytest.raises(FileError, match="truncated"):
        studies.draw(only, Asked(), ["range:stroke"], tmp_path)


def test_a_number_made_of_nothing_is_told(study, tmp_path):
    word = "dispersion:journal@2.995ms.."
    found = studies.draw(study, Asked(), [word], tmp_path)
    assert found.lines[0] == f"rigid0, rigid1, flexible0, flexible1: nothing to make {word} of"


def test_a_case_without_a_number_keeps_its_place_on_the_axis(uneven):
    one, y = studies.shown(uneven), np.array([np.nan, 1.0, 2.0, 3.0, np.nan, np.nan])
    with look():
        made = studies.figure(uneven, one, "range:stroke", "m", y, None)
        axes = made.axes[0]
    crosses = axes.lines[-1]
    np.testing.assert_allclose(np.sort(crosses.get_xdata()), [0.2, 0.7, 0.9])
    assert axes.get_xlim()[0] < 0.1 < 0.9 < axes.get_xlim()[1]
    assert axes.get_ylim()[0] > 1000.0  # rigid, without the key, is not there
    assert "without a number" in [text.get_text() for text in made.legends[0].get_texts()]


def test_bifurcation_of_cases_that_are_not_alike(uneven, tmp_path):
    found = studies.draw(uneven, Asked(bifurcation=("journal",)), [], tmp_path)
    told = "\n".join(found.lines)
    assert "early: no section 'journal'" in told
    assert "rigid: without joints.B.clearance" in told
    assert {row["case"] for row in rows(tmp_path / "bifurcation_journal_x.csv")} == {
        "fast0",
        "fast1",
    }
    assert np.isnan(next(v.value for v in found.values if v.run == "early"))
    with look():
        upper, _ = bifurcated(studies.shown(uneven), diagram(uneven, "journal")).axes
    assert upper.get_xlim()[0] < 0.1 < 0.9 < upper.get_xlim()[1]


def test_sobol_indices_of_the_named_cases_that_have_some(paths, tmp_path):
    from tests.analyse.studies import of_blocks

    rng, keys = np.random.default_rng(3), ("joints.B.clearance", "solver.tolerance")
    plan = of_blocks(rng.random((8, 2)), rng.random((8, 2)), keys, 8)
    fast = [Case(c.name, {"case": "fast", **c.values}, paths[int(c.values[keys[0]] > 0.5)])
            for c in plan.cases]  # fmt: skip
    rigid = Case("rigid", {"case": "rigid"}, paths[0])
    mixed = Study((rigid, *fast), ("case", *keys), {}, "sobol", 8)
    found = studies.draw(mixed, Asked(sobol=("peak:B.contact_force",)), [], tmp_path)
    assert named(found) == {f"sobol_peak_B_contact_force_fast.{kind}" for kind in ("png", "csv")}
    told = "rigid: nothing is sampled: no Sobol indices of peak:B.contact_force"
    assert told in found.lines
    with pytest.raises(UsageError, match="nothing is sampled"):
        studies.draw(
            replace(mixed, cases=(rigid,)), Asked(sobol=("peak:B.contact_force",)), [], tmp_path
        )


def test_every_run_is_read_once(study, tmp_path, monkeypatch):
    read_files = []
    whole = Case.run
    monkeypatch.setattr(Case, "run", lambda case: read_files.append(case.name) or whole(case))
    words = ["peak:B.contact_force", "range:stroke", "impacts:B"]
    studies.draw(study, Asked(), words, tmp_path)
    assert sorted(read_files) == sorted([*[c.name for c in study.cases[:4]], study.cases[0].name])


# --- what is asked for -----------------------------------------------------------------------
