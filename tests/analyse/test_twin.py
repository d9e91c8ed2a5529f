"""The twin is as tight as rounding allows, and no tighter."""

import pytest

from tests import mechanisms, small
from trsim.analyse.twin import overrides, twin_setting
from trsim.assemble.assemble import assemble
from trsim.scenario.load import loads

UNEQUAL = """
planar: false
gravity: [0, 0, -9.81]
bodies:
  needle: {mass: 1, inertia: [1e-12, 0.08, 0.08], at: [0.5, 0, 0], angular_velocity: [0, 1, 2]}
joints: {ball: {type: spherical, bodies: [ground, needle], at: [0, 0, 0]}}
solver: {method: radau, end: 3 s, tolerance: 1e-8}
"""  # what turns the needle about itself is rounding, 1e-16 N m over its inertia


def setting(text, *sets):
    scenario = loads(text, sets)
    return twin_setting(scenario, assemble(scenario))


@pytest.mark.parametrize("method, other", [("auto", "radau"), ("radau", "dop853")])
def test_a_hundred_times_tighter(method, other):
    for text in (mechanisms.torsion_pendulum()[0], small.SLIDER_CRANK):
        found = setting(text, f"solver.method={method}", "solver.tolerance=1e-6")
        assert (found.method, found.tolerance) == (other, pytest.approx(1e-8))


def test_rounding_is_seen():
    assert setting(UNEQUAL).tolerance == 1e-8
    assert setting(UNEQUAL, "bodies.needle.inertia=[0.08, 0.08, 0.08]").tolerance == pytest.approx(
        1e-10
    )


def test_tightest():
    assert setting(mechanisms.torsion_pendulum()[0], "solver.tolerance=1e-14").tolerance == 1e-14


def test_events_of_the_twin_are_located():
    scenario = loads(small.SLIDER_CRANK, ["solver.locate_events=false"])
    found = overrides(scenario, twin_setting(scenario, assemble(scenario)))
    assert found == ("solver.method=radau", "solver.tolerance=1e-08", "solver.locate_events=true")
