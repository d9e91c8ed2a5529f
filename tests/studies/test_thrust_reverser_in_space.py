"""The published study in space: its cases on a fairing without chains, which is fast."""

import csv
import json
import re
from pathlib import Path
from types import SimpleNamespace

import numpy as np
import pytest
import yaml

from tests.report.test_figures import drawn
from tests.sweeps.test_go import here
from trsim.assemble.assemble import assemble
from trsim.errors import UsageError
from trsim.report.animation.motion import motion
from trsim.report.style import look
from trsim.scenario.load import load
from trsim.solve.simulate import simulate
from trsim.store.hdf5 import write
from trsim.store.read import read
from trsim.studies.numbers import number
from trsim.studies.rules import CONFIRMED, CONTRADICTED, UNDETERMINED
from trsim.studies.runs import Runs
from trsim.studies.single import (
    above,
    apart,
    below,
    greatest,
    multiple,
    near,
    opposite,
    steps,
    unlike,
)
from trsim.studies.study import paper
from trsim.studies.thrust_reverser import STUDY
from trsim.studies.thrust_reverser.claims.spatial import CLAIMS, CONCLUSIONS
from trsim.studies.thrust_reverser.figures import FIGURES, mechanism, sticking
from trsim.studies.thrust_reverser.figures.canvas import Canvas, view
from trsim.studies.thrust_reverser.peaks import PUBLISHED, ends, peaks
from trsim.sweeps.go import go
from trsim.sweeps.plan import plan
from trsim.sweeps.study import study

SCENARIOS = Path(__file__).parents[2] / "scenarios" / "thrust_reverser"
SUPPLY = {"stiffness": 3.2e6, "damping": 4e3, "mass": 2.0}
ENDS = ((-0.628, 0.527), (0.0, 0.82), (0.628, 0.527))  # m, y and z of the actuators


def scene():
    """A fairing on rails, pushed by three actuators, driven by a load as that of the doors."""
    rails = {
        f"rail_{k}": {
            "type": "bushing",
            "bodies": ["ground", "fairing"],
            "at": at,
            "stiffness": [0, 8e5, 2.4e6],
        }
        for k, at in enumerate([[x, y, 0] for x in (-0.272, 0.028) for y in (-0.72, 0.72)])
    }
    actuators = {f"actuator_{k}": {"type": "actuator", "bodies": ["ground", "fairing"],
                                   "points": [[-0.852, y, z], [-0.252, y, z]], "sign": -1,
                                   "velocity": f"speed_{k}", "stiffness": 1.6e6, "damping": 2e3}
                 for k, (y, z) in enumerate(ENDS, 1)}  # fmt: skip
    load = {
        "type": "applied_load",
        "body": "fairing",
        "at": [0.128, -0.01, 0.453],
        "direction": [1, 0, 0],
        "force": "way*smoothstep((stroke - 0.15)/0.325)",
    }
    return {
        "planar": False,
        "parameters": {"way": 4090.0, "shaft": 0.53, **{f"speed_{k}": 0.42 for k in (1, 2, 3)}},
        "bodies": {"fairing": {"mass": 50, "inertia": [18.1, 5.6, 17.9], "at": [0.128, 0, 0.497]}},
        "sensors": {"stroke": {"type": "displacement", "bodies": ["ground", "fairing"],
                               "at": [0.128, 0, 0.497], "axis": [1, 0, 0]}},
        "drives": actuators,
        "forces": {**rails, "load": load},
        "solver": {"end": "0.5/0.42", "tolerance": 1e-6},
        "output": {"every": "0.5/0.42/200", "channels": ["stroke", *actuators]},
    }  # fmt: skip


def cases():
    """The cases of the study, under their names."""
    supplied = {f"actuator_{k}": {"stiffness": 3.2e6, "damping": 4e3, "supply": SUPPLY}
                for k in (1, 2, 3)}  # fmt: skip
    shaft = {"shaft_1_3": {"type": "sync_shaft", "actuators": [*supplied], "stiffness": "shaft",
                           "ratio": 754}}  # fmt: skip
    stalls = {name: {**of, "stall": 3e3} for name, of in supplied.items()}
    found = {"spatial_420": {}}
    for k in (1, 2, 3):
        for v in (418, 419, 421, 422):
            found[f"spatial_{k}_{v}"] = {"parameters": {f"speed_{k}": v / 1000}}
    for v in (418, 420, 422):
        found[f"spatial_resisted_{v}"] = {"parameters": {"speed_2": v / 1000, "way": -4090.0}}
    for name, k in (("", 0.53), ("_softer", 0.176), ("_stiffer", 1.76), ("_without", 0)):
        found[f"spatial_shaft{name}"] = {"parameters": {"speed_2": 0.418, "shaft": k},
                                         "drives": supplied, "forces": shaft}  # fmt: skip
    grid = {"parameters.speed_2": [f"{v} mm/s" for v in sticking.SPEEDS],
            "parameters.shaft": [f"{k} N*m/rad" for k in sticking.STIFFNESSES]}  # fmt: skip
    found["spatial_jam"] = {"drives": stalls, "forces": shaft, "sweep": grid}
    return found


