"""User events on the command line and in result files: said before, during and after a run."""

import h5py
import numpy as np
import pytest

from tests import inside, small
from trsim.cli import main
from trsim.store import hdf5
from trsim.store.read import read

TEXT = (
    small.SLIDER_CRANK
    + """
events:
  shut: {when: stroke, value: -5 mm, crosses: down, times: 1,
         do: {release: [motor], lock: [O], record: true}}
  open: {when: t, value: 1.5 ms, do: {unlock: [O]}}
  never: {when: crank_angle, value: 90 deg, do: {end: true}}
"""
)
END = ("--set", "events.never.value=0.3")
LONG = ("--set", "output.every=0.2us", "--set", "output.channels=[stroke, B.force]")  # three chunks


@pytest.fixture
def events(scenario):
    scenario.write_text(TEXT)
    return scenario


def test_check_says_what_there_is(events, trsim, answer):
    _, out, _ = trsim("check", "crank.yaml")
    assert "shut: stroke falls through -0.005 m, once: release motor, lock O, record" in out
    assert answer("check", "crank.yaml")[1]["scenarios"][0]["events"]["open"] == (
        "t rises through 0.0015 s: unlock O"
    )


def test_run_show_and_the_file(events, trsim, answer):
    code, _, err = trsim("run", "crank.yaml", "-o", "x.h5")
    assert code == 0
    assert "note: the event 'never' never happened" in err and "'shut'" not in err
    document = answer("show", "x.h5")[1]
    assert document["fired"] == {"shut": 1, "open": 1, "never": 0}
    out = trsim("show", "x.h5")[1]
    assert "event     shut: release motor, lock O, record at 0.0007639" in out
    assert "event     never: never" in out
    run = read("x.h5")
    user = run.events.kind == "user"
    assert run.events.element[user].tolist() == ["shut", "open"]
    assert run.events.did[user].tolist() == ["release motor, lock O, record", "unlock O"]
    assert np.all(run.events.work[~user] == 0.0) and set(run.events.did[~user]) == {"-"}
    lost = run.events.work[user][0]
    assert lost < 0 and run.channel("energy.work.events")[-1] == pytest.approx(lost)
    line = run.recorded
    assert line["event"].tolist() == [b"shut"] and line["time"] == run.events.time[user][:1]
    assert line["stroke"] == pytest.approx(-5e-3, abs=1e-12)
    assert line["slider.velocity"].shape == (1, 3)


def test_an_event_ends_the_run(events, trsim, answer):
    code, _, err = trsim("run", "crank.yaml", *END, "-o", "x.h5")
    assert code == 0 and "done at t = " in err and "(event 'never' ended the run)" in err
    run = answer("run", "crank.yaml", *END, "-o", "y.h5")[1]["runs"][0]
    assert (run["status"], run["reason"]) == ("done", "event 'never' ended the run")
    assert run["fired"] == {"shut": 0, "open": 0, "never": 1}
    assert answer("show", "y.h5")[1]["reason"] == "event 'never' ended the run"


def test_without_events_there_is_no_trace(scenario, trsim):
    trsim("run", "crank.yaml", "-o", "x.h5")
    with h5py.File("x.h5") as file:
        assert sorted(file["events"]) == ["angle", "element", "kind", "speed", "time"]
        assert "recorded" not in file and "energy.work.events" not in file
    assert read("x.h5").fired == {} and read("x.h5").recorded == {}


@pytest.fixture(scope="module")
def unbroken(tmp_path_factory):
    """The hash of the run that the following ones end early."""
    folder = tmp_path_factory.mktemp("unbroken")
    (folder / "crank.yaml").write_text(TEXT)
    with pytest.MonkeyPatch.context() as patch, pytest.raises(SystemExit):
        patch.chdir(folder)
        main(["run", "crank.yaml", *LONG, "-q"])
    return read(folder / "runs/crank.h5").attributes["content_sha256"]


