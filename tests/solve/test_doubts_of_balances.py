"""What is said of the start of a static path: joints move bodies, or the balance does."""

import pytest

from trsim.solve.diagnose.doubts import doubts, settled

from ..runs import run

HUNG = """
gravity: [0, -10, 0]
bodies: {b: {mass: 1, inertia: 0.01, at: [0, 0]}}
joints: {v: {type: prismatic, bodies: [ground, b], at: [0, 0], axis: [0, 1, 0]}}
forces:
  sp: {type: spring_damper, bodies: [ground, b], points: [[0, 1], [0, 0]], stiffness: K,
       free_length: 1}
solver: {method: static_path, end: 0.1}
output: {every: 0.05}
"""
ROD = """
gravity: [0, -10, 0]
bodies: {b: {mass: 1, inertia: 0.01, at: [0.1, 0]}}
joints: {o: {type: revolute, bodies: [ground, b], at: [0, 0]}}
solver: {method: static_path, end: 0.1}
output: {every: 0.05}
"""


def said(text):
    r = run(text)
    return [*doubts(r.scenario, r.mechanism, r.outcome)]


@pytest.mark.parametrize("stiffness", [1000, 2e4])
def test_a_settlement_is_not_told(stiffness):
    """10 mm, and half a millimetre: no joint is open as drawn."""
    assert said(HUNG.replace("K", str(stiffness))) == []


def test_a_static_phase_that_begins_a_run():
    text = HUNG.replace("K", "1000").replace("method: static_path, ", "")
    assert said(text + "phases: [{name: rest, static: true, for: 0.1}]\n") == []


def test_a_balance_that_is_far_away():
    """10 N on 20 N/m: half a metre."""
    (found,) = said(HUNG.replace("K", "20"))
    assert found.startswith("bodies.b: in the balance that the path begins in it is 0.5 m away")


def test_a_rod_that_hangs_down():
    (found,) = said(ROD)
    assert "in the balance that the path begins in" in found


def test_a_drawing_that_a_drive_does_not_meet():
    text = HUNG.replace("K", "1000")
    text = text.replace("forces:", "drives: {d: {joint: v, position: 0.2 + 0.1*t}}\nforces:")
    (found,) = said(text)
    assert found.startswith("bodies.b: starts 0.2 m from where it is drawn, to meet joints")


@pytest.mark.parametrize("solver", ["method: static_path, ", ""])
@pytest.mark.parametrize("stiffness, moved", [(200, "moved 'b' by 0.05 m"), (2000, "")])
def test_how_far_an_equilibrium_moves_a_body(solver, stiffness, moved):
    """10 N on a spring in a mechanism of 1 m; half a per cent is no news."""
    text = HUNG.replace("K", str(stiffness)).replace("method: static_path, ", solver)
    text += "" if solver else "initial: {equilibrium: all}\n"
    r = run(text)
    found = settled(r.scenario, r.mechanism, r.outcome.start)
    assert found == (f"the equilibrium at the start {moved}" if moved else "")


def test_nothing_is_said_of_a_start_as_drawn():
    text = HUNG.replace("K", "200").replace("method: static_path, ", "")
    r = run(text)
    assert settled(r.scenario, r.mechanism, r.outcome.start) == ""


def test_a_rod_that_its_equilibrium_lets_down():
    r = run(ROD)
    found = settled(r.scenario, r.mechanism, r.outcome.start)
    assert found == "the equilibrium at the start moved 'b' by 0.141 m"
