"""Sweeps that keep the numbers of their cases: those that result files give, to the bit."""

import math
import shutil
from pathlib import Path

import numpy as np
import pytest

from tests import small
from tests.sweeps.test_go import B, here
from trsim.analyse.bifurcation import diagram
from trsim.analyse.cases import numbers
from trsim.analyse.outputs import scalar
from trsim.api.cases import again
from trsim.api.hearing import Listener
from trsim.api.study import Sweep
from trsim.assemble.assemble import assemble
from trsim.errors import FileError, ScenarioError, UsageError
from trsim.scenario.load import loads
from trsim.solve.simulate import simulate
from trsim.store.live import Gathered, Taking
from trsim.store.read import read
from trsim.sweeps.go import engine, go
from trsim.sweeps.plan import plan
from trsim.sweeps.study import study
from trsim.sweeps.summary import OF_CHANNELS, OF_CONTACTS, Kept, packed, record, unpacked

ASKED = ("peak:B.contact_force@0.5 ms..2 ms", "mean:stroke@crank_angle=10 deg..30 deg")
SWEEP = f"""
sweep: {{keep: summary, numbers: ["{ASKED[0]}", "{ASKED[1]}"], {B}: [0.2 mm, 0.5 mm]}}
"""
TEXTS = {
    "contact": small.SLIDER_CRANK,
    "events": small.SLIDER_CRANK
    + "events:\n  far: {when: stroke, value: -0.1 mm, do: {record: true}}\n"
    "phase_portraits:\n  p: {x: stroke, y: stroke.rate}\n",
    "nothing": """
bodies: {bob: {mass: 1, inertia: 0.1, at: [1, 0]}}
joints: {O: {type: revolute, bodies: [ground, bob], at: [0, 0]}}
solver: {end: 20 ms}
output: {every: 1 ms}
""",
    "no touch": """
bodies: {bob: {mass: 1, inertia: 0.1, at: [1, 0], velocity: [10 mm/s, 0]}}
joints: {B: {type: revolute, bodies: [ground, bob], at: [0, 0], clearance: 1 mm, contact: pin}}
contact_laws: {pin: {normal: lankarani_nikravesh, stiffness: 1e8, restitution: 0.9,
                     bearing_radius: 10 mm, friction: {law: none}}}
solver: {end: 20 ms}
output: {every: 20 ms}
""",
}


@pytest.mark.parametrize("name", TEXTS)
def test_a_run_in_memory_gives_what_its_file_gives(name, tmp_path):
    scenario = loads(TEXTS[name])
    mechanism = assemble(scenario)
    small.run(tmp_path / "x.h5", text=TEXTS[name])
    live, told = Taking(tmp_path / "x.h5", scenario, mechanism).all(simulate(scenario, mechanism))
    filed = read(tmp_path / "x.h5")
    asked = ASKED if name in ("contact", "events") else ()
    one, two = record(live, asked), record(filed, asked)
    assert packed(one)[1] == packed(two)[1]
    assert told["status"] == "done" and told["rows"] == filed.rows
    assert one["channels"] and all(len(row) == len(OF_CHANNELS) for row in one["channels"].values())


def test_lines_of_blocks_as_they_come():
    """More than there is room for, in blocks whose memory is the solver's again."""
    rng = np.random.default_rng(3)
    for expected in (0, 7, 500):
        gathered, told, block = Gathered(4, expected), [], np.empty((90, 4))
        for n in (0, 1, 5, 90, 3, 77, 90, 0, 64):
            block[:n] = rng.random((n, 4))
            told.append(block[:n].copy())
            gathered.append(block[:n])
        assert np.array_equal(gathered.whole(), np.vstack(told)) and gathered.n == 330
        assert all(column.flags.c_contiguous for column in gathered.whole().T)


@pytest.fixture(scope="module")
def scenario(tmp_path_factory):
    path = tmp_path_factory.mktemp("summary") / "crank.yaml"
    path.write_text(small.SLIDER_CRANK + SWEEP)
    return path


