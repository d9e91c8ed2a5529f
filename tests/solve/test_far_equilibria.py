"""Balances that are far from the drawing, and loads without one."""

import pytest

from trsim.errors import ModelError
from trsim.scenario.load import loads
from trsim.solve.start.consistent import start

from ..runs import assemble

SCENE = """
planar: PLANAR
gravity: [0, 0, 0]
bodies: {rod: {mass: 2, inertia: [0.1, 0.1, 0.05], at: [0.4, 0.1, 0]}}
joints: {hinge: {type: revolute, bodies: [ground, rod], at: [0, 0, 0]}}
sensors: {angle: {joint: hinge}}
forces: {LOAD}
initial: {equilibrium: [hinge]}
solver: {end: 0.1}
"""


def begun(load, planar="true"):
    scenario = loads(SCENE.replace("LOAD", load).replace("PLANAR", planar))
    mechanism = assemble(scenario)
    found = start(scenario, mechanism, located=True)
    return found.branch[mechanism.coordinates["hinge"].entry]


@pytest.mark.parametrize("planar", ["true", "false"])
@pytest.mark.parametrize("moment", [240.0, -360.0])
def test_a_spring_wound_by_turns(moment, planar):
    load = f"coil: {{type: torsion_spring, joint: hinge, stiffness: 40, preload: {moment}}}"
    assert begun(load, planar) == pytest.approx(moment / 40.0, rel=1e-9)


def test_a_moment_that_goes_on_for_ever():
    with pytest.raises(ModelError, match="no static equilibrium found"):
        load = '{type: applied_load, body: rod, direction: [0, 0, 1], torque: "3 + 2*sin(angle)"}'
        begun(f"push: {load}")
