"""Loads of a door: wind in axes that turn with it, opening and closing; weight by difference."""

import numpy as np
import pytest
from scipy.interpolate import Akima1DInterpolator

from ..runs import run

# a door whose hinge lies anywhere, drawn turned by ALPHA about the hinge line
DOOR = """
planar: false
points:
  wind_axes: {{body: door, at: [3.2, -1, 5.4], x_axis: {x}, y_axis: {y}}}
bodies:
  door: {{mass: 20, inertia: [2, 2, 3, 0.1, 0.2, -0.1], at: [3.3, -1, 5.5], angle: 0.3}}
joints:
  hinge: {{type: revolute, bodies: [{bodies}], at: [3, -1, 5], axis: [0, 1, 0]}}
sensors: {{opening: {{joint: hinge, sign: {sign}}}}}
drives: {{motor: {{joint: hinge, position: "{sign}*1.5*smoothstep(t/2)"}}}}
forces: {{wind: {{type: wrench, body: door, frame: wind_axes, force: [{f}, 0, {g}]}}}}
gravity: {gravity}
solver: {{end: 2, method: {method}}}
output: {{every: 0.05}}
"""
X = [0, 0.3, 0.7, 1.2, 1.6]
SETS = {"opening": ([10, 40, -20, 5, 0], [300, 250, 400, 80, 60]),
        "closing": ([-5, 15, 30, 20, 10], [-100, -300, 50, 120, -40])}  # fmt: skip
HINGE, CENTRE, AIR = np.array([3, -1, 5]), np.array([3.3, -1, 5.5]), np.array([3.2, -1, 5.4])


def rotated(v, angle):
    """About y."""
    c, s = np.cos(angle)[:, None], np.sin(angle)[:, None]
    v = np.broadcast_to(v, (len(angle), 3))
    return np.hstack([c * v[:, :1] + s * v[:, 2:], v[:, 1:2], -s * v[:, :1] + c * v[:, 2:]])


def table(values):
    rows = [list(row) for row in zip(X, values, strict=True)]
    return f"{{table: {rows}, of: opening}}"


def of(which, alpha=np.pi / 2, gravity="[0, 0, 0]", method="kinematic", turned=False):
    x = [np.cos(alpha - np.pi / 2), 0.0, -np.sin(alpha - np.pi / 2)]  # turned by alpha - 90 deg
    f, g = map(table, SETS[which])
    bodies, sign = ("door, ground", -1) if turned else ("ground, door", 1)
    x = [float(c) for c in x]
    return DOOR.format(x=x, y=[0, 1, 0], f=f, g=g, gravity=gravity, method=method, bodies=bodies,
                       sign=sign)  # fmt: skip


@pytest.mark.parametrize("which", SETS)
@pytest.mark.parametrize("alpha", [90, 125, -30])
@pytest.mark.parametrize("turned", [False, True])
def test_wind_in_axes_that_turn_with_the_door(which, alpha, turned):
    """beta = alpha - 90 deg as drawn, then with the door; the motor holds its moment."""
    alpha = np.radians(alpha)
    r = run(of(which, alpha, turned=turned))
    u = r["opening"]
    f, g = (Akima1DInterpolator(X, values)(u) for values in SETS[which])
    along, across = (
        rotated(v, u + alpha - np.pi / 2) for v in (np.array([1, 0, 0]), np.array([0, 0, 1]))
    )
    force = f[:, None] * along + g[:, None] * across
    assert r["wind.force"] == pytest.approx(force, abs=1e-9)
    arm = rotated(AIR - HINGE, u)
    moment = np.cross(arm, force)[:, 1]
    still = run(
        "\n".join(
            line
            for line in of(which, alpha, turned=turned).splitlines()
            if not line.startswith("forces")
        )
    )
    held = (r["motor.force"] - still["motor.force"]) * (-1 if turned else 1)
    assert held == pytest.approx(-moment, abs=1e-7)
    assert np.abs(moment).max() > 15.0


@pytest.mark.parametrize("turned", [False, True])
@pytest.mark.parametrize("method", ["kinematic", "dop853, tolerance: 1e-10"])
def test_gravity_on_less_gravity_off_is_the_weight(turned, method):
    """By the motor and by the hinge, at any speed: inertia and wind drop out of the difference."""
    g = np.array([1.0, -2.0, -9.0])
    on = run(of("opening", gravity=g.tolist(), method=method, turned=turned))
    off = run(of("opening", method=method, turned=turned))
    arm = rotated(CENTRE - HINGE, on["opening"])
    about = np.cross(arm, 20 * g)
    sign = -1 if turned else 1
    assert sign * (on["motor.force"] - off["motor.force"]) == pytest.approx(-about[:, 1], abs=1e-6)
    held = sign * (on["hinge.reaction"] - off["hinge.reaction"])
    assert held == pytest.approx(np.tile(-20 * g, (len(held), 1)), abs=1e-6)
    across = sign * (on["hinge.reaction_moment"] - off["hinge.reaction_moment"])
    assert across[:, [0, 2]] == pytest.approx(-about[:, [0, 2]], abs=1e-6)
