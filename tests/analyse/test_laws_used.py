"""Laws as a run used them, against closed forms."""

import numpy as np
import pytest

from tests import small
from trsim.analyse.laws_used import coefficient, hertzian, laws, part, stopped
from trsim.elements.curve import Curve, sampled
from trsim.elements.friction_law import Friction
from trsim.scenario.load import loads
from trsim.store.read import read

DOOR = """\
bodies: {door: {mass: 2, inertia: 0.1, at: [0.5, 0]}, cart: {mass: 1, inertia: 1, at: [0, 1]}}
joints:
  hinge: {type: revolute, bodies: [ground, door], at: [0, 0]}
  rail: {type: prismatic, bodies: [ground, cart], axis: [1, 0, 0]}
drives:
  handle: {joint: hinge, position: 0.6*sin(2*pi*t)}
  push: {joint: rail, position: {table: [[0, 0], [0.1, 0], [1, 0.2]], interpolation: spline}}
sensors: {door_angle: {joint: hinge}, way: {joint: rail}}
load_sets: {gust: {loads: [wind]}}
loads: {gust: ultimate}
forces:
  seal: {type: joint_spring, joint: hinge, damper: 3*rate,
         elastic: {table: [[-0.2, 5 N*m], [0, 0 N*m], [0.4, 8 N*m]], interpolation: linear}}
  rope: {type: spring, bodies: [ground, cart], points: [[0, 1], [0.1, 1]], tension_only: true,
         free_length: 0.15, elastic: 100*stretch}
  wind: {type: applied_load, body: door, at: [1, 0], frame: world, direction: [0, 1, 0],
         force: {table: [[0, 0], [0.3, 30]], of: door_angle, outside: extend}}
  both: {type: applied_load, body: door, at: [1, 0], frame: world, direction: [0, 1, 0],
         force: way*t}
solver: {end: 0.7 s, tolerance: 1e-9}
output: {every: 7 ms}
"""


@pytest.fixture(scope="module")
def used(tmp_path_factory):
    path = tmp_path_factory.mktemp("laws") / "door.h5"
    small.run(path, text=DOOR)
    found, lost = laws(read(path))
    return {law.name: law for law in found}, lost, read(path)


def at(law, x):
    grid, y = law.curves["law"]
    return np.interp(x, grid, y)


def test_expressions_and_the_time_they_ran(used):
    law = used[0]["drives.handle.position"]
    assert (law.x, law.x_unit, law.y_unit) == ("t", "s", "rad")
    assert law.visited == (0.0, pytest.approx(0.7))
    t = np.linspace(0.0, 0.7, 20)
    np.testing.assert_allclose(at(law, t), 0.6 * np.sin(2.0 * np.pi * t), atol=1e-6)


def test_tables_beyond_their_ends(used):
    """The door swings from -0.6 to 0.6: farther than both tables reach, one holds, one goes on."""
    seal = used[0]["forces.seal.elastic"]
    assert seal.x_unit == "rad" and seal.y_unit == "N*m"
    assert seal.visited == (pytest.approx(-0.57063, abs=1e-4), pytest.approx(0.6, abs=1e-7))
    np.testing.assert_allclose(at(seal, [-0.55, -0.2, -0.1, 0.0, 0.2, 0.6]),
                               [5.0, 5.0, 2.5, 0.0, 4.0, 8.0], atol=1e-9)  # fmt: skip
    np.testing.assert_array_equal(seal.data[1], [5.0, 0.0, 8.0])
    assert "outside held; the run leaves it" in seal.said
    wind = used[0]["forces.wind.force"]
    assert (wind.x, wind.y_unit) == ("door_angle", "N")
    np.testing.assert_allclose(at(wind, [-0.5, 0.3, 0.6]), 1.5 * np.array([-50, 30, 60]), rtol=1e-9)
    np.testing.assert_allclose(wind.data[1], [0.0, 45.0])  # the ultimate load, as it acts


def test_springs(used):
    rope = used[0]["forces.rope.elastic"]
    way = used[2].channel("way")
    assert way.min() < 0.0
    assert rope.visited == pytest.approx((way.min() - 0.05, way.max() - 0.05), abs=1e-4)
    np.testing.assert_allclose(at(rope, [rope.visited[0], 0.0]), 0.0, atol=1e-9)
    assert at(rope, rope.visited[1]) == pytest.approx(100.0 * rope.visited[1])
    damper = used[0]["forces.seal.damper"]
    assert (damper.x, damper.x_unit) == ("rate", "rad/s")
    w = 0.6 * 2.0 * np.pi
    assert -w <= damper.visited[0] < -0.99 * w and 0.99 * w < damper.visited[1] <= w
    assert "at least" in damper.why


def test_what_has_no_curve_is_told(used):
    assert used[1] == ["forces.both.force: depends on t and way: no curve of one variable"]


