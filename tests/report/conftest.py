import pytest

from tests import small

from .filmed import HATCH, ROD, of


@pytest.fixture(scope="session")
def paths(tmp_path_factory):
    """Two result files that differ in one clearance."""
    folder = tmp_path_factory.mktemp("report")
    for name, clearance in (("a", "0.5mm"), ("b", "0.1mm")):
        small.run(folder / f"{name}.h5", f"joints.B.clearance={clearance}")
    return [folder / "a.h5", folder / "b.h5"]


@pytest.fixture(scope="session")
def crank(tmp_path_factory):
    """A slider-crank with clearance, and without rotations."""
    return of(tmp_path_factory.mktemp("crank"))


@pytest.fixture(scope="session")
def bar(tmp_path_factory):
    return of(tmp_path_factory.mktemp("bar"), text=ROD)


@pytest.fixture(scope="session")
def hatch(tmp_path_factory):
    return of(tmp_path_factory.mktemp("hatch"), text=HATCH)
