"""Relative angle: turns about an axis without a joint, counted, in loads and in events."""

from math import pi, tau

import numpy as np
import pytest

from trsim.errors import TrsimError
from trsim.solve.march.record import EVENT_KIND, EVENT_TIME, USER

from ..runs import built, run
from .bench import bench, product, put_right, quaternion

AXIS, PLACE = np.array([0.48, 0.6, 0.64]), np.array([0.2, 0.1, 0.0])
ACROSS = np.cross(AXIS, [1.0, 2.0, -0.5]) / np.linalg.norm(np.cross(AXIS, [1.0, 2.0, -0.5]))
SENSED = """
sensors:
  x: {type: relative_angle, bodies: [left, right], axis: [4.8, 6, 6.4], sign: -1, at_start: 0.25}
"""


def rotation_vector(q):
    """The rotation vector of a unit quaternion, turning by less than pi."""
    q = q if q[0] > 0 else -q
    n = np.linalg.norm(q[1:])
    return 2.0 * np.arctan2(n, q[0]) * q[1:] / n


@pytest.mark.parametrize("tilt", [0.0, 0.7, 2.4])
@pytest.mark.parametrize("turn", [1.3, -2.9])
def test_is_the_turn_that_is_left_when_the_axes_are_brought_together(tilt, turn):
    b = bench(SENSED, np.random.default_rng(1))
    swung = product(quaternion(tilt * ACROSS), quaternion(turn * AXIS))
    put_right(b, PLACE, rotation_vector(swung), np.array([0.3, -1.0, 0.2]))
    x, s = b.scene().S[:, 0]
    assert x == pytest.approx(turn, abs=1e-12)
    assert s == pytest.approx(0.25 - turn, abs=1e-12)


@pytest.mark.parametrize("seed", range(5))
def test_rate(seed):
    b, h = bench(SENSED, np.random.default_rng(seed)), 1e-6
    w = b.scene()
    rate = w.S[1, 1]
    (_, ahead), (_, behind) = b.later(h).scene().S[:, 0], b.later(-h).scene().S[:, 0]
    # values are between half a turn either way: their difference may be off by whole turns
    change = (ahead - behind + pi) % tau - pi
    assert rate == pytest.approx(change / (2 * h), rel=1e-7)


SPINNING = ", velocity: [1, 0, 0], angular_velocity: [9, 3, -6]}"
TUMBLING = (
    "planar: false\nbodies:\n  left: {mass: 2, inertia: [0.02, 0.03, 0.04]" + SPINNING
    + "\n  right: {mass: 3, inertia: [0.05, 0.04, 0.03], at: [0.5, 0.2, -0.1], angle: 0.4 %s}\n%s"
    + "solver: {end: 2, tolerance: 1e-11}\noutput: {every: 1 ms}\n"
)  # fmt: skip
HINGE = "joints: {joint: {type: revolute, bodies: [left, right], at: [0.2, 0.1, 0], "
HINGE += "axis: [0.48, 0.6, 0.64]}}\n"


@pytest.mark.parametrize("pair", ["left, right", "right, left"])
def test_is_the_angle_of_a_hinge(pair):
    """Both bodies turn round several times, the hinge too."""
    text = TUMBLING % (", angular_velocity: [0, 5, 9]", HINGE) + SENSED
    text = text.replace("[left, right]", f"[{pair}]")
    r = run(text + "  y: {joint: joint, sign: -1, at_start: 0.25}\n", "solver.end=6")
    assert np.ptp(r["y"]) > 3 * tau
    for channel, within in (("", 1e-11), (".rate", 1e-10), (".acceleration", 1e-8)):
        assert r["x" + channel] == pytest.approx(r["y" + channel], abs=within), channel


def test_rate_and_acceleration_without_a_joint():
    r = run(TUMBLING % (", angular_velocity: [2, 1, 2]", "") + SENSED)
    assert np.ptp(r["x"]) > tau  # and no jump of a turn
    for a, b in (("x", "x.rate"), ("x.rate", "x.acceleration")):
        slope = (r[a][2:] - r[a][:-2]) / 2e-3
        assert slope == pytest.approx(r[b][1:-1], abs=2e-3 * np.abs(r[b]).max())