def test_force_over_depth_and_the_loss(tmp_path):
    """Area in: E (1 + 2/3 chi), out: E (1 - 2/3 chi e), where E = 2/5 K d^2.5, and
    u/chi - ln(1 + chi u)/chi^2 is the same at 1 and at -e."""
    small.run(tmp_path / "x.h5")
    [law], lost = laws(read(tmp_path / "x.h5"))
    assert (law.name, law.x_unit, law.y_unit, lost) == ("contact.B", "m", "N", [])
    R, c, E, nu = 10e-3, 0.5e-3, 207e9, 0.3
    K = 4.0 / (3.0 * 2.0 * (1.0 - nu**2) / E) * np.sqrt(R * (R - c) / c)
    depth, rest = law.curves["at rest"]
    np.testing.assert_allclose(rest, K * depth**1.5, rtol=1e-12)
    deepest = depth[-1]
    assert law.visited == (0.0, deepest)
    assert deepest >= law.met[0].max()
    chi = 0.75 * (1.0 - 0.9**2)
    left = 1.0 / chi - np.log1p(chi) / chi**2
    grid = np.linspace(0.5, 1.0, 200001)
    e = grid[np.argmin(np.abs(-grid / chi - np.log1p(-chi * grid) / chi**2 - left))]
    x, y = law.curves["impact"]
    half = len(x) // 2
    whole = 0.4 * K * deepest**2.5
    assert np.trapezoid(y[:half], x[:half]) == pytest.approx(whole * (1 + 2 / 3 * chi), rel=1e-3)
    out = -np.trapezoid(y[half:], x[half:])
    assert out == pytest.approx(whole * (1 - 2 / 3 * chi * e), rel=1e-3)


BLOCK = """\
bodies:
  block: {mass: 2, inertia: 1, at: [0, 0], velocity: [1, 0]}
  bead: {mass: 1, inertia: 1, at: [0.1, 2], velocity: [1, 0]}
joints:
  slide: {type: prismatic, bodies: [ground, block], axis: [1, 0, 0]}
  wire: {type: point_on_curve, bodies: [ground, bead], at: [0.1, 2],
         curve: {at: [0, 2], points: [[0, 0], [0.2, 0], [1, 0]]}}
forces:
  wall: {type: limit_stop, joint: slide, upper: 0.1, stiffness: 1e4, damping: 20, ramp: 1e-4}
  rub: {type: joint_friction, joint: slide, friction: {law: modified_coulomb, coefficient: 0.3,
        v0: 0.01, v1: 0.1}}
gravity: [0, -9.81, 0]
solver: {end: 0.3 s, tolerance: 1e-9}
output: {every: 10 ms}
"""


def test_stop_friction_and_curve_of_a_run(tmp_path):
    """v^2 = 1 - 2 mu g 0.1 at the wall, then m x'' + c x' + k x = 0 with x = d + mu m g / k, but
    for the ramp of the first 0.1 of 8 mm; the bead goes on at 1 m/s."""
    small.run(tmp_path / "x.h5", text=BLOCK)
    found, lost = laws(read(tmp_path / "x.h5"))
    of = {law.name: law for law in found}
    assert (lost, [*of]) == (
        [], ["joints.wire.curve", "forces.rub.friction", "contact.wall"])  # fmt: skip
    v = np.sqrt(1.0 - 2.0 * 0.3 * 9.81 * 0.1)
    wall = of["contact.wall"]
    x0, w, z = 0.3 * 2.0 * 9.81 / 1e4, np.sqrt(1e4 / 2.0), 20.0 / (2.0 * np.sqrt(2e4))
    wd = w * np.sqrt(1.0 - z * z)
    t = np.arctan2(wd * v, z * w * v + w * w * x0) / wd
    x = np.exp(-z * w * t) * (x0 * np.cos(wd * t) + (v + z * w * x0) / wd * np.sin(wd * t))
    assert wall.visited == (0.0, pytest.approx(x - x0, rel=0.01))
    depth, force = wall.curves["impact"]
    slower = np.sqrt(1.0 - (depth[200] / wall.visited[1]) ** 2)
    assert force[200] == pytest.approx(1e4 * depth[200] + 20.0 * v * slower, rel=1e-6)
    assert (wall.x_unit, wall.y_unit) == ("m", "N")
    assert of["forces.rub.friction"].visited == (0.0, pytest.approx(1.0, rel=1e-6))
    wire = of["joints.wire.curve"]
    assert wire.visited == (pytest.approx(0.1), pytest.approx(0.4))
    assert wire.curves["visited"][0][[0, -1]] == pytest.approx([0.1, 0.4], abs=1e-6)
    np.testing.assert_allclose(wire.data, [[0.0, 0.2, 1.0], [0.0, 0.0, 0.0]])


