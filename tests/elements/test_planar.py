"""Planar joint: a plate on a plane that stands, tilts or turns; its angle, x and y."""

import numpy as np
import pytest

from trsim.errors import TrsimError

from ..runs import built, energy_error, run

A = np.array([2.0, 1.0, 2.0]) / 3.0
X = np.array([1.0, 0.0, -1.0]) / np.sqrt(2.0)
Y = np.cross(A, X)
G = np.array([1.0, -9.0, -3.0])
SPACES = ["true", "false"]
TILTED = f"""
planar: false
bodies:
  plate: {{mass: 2, inertia: [0.02, 0.02, 0.02], at: {(0.3 * A).tolist()}, angle: 0.9,
          velocity: {(0.8 * X - 0.2 * Y).tolist()}, angular_velocity: {(9 * A).tolist()}}}
joints:
  plane: {{type: planar, bodies: [ground, plate], at: [0, 0, 0], axis: {(3 * A).tolist()},
          x_axis: {(2 * X + 5 * A).tolist()}}}
sensors: {{turn: {{joint: plane.angle}}, x: {{joint: plane.x}}, y: {{joint: plane.y}}}}
gravity: {G.tolist()}
solver: {{end: 3, tolerance: 1e-10}}
output: {{every: 0.01}}
"""


@pytest.mark.parametrize("method", ["dop853", "radau"])
def test_on_a_tilted_plane(method):
    """It slides with what of the weight lies in the plane, turns on, and presses with the rest."""
    r = run(TILTED.replace("1e-10", f"1e-10, method: {method}"))
    t = r.t
    x, y = 0.8 * t + (G @ X) * t**2 / 2, -0.2 * t + (G @ Y) * t**2 / 2
    assert r["x"] == pytest.approx(x, abs=1e-7) and r["y"] == pytest.approx(y, abs=1e-7)
    assert r["y.rate"] == pytest.approx(-0.2 + (G @ Y) * t, abs=1e-7)
    assert r["x.acceleration"] == pytest.approx(G @ X, abs=1e-7)
    assert r["turn"] == pytest.approx(9 * t, abs=1e-7) and r["turn"][-1] > 4 * 2 * np.pi
    place = 0.3 * A + x[:, None] * X + y[:, None] * Y
    assert r["plate.position"] == pytest.approx(place, abs=1e-7)
    assert r["plane.reaction"] == pytest.approx(-2 * (G @ A) * A + 0 * place, abs=1e-6)
    # the weight along the plane acts above the point of the joint, and so does the inertia
    assert r["plane.reaction_moment"] == pytest.approx(0 * place, abs=1e-6)
    assert energy_error(r) < 1e-9


TURNTABLE = """
planar: {planar}
bodies:
  table: {{mass: 1, inertia: [1, 1, 1], angle: 0.4}}
  puck: {{mass: 2, inertia: [0.1, 0.1, 0.1], at: [0.3, 0.1], angle: -1}}
joints:
  hinge: {{type: revolute, bodies: [ground, table], at: [0, 0]}}
  top: {{type: planar, bodies: [table, puck], at: [0.3, 0.1]}}
drives: {{motor: {{joint: hinge, velocity: 10}}}}
sensors: {{turn: {{joint: top.angle}}, x: {{joint: top.x}}, y: {{joint: top.y}}}}
solver: {{end: 2, tolerance: 1e-10}}
output: {{every: 0.01}}
"""


@pytest.mark.parametrize("planar", SPACES)
def test_a_puck_on_a_table_that_turns(planar):
    """It stays where it is; seen from the table it goes round, three times, and turns back."""
    r = run(TURNTABLE.format(planar=planar))
    assert r.mechanism.planar == (planar == "true")
    turn, place = 10 * r.t, np.array([0.3, 0.1])
    assert r["turn"] == pytest.approx(-turn, abs=1e-7)
    c, s = np.cos(turn), np.sin(turn)
    assert r["x"] == pytest.approx(c * 0.3 + s * 0.1 - 0.3, abs=1e-7)
    assert r["y"] == pytest.approx(-s * 0.3 + c * 0.1 - 0.1, abs=1e-7)
    assert r["puck.position"][:, :2] == pytest.approx(place + 0 * c[:, None], abs=1e-8)
    assert r["top.reaction"] == pytest.approx(0 * r["top.reaction"], abs=1e-8)
    assert r["motor.force"] == pytest.approx(0 * turn, abs=1e-8)


DRIVEN = """
planar: {planar}
bodies: {{plate: {{mass: 2, inertia: [0.1, 0.1, 0.1], at: [0.1, 0.2], angle: 0.5}}}}
joints: {{plane: {{type: planar, bodies: [ground, plate], at: [0.1, 0.2], x_axis: [0, 1]}}}}
drives:
  east: {{joint: plane.x, position: 0.1*sin(3*t)}}
  north: {{joint: plane.y, velocity: 2*t}}
  motor: {{joint: plane.angle, velocity: 8}}
sensors: {{x: {{joint: plane.x}}, y: {{joint: plane.y}}, turn: {{joint: plane.angle}}}}
solver: {{end: 2, tolerance: 1e-10}}
output: {{every: 0.01}}
"""


