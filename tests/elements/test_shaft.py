"""Shaft: what each bearing carries, against two joints that carry the same and against weights."""

import numpy as np
import pytest

from trsim.errors import TrsimError
from trsim.scenario.load import loads

from ..runs import built, energy_error, run

# an unbalanced rotor on a carrier that swings about another axis, pushed along and across
ROTOR = """
planar: false
bodies:
  arm: {{mass: 3, inertia: [0.2, 0.1, 0.2], at: [0.1, 0.2, -0.4], angular_velocity: [0.5, 2, 0]}}
  rotor: {{mass: 2, inertia: [0.012, 0.02, 0.03, 0.002, -0.001, 0.003], at: [0.31, 0.06, -0.22]}}
joints:
  swing: {{type: revolute, bodies: [ground, arm], at: [0, 0, 0], axis: [1, 4, 1]}}
{joints}
forces:
  along: {{type: applied_load, body: rotor, at: [0.3, 0.1, -0.2], frame: rotor,
          direction: [1, 2, 3], force: 12}}
gravity: [1, -2, -9.81]
initial: {{swing.rate: 3}}
solver: {{end: 0.6, tolerance: 1e-10}}
output: {{every: 0.02}}
"""
AT, FLOATING = [0.2, 0.1, -0.3], [0.5, 0.0, -0.1]
AXIS = np.subtract(FLOATING, AT)


def two_joints(bodies):
    return f"""
  near: {{type: spherical, bodies: {bodies}, at: {AT}}}
  far: {{type: inline, bodies: {bodies}, at: {FLOATING}, axis: {AXIS.tolist()}}}"""


def one(bodies, at=AT, floating=FLOATING):
    return f"""
  axle: {{type: shaft, bodies: {bodies}, at: {at}, floating: {floating}}}"""


@pytest.mark.parametrize("bodies", ["[arm, rotor]", "[rotor, arm]"])
def test_bearings_carry_what_a_ball_and_a_sleeve_do(bodies):
    r = run(ROTOR.format(joints=one(bodies)))
    both = run(ROTOR.format(joints=two_joints(bodies)))
    largest = np.abs(both["near.reaction"]).max()
    assert np.ptp(r["rotor.angular_velocity"], axis=0).max() > 1.0
    assert r["axle.locating_force"] == pytest.approx(both["near.reaction"], abs=1e-6 * largest)
    assert r["axle.floating_force"] == pytest.approx(both["far.reaction"], abs=1e-6 * largest)
    for name in ("locating", "floating"):
        sizes = np.linalg.norm(r[f"axle.{name}_force"], axis=1)
        assert r[f"axle.{name}_load"] == pytest.approx(sizes, rel=1e-12)
    together = r["axle.locating_force"] + r["axle.floating_force"]
    assert together == pytest.approx(r["axle.reaction"], abs=1e-9 * largest)
    assert energy_error(r) < 1e-8


def test_the_locating_bearing_alone_is_pushed_along_the_axis():
    way = AXIS / np.linalg.norm(AXIS)
    r = run(ROTOR.format(joints=one("[ground, rotor]")))
    along = r["axle.floating_force"] @ way
    assert np.abs(along).max() < 1e-9 * np.abs(r["axle.floating_force"]).max()
    turned = run(ROTOR.format(joints=one("[ground, rotor]", FLOATING, AT)))
    # turned round, each carries the same across the axis
    across = np.eye(3) - np.outer(way, way)
    assert turned["axle.locating_force"] @ across == pytest.approx(
        r["axle.floating_force"] @ across, abs=1e-6
    )
    assert turned["axle.locating_force"] @ way == pytest.approx(
        r["axle.locating_force"] @ way, abs=1e-6
    )


def test_a_weight_between_the_bearings_and_one_outside():
    """10 kg at a quarter of the span, and overhung by half of it."""
    for x, near, far in ((0.25, 0.75, 0.25), (1.5, -0.5, 1.5)):
        r = run(f"""
bodies: {{roll: {{mass: 10, inertia: [0.1, 0.1, 0.1], at: [{x}, 0, 0]}}}}
joints: {{axle: {{type: shaft, bodies: [ground, roll], at: [0, 0, 0], floating: [1, 0, 0]}}}}
gravity: [0, 0, -9.81]
solver: {{end: 0.01}}
""")
        assert r["axle.locating_force"][-1] == pytest.approx([0, 0, near * 98.1], abs=1e-9)
        assert r["axle.floating_force"][-1] == pytest.approx([0, 0, far * 98.1], abs=1e-9)


