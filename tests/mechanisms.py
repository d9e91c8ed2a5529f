"""Mechanisms with a known answer.  Each returns (scenario text, exact solution)."""

from math import atan, cos, pi, sqrt
from pathlib import Path

import numpy as np
from scipy.integrate import solve_ivp

DATA = Path(__file__).parent / "data"
TIGHT = "tolerance: 1e-12"
SPEED = 0.5  # m/s, of central_impact


def table(name):
    """The rows of a CSV file of tests/data."""
    lines = (DATA / name).read_text().splitlines()
    return np.array([[float(x) for x in line.split(",")] for line in lines if line[0].isdigit()])


def torsion_pendulum(theta0=0.3, k=2.0, J=5e-3, solver="end: 0.4"):
    """A disc on a torsion spring:  theta(t) = theta0 cos(omega t),  omega^2 = k / J."""
    text = f"""
bodies: {{disc: {{mass: 2, inertia: {J}}}}}
joints: {{pin: {{type: revolute, bodies: [ground, disc], at: [0, 0]}}}}
sensors: {{angle: {{joint: pin, at_start: {theta0}}}}}
forces: {{spring: {{type: torsion_spring, joint: pin, stiffness: {k}, preload: {-k * theta0}}}}}
solver: {{{solver}}}
"""
    return text, lambda t: theta0 * np.cos(sqrt(k / J) * t)


def free_top(inertia=(1.0, 2.0, 3.0), omega=(0.5, 4.0, -1.0), end=1.0):
    """A body in free flight, tumbling:  L = R I R^T omega,  T, p and v are constant."""
    text = f"""
planar: false
bodies:
  top: {{mass: 2, inertia: {list(inertia)}, angle: 0.3, velocity: [1, 2, 3],
        angular_velocity: {list(omega)}}}
solver: {{end: {end}, {TIGHT}}}
output: {{channels: ["*", "*.rotation"]}}
"""
    return text, np.array([1.0, 2.0, 3.0])


def compound_pendulum(theta0=1.0, m=2.0, L=0.4, J=0.05, g=9.81):
    """A body on a hinge, let go at an angle: its exact period (arithmetic-geometric mean)."""
    text = f"""
gravity: [0, {-g}]
bodies: {{rod: {{mass: {m}, inertia: {J}, at: [{L * np.sin(theta0)}, {-L * cos(theta0)}]}}}}
joints: {{hinge: {{type: revolute, bodies: [ground, rod], at: [0, 0]}}}}
sensors: {{angle: {{joint: hinge, at_start: {theta0}}}}}
"""
    a, b = 1.0, cos(theta0 / 2)
    for _ in range(8):
        a, b = (a + b) / 2, sqrt(a * b)
    return text, 2 * np.pi / (a * sqrt(m * g * L / (J + m * L * L)))


def spherical_pendulum(end=2.0, solver=TIGHT):
    """A ball on a massless rod and a ball joint; its path from the textbook's equations.

    theta'' = sin theta cos theta phi'^2 - (g/L) sin theta,   phi' = h / sin^2 theta

    with the body's small inertia made part of them: a ball joint lets the body turn about its rod.
    """
    m, L, J, g, theta0, phi_dot0 = 1.5, 0.6, 0.02, 9.81, 1.1, 4.0
    text = f"""
planar: false
gravity: [0, 0, {-g}]
bodies:
  ball: {{mass: {m}, inertia: [{J}, {J}, {J}], at: [{L * np.sin(theta0)}, 0, {-L * cos(theta0)}],
         velocity: [0, {L * np.sin(theta0) * phi_dot0}, 0],
         angular_velocity: {_spin(theta0, phi_dot0)}}}
joints: {{ball_joint: {{type: spherical, bodies: [ground, ball], at: [0, 0, 0]}}}}
solver: {{end: {end}, {solver}}}
output: {{every: 0.02}}
"""
    stiff = m * g * L / (m * L * L + J)

    def rates(t, s):
        theta, theta_dot, _, phi_dot = s
        return [theta_dot, np.sin(theta) * np.cos(theta) * phi_dot**2 - stiff * np.sin(theta),
                phi_dot, -2 * theta_dot * phi_dot / np.tan(theta)]  # fmt: skip

    exact = solve_ivp(rates, (0, end), [theta0, 0.0, 0.0, phi_dot0], "DOP853",
                      rtol=1e-13, atol=1e-13, dense_output=True).sol  # fmt: skip

    def position(t):
        theta, _, phi, _ = exact(t)
        return L * np.array([np.sin(theta) * np.cos(phi), np.sin(theta) * np.sin(phi),
                             -np.cos(theta)]).T  # fmt: skip

    return text, position


def _spin(theta, phi_dot):
    """omega = r x v / r^2: no turn about the rod."""
    r = np.array([np.sin(theta), 0.0, -np.cos(theta)])
    return list(map(float, np.cross(r, [0.0, np.sin(theta) * phi_dot, 0.0])))


