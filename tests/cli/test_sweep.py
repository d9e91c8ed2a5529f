"""trsim sweep and trsim status, as a user types them."""

import pytest

from tests import drawn, inside
from trsim.sweeps.study import study

B = "joints.B.clearance"
FAST = ("--set", "solver.end=0.5 ms", "-j", "1", "-o", "sw")


@pytest.fixture
def within(monkeypatch):
    """Cases run in this process."""
    inside.sweeps(monkeypatch)


def test_made_explained_and_told(scenario, trsim):
    vary = ("sweep", "crank.yaml", "--set", f"{B}=[0.4 mm, 0.5 mm]", *FAST)
    code, out, err = trsim(*vary, "--dry-run", "--explain")
    assert code == 0
    assert out.splitlines() == ["clearance=0.4mm: not run yet", "clearance=0.5mm: not run yet"]
    assert "2 of 2 cases are to be run" in err and "2 cases are well formed and assemble" in err
    assert not (scenario.parent / "sw").exists()
    code, out, err = trsim(*vary)
    assert (code, out) == (0, "sw/index.csv\n")
    assert "2 cases, 2 run in" in err and "2 done" in err
    code, out, err = trsim(*vary, "--explain")
    assert code == 0 and "0 of 2 cases are to be run" in err and "0 run in" in err
    code, out, _ = trsim("status", "sw")
    assert code == 0 and out == "sw: 2 cases of crank.yaml: 2 done\n"
    vary = ("sweep", "crank.yaml", "--set", f"{B}=[0.4 mm, 0.6 mm]", *FAST)
    code, out, err = trsim(*vary, "--explain")
    assert out.splitlines()[0] == "clearance=0.6mm: not run yet"
    assert "of an earlier plan: clearance=0.5mm.h5" in err
    code, out, err = trsim(*vary[:-4], "-j", "1", "-o", "sw", "--set", "solver.end=0.6 ms",
                           "--explain", "--dry-run")  # fmt: skip
    assert 'the scenario changed: solver.end is "0.6 ms", was "0.5 ms"' in out


def test_failed_cases(scenario, trsim, answer, within):
    sets = ("--set", "solver.max_steps=[3, 100000]", *FAST)
    code, _, err = trsim("sweep", "crank.yaml", *sets)
    assert code == 6
    assert "1 of 2 cases failed" in err and "more than 3 steps" in err
    code, told = answer("status", "sw")
    assert code == 0
    assert told["counts"] == {"failed": 1, "done": 1}
    assert [one["case"] for one in told["failed"]] == ["max_steps=3"]
    assert "more than 3 steps" in trsim("status", "sw")[1]


def test_limits(scenario, trsim):
    long = ("sweep", "crank.yaml", "--set", "solver.end=[1000 s]", "-j", "1", "-o", "sw")
    code, _, err = trsim(*long, "--time-limit", "0.3")
    assert code == 6 and "over time: not done after 0.3 s" in err
    code, out, err = trsim(*long, "--explain", "--dry-run")
    assert out == "end=1000s: tried again: over time\n"


def test_shards(scenario, trsim, within):
    vary = ("sweep", "crank.yaml", "--set", f"{B}=lin(0.4 mm, 0.5 mm, 3)", *FAST)
    assert trsim(*vary, "--shard", "1/2")[0] == 0
    assert [case.status for case in study("sw").cases] == ["done", "missing", "done"]
    _, out, _ = trsim("status", "sw")
    assert "1 missing" in out and "missing: about" in out
    assert trsim(*vary, "--shard", "2/2")[0] == 0
    assert [case.status for case in study("sw").cases] == ["done"] * 3


def test_cases_that_are_not_needed(scenario, trsim, answer):
    """Two ends that are alike: nothing between them is run, and all that is told is how many."""
    text = scenario.read_text()
    scenario.write_text(f"{text}sweep: {{{B}: [0.4 mm, 0.45 mm, 0.5 mm], refine: {{every: 2}}}}\n")
    code, _, err = trsim("sweep", "crank.yaml", *FAST, "--explain")
    assert code == 0 and "at most 3 of 3 cases are to be run" in err
    assert "3 cases, 2 run in" in err and ": 2 done, 1 not needed" in err
    said = "2 of 3 cases: neighbours that differ in status are next to each other on the axes"
    assert said in err
    assert trsim("status", "sw")[1].splitlines() == [
        "sw: 3 cases of crank.yaml: 2 done, 1 not needed", said,
    ]  # fmt: skip
    assert answer("status", "sw")[1]["chosen"] == [said]
    code, told = answer("sweep", "crank.yaml", *FAST)
    assert (code, told["ran"], told["chosen"]) == (0, 0, [said])
    code, _, err = trsim("sweep", "crank.yaml", *FAST, "--shard", "1/2", "--dry-run")
    assert code == 2 and "choose cases from what all others gave" in err


