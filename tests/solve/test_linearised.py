"""The linearised motion: frequencies and dampings with a known answer."""

from math import sqrt

import numpy as np
import pytest

from trsim.elements.scene import scene as workspace
from trsim.solve.diagnose.linearised import Probe, linearised, smooth
from trsim.solve.start.consistent import start

from ..linkages import INERTIA, slider_crank
from ..mechanisms import compound_pendulum, free_top, torsion_pendulum
from ..runs import assemble, scenario

EXACT = 1e-6


def linear(text, *sets):
    read = scenario(text, "solver.end=1", *sets)
    mechanism = assemble(read)
    return linearised(mechanism, start(read, mechanism, located=True))


def frequencies(found):
    """rad/s, of an undamped motion."""
    return np.sqrt(np.sort(np.linalg.eigvals(found.K).real))


def oscillator(m=2.0, k=450.0, c=6.0, planar="true"):
    return f"""
planar: {planar}
bodies: {{mass: {{mass: {m}, {INERTIA}}}}}
joints: {{slide: {{type: prismatic, bodies: [ground, mass], axis: [1, 0, 0]}}}}
forces:
  spring: {{type: spring_damper, bodies: [ground, mass], points: [[-1, 0], [0, 0]],
           stiffness: {k}, damping: {c}}}
"""


@pytest.mark.parametrize("planar", ["true", "false"])
def test_spring_mass_damper(planar):
    m, k, c = 2.0, 450.0, 6.0
    found = linear(oscillator(m, k, c, planar))
    assert pytest.approx(np.array([[k / m]]), rel=EXACT) == found.K
    assert pytest.approx(np.array([[c / m]]), rel=EXACT) == found.C
    values = sorted(np.linalg.eigvals(found.A), key=lambda x: x.imag)
    damped = sqrt(k / m - (c / (2 * m)) ** 2)
    assert values == pytest.approx(
        [complex(-c / (2 * m), -damped), complex(-c / (2 * m), damped)], rel=EXACT
    )


def test_torsion_pendulum():
    found = linear(torsion_pendulum(theta0=0.3)[0])
    assert frequencies(found) == pytest.approx([20.0], rel=EXACT)


@pytest.mark.parametrize("planar", ["true", "false"])
def test_compound_pendulum(planar):
    m, L, J, g = 2.0, 0.4, 0.05, 9.81
    for theta in (0.0, 0.7):  # V'' = m g L cos theta, also away from equilibrium
        text = compound_pendulum(theta, m, L, J, g)[0]
        text = text.replace(f"inertia: {J}", f"inertia: [1, 2, {J}]")
        squared = m * g * L * np.cos(theta) / (J + m * L * L)
        found = linear(text, f"planar={planar}")
        assert frequencies(found) == pytest.approx([sqrt(squared)], rel=EXACT)


def chain(n=5, m=0.7, k=1e4):
    """n masses between two walls, n + 1 springs."""
    lines = ["planar: true", "bodies:"]
    lines += [f"  m{i}: {{mass: {m}, inertia: 1, at: [{i}, 0]}}" for i in range(1, n + 1)]
    lines += ["joints:"]
    lines += [
        f"  s{i}: {{type: prismatic, bodies: [ground, m{i}], axis: [1, 0, 0]}}"
        for i in range(1, n + 1)
    ]
    lines += ["forces:"]
    names = ["ground", *(f"m{i}" for i in range(1, n + 1)), "ground"]
    for i in range(n + 1):
        ends = f"bodies: [{names[i]}, {names[i + 1]}], points: [[{i}, 0], [{i + 1}, 0]]"
        lines += [f"  k{i}: {{type: spring_damper, {ends}, stiffness: {k}}}"]
    return "\n".join(lines)


