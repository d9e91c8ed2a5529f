"""What stands for an energy where nothing can move: the largest force along the size."""

from types import SimpleNamespace

import numpy as np
import pytest

from trsim.assemble.equations import derivative
from trsim.elements.scene import scene
from trsim.solve.outcome import of_what_is_locked
from trsim.solve.start.consistent import start

from ..runs import assemble, scenario

TOGGLE = """
bodies:
  left: {{mass: 1e-6, inertia: 1e-6, at: [-0.5, 0.005]}}
  right: {{mass: 1e-6, inertia: 1e-6, at: [0.5, 0.005]}}
joints:
  a: {{type: revolute, bodies: [ground, left], at: [-1, 0]}}
  top: {{type: revolute, bodies: [left, right], at: [0, 0.01]}}
  b: {{type: revolute, bodies: [right, ground], at: [1, 0]}}
forces: {{push: {{type: applied_load, body: left, at: {at}, direction: {way}, force: 7}}}}
gravity: [0, 0]
solver: {{end: 1}}
"""


@pytest.mark.parametrize("at, way, times", [
    ([0, 0.01], [0, -1], 50.0),  # almost flat, the bars press a hundred times as hard, half each
    ([-1, 0], [1, 0], 1.0),  # on the ground nothing else is loaded
])  # fmt: skip
def test_a_toggle_that_is_pushed(at, way, times):
    read = scenario(TOGGLE.format(at=at, way=way))
    mechanism = assemble(read)
    begun = start(read, mechanism, located=True)
    w = scene(mechanism.model)
    w.mem[:], w.branch[:] = begun.mem, begun.branch
    derivative(w, 0.0, begun.y, np.zeros_like(begun.y))
    record = SimpleNamespace(peak=np.zeros((4, w.n_out)))
    found = of_what_is_locked(record, w, SimpleNamespace(speed=0.0))
    assert found == pytest.approx(times * 7.0 * w.size, rel=1e-3)
