"""trsim statics: closed forms of places, reactions and stability."""

import numpy as np
import pytest
from scipy.optimize import brentq

from trsim.errors import ModelError
from trsim.scenario.load import load, loads
from trsim.solve.rest import at_rest, turn

from ..runs import run
from .test_inverse_dynamics import VALIDATION

G = 9.81


def rest(text, *sets):
    return at_rest(loads(text, sets) if isinstance(text, str) else text)


def channel(resting, name):
    [column] = [c for c in resting.mechanism.columns if c.name == name]
    values = resting.channels[column.start : column.start + column.size]
    return float(values[0]) if column.size == 1 else values


SPRUNG = """
planar: {planar}
bodies:
  rod: {{mass: 2 kg, inertia: [0.07, 0.06, 0.05], at: [0.2, 0]}}
joints:
  hinge: {{type: revolute, bodies: {bodies}, at: [0, 0]}}
forces:
  spring: {{type: spring_damper, bodies: [ground, rod], points: [[0.3, 0.4], [0.3, 0]],
           stiffness: 200, free_length: 0.3, damping: 5}}
  pull: {{type: applied_load, body: rod, at: [0.4, 0], frame: world, direction: [1, 0, 0],
         force: "3 + 100*t"}}
gravity: [0, -9.81, 0]
"""


def sprung(q):
    """Moment about the hinge, the spring's tension, its length and direction on the rod."""
    end = 0.3 * np.array([np.cos(q), np.sin(q)])
    line = np.array([0.3, 0.4]) - end
    length = np.hypot(*line)
    T = 200 * (length - 0.3)
    F = T * line / length
    moment = end[0] * F[1] - end[1] * F[0] - 2 * G * 0.2 * np.cos(q) - 3 * 0.4 * np.sin(q)
    return moment, T, length, F


@pytest.mark.parametrize("planar", [True, False])
@pytest.mark.parametrize("bodies", ["[ground, rod]", "[rod, ground]"])
def test_rod_on_a_spring(planar, bodies):
    found = rest(SPRUNG.format(planar=str(planar).lower(), bodies=bodies))
    q = brentq(lambda x: sprung(x)[0], -1, 1)
    _, T, length, F = sprung(q)
    assert found.turns["rod"] == pytest.approx([0, 0, q], abs=1e-9)
    assert channel(found, "rod.position") == pytest.approx(
        [0.2 * np.cos(q), 0.2 * np.sin(q), 0], abs=1e-9
    )
    assert channel(found, "spring.force") == pytest.approx(T, abs=1e-6)
    assert channel(found, "spring.length") == pytest.approx(length, abs=1e-9)
    hinge = -np.array([F[0] + 3, F[1] - 2 * G]) * (1 if bodies == "[ground, rod]" else -1)
    assert channel(found, "hinge.reaction")[:2] == pytest.approx(hinge, abs=1e-6)
    stiffness = -(sprung(q + 1e-5)[0] - sprung(q - 1e-5)[0]) / 2e-5
    value = stiffness / (0.05 + 2 * 0.04)
    told = found.found
    assert (told.verdict, told.freedoms) == ("stable", 1)
    assert told.stiffness == pytest.approx(stiffness, rel=1e-6)
    assert told.eigenvalue == pytest.approx(value, rel=1e-6)
    assert told.frequency == pytest.approx(np.sqrt(value) / (2 * np.pi), rel=1e-6)
    assert told.residual < 1e-9


PENDULUM = """
planar: {planar}
bodies:
  rod: {{mass: 2 kg, inertia: [0.05, 0.05, 0.05], at: [0, {y}]}}
joints:
  hinge: {{type: revolute, bodies: [ground, rod], at: [0, 0]}}
gravity: [0, -9.81, 0]
"""


