"""The published study: rules on made-up numbers, numbers of runs, figures, page and command."""

import csv
import dataclasses
import re
import shutil
from pathlib import Path
from types import SimpleNamespace

import numpy as np
import pytest
import yaml

from tests import small
from tests.report.test_figures import drawn
from tests.sweeps.test_go import here
from trsim.analyse.fluctuation import fluctuation
from trsim.analyse.outputs import scalar
from trsim.cli import main
from trsim.errors import FileError, UsageError
from trsim.report.display import Shown
from trsim.report.page import Cell, Line, Points, Section, Table, Text, page
from trsim.report.style import look, panels
from trsim.store.read import read
from trsim.studies.claim import (
    BOOKKEEPING,
    CHOSEN,
    GEOMETRY,
    INDEPENDENT,
    LAW,
    TUNED,
    WORTH,
    Claim,
    Reading,
)
from trsim.studies.drawing import UNITS, enlarged
from trsim.studies.judge import OF_LAWS, Row, shown
from trsim.studies.numbers import number, word
from trsim.studies.rules import (
    CONFIRMED,
    CONTRADICTED,
    UNDETERMINED,
    Judged,
    alike,
    departing,
    exact,
    falling,
    interval,
    ratio,
    rising,
    steadier,
    undecided,
    within,
)
from trsim.studies.runs import Member, Runs
from trsim.studies.study import paper
from trsim.studies.tables import tally
from trsim.studies.thrust_reverser import STUDY
from trsim.studies.thrust_reverser.claims import CLAIMS
from trsim.studies.thrust_reverser.figures import FIGURES, chain
from trsim.sweeps.go import go
from trsim.sweeps.plan import plan

SCENARIOS = Path(__file__).parents[2] / "scenarios"
MEMBERS = np.array([1.0, 1.02, 0.99, 1.01])  # what an ensemble of four spreads by
WILD = np.array([1.0, 3.0, 0.3, 2.0])


def cases(*means, spread=MEMBERS):
    """Numbers (cases, members), each case with its own order of the same spread."""
    return np.array([m * np.roll(spread, k) for k, m in enumerate(means)])


@pytest.mark.parametrize(
    ("rule", "values", "verdict"),
    [
        (rising(), cases(1.0, 2.0, 3.0), CONFIRMED),
        (rising(), cases(1.0, 3.0, 2.0), CONTRADICTED),
        (rising(), cases(1.0, 1.1, 1.2, spread=WILD), UNDETERMINED),
        (rising(0.5), cases(1.0, 2.0), CONFIRMED),
        (rising(0.5), cases(1.0, 1.2), CONTRADICTED),
        (rising(), cases(0.0, 1.0), UNDETERMINED),
        (falling(), cases(3.0, 2.0, 1.0), CONFIRMED),
        (falling(), cases(1.0, 2.0), CONTRADICTED),
        (falling(), cases(2.0, 1.0, spread=WILD), UNDETERMINED),
        (falling(0.1), cases(1.0, 0.8), CONFIRMED),
        (falling(0.1), cases(1.0, 0.96), CONTRADICTED),
        (ratio(2.5, 3.0), cases(1.0, 2.75), CONFIRMED),
        (ratio(2.5, 3.0), cases(1.0, 2.0), CONTRADICTED),
        (ratio(2.5, 3.0), cases(1.0, 2.5), UNDETERMINED),
        (alike(0.2), cases(1.0, 1.1), CONFIRMED),
        (alike(0.05), cases(1.0, 1.2), CONTRADICTED),
        (alike(0.02), cases(1.0, 1.0), UNDETERMINED),
        (within(0.5, 1.5, "x"), cases(1.0, 1.1), CONFIRMED),
        (within(1.5, 2.5, "x"), cases(1.0, 2.0), CONTRADICTED),
        (within(1.0, 2.5, "x"), cases(1.0, 2.0), UNDETERMINED),
        (steadier(), cases(1.0, 2.0, 1.0, 1.1), CONFIRMED),
        (steadier(), cases(1.0, 1.1, 1.0, 2.0), CONTRADICTED),
        (steadier(), cases(1.0, 1.1, 1.0, 1.1), UNDETERMINED),
        (departing(), cases(1.0, 1.1, 1.0, 2.0), CONFIRMED),
        (departing(), cases(1.0, 1.1, 2.0, 1.0), CONFIRMED),  # the other way, and farther
        (departing(), cases(1.0, 2.0, 1.0, 1.1), CONTRADICTED),
        (departing(), cases(2.0, 1.0, 1.1, 1.0), CONTRADICTED),
        (departing(), cases(1.0, 1.1, 1.0, 1.12), UNDETERMINED),
        (departing(), cases(1.0, 0.0, 1.0, 2.0), UNDETERMINED),
        (exact(0.9, 1.1, "x"), np.array([[1.0]]), CONFIRMED),
        (exact(0.9, 1.1, "x"), np.array([[2.0]]), CONTRADICTED),
        (undecided("no"), cases(1.0), UNDETERMINED),
    ],
)
def test_verdicts(rule, values, verdict):
    found = rule.judge(values)
    assert found.verdict == verdict
    assert found.told and rule.words