ROTOR = """
bodies: {{rotor: {{mass: 2, inertia: {inertia}, at: [1000, -2000, 0], angle: 0.7,
          angular_velocity: {spin}}}}}
joints: {{hinge: {{type: revolute, bodies: [ground, rotor], at: [1000, -2000, 0], axis: {axis}}}}}
sensors: {{x: {{type: relative_angle, bodies: [{bodies}], axis: {axis}, at_start: 30 deg}}}}
solver: {{end: 5, method: {method}}}
output: {{every: 0.5}}
"""
METHODS = ("dop853", "radau", "generalized_alpha, tolerance: 1e-4", "rk4, step: 0.01", "scipy:RK45")


@pytest.mark.parametrize("method", METHODS)
@pytest.mark.parametrize("axis, spin", [((0, 0, 1), (0, 0, 20)), ((1, 2, 2), (8, 16, 16))])
@pytest.mark.parametrize("bodies", ["ground, rotor", "rotor, ground"])
def test_many_turns_far_from_the_origin(method, axis, spin, bodies):
    sign = 1 if bodies == "ground, rotor" else -1
    rate = np.dot(axis, spin) / np.linalg.norm(axis)
    text = ROTOR.format(inertia=[1, 1, 1], spin=list(spin), axis=list(axis), method=method,
                        bodies=bodies)  # fmt: skip
    r = run(text)
    assert r.mechanism.planar == (axis == (0, 0, 1))
    assert r["x"] == pytest.approx(pi / 6 + sign * rate * r.t, abs=1e-3)
    assert r["x.rate"] == pytest.approx(np.full(r.t.size, sign * rate), abs=1e-6)


@pytest.mark.parametrize("axis, spin", [((0, 0, 1), (0, 0, 20)), ((1, 2, 2), (8, 16, 16))])
def test_in_events_and_loads(axis, spin):
    """On the fourth turn, and through every turn of a load whose corner the angle meets."""
    rate = np.dot(axis, spin) / np.linalg.norm(axis)
    text = ROTOR.format(inertia=[1, 1, 1], spin=list(spin), axis=list(axis), method="auto",
                        bodies="ground, rotor")  # fmt: skip
    text += "forces: {push: {type: applied_load, body: rotor, at: [1000, -2000, 0], frame: world, "
    text += "direction: [1, 0, 0], force: 10*(sin(x) > 0)}}\n"
    r = run(text + "events: {there: {when: x, value: 1500 deg, do: {record: true, end: true}}}\n")
    assert r.outcome.fired == {"there": 1}
    assert r.outcome.time == pytest.approx((1500 - 30) / 180 * pi / rate, abs=1e-7)
    assert r.outcome.statistics["unproved_searches"] == 0


def test_every_crossing_of_a_body_that_nods():
    """A free disc whose axis leans: its angle about a fixed line wavers."""
    text = """
planar: false
bodies: {disc: {mass: 1, inertia: [0.2, 0.23, 0.3], angular_velocity: [8, 0, 20]}}
sensors: {x: {type: relative_angle, bodies: [ground, disc]}}
solver: {end: 4, tolerance: 1e-9}
output: {every: 1e-4}
events: {over: {when: x, value: 17, crosses: both, do: {record: true}}}
"""
    r = run(text)
    times = r.events[r.events[:, EVENT_KIND] == USER][:, EVENT_TIME]
    above = r["x"] > 17
    flips = np.flatnonzero(above[1:] != above[:-1])
    assert len(flips) == len(times) > 0
    assert times == pytest.approx(r.t[flips], abs=1.1e-4)