@pytest.fixture(scope="module")
def folder(tmp_path_factory):
    place = tmp_path_factory.mktemp("space")
    text = json.dumps({**scene(), "cases": cases()})  # which YAML reads, too
    (place / "space.yaml").write_text(text)
    planned = plan(str(place / "space.yaml"), (), "one")
    list(go(planned, place / "study", "one", here))
    return place / "study"


@pytest.fixture(scope="module")
def runs(folder):
    return Runs(folder, STUDY.grids)


@pytest.fixture(scope="module")
def made(folder, tmp_path_factory):
    """The page of the small study, its figures 24 and of when it sticks."""
    page = tmp_path_factory.mktemp("page")
    wanted = [one for one in FIGURES if one.number in ("24", "25 until it sticks")]
    paper(STUDY, folder, page, figures=wanted)
    return page


def column(*values):
    return np.array(values, dtype=float)[:, None]


@pytest.mark.parametrize(
    ("rule", "holds", "fails"),
    [
        (steps(1), (0, 20, 40), (0, 20, 25)),
        (steps(-1), (40, -20, -40), (40, 20, 15)),
        (above(), (1, 2, 3), (1, 3, 3.02)),
        (below(), (2, 3, 1), (2, 1, 0.995)),
        (near(0.05), (1.0, 1.04), (1.0, 1.06)),
        (apart(), (10, 5, 9), (10, 5, 7)),
        (opposite(), (1, 2, 2, 1), (1, 2, 3, 4)),
        (multiple(10.0), (3, 31), (3, 29)),
        (unlike(0.01), (1.0, 1.0, 1.02), (1.0, 1.005, 1.0)),
        (greatest(above(), 2), (1, 2, 3, 0), (1, 3, 2, 3)),
    ],
)
def test_rules_of_single_runs(rule, holds, fails):
    assert rule.judge(column(*holds)).verdict == CONFIRMED
    assert rule.judge(column(*fails)).verdict == CONTRADICTED
    assert rule.words and rule.judge(column(*holds)).told


def test_the_grid_is_that_of_its_scenario():
    one = yaml.safe_load((SCENARIOS / "spatial_jam.yaml").read_text())["sweep"]
    whole = yaml.safe_load((SCENARIOS / "paper.yaml").read_text())["cases"]["spatial_jam"]
    assert whole["sweep"] == one
    names = [case.name for case in plan(str(SCENARIOS / "spatial_jam.yaml")).cases]
    assert list(sticking.CASES) == [f"spatial_jam,{name}" for name in names]


def test_jammed_runs_are_results(folder, runs):
    found = study(folder)
    jammed = [case for case in found.cases if case.status == "jammed"]
    assert jammed and not any(case.failed for case in found.cases)
    assert not runs.missing
    member = runs.stated(sticking.case(408, "0"))
    assert member.run.attributes["status"] == "jammed"
    assert number(member, "summary:time").value < 1.0
    rows = ends(runs)
    assert len(rows) == 30
    assert sum(row[4] == "jammed" for row in rows) == len(jammed)


def table(path):
    with path.open(newline="", encoding="utf-8") as file:
        return list(csv.DictReader(file))


def test_every_claim_is_decided(made):
    rows = {(row["claim"], row["reading"]): row for row in table(made / "claims.csv")}
    for claim in (*CLAIMS, *CONCLUSIONS):
        for reading in claim.readings:
            row = rows[claim.key, reading.name]
            assert row["verdict"] in (CONFIRMED, CONTRADICTED), row
            assert (row["members"], bool(row["runs"])) == ("1", True)
    assert rows["displacement", ""]["verdict"] == UNDETERMINED  # of a case that was not run


def test_verdicts_follow_the_mechanics(made):
    """The forces follow the second difference of the strokes; who lags under a pull has more."""
    rows = table(made / "claims.csv")
    of = {(row["claim"], row["reading"]): row["verdict"] for row in rows}
    for key in ("one_rises", "one_falls", "two_rises", "two_falls", "two_opposite",
                "three_mirrors", "sticks_earlier", "shaft_adjusts"):  # fmt: skip
        assert {verdict for (claim, _), verdict in of.items() if claim == key} == {CONFIRMED}, key
    assert of["advice_faster", "418 and 422 mm/s"] == CONFIRMED
    assert of["advice_faster", "418 and 422 mm/s, a load that resists"] == CONTRADICTED
    assert of["advice", "418 mm/s, against one speed"] == CONTRADICTED


