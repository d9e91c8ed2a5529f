"""Figures of flexible bars: forces over time, shapes, one run and two."""

import numpy as np
import pytest

from tests import small
from trsim.report import report
from trsim.report.bars import line, nodes
from trsim.report.display import compared
from trsim.store.read import read

from .test_figures import drawn

TEXT = """
gravity: [0, -9.81, 0]
bodies:
  rod: {type: ancf_cable, start: [0, 0], end: [1, 0], elements: 4, section: {width: 5 mm},
        youngs_modulus: 1.6e6, density: 320}
joints: {pin: {type: revolute, bodies: [ground, rod], at: [0, 0]}}
solver: {end: 0.2 s, tolerance: 1e-4}
"""


@pytest.fixture(scope="module")
def runs(tmp_path_factory):
    folder = tmp_path_factory.mktemp("bars")
    for elements in (4, 2):
        small.run(folder / f"{elements}.h5", f"bodies.rod.elements={elements}", text=TEXT)
    return [folder / "4.h5", folder / "2.h5"]


@pytest.mark.parametrize("several", [False, True])
def test_drawn(several, runs, tmp_path):
    written = report(runs if several else runs[0], tmp_path / "figures")
    own = [path for path in written if path.stem in ("bar_rod", "shapes_rod")]
    assert len(own) == 2
    for path in own:
        assert 0.005 < drawn(path) < 0.5, path.name


def test_line(runs):
    """The line drawn goes through the nodes, in the units of the figures (mm)."""
    (shown,) = compared([read(runs[0])])
    assert nodes(shown, "rod") == 5
    found = line(shown, "rod")
    assert found[0, :, 0] == pytest.approx(np.linspace(0.0, 1000.0, 5))
    assert found[-1, -1] == pytest.approx(1e3 * read(runs[0]).channel("rod.tip")[-1])
