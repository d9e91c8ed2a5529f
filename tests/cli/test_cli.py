import time
from pathlib import Path

import numpy as np
import pytest

from tests import drawn, small
from tests.store import outside
from trsim.cli import COMMANDS
from trsim.store.read import read, verify


def files(folder):
    return sorted(str(p.relative_to(folder)) for p in folder.rglob("*") if p.is_file())


def wait_for(path, size=100_000):
    """Until a file has some content."""
    for _ in range(1200):
        if path.exists() and path.stat().st_size > size:
            return
        time.sleep(0.05)
    raise AssertionError(f"{path} does not grow")


# --- help and usage --------------------------------------------------------------------------


def test_help_imports_nothing_heavy():
    code = (
        "import sys, contextlib\nfrom trsim.cli import main\n"
        "with contextlib.suppress(SystemExit): main(['--help'])\n"
        "heavy = {'numpy', 'numba', 'h5py', 'pydantic', 'yaml', 'rich', 'scipy', 'matplotlib'}\n"
        "print(sorted(heavy & set(sys.modules)))"
    )
    out, _ = outside.started(outside.ROOT, "-c", code).communicate()
    assert out.splitlines()[-1] == "[]"
    for name in COMMANDS:
        assert f"  {name} " in out


def test_numba_is_needed_once(scenario):
    """The second run loads machine code; a compliant drive calls a law from Python as well."""
    compliant = "velocity: 5000 rpm, compliance: {stiffness: 1e4, damping: 1}"
    scenario.write_text(small.SLIDER_CRANK.replace("velocity: 5000 rpm", compliant))
    code = (
        "import sys, contextlib\nfrom trsim.cli import main\n"
        "for command in ('check', 'run'):\n"
        "    with contextlib.suppress(SystemExit): main([command, 'crank.yaml'])\n"
        "print(sorted({'numba', 'scipy', 'matplotlib'} & set(sys.modules)))"
    )
    for _ in range(2):
        out, _ = outside.started(scenario.parent, "-c", code).communicate()
    assert "runs/crank.h5" in out
    assert out.splitlines()[-1] == "[]"


@pytest.mark.parametrize(
    "arguments, message",
    [
        ((), "Usage"),
        (("rnu",), "Did you mean 'run'?"),
        (("run",), "Missing argument"),
        (("run", "x.yaml", "--nonsense"), "nonsense"),
    ],
)
def test_usage(arguments, message, trsim):
    code, out, err = trsim(*arguments)
    assert code == 2
    assert message in err
    assert out == ""


def test_usage_as_json(answer):
    code, document = answer("run")
    assert code == 2
    assert "Missing argument" in document["errors"][0]["what"]


# --- run -------------------------------------------------------------------------------------


def test_run_default_output(scenario, trsim):
    code, out, err = trsim("run", "crank.yaml")
    assert code == 0
    assert out == "runs/crank.h5\n"
    assert "done at t = 0.003 s, 301 rows" in err
    assert files(scenario.parent) == ["crank.yaml", "runs/crank.h5"]
    assert verify("runs/crank.h5")


def test_run_several_into_a_folder(scenario, trsim):
    (scenario.parent / "other.yaml").write_text(small.SLIDER_CRANK.replace("3 ms", "2 ms"))
    code, out, _ = trsim("run", "crank.yaml", "other.yaml", "-o", "results")
    assert code == 0
    assert out.split() == ["results/crank.h5", "results/other.h5"]


def test_run_refuses_two_results_of_one_name(scenario, trsim):
    code, _, err = trsim("run", "crank.yaml", "crank.yaml", "-o", "results")
    assert code == 2
    assert "would both be written to results/crank.h5" in err
    assert files(scenario.parent) == ["crank.yaml"]


def test_run_set_and_json(scenario, answer):
    code, document = answer("run", "crank.yaml", "--set", "solver.end=1ms", "-o", "x.h5")
    assert code == 0
    assert document["errors"] == []
    [summary] = document["runs"]
    assert summary["status"] == "done"
    assert summary["time"] == 0.001
    assert summary["file"] == "x.h5"
    assert summary["contacts"]["B"]["impacts"] >= 1


def test_run_quiet(scenario, trsim):
    code, out, err = trsim("run", "crank.yaml", "-q")
    assert (code, out, err) == (0, "runs/crank.h5\n", "")


# --- what can go wrong -----------------------------------------------------------------------

WRONG = {  # text replaced, replacement, exit code, message
    "unknown key": ("clearance: 0.5", "clearnce: 0.5", 3, "Did you mean 'clearance'?"),
    "wrong unit": ("end: 3 ms", "end: 3 mm", 3, "wrong unit"),
    "no end": ("end: 3 ms, ", "", 3, "field required: end"),
    "no such body": ("bodies: [rod, slider]", "bodies: [rodd, slider]", 3, "rodd"),
    "unknown channel": ("when: B.ecc", "when: B.exc", 3, "no channel named"),
    "two drives": (
        "  motor: {joint: O, velocity: 5000 rpm}",
        "  motor: {joint: O, velocity: 5000 rpm}\n  twin: {joint: O, velocity: 1 rpm}",
        4,
        "moves a coordinate that",
    ),
    "solver": (
        "method: dop853",
        "method: rk4, force: true, step: 0.05 ms",
        5,
        "the solver failed at t =",
    ),
}


