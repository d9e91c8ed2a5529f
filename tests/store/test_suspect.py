"""Files as a run leaves them are to blame for nothing."""

import shutil

from trsim.store.suspect import blamed


def test_a_file_as_a_run_leaves_it(result):
    assert blamed(result.path) is None


def test_a_file_that_is_no_more_than_its_beginning(result, tmp_path):
    path = tmp_path / "half.h5"
    shutil.copy(result.path, path)
    with path.open("r+b") as file:
        file.truncate(path.stat().st_size // 2)
    found = blamed(path)
    assert found is not None and str(path) in found.file
