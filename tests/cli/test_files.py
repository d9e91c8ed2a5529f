"""Commands on result files: export, recover, and run of a result."""

import csv

import h5py
import numpy as np
import pytest

from tests import inside, small
from tests.store import outside
from trsim.store.read import read, verify


@pytest.fixture
def result(scenario):
    small.copy(scenario.parent / "x.h5")
    return read(scenario.parent / "x.h5")


def table(path):
    with open(path, newline="") as file:
        head, *rows = csv.reader(file)
    return head, np.array(rows, float)


# --- export ----------------------------------------------------------------------------------


def test_export_all(result, answer):
    code, document = answer("export", "x.h5", "--csv")
    assert code == 0
    assert document["file"] == "x.csv"
    head, rows = table("x.csv")
    assert head[0] == "time [s]"
    assert head[1:] == [
        f"{name} [{result.unit(name.rpartition('.')[0] if name not in result.units else name)}]"
        for name in document["channels"]
    ]
    assert rows.shape == (result.rows, 1 + sum(result.sizes.values()))
    np.testing.assert_array_equal(rows[:, 0], result.time)  # to the last digit
    for name in ("stroke", "B.force.y", "rod.position.x"):
        column = 1 + document["channels"].index(name)
        np.testing.assert_array_equal(rows[:, column], result.channel(name))


@pytest.mark.parametrize(
    "patterns, columns",
    [
        (("stroke",), ["stroke [m]"]),
        (("B.force",), ["B.force.x [N]", "B.force.y [N]", "B.force.z [N]"]),
        (("B.force.y", "strok?"), ["B.force.y [N]", "stroke [m]"]),
        (("B.force.y, strok?",), ["B.force.y [N]", "stroke [m]"]),
    ],
)
def test_export_some(patterns, columns, result, trsim):
    chosen = [word for pattern in patterns for word in ("--channels", pattern)]
    code, out, _ = trsim("export", "x.h5", "--csv", "-o", "deep/", *chosen)
    assert (code, out) == (0, "deep/x.csv\n")
    assert sorted(table("deep/x.csv")[0][1:]) == sorted(columns)


def test_export_refuses(result, trsim):
    code, _, err = trsim("export", "x.h5", "--csv", "--channels", "strke")
    assert code == 2
    assert "Did you mean 'stroke'?" in err
    assert trsim("export", "none.h5", "--csv")[0] == 7
    assert trsim("export", "x.h5", "--csv", "-o", "crank.yaml/x.csv")[0] == 7
    assert trsim("export", "x.h5", "-o", "x.txt")[0] == 2


# --- run of a result -------------------------------------------------------------------------


def test_run_of_a_result_is_identical(scenario, trsim, answer):
    """Also of one made by `extends` and `--set`, after its scenario is gone."""
    (scenario.parent / "load.yaml").write_text("extends: crank.yaml\ntitle: Löwe\n")
    trsim("run", "load.yaml", "--set", "joints.B.clearance=0.3mm")
    scenario.unlink()
    code, document = answer("run", "runs/load.h5")
    assert code == 0
    [summary] = document["runs"]
    assert summary["file"] == "runs/load.again.h5"
    assert summary["identical"]
    first, again = read("runs/load.h5"), read("runs/load.again.h5")
    assert again.attributes["content_sha256"] == first.attributes["content_sha256"]
    assert verify(again.path)
    code, document = answer("run", "runs/load.h5", "--set", "solver.end=1ms", "-o", "y.h5")
    assert document["runs"][0]["identical"] is False
    assert read("y.h5").time[-1] == 0.001
    code, document = answer("check", "y.h5")
    assert document["scenarios"][0]["title"] == "Löwe"


def test_a_damaged_result_is_not_what_it_says(scenario, trsim, answer):
    trsim("run", "crank.yaml")
    with h5py.File("runs/crank.h5", "r+") as file:
        file["stroke"][5] += 1e-9
    code, document = answer("run", "runs/crank.h5", "-o", "again.h5")
    assert code == 0
    assert "identical" not in document["runs"][0]


# --- show ------------------------------------------------------------------------------------


def test_verify(result, answer, trsim):
    """The hash is compared, not only printed."""
    code, document = answer("show", "x.h5", "--verify")
    assert (code, document["verified"]) == (0, True)
    assert answer("show", "x.h5")[1]["verified"] is None
    with h5py.File("x.h5", "r+") as file:
        file["stroke"][5] += 1e-9
    assert trsim("show", "x.h5")[0] == 0
    code, document = answer("show", "x.h5", "--verify")
    assert code == 7
    [error] = document["errors"]
    assert "x.h5 does not hold what was written: its content hash differs" in error["what"]
    with h5py.File("x.h5", "r+") as file:
        del file.attrs["content_sha256"]
    code, _, err = trsim("show", "x.h5", "--verify")
    assert code == 7 and "x.h5 has no content hash to compare with" in err


# --- recover ---------------------------------------------------------------------------------


def test_recover(scenario, trsim, answer, monkeypatch):
    process = outside.begun(scenario.parent)
    outside.blocks_until(process, 0.7)
    outside.killed(process)
    code, out, err = trsim("recover", "runs/crank.h5.part")
    assert (code, out) == (0, "runs/crank.recovered.h5\n")
    assert "the run was 'running'" in err
    assert read("runs/crank.recovered.h5").attributes["status"] == "recovered"
    for command in (("show",), ("export", "--csv", "--channels", "stroke")):
        assert trsim(*command, "runs/crank.recovered.h5")[0] == 0
    inside.recovering(monkeypatch)  # what was read above does not end its reader
    code, document = answer("recover", "runs/crank.h5.part", "-o", "x.h5")
    assert code == 0
    assert document["rows"] == read("x.h5").rows > 0
    assert document["was"] == "running"


def test_recover_refuses(result, trsim):
    assert trsim("recover", "none.h5.part")[0] == 7
    assert trsim("recover", "crank.yaml")[0] == 7
    assert trsim("recover", "x.h5", "-o", "x.h5")[0] == 2
    assert trsim("recover", "x.h5", "-o", "crank.yaml/x.h5")[0] == 7


def test_no_file_but_a_result_is_written_over(trsim, scenario):
    text = scenario.read_text()
    code, _, err = trsim("run", "crank.yaml", "-o", "crank.yaml")
    assert code == 2 and "is not a result file" in err
    assert scenario.read_text() == text