def test_chain_of_masses():
    n, m, k = 5, 0.7, 1e4
    found = linear(chain(n, m, k))
    exact = [2 * sqrt(k / m) * np.sin(p * np.pi / (2 * (n + 1))) for p in range(1, n + 1)]
    assert frequencies(found) == pytest.approx(exact, rel=EXACT)
    assert pytest.approx(found.K.T, abs=1e-6 * k / m) == found.K
    assert found.Z.T @ (m * found.Z) == pytest.approx(np.eye(n), abs=1e-9)


def test_spinning_top():
    """A symmetric top that spins about its axis nods at I3 / I1 of its spin."""
    values = np.linalg.eigvals(linear(free_top((1.0, 1.0, 3.0), (0, 0, 4.0))[0]).A)
    assert sorted(np.round(values.imag, 6)) == [-12.0, *[0.0] * 10, 12.0]
    assert np.abs(values.real).max() < 1e-6


def test_sleeping_top():
    """Lagrange's top, upright on its point.

    I theta'' - i I3 omega theta' - m g L theta = 0,    theta = theta_x + i theta_y in world axes
    """
    m, L, I0, I3, g, omega = 2.0, 0.3, 0.02, 0.03, 9.81, 90.0
    text = f"""
planar: false
gravity: [0, 0, {-g}]
bodies:
  top: {{mass: {m}, inertia: [{I0}, {I0}, {I3}], at: [0, 0, {L}],
        angular_velocity: [0, 0, {omega}]}}
joints: {{tip: {{type: spherical, bodies: [ground, top], at: [0, 0, 0]}}}}
"""
    I = I0 + m * L * L
    root = sqrt((I3 * omega) ** 2 - 4 * I * m * g * L)
    values = np.linalg.eigvals(linear(text).A)
    for rate in ((I3 * omega + root) / (2 * I), (I3 * omega - root) / (2 * I)):
        assert np.abs(values - 1j * rate).min() < EXACT * abs(rate)


def test_a_moving_loop():
    """A slider-crank in motion:  v = s angle',  v' = s angle'' + s' angle'^2,  s = dq / dangle."""
    r, L, angle0, h = 0.3, 1.0, np.radians(30), 1e-3
    at = f"at: [{r / 2 * sqrt(0.75)}, 0.075]"
    text = slider_crank("true")
    assert at in text
    read = scenario(text.replace(at, f"{at}, angular_velocity: [0, 0, 7]"))
    mechanism = assemble(read)
    begun = start(read, mechanism, located=True)
    found, turning0 = linearised(mechanism, begun), begun.y[9 + 2]

    def q(angle):
        beta = np.arcsin(r * np.sin(angle) / L)
        x, y = r * np.cos(angle), r * np.sin(angle)
        crank, rod = [x / 2, y / 2, angle], [x + L / 2 * np.cos(beta), y / 2, -beta]
        return np.array([*crank, *rod, x + L * np.cos(beta), 0, 0])

    def slope(f, angle):  # of fourth order
        near, far = f(angle + h) - f(angle - h), f(angle + 2 * h) - f(angle - 2 * h)
        return (8 * near - far) / (12 * h)

    M = np.array([1, 1, 0.03] * 3)
    s0 = slope(q, angle0)
    size = sqrt(s0 @ (M * s0))
    Z = s0 / size

    def rate(xi, eta):
        """eta' = Z^T M v' at the angle that xi stands for, where Z^T M v = eta + its start."""
        angle = angle0 + xi / size
        s, bend = slope(q, angle), slope(lambda a: slope(q, a), angle)
        turning = (size * turning0 + eta) / (Z @ (M * s))
        return Z @ (M * (bend - s * (s @ (M * bend)) / (s @ (M * s)))) * turning**2

    assert abs(turning0) > 1.0
    K, C = -slope(lambda x: rate(x, 0.0), 0.0), -slope(lambda x: rate(0.0, x), 0.0)
    assert found.K[0, 0] == pytest.approx(K, rel=EXACT)
    # C vanishes: what is left of it is rounding of the rates
    assert abs(C) < 1e-12
    assert found.C[0, 0] == pytest.approx(0.0, abs=1e-10 * abs(turning0))


