import pytest

from tests import small
from tests.store import outside
from trsim.assemble.assemble import assemble
from trsim.scenario.load import loads
from trsim.store.read import read


@pytest.fixture(scope="session")
def result(tmp_path_factory):
    """A complete result file, opened."""
    path = tmp_path_factory.mktemp("store") / "run.h5"
    small.run(path)
    return read(path)


@pytest.fixture(scope="session")
def scenario():
    return loads(small.SLIDER_CRANK)


@pytest.fixture(scope="session")
def mechanism(scenario):
    return assemble(scenario)


@pytest.fixture(scope="session")
def running_part(tmp_path_factory):
    """The file of a run that was killed."""
    folder = tmp_path_factory.mktemp("killed")
    process = outside.begun(folder)
    outside.blocks_until(process, 1.2)
    outside.killed(process)
    return folder / "runs/crank.h5.part"