def made(scenario, folder, sets=(), keep=""):
    planned = plan(str(scenario), sets, engine())
    planned = planned._replace(keep=keep) if keep else planned
    return [one.case for one in go(planned, folder, engine(), here) if not isinstance(one, int)]


@pytest.fixture(scope="module")
def folder(scenario, tmp_path_factory):
    folder = tmp_path_factory.mktemp("kept") / "sweep"
    assert made(scenario, folder) == ["clearance=0.2mm", "clearance=0.5mm"]
    return folder


@pytest.fixture(scope="module")
def filed(scenario, tmp_path_factory):
    """The same sweep with result files."""
    folder = tmp_path_factory.mktemp("filed") / "sweep"
    made(scenario, folder, keep="all")
    return folder


def test_numbers_are_those_of_the_files(folder, filed):
    kept, whole = study(folder), study(filed)
    assert not list((folder / "cases").iterdir())
    for case, other in zip(kept.cases, whole.cases, strict=True):
        one, run = case.run(), other.run()
        assert isinstance(one, Kept) and not case.filed and other.filed
        words = [f"{kind}:{name}" for kind in OF_CHANNELS for name in ("stroke", "B.contact_force")]
        words += [f"{kind}:crank.position.y" for kind in OF_CHANNELS]
        words += [f"{kind}:B" for kind in OF_CONTACTS]
        words += ["points:journal", "dispersion:journal", "dispersion:journal.x@1 ms..2 ms"]
        words += ["summary:contacts.B.impacts", "solver:steps", "peak:|O.reaction|", *ASKED]
        for word in words:
            value, unit = scalar(one, word)
            of_file = scalar(run, word)
            assert (value, unit) == of_file or (math.isnan(value) and math.isnan(of_file[0])), word
        assert (one.events.time == run.events.time).all()
        assert [p[:4] for p in one.peaks] == [p[:4] for p in run.peaks]
    assert (
        diagram(kept, "journal").cases[0].y.tolist()
        == diagram(whole, "journal").cases[0].y.tolist()
    )
    assert numbers(kept, ASKED[:1])[ASKED[0]].values == numbers(whole, ASKED[:1])[ASKED[0]].values
    frame = Sweep(folder).frame("peak:B.contact_force")
    assert frame["peak:B.contact_force"].tolist() == [
        scalar(case.run(), "peak:B.contact_force")[0] for case in whole.cases
    ]


def test_the_index_has_the_numbers_asked_for(folder):
    text = (folder / "index.csv").read_text()
    run = study(folder).cases[1].run()
    assert ASKED[0] in text and repr(scalar(run, ASKED[0])[0]) in text


def test_what_was_not_kept_is_told(folder):
    run = study(folder).cases[0].run()
    for word in ("mean:stroke@1 ms..2 ms", "fluctuation:stroke", "peak:B.normal_force@1 ms..2 ms"):
        with pytest.raises(UsageError, match="the sweep did not keep the rows") as caught:
            scalar(run, word)
        assert "trsim run" in caught.value.hint and "numbers:" in caught.value.hint
    with pytest.raises(UsageError, match="no channel named 'strok'"):
        scalar(run, "mean:strok")
    with pytest.raises(FileError, match="the numbers of the case only"):
        Sweep(folder)[0]


@pytest.fixture
def copy(folder, tmp_path):
    """A copy of the sweep."""
    return shutil.copytree(folder, tmp_path / "sweep")


def test_again_runs_nothing_and_other_wishes_do(scenario, copy, tmp_path):
    assert made(scenario, copy) == []
    silent = tmp_path / "silent.yaml"  # of so few cases it would keep the result files
    silent.write_text(scenario.read_text().replace("keep: summary, ", ""))
    assert made(silent, copy) == []
    other = tmp_path / "crank.yaml"
    other.write_text(scenario.read_text().replace(ASKED[1], "final:stroke"))
    assert made(other, copy) == ["clearance=0.2mm", "clearance=0.5mm"]
    assert made(other, copy) == []
    assert made(other, copy, keep="all") == ["clearance=0.2mm", "clearance=0.5mm"]
    assert made(other, copy) == []  # files have all that is asked for


