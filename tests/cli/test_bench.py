"""trsim bench, as a command."""

import os
import signal

import pytest

from trsim.analyse import precision

QUICK = ("--methods", "dop853,rk4", "--tolerances", "1e-3,1e-4", "--steps", "50 us",
         "--reference", "radau:1e-5", "--repeats", "1")  # fmt: skip


def test_table_and_files(scenario, trsim):
    code, out, err = trsim("bench", "crank.yaml", *QUICK)
    assert code == 0
    assert "reference  radau, tolerance 1e-05, beside dop853" in out
    assert "left out    crank_angle.rate: no motion" in out
    assert (
        "failed: a value is not finite, or grew beyond bounds: the fixed step is too large" in out
    )
    assert "slope of error over tolerance, dop853: " in out
    assert "slope of error over step, rk4: - " in out
    assert "3 of 3: rk4" in err
    folder = scenario.parent / "runs" / "crank.bench"
    assert {path.name for path in folder.iterdir()} == {"work_precision.png", "work_precision.csv"}


def test_document(scenario, answer):
    code, told = answer("bench", "crank.yaml", *QUICK, "--quantity", "stroke", "-o", "here")
    assert code == 0
    assert told["folder"] == "here"
    assert [p["status"] for p in told["points"]] == ["done", "done", "failed"]
    assert list(told["points"][0]["errors"]) == ["stroke"] == list(told["reference"]["ranges"])
    assert all(p["error"] == p["errors"]["stroke"] > 0.0 for p in told["points"][:2])
    assert told["points"][2]["error"] is None
    assert told["slopes"]["rk4"] is None


@pytest.mark.parametrize("number, code", [(signal.SIGINT, 130), (signal.SIGTERM, 143)])
def test_a_signal_keeps_what_was_measured(number, code, scenario, answer, monkeypatch):
    measure = precision.point

    def then_killed(of, to, setting, *options):
        if setting.tolerance == 1e-4:
            os.kill(os.getpid(), number)
        return measure(of, to, setting, *options)

    monkeypatch.setattr(precision, "point", then_killed)
    ended, told = answer("bench", "crank.yaml", *QUICK)
    assert ended == code
    assert [p["tolerance"] for p in told["points"]] == [1e-3]
    assert len(told["files"]) == 2


@pytest.mark.parametrize(
    "options, message",
    [
        (("--methods", "dop583"), "Did you mean 'dop853'?"),
        (("--tolerances", "1e-3,x"), "'x' is no tolerance"),
        (("--tolerances", "1e-15"), "from 1e-14 to 0.1"),
        (("--steps", "3 kg"), "'3 kg' is no step"),
        (("--steps", "-1"), "A step is positive"),
        (("--reference", "radau"), "Write for example radau:1e-10"),
        (("--reference", "rk4:1e-3"), "rk4 has no tolerance"),
        (("--quantity", "strke"), "no channel fits 'strke'"),
        (("--repeats", "0"), "0 is not in the range"),
    ],
)
def test_usage(options, message, scenario, trsim):
    code, _, err = trsim("bench", "crank.yaml", *options)
    assert code == 2
    assert message in err
