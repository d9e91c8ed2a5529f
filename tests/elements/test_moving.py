"""Channels of places and rates alone: no force has to be known for them."""

import numpy as np
import pytest

from trsim.assemble.assemble import assemble
from trsim.assemble.equations import derivative
from trsim.assemble.outputs import measured
from trsim.elements import ELEMENTS, load
from trsim.elements.scene import scene
from trsim.scenario.load import loads

MOVING = [key for key in ELEMENTS if any(c.moves for c in load(key).channels)]


def test_which():
    assert {"rigid_body", "sensor", "clearance_joint"} <= {*MOVING}


@pytest.mark.parametrize("key", MOVING)
def test_forces_have_no_part_in_them(key):
    """At a place off the start, in touch and not."""
    example = loads(load(key).example)
    mechanism = assemble(example)
    columns = {c.name: c for c in mechanism.columns}
    rng, found = np.random.default_rng(3), 0
    w = scene(mechanism.model)
    y = mechanism.y0 + 1e-3 * rng.standard_normal(mechanism.y0.size)
    derivative(w, 0.1, y, np.empty(y.size))
    told = []
    for other in (None, 1e3, -7.0):  # as if accelerations and loads were others
        for array in (w.A, w.lam, w.F, w.zd, w.free, w.x) if other else ():
            array[...] = other
        measured(w, 0.1, y, 0.0, 0.0)
        told.append(w.out.copy())
    for instance in mechanism.instances:
        for channel in instance.channels:
            column = columns.get(f"{instance.name}.{channel.name}".rstrip("."))
            if channel.moves and column is not None:
                own = slice(column.start, column.start + column.size)
                found += column.size
                assert all(np.array_equal(told[0][own], x[own]) for x in told), column.name
    assert found > 0
