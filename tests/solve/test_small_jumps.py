"""A load that jumps by next to nothing where a place comes to rest: pieces whose numbers are
rounded.  What holds it there is known to the size of the jump, so the run goes on."""

import numpy as np
import pytest

from ..runs import run

BLOCK = """
bodies: {{block: {{mass: 2 kg, inertia: 0.01, velocity: [0.05, 0, 0]}}}}
joints: {{guide: {{type: prismatic, bodies: [ground, block], axis: [1, 0, 0], at: [0, 0, 0]}}}}
sensors: {{x: {{joint: guide}}}}
forces:
  pad: {{type: applied_load, body: block, direction: [1, 0, 0], force: '{force}'}}
solver: {{end: 3, method: {method}}}
"""


@pytest.mark.parametrize("method", ["dop853", "auto", "radau"])
@pytest.mark.parametrize("jump", [1e-9, 1e-7])
def test_what_rests_on_a_jump_of_rounded_numbers_goes_on(method, jump):
    force = f"-1000*x - 60*x.rate - {jump}*sign(x)"
    r = run(BLOCK.format(force=force, method=method))
    assert abs(r["block.position"][-1, 0]) < 1e-9  # the spring holds it where it holds itself
    assert r.outcome.statistics["steps"] < 10000


def test_a_jump_that_something_rests_on_ends_the_run():
    text = BLOCK.format(force="-1000*x - 60*x.rate - 0.01*sign(x)", method="dop853")
    r = run(text, fails=True)
    assert "what it depends on rests at a corner" in r.outcome.reason
    assert np.abs(r["block.position"][-1, 0]) < 1e-4