def test_scatter_is_no_effect():
    """Two cases that scatter far, but alike in the mean, are no farther apart for it."""
    calm, wild = cases(1.0, 1.05), np.array([[1.0, 1.0, 1.0, 1.0], [2.0, 0.5, 2.0, 0.5]])
    assert departing().judge(np.concatenate([calm, wild])).verdict == UNDETERMINED


@pytest.mark.parametrize(
    "rule", [rising(), falling(), ratio(1.0, 3.0), steadier(), departing(), alike(0.1)]
)
def test_one_run_proves_nothing(rule):
    assert rule.judge(cases(1.0, 2.0, 1.5, 1.6)[:, :1]).verdict == UNDETERMINED


def test_holding_is_counted():
    values = np.array([[1.0, 1.0, 1.0, 1.0], [2.0, 2.0, 2.0, 0.9]])
    assert rising().judge(values)[2:] == (3, 4)
    assert falling().judge(values)[2:] == (1, 4)


def test_interval_is_student_s():
    assert interval(np.array([1.0, 2.0, 3.0])) == pytest.approx(
        (2.0, -0.484138, 4.484138), abs=1e-6
    )
    assert shown(np.array([1.0, 2.0, 3.0]), 1.0, "N") == "2.0 \u00b1 2.5 N"
    assert shown(np.array([12345.0, 12445.0]), 1.0, "-") == "12400 \u00b1 640"
    assert shown(np.array([0.5]), 1e3, "mm") == "500 mm"


# --- the study -------------------------------------------------------------------------------


@pytest.fixture(scope="module")
def scenario():
    return yaml.safe_load((SCENARIOS / "thrust_reverser/paper.yaml").read_text())


def test_claims_are_of_the_study(scenario):
    series = [s for claim in CLAIMS for reading in claim.readings for s in reading.series]
    assert {s.case.partition(",")[0] for s in series} - {LAW} <= set(scenario["cases"])
    for one in series:
        if one.case != LAW:
            word(one.word)
    keys = [claim.key for claim in CLAIMS]
    assert len(set(keys)) == len(keys)
    for claim in CLAIMS:
        assert claim.section in STUDY.sections and claim.worth in WORTH
        assert {reading.worth for reading in claim.readings} <= {"", *WORTH}
        names = [reading.name for reading in claim.readings]
        assert len(set(names)) == len(names)


def test_the_documents_count_the_claims_there_are(scenario):
    text = (SCENARIOS.parent / "docs/thrust_reverser.md").read_text(encoding="utf-8")
    [counts] = re.findall(r"Of (\d+) claims in (\d+) readings (\d+) are confirmed, "
                          r"(\d+) contradicted, (\d+) undetermined", text)  # fmt: skip
    claims, readings, *verdicts = map(int, counts)
    assert (claims, readings) == (len(CLAIMS), sum(len(claim.readings) for claim in CLAIMS))
    assert sum(verdicts) == readings
    lines = re.findall(r"^\| (.+) \| (\d+) \| (\d+) \| (\d+) \|$", text, re.MULTILINE)
    named = {text or "independent of our choices": worth for worth, text in WORTH.items()}
    told = {named[name]: sum(map(int, found)) for name, *found in lines if name in named}
    each = [worth for of in worths().values() for worth in of.values()]
    assert told == {worth: each.count(worth) for worth in WORTH}
    [runs] = re.findall(r": (\d+) runs\)", text)
    alone = [case for case in scenario["cases"].values() if case.get("sweep", "") is None]
    assert int(runs) == 8 * (len(scenario["cases"]) - len(alone) - 1) + len(alone) + 30