@pytest.mark.parametrize("planar", ["true", "false"])
@pytest.mark.parametrize("y, verdict", [(-0.3, "stable"), (0.3, "unstable"), (0, "indifferent")])
def test_pendulum(y, verdict, planar):
    """Its stiffness is that of the joint's curvature under its reaction alone: -m g y."""
    told = rest(PENDULUM.format(y=y, planar=planar)).found
    assert told.verdict == verdict
    assert told.eigenvalue == pytest.approx(-2 * G * y / (0.05 + 2 * y * y), rel=1e-7, abs=1e-6)
    assert (told.frequency is None) == (verdict != "stable")
    [moved] = told.direction
    assert moved.body == "rod" and abs(moved.rotation[2]) == pytest.approx(1, rel=1e-6)


ZIEGLER = """
bodies:
  one: {{mass: 2 kg, inertia: 1e-7, at: [1, 0]}}
  two: {{mass: 1 kg, inertia: 1e-7, at: [2, 0]}}
joints:
  a: {{type: revolute, bodies: [ground, one], at: [0, 0]}}
  b: {{type: revolute, bodies: [one, two], at: [1, 0]}}
forces:
  k1: {{type: torsion_spring, joint: a, stiffness: 100}}
  k2: {{type: torsion_spring, joint: b, stiffness: 100}}
  thrust: {{type: applied_load, body: two, at: [2, 0], frame: two,
           direction: [-1, 0, 0], force: {P}}}
"""


SLOW = {
    "one:": "  block: {mass: 1 kg, inertia: 1, at: [0, 3]}\n",
    "a:": "  slide: {type: prismatic, bodies: [ground, block], axis: [1, 0, 0]}\n",
    "k1:": "  soft: {type: spring_damper, bodies: [ground, block], points: [[-1, 3], [0, 3]],"
    " stiffness: 1, free_length: 1}\n",
}


@pytest.mark.parametrize("P, verdict", [(200, "stable"), (208, "stable"), (209.5, "unstable")])
@pytest.mark.parametrize("slow", [False, True])
def test_flutter(P, verdict, slow):
    """Ziegler's column: a thrust that turns with it, stable up to (7/2 - sqrt 2) k/l = 208.58 N;
    a slower motion beside it that is stable does not hide it."""
    text = ZIEGLER.format(P=P)
    for before, own in SLOW.items() if slow else ():
        text = text.replace(f"  {before}", f"{own}  {before}", 1)
    told = rest(text).found
    assert (told.verdict, told.freedoms) == (verdict, 3 if slow else 2)


def test_least_norm_of_redundant_rows():
    """Both hinges of a door carry the same, as pseudo-inverse of all rows says."""
    found = rest(load(VALIDATION / "kitchen_door.yaml"))
    both = channel(found, "bottom.reaction"), channel(found, "top.reaction")
    assert both[0][2] == pytest.approx(both[1][2], rel=1e-9)
    assert sum(both)[2] == pytest.approx(12 * G * np.cos(np.deg2rad(5)), rel=1e-9)
    moments = channel(found, "bottom.reaction_moment"), channel(found, "top.reaction_moment")
    weight, centre = 12 * G * np.array([np.sin(np.deg2rad(5)), 0, -np.cos(np.deg2rad(5))]), 0.3
    size = found.mechanism.model.size
    A = np.zeros((6, 10))  # of both forces, and of both moments across the axis
    for k, z in enumerate((0.2, 1.6)):
        A[:3, 3 * k : 3 * k + 3] = np.eye(3)
        A[3:, 3 * k : 3 * k + 3] = [[0, -z, 0], [z, 0, 0], [0, 0, 0]]
        A[3:5, 6 + 2 * k : 8 + 2 * k] = size * np.eye(2)
    x = np.linalg.pinv(A) @ -np.concatenate([weight, np.cross([centre, 0, 0.9], weight)])
    assert np.concatenate(both) == pytest.approx(x[:6], abs=1e-8)
    assert moments[0][:2] == pytest.approx(size * x[6:8], abs=1e-8)
    assert moments[1][:2] == pytest.approx(size * x[8:], abs=1e-8)


