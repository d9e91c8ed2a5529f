"""Mechanisms with a known answer.  Each returns (scenario text, exact solution)."""

from math import cos, sqrt

import numpy as np
from scipy.integrate import solve_ivp

TIGHT = "tolerance: 1e-12"


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
        theta, theta_dot, phi, phi_dot = s
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
