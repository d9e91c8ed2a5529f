import pytest

from tests import small


@pytest.fixture(scope="session")
def paths(tmp_path_factory):
    """Two result files that differ in one clearance."""
    folder = tmp_path_factory.mktemp("report")
    for name, clearance in (("a", "0.5mm"), ("b", "0.1mm")):
        small.run(folder / f"{name}.h5", f"joints.B.clearance={clearance}")
    return [folder / "a.h5", folder / "b.h5"]
