"""Cylindrical joint: a screw-free fall along a tilted axis, its two coordinates, what they carry.

A ring of mass m turns on a fixed axis a and slides along it, its centre of mass at a distance r
from the axis and all its moments of inertia I:

    stroke'' = g . a        (I + m r^2) angle'' = 0 where g has no part across the axis
    reaction = m (r'' - g),  r'' = (g . a) a - r angle'^2
"""

import numpy as np
import pytest

from trsim.assemble.release import release
from trsim.errors import TrsimError
from trsim.scenario.load import loads

from ..runs import built, energy_error, run

A = np.array([2.0, 1.0, 2.0]) / 3.0
OUT = np.array([1.0, 0.0, -1.0]) / np.sqrt(2.0)  # across the axis
M, I, R, RATE = 2.0, 0.02, 0.1, 3.0
PLACE = R * OUT


def ring(more="", away=PLACE, gravity=-9.81 * A, kind="cylindrical", solver="tolerance: 1e-10"):
    """A ring on a tilted shaft of the ground, with the rate RATE."""
    turning = RATE * A
    return f"""
planar: false
bodies:
  ring: {{mass: {M}, inertia: [{I}, {I}, {I}], at: {away.tolist()},
         velocity: {np.cross(turning, away).tolist()}, angular_velocity: {turning.tolist()}}}
joints:
  shaft: {{type: {kind}, bodies: [ground, ring], at: [0, 0, 0], axis: {(3 * A).tolist()}}}
sensors: {{angle: {{joint: shaft.angle}}, stroke: {{joint: shaft.stroke}}}}
gravity: {gravity.tolist()}
solver: {{end: 2, {solver}}}
output: {{every: 0.01, channels: ["*"]}}
{more}
"""


METHODS = {
    "dop853": ("tolerance: 1e-10", 1e-8),
    "radau": ("method: radau, tolerance: 1e-9", 1e-6),
    "ggl": ("method: radau, formulation: ggl, tolerance: 1e-9", 1e-6),
    "rk4": ("method: rk4, step: 1e-3", 1e-8),
    "generalized_alpha": ("method: generalized_alpha, tolerance: 1e-5", 1e-3),
}


@pytest.mark.parametrize("method", METHODS)
def test_fall_and_spin(method):
    solver, error = METHODS[method]
    r = run(ring(solver=solver))
    angle, stroke = RATE * r.t, -9.81 * r.t**2 / 2
    assert r["angle"] == pytest.approx(angle, abs=error * RATE)
    assert r["angle.rate"] == pytest.approx(RATE, abs=error * RATE)
    assert r["stroke"] == pytest.approx(stroke, abs=error * 20)
    assert r["stroke.rate"] == pytest.approx(-9.81 * r.t, abs=error * 20)
    assert r["angle.acceleration"] == pytest.approx(0.0, abs=1e3 * error)
    out = np.cos(angle)[:, None] * OUT + np.sin(angle)[:, None] * np.cross(A, OUT)
    place = R * out + stroke[:, None] * A
    assert r["ring.position"] == pytest.approx(place, abs=error * 20)
    force = -M * R * RATE**2 * out
    assert r["shaft.reaction"] == pytest.approx(force, abs=1e3 * error)
    # the point of the joint slides along: the moment there is that of the force on the ring
    assert r["shaft.reaction_moment"] == pytest.approx(0.0 * force, abs=1e3 * error)
    assert energy_error(r) < 1e2 * error


def test_weight_across_the_axis_swings_it():
    """A pendulum on a slide: the same swing as on a hinge, and the fall as along a slide."""
    gravity = np.array([0.0, -9.81, 0.0])
    both = run(ring(gravity=gravity))
    hinge = run(
        ring(gravity=gravity, kind="revolute").replace(", stroke: {joint: shaft.stroke}", "")
    )
    assert np.ptp(both["angle"]) > 1.0
    assert both["angle"] == pytest.approx(hinge["angle"], abs=1e-8)
    fall = (gravity @ A) * both.t**2 / 2
    assert both["stroke"] == pytest.approx(fall, abs=1e-8)
    assert both["ring.position"] == pytest.approx(
        hinge["ring.position"] + fall[:, None] * A, abs=1e-8
    )
    # along the axis the hinge carries the weight, the slide nothing
    assert both["shaft.reaction"] @ A == pytest.approx(0.0, abs=1e-9)
    across = hinge["shaft.reaction"] - (hinge["shaft.reaction"] @ A)[:, None] * A
    assert both["shaft.reaction"] == pytest.approx(across, abs=1e-6)
    assert energy_error(both) < 1e-9


SCREW = """
drives:
  turn: {joint: shaft.angle, velocity: "3 + 2*t"}
  lift: {joint: shaft.stroke, position: "0.3*sin(2*t)"}
"""


