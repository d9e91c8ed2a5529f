"""The equations of motion of a body or two, against what is written on paper."""

import numpy as np
import pytest

from trsim.assemble.equations import derivative, kinetic, largest_wrench
from trsim.elements.scene import scene
from trsim.solve.start.consistent import start

from ..runs import assemble, scenario

BODY = "bodies: {b: {mass: 2, inertia: [0.1, 0.2, 0.4], at: [0.3, 0.2]}}\nsolver: {end: 1}\n"


def ready(text):
    """Workspace and state of a scenario at its start."""
    read = scenario(text)
    mechanism = assemble(read)
    begun = start(read, mechanism, True)
    w = scene(mechanism.model)
    w.mem[:], w.branch[:] = begun.mem, begun.branch
    return w, begun.y.copy()


@pytest.mark.parametrize("direction", [[1, 0, 0], [0, 1, 0], [0, 0, 1]])
def test_a_free_body_goes_where_it_is_pushed(direction):
    push = f"forces: {{push: {{type: applied_load, body: b, direction: {direction}, force: 6}}}}\n"
    w, y = ready("planar: false\n" + BODY + push)
    rates = np.zeros_like(y)
    derivative(w, 0.0, y, rates)
    assert rates[w.n_q : w.n_q + 3] == pytest.approx(3.0 * np.array(direction), abs=1e-12)


@pytest.mark.parametrize("axis", [[1, 0, 0], [0, 1, 0], [0, 0, 1]])
def test_a_moment_counts_as_a_force_at_the_size(axis):
    twist = f"forces: {{twist: {{type: applied_load, body: b, direction: {axis}, torque: 5}}}}\n"
    w, y = ready("planar: false\n" + BODY + twist)
    derivative(w, 0.0, y, np.zeros_like(y))
    assert largest_wrench(w, 0.0) == pytest.approx(5.0 / w.size, rel=1e-12)


def test_evaluations_are_counted():
    w, y = ready(BODY)
    before = int(w.status[1])
    for k in range(1, 4):
        derivative(w, 0.0, y, np.zeros_like(y))
        assert int(w.status[1]) == before + k


def test_kinetic_energy_of_a_flexible_bar_and_a_body():
    """Both go in a straight line: half their masses times the squares of their speeds."""
    w, y = ready("""
bodies:
  b: {mass: 2, inertia: 0.1, at: [3, 3], velocity: [0, 5]}
  bar: {type: ancf_cable, start: [0, 0, 0], end: [1, 0, 0], section: {width: 0.1, height: 0.1},
        elements: 2, youngs_modulus: 1e9, density: 700, velocity: [3, 4, 0]}
solver: {end: 1}
""")
    assert kinetic(w, y) == pytest.approx(0.5 * 7.0 * 25 + 0.5 * 2.0 * 25, rel=1e-12)


def test_loads_of_nodes_are_those_of_now():
    """Evaluated again at the same place, a bar under its weight is pushed no harder."""
    w, y = ready("""
bodies:
  bar: {type: ancf_cable, start: [0, 0, 0], end: [1, 0, 0], section: {width: 0.1, height: 0.1},
        elements: 2, youngs_modulus: 1e9, density: 700}
joints: {clamp: {type: fixed, bodies: [ground, bar], at: [0, 0, 0]}}
gravity: [0, -9.81]
solver: {end: 1}
""")
    first, again = np.zeros_like(y), np.zeros_like(y)
    derivative(w, 0.0, y, first)
    derivative(w, 0.0, y, again)
    assert np.abs(first).max() > 1.0
    assert again == pytest.approx(first, rel=1e-9, abs=1e-9)