def test_its_angle_is_that_of_a_hinge():
    """It turns a gear, is driven, and is right-handed about the line to the floating bearing."""
    text = """
bodies:
  a: {mass: 1, inertia: [0.01, 0.01, 0.01], at: [0, 0, 0]}
  b: {mass: 1, inertia: [0.01, 0.01, 0.01], at: [0, 0.3, 0]}
joints:
  one: {type: shaft, bodies: [ground, a], at: [-0.1, 0, 0], floating: [0.1, 0, 0]}
  two: {type: shaft, bodies: [ground, b], at: [0.1, 0.3, 0], floating: [-0.1, 0.3, 0]}
  teeth: {type: gear, joints: [one, two], teeth: [20, 10]}
drives: {motor: {joint: one, velocity: 2}}
sensors: {x: {joint: one}, y: {joint: two}}
solver: {end: 1}
"""
    r = run(text)
    assert r["a.angular_velocity"][-1] == pytest.approx([2, 0, 0], abs=1e-9)
    assert r["b.angular_velocity"][-1] == pytest.approx([-4, 0, 0], abs=1e-9)
    assert r["y"][-1] == pytest.approx(4.0, abs=1e-9)  # about -x


def test_bearings_at_one_place_are_refused():
    text = ROTOR.format(joints=one("[arm, rotor]", AT, AT))
    with pytest.raises(TrsimError, match="both bearings are at one place"):
        built(loads(text))


SHAFT = """
bodies:
  arm: {mass: 3, inertia: [0.2, 0.1, 0.2], at: [0.1, 0.2, -0.4], angular_velocity: [0.5, 2, 0]}
PARTS
forces:
  along: {type: applied_load, body: BEYOND, at: [0.45, 0.1, -0.2], frame: BEYOND,
          direction: [1, 2, 3], force: 12}
gravity: [1, -2, -9.81]
initial: {swing.rate: 3}
solver: {end: 0.4, tolerance: 1e-10}
output: {every: 0.02}
"""
SWING = "swing: {type: revolute, bodies: [ground, arm], at: [0, 0, 0], axis: [1, 4, 1]}"
NEAR = "{mass: 2, inertia: [0.012, 0.02, 0.03], at: [0.26, 0.06, -0.22]}"
BEYOND = "{mass: 3, inertia: [0.011, 0.01, 0.02, 0.001, 0.002, -0.001], at: [0.44, 0.07, -0.1]}"


def together():
    """Both parts as one body."""
    masses, centres = np.array([2.0, 3.0]), np.array([[0.26, 0.06, -0.22], [0.44, 0.07, -0.1]])
    tensors = [
        np.diag([0.012, 0.02, 0.03]),
        np.array([[0.011, 0.001, 0.002], [0.001, 0.01, -0.001], [0.002, -0.001, 0.02]]),
    ]
    middle = masses @ centres / 5.0
    I = np.zeros((3, 3))
    for m, c, own in zip(masses, centres - middle, tensors, strict=True):
        I += own + m * (c @ c * np.eye(3) - np.outer(c, c))
    numbers = [I[0, 0], I[1, 1], I[2, 2], I[0, 1], I[0, 2], I[1, 2]]
    return f"{{mass: 5, inertia: {list(map(float, numbers))}, at: {middle.tolist()}}}"


@pytest.mark.parametrize("beyond", ["", ", beyond: [axle, along]"])
def test_a_section_between_the_bearings_is_that_of_the_split_shaft(beyond):
    """The rotor cut at a bolt hole between its bearings, and the two halves welded there."""
    station, way = [0.35, 0.05, -0.2], AXIS.tolist()
    split = run(SHAFT.replace("PARTS", f"""
  a: {NEAR}
  b: {BEYOND}
joints:
  {SWING}
  near: {{type: spherical, bodies: [arm, a], at: {AT}}}
  far: {{type: inline, bodies: [arm, b], at: {FLOATING}, axis: {way}}}
  bolt: {{type: fixed, bodies: [a, b], at: {station}}}
""").replace("BEYOND", "b"))  # fmt: skip
    whole = run(SHAFT.replace("PARTS", f"""
  rotor: {together()}
joints:
  {SWING}
  axle: {{type: shaft, bodies: [arm, rotor], at: {AT}, floating: {FLOATING}}}
sensors:
  cut: {{type: section, body: rotor, at: {station}, axis: {way}, mass: 3,
        centre: [0.44, 0.07, -0.1], inertia: [0.011, 0.01, 0.02, 0.001, 0.002, -0.001]{beyond}}}
""").replace("BEYOND", "rotor"))  # fmt: skip
    for ours, theirs in (("force", "reaction"), ("moment", "reaction_moment")):
        size = np.linalg.norm(split[f"bolt.{theirs}"], axis=1)
        assert np.ptp(size) > 0.1
        found = np.linalg.norm(whole[f"cut.{ours}"], axis=1)
        assert found == pytest.approx(size, abs=1e-6 * size.max())
    # across the axis of the shaft, in axes that turn with it
    assert np.ptp(whole["cut.bending"]) > 0.1


