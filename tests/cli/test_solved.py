"""`trsim run` says by which method a run was solved, why `auto` changed it, and the CPU time."""

import re

import numpy as np
import pytest

import trsim as package
from tests.solve.test_auto import DAMPED

LINE = r"x\.yaml: solved by (.*); ([0-9.e+-]+) s of CPU$"


@pytest.fixture
def told(tmp_path, monkeypatch, trsim):
    """Runs a text; what is said of its method, and the result file."""
    monkeypatch.chdir(tmp_path)

    def of(text, *options):
        (tmp_path / "x.yaml").write_text(text, encoding="utf-8")
        code, _, err = trsim("run", "x.yaml", "-o", "x.h5", *options)
        assert code == 0, err
        (line,) = re.findall(LINE, err, re.MULTILINE)
        result = package.Result("x.h5")
        cpu = result.run.group("provenance")["integration_cpu"]
        assert float(line[1]) == pytest.approx(cpu, rel=0.01, abs=1e-3)
        return line[0], result

    return of


def test_what_does_not_change(told):
    text = DAMPED.format(force="200*t", end=0.001, more="").replace("20000", "2")
    assert told(text)[0] == "auto: dop853 all the time, no stiff stretch was met"
    assert told(text.replace("method: auto", "method: radau"))[0] == "radau"
    fixed = ("--set", "solver.step=1e-5")
    assert told(text.replace("method: auto", "method: rk4"), *fixed)[0] == "rk4"
    assert told(text.replace("method: auto", "method: scipy:RK45"))[0] == "scipy:RK45"


def test_why_it_changed(told):
    """A block of 2 kg on 20 000 N s/m: m v' = -c v has the rate c/m = 1e4 1/s."""
    line, result = told(DAMPED.format(force="200*t", end=1, more=""))
    found = re.fullmatch(
        r"auto: dop853, from t = (\S+) s on radau, as the motion is stiff there "
        r"\(rates up to (\S+) 1/s\), so that stability, not accuracy, "
        r"would set the steps of dop853",
        line,
    )
    assert found, line
    when, rate = map(float, found.groups())
    events = result.events
    assert when == pytest.approx(events[events.kind == "to implicit"].time.iloc[0], rel=1e-4)
    assert rate == pytest.approx(1e4, rel=0.01)


def test_there_and_back(told):
    more = "events: {tick: {when: t, value: 0.4, do: {record: true}}}"
    line, result = told(DAMPED.format(force="200*t", end=1, more=more))
    assert re.search(r"from t = \S+ to 0\.4 s radau, as", line), line
    assert line.endswith("; 3 changes of method"), line
    assert np.count_nonzero(result.events.element == "solver") == 3


def test_phases_that_are_all_static(told):
    text = """
gravity: [0, 0, 0]
bodies: {b: {mass: 1, inertia: 1, at: [0, 0]}}
joints: {g: {type: prismatic, bodies: [ground, b], axis: [1, 0, 0]}}
drives: {d: {joint: g, velocity: 0}}
phases:
  - {name: there, static: true, drive: {d: {velocity: 1}}, for: 2 ms}
  - {name: back, STATIC drive: {d: {velocity: -1}}, for: 2 ms}
solver: {end: 1}
output: {every: 1 ms}
"""
    assert told(text.replace("STATIC", "static: true,"))[0] == "static_path"
    assert told(text.replace("STATIC", ""))[0].startswith("auto: dop853")