def test_a_record_that_was_lost_is_made_again(scenario, folder, copy):
    records = copy / "summaries.jsonl.gz"
    whole = records.read_bytes()
    records.write_bytes(whole[:-1])  # its writer died
    assert [case.status for case in study(copy).cases] == ["done", "missing"]
    assert made(scenario, copy) == ["clearance=0.5mm"]
    assert [case.status for case in study(copy).cases] == ["done", "done"]
    assert study(copy).cases[1].run().told == study(folder).cases[1].run().told
    assert unpacked(*packed({"of": "this"})) == {"of": "this"}
    assert unpacked(packed({"of": "that"})[0], packed({"of": "this"})[1]) is None
    records.write_bytes(b"\0" * 100 + records.read_bytes()[100:])
    with pytest.raises(FileError, match="is damaged from byte 0 on"):
        study(copy).cases[0].run()


def test_a_case_can_be_run_again_with_all_it_gives(scenario, tmp_path):
    folder = tmp_path / "sweep"
    made(scenario, folder)
    with pytest.raises(UsageError, match="no case named 'clearance'"):
        list(again(Listener(), folder, ("clearance",)))
    (summary,) = again(Listener(), folder, ("clearance=0.5mm",))
    assert summary["as_kept"] is True
    found = study(folder)
    assert [case.filed for case in found.cases] == [False, True]
    assert found.cases[1].run().channel("stroke").size == found.cases[1].run().rows
    row = (folder / "index.csv").read_text().splitlines()[2]
    assert made(scenario, folder) == []
    assert [case.filed for case in study(folder).cases] == [False, True]
    asked = repr(scalar(found.cases[1].run(), ASKED[0])[0])
    assert asked in row and asked in (folder / "index.csv").read_text().splitlines()[2]


CASES = f"""
sweep: {{keep: summary, numbers: ["{ASKED[0]}"], {B}: [0.2 mm, 0.5 mm]}}
cases:
  slow: {{drives: {{motor: {{velocity: 4000 rpm}}}}}}
  fast: {{drives: {{motor: {{velocity: 6000 rpm}}}}}}
"""


def test_named_cases_are_kept_alike(tmp_path):
    path = tmp_path / "crank.yaml"
    path.write_text(small.SLIDER_CRANK + CASES)
    for sets in ((), (f"{B}=0.3 mm",)):  # nothing varies any more: the cases are left
        found = plan(str(path), sets, "one")
        assert (found.keep, found.numbers) == ("summary", ASKED[:1])
    path.write_text(path.read_text() + f"  other: {{sweep: {{{B}: [0.4 mm]}}}}\n")
    with pytest.raises(UsageError, match="differ in what is kept of them"):
        plan(str(path), (), "one")


def test_a_file_of_others_is_left_alone(scenario, tmp_path):
    other = tmp_path / "sweep" / "summaries.jsonl.gz"
    other.parent.mkdir()
    (tmp_path / "sweep" / "ledger.jsonl").touch()
    made(scenario, tmp_path / "sweep")
    other.write_text("something else")
    with pytest.raises(FileError, match="is not a file of a sweep's summaries"):
        made(scenario, tmp_path / "sweep")
    assert other.read_text() == "something else"


@pytest.mark.parametrize(
    "wrong, told",
    [("keep: some", "must be one of all, summary"), ("numbers: 3", "must be a list of numbers"),
     ("numbers: [stroke]", "no number of a run"), ("numbers: ['max:stroke']", "Write peak:stroke"),
     ("numbers: ['solver:steps@1..2']", "is of the whole run")],
)  # fmt: skip
def test_wrong_wishes(wrong, told, tmp_path):
    path = Path(tmp_path / "crank.yaml")
    path.write_text(small.SLIDER_CRANK + f"sweep: {{{wrong}, {B}: [0.2 mm]}}\n")
    with pytest.raises(ScenarioError) as caught:
        plan(str(path), (), "one")
    assert told in caught.value.show() and caught.value.place.line == 24