def test_a_drive_on_each_coordinate():
    r = run(ring(SCREW, away=np.zeros(3)))
    assert r.mechanism.mobility == 0
    assert r["angle"] == pytest.approx(3 * r.t + r.t**2, abs=1e-8)
    assert r["stroke"] == pytest.approx(0.3 * np.sin(2 * r.t), abs=1e-9)
    assert r["turn.force"] == pytest.approx(2 * I, abs=1e-7)
    assert r["lift.force"] == pytest.approx(M * (9.81 - 1.2 * np.sin(2 * r.t)), abs=1e-6)
    units = {c.name: c.unit for c in r.mechanism.columns}
    assert (units["turn.force"], units["lift.force"]) == ("N*m", "N")
    assert (units["angle"], units["stroke"]) == ("rad", "m")
    assert energy_error(r) < 1e-9


CARRIED = """
forces:
  coil: {type: torsion_spring, joint: shaft, stiffness: 0.5}
  floor: {type: limit_stop, joint: shaft.stroke, lower: -0.5, stiffness: 1e6}
  wall: {type: limit_stop, joint: shaft.angle, upper: 0.4, stiffness: 1e3 N*m/rad}
"""


def test_a_spring_on_the_angle_and_stops_on_both():
    """The spring alone turns the ring until a stop; the floor throws it up again without loss."""
    r = run(ring(CARRIED, away=np.zeros(3)))
    omega = np.sqrt(0.5 / I)
    fall = np.sqrt(2 * 0.5 / 9.81)
    before = r.t < np.arcsin(0.4 * omega / RATE) / omega
    assert r["angle"][before] == pytest.approx(RATE / omega * np.sin(omega * r.t[before]), abs=1e-8)
    assert r["angle"].max() == pytest.approx(0.4, abs=0.03) and r["angle"].min() < -0.4
    assert r["stroke"][r.t < fall] == pytest.approx(-9.81 * r.t[r.t < fall] ** 2 / 2, abs=1e-8)
    assert r["stroke"].min() == pytest.approx(-0.5, abs=0.02)
    assert np.abs(r["stroke"][r.t > fall]).min() < 0.01
    assert energy_error(r) < 1e-8


EVENTS = """
events:
  stop: {when: stroke, value: -1, crosses: down, do: {lock: [shaft.stroke]}}
  go: {when: t, value: 0.6, do: {unlock: [shaft.stroke], lock: [shaft.angle]}}
  off: {when: t, value: 1.0, do: {release: [shaft]}}
"""


def test_locks_hold_one_coordinate_each():
    r = run(ring(EVENTS, away=np.zeros(3)))
    arrives = np.sqrt(2 / 9.81)
    held, turned, later = (r.t > arrives) & (r.t < 0.6), (r.t > 0.6) & (r.t < 1.0), r.t > 1.0
    assert r["stroke"][held] == pytest.approx(-1.0, abs=1e-9)
    assert r["angle"][held] == pytest.approx(RATE * r.t[held], abs=1e-8)
    assert r["angle"][turned] == pytest.approx(RATE * 0.6, abs=1e-8)
    fall = -1.0 - 9.81 * (r.t - 0.6) ** 2 / 2
    assert r["stroke"][turned] == pytest.approx(fall[turned], abs=1e-8)
    # released it falls on, and nothing turns it again
    assert r["ring.position"][later] @ A == pytest.approx(fall[later], abs=1e-8)
    assert r["shaft.stroke.lock.force"][held] == pytest.approx(9.81 * M, abs=1e-6)


def test_initial_values():
    text = ring("initial: {shaft.angle: 30 deg, shaft.stroke: 0.4}", gravity=np.zeros(3))
    r = run(text)
    assert r["angle"][0] == pytest.approx(np.pi / 6, abs=1e-9)
    assert r["stroke"][0] == pytest.approx(0.4, abs=1e-9)


def test_balance():
    """The ring swings to where it hangs, and slides to where a spring holds it."""
    more = """
initial: {equilibrium: [shaft]}
forces: {hanger: {type: spring_damper, bodies: [ground, ring], points: [[0, 0, 0], [0, 0, 0]],
         stiffness: 100, free_length: 0.1}}
"""
    r = run(
        ring(more, gravity=np.array([0.0, -9.81, 0.0])).replace(
            "solver: {end: 2", "solver: {end: 0.1"
        )
    )
    still = np.abs(r["stroke"] - r["stroke"][0]).max() + np.abs(r["angle"] - r["angle"][0]).max()
    assert still < 1e-7 and abs(r["angle"][0]) > 0.1


SENSOR = ("sensors", "angle", "joint")