def test_in_the_plane_about_an_axis_in_it():
    """It tells what happens out of the plane, so the scene is spatial; or else it stays at zero."""
    text = """
bodies: {rod: {mass: 1, inertia: [1, 1, 1], angular_velocity: [0, 0, 3]}}
joints: {hinge: {type: revolute, bodies: [ground, rod], at: [0, 0]}}
sensors: {x: {type: relative_angle, bodies: [ground, rod], axis: [1, 0, 0]}}
solver: {end: 0.5}
"""
    assert not built(text).planar
    r = run("planar: true" + text)
    assert r["x"] == pytest.approx(np.zeros(r.t.size), abs=1e-12)


@pytest.mark.parametrize(
    "old, new, path, what",
    [
        ("axis: [0, 0, 1]", "axis: [0, 0, 0]", ("axis",), "must not be zero"),
        ("[ground, rotor], axis", "[rotor, rotor], axis", ("bodies",), "itself"),
        ("[ground, rotor], axis", "[ground, motor], axis", ("bodies", 1), "no body"),
        ("30 deg", "30 mm", ("at_start",), "wrong unit"),
    ],
)
def test_refused(old, new, path, what):
    text = ROTOR.format(inertia=[1, 1, 1], spin=[0, 0, 1], axis=[0, 0, 1], method="auto",
                        bodies="ground, rotor")  # fmt: skip
    where = text.index("sensors")
    assert old in text[where:]
    with pytest.raises(TrsimError) as caught:
        built(text[:where] + text[where:].replace(old, new))
    [error] = caught.value.problems
    assert error.path == ("sensors", "x", *path) and what in error.what


def test_of_flexible_bars():
    """In the plane the slope of a node; in space nobody knows how a bar turns about itself."""
    text = """
planar: PLANAR
bodies:
  rod: {type: ancf_cable, start: [0, 0, 0], end: [1, 0, 0], section: {diameter: 20 mm},
        elements: 2, youngs_modulus: 207 GPa, density: 7850}
joints: {pin: {type: KIND, bodies: [ground, rod], at: [0, 0]}}
sensors: {s: {type: relative_angle, bodies: [ground, rod], at: [1, 0]}}
gravity: [0, -9.81, 0]
solver: {end: 200 ms}
"""
    r = run(text.replace("PLANAR", "true").replace("KIND", "revolute"))
    v = r["rod.node2.position"]
    assert r["s"][-1] == pytest.approx(np.arctan2(v[-1, 1], v[-1, 0]), abs=1e-3)
    assert r["s"][-1] < -0.1
    with pytest.raises(TrsimError, match="turns with 'rod'"):
        built(text.replace("PLANAR", "false").replace("KIND", "spherical"))


@pytest.mark.parametrize("planar", ["true", "false"])
@pytest.mark.parametrize(
    "more", ["initial: {hinge: 700 deg}", "initial: {hinge: 700 deg, next: -500 deg}",
             'drives: {d: {joint: hinge, position: 20 + t}}',
             'drives: {d: {joint: hinge, position: -30 - t}}'],
)  # fmt: skip
def test_turns_of_the_start_are_counted(planar, more):
    """As the angles of the joints are, by a start and by a drive, in the plane and in space."""
    text = f"""
planar: {planar}
bodies:
  one: {{mass: 2, inertia: [1, 1, 1], at: [0.2, 0, 0]}}
  two: {{mass: 1, inertia: [1, 1, 1], at: [0.6, 0, 0]}}
joints:
  hinge: {{type: revolute, bodies: [ground, one], at: [0, 0, 0]}}
  next: {{type: revolute, bodies: [one, two], at: [0.5, 0, 0]}}
sensors:
  h: {{joint: hinge}}
  n: {{joint: next}}
  x: {{type: relative_angle, bodies: [ground, one]}}
  back: {{type: relative_angle, bodies: [two, ground], axis: [0, 0, -1]}}
solver: {{end: 0.1}}
{more}
"""
    r = run(text)
    assert abs(r["h"][0]) > tau
    assert r["x"] == pytest.approx(r["h"], abs=1e-9)
    assert r["back"] == pytest.approx(r["h"] + r["n"], abs=1e-9)