@pytest.mark.parametrize("planar", SPACES)
def test_a_drive_on_each_coordinate(planar):
    r = run(DRIVEN.format(planar=planar))
    assert r.mechanism.planar == (planar == "true") and r.mechanism.mobility == 0
    x, y = 0.1 * np.sin(3 * r.t), r.t**2
    assert r["x"] == pytest.approx(x, abs=1e-8) and r["y"] == pytest.approx(y, abs=1e-8)
    assert r["plate.position"][:, 0] == pytest.approx(0.1 - y, abs=1e-8)
    assert r["plate.position"][:, 1] == pytest.approx(0.2 + x, abs=1e-8)
    assert r["turn"] == pytest.approx(8 * r.t, abs=1e-8)
    assert r["east.force"] == pytest.approx(-2 * 9 * x, abs=1e-6)
    assert r["north.force"] == pytest.approx(4.0, abs=1e-6)
    units = {c.name: c.unit for c in r.mechanism.columns}
    assert [units[n] for n in ("x", "turn", "east.force", "motor.force")] == [
        "m",
        "rad",
        "N",
        "N*m",
    ]
    assert energy_error(r) < 1e-9


def test_locks_stops_and_initial_values():
    """It starts turned and aside, meets a stop along x, and y is held for a while."""
    text = """
bodies: {plate: {mass: 2, inertia: 0.1, velocity: [1, 1]}}
joints: {plane: {type: planar, bodies: [ground, plate], at: [0, 0]}}
sensors: {x: {joint: plane.x}, y: {joint: plane.y}, turn: {joint: plane.angle}}
initial: {plane.x: 0.5, plane.angle: 400 deg}
forces: {wall: {type: limit_stop, joint: plane.x, upper: 1, stiffness: 1e6}}
events:
  hold: {when: t, value: 0.2, do: {lock: [plane.y]}}
  free: {when: t, value: 0.6, do: {unlock: [plane.y]}}
solver: {end: 1, tolerance: 1e-9}
output: {every: 0.01}
"""
    r = run(text)
    assert r["x"][0] == pytest.approx(0.5) and r["turn"][0] == pytest.approx(np.deg2rad(400))
    assert r["x"].max() == pytest.approx(1.0, abs=0.01) and r["x"][-1] < 0.6
    assert r["y"][r.t > 0.2] == pytest.approx(0.2, abs=1e-8)


@pytest.mark.parametrize("axis", ["[1, 0, 0]", "[1, 0, 1]"])
def test_another_plane_is_not_planar(axis):
    text = f"""
bodies: {{plate: {{mass: 2, inertia: [1, 1, 1]}}}}
joints: {{plane: {{type: planar, bodies: [ground, plate], at: [0, 0], axis: {axis}}}}}
"""
    assert not built(text).planar
    with pytest.raises(TrsimError, match="leave the x-y plane"):
        built("planar: true" + text)


@pytest.mark.parametrize(
    "keys, key, words, hint",
    [
        ("axis: [0, 0, 0]", "axis", "must not be zero", "for example"),
        ("x_axis: [0, 0, 0]", "x_axis", "must not be zero", "for example"),
        ("x_axis: [0, 0, -2]", "x_axis", "direction of `axis`", "for example [1, 0, 0]"),
    ],
)
def test_refused(keys, key, words, hint):
    with pytest.raises(TrsimError) as caught:
        built(f"""
bodies: {{plate: {{mass: 2, inertia: 0.1}}}}
joints: {{plane: {{type: planar, bodies: [ground, plate], at: [0, 0], {keys}}}}}
""")
    assert caught.value.path == ("joints", "plane", key)
    assert words in caught.value.what and hint in caught.value.hint


def test_in_a_template_that_is_turned():
    """x is that of the instance's frame."""
    m = built("""
planar: false
templates:
  desk:
    bodies: {plate: {mass: 1, inertia: [1, 1, 1]}}
    joints: {top: {type: planar, bodies: [ground, plate], at: [0, 0], x_axis: [1, 0, 0]},
             bottom: {type: planar, bodies: [ground, plate], at: [0, 0]}}
    sensors: {x: {joint: top.x}, y: {joint: bottom.y}}
instances: {a: {template: desk, frame: {at: [1, 0], x_axis: [0, 1, 0], y_axis: [0, 0, 1]}}}
""")
    assert m.coordinates["a_top.x"].axis == pytest.approx((0, 1, 0))
    assert m.coordinates["a_bottom.y"].axis == pytest.approx((0, 0, 1))


@pytest.mark.parametrize("planar", SPACES)
def test_rates_at_the_start(planar):
    """Of a joint at the end of a lever: its point has the rates along the axes of the ground."""
    r = run(f"""
planar: {planar}
bodies: {{plate: {{mass: 2, inertia: [0.02, 0.02, 0.02], at: [1, 0]}}}}
joints: {{plane: {{type: planar, bodies: [ground, plate], at: [0, 0]}}}}
sensors: {{turn: {{joint: plane.angle}}, x: {{joint: plane.x}}, y: {{joint: plane.y}}}}
initial: {{plane.x.rate: 2, plane.y.rate: -300 cm/s, plane.angle.rate: 30 rpm}}
solver: {{end: 0.1}}
""")
    assert [r[f"{x}.rate"][0] for x in ("turn", "x", "y")] == pytest.approx([np.pi, 2, -3])
    assert r["plate.velocity"][0] == pytest.approx([2, -3 + np.pi, 0], abs=1e-12)


@pytest.mark.parametrize("key", ["plane.x", "plane.y", "plane.x.rate"])
def test_units_of_values_at_the_start(key):
    with pytest.raises(TrsimError, match="wrong unit: 'deg") as caught:
        built(TILTED + f"initial: {{{key}: 90 deg{'/s' * key.endswith('rate')}}}\n")
    assert caught.value.problems[0].path == ("initial", key)