@pytest.mark.parametrize("case", WRONG)
def test_wrong_scenarios(case, scenario, trsim, answer):
    old, new, exit_code, message = WRONG[case]
    assert old in small.SLIDER_CRANK
    scenario.write_text(small.SLIDER_CRANK.replace(old, new))
    code, out, err = trsim("run", "crank.yaml")
    assert code == exit_code
    assert message in err
    left = files(scenario.parent)
    if exit_code == 5:  # partial results are kept
        assert out == "runs/crank.h5\n"
        assert read("runs/crank.h5").attributes["status"] == "failed"
    else:
        assert out == ""
        assert "crank.yaml:" in err
        assert left == ["crank.yaml"]
    code, document = answer("run", "crank.yaml")
    assert code == exit_code
    [error] = document["errors"]
    assert message in error["what"] + error["hint"]
    assert error["exit_code"] == exit_code


def test_one_wrong_scenario_does_not_stop_the_others(scenario, trsim):
    (scenario.parent / "bad.yaml").write_text("bodies: 3")
    code, out, _ = trsim("run", "bad.yaml", "crank.yaml")
    assert code == 3
    assert out == "runs/crank.h5\n"


def test_file_system(scenario, trsim, answer):
    assert trsim("run", "none.yaml")[0] == 7
    assert trsim("run", "crank.yaml", "-o", "crank.yaml/run.h5")[0] == 7
    assert trsim("report", "crank.yaml")[0] == 7
    code, document = answer("show", "none.h5")
    assert code == 7
    assert "no such file" in document["errors"][0]["what"]
    assert files(scenario.parent) == ["crank.yaml"]


def test_bug_is_one_line(scenario, trsim, answer, monkeypatch):
    def broken(*_):
        raise ZeroDivisionError("division by zero")

    monkeypatch.setattr("trsim.api.check.described", broken)
    code, out, err = trsim("check", "crank.yaml")
    assert (code, out) == (1, "")
    assert "ZeroDivisionError: division by zero" in err
    assert "TRSIM_DEBUG=1" in err
    assert answer("check", "crank.yaml")[0] == 1
    monkeypatch.setenv("TRSIM_DEBUG", "1")
    with pytest.raises(ZeroDivisionError):
        trsim("check", "crank.yaml")


# --- check, show, report ---------------------------------------------------------------------


def test_check(scenario, trsim, answer):
    code, out, _ = trsim("check", "crank.yaml")
    assert code == 0
    assert "mobility    2 by rank, 2 by count: 9 unknowns, 7 constraint rows" in out
    scenario.write_text(small.SLIDER_CRANK.split("poincare:")[0])  # an ideal pin has no orbit
    code, document = answer("check", "crank.yaml", "--set", "joints.B.clearance=0")
    assert code == 0
    [found] = document["scenarios"]
    assert found["mobility"] == 0
    assert found["joints"]["B"] == "clearance_joint"
    assert found["contacts"] == []
    assert found["start"]["position_residual"] < 1e-12
    assert files(scenario.parent) == ["crank.yaml"]


def test_check_finds_redundant_rows(scenario, answer):
    text = small.SLIDER_CRANK.replace(", clearance: 0.5 mm, contact: pin", "")
    text = text[: text.index("poincare")].replace(
        "drives:", "  again: {type: prismatic, bodies: [ground, slider], axis: [1, 0, 0]}\ndrives:"
    )
    scenario.write_text(text)
    code, document = answer("check", "crank.yaml")
    assert code == 0
    [found] = document["scenarios"]
    assert len(found["redundant"]) == 2
    assert {name.split(".")[0] for name in found["not_unique"]} >= {"guide", "again"}
    assert found["mobility"] == 0


def test_show_and_report(scenario, trsim, answer, monkeypatch):
    drawn.few(monkeypatch)
    drawn.blank(monkeypatch)
    trsim("run", "crank.yaml", "-o", "x.h5", "--set", *small.FEW)
    code, out, _ = trsim("show", "x.h5")
    assert code == 0
    assert "301 rows" in out or "301 of" in out
    assert "B.contact_force" in out
    code, document = answer("show", "x.h5")
    assert document["channels"]["stroke"] == "m"
    code, document = answer("report", "x.h5")
    assert code == 0
    assert document["folder"] == "x"
    assert all(Path(name).stat().st_size > 0 for name in document["files"])
    assert "x/orbit_B.png" in document["files"]


# --- killed ----------------------------------------------------------------------------------