def worths():
    """What agreement with each reading of a claim is worth, by its key."""
    return {c.key: {r.name: r.worth or c.worth for r in c.readings} for c in CLAIMS}


def test_what_shares_its_data_with_the_fit_is_no_finding():
    """The nine peaks were fitted: the same forces give trends, orderings and advice."""
    of = worths()
    for key in ("one_rises", "one_falls", "two_rises", "two_falls", "two_opposite",
                "one_alike_each", "one_above_each", "two_alike_each", "advice", "advice_faster",
                "sticks_earlier"):  # fmt: skip
        assert {*of[key].values()} == {TUNED}, key
    assert of["speed_triple"] == {"B": CHOSEN, "A and B": CHOSEN, "at A": INDEPENDENT}


def test_geometry_and_bookkeeping_are_told_apart():
    of = worths()
    assert of["phase_range"]["eccentricity at B"] == GEOMETRY
    assert of["phase_range"]["velocity at B"] == INDEPENDENT
    assert {*of["displacement"].values()} == {GEOMETRY}
    assert {*of["coulomb"].values()} == {BOOKKEEPING}


def test_every_worth_has_a_line_of_its_own_in_the_tally():
    claims = [
        Claim("a", "1", "", "a", rising(), (Reading("", ()), Reading("g", (), worth=GEOMETRY))),
        Claim("b", "1", "", "b", rising(), (Reading("", ()),), TUNED),
        Claim("c", "1", "", "c", rising(), (Reading("", ()),), BOOKKEEPING),
    ]
    verdicts = iter([CONFIRMED, CONTRADICTED, CONFIRMED, UNDETERMINED])
    rows = [Row(claim, reading, Judged(next(verdicts), "", 1, 1), (), ())
            for claim in claims for reading in claim.readings]  # fmt: skip
    found = {line.cells[0].text: [cell.text for cell in line.cells[1:]]
             for line in tally(rows).lines}  # fmt: skip
    assert found == {
        "independent of our choices": ["1", "0", "0"],
        "by construction": ["1", "0", "0"],
        "geometry": ["0", "1", "0"],
        "bookkeeping": ["0", "0", "1"],
    }


def test_every_figure_of_the_study_is_drawn(scenario):
    panels = {"1": "", "3": "ab", "7": "ab", "8": "", "9": "abcdef", "10": "abcd", "11": "abcd",
              "12": "abcd", "13": "ab", "14": "abcdefgh", "15": "ab", "16": "abcd", "17": "ab",
              "18": "abcde", "19": "ab", "20": "ab", "21": "", "22": "", "23": "abc",
              "24": "abc", "25": "abc", "26": "abc"}  # fmt: skip
    found = {one.number: one.panels for one in FIGURES}
    assert {number: found.get(number) for number in panels} == panels
    used = {case for one in FIGURES for case in one.names}
    used |= {s.case for claim in CLAIMS for r in claim.readings for s in r.series} - {LAW}
    assert {name.partition(",")[0] for name in used} == set(scenario["cases"])
    for claim in CLAIMS:
        for digits in re.findall(r"\d+", claim.figure):
            assert digits in found


def test_the_members_of_the_study(scenario):
    """The first is as stated; no two are the same."""
    play = np.array(scenario["sweep"]["parameters.play"])
    assert play[0] == 1.0 and np.abs(play - 1.0).max() == pytest.approx(0.02)
    varied = [values for key, values in scenario["sweep"].items() if "." in key]
    members = [*zip(*varied, strict=True)]
    assert len(set(members)) == 8
    assert members[0] == (1, "0 mm", "1e-6*loose")


CHAINS = {"ideal": "ideal", "a_03": "clearance_a_0.3mm", "b_03": "clearance_b_0.3mm",
          "a_03_fine": "clearance_a_0.3mm", "b_03_fine": "clearance_b_0.3mm"}  # fmt: skip


