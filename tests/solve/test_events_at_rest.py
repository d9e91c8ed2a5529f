"""What tables of events tell of static paths: rates along the path, and no energy of speeds."""

import numpy as np
import pytest

from ..runs import run

DRIVEN = """
gravity: [0, -10, 0]
bodies: {b: {mass: 10, inertia: 0.1, at: [0, 0]}}
joints: {g: {type: prismatic, bodies: [ground, b], axis: [1, 0, 0]}}
drives: {d: {joint: g, MOTION}}
sensors: {x: {joint: g}}
forces:
  sp: {type: spring_damper, bodies: [ground, b], points: [[-1, 0], [0, 0]], stiffness: 1000}
  fr: {type: joint_friction, joint: g,
       friction: {law: modified_coulomb, coefficient: MU, v0: 0, v1: 1 mm/s}}
events: {e: {when: d.force, value: 25, crosses: both, do: {record: true}}}
solver: {METHOD, end: 1 s}
output: {every: 0.1}
"""
SINE = 'position: "0.1*sin(3*t)"'
PATH = "method: static_path"


def speeds(r):
    return r.events[r.events[:, 1] == 5.0][:, 3]


def test_the_rate_of_a_force():
    """1000 x = 25 at sin(3 t) = 1/4, where x' is 0.3 cos(3 t); there and back."""
    r = run(DRIVEN.replace("MOTION", SINE).replace("MU", "1e-12").replace("METHOD", PATH))
    rate = 300.0 * np.sqrt(1.0 - 0.25**2)
    assert speeds(r) == pytest.approx([rate, -rate], rel=1e-6)


def test_the_same_beside_friction():
    """1000 x + 20 = 25, and 1000 x - 20 = 25 on the way back."""
    r = run(DRIVEN.replace("MOTION", SINE).replace("MU", "0.2").replace("METHOD", PATH))
    rates = [300.0 * np.sqrt(1.0 - s**2) for s in (0.05, 0.45)]
    assert speeds(r) == pytest.approx([rates[0], -rates[1]], rel=1e-6)


def test_a_time_passes_at_a_rate_of_one():
    text = DRIVEN.replace("when: d.force, value: 25, crosses: both", "when: t, value: 0.3")
    r = run(text.replace("MOTION", SINE).replace("MU", "1e-12").replace("METHOD", PATH))
    assert speeds(r) == pytest.approx([1.0])


PHASES = """
phases:
  - {name: a, static: true, drive: {d: {velocity: 0.04}}, for: 1 s}
  - {name: b, static: true, drive: {d: {velocity: -0.03}}, for: 0.5 s}
"""


def test_speeds_of_a_path_have_neither_energy_nor_momentum():
    """40 mm/s and then -30 mm/s: of 10 kg that would be 3.5 mJ and 0.7 N s."""
    text = DRIVEN.replace("MOTION", "velocity: 0").replace("MU", "0.2")
    r = run(text.replace("METHOD", "method: auto").replace("end: 1 s", "end: 3 s") + PHASES)
    assert r.t[-1] == pytest.approx(1.5)
    assert r.events[:, 5] == pytest.approx(np.zeros(len(r.events)), abs=1e-12)
    assert not len(r.impulses) and not len(r.jumps)
    assert speeds(r)[1] == pytest.approx(40.0, rel=1e-6)  # of d.force, at t = 1/8 s
