"""Laws as pictures and tables."""

import csv

import pytest

from tests import small
from tests.analyse.test_laws_used import DOOR
from tests.report.test_figures import drawn
from trsim.analyse.laws_used import laws
from trsim.errors import UsageError
from trsim.report import analysed, check_asked
from trsim.report import laws as of_laws
from trsim.report.asked import Asked
from trsim.report.display import compared
from trsim.report.style import look
from trsim.store.read import read


def rows(path):
    with path.open(newline="") as file:
        return list(csv.DictReader(file))


def test_a_picture_and_a_table_of_each_law(tmp_path):
    small.run(tmp_path / "door.h5", text=DOOR)
    found = analysed([tmp_path / "door.h5"], tmp_path / "out", Asked(laws=True))
    stems = {path.stem for path in found.files}
    assert stems == {"laws", *(f"law_{name}" for name in (
        "drives_handle_position", "drives_push_position", "forces_seal_elastic",
        "forces_seal_damper", "forces_rope_elastic", "forces_wind_force"))}  # fmt: skip
    for path in found.files:
        assert path.suffix != ".png" or 0.005 < drawn(path) < 0.6, path.name
    table = rows(tmp_path / "out" / "law_forces_seal_elastic.csv")
    assert [*table[0]] == ["part", "stretch [rad]", "elastic [N*m]"]
    data = [row for row in table if row["part"] == "data"]
    assert [float(row["elastic [N*m]"]) for row in data] == [5.0, 0.0, 8.0]
    listed = {row["law"]: row for row in rows(tmp_path / "out" / "laws.csv")}
    assert float(listed["drives.handle.position"]["visited to"]) == pytest.approx(0.7)
    assert any(line.startswith("forces.both.force: depends on t and way") for line in found.lines)


def test_units_of_a_picture(tmp_path):
    small.run(tmp_path / "door.h5", text=DOOR)
    [shown] = compared([read(tmp_path / "door.h5")])
    [law] = [law for law in laws(shown.run)[0] if law.name == "forces.seal.elastic"]
    with look():
        axes = of_laws.figure(shown, law).axes[0]
    assert (axes.get_xlabel(), axes.get_ylabel()) == ("stretch (deg)", "elastic (N·m)")
    [data] = [line for line in axes.lines if line.get_label() == "data"]
    assert data.get_xdata()[-1] == pytest.approx(22.918, abs=1e-3)


def test_several_runs_and_contacts(paths, tmp_path):
    found = analysed(paths, tmp_path, Asked(laws=True))
    assert {path.stem for path in found.files} == {"laws", "law_contact_B", "law_contact_B_2"}
    assert {row["part"] for row in rows(tmp_path / "law_contact_B.csv")} == {
        "at rest", "impact", "steps of the run"}  # fmt: skip
    assert len({row["law"] for row in rows(tmp_path / "laws.csv")}) == 2


def test_a_run_without_laws(tmp_path):
    text = DOOR.split("drives:")[0] + "solver: {end: 0.1 s}\n"
    small.run(tmp_path / "x.h5", text=text)
    found = analysed([tmp_path / "x.h5"], tmp_path / "out", Asked(laws=True))
    assert found.lines == ["no law that varies, no contact and no curve: nothing is drawn"]
    with pytest.raises(UsageError, match="--laws is not for a sweep"):
        check_asked([tmp_path], Asked(laws=True))