def test_drives_stand_still():
    """A drive at speed, with a damper in series: in balance it holds what hangs on it."""
    text = """
bodies: {block: {mass: 3 kg, inertia: 0.1, velocity: [0, 4, 0]}}
joints: {slide: {type: prismatic, bodies: [ground, block], axis: [0, 1, 0]}}
drives:
  jack: {joint: slide, MOTION, compliance: {stiffness: 1000, damping: 50}}
gravity: [0, -9.81, 0]
"""
    for motion, place in (('position: "0.1 + 5*t + t**2"', 0.1), ("velocity: 3", 0.0)):
        found = rest(text.replace("MOTION", motion))
        assert channel(found, "jack.force") == pytest.approx(3 * G, rel=1e-9)
        assert channel(found, "block.position")[1] == pytest.approx(place - 3 * G / 1000, abs=1e-9)
        assert channel(found, "jack.power") == channel(found, "jack.velocity") == 0.0
        assert found.found.eigenvalue == pytest.approx(1000 / 3, rel=1e-6)


def test_bent_bar():
    """A cantilever with a small load at its tip: F L^3 / 3 E I."""
    found = rest("""
bodies:
  bar: {type: ancf_cable, start: [0, 0], end: [1 m, 0], elements: 4, section: {width: 10 mm},
        youngs_modulus: 200 GPa, density: 7800 kg/m^3}
joints: {clamp: {type: fixed, bodies: [ground, bar], at: [0, 0]}}
forces: {tip: {type: applied_load, body: bar, at: [1, 0], frame: world, direction: [0, -1, 0],
               force: 1 N}}
""")
    I = 0.01**4 / 12
    assert channel(found, "bar.tip")[1] == pytest.approx(-1 / (3 * 200e9 * I), rel=1e-4)
    assert channel(found, "clamp.reaction")[1] == pytest.approx(1, rel=1e-6)
    assert channel(found, "clamp.reaction_moment")[2] == pytest.approx(1, rel=1e-4)
    first = 1.8751**2 / (2 * np.pi) * np.sqrt(200e9 * I / (7800 * 1e-4))
    assert found.found.verdict == "stable"
    assert found.found.frequency == pytest.approx(first, rel=2e-3)


def test_reactions_of_what_is_driven():
    """Nothing can move: the reactions are those of a kinematic run at rest."""
    still = ["drives.boom_ram.position=0", "drives.stick_ram.position=0",
             "drives.bucket_ram.velocity=0", "output.channels=['*']"]  # fmt: skip
    found = rest(load(VALIDATION / "excavator_arm.yaml"))
    known = run(load(VALIDATION / "excavator_arm.yaml", still), "solver.end=0.01")
    assert (found.found.verdict, found.found.freedoms) == ("stable", 0)
    for name in ("A.reaction", "H.reaction", "bucket_ram.force", "stick_ram.force"):
        assert channel(found, name) == pytest.approx(known[name][0], rel=1e-9)


def test_begins_at_values_of_joints():
    """Of two places where an over-centre spring lets it rest, the one that is near."""
    text = SPRUNG.format(planar="true", bodies="[ground, rod]").replace("[0.3, 0.4]", "[0, -0.6]")
    text = text.replace("free_length: 0.3", "free_length: 0.8")
    near, far = rest(text), rest(text + "initial: {hinge: 150 deg}")
    assert abs(near.turns["rod"][2]) < 1.5 < abs(far.turns["rod"][2])
    assert near.found.verdict == far.found.verdict == "stable"


@pytest.mark.parametrize(
    "text, what",
    [
        ("bodies: {b: {mass: 1, inertia: 1}}\ngravity: [0, -9.81, 0]", "stays unbalanced"),
        (ZIEGLER.format(P=1).replace("force: 1}", "torque: 1000}")
         .replace("direction: [-1, 0, 0]", "direction: [0, 0, 1]")
         .replace("joint: a, stiffness: 100", "joint: a, stiffness: 0"), "stays unbalanced"),
    ],
)  # fmt: skip
def test_no_equilibrium(text, what):
    with pytest.raises(ModelError, match=what) as caught:
        rest(text)
    assert "`equilibrium`" not in str(caught.value)