def test_killed_run_leaves_a_readable_part(scenario):
    process = outside.trsim(scenario.parent, "run", "crank.yaml", "--set", outside.LONG)
    part = scenario.parent / "runs/crank.h5.part"
    wait_for(part)
    while (seen := read(part).rows) == 0:  # it can be read while it grows
        time.sleep(0.05)
    outside.killed(process)
    result = read(part)
    assert result.attributes["status"] == "running"
    assert result.rows >= seen
    assert np.all(np.diff(result.time) > 0.0)
    for name in result.names:
        assert np.all(np.isfinite(result.channel(name)))
    assert not (scenario.parent / "runs/crank.h5").exists()


GUIDES = """
bodies: {b: {mass: 1, inertia: 1, velocity: [1, 0]}}
joints:
  g: {type: prismatic, bodies: [ground, b], axis: [1, 0, 0]}
  h: {type: prismatic, bodies: [ground, b], axis: [1, 0.001, 0]}
solver: {end: 1 ms}
"""


def test_warnings_and_redundancy_are_told_by_run_and_kept_for_show(trsim, answer, scenario):
    scenario.write_text(GUIDES)
    _, _, err = trsim("run", scenario, "-o", "g.h5")
    assert err.count("warning: bodies.b.velocity: given as [1, 0, 0]") == 1
    assert "1 constraint row dropped (h.tilt 1)" in err and "reactions of g, h are not" in err
    _, document = answer("run", scenario, "-o", "g.h5")
    (ran,) = document["runs"]
    assert len(ran["warnings"]) == 1 and ran["redundant"] == ["h.tilt 1"]
    assert ran["not_unique"] == ["g.tilt 1", "h.tilt 1"] and ran["mobility"] == 0
    _, shown = answer("show", "g.h5")
    assert all(shown[key] == ran[key] for key in ("warnings", "redundant", "not_unique"))
    _, out, _ = trsim("show", "g.h5")
    assert "  warning   bodies.b.velocity" in out and "  redundant 1 constraint row" in out
    assert next(line for line in out.splitlines() if "h.reaction " in line).endswith("h.tilt 1")
    _, out, _ = trsim("check", scenario)
    assert "given ones changed most: b by 1 m/s" in out


@pytest.mark.parametrize(
    "old, new, path",
    [
        ("when: B.eccentricity_x_rate", "when: nope", "poincare.journal.when"),
        ("when: B.eccentricity_x_rate", "when: crank.position", "poincare.journal.when"),
        ("every: 0.01 ms", "every: 1e-30", "output.every"),
        (
            "method: dop853",
            "method: rk4, step: 1e-6, force: true}\noutput: {every: 1e-12",
            "output",
        ),
        ("method: dop853", "method: rk4, step: 0.05 ms", "solver.step"),
    ],
)
def test_check_refuses_what_run_refuses(old, new, path, answer, scenario):
    text = small.SLIDER_CRANK.replace(old, new)
    if "every: 1e-12" in new:
        text = text.replace("every: 1e-12, end: 3 ms, tolerance: 1e-6}", "every: 1e-12}")
        text = text.replace("force: true}", "force: true, end: 3 ms}")
        text = text.replace("output: {every: 0.01 ms}\n", "")
    scenario.write_text(text)
    (of_run, of_check) = (answer(word, scenario) for word in ("run", "check"))
    assert of_run[0] == of_check[0] == 3
    assert of_run[1]["errors"] == of_check[1]["errors"]
    assert of_check[1]["errors"][0]["path"].startswith(path)


def test_check_lets_a_forced_step_pass(answer, scenario):
    forced = "method: rk4, step: 0.05 ms, force: true"
    scenario.write_text(small.SLIDER_CRANK.replace("method: dop853", forced))
    assert answer("check", scenario)[0] == 0


DRIVEN = """
bodies: {rod: {mass: 2 kg, inertia: 0.05 kg*m^2, at: [0.2, 0]}}
joints: {hinge: {type: revolute, bodies: [ground, rod], at: [0, 0]}}
drives: {motor: {joint: hinge, velocity: 2 rad/s}}
sensors: {angle: {joint: hinge}}
solver: {end: 1}
"""


@pytest.mark.parametrize(
    "more, driven",
    [
        ("", True),
        ("phases: [{name: turn, for: 0.2 s}]", False),
        ("events: {go: {when: t, value: 0.5, do: {release: [motor]}}}", False),
        ("events: {seen: {when: t, value: 0.5, do: {record: true}}}", True),
        ("forces: {end: {type: limit_stop, joint: hinge, upper: 1, stiffness: 1e4}}", False),
    ],
)
def test_check_proposes_kinematic_analysis_where_it_is_taken(more, driven, scenario, answer, trsim):
    scenario.write_text(DRIVEN + more)
    [found] = answer("check", "crank.yaml")[1]["scenarios"]
    assert found["kinematic"] is driven
    _, said, _ = trsim("check", "crank.yaml")
    assert ("`method: kinematic`" in said) is driven
