"""A motion or a load with a corner exactly where the run ends: what would follow is not run."""

import numpy as np
import pytest

from trsim.solve.diagnose.doubts import doubts

from ..runs import run

SLIDE = """
bodies: {block: {mass: 2, inertia: [0.01, 0.01, 0.01]}}
joints: {slide: {type: prismatic, bodies: [ground, block], axis: [1, 0, 0]}}
sensors: {x: {joint: slide}}
WHAT
solver: {end: 1, SOLVER}
output: {every: 0.1}
"""
METHODS = (
    "method: dop853", "method: radau", "method: generalized_alpha", "method: auto",
    "method: rk4, step: 0.01", "method: scipy:RK45",
)  # fmt: skip


@pytest.mark.parametrize("method", METHODS)
def test_a_drive_to_the_end_of_its_table(method):
    """The last row has the rate with which the block arrives; nothing stops it."""
    table = "{table: [[0, 0], [1, 0.3]], interpolation: linear}"
    what = f"drives: {{pull: {{joint: slide, position: {table}}}}}"
    r = run(SLIDE.replace("WHAT", what).replace("SOLVER", method))
    assert r["x.rate"] == pytest.approx(np.full(11, 0.3), rel=1e-6)
    assert r.outcome.record.work_projection == pytest.approx(0.0, abs=1e-9)
    assert not [x for x in doubts(r.scenario, r.mechanism, r.outcome) if "bringing" in x]
    assert len(r.events) == 0


@pytest.mark.parametrize("method", METHODS)
def test_a_load_that_sets_in_at_the_end(method):
    """It has no part in the last row."""
    load = '{type: applied_load, body: block, direction: [1, 0, 0], force: "4 + 100*(t >= 1)"}'
    r = run(SLIDE.replace("WHAT", f"forces: {{push: {load}}}").replace("SOLVER", method))
    assert r["block.acceleration"][-1, 0] == pytest.approx(2.0)