@pytest.mark.parametrize(
    "more, code, what",
    [
        (("--shard", "3/2"), 2, "the first of 2 shares is 1/2"),
        (("--shard", "x"), 2, "is no share"),
        (("--memory", "much"), 2, "is no amount of memory"),
        (("--memory", "0"), 2, "is no amount of memory"),
        (("--jobs", "0"), 2, "0 is not in the range"),
        (("--time-limit", "nan"), 2, "is not a number of seconds"),
        (("--dask", "tcp://127.0.0.1:9"), 7, "no Dask scheduler at"),
        (("--set", "joints.B.clearnce=[1]"), 3, "Did you mean 'clearance'?"),
        (("--set", f"{B}=[1 kg, 2 s]"), 3, "wrong unit: 'kg' is a mass"),
        (("--set", "bodies.rod.mass=[0]", "--dry-run"), 4, "Case: "),
        (("-o", "crank.yaml"), 2, "is not a folder"),
        (("-o", "."), 2, "a folder of other files"),
    ],
)  # fmt: skip
def test_refused(scenario, trsim, more, code, what, monkeypatch):
    monkeypatch.setattr("trsim.sweeps.dask.CONNECTING", 0.5)  # s; nobody answers there
    vary = ("sweep", "crank.yaml", "--set", f"{B}=[0.4 mm]", *FAST)
    found, _, err = trsim(*vary, *more)
    assert (found, what in err) == (code, True), err


def test_faults_are_told_once(scenario, trsim):
    """A fault of many cases is that of the first; another one behind them is told too."""
    sizes = ", ".join(f"0.{k} mm" for k in range(11, 23))
    vary = ("--set", "bodies.rod.mass=[-1]", "--set", f"{B}=[{sizes}, -1 mm]")
    code, _, err = trsim("sweep", "crank.yaml", *vary, *FAST)
    assert code == 3
    assert err.count("bodies.rod.mass: must be") == 1 and "clearance=0.11mm" in err
    assert err.count("  Case: ") == 2 and "joints.B.clearance" in err


def test_nothing_to_vary(scenario, trsim):
    code, _, err = trsim("sweep", "crank.yaml")
    assert code == 2 and "says nothing to vary" in err


def test_into_the_folder_of_a_report(scenario, trsim, within):
    """By default a report of runs/NAME.h5 and a sweep of NAME.yaml have one folder."""
    assert trsim("run", "crank.yaml", "--set", "solver.end=0.5 ms", "-o", "sw.h5")[0] == 0
    assert trsim("report", "sw.h5", "--plot", "time : time")[0] == 0
    vary = ("sweep", "crank.yaml", "--set", f"{B}=[0.4 mm]", *FAST)
    own = scenario.parent / "sw/notes.txt"
    own.write_text("mine")
    code, _, err = trsim(*vary)
    assert code == 2 and "a folder of other files" in err
    own.unlink()
    assert trsim(*vary)[0] == 0
    assert [case.status for case in study("sw").cases] == ["done"]


def test_no_sweep_there(scenario, trsim):
    code, _, err = trsim("status", "nowhere")
    assert code == 7 and "no such folder" in err


def test_bars_and_envelope(scenario, trsim, answer, within, monkeypatch):
    drawn.few(monkeypatch)
    drawn.blank(monkeypatch)
    assert trsim("sweep", "crank.yaml", "--set", f"{B}=[0.4 mm, 0.5 mm]", *FAST)[0] == 0
    code, told = answer("report", "sw", "--bars", "peak:A.reaction", "--envelope",
                        "--at", "stroke", "--with", "motor.force,|A.reaction|")  # fmt: skip
    assert code == 0
    names = {name.rpartition("/")[2] for name in told["files"]}
    assert {"bars_peak_A_reaction.png", "envelope.csv", "envelope_cases.csv"} <= names
    head = (scenario.parent / "sw/figures/envelope.csv").read_text().splitlines()[0]
    assert head.endswith("stroke [m],known from,in rows,x,y,z,motor.force [N*m],|A.reaction| [N]")
    assert {value["run"] for value in told["values"]} <= {"clearance=0.4mm", "clearance=0.5mm"}
    code, told = answer("report", "sw", "--envelope", "A.reaction.x, stroke")
    assert {value["what"] for value in told["values"]} == {
        f"{name}: {word}" for name in ("A.reaction.x", "stroke") for word in ("largest", "smallest")
    }
    assert answer("report", "sw", "--envelope", "A.action")[0] == 2
    assert answer("report", "sw", "--at", "stroke")[0] == 2
    assert answer("report", "sw", "--plot", "stroke")[0] == 2
    case = "sw/cases/clearance=0.4mm.h5"
    assert answer("report", case, "--envelope")[0] == 2
    code, told = answer("report", case, "--laws", "--plot", "B.normal_force : stroke", "-o", "out")
    assert code == 0 and any("visited depth" in line for line in told["told"])
    code, told = answer("report", case, "--plot", "motor.force : stroke", "-o", "new",
                        "--overlay", "out/none.csv")  # fmt: skip
    assert code == 7
