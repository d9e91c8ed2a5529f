"""`trsim run --certify`: what it finds, what it keeps, what it goes on from."""

import csv
import io
import json
import shutil
from contextlib import redirect_stdout

import h5py
import pytest

from tests import inside, mechanisms, small
from tests.cli.conftest import faults
from tests.cli.test_contract import changed, mappings
from trsim.cli import main
from trsim.store import hdf5
from trsim.store.checkpoint import load
from trsim.store.read import read, verify

LONG = ("--set", "output.every=0.2us", "--set", "solver.tolerance=1e-4",  # blocks of rows
        "--set", "output.channels=[stroke, crank_angle, B.force]")  # fmt: skip
CHAOTIC = ("--set", "solver.end=120ms", "--set", "output.every=0.05ms")


def certified(answer, *arguments, code=0):
    """The run of a command line, as its document tells it."""
    ended, document = answer("run", *arguments)
    assert ended == code
    return document["runs"][0]


def alone(folder, *options):
    """A certified run in a folder of its own, as its document tells it."""
    (folder / "crank.yaml").write_text(small.SLIDER_CRANK)
    with pytest.MonkeyPatch.context() as patch, redirect_stdout(io.StringIO()) as out:
        patch.chdir(folder)
        with pytest.raises(SystemExit) as ended:
            main(["run", "crank.yaml", *options, "--certify", "--json", "-q"])
    assert ended.value.code == 0
    document = json.loads(out.getvalue())
    assert faults(document, "run") == []
    return document["runs"][0]


@pytest.fixture(scope="module")
def whole(tmp_path_factory):
    """The run of the scenario as it is, certified, as its document tells it, and its file."""
    folder = tmp_path_factory.mktemp("certified")
    return alone(folder), folder / "runs/crank.h5"


def bring(file, scenario):
    """Have a file where a run of the scenario is written to."""
    (scenario.parent / "runs").mkdir()
    shutil.copy(file, scenario.parent / "runs")


@pytest.fixture
def done(whole, scenario):
    """What is told of that run, with its file where a run of the scenario is written to."""
    told, file = whole
    bring(file, scenario)
    return told


@pytest.fixture(scope="module")
def parting(tmp_path_factory):
    """The certificate of a chaotic run, and its file."""
    folder = tmp_path_factory.mktemp("parting")
    told = alone(folder, *CHAOTIC, "--set", "solver.tolerance=1e-5")["certificate"]
    return told, folder / "runs/crank.h5"


@pytest.fixture
def chaotic(parting, scenario):
    """The same, with its file where a run of the scenario is written to."""
    told, file = parting
    bring(file, scenario)
    return told


def names(folder):
    return {path.name for path in (folder / "runs").iterdir()}


# --- what it finds ---------------------------------------------------------------------------


@pytest.fixture
def pendulum(scenario):
    scenario.with_name("pendulum.yaml").write_text(mechanisms.torsion_pendulum()[0])
    return "pendulum.yaml"


def test_a_regular_motion_is_predictable(pendulum, answer):
    """Its error is about the tolerance, and shrinks with it."""
    found = []
    for tolerance in (1e-2, 1e-4, 1e-6, 1e-8):
        setting = ("--set", f"solver.tolerance={tolerance}")
        told = certified(answer, pendulum, *setting, "--certify")["certificate"]
        assert (told["method"], told["status"]) == ("radau", "done")
        assert told["tolerance"] == pytest.approx(tolerance / 100.0)
        assert told["apart"] is None and told["windows"] == []
        assert told["compared_until"] == 0.4
        assert told["difference"] < 10.0 * tolerance
        found.append(told["difference"])
    assert sorted(found, reverse=True) == found
    assert found[0] > 1e4 * found[-1]


def test_the_difference_is_the_true_error(pendulum, answer):
    """Against the exact solution."""
    exact = mechanisms.torsion_pendulum()[1]
    told = certified(answer, pendulum, "--certify", "--set", "solver.tolerance=1e-4")
    run = read(told["file"])
    error = abs(run.channel("angle") - exact(run.time)).max()
    curve = next(c for c in run.certificate.curves if c.channel == "angle")
    assert curve.difference * curve.range == pytest.approx(error, rel=0.05)


def test_a_chaotic_motion_has_a_horizon(chaotic, answer, trsim):
    told = chaotic
    assert 0.003 < told["apart"] < 0.03
    assert told["difference"] <= 0.01
    assert told["windows"][-1]["end"] is None
    assert told["agree"] > 0.9 * (told["agree"] + told["differ"]) > 50
    [contact] = told["contacts"]
    assert contact["before"] == contact["twin_before"] > 10
    assert contact["before"] < min(contact["impacts"], contact["twin"])
    assert told["windows"][-1]["share"] > 0.5
    _, document = answer("show", "runs/crank.h5")
    shown = document["certificate"]
    assert {key: shown[key] for key in told} == told
    share = next(row for row in shown["levels"] if row["quantity"] == "in contact")
    assert share["verdict"] == "agree" and 0.0 < share["value"] < 1.0
    peak = {(q["channel"], q["quantity"]): q for q in shown["quantities"]}
    assert peak["B.contact_force", "largest"]["value"] == document["summary"]["contacts"]["B"][
        "peak_force"
    ]  # fmt: skip
    _, out, _ = trsim("show", "runs/crank.h5")
    assert f"predictable until t = {told['apart']:.6g} s" in out
    assert "~ of a time in which the two are apart" in out


