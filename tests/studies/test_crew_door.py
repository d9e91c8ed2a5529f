"""The page of the crew door: what it speaks of is there, and what it says follows from the runs."""

import csv
import json
import shutil
from pathlib import Path

import numpy as np
import pytest
import yaml

from tests.sweeps.test_go import here
from trsim.api.result import Result
from trsim.studies import STUDIES, load
from trsim.studies.crew_door import STUDY, checks
from trsim.studies.crew_door.side_view import LEAN, world
from trsim.studies.numbers import number, word
from trsim.studies.runs import Runs
from trsim.studies.single import apart_by, bounded, differ, grows, other_signs, part_of
from trsim.studies.study import paper
from trsim.sweeps.go import go
from trsim.sweeps.plan import plan

SCENARIOS = Path(__file__).parents[2] / "scenarios"
OTHER = json.loads((Path(__file__).parents[1] / "data" / "crew_door_prototype.json").read_text())
RATES = ("opening.rate", "yoke.angular_velocity.x")
# what is asked of the runs here: written in less time than all that the study records
CHANNELS = [
    "latch_angle",
    "opening",
    "*.force",
    "hinge.*_load",
    "opening.rate",
    "yoke.angular_velocity",
    *checks.WANTED[1:],
]


def one(*values):
    return np.array(values)[:, None]


@pytest.mark.parametrize(
    ("rule", "yes", "no"),
    [
        (bounded(1.0, 2.0, ""), (1.0, 2.0), (1.5, 2.1)),
        (apart_by(1.0, 2.0, 1.0, "N"), (3.0, -4.5), (3.0, 2.0)),
        (differ(1.0, "N"), (3.0, 1.5), (3.0, 3.5)),
        (other_signs(), (3.0, -0.1), (3.0, 0.1)),
        (part_of(0.1), (-0.2, 3.0), (-0.4, 3.0)),
        (grows(0.1), (1.0, 1.2, 1.4), (1.0, 1.2, 1.25)),
    ],
)
def test_rules(rule, yes, no):
    assert rule.judge(one(*yes)).verdict == "confirmed"
    assert rule.judge(one(*no)).verdict == "contradicted"


def test_every_study_has_a_word():
    assert {load(name).title for name in STUDIES} and load("crew-door") is STUDY


def test_statements_and_figures_are_of_cases_that_are_run():
    cases = yaml.safe_load((SCENARIOS / "crew_door/door.yaml").read_text())["cases"]
    assert {name.partition(",")[0] for name in STUDY.cases} <= {*cases}
    assert {case for tight in checks.TIGHT for case in tight[:2]} <= {*cases}
    for claim in STUDY.claims:
        assert claim.section in STUDY.sections
        for reading in claim.readings:
            for series in reading.series:
                word(series.word)
    keys = [claim.key for claim in STUDY.claims]
    assert len({*keys}) == len(keys)
    numbers = [figure.number for figure in STUDY.figures]
    assert len({*numbers}) == len(numbers)


@pytest.fixture(scope="module")
def folder(tmp_path_factory):
    """The opened door alone, and a little of the lifting: a study with most of it missing."""
    place = tmp_path_factory.mktemp("door") / "scenarios"
    shutil.copytree(SCENARIOS / "crew_door", place)
    whole = yaml.safe_load((place / "door.yaml").read_text())
    kept = {name: whole["cases"][name] for name in ("opened", "three_men", "wind_60kt", "running")}
    kept["running"]["sweep"] = {"parameters.foot": ["0 mm"], "parameters.stair": [1, 2, 3, 4, 5, 6]}
    beside = {"stair": 6, "foot": "-200 mm"}
    kept["beside"] = {"extends": "opened_man.yaml", "parameters": beside}
    # each to where the roller has met the guide
    for name, gap, end in (("path_inner", "0 mm", "3.9 s"), ("path_inner_gap", "1.3 mm", "3 s")):
        kept[name] = {
            "extends": "lifting_path.yaml",
            "solver": {"end": end},
            "output": {"every": "0.3 s"},
            "parameters": {"stop1_gap": gap},
        }
    text = {"output": {"channels": CHANNELS}, "cases": kept}
    (place / "short.yaml").write_text(yaml.safe_dump(text, sort_keys=False))
    list(go(plan(str(place / "short.yaml"), (), "one"), place.parent / "study", "one", here))
    return place.parent / "study"


@pytest.fixture(scope="module")
def page(folder, tmp_path_factory):
    made = tmp_path_factory.mktemp("page")
    wanted = [one for one in STUDY.figures if one.number in ("36", "23")]
    written = {path.name for path in paper(STUDY, folder, made, figures=wanted)}
    assert written == {"index.html", "claims.csv", "numbers.csv", "cases.csv", "critical.csv"}
    return made