@pytest.mark.parametrize(
    "old, new, path, words",
    [
        ("joint: shaft.angle", "joint: shaft", SENSOR, "several coordinates"),
        ("joint: shaft.angle", "joint: shaft.angel", SENSOR, "has no angel"),
        ("joint: shaft.angle", "joint: shaf.angle", SENSOR, "no joint named"),
        ("gravity:", "initial: {shaft: 1}\ngravity:", ("initial", "shaft"), "several coordinates"),
        ("gravity:", "forces: {coil: {type: torsion_spring, joint: shaft.stroke,\n"
         " stiffness: 1 N*m/rad}}\ngravity:", ("forces", "coil", "stiffness"), "the joint slides"),
        ("gravity:", "events: {e: {when: t, value: 1, do: {lock: [shaft]}}}\ngravity:",
         ("events", "e", "do", "lock", 0), "several coordinates"),
    ],
)  # fmt: skip
def test_which_coordinate_must_be_said(old, new, path, words):
    with pytest.raises(TrsimError) as caught:
        built(ring().replace(old, new))
    assert caught.value.path == path
    assert words in caught.value.what
    if "several" in words:
        assert caught.value.hint == "name one of them: shaft.angle, shaft.stroke"


def test_a_hinge_may_be_named_by_its_angle_too():
    text = ring(kind="revolute").replace(", stroke: {joint: shaft.stroke}", "")
    assert list(built(text).coordinates) == ["shaft"]


def test_in_a_template():
    """A part of it, and what it names, have the names of the instance."""
    m = built("""
planar: false
templates:
  post:
    bodies: {ring: {mass: 1, inertia: [1, 1, 1]}}
    joints: {shaft: {type: cylindrical, bodies: [ground, ring], at: [0, 0], axis: [0, 0, 1]}}
    sensors: {height: {joint: shaft.stroke}}
    drives: {turn: {joint: shaft.angle, velocity: 1}}
    events: {held: {when: height, value: -1, crosses: down, do: {lock: [shaft.stroke]}}}
instances: {a: {template: post}, b: {template: post, frame: {at: [1, 0], y_axis: [0, 0, 1]}}}
""")
    assert {*m.coordinates} == {f"{one}_shaft.{x}" for one in "ab" for x in ("angle", "stroke")}
    assert m.coordinates["b_shaft.stroke"].axis == pytest.approx((0, -1, 0))


def test_two_bearings_on_one_shaft():
    """Four rows too many; points on the axis hold what is left, and the ring slides and turns."""
    again = "  more: {type: cylindrical, bodies: [ground, ring], at: [2, 1, 2], axis: [2, 1, 2]}\n"
    text = ring().replace("sensors:", again + "sensors:")
    m = built(text)
    assert (m.mobility, m.mobility_by_count, len(m.redundant)) == (2, -2, 4)
    bare = text.replace(
        "sensors: {angle: {joint: shaft.angle}, stroke: {joint: shaft.stroke}}\n", ""
    )
    found = release(loads(bare), built(bare))
    assert found.proven
    assert [(c.joint, c.type) for c in found.changes] == [("shaft", "inline"), ("more", "inline")]
    m = built(text.replace("type: cylindrical, bodies: [ground, ring], at: [2", "type: inline, "
                           "bodies: [ground, ring], at: [2"))  # fmt: skip
    assert len(m.redundant) == 2


@pytest.mark.parametrize("axis", ["[1, 0, 0]", "[0, 0, 1]"])
def test_is_never_planar(axis):
    text = f"""
bodies: {{ring: {{mass: 1, inertia: [1, 1, 1]}}}}
joints: {{shaft: {{type: cylindrical, bodies: [ground, ring], at: [0, 0], axis: {axis}}}}}
"""
    assert not built(text).planar
    with pytest.raises(TrsimError, match="leave the x-y plane"):
        built("planar: true" + text)


def test_a_crank_whose_piston_turns_in_its_cylinder():
    """Nothing is redundant in a slider-crank with a ball on its crank and a cylinder."""
    m = built("""
planar: false
bodies:
  crank: {mass: 1, inertia: [0.1, 0.1, 0.1], at: [0, 0.1, 0]}
  rod: {mass: 1, inertia: [0.1, 0.1, 0.1], at: [0.4, 0.1, 0]}
  piston: {mass: 1, inertia: [0.1, 0.1, 0.1], at: [0.8, 0, 0]}
joints:
  A: {type: revolute, bodies: [ground, crank], at: [0, 0, 0]}
  B: {type: spherical, bodies: [crank, rod], at: [0, 0.2, 0]}
  C: {type: revolute, bodies: [rod, piston], at: [0.8, 0, 0]}
  D: {type: cylindrical, bodies: [ground, piston], at: [0.8, 0, 0], axis: [1, 0, 0]}
""")
    assert (m.mobility, m.mobility_by_count, m.redundant) == (1, 1, ())