def test_a_tighter_tolerance_is_predictable_for_longer(parting, scenario, answer):
    sets = (*CHAOTIC, "--set", "solver.tolerance=1e-2")
    coarse = certified(answer, "crank.yaml", *sets, "--certify")["certificate"]
    assert coarse["apart"] < parting[0]["apart"]


@pytest.mark.parametrize(
    "method, other", [("auto", "radau"), ("radau", "dop853"), ("generalized_alpha", "auto")]
)
def test_the_twin_is_of_the_other_family(method, other, pendulum, answer):
    sets = ("--set", f"solver.method={method}", "--set", "solver.tolerance=1e-3")
    assert certified(answer, pendulum, *sets, "--certify")["certificate"]["method"] == other


def test_fixed_steps(pendulum, answer):
    sets = ("--set", "solver.method=rk4", "--set", "solver.step=1ms")
    told = certified(answer, pendulum, *sets, "--certify")["certificate"]
    assert told["method"] == "auto"
    assert 0.0 < told["difference"] < 1e-6


def test_a_tolerance_that_rounding_forbids_is_not_asked_for(pendulum, answer):
    told = certified(answer, pendulum, "--set", "solver.tolerance=1e-13", "--certify")
    assert told["certificate"]["tolerance"] > 1e-15
    assert told["certificate"]["status"] == "done"


def test_a_twin_of_ones_own(scenario, answer, trsim):
    told = certified(answer, "crank.yaml", "--certify-with", "scipy:RK45:1e-7")["certificate"]
    assert (told["method"], told["tolerance"]) == ("scipy:RK45", 1e-7)
    for wrong, said in (
        ("radu:1e-7", "no method 'radu'"), ("1e-7", "is no twin"), ("rk4:1e-3", "rk4 has no"),
        ("radau:2", "is no tolerance"),
    ):  # fmt: skip
        code, _, err = trsim("run", "crank.yaml", "--certify-with", wrong)
        assert code == 2 and said in err


def test_schemas_can_fail(chaotic, answer):
    """A key too many is seen everywhere in a certificate."""
    _, document = answer("show", "runs/crank.h5")
    tables = [p for p in mappings(document) if p[:1] == ("certificate",) and p[2:] in ((), (0,))]
    assert len(tables) == 7
    for path in tables:
        assert faults(changed(document, path, lambda it: it.update(extra=1)), "show"), path


def test_runs_that_an_event_ends(scenario, answer):
    """Both end there, at times that differ as little as they do."""
    text = small.SLIDER_CRANK + "events: {far: {when: crank_angle, value: 60 deg, do: {end: true}}}"
    scenario.write_text(text)
    run = certified(answer, "crank.yaml", "--certify")
    told = run["certificate"]
    assert (told["status"], told["apart"]) == ("done", None)
    assert told["time"] == pytest.approx(run["time"], rel=1e-9) and run["time"] < 3e-3
    assert told["rows"] >= run["rows"] - 1
    assert told["difference"] < 1e-3


# --- what does not work out ------------------------------------------------------------------


def test_a_twin_that_fails_says_when(scenario, trsim):
    code, out, err = trsim("run", "crank.yaml", "--certify", "--set", "solver.max_steps=500",
                           "--json")  # fmt: skip
    told = json.loads(out)["runs"][0]
    assert (code, told["status"]) == (0, "done")
    assert "the twin failed at t = " in err
    twin = told["certificate"]
    assert (twin["status"], twin["reason"]) == ("failed", "more than 500 steps")
    assert 0.0 < twin["compared_until"] <= twin["time"] < 3e-3
    assert twin["difference"] < 0.01


def test_a_run_that_fails_is_certified_until_then(scenario, answer):
    told = certified(answer, "crank.yaml", "--certify", "--set", "solver.max_steps=100", code=5)
    assert told["status"] == "failed"
    assert told["certificate"]["status"] == "failed"


def test_a_twin_that_cannot_be_read_does_not_cost_the_run(scenario, answer, monkeypatch):
    def unreadable(*_):
        raise OSError("Can't read data")

    monkeypatch.setattr("trsim.analyse.certificate.certificate", unreadable)
    told = certified(answer, "crank.yaml", "--certify", code=7)
    assert "certificate" not in told
    assert verify(told["file"]) and read(told["file"]).certificate is None
    assert names(scenario.parent) == {"crank.h5", "crank.twin.h5"}