def driven_slide(motion="position", compliance=""):
    """A body on a slide driven along x = 0.2 sin^2 3t (from rest); also x' and x''."""
    law = {"position": "0.1*(1 - cos(6*t))", "velocity": "0.6*sin(6*t)"}[motion]
    text = f"""
bodies: {{slider: {{mass: 3, inertia: 1}}}}
joints: {{slide: {{type: prismatic, bodies: [ground, slider], axis: [1, 0, 0]}}}}
drives: {{drive: {{joint: slide, {motion}: "{law}", sign: -1{compliance}}}}}
solver: {{end: 0.5, tolerance: 1e-10}}
output: {{every: 0.01}}
"""

    def exact(t):
        return 0.1 * (1 - np.cos(6 * t)), 0.6 * np.sin(6 * t), 3.6 * np.cos(6 * t)

    return text, exact


def p1_slider_crank(friction=False, tolerance=1e-8, clearance="0.5 mm", end=0.003, more=""):
    """A slider-crank at 5000 rpm with play in the pin of rod and slider.

    The journal starts centred, with the velocities of the ideal mechanism.
    """
    law = "law: modified_coulomb, coefficient: 0.01, v0: 1e-4, v1: 1e-3"
    text = f"""
bodies:
  crank: {{mass: 0.30, inertia: 1.0e-4, at: [0.025, 0]}}
  rod: {{mass: 0.21, inertia: 2.5e-4, at: [0.11, 0]}}
  slider: {{mass: 0.14, inertia: 1e-4, at: [0.17, 0]}}
joints:
  A: {{type: revolute, bodies: [ground, crank], at: [0, 0]}}
  B: {{type: revolute, bodies: [crank, rod], at: [0.05, 0]}}
  C: {{type: revolute, bodies: [rod, slider], at: [0.17, 0], clearance: {clearance}, contact: pin}}
  track: {{type: prismatic, bodies: [ground, slider], axis: [1, 0, 0]}}
drives: {{motor: {{joint: A, velocity: 5000 rpm}}}}
contact_laws:
  pin: {{normal: lankarani_nikravesh, stiffness: internal, bearing_radius: 10 mm, restitution: 0.9,
        youngs_modulus: 207 GPa, poisson: 0.3, slowest_impact: 1e-6,
        friction: {{{law if friction else "law: none"}}}}}
solver: {{end: {end}, tolerance: {tolerance}}}
output: {{every: 40 us}}
{more}
"""
    return text


def central_impact(law="lankarani_nikravesh", restitution=1.0, K=1e9, mass=1.0, exponent=1.5,
                   planar="true"):  # fmt: skip
    """A body on a slide flies at the wall of its bearing and hits it at SPEED."""
    return f"""
planar: {planar}
bodies: {{slider: {{mass: {mass}, inertia: [1, 1, 1], velocity: [{SPEED}, 0]}}}}
joints:
  slide: {{type: prismatic, bodies: [ground, slider], axis: [1, 0, 0]}}
  pin: {{type: revolute, bodies: [ground, slider], at: [0, 0], clearance: 1 mm, contact: law}}
contact_laws:
  law: {{normal: {law}, restitution: {restitution}, stiffness: {K}, exponent: {exponent},
        bearing_radius: 0.1}}
solver: {{end: 6 ms, tolerance: 1e-10}}
"""


def bouncing_ball(height=0.1, k=1e5, damping=0.0, tolerance=1e-8, bounces=5):
    """A ball of 1 kg falls on a spring: first touch, contact time and period.

    In touch x'' = g - (k/m) x; the time is that between the zeros of the solution.
    """
    g, omega = 9.81, sqrt(k)
    v = sqrt(2 * g * height)
    contact = 2 / omega * (np.pi / 2 + atan(g / (omega * v)))
    period = 2 * v / g + contact
    text = f"""
planar: true
gravity: [0, {-g}]
bodies: {{ball: {{mass: 1, inertia: 1, at: [0, {height}]}}}}
forces:
  floor: {{type: limit_stop, point: {{body: ball, at: [0, {height}]}},
          wall: {{body: ground, at: [0, 0], normal: [0, 1]}}, stiffness: {k}, damping: {damping}}}
solver: {{end: {bounces * period!r}, tolerance: {tolerance}}}
"""
    return text, (v / g, contact, period)


def sealed_door(speed=0.5):
    """A door that slides 6 mm onto a seal, which is linear: it is pressed for half a period, s."""
    text = f"""
planar: false
bodies:
  door: {{mass: 20, inertia: [2, 2, 4], at: [0.4, 0, 1], velocity: [0, {-speed}, 0]}}
joints:
  rail: {{type: prismatic, bodies: [ground, door], at: [0.4, 0, 1], axis: [0, 1, 0]}}
forces:
  edge: {{type: seal, line: {{body: door, start: [0.8, 0, 0.1], end: [0.8, 0, 1.9]}},
         against: {{body: ground, at: [0, -0.01, 0], normal: [0, 1, 0]}},
         height: 0.004, load: 130, at: 0.004, exponent: 1}}
solver: {{end: 0.8, tolerance: 1e-8}}
output: {{every: 1 ms}}
"""
    return text, pi * sqrt(20 / (130 / 0.004 * 1.8))