def test_stiffness_of_a_closed_loop():
    """One freedom of a slider-crank: k_eff / m_eff from its energies along the motion."""
    k = 300.0
    text = slider_crank("true", "forces: {s: {type: torsion_spring, joint: A, stiffness: 300}}")
    found = linear(text)
    # T = 1/2 m_eff angle'^2 with the ratios of the drawing, by the geometry of the crank
    r, L, angle = 0.3, 1.0, np.radians(30)
    beta = np.arcsin(r * np.sin(angle) / L)
    rod = -r * np.cos(angle) / (L * np.cos(beta))
    slider = -r * np.sin(angle) + L * np.sin(beta) * rod
    cx = -r * np.sin(angle) + 0.5 * L * np.sin(beta) * rod
    cy = 0.5 * r * np.cos(angle)
    m_eff = 0.03 + 0.15**2 + 0.03 * rod**2 + cx**2 + cy**2 + slider**2
    assert frequencies(found) == pytest.approx([sqrt(k / m_eff)], rel=EXACT)


@pytest.mark.parametrize("law, friction", [("identified", "none"), ("flores", "coulomb")])
def test_journal_pressed_into_its_bearing(law, friction):
    """A contact that carries the weight: k = 1.5 K d^0.5 with K d^1.5 = m g."""
    K, m, g = 1e9, 2.0, 9.81
    text = f"""
planar: true
gravity: [{g}, 0]
bodies: {{slider: {{mass: {m}, inertia: 1}}}}
joints:
  slide: {{type: prismatic, bodies: [ground, slider], axis: [1, 0, 0]}}
  pin: {{type: revolute, bodies: [ground, slider], at: [0, 0], clearance: 1 mm, contact: law}}
contact_laws:
  law: {{normal: {law}, restitution: 1, stiffness: {K}, bearing_radius: 0.1,
        friction: {{law: {friction}, coefficient: {0.3 if friction == "coulomb" else 0}}}}}
initial: {{equilibrium: [pin]}}
"""
    if friction == "none":
        text = text.replace(", coefficient: 0}", "}")
    d = (m * g / K) ** (2 / 3)
    assert frequencies(linear(text)) == pytest.approx([sqrt(1.5 * K * d**0.5 / m)], rel=EXACT)


def test_a_driven_mechanism_has_no_freedom():
    found = linear(slider_crank("true", "drives: {motor: {joint: A, velocity: 5}}"))
    assert found.A.shape == (0, 0)


@pytest.mark.parametrize("size", [1e-6, 1.0, 1e6])
def test_a_bar_moves_in_as_many_ways_whatever_it_weighs(size):
    """A hinged bar of two elements with a disc at its end."""
    text = f"""
bodies:
  bar: {{type: ancf_cable, start: [0, 0, 0], end: [1, 0, 0], section: {{width: 0.1, height: 0.1}},
        elements: 2, youngs_modulus: {1e9 * size}, density: {700 * size}}}
  disc: {{mass: {size}, inertia: {size}, at: [1, 0]}}
joints:
  hinge: {{type: revolute, bodies: [ground, bar], at: [0, 0]}}
  weld: {{type: fixed, bodies: [bar, disc], at: [1, 0]}}
"""
    read = scenario(text, "solver.end=1")
    mechanism = assemble(read)
    begun = start(read, mechanism, located=True)
    work = workspace(smooth(mechanism))
    work.mem[:], work.branch[:] = begun.mem, begun.branch
    ways = Probe(mechanism, work, begun).ways
    assert ways.T @ ways == pytest.approx(np.eye(ways.shape[1]), abs=1e-9)
    # all but the place and slope of the node in the middle, which nothing else is tied to
    assert ways.shape == (10, 6)
