"""Displacement sensor: the stroke of a slide without the slide, in loads, tables and events."""

import numpy as np
import pytest

from trsim.assemble.coupling import nodes
from trsim.errors import TrsimError

from ..runs import built, energy_error, run, scenario
from .bench import bench, now, put_right

AXIS, PLACE = np.array([0.48, 0.6, 0.64]), np.array([0.2, 0.1, 0.0])
SENSED = """
sensors:
  x: {type: displacement, bodies: [left, right], at: [0.2, 0.1, 0], axis: [4.8, 6, 6.4], sign: -1,
      at_start: 0.25}
"""


def test_value_and_rate_off_any_joint():
    """P_j turns and slides away; the axis turns with the first body."""
    b, h = bench(SENSED, np.random.default_rng(2)), 1e-6
    [(_, rate)] = b.scene().S
    [(ahead, _)], [(behind, _)] = b.later(h).scene().S, b.later(-h).scene().S
    assert rate == pytest.approx((ahead - behind) / (2 * h), rel=1e-8)
    put_right(b, PLACE, np.array([0.3, -1.0, 0.2]), 1.3 * AXIS + np.cross(AXIS, [1, 2, 3]))
    assert b.scene().S[0, 0] == pytest.approx(0.25 - 1.3, rel=1e-12)
    assert now(b, AXIS) @ now(b, AXIS) == pytest.approx(1.0)


TUMBLING = """
planar: false
bodies:
  left: {mass: 2, inertia: [0.02, 0.03, 0.04], velocity: [1, 0, 0], angular_velocity: [3, 1, -2]}
  right: {mass: 3, inertia: [0.05, 0.04, 0.03], at: [0.5, 0.2, -0.1], velocity: [1, 0.5, 0.7]}
joints:
  joint: {type: prismatic, bodies: [left, right], at: [0.2, 0.1, 0], axis: [0.48, 0.6, 0.64]}
solver: {end: 0.4, tolerance: 1e-10}
"""


def test_is_the_stroke_of_a_slide():
    r = run(TUMBLING + SENSED + "  y: {joint: joint, sign: -1, at_start: 0.25}\n")
    assert np.ptp(r["x"]) > 0.05 and np.ptp(r["x.rate"]) > 0.05
    for channel in ("", ".rate", ".acceleration"):
        assert r["x" + channel] == pytest.approx(r["y" + channel], abs=1e-12), channel


def test_acceleration_is_the_rate_of_the_rate_without_a_joint():
    free = "\n".join(line for line in TUMBLING.splitlines() if "joint" not in line)
    r = run(free + SENSED)
    for a, b in (("x", "x.rate"), ("x.rate", "x.acceleration")):
        slope = np.gradient(r[a], r.t)[1:-1]
        assert slope == pytest.approx(r[b][1:-1], abs=1e-4 * np.abs(r[b]).max())


RAIL = """
bodies: {slider: {mass: 2, inertia: [0.1, 0.1, 0.1], velocity: [0.5, 0]}}
forces:
  rail: {type: bushing, bodies: [ground, slider], at: [0, 0, 0], stiffness: [0, 1e4, 1e4],
         rotational_stiffness: [100, 100, 100]}
  %s
sensors: {s: {type: displacement, bodies: [ground, slider], at: [0, 0], axis: [1, 0, 0]}}
solver: {end: 0.5, tolerance: 1e-11}
output: {every: 0.01}
"""
LOAD = "spring: {type: applied_load, body: slider, direction: [1, 0, 0], force: %s}"


@pytest.mark.parametrize("force", ["-200*s", "{table: [[-1, 200], [0, 0], [1, -200]], of: s}"])
@pytest.mark.parametrize("planar", ["true", "false"])
def test_in_loads_and_tables(force, planar):
    r = run(RAIL % (LOAD % force), f"planar={planar}")
    assert r["s"] == pytest.approx(0.05 * np.sin(10 * r.t), abs=1e-10)
    assert r["s.rate"] == pytest.approx(0.5 * np.cos(10 * r.t), abs=1e-9)
    assert r["s.acceleration"] == pytest.approx(-5 * np.sin(10 * r.t), abs=1e-8)
    assert energy_error(r) < 1e-9
    assert {c.name: c.unit for c in r.mechanism.columns if c.name.startswith("s")}["s"] == "m"


def test_its_bodies_act_on_what_its_load_pushes():
    text = RAIL % (LOAD % "-200*s").replace("body: slider", "body: other")
    other = "bodies: {other: {mass: 1, inertia: [1, 1, 1], at: [1, 1]}, "
    read = scenario(text.replace("bodies: {", other, 1))
    assert frozenset({0, 1}) in nodes(built(read)).groups


def test_in_events():
    """20 mm at 0.5 m/s."""
    r = run(RAIL % "" + "events: {there: {when: s, value: 20 mm, do: {record: true, end: true}}}\n")
    assert r.outcome.fired == {"there": 1}
    assert r.outcome.time == pytest.approx(0.04, abs=1e-12)
    with pytest.raises(TrsimError, match="wrong unit: 'deg'; 's' is in m"):
        built(RAIL % "" + "events: {there: {when: s, value: 2 deg, do: {end: true}}}\n")


BAR = """
planar: {}
bodies:
  rod: {{type: ancf_cable, start: [0, 0, 0], end: [1, 0, 0], section: {{diameter: 20 mm}},
        elements: 2, youngs_modulus: 207 GPa, density: 7850}}
  block: {{mass: 2, inertia: [0.1, 0.1, 0.1], at: [1, 0.2, 0]}}
joints: {{pin: {{type: {}, bodies: [ground, rod], at: [0, 0]}}}}
sensors: {{s: {{type: displacement, bodies: {}, at: [1, 0], axis: {}}}}}
forces: {{f: {{type: applied_load, body: block, direction: [0, 1], force: 1 - s}}}}
gravity: [0, -9.81, 0]
solver: {{end: 10 ms}}
"""


def test_of_flexible_bars():
    """Of a node, and in the plane along an axis that a node carries along."""
    r = run(BAR.format("true", "revolute", "[ground, rod]", "[0, 1]"))
    assert r["s"] == pytest.approx(r["rod.node2.position"][:, 1], abs=1e-12)
    assert r["s"][-1] < -1e-4
    built(BAR.format("true", "revolute", "[rod, block]", "[0, 1]"))
    built(BAR.format("false", "spherical", "[rod, block]", "[1, 0]"))
    with pytest.raises(TrsimError, match="turns with 'rod'") as caught:
        built(BAR.format("false", "spherical", "[rod, block]", "[0, 1]"))
    assert caught.value.path == ("sensors", "s")


@pytest.mark.parametrize(
    "old, new, path, what",
    [
        ("axis: [1, 0, 0]", "axis: [0, 0, 0]", ("axis",), "must not be zero"),
        ("[ground, slider], at: [0, 0],", "[slider, slider], at: [0, 0],", ("bodies",), "itself"),
        ("[ground, slider], at: [0, 0],", "[ground, slide], at: [0, 0],", ("bodies", 1), "no body"),
        ("axis: [1, 0, 0]", "axis: [1, 0, 0], at_start: 3 deg", ("at_start",), "wrong unit"),
    ],
)
def test_refused(old, new, path, what):
    assert old in RAIL
    with pytest.raises(TrsimError) as caught:
        built((RAIL % "").replace(old, new))
    [error] = caught.value.problems
    assert error.path == ("sensors", "s", *path) and what in error.what
