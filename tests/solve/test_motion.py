"""Motions with a known answer or a known invariant."""

import numpy as np
import pytest
from scipy.integrate import solve_ivp

from ..mechanisms import compound_pendulum, free_top, spherical_pendulum, torsion_pendulum
from ..runs import energy_error, run


def angular_momentum(r, body, mass, inertia):
    """About the origin, world axes (n, 3)."""
    R = r[f"{body}.rotation"].reshape(-1, 3, 3)
    I = R @ inertia @ R.transpose(0, 2, 1)
    spin = np.einsum("tij,tj->ti", I, r[f"{body}.angular_velocity"])
    return spin + mass * np.cross(r[f"{body}.position"], r[f"{body}.velocity"])


def body_rates(r, body):
    """Angular velocity in body axes."""
    R = r[f"{body}.rotation"].reshape(-1, 3, 3)
    return np.einsum("tji,tj->ti", R, r[f"{body}.angular_velocity"])


def test_torsion_pendulum():
    text, angle = torsion_pendulum(solver="end: 2, tolerance: 1e-11")
    r = run(text)
    assert r["angle"] == pytest.approx(angle(r.t), abs=1e-9)
    assert energy_error(r) < 1e-9


def test_spherical_pendulum_against_the_textbook():
    text, position = spherical_pendulum()
    r = run(text)
    assert r["ball.position"] == pytest.approx(position(r.t), abs=1e-8)


def test_spherical_pendulum_keeps_energy_and_vertical_angular_momentum():
    r = run(spherical_pendulum()[0], 'output.channels=["*", "*.rotation"]')
    total = r["energy.kinetic"] + r["energy.stored.gravity"]
    assert total == pytest.approx(total[0], abs=1e-9 * r["energy.kinetic"].max())
    L = angular_momentum(r, "ball", 1.5, 0.02 * np.eye(3))[:, 2]
    assert pytest.approx(L[0], rel=1e-9) == L


def test_free_flight_keeps_momentum_and_energy():
    text, v = free_top()
    r = run(text)
    assert r["top.velocity"] == pytest.approx(np.tile(v, (len(r.t), 1)), abs=1e-12)
    assert r["top.position"] == pytest.approx(r.t[:, None] * v, abs=1e-12)
    L = angular_momentum(r, "top", 2.0, np.diag([1.0, 2.0, 3.0]))
    assert np.abs(L - L[0]).max() < 1e-10 * np.linalg.norm(L[0])
    assert r["energy.kinetic"] == pytest.approx(r["energy.kinetic"][0], rel=1e-10)


def test_asymmetric_top_against_euler():
    """Tumbling about the middle axis: it flips over and back."""
    text, _ = free_top(omega=(0.02, 4.0, 0.0), end=8.0)
    r = run(text, "bodies.top.angle=0")
    I = np.array([1.0, 2.0, 3.0])
    euler = solve_ivp(lambda t, o: -np.cross(o, I * o) / I, (0, 8), [0.02, 4.0, 0.0], "DOP853",
                      rtol=1e-13, atol=1e-13, t_eval=r.t).y.T  # fmt: skip
    assert body_rates(r, "top") == pytest.approx(euler, abs=1e-8)
    assert euler[:, 1].min() < -3.9  # it did flip


def test_products_of_inertia_are_the_turned_tensor():
    """One body written in axes turned by 0.5 about z: the same flight."""
    c, s = np.cos(0.5), np.sin(0.5)
    R = np.array([[c, -s, 0], [s, c, 0], [0, 0, 1]])
    I = R @ np.diag([1.0, 2.0, 3.0]) @ R.T
    straight, _ = free_top(end=0.5)
    turned, _ = free_top((*np.diag(I).tolist(), *I[[0, 0, 1], [1, 2, 2]].tolist()), end=0.5)
    a, b = run(straight), run(turned, "bodies.top.angle=-0.2")
    assert a["top.angular_velocity"] == pytest.approx(b["top.angular_velocity"], abs=1e-10)


@pytest.mark.parametrize("planar", ["true", "false"])
def test_period_of_a_compound_pendulum(planar):
    text, period = compound_pendulum()
    text = text.replace("inertia: 0.05", "inertia: [0.05, 0.05, 0.05]") + f"planar: {planar}\n"
    r = run(text + f"solver: {{end: {1.25 * period!r}, tolerance: 1e-12}}")
    # after five quarters it hangs straight down
    assert abs(r["angle"][-1] / r["angle.rate"][-1]) < 1e-8 * period
    assert energy_error(r) < 1e-9


def test_result_does_not_depend_on_the_order_of_bodies_or_on_the_place():
    """Reordered, moved by (3, 4) and turned by 1 rad: the same motion, moved and turned."""
    c, s = np.cos(1.0), np.sin(1.0)
    R, shift = np.array([[c, -s], [s, c]]), np.array([3.0, 4.0])

    def two(order, place, turn):
        at = {"a": (0.5, 0.0), "b": (1.25, 0.0), "A": (0, 0), "B": (1, 0)}
        at = {k: (place + turn @ v).tolist() for k, v in at.items()}
        bodies = [f"  {n}: {{mass: 1, inertia: 0.1, at: {at[n]}}}" for n in order]
        return "\n".join([
            f"gravity: {(turn @ [0, -9.81]).tolist()}", "bodies:", *bodies, "joints:",
            f"  A: {{type: revolute, bodies: [ground, a], at: {at['A']}}}",
            f"  B: {{type: revolute, bodies: [a, b], at: {at['B']}}}",
            "solver: {end: 1, tolerance: 1e-11}",
        ])  # fmt: skip

    here = run(two("ab", np.zeros(2), np.eye(2)))
    there = run(two("ba", shift, R))
    moved = here["b.position"][:, :2] @ R.T + shift
    assert there["b.position"][:, :2] == pytest.approx(moved, abs=1e-8)
    assert there["A.reaction"][:, :2] == pytest.approx(here["A.reaction"][:, :2] @ R.T, abs=1e-5)


@pytest.mark.parametrize("planar", ["true", "false"])
@pytest.mark.parametrize("motion", ['velocity: "0*t"', 'position: "smoothstep(t)"'])
def test_what_rests_is_not_stiff(motion, planar):
    """A pendulum that hangs still, and a slide that a drive holds against a part of its weight."""
    r = run(f"""
planar: {planar}
gravity: [0, -9.81, 0]
bodies:
  pendulum: {{mass: 1, inertia: [0.1, 0.1, 0.1], at: [0, -0.5]}}
  sledge: {{mass: 1, inertia: [0.1, 0.1, 0.1], at: [2, 0]}}
joints:
  hinge: {{type: revolute, bodies: [ground, pendulum], at: [0, 0]}}
  slide: {{type: prismatic, bodies: [ground, sledge], axis: [1, 0.3, 0]}}
drives: {{motor: {{joint: slide, {motion}}}}}
solver: {{end: 30, tolerance: 1e-6}}
""")
    assert r.outcome.statistics["method_switches"] == 0
