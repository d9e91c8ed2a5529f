"""Tables for other programs: what their own readers find in them is what stands in the result."""

import io
import os
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest

from tests import small
from trsim.store.export import export
from trsim.store.export.mat import variables
from trsim.store.export.sheet import MOST_ROWS, cell, check_room
from trsim.store.read import read

NAMES = ["stroke", "B.force.x", "B.force.y", "rod.position.z"]


@pytest.fixture(scope="module")
def run(tmp_path_factory):
    path = tmp_path_factory.mktemp("export") / "x.h5"
    small.copy(path)
    return read(path)


def rows(run):
    """What stands in the result, (rows, columns)."""
    return np.column_stack([run.time, *(run.channel(name) for name in NAMES)])


def titles(run):
    return ["time [s]", "stroke [m]", "B.force.x [N]", "B.force.y [N]", "rod.position.z [m]"]


@pytest.mark.parametrize("form, between", [("csv", ","), ("tsv", "\t")])
def test_text(form, between, run, tmp_path):
    path = tmp_path / f"x.{form}"
    assert export(run, NAMES, path, form) == run.rows
    head, *lines = path.read_text().splitlines()
    assert head.split(between) == titles(run)
    found = np.array([[float(x) for x in line.split(between)] for line in lines])
    np.testing.assert_array_equal(found, rows(run))


def test_sheet(run, tmp_path):
    reader = pytest.importorskip("openpyxl")
    path = tmp_path / "x.xlsx"
    export(run, NAMES, path, "xlsx")
    sheet = reader.load_workbook(path)["channels"]
    head, *lines = sheet.iter_rows(values_only=True)
    assert list(head) == titles(run)
    np.testing.assert_array_equal(np.array(lines, float), rows(run))  # to the last digit
    assert sheet.freeze_panes == "B2"


def test_sheet_says_what_it_cannot_hold(run):
    class Columns:
        names = NAMES

        class run:
            rows = MOST_ROWS

    with pytest.raises(Exception, match="1048576 rows are too many"):
        check_room(Columns)
    Columns.run.rows = MOST_ROWS - 1
    check_room(Columns)
    assert (cell(float("nan")), cell(1e-300)) == ("<c/>", "<c><v>1e-300</v></c>")
    assert "#NUM!" in cell(float("-inf"))


def test_parquet(run, tmp_path):
    reader = pytest.importorskip("pyarrow.parquet")
    path = tmp_path / "x.parquet"
    export(run, NAMES, path, "parquet")
    found = reader.read_table(path)
    assert found.column_names == ["time", *NAMES]
    units = [found.schema.field(name).metadata[b"units"] for name in found.column_names]
    assert units == [b"s", b"m", b"N", b"N", b"m"]
    values = np.column_stack([found[name].to_numpy() for name in found.column_names])
    np.testing.assert_array_equal(values, rows(run))
    assert found.schema.metadata[b"trsim.title"].decode() == run.attributes["title"]


def test_mat(run, tmp_path):
    from scipy.io import loadmat

    path = tmp_path / "x.mat"
    export(run, NAMES, path, "mat")
    found = loadmat(path, squeeze_me=True)
    np.testing.assert_array_equal(found["B_force_y"], run.channel("B.force.y"))
    about = found["trsim"]
    names, channels, units = (about[key].item().tolist() for key in
                              ("variables", "channels", "units"))  # fmt: skip
    assert channels == ["time", *NAMES] and units == ["s", "m", "N", "N", "m"]
    values = np.column_stack([found[name] for name in names])
    np.testing.assert_array_equal(values, rows(run))
    assert loadmat(path)["time"].shape == (run.rows, 1)


def test_names_of_variables():
    given = ["a.b_c", "a_b.c", "end", "trsim", "2nd.force", "x" * 90, "x" * 91]
    found = variables(given)
    assert found[:5] == ["a_b_c", "a_b_c_2", "end_2", "trsim_2", "x2nd_force"]
    assert all(name.isidentifier() and len(name) <= 63 for name in found)
    assert len({*found}) == len(given)


@pytest.mark.parametrize("form", ["csv", "tsv", "xlsx", "parquet", "mat"])
def test_the_same_to_the_byte_and_only_its_own_is_replaced(form, run, tmp_path, monkeypatch):
    if form == "parquet":
        pytest.importorskip("pyarrow")
    path = tmp_path / f"x.{form}"
    export(run, NAMES, path, form)
    before = path.read_bytes()
    monkeypatch.setattr("time.time", lambda: 4e9)
    monkeypatch.setattr("time.asctime", lambda *_: "another day")
    export(run, NAMES, path, form)
    assert path.read_bytes() == before
    path.write_bytes(before[:4] + b" of somebody else " * 20)
    with pytest.raises(Exception, match="exists and is not a"):
        export(run, NAMES, path, form)


def test_without_a_package(run, tmp_path, monkeypatch):
    monkeypatch.setitem(sys.modules, "pyarrow", None)
    with pytest.raises(Exception, match="needs the package pyarrow") as caught:
        export(run, NAMES, tmp_path / "x.parquet", "parquet")
    assert 'pip install "trsim[parquet]"' in caught.value.hint
    assert list(tmp_path.iterdir()) == []


def test_command(run, tmp_path, monkeypatch):
    """By the ending, by the option, on standard output; what does not fit is refused."""

    def command(*words):
        full = [sys.executable, "-m", "trsim", "export", str(run.path), *words]
        env = os.environ | {"PYTHONPATH": str(Path(__file__).parents[2])}
        done = subprocess.run(full, capture_output=True, cwd=tmp_path, check=False, env=env)  # noqa: S603
        return done.returncode, done.stdout, done.stderr.decode()

    code, out, _ = command("-o", "-", "--channels", "stroke")
    table = np.loadtxt(io.BytesIO(out), delimiter=",", skiprows=1)
    assert code == 0
    np.testing.assert_array_equal(table, np.column_stack([run.time, run.channel("stroke")]))
    assert command("-o", "-", "--format", "tsv", "--channels", "stroke")[1] == out.replace(
        b",", b"\t"
    )
    assert command("-o", "deep/a.MAT")[0] == 0 and (tmp_path / "deep/a.MAT").is_file()
    assert command("-o", "sub/", "--format", "xlsx")[1] == b"sub/x.xlsx\n"
    for words, what in ((("-o", "a.txt"), ".csv, .tsv, .xlsx"),
                        (("-o", "a.xlsx", "--csv"), "format csv"),
                        (("-o", "-", "--json"), "standard output")):  # fmt: skip
        code, _, err = command(*words)
        assert code == 2
        if "--json" not in words:
            assert what in err