def test_a_stop():
    class Stop:
        stiffness, damping, ramp = 1e4, 20.0, 1e-3

    depth = np.linspace(0.0, 4e-3, 2001)
    found = stopped(Stop, depth, 0.5)
    np.testing.assert_allclose(found["at rest"][1], 1e4 * depth)
    x, y = found["impact"]
    k = 1000  # 2 mm in, past the ramp, at sqrt(3)/2 of the speed
    assert (x[k], y[k]) == (pytest.approx(2e-3), pytest.approx(20.0 + 10.0 * np.sqrt(0.75)))
    assert y[-1 - k] == pytest.approx(20.0 - 10.0 * np.sqrt(0.75))
    half = 20.0 * 0.5 * 0.5 * np.sqrt(1.0 - 0.125**2)  # half of the ramp, nearly at full speed
    assert y[250] == pytest.approx(5.0 + half)
    assert [*stopped(Stop, depth, 0.0)] == ["at rest"]
    assert [*hertzian(loads(small.SLIDER_CRANK).contact_laws["pin"], 5e-4, depth, 0.0)] == [
        "at rest"
    ]


def test_friction():
    ramp = Friction(law="modified_coulomb", coefficient=0.3, v0=0.1, v1=0.3)
    assert [coefficient(ramp, v) for v in (0.0, 0.1, 0.2, 0.3, 9.0)] == pytest.approx(
        [0.0, 0.0, 0.15, 0.3, 0.3]
    )
    stick = Friction(law="sticking", coefficient=0.2, static_coefficient=0.5, stribeck_speed=0.1,
                     bristle_stiffness=1e5)  # fmt: skip
    assert [coefficient(stick, v) for v in (0.0, 0.1, 9.0)] == pytest.approx(
        [0.5, 0.2 + 0.3 / np.e, 0.2]
    )
    assert coefficient(Friction(law="coulomb", coefficient=0.4), 3.0) == 0.4


def test_the_visited_part_of_a_curve():
    """An eighth of a circle across its beginning, and all of it after more than a turn."""
    circle = Curve(x="0.2*cos(s)", y="0.2*sin(s)", range=(0.0, 2.0 * np.pi), closed=True)
    curve = sampled(circle)
    x, y = part(curve, -0.2 * np.pi / 8.0, 0.2 * np.pi / 8.0)
    turn = np.unwrap(np.arctan2(y, x))
    assert (turn[0], turn[-1]) == pytest.approx((-np.pi / 8.0, np.pi / 8.0), abs=1e-5)
    np.testing.assert_allclose(np.hypot(x, y), 0.2, rtol=1e-5)
    x, y = part(curve, -1.0, 3.0)
    assert np.ptp(np.unwrap(np.arctan2(y, x))) == pytest.approx(2.0 * np.pi, abs=1e-5)
    line = sampled(Curve(points=((0.0, 0.0), (0.1, 0.0), (0.3, 0.0))))
    x, _ = part(line, 0.05, 0.2)
    assert (x[0], x[-1]) == pytest.approx((0.05, 0.2), abs=1e-7)


def test_a_contact_with_a_surface_tells_where_it_was_deepest(tmp_path):
    """A weight that is led along a plane and pressed most as it passes x = 0.3 m."""
    path = tmp_path / "press.h5"
    small.run(
        path,
        text="""\
bodies:
  cart: {mass: 1, inertia: 1, at: [0, 0.0199]}
  ball: {mass: 0.1, inertia: 1e-5, at: [0, 0.0199]}
joints:
  rail: {type: prismatic, bodies: [ground, cart], at: [0, 0.0199], axis: [1, 0, 0]}
  up: {type: prismatic, bodies: [cart, ball], at: [0, 0.0199], axis: [0, 1, 0]}
drives: {pull: {joint: rail, velocity: 1}}
forces:
  press: {type: applied_load, body: ball, at: [0, 0.0199], direction: [0, -1, 0],
          force: "100*exp(-((t-0.3)/0.1)**2) + 1"}
  floor: {type: surface_contact, surface: {body: ground, at: [-0.1, 0]},
          ball: {body: ball, at: [0, 0.0199], radius: 0.02}}
contact_laws: {soft: {normal: impact, exponent: 1, stiffness: 1e5, damping: 50, ramp: 1e-9}}
solver: {end: 0.6 s, tolerance: 1e-8}
output: {every: 5 ms}
""",
    )
    law = {law.name: law for law in laws(read(path))[0]}["contact.floor"]
    assert law.visited == (0.0, pytest.approx(101 / 1e5, rel=5e-3))
    x = float(law.why.split("[")[1].split(",")[0])
    assert x == pytest.approx(0.1 + 0.3, abs=0.02)
    depth, force = law.curves["at rest"]
    assert force == pytest.approx(1e5 * depth)
