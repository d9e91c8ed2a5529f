"""Friction of a joint as an explicit method feels it: N mu / ((v1 - v0) m)."""

import pytest

from trsim.solve.diagnose.linearised import linearised
from trsim.solve.diagnose.rub_scales import rub_scales
from trsim.solve.start.consistent import start

from ..runs import assemble, scenario

BOX = """
bodies: {box: {mass: 4, inertia: 1}}
joints: {slide: {type: prismatic, bodies: [ground, box], axis: [1, 0, 0]}}
gravity: [0, -10, 0]
solver: {end: 1}
"""
RUBS = """
forces:
  rub: {type: joint_friction, joint: slide,
        friction: {law: modified_coulomb, coefficient: 0.2, v0: 0, v1: 1 mm/s}}
"""


@pytest.mark.parametrize("more, expected", [("", []), (RUBS, [(-0.2 * 10 / 1e-3, "rub")])])
def test_a_box_on_its_guide(more, expected):
    read = scenario(BOX + more)
    mechanism = assemble(read)
    begun = start(read, mechanism, located=True)
    found = list(rub_scales(mechanism, begun, linearised(mechanism, begun)))
    assert [name for _, name in found] == [name for _, name in expected]
    assert [x for x, _ in found] == pytest.approx([x for x, _ in expected])
