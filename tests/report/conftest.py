import pytest

from tests import small
from trsim.store.read import read


@pytest.fixture(scope="session")
def result(tmp_path_factory):
    """A complete result file, opened."""
    path = tmp_path_factory.mktemp("store") / "run.h5"
    small.run(path)
    return read(path)