@pytest.mark.parametrize("angle", [0, 1e-9, 0.3, 2.0, 3.1, np.pi])
def test_turn(angle):
    axis = np.array([2.0, -1.0, 3.0]) / np.sqrt(14)
    K = np.array([[0, -axis[2], axis[1]], [axis[2], 0, -axis[0]], [-axis[1], axis[0], 0]])
    R = np.eye(3) + np.sin(angle) * K + (1 - np.cos(angle)) * K @ K
    R0 = np.array([[0, 0, 1], [1, 0, 0], [0, 1, 0]])
    found = np.array(turn(R @ R0, R0))
    assert found == pytest.approx(angle * axis, abs=1e-7) or (
        angle == np.pi and found == pytest.approx(-angle * axis, abs=1e-7)
    )


def test_pressed_in_its_clearance():
    """A journal that rests in its bearing: pressed in until the contact carries the weight."""
    found = rest("""
bodies: {rod: {mass: 2 kg, inertia: 0.05, at: [0, -0.2]}}
joints:
  pin: {type: revolute, bodies: [ground, rod], at: [0, 0], clearance: 0.5 mm, contact: steel}
contact_laws:
  steel: {normal: lankarani_nikravesh, stiffness: 1e9 N/m^1.5, restitution: 0.9,
          bearing_radius: 10 mm}
gravity: [0, -9.81, 0]
""")
    depth = (2 * G / 1e9) ** (2 / 3)
    assert channel(found, "pin.contact_force") == pytest.approx(2 * G, rel=1e-6)
    assert channel(found, "rod.position")[1] == pytest.approx(-0.2005 - depth, abs=1e-9)
    assert found.found.verdict == "stable" and found.found.freedoms == 3


def test_on_a_cam():
    """The place along a curve is no coordinate that could be held; the torque is m g dh/da."""
    found = at_rest(load(VALIDATION / "cam_roller.yaml"))
    assert found.found.verdict == "stable" and found.found.freedoms == 0
    column = next(c for c in found.mechanism.columns if c.name == "motor.force")
    # h = e sin a + sqrt((a + r)^2 - (e cos a)^2) at a = 0
    assert found.channels[column.start] == pytest.approx(0.5 * 9.81 * 0.015, abs=1e-9)


@pytest.mark.parametrize("planar", ["true", "false"])
def test_turns_are_those_since_the_drawing(planar):
    """Whatever axes the body was drawn with."""
    text = SPRUNG.format(planar=planar, bodies="[ground, rod]")
    found = rest(text.replace("at: [0.2, 0]}", "at: [0.2, 0], angle: 0.5}"))
    q = brentq(lambda x: sprung(x)[0], -1, 1)
    assert found.turns["rod"] == pytest.approx([0, 0, q], abs=1e-9)


@pytest.mark.parametrize("size", [0.01, 1.0, 100.0])
def test_the_nearest_balance_is_found_at_any_size(size):
    """Of many that a wave of force has, 2 cos(x/w): at x = pi/2 w, from where x is 0."""
    r = run(f"""
planar: true
bodies: {{block: {{mass: 1, inertia: 1e-4, at: [{size}, 0]}}}}
joints: {{slide: {{type: prismatic, bodies: [ground, block], at: [0, 0], axis: [1, 0, 0]}}}}
sensors: {{way: {{joint: slide}}}}
forces:
  wave: {{type: applied_load, body: block, direction: [1, 0], force: 2*cos(way/{0.05 * size})}}
initial: {{equilibrium: all}}
solver: {{end: 1e-6}}
""")
    assert r["way"][0] == pytest.approx(np.pi / 2 * 0.05 * size, rel=1e-6)