@pytest.fixture(scope="module")
def folder(tmp_path_factory):
    """A study of three cases of two members, a third of a stroke; two of them for figures."""
    place = tmp_path_factory.mktemp("study") / "scenarios"
    place.mkdir()
    for path in (SCENARIOS / "thrust_reverser").glob("*.yaml"):
        shutil.copy(path, place)
    text = {
        "sweep": {"method": "zip", "initial.guide": ["0 mm", "1 mm"], "parameters.play": [1, 1.02]},
        "parameters": {"play": 1},
        "cases": {
            name: {"extends": f"{file}.yaml", "solver": {"end": "0.32 s", "tolerance": 1e-4}}
            for name, file in CHAINS.items()
        },
    }
    (place / "short.yaml").write_text(yaml.safe_dump(text))
    planned = plan(str(place / "short.yaml"), (), "one")
    list(go(planned, place.parent / "study", "one", here))
    return place.parent / "study"


@pytest.fixture(scope="module")
def page_folder(folder, tmp_path_factory):
    made = tmp_path_factory.mktemp("page")
    wanted = [one for one in FIGURES if one.number in ("8", "11", "12", "13", "15")]
    written = paper(STUDY, folder, made, figures=wanted)
    assert {path.name for path in written} == {
        *("index.html", "claims.csv", "numbers.csv"),
        *(f"figure_{k}.png" for k in (8, 11, 12, 13)),
    }
    return made


def test_apart_is_measured_at_equal_strokes(folder):
    runs = Runs(folder)
    ideal, later = runs.stated("ideal"), runs.of("ideal", 1)
    assert later.channel("stroke")[0] - ideal.channel("stroke")[0] == pytest.approx(1e-3)
    assert number(ideal, "apart:door_angle", ideal).value == 0.0
    assert number(later, "apart:door_angle", ideal).value < 1e-4
    assert 1e-4 < number(runs.stated("a_03"), "apart:door_angle", ideal).value < 1e-2
    with pytest.raises(UsageError):
        number(ideal, "apart:door_angle")


def test_a_run_whose_energy_book_does_not_close_counts_in_nothing(folder, tmp_path, monkeypatch):
    monkeypatch.setattr("trsim.studies.runs.Member.missed", 0.0)
    assert not Runs(folder).aside
    faulty = property(lambda member: 0.01 if (member.case, member.index) == ("a_03", 1) else 0.0)
    monkeypatch.setattr("trsim.studies.runs.Member.missed", faulty)
    paper(STUDY, folder, tmp_path, figures=())
    numbers = table(tmp_path / "numbers.csv")
    assert {n["member"] for n in numbers if n["case"] in ("a_03", "b_03")} == {"0"}
    assert "misses 10 mJ" in (tmp_path / "index.html").read_text(encoding="utf-8")


def table(path):
    with path.open(newline="", encoding="utf-8") as file:
        return list(csv.DictReader(file))


def test_every_number_has_a_run_file(page_folder, folder):
    numbers, claims = table(page_folder / "numbers.csv"), table(page_folder / "claims.csv")
    assert numbers and claims
    for row in numbers:
        assert row["file"] == OF_LAWS or (folder / row["file"]).is_file()
        assert float(row["value"]) is not None and row["word"]
    for row in claims:
        files = [name for name in row["runs"].split(" ") if name]
        of = {
            n["file"]
            for n in numbers
            if (n["claim"], n["reading"]) == (row["claim"], row["reading"])
        }
        assert set(files) == of
        assert bool(files) == bool(row["numbers"])
        assert row["verdict"] in (CONFIRMED, CONTRADICTED, UNDETERMINED)


def test_what_was_not_run_is_undetermined(page_folder):
    rows = table(page_folder / "claims.csv")
    of = {(row["claim"], row["reading"]): row for row in rows}
    assert of["place_velocity", "0.5 mm"]["verdict"] == UNDETERMINED
    assert of["place_velocity", "0.5 mm"]["decided_by"] == "not run: a_05, b_05"
    assert of["coulomb", ""]["verdict"] == CONFIRMED
    assert of["overturn", ""]["members"] == "2"
    assert len(rows) == sum(len(claim.readings) for claim in CLAIMS)


def test_the_page_stands_alone(page_folder):
    text = (page_folder / "index.html").read_text(encoding="utf-8")
    assert re.findall(r'(?:src|href)="(?!data:image/png;base64,|#)', text) == []
    assert "<script" not in text and "@import" not in text and "url(" not in text
    anchors = re.findall(r'id="([^"]+)"', text)
    assert len(set(anchors)) == len(anchors)
    assert set(re.findall(r'href="#([^"]+)"', text)) <= set(anchors)
    assert text.count("data:image/png") == 4
    for claim in CLAIMS:
        assert f'id="claim-{claim.key}"' in text


