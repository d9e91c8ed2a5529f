import h5py
import pytest

from tests import small
from trsim.store import grow, hdf5
from trsim.store.read import verify


def test_content_hash(result, tmp_path):
    same = small.run(tmp_path / "same.h5")
    assert same["content_sha256"] == result.attributes["content_sha256"]
    assert verify(tmp_path / "same.h5")
    other = small.run(tmp_path / "other.h5", "joints.B.clearance=0.500001mm")
    assert other["content_sha256"] != result.attributes["content_sha256"]


def test_content_hash_does_not_depend_on_flushes(result, tmp_path, monkeypatch):
    monkeypatch.setattr(hdf5, "FLUSHED", 0.0)
    monkeypatch.setattr(grow, "LONGEST", 64)
    assert small.run(tmp_path / "run.h5")["content_sha256"] == result.attributes["content_sha256"]


@pytest.mark.parametrize("what", ["row", "attribute", "text", "peak"])
def test_content_hash_covers(what, tmp_path):
    path = tmp_path / "run.h5"
    small.copy(path)
    with h5py.File(path, "r+") as file:
        if what == "row":
            file["B.force"][150, 1] += 1e-12
        elif what == "attribute":
            file["stroke"].attrs["units"] = "mm"
        elif what == "text":
            text = file["scenario/text"].asstr()[()]
            file["scenario/text"][()] = text.replace("play", "plan")
        else:
            file["peaks/value"][3] += 1.0
    assert not verify(path)


def test_content_hash_leaves_out_provenance(tmp_path):
    path = tmp_path / "run.h5"
    small.copy(path)
    with h5py.File(path, "r+") as file:
        file["provenance"].attrs["machine"] = "another"
    assert verify(path)