def rows(path):
    with path.open(newline="") as file:
        return list(csv.DictReader(file))


def test_what_was_run_is_judged(page):
    verdicts = {(r["claim"], r["reading"]): r["verdict"] for r in rows(page / "claims.csv")}
    assert verdicts["wire", ""] == verdicts["rod_idle", "one man running"] == "confirmed"
    assert verdicts["gap_angle", "static path"] == "confirmed"
    assert verdicts["inertia", "70 to 94.5 deg"] == "undetermined"  # not run here
    text = (page / "index.html").read_text()
    for part in ("Critical values over all cases", "How every case ended", "not run: "):
        assert part in text


def test_numbers_are_those_of_the_runs(folder, page):
    runs = Runs(folder, STUDY.grids, STUDY.book)
    path = runs.stated("path_inner")
    latch, guide = path.channel("latch_angle"), path.channel("fwd_guide.normal_force")
    first = number(path, "begins:fwd_guide.normal_force@latch_angle=0.01..1.9")
    assert first.unit == "rad"
    assert first.value == latch[np.flatnonzero(guide > 1.0)[0]]
    assert np.isnan(number(path, "begins:wire.force@latch_angle=0..2").value)
    force = path.channel("handle.force")
    turned = number(path, "turns:handle.force@latch_angle=0.5..1.9").value
    assert np.isnan(turned) and (force[latch > 0.5] > 0.0).all()
    assert number(path, "status:limit").value == 0.0 and number(path, "status:done").value == 1.0
    men = {r["quantity"]: r for r in rows(page / "critical.csv") if r["extreme"] == "largest"}
    assert men["wire.force"]["case"] == "three_men"
    assert float(men["wire.force"]["value"]) == pytest.approx(
        runs.stated("three_men").channel("wire.force").max(), rel=1e-9
    )
    ended = {r["case"]: r for r in rows(page / "cases.csv")}
    assert ended["opened"]["status"] == "done" and len(ended) == 12


# --- the same runs against a separate program for the same data (tests/test_crew_door.py) ------


def case(folder, name):
    """A run of the study."""
    return Result(Runs(folder, STUDY.grids, STUDY.book).stated(name).file)


def test_men_on_the_stairs(folder):
    theirs = OTHER["running"]
    for stair in (1, 6):
        r = case(folder, f"running,foot=0mm,stair={stair}")
        assert r["wire.force"][-1] == pytest.approx(theirs[f"step_{stair}"], rel=0.01)
    r = case(folder, "beside")
    assert r["hinge.floating_load"][-1] == pytest.approx(theirs["largest_hinge"], rel=0.01)
    r, theirs = case(folder, "three_men"), OTHER["three_men"]
    assert r["wire.force"][-1] == pytest.approx(theirs["wire"], rel=0.01)
    assert r["hinge.locating_load"][-1] == pytest.approx(theirs["hinge_fwd"], rel=0.01)
    assert r["hinge.floating_load"][-1] == pytest.approx(theirs["hinge_aft"], rel=0.01)


def latches_at_onset(r, contact):
    """Angles of the latch where a contact begins, deg: between two rows it turns evenly."""
    events = r.run.events
    begins = events.time[(events.element == contact) & (events.kind == "onset")]
    return np.degrees(np.interp(begins, r.time, r["latch_angle"]))


def test_first_contact_and_the_gap(folder):
    """The roller meets the guide 5 deg of the latch earlier with a gap of 1.3 mm at Stop1."""
    met = {}
    for name in ("path_inner", "path_inner_gap"):
        r = case(folder, name)
        [met[name]] = latches_at_onset(r, "fwd_guide")
        assert (r["wire.force"] == 0.0).all() and (r["fwd_landing.force"] == 0.0).all()
    stop1 = case(folder, "path_inner").number("peak:fwd_stop1.normal_force")
    assert stop1 == pytest.approx(OTHER["lifting"]["stop1"], rel=0.02)
    assert met["path_inner"] == pytest.approx(28.0, abs=0.5)
    assert met["path_inner"] - met["path_inner_gap"] == pytest.approx(5.0, abs=0.5)


def test_rates_of_a_path_are_largest_in_a_row(folder):
    """Where the roller comes to the guide, between two rows, the path has two speeds."""
    r = case(folder, "path_inner")
    for name in RATES:
        assert r.number(f"peak:{name}") == pytest.approx(np.abs(r[name]).max(), rel=1e-12)


def test_the_side_view_leans_as_the_door_does():
    top = world([(0.0, 2.0)])[0]
    assert np.arctan2(-top[1], top[2]) == pytest.approx(LEAN)
