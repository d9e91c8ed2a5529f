"""Bodies as they are solved: flexible bars, and their nodes."""

import numpy as np
import pytest

from trsim.assemble.members import members
from trsim.scenario.load import loads

from ..runs import built

TEXT = """
bodies:
  bar: {type: ancf_cable, start: [0.2, 0.1, 0], end: [1.4, 0.7, 0], section: {diameter: 20 mm},
        elements: 3, youngs_modulus: 2e11, density: 7800}
  block: {mass: 1, inertia: 1}
joints: {clamp: {type: fixed, bodies: [ground, bar], at: [0.2, 0.1, 0]}}
solver: {end: 1}
"""


def test_nodes_are_drawn_in_equal_parts_from_end_to_end():
    (bar,) = built(TEXT).beams.values()
    expected = [[0.2 + 0.4 * k, 0.1 + 0.2 * k, 0.0] for k in range(4)]
    assert np.asarray(bar.places) == pytest.approx(np.array(expected), abs=1e-12)


def test_bars_bend_unless_all_are_asked_to_be_stiff():
    scenario = loads(TEXT)
    assert members(scenario)["bar"].flexible is not None
    assert members(scenario, stiff=True)["bar"].flexible is None