@pytest.mark.parametrize("after", [0.5e-3, 1.2e-3, 2.0e-3])
def test_resumed_between_events(events, unbroken, trsim, answer, monkeypatch, after, at_once):
    take = hdf5.Running.take

    def interrupt(run, block):
        take(run, block)
        if block.time > after:
            raise KeyboardInterrupt

    with monkeypatch.context() as patch:
        patch.setattr(hdf5.Running, "take", interrupt)
        assert trsim("run", "crank.yaml", *LONG)[0] == 130
    resumed = answer("run", "crank.yaml", *LONG, "--resume")[1]["runs"][0]
    assert resumed["resumed_from"] > after
    assert resumed["content_sha256"] == unbroken


def test_recovered(events, trsim, answer, monkeypatch):
    inside.recovering(monkeypatch)
    trsim("run", "crank.yaml", "-o", "x.h5")
    document = answer("recover", "x.h5", "-o", "y.h5")[1]
    assert document["exit_code"] == 0
    before, after = read("x.h5"), read("y.h5")
    assert after.fired == before.fired
    np.testing.assert_array_equal(after.events.work, before.events.work)
    np.testing.assert_array_equal(after.recorded["stroke"], before.recorded["stroke"])


WRONG = [
    (
        "when: stroke,",
        "when: strok,",
        "no sensor named 'strok'",
        "Did you mean 'stroke'?",
    ),
    ("release: [motor]", "release: [moter]", "no joint or drive named 'moter'", "'motor'?"),
    ("lock: [O]", "lock: [G]", "no joint named 'G'", "Known: O"),
    ("unlock: [O]", "unlock: [A]", "no event locks the joint 'A'", ""),
    ("lock: [O]", "set: {motr: {velocity: 3}}", "no drive named 'motr'", "'motor'?"),
    ("release: [motor]", "release: [B]", "joint 'B' has clearance", "clearance: 0"),
    ("value: -5 mm", "value: -5 deg", "wrong unit: 'deg'; 'stroke' is in m", ""),
    ("value: -5 mm", "value: -5 ms", "wrong unit: 'ms'; 'stroke' is in m", ""),
    ("value: 1.5 ms", "value: 1.5 mm", "wrong unit: 'mm'; 't' is in s", ""),
    ("crosses: down", "crosses: dwon", "must be one of up, down, both", "'down'"),
    ("times: 1", "times: 0", "must be > 0", ""),
    ("do: {unlock: [O]}", "do: {}", "nothing to do", "record, set, release"),
    ("do: {unlock: [O]}", "do: {unlok: [O]}", "unknown key 'unlok'", "'unlock'?"),
    ("do: {unlock: [O]}", "do: {lock: [O], unlock: [O]}", "'O' stands under lock and", ""),
    ("unlock: [O]", "set: {motor: {velocity: 3, position: 1}}", "give either `position` or", ""),
    ("unlock: [O]", "set: {motor: {velocity: 3 mm}}", "wrong unit: 'mm'", ""),
    ("unlock: [O]", "set: {motor: {velocity: 3 m/s}}", "the joint turns", "rad/s"),
    ("unlock: [O]", "set: {motor: {velocity: 3*stroke}}", "a drive depends on t only", ""),
    ("  open:", "  motor:", "the name 'motor' is taken", ""),
    ("when: t, ", "", "field required: when", ""),
    ("do: {unlock: [O]}", "value: 3", "field required: do", ""),
]


@pytest.mark.parametrize("old, new, what, hint", WRONG, ids=lambda text: str(text)[:20])
def test_what_makes_no_sense_is_said_with_its_place(events, answer, old, new, what, hint):
    assert old in TEXT
    text = TEXT.replace(old, new, 1)
    if new == "value: 3":
        text = TEXT.replace(", do: {unlock: [O]}", "")
    events.write_text(text)
    code, document = answer("check", "crank.yaml")
    assert code == 3
    error = document["errors"][0]
    assert what in error["what"] and hint in error["hint"]
    places = [k for k, one in enumerate(text.splitlines(), 1) if new and new in one]
    assert error["line"] in places or new in ("", "value: 3")
    assert error["path"].startswith("events")


def test_scipy_is_refused(events, answer):
    code, document = answer("check", "crank.yaml", "--set", "solver.method=scipy:BDF")
    assert code == 3 and "knows no events" in document["errors"][0]["what"]
