"""Energy sensor: it shows what the energy book says, and what bodies have in the plane."""

import numpy as np
import pytest

from trsim.errors import TrsimError

from ..runs import built, run

SPINNING = """
bodies: {wheel: {mass: 2, inertia: 0.3, velocity: [3, 4], angular_velocity: [0, 0, 6]}}
sensors: {k: {type: energy, of: kinetic}, s: {type: energy, of: stored}, e: {type: energy}}
forces: {brake: {type: applied_load, body: wheel, direction: [0, 0, 1], torque: -0.6}}
events: {slow: {when: k, value: 27.4, crosses: down, do: {end: true}}}
solver: {end: 5, tolerance: 1e-10}
output: {every: 0.1}
"""


def test_energy_of_a_wheel():
    """m v^2 / 2 + I (w - M t / I)^2 / 2 = 27.4 J where 2/3 of the spin is left: after 1 s."""
    r = run(SPINNING)
    assert r["k"] == pytest.approx(25 + 0.15 * (6 - 2 * r.t) ** 2, rel=1e-9)
    assert r["k"] == pytest.approx(r["energy.kinetic"], rel=1e-12)
    assert np.array_equal(r["e"], r["k"]) and not r["s"].any()
    assert r.outcome.time == pytest.approx(1.0, abs=1e-7)


def test_energy_of_a_tumbling_body():
    text = """
planar: false
bodies: {rod: {mass: 2, inertia: [0.02, 0.03, 0.04, 0.001, 0.002, -0.003], angle: 0.7,
         velocity: [1, 0, 2], angular_velocity: [3, 1, -2]}}
sensors: {k: {type: energy, of: kinetic}, s: {type: energy, of: stored}, e: {type: energy}}
gravity: [0, 0, -9.81]
solver: {end: 0.5, tolerance: 1e-9}
"""
    r = run(text)
    assert r["k"] == pytest.approx(r["energy.kinetic"], rel=1e-12)
    assert r["s"] == pytest.approx(r["energy.stored.gravity"], abs=1e-12)
    assert np.ptp(r["e"]) < 1e-8


BAR = """
bodies: {bar: {type: ancf_cable, start: [0, 0], end: [1, 0], section: {diameter: 20 mm},
         elements: 2, youngs_modulus: 207 GPa, density: 7850}}
joints: {pin: {type: revolute, bodies: [ground, bar], at: [0, 0]}}
sensors: {k: {type: energy, of: KIND}}
gravity: [0, -9.81]
solver: {end: 1 ms}
"""


def test_energy_of_flexible_bars():
    r = run(BAR.replace("KIND", "stored"))
    total = r["energy.stored.springs"] + r["energy.stored.gravity"]
    assert r["k"] == pytest.approx(total, abs=1e-12)
    with pytest.raises(TrsimError, match="energy book alone"):
        built(BAR.replace("KIND", "total"))


def test_what_a_stop_stores_counts():
    """A block runs into a spring of a stop: m v^2 / 2 = k d^2 / 2 where it turns round."""
    r = run("""
bodies: {block: {mass: 2 kg, inertia: 0.01, velocity: [0.5, 0]}}
joints: {slide: {type: prismatic, bodies: [ground, block], axis: [1, 0, 0]}}
forces: {bumper: {type: limit_stop, joint: slide, upper: 20 mm, stiffness: 1e4 N/m}}
sensors: {stored: {type: energy, of: stored}, all: {type: energy}}
solver: {end: 0.1}
output: {every: 1 ms}
""")
    depth = np.maximum(r["bumper.penetration"], 0.0)
    assert r["stored"] == pytest.approx(0.5e4 * depth**2, abs=1e-12)
    assert r.largest("stored")[0] == pytest.approx(0.25, rel=1e-8)
    assert r["all"] == pytest.approx(np.full(len(r.t), 0.25), rel=1e-7)