def test_panels_have_the_letters_of_the_study(folder):
    runs = Runs(folder)
    with look():
        for one in FIGURES:
            if one.panels and one.names and runs.has(*one.names):
                titles = [axes.get_title("left") for axes in one.made(runs).axes]
                letters = [title[1] for title in titles if title.startswith("(")]
                assert "".join(letters) == one.panels, one.number


def test_what_is_enlarged_fills_its_panel():
    with look():
        axes = panels(1)[1]
    t = np.linspace(0.0, 1.0, 1001)
    axes[0, 0].plot(t, 100.0 * t)
    axes[0, 0].plot(t, np.where(np.abs(t - 0.35) < 1e-3, -7.0, 0.0))
    enlarged(axes[0, 0], 0.3, 0.4)
    assert axes[0, 0].get_xlim() == (0.3, 0.4)
    low, high = axes[0, 0].get_ylim()
    assert (low, high) == pytest.approx((-7.0 - 2.35, 40.0 + 2.35))


def test_what_is_enlarged_is_the_member_as_stated(scenario):
    """A case with fine rows has its motion from the case it is named after."""
    for name, case in scenario["cases"].items():
        if name.endswith("_fine"):
            assert case["extends"] == name.removesuffix("_fine")
            assert set(case) <= {"extends", "sweep", "output", "solver"} and case["sweep"] is None
            tolerance = case.get("solver", {}).get("tolerance", "1e-6*loose")
            assert tolerance == scenario["sweep"]["solver.tolerance"][0]
            assert ("solver" in case) == ("flexible" in name)


def test_figures_are_drawn(page_folder):
    for path in page_folder.glob("*.png"):
        assert 0.005 < drawn(path) < 0.5, path.name


def test_the_chain_is_drawn_where_the_run_has_it(folder, tmp_path):
    """At its start as its scenario draws it; B moves aft with the fairing, 0.5 m/s."""
    shown = Shown(Runs(folder).stated("ideal").run, "", UNITS)
    with look():
        figure = chain.figure_1([shown] * 9)
        figure.savefig(tmp_path / "a.png")
    begun, touched, _ = figure.axes[:3]
    joints = [[tuple(line.get_xydata()[0]) for line in axes.lines if line.get_marker() == "o"]
              for axes in (begun, touched)]  # fmt: skip
    a, p, q, b = joints[0]
    assert np.hypot(*np.subtract(p, a)) == pytest.approx(0.220, abs=1e-5)
    assert np.hypot(*np.subtract(q, b)) == pytest.approx(0.195, abs=1e-4)
    assert b == pytest.approx((-0.242, 0.241), abs=1e-5)
    assert joints[1][0] == pytest.approx(a, abs=1e-5)
    assert joints[1][3] == pytest.approx((-0.092, 0.241), abs=1e-3)
    assert len(figure.axes) == 7
    assert 0.02 < drawn(tmp_path / "a.png") < 0.5


def test_the_same_every_time(page_folder, folder, tmp_path):
    paper(STUDY, folder, tmp_path, figures=FIGURES[:0])
    for name in ("claims.csv", "numbers.csv"):
        assert (tmp_path / name).read_bytes() == (page_folder / name).read_bytes()


def test_the_command(folder, tmp_path, capsys, monkeypatch):
    bare = dataclasses.replace(STUDY, figures=())
    monkeypatch.setattr("trsim.studies.thrust_reverser.STUDY", bare)
    for arguments, code in ((["--paper", "thrust-reverser", str(folder)], 0),
                            (["--paper", "thrust-reverser", str(folder), str(folder)], 2),
                            (["--paper", "crew-door", str(folder)], 2),
                            (["--paper", "thrust-reverser", "--compare", str(folder)], 2),
                            (["--paper", "thrust-reverser", str(tmp_path)], 7)):  # fmt: skip
        with pytest.raises(SystemExit) as ended:
            main(["report", *arguments, "-o", str(tmp_path / "made")])
        told = capsys.readouterr()
        assert ended.value.code == code, told.err
        assert "Traceback" not in told.err
    assert (tmp_path / "made" / "index.html").is_file()


def test_a_folder_that_is_no_study(tmp_path, monkeypatch):
    with pytest.raises(FileError):
        paper(STUDY, tmp_path, tmp_path / "page")
    plain = SimpleNamespace(keys=("joints.A.clearance",), cases=())
    monkeypatch.setattr("trsim.sweeps.study.study", lambda folder: plain)
    with pytest.raises(UsageError, match="not of a study"):
        paper(STUDY, tmp_path, tmp_path / "page")


