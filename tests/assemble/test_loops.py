"""Which bodies are in kinematic loops."""

from ..linkages import four_bar
from ..runs import built

ROTOR = """
bodies:
  a: {mass: 1, inertia: 0.1, at: [0.5, 0]}
  b: {mass: 1, inertia: 0.1, at: [1, 0.5]}
  c: {mass: 1, inertia: 0.1, at: [0.5, 1]}
  rotor: {mass: 1, inertia: 0.1, at: [0.5, 0]}
joints:
  A: {type: revolute, bodies: [ground, a], at: [0, 0]}
  B: {type: revolute, bodies: [a, b], at: [1, 0]}
  C: {type: revolute, bodies: [b, c], at: [1, 1]}
  axle: {type: revolute, bodies: [a, rotor], at: [0.5, 0]}
%s
drives: {spin: {joint: axle, velocity: 100}}
solver: {end: 1}
"""
CLOSING = "  D: {type: revolute, bodies: [ground, c], at: [0, 1]}"


def names(mechanism):
    frames = {f: name for name, f in mechanism.frames.items()}
    return [frames[f] for f in mechanism.model.looped.tolist()]


def test_a_rotor_on_a_loop_is_not_in_it():
    """Its drive is between bodies that its joint joins already."""
    assert names(built(ROTOR % CLOSING)) == ["a", "b", "c"]


def test_a_chain_has_none():
    assert names(built(ROTOR % "")) == []


def test_a_ring_of_two_bodies_and_the_ground():
    assert len(built(four_bar("true", "", end=1)).model.looped) == 3