def test_the_nine_peaks(runs, made):
    rows = peaks(runs)
    assert [row[2] for row in rows] == [force for odd in (1, 2, 3) for force in PUBLISHED[odd]]
    best = max(number(runs.stated(f"spatial_2_{v}"), "largest:actuator_1.force").value
               for v in (418, 419, 421, 422))  # fmt: skip
    _, _, theirs, ours, off, share, speed = rows[3]
    assert (ours, speed) == (best, 422)
    assert (off, share) == pytest.approx((best - theirs, 100.0 * (best / theirs - 1.0)))
    assert len(table(made / "peaks.csv")) == 9
    assert len(table(made / "sticking.csv")) == 30


def test_numbers_of_several_actuators(runs):
    member = runs.stated("spatial_2_422")
    each = [number(member, f"peak:actuator_{k}.force") for k in (1, 2, 3)]
    assert number(member, "most:actuator_?.force") == max(each)
    with pytest.raises(UsageError, match="no channel fits"):
        number(member, "most:motor_?.force")
    vector = member.channel("actuator_1.reaction")
    across = np.hypot(vector[:, 1], vector[:, 2]).max() / np.abs(vector[:, 0]).max()
    assert number(member, "sideways:actuator_1.reaction").value == pytest.approx(across)


def test_the_page_has_them(made):
    text = (made / "index.html").read_text(encoding="utf-8")
    assert re.findall(r'(?:src|href)="(?!data:image/png;base64,|#)', text) == []
    assert text.count("data:image/png") == 2
    for word in ("Nine peaks", "When it sticks", "full stroke", "claim-advice"):
        assert word in text
    for path in made.glob("*.png"):
        assert 0.005 < drawn(path) < 0.8, path.name


def test_all_directions_have_one_sign(runs):
    """The force of the fairing on the actuator; its X is what `force` tells, hold-back positive."""
    [one] = [one for one in FIGURES if one.number == "23"]
    member = runs.stated("spatial_420")
    with look():
        axes = one.made(runs).axes
    for k, line in enumerate(axes[0].get_lines(), 1):
        found = member.channel(f"actuator_{k}.force")
        assert line.get_ydata() == pytest.approx(found, abs=1e-3 * np.abs(found).max())
    for a, column in zip(axes, range(3), strict=True):
        for k, line in enumerate(a.get_lines(), 1):
            assert line.get_ydata() == pytest.approx(
                -member.channel(f"actuator_{k}.reaction")[:, column]
            )


# --- the picture -----------------------------------------------------------------------------


def test_the_nearer_is_painted_over_the_farther():
    canvas = Canvas(view(0.0, 0.0))  # from +x
    for x, colour in ((1.0, "#ff0000"), (-1.0, "#0000ff")):
        canvas.sheet(np.array([[[x, 0, 0], [x, 1, 0]], [[x, 0, 1], [x, 1, 1]]]), colour)
    found = []
    axes = SimpleNamespace(add_collection=found.append, set_aspect=str, autoscale_view=int,
                           axis=str)  # fmt: skip
    canvas.paint(axes)
    far, near = found[0].get_facecolors()
    assert far[2] > 0.5 > far[0] and near[0] > 0.5 > near[2]
    assert canvas.seen(np.array([0.0, 1.0, 0.0])) == pytest.approx([1.0, 0.0, 0.0])


def test_the_mechanism_is_drawn(tmp_path):
    """From a run of the real one, broken off early."""
    sets = ["solver.end=4e-3", "solver.tolerance=1e-3", "output.every=2e-3",
            'output.channels=["*.position", "*.rotation"]']  # fmt: skip
    scenario = load(SCENARIOS / "spatial_synchronous.yaml", sets)
    built = assemble(scenario)
    write(tmp_path / "a.h5", scenario, built, simulate(scenario, built))
    with look():
        figure = mechanism.figure_22([SimpleNamespace(run=read(tmp_path / "a.h5"))])
    shafts = [mesh.points for mesh, colour in mechanism.parts(motion(read(tmp_path / "a.h5")), 0)
              if colour == mechanism.SHAFT]  # fmt: skip
    lowest, highest = np.vstack(shafts).min(axis=0), np.vstack(shafts).max(axis=0)
    ends = np.array([point for n in (1, 2, 3)
                     for point in scenario.drives[f"actuator_{n}"].points[:1]])  # fmt: skip
    assert (lowest <= ends.min(axis=0)).all() and (highest >= ends.max(axis=0)).all()
    assert lowest == pytest.approx(ends.min(axis=0), abs=0.05)
    assert highest == pytest.approx(ends.max(axis=0), abs=0.05)
    written = [text.get_text() for axes in figure.axes for text in axes.texts]
    assert written == ["1", "2", "3", "1", "2", "3", "4", "5"] * 2
    figure.savefig(tmp_path / "a.png")
    assert 0.02 < drawn(tmp_path / "a.png") < 0.6
