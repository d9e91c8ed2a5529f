"""Tables of numbers that runs are laid over."""

import numpy as np
import pytest

from trsim.analyse.reference import given, reference
from trsim.errors import FileError, UsageError


def test_reference_with_units(tmp_path):
    path = tmp_path / "old.csv"
    path.write_text("# a remark\ntime [ms],stroke [mm],other\n1,2,9\n0,5,8\n2,3,7\n")
    found = reference(path, "stroke", "", ("s", "m"))
    np.testing.assert_allclose(found.s, [0.0, 1e-3, 2e-3])
    np.testing.assert_allclose(found.x, [5e-3, 2e-3, 3e-3])


def test_reference_of_two_columns_needs_no_names(tmp_path):
    path = tmp_path / "old.csv"
    path.write_text("a,b\n0,1\n1,2\n")
    np.testing.assert_array_equal(reference(path, "stroke", "", ("s", "m")).x, [1.0, 2.0])


@pytest.mark.parametrize("titles", ["time,stroke", "stroke,time", "stroke,other,time", "x,time"])
def test_time_is_the_column_of_that_name(titles, tmp_path):
    path = tmp_path / "old.csv"
    rows = [[{"time": k, "other": 7}.get(name, 5 - k) for name in titles.split(",")]
            for k in range(3)]  # fmt: skip
    path.write_text("\n".join([titles, *(",".join(map(str, row)) for row in rows)]))
    found = reference(path, "stroke", "", ("s", "m"))
    np.testing.assert_array_equal(found.s, [0.0, 1.0, 2.0])
    np.testing.assert_array_equal(found.x, [5.0, 4.0, 3.0])


@pytest.mark.parametrize(
    "text, kind, what",
    [
        ("stroke,b\n0,1\n1,2\n", UsageError, "'time' and 'stroke' at once"),
        ("a,b,c\n0,1,2\n1,2,3\n", UsageError, "no column named 'stroke'"),
        ("a,b\n0,1\n1,x\n", FileError, "no number in column 2"),
        ("a,b\n0,1\n1\n", FileError, "no number in column 2"),
        ("a,b\n0,nan\n1,2\n", FileError, "no number in column 2"),
        ("a,b\n", FileError, "no table"),
        ("0,1\n1,2\n2,3\n", FileError, "no table"),
        ("time,b,b\n0,1,2\n1,2,3\n", FileError, "two columns named 'b'"),
        ("a [s],b [kg]\n0,1\n1,2\n", UsageError, "is no unit of"),
        ("a [s],b [qq]\n0,1\n1,2\n", UsageError, "unknown unit"),
    ],
)
def test_tables_that_make_no_sense(text, kind, what, tmp_path):
    (tmp_path / "old.csv").write_text(text)
    with pytest.raises(kind, match=what):
        reference(tmp_path / "old.csv", "stroke", "", ("s", "m"))


def test_no_table(tmp_path):
    with pytest.raises(FileError, match="no such file"):
        reference(tmp_path / "old.csv", "stroke", "", ("s", "m"))
    (tmp_path / "old.csv").write_bytes(b"\xff\xfe\x00")
    with pytest.raises(FileError, match="cannot be read"):
        reference(tmp_path / "old.csv", "stroke", "", ("s", "m"))


def test_columns_as_they_stand(tmp_path):
    """Rows keep their order, X is the first column unless one has its name, units are kept."""
    path = tmp_path / "old.csv"
    path.write_text("phi [deg],F [kN],time [ms],w\n90,1,0,5\n180,2,7,6\n90,3,9,7\n")
    found = given(path, "angle", {"F": "N", "w": "rad/s", "M": "N*m"}, "rad")
    np.testing.assert_allclose(found.x, np.array([0.5, 1.0, 0.5]) * np.pi)
    np.testing.assert_allclose(found.y["F"], [1e3, 2e3, 3e3])
    np.testing.assert_allclose(found.time, [0.0, 7e-3, 9e-3])
    assert (found.bare, [*found.y]) == (("w",), ["F", "w"])
    over = given(path, "w", {"F": "N"}, "rad/s")
    np.testing.assert_allclose(over.x, [5.0, 6.0, 7.0])
    assert given(path, "time", {"F": "N"}, "s").time is None