@pytest.mark.parametrize(("x", "way"), [(1, 1), (1, -1), (0, 1), (0, -1)])
def test_a_listed_shaft_has_beyond_a_section_at_a_bearing_only_that_one(x, way):
    """10 kg at a quarter of the span: a section at either bearing, which is listed as beyond."""
    beyond = 10 if way * (0.25 - x) > 0 else 0
    mass = "10 kg, centre: [0.25, 0, 0], inertia: [0.1, 0.1, 0.1]" if beyond else "0"
    r = run(f"""
bodies: {{roll: {{mass: 10, inertia: [0.1, 0.1, 0.1], at: [0.25, 0, 0]}}}}
joints: {{axle: {{type: shaft, bodies: [ground, roll], at: [0, 0, 0], floating: [1, 0, 0]}}}}
sensors: {{cut: {{type: section, body: roll, at: [{x}, 0, 0], axis: [{way}, 0, 0], mass: {mass},
                beyond: [axle]}}}}
gravity: [0, 0, -9.81]
solver: {{end: 0.01}}
""")
    # with the roll beyond it both bearings are
    carried = 0.0 if beyond else (0.25 if x == 1 else 0.75) * 98.1
    assert r["cut.shear"][-1] == pytest.approx(carried, abs=1e-8)
    assert r["cut.bending"][-1] == pytest.approx(0.0, abs=1e-8)


def test_friction_is_that_of_both_bearings():
    """A roll overhung by half the span coasts: its bearings carry 0.5 and 1.5 of its weight, both
    ways, and brake it together: I alpha = mu r (|F_1| + |F_2|)."""
    text = """
bodies: {roll: {mass: 10, inertia: [0.1, 0.1, 0.1], at: [1.5, 0, 0], angular_velocity: [60, 0, 0]}}
joints: {axle: {type: shaft, bodies: [ground, roll], at: [0, 0, 0], floating: [1, 0, 0]}}
forces:
  rub: {type: joint_friction, joint: axle, radius: 20 mm,
        friction: {law: modified_coulomb, coefficient: 0.1, v0: 0, v1: 1 mm/s}MORE}
sensors: {x: {joint: axle}}
gravity: [3, 0, -9.81]
solver: {end: 1, tolerance: 1e-9}
"""
    r = run(text.replace("MORE", ""))
    assert r["rub.normal_force"][-1] == pytest.approx(2 * 98.1, rel=1e-9)
    assert r["x.rate"][-1] == pytest.approx(60 - 0.1 * 0.02 * 2 * 98.1 / 0.1, rel=1e-9)
    collar = run(text.replace("MORE", ", thrust_radius: 30 mm"))
    assert collar["rub.normal_force"][-1] == pytest.approx(2 * 98.1 + 30 * 30 / 20, rel=1e-9)
    with pytest.raises(TrsimError, match="a shaft has no `length`"):
        built(loads(text.replace("MORE", ", length: 1")))


@pytest.mark.parametrize(("span", "out"), [(0.05, 25.0), (0.01, 25.0), (1e-6, 0.25), (1e3, 0.1)])
def test_bearings_that_are_near_or_far(span, out):
    """A weight overhung by far more than the distance of the bearings: its lever over theirs."""
    r = run(f"""
bodies: {{boom: {{mass: 10, inertia: [3, 3, 3], at: [{span + out}, 0, 0]}}}}
joints: {{axle: {{type: shaft, bodies: [ground, boom], at: [0, 0, 0], floating: [{span}, 0, 0]}}}}
gravity: [0, 0, -9.81]
solver: {{end: 0.01}}
""")
    far = 98.1 * (span + out) / span
    assert r["axle.floating_force"][-1] == pytest.approx([0, 0, far], rel=1e-9, abs=1e-9 * far)
    assert r["axle.locating_force"][-1, 2] == pytest.approx(98.1 - far, abs=1e-9 * far)


def test_what_is_said_to_be_the_least_of_a_channel_is_met():
    """Without loads the bearings carry nothing; extremes below the least are not looked for."""
    r = run(ROTOR.format(joints=one("[arm, rotor]")).replace("force: 12", "force: 0")
            .replace("gravity: [1, -2, -9.81]", "gravity: [0, 0, 0]")
            .replace("angular_velocity: [0.5, 2, 0]", "angular_velocity: [0, 0, 0]")
            .replace("swing.rate: 3", "swing.rate: 0"), "solver.end=0.01")  # fmt: skip
    for c in r.mechanism.columns:
        if c.name.startswith("axle."):
            assert np.all(r[c.name] >= c.least), c.name