def test_a_file_that_is_no_twin_is_not_written_over(scenario, trsim):
    small.copy(scenario.parent / "runs/crank.twin.h5")
    before = (scenario.parent / "runs/crank.twin.h5").read_bytes()
    code, _, err = trsim("run", "crank.yaml", "--certify")
    assert code == 2 and "is no twin of a run" in err
    assert (scenario.parent / "runs/crank.twin.h5").read_bytes() == before


def test_without_motion_nothing_is_known(pendulum, answer, trsim):
    sets = ("--set", "output.channels=[energy.kinetic]")
    told = certified(answer, pendulum, *sets, "--certify")["certificate"]
    assert (told["motion"], told["apart"], told["difference"]) == (0, None, None)
    assert "no channel of positions or velocities" in trsim("show", "runs/pendulum.h5")[1]


# --- what it keeps ---------------------------------------------------------------------------


def test_the_content_is_that_of_an_uncertified_run(done, scenario, answer):
    first = done
    assert names(scenario.parent) == {"crank.h5"}
    plain = certified(answer, "crank.yaml", "-o", "x.h5")
    assert first["content_sha256"] == plain["content_sha256"]
    again = certified(answer, "runs/crank.h5", "--certify", "-o", "y.h5")
    assert again["identical"]
    assert again["certificate"] == first["certificate"]
    hashes = [
        h5py.File(f)["certificate"].attrs["content_sha256"] for f in ("runs/crank.h5", "y.h5")
    ]
    assert hashes[0] == hashes[1]
    assert "certificate" not in plain and read("x.h5").certificate is None


def test_damage_is_noticed(done):
    assert verify("runs/crank.h5")
    with h5py.File("runs/crank.h5", "r+") as file:
        file["certificate"].attrs["apart"] = 0.1
    assert not verify("runs/crank.h5")


def test_other_commands_on_a_certified_file(done, trsim, answer, monkeypatch):
    # its page and its tables are enough
    monkeypatch.setattr("trsim.report.figures.draw", lambda *_: [])
    inside.recovering(monkeypatch)
    assert trsim("export", "runs/crank.h5", "--csv", "--channels", "stroke")[0] == 0
    with open("runs/crank.csv") as file:
        assert len(list(csv.reader(file))) == 302
    assert trsim("report", "runs/crank.h5", "-o", "figures")[0] == 0
    # what is recovered may be less than what was certified
    assert answer("recover", "runs/crank.h5", "-o", "r.h5")[0] == 0
    assert "certificate" not in answer("show", "r.h5")[1]


# --- what it goes on from --------------------------------------------------------------------


def interrupt(monkeypatch, of_twin):
    """Break the twin off near its end, or the run; the command ends with 130."""
    take = hdf5.Running.take

    def taken(run, block):
        take(run, block)
        if block.time > 2.5e-3 and ("twin" in run.final.name) == of_twin:
            raise KeyboardInterrupt

    monkeypatch.setattr(hdf5.Running, "take", taken)


@pytest.fixture(scope="module")
def expected(tmp_path_factory):
    """The same run without a break, as its document tells it."""
    return alone(tmp_path_factory.mktemp("whole"), *LONG)


@pytest.mark.parametrize("of_twin", [True, False])
def test_interrupted_and_resumed(of_twin, expected, scenario, trsim, answer, monkeypatch, at_once):
    with monkeypatch.context() as patch:
        interrupt(patch, of_twin)
        assert trsim("run", "crank.yaml", *LONG, "--certify")[0] == 130
    broken = "crank.twin.h5" if of_twin else "crank.h5"
    left = {f"{broken}.part", f"{broken}.checkpoint"} | (set() if of_twin else {"crank.twin.h5"})
    assert names(scenario.parent) == left
    kept = load(scenario.parent / f"runs/{broken}.checkpoint")
    if not of_twin:
        assert "keys" in answer("show", "runs/crank.twin.h5")[1]["provenance"]
    code, out, err = trsim("run", "crank.yaml", *LONG, "--certify", "--resume", "--json")
    told = json.loads(out)["runs"][0]
    assert code == 0
    assert f"goes on at t = {kept.time:.6g} s" in err
    assert ("the twin is there already" in err) == (not of_twin)
    assert told["content_sha256"] == expected["content_sha256"]
    assert told["certificate"] == expected["certificate"]
    assert names(scenario.parent) == {"crank.h5"}


def test_a_twin_of_another_run_is_made_anew(scenario, trsim, answer, monkeypatch):
    with monkeypatch.context() as patch:
        interrupt(patch, of_twin=False)
        assert trsim("run", "crank.yaml", *LONG, "--certify")[0] == 130
    code, _, err = trsim("run", "crank.yaml", *LONG, "--certify-with", "radau:1e-7", "--resume")
    assert code == 0
    assert "first its twin, by radau at 1e-07" in err
    assert read("runs/crank.h5").certificate.about["tolerance"] == 1e-7
