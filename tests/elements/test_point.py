"""Point sensor: a component of a place, seen from a body that turns."""

import numpy as np
import pytest

from trsim.errors import TrsimError

from ..runs import built, run
from .bench import bench, matrix

SENSED = """
sensors:
  x: {type: point, body: right, at: [0.7, 0.3, 0.4], frame: left, axis: [4.8, 6, 6.4],
      origin: [0.3, 0.1, -0.2]}
  h: {type: point, body: right, at: [0.7, 0.3, 0.4], axis: [0, 3, 4]}
"""


def test_value_and_rate():
    b, h = bench(SENSED, np.random.default_rng(2)), 1e-6
    S = b.scene().S
    change = (b.later(h).scene().S[:, 0] - b.later(-h).scene().S[:, 0]) / (2 * h)
    assert S[:, 1] == pytest.approx(change, rel=1e-8)
    R = matrix(b.p[2])
    drawn = matrix(np.array([np.cos(-0.2), 0, 0, np.sin(-0.2)]))
    place = b.r[2] + R @ drawn.T @ (np.array([0.7, 0.3, 0.4]) - [0.5, 0.2, -0.1])
    assert S[1, 0] == pytest.approx(place @ [0, 0.6, 0.8], rel=1e-12)


TUMBLING = """
planar: false
bodies:
  left: {mass: 2, inertia: [0.02, 0.03, 0.04], velocity: [1, 0, 0], angular_velocity: [3, 1, -2]}
  right: {mass: 3, inertia: [0.05, 0.04, 0.03], at: [0.5, 0.2, -0.1], velocity: [1, 0.5, 0.7],
          angular_velocity: [5, 0, 2]}
points: {tip: {body: right, at: [0.7, 0.3, 0.4], x_axis: [1, 1, 0]}}
solver: {end: 1, tolerance: 1e-11}
output: {every: 1 ms}
"""


def test_rate_and_acceleration():
    r = run(TUMBLING + SENSED)
    for name in ("x", "h"):
        for a, b in (("", ".rate"), (".rate", ".acceleration")):
            slope = (r[name + a][2:] - r[name + a][:-2]) / 2e-3
            channel = r[name + b]
            assert slope == pytest.approx(channel[1:-1], abs=1e-4 * np.abs(channel).max())
    for channel, of in (("", "position"), (".rate", "velocity"), (".acceleration", "acceleration")):
        assert r["h" + channel] == pytest.approx(r[f"tip.{of}"] @ [0, 0.6, 0.8], abs=1e-10)


def test_may_name_a_point():
    text = TUMBLING + "sensors:\n  h: {type: point, body: right, at: tip, axis: tip.x}\n"
    r = run(text)
    assert r["h"] == pytest.approx(r["tip.position"] @ [0.5**0.5, 0.5**0.5, 0], abs=1e-12)


def test_in_an_event_and_in_a_load():
    text = """
bodies: {ball: {mass: 2, inertia: 1, at: [3, 1], velocity: [0, 4]}}
sensors: {h: {type: point, body: ball, at: [3, 1], axis: [0, 2], origin: [0, 1]}}
forces: {pull: {type: applied_load, body: ball, direction: [0, 1], force: -50*h}}
events: {low: {when: h, value: 0.1, crosses: down, do: {end: true}}}
solver: {end: 5}
"""
    r = run(text)  # h = 0.8 sin(5 t)
    assert r.outcome.time == pytest.approx((np.pi - np.arcsin(0.1 / 0.8)) / 5, abs=1e-7)


def test_out_of_the_plane_it_makes_a_scene_spatial():
    text = """
bodies: {ball: {mass: 2, inertia: [1, 1, 1]}}
sensors: {h: {type: point, body: ball, at: [0, 0], axis: [0, 1, 1]}}
"""
    assert not built(text).planar
    assert built(text.replace("[0, 1, 1]", "[0, 1, 0]")).planar


def test_refused():
    text = "bodies: {b: {mass: 1, inertia: 1}}\nsensors: {s: {type: point, body: b, at: [0, 0], "
    with pytest.raises(TrsimError, match="must not be zero"):
        built(text + "axis: [0, 0]}}")
    with pytest.raises(TrsimError, match="no body or point named 'c'"):
        built(text + "axis: [1, 0], frame: c}}")


BAR = """
planar: false
bodies:
  bar: {mass: 2, inertia: [1e-4, 0.17, 0.17], at: [0.5, 0, 0],
        flexible: {youngs_modulus: 70 GPa, area: 1e-4, second_moment: 1e-9, elements: 2}}
joints: {clamp: {type: spherical, bodies: [ground, bar], at: [0, 0, 0]},
         far: {type: inline, bodies: [ground, bar], at: [1, 0, 0], axis: [1, 0, 0]}}
sensors: {tip: {type: point, body: bar, axis: [0, 1, 0], WHERE}}
"""


def test_of_a_flexible_bar_in_space():
    """Nobody knows how it turns about itself, so what lies on its line alone can be told."""
    on_line = "at: [1, 0, 0], origin: [0, 0.3, 0.2]"
    assert built(BAR.replace("WHERE", on_line)).model.n > 2
    refused = {
        "at: [1, 0.1, 0]": "is not on the line of 'bar'",
        "at: [1, 0, 0], frame: bar, origin: [0.5, 0, 0]": "about itself",
    }
    for where, words in refused.items():
        with pytest.raises(TrsimError, match=words):
            built(BAR.replace("WHERE", where))
