"""Which actuator is to blame where its line has no length left."""

import pytest

from trsim.solve.diagnose.blame import drawn_in
from trsim.solve.start.consistent import start

from ..runs import assemble, scenario

JACK = """
bodies: {{box: {{mass: 1, inertia: 0.1, at: [0.5, 0]}}}}
joints: {{slide: {{type: prismatic, bodies: [ground, box], axis: [1, 0, 0]}}}}
drives:
  jack: {{type: actuator, bodies: [ground, box], points: [[0, 0], [0.5, 0]], position: {stroke},
         stiffness: 1e4, damping: 10}}
initial: {{slide: {stroke}}}
solver: {{end: 1}}
"""


@pytest.mark.parametrize("stroke, told", [(0.0, False), (-0.4, False), (-0.499, True)])
def test_an_actuator_that_is_drawn_in(stroke, told):
    """Behind joints, which have no line that could end."""
    read = scenario(JACK.format(stroke=stroke))
    mechanism = assemble(read)
    said = drawn_in(read, mechanism, start(read, mechanism, located=True).y)
    assert (said.startswith("drives.jack") and "a stroke of -0.499 m" in said) == told
    assert bool(said) == told
