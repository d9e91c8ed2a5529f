import h5py
import numpy as np
import pytest
import xarray

from tests import small
from trsim.errors import FileError, UsageError
from trsim.store import describe
from trsim.store.read import read


def test_what_cannot_be_read_is_told(result, tmp_path):
    whole = result.path.read_bytes()
    cases = {
        "text.h5": (b"title: x", "is not a result file"),
        "empty.h5": (b"", "is not a result file"),
        "short.h5": (whole[: len(whole) // 2], "is truncated"),
    }
    for name, (content, message) in cases.items():
        (tmp_path / name).write_bytes(content)
        with pytest.raises(FileError, match=message):
            read(tmp_path / name)
    with pytest.raises(FileError, match="no such file"):
        read(tmp_path / "none.h5")
    with h5py.File(tmp_path / "other.h5", "w") as file:
        file["x"] = 1
    with pytest.raises(FileError, match="not a result of trsim"):
        read(tmp_path / "other.h5")


def test_newer_format_is_refused(result, tmp_path):
    (tmp_path / "new.h5").write_bytes(result.path.read_bytes())
    with h5py.File(tmp_path / "new.h5", "r+") as file:
        file.attrs["format_version"] = 99
    with pytest.raises(FileError, match="format 99"):
        read(tmp_path / "new.h5")


def test_unknown_channel_and_contact(result):
    with pytest.raises(UsageError, match=r"(?s)'strke'.*Did you mean 'stroke'"):
        result.channel("strke")
    with pytest.raises(UsageError, match="no contact 'A'"):
        result.steps("A")


def test_cause_names_what_the_system_said():
    text = "Can't write (errno = 28, error message = 'No space left on device', buf = 0x5)"
    assert describe.cause(OSError(text)) == "No space left on device"


@pytest.mark.parametrize("key", ["units", "long_name"])
@pytest.mark.parametrize("value", [3.0, ["m", "m"], None])
def test_what_a_dataset_says_of_itself_is_text(key, value, tmp_path):
    small.copy(tmp_path / "x.h5", *small.FEW)
    with h5py.File(tmp_path / "x.h5", "r+") as file:
        file["stroke"].attrs[key] = h5py.Empty("S1") if value is None else value
    with pytest.raises(FileError, match=f"its {key} is no text"):
        read(tmp_path / "x.h5")


def test_units_are_those_that_were_written(tmp_path):
    """As variable text, as text of fixed length, or not there."""
    small.copy(tmp_path / "x.h5", *small.FEW)
    with h5py.File(tmp_path / "x.h5", "r+") as file:
        assert read(tmp_path / "x.h5").units["stroke"] == file["stroke"].attrs["units"] == "m"
        file["stroke"].attrs["units"] = "µm"
        del file["motor.force"].attrs["units"]
    found = read(tmp_path / "x.h5")
    assert (found.units["stroke"], found.units["motor.force"]) == ("µm", "-")


def test_xarray_opens_a_result_with_one_line(tmp_path):
    small.run(tmp_path / "run.h5", *small.FEW)
    result = read(tmp_path / "run.h5")
    with xarray.open_dataset(result.path, engine="h5netcdf") as data:
        assert data.sizes["time"] == result.rows
        for name in result.names:
            np.testing.assert_array_equal(data[name].values, result.channel(name))
            assert data[name].attrs["units"] == result.unit(name)
            assert data[name].dims[0] == "time"
        np.testing.assert_array_equal(data.time.values, result.time)
        place = data["crank.position"].sel({"component.xyz": "y"})
        np.testing.assert_array_equal(place, result.channel("crank.position.y"))