# --- numbers ---------------------------------------------------------------------------------


@pytest.fixture(scope="module")
def member(tmp_path_factory):
    path = tmp_path_factory.mktemp("member") / "a.h5"
    small.run(path)
    return Member("a", 0, path, read(path))


def test_numbers_of_a_run(member):
    run, t = member.run, member.run.time
    peak = max(abs(p.value) for p in run.peaks if p.channel == "B.contact_force")
    assert number(member, "peak:B.contact_force") == (peak, "N")
    x = run.channel("stroke")
    low, high = float(x.min()) - 1.0, float(x.max()) + 1.0
    whole = f"@stroke={low}..{high}"
    assert 0.98 * peak < number(member, f"peak:B.contact_force{whole}").value <= peak
    rate = run.channel("crank_angle.rate")
    assert number(member, f"fluctuation:crank_angle.rate{whole}").value == pytest.approx(
        fluctuation(t, rate, 0.0, 1.0), rel=1e-12
    )
    points = run.poincare["journal"]
    spread = np.sqrt(np.var(points.x) + np.var(points.y))
    assert number(member, "dispersion:journal").value == pytest.approx(spread)
    assert number(member, "scaled:journal").value == pytest.approx(spread / 0.5e-3)
    for text in ("impacts:B", "flight:B", "mean:B.contact_force"):
        assert number(member, text) == scalar(run, text)
    assert number(member, "range:stroke") == (pytest.approx(np.ptp(x)), "m")
    assert number(member, f"place:stroke{whole}").value == pytest.approx(x.max())
    assert number(member, "orbit:B").value > 0.0
    assert 0.0 < number(member, "flight:B").value < 1.0


def test_the_free_motions_of_a_run(folder):
    """The door of the ideal chain moves by the drive or against spring and lug: 12 unknowns, 11
    rows; a pin with play holds none of its two."""
    runs = Runs(folder)
    assert number(runs.stated("ideal"), "mechanism:mobility") == (1.0, "-")
    assert number(runs.stated("b_03"), "mechanism:mobility") == (3.0, "-")
    with pytest.raises(UsageError):
        number(runs.stated("ideal"), "mechanism:mobilty")


def test_what_was_not_judged_before(scenario):
    """Two freedoms and what makes one motion of them, Coulomb, rod and load, joints and load."""
    of = {claim.key: claim for claim in CLAIMS}
    for key in ("two_freedoms", "unique", "unique_needs", "coulomb_converges", "rod_load",
                "rod_force_fluctuation", "number_acceleration", "load_force"):  # fmt: skip
        assert of[key].readings, key
    words = {s.word for r in of["load_force"].readings for s in r.series}
    assert all(word.startswith("fluctuation:") and "contact_force" in word for word in words)
    origins = {case: STUDY.origin(case) for case in scenario["cases"] if "kicked" in case}
    assert origins == {"kicked": "ideal", "no_spring_kicked": "no_spring",
                       "no_lug_kicked": "no_lug", "neither_kicked": "neither"}  # fmt: skip


def test_windows_are_of_stroke(member):
    x, force = member.run.channel("stroke"), member.run.channel("motor.force")
    middle = float(np.median(x))
    found = number(member, f"mean:motor.force@stroke={middle}..{float(x.max())}")
    assert found == (pytest.approx(force[x >= middle].mean()), "N*m")
    assert np.isnan(number(member, "mean:motor.force@stroke=5..6").value)


@pytest.mark.parametrize(
    "text", ["peek:B.contact_force", "peak", "peak:B.contact_fors", "mean:stroke@0..1"]
)
def test_unknown_words(member, text):
    with pytest.raises((UsageError, KeyError)):
        number(member, text)


# --- the page --------------------------------------------------------------------------------


def test_a_page_escapes_what_it_is_told():
    nasty = '<script>"&'
    blocks = [
        Text(nasty),
        Points([nasty]),
        Table([nasty], [Line([Cell(nasty, aside=nasty)], anchor="a")]),
    ]
    text = page(nasty, [nasty], [Section("s", nasty, blocks)])
    assert "<script" not in text
    assert text.count("&lt;script&gt;&quot;&amp;") == 10
