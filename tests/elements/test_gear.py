"""Gears: they do not slip where they touch, torques of closed forms, and what is refused.

That they do not slip is looked at with the velocities of both wheels alone: their points in mesh
move alike, wherever the carrier is and however it turns.
"""

import numpy as np
import pytest

from trsim.errors import TrsimError
from trsim.solve.diagnose.doubts import doubts

from ..runs import built, energy_error, run
from ..trains import Train, numbers

X, Y, Z = np.eye(3)
BESIDE = (np.zeros(3), 0.3 * X)
# teeth, radii of two wheels in mesh and where they touch; apart: 0.3 m between their axes
EXTERNAL = "teeth: [20, 40]", "radii: [0.1, 0.2]", 0.1 * X
RING = "teeth: [20, 50], internal: true", "radii: [0.2, 0.5], internal: true", -0.2 * X
PINION = "teeth: [50, 20], internal: true", "radii: [0.5, 0.2], internal: true", 0.5 * X
# bevel gears whose axes meet in the origin, at 90 and at 60 degrees: from there to the wheels
RIGHT = (-0.1 * Z, 0.2 * X), np.array([0.2, 0.0, -0.1])
DIRECTION = np.array([np.sin(np.pi / 3), 0.0, np.cos(np.pi / 3)])


def sharp(first, second):
    """Where wheels of these teeth touch, on axes along z and DIRECTION."""
    out = np.cross(np.cross(Z, DIRECTION), Z)
    tangent = first * np.sin(np.pi / 3) / (second + first * np.cos(np.pi / 3))
    return Z + tangent * out / np.linalg.norm(out)


CASES = {
    "external": (Train(BESIDE, (Z, Z)), EXTERNAL[0], EXTERNAL[2]),
    "by radii": (Train(BESIDE, (Z, Z)), EXTERNAL[1], EXTERNAL[2]),
    "axes against each other": (Train(BESIDE, (Z, -Z)), EXTERNAL[0], EXTERNAL[2]),
    "in a ring": (Train(BESIDE, (Z, Z)), RING[0], RING[2]),
    "in a ring, by radii": (Train(BESIDE, (-Z, Z)), RING[1], RING[2]),
    "about a pinion": (Train(BESIDE, (Z, Z)), PINION[1], PINION[2]),
    "a wheel shifted along": (Train((0.1 * Z, 0.3 * X), (Z, Z)), EXTERNAL[1], EXTERNAL[2]),
    "far away": (
        Train(BESIDE, (Z, Z), place=np.array([300.0, -200.0, 80.0])), EXTERNAL[0], EXTERNAL[2],
    ),
    "turned against the drawing": (
        Train(BESIDE, (Z, Z), angles=(3.5, -2.9, 4.1)), EXTERNAL[0], EXTERNAL[2],
    ),
    "upright and turned": (
        Train(BESIDE, (Z, Z), turned=np.eye(3), spin=Z, angles=(3.5, -2.9, 4.1)),
        EXTERNAL[0], EXTERNAL[2],
    ),
    "carrier second": (Train(BESIDE, (Z, Z), second=(True, False)), EXTERNAL[0], EXTERNAL[2]),
    "carrier second, twice": (Train(BESIDE, (Z, Z), second=(True, True)), RING[0], RING[2]),
    "bevel": (Train(RIGHT[0], (Z, X)), "teeth: [20, 10]", RIGHT[1]),
    "bevel, other axis": (Train(RIGHT[0], (-Z, X)), "teeth: [20, 10]", RIGHT[1]),
    "bevel, other side": (
        Train((0.1 * Z, 0.2 * X), (Z, X)), "radii: [0.2, 0.1]", np.array([0.2, 0.0, 0.1]),
    ),
    "bevel, carrier second": (
        Train(RIGHT[0], (Z, X), second=(False, True)), "teeth: [20, 10]", RIGHT[1],
    ),
    "bevel at 60 degrees": (
        Train((0.2 * Z, 0.3 * DIRECTION), (Z, DIRECTION)), "teeth: [30, 17]", sharp(30, 17),
    ),
    "by ratio": (Train(BESIDE, (Z, Z)), "ratio: -2", EXTERNAL[2]),
    "by ratio, carrier second": (
        Train(BESIDE, (Z, Z), second=(True, False)), "ratio: 2", EXTERNAL[2],
    ),
    "bevel by ratio": (Train(RIGHT[0], (Z, X)), "ratio: 0.5", RIGHT[1]),
}  # fmt: skip


@pytest.mark.parametrize("case", CASES)
def test_wheels_do_not_slip(case):
    train, mesh, at = CASES[case]
    r = run(train.text(f"type: gear, joints: [first, other], {mesh}"))
    assert r.mechanism.mobility == 0 and not r.mechanism.planar
    assert np.ptp(r["x"]) > 1.0 and np.ptp(r["y"]) > 0.3
    far = np.abs(train.place).max()
    assert np.abs(train.slip(r, at)).max() < 1e-11 * max(1.0, far)
    assert energy_error(r) < 1e-6


@pytest.mark.parametrize("space", ["plane", "space"])
@pytest.mark.parametrize("method", ["dop853", "radau", "rk4"])
def test_ratio_over_many_turns(space, method):
    """After 50 turns too, and of wheels drawn at angles of more than half a turn.

    In space rows inside long steps are as near as the step is right, those of steps exact.
    """
    solver = {"rk4": "method: rk4, step: 2e-4"}.get(method, f"method: {method}, tolerance: 1e-9")
    inertia = "1" if space == "plane" else "[1, 1, 1]"
    axis = [0, 0, 1] if space == "plane" else [2, -1, 3]
    beside = [0.3, 0] if space == "plane" else numbers(0.3 * np.array([3, 0, -2]) / np.sqrt(13))
    r = run(f"""
bodies:
  one: {{mass: 1, inertia: {inertia}, at: [0, 0, 0], angle: 3.5}}
  two: {{mass: 1, inertia: {inertia}, at: {beside}, angle: -4.5}}
joints:
  first: {{type: revolute, bodies: [ground, one], at: [0, 0, 0], axis: {axis}}}
  other: {{type: revolute, bodies: [two, ground], at: {beside}, axis: {axis}}}
  mesh: {{type: gear, joints: [first, other], teeth: [17, 31]}}
forces: {{push: {{type: applied_load, body: one, direction: {axis}, torque: 100}}}}
sensors: {{x: {{joint: first}}, y: {{joint: other}}}}
solver: {{end: 3, {solver}}}
""")
    assert r.mechanism.planar == (space == "plane")
    assert r["x"][-1] > 80 * np.pi
    x, y = r["x"], r["y"]
    assert np.abs(y - 17 / 31 * x).max() < 1e-12 * x.max()
    # J of both, seen from the first:  x'' = T / (1 + (17/31)^2)
    acceleration = 100 / (1 + (17 / 31) ** 2)
    assert x == pytest.approx(acceleration * r.t**2 / 2, rel=1e-7, abs=1e-9)
    # the second body of the first joint is its wheel, that of the other one the ground
    assert r["mesh.torque_1"] == pytest.approx(acceleration - 100, rel=1e-9)
    assert r["mesh.torque_2"] == pytest.approx(-31 / 17 * (acceleration - 100), rel=1e-9)


CONE = """
planar: false
bodies:
  arm: {mass: 1, inertia: [0.1, 0.1, 0.1], at: [0, 0, 0]}
  planet: {mass: 2, inertia: [0.03, 0.02, 0.02], at: [0.3, 0, 0]}
joints:
  bearing: {type: revolute, bodies: [ground, arm], at: [0, 0, -0.1], axis: [0, 0, 1]}
  pin: {type: revolute, bodies: [arm, planet], at: [0.3, 0, 0], axis: [1, 0, 0]}
  teeth: {type: gear, joints: [bearing, pin], teeth: [60, 20]}
drives: {motor: {joint: bearing, velocity: 5}}
sensors: {a: {joint: bearing}, b: {joint: pin}}
solver: {end: 4, tolerance: 1e-9}
"""


def test_a_bevel_wheel_that_rolls_around_a_fixed_one():
    """A mill: the wheel turns at -3 Omega about its pin, which bears C w_2 Omega across both."""
    r = run(CONE)
    assert r.mechanism.mobility == 0
    assert r["b"] == pytest.approx(-3 * r["a"], abs=1e-11)
    assert r["a"][-1] == pytest.approx(20.0)
    around = np.stack([-np.sin(r["a"]), np.cos(r["a"]), 0 * r.t], axis=1)
    # L = ... + C w_2 e_r,  L' = C w_2 Omega (z x e_r)
    assert r["pin.reaction_moment"] == pytest.approx(0.03 * -15 * 5 * around, abs=1e-7)
    assert r["teeth.torque_2"] == pytest.approx(0.0, abs=1e-8)
    assert r["motor.force"] == pytest.approx(0.0, abs=1e-8)


def test_a_train_that_floats_keeps_its_momentum():
    """Nothing holds the carrier: angular momentum and energy stay, whatever the wheels do."""
    bevel = Train((-0.1 * Z, 0.2 * X), (Z, X))
    text = bevel.text("type: gear, joints: [first, other], teeth: [23, 11]", end=3.0)
    lines = [x for x in text.splitlines() if not x.startswith(("  bearing", "  turn", "  motor"))]
    thrown = "angle: 0.0, angular_velocity: [2, -3, 5], velocity: [0.1, 0.2, 0.3]}"
    text = "\n".join(lines).replace("drives:", "").replace("angle: 0.0}", thrown, 1)
    r = run(text.replace('"motor.*", "turn.*", ', ""))
    assert r.mechanism.mobility == 7
    inertia = np.array([[0.02, 0.001, 0.002], [0.001, 0.03, 0.003], [0.002, 0.003, 0.04]])
    total = 0.0
    for body in ("carrier", "one", "two"):
        R = r[f"{body}.rotation"].reshape(-1, 3, 3)
        spin = np.einsum("nij,jk,nlk,nl->ni", R, inertia, R, r[f"{body}.angular_velocity"])
        total = total + spin + np.cross(r[f"{body}.position"], r[f"{body}.velocity"])
    assert np.ptp(r["x"]) > 0.2
    assert total == pytest.approx(np.broadcast_to(total[0], total.shape), abs=1e-7)
    assert r["energy.kinetic"] == pytest.approx(r["energy.kinetic"][0], rel=1e-9)
    # the axes lead away from where they meet for the second wheel, and towards it for the first
    assert r["y"] == pytest.approx(23 / 11 * r["x"], abs=1e-8)


PLANETARY = """
bodies:
  arm: {mass: 1, inertia: 0.05, at: [0, 0]}
  sun: {mass: 1, inertia: 0.02, at: [0, 0]}
  ring: {mass: 3, inertia: 0.3, at: [0, 0]}
  p0: {mass: 0.5, inertia: 0.004, at: [0.21, 0]}
  p1: {mass: 0.5, inertia: 0.004, at: [-0.105, 0.18186533479473213]}
  p2: {mass: 0.5, inertia: 0.004, at: [-0.105, -0.18186533479473213]}
joints:
  bearing: {type: revolute, bodies: [ground, arm], at: [0, 0]}
  middle: {type: revolute, bodies: [arm, sun], at: [0, 0]}
  outer: {type: revolute, bodies: [ground, ring], at: [0, 0]}
  around: {type: revolute, bodies: [ring, arm], at: [0, 0]}
  pin0: {type: revolute, bodies: [arm, p0], at: [0.21, 0]}
  pin1: {type: revolute, bodies: [arm, p1], at: [-0.105, 0.18186533479473213]}
  pin2: {type: revolute, bodies: [arm, p2], at: [-0.105, -0.18186533479473213]}
  in0: {type: gear, joints: [middle, pin0], radii: [0.12, 0.09]}
  in1: {type: gear, joints: [middle, pin1], radii: [0.12, 0.09]}
  in2: {type: gear, joints: [middle, pin2], radii: [0.12, 0.09]}
  out0: {type: gear, joints: [around, pin0], radii: [0.3, 0.09], internal: true}
  out1: {type: gear, joints: [around, pin1], radii: [0.3, 0.09], internal: true}
  out2: {type: gear, joints: [around, pin2], radii: [0.3, 0.09], internal: true}
forces:
  push: {type: applied_load, body: sun, direction: [0, 0, 1], torque: 3*cos(4*t)}
  hold: {type: applied_load, body: ring, direction: [0, 0, 1], torque: -1 + t}
sensors: {c: {joint: bearing}, s: {joint: middle}, r: {joint: outer}, p: {joint: pin2}}
solver: {end: 3, tolerance: 1e-10}
"""


def test_three_planets_and_two_freedoms():
    """Willis: (w_s - w_c)/(w_r - w_c) = -z_r/z_s; two of the six rows of teeth are too many."""
    r = run(PLANETARY)
    assert r.mechanism.planar and r.mechanism.mobility == 2
    redundant = {name.split(".")[0] for name in r.mechanism.redundant}
    assert len(redundant & {f"{x}{k}" for x in ("in", "out") for k in range(3)}) == 2
    sun, carrier, ring = r["s.rate"] + r["c.rate"], r["c.rate"], r["r.rate"]
    assert np.abs(12 * (sun - carrier) + 30 * (ring - carrier)).max() < 1e-11
    assert np.abs(9 * r["p.rate"] + 12 * (sun - carrier)).max() < 1e-11
    # two freedoms, sun and carrier, from Lagrange's equations
    of = {"s": (1.0, 0.0), "c": (0.0, 1.0), "r": (-0.4, 1.4), "p": (-4 / 3, 4 / 3 + 1)}
    inertias = {"s": 0.02, "c": 0.05 + 3 * 0.5 * 0.21**2, "r": 0.3, "p": 3 * 0.004}
    M = sum(I * np.outer(of[x], of[x]) for x, I in inertias.items())
    Q = np.outer(of["s"], 3 * np.sin(4 * r.t) / 4) + np.outer(of["r"], -r.t + r.t**2 / 2)
    assert np.stack([sun, carrier]) == pytest.approx(np.linalg.solve(M, Q), abs=1e-7)
    assert energy_error(r) < 1e-8


def test_initial_values_count_turns():
    r = run(PLANETARY + "initial: {outer: 0, middle: 3 rev}\n", "solver.end=0.1")
    at = {x: r[x][0] for x in "csrp"}
    assert at["s"] == pytest.approx(6 * np.pi)
    assert at["r"] == pytest.approx(0.0, abs=1e-12)
    # against the carrier the ring goes back by -0.4 of what the sun goes on by
    assert at["c"] == pytest.approx(0.4 * 6 * np.pi)
    assert at["p"] == pytest.approx(-4 / 3 * 6 * np.pi)


AHEAD = """
bodies:
  one: {mass: 1, inertia: [1, 1, 1], at: [0, 0]}
  two: {mass: 1, inertia: [1, 1, 1], at: [0.3, 0]}
joints:
  first: {type: revolute, bodies: [ground, one], at: [0, 0]}
  other: {type: revolute, bodies: [ground, two], at: [0.3, 0]}
  mesh: {type: gear, joints: [first, other], teeth: [20, 30]}
drives: {motor: {joint: first, position: 20 + t}}
sensors: {x: {joint: first}, y: {joint: other}}
solver: {end: 0.2}
"""


def test_a_drive_that_begins_turns_ahead():
    """The other wheel is where the relation has it, not where whole turns would leave it."""
    r = run(AHEAD + "planar: true")
    assert r["x"] == pytest.approx(20 + r.t, abs=1e-10)
    assert r["y"] == pytest.approx(-2 / 3 * (20 + r.t), abs=1e-10)


def test_a_drive_that_begins_turns_ahead_in_space():
    """How many turns the other wheel has made nobody can see there: told, and done by `initial`."""
    with pytest.raises(TrsimError, match=r"mesh\.relation stays open"):
        run(AHEAD + "planar: false")
    text = AHEAD.replace("position: 20 + t", "velocity: 1") + "planar: false\ninitial: {first: 20}"
    r = run(text)
    assert r["x"] == pytest.approx(20 + r.t, abs=1e-10)
    assert r["y"] == pytest.approx(-2 / 3 * (20 + r.t), abs=1e-10)


def test_of_a_hinge_that_came_apart_in_space_it_holds_nothing():
    """And the run says so; in the plane turns go on to be counted."""
    text = AHEAD.replace(
        "drives: {motor: {joint: first, position: 20 + t}}",
        """
drives: {motor: {joint: first, velocity: 3}}
events: {off: {when: t, value: 0.1, do: {release: [other]}}, slow: {when: t, value: 0.15,
         do: {set: {motor: {velocity: 0}}}}}
""",
    )
    for planar, rate in (("true", 0.0), ("false", -2.0)):
        r = run(text + f"planar: {planar}")
        late = r.t > 0.15
        assert r["two.angular_velocity"][late] == pytest.approx(
            np.broadcast_to([0.0, 0.0, rate], (late.sum(), 3)), abs=1e-8
        )
        told = [w for w in doubts(r.scenario, r.mechanism, r.outcome) if "mesh" in w]
        assert len(told) == (planar == "false")
        assert not told or "joints.mesh: holds nothing once an event has released" in told[0]


def test_in_an_instance_that_is_turned():
    r = run("""
planar: false
templates:
  pair:
    bodies:
      one: {mass: 1, inertia: [1, 1, 1], at: [0, 0]}
      two: {mass: 1, inertia: [1, 1, 1], at: [0.3, 0]}
    joints:
      first: {type: cylindrical, bodies: [ground, one], at: [0, 0], axis: [0, 0, 1]}
      other: {type: revolute, bodies: [ground, two], at: [0.3, 0]}
      mesh: {type: gear, joints: [first.angle, other], radii: [10 cm, 20 cm]}
    sensors: {x: {joint: first.angle}, y: {joint: other}}
    drives: {motor: {joint: first.angle, velocity: 3}}
instances:
  a: {template: pair}
  b: {template: pair, frame: {at: [1, 2, 3], x_axis: [0, 1, 0], y_axis: [0, 0, 1]}}
solver: {end: 1}
""")
    for name in "ab":
        assert r[f"{name}_y"] == pytest.approx(-1.5 * r.t, abs=1e-11)


REFUSED = {
    "radii too large": (EXTERNAL[1], "radii: [0.1, 0.21]", ("radii",), "touch at 0.31"),
    "inside, not outside": (EXTERNAL[1], RING[1].split(",")[0] + ", 0.5]", ("radii",), "0.7"),
    "zero radius": (EXTERNAL[1], "radii: [0, 0.3]", ("radii", 0), "must be > 0"),
    "half a tooth": (EXTERNAL[1], "teeth: [20.5, 41]", ("teeth", 0), "whole number"),
    "nothing": (EXTERNAL[1], "internal: true", (), "got none"),
    "two of them": (EXTERNAL[1], "ratio: 2, teeth: [1, 2]", (), "got teeth and ratio"),
    "ratio of zero": (EXTERNAL[1], "ratio: 0", ("ratio",), "must not be zero"),
    "internal ratio": (EXTERNAL[1], "ratio: 2, internal: true", (), "has a sign"),
    "one joint twice": ("[first, other]", "[first, first]", ("joints",), "twice"),
    "no such joint": ("[first, other]", "[first, othr]", ("joints", 1), "no joint named"),
    "one joint": ("[first, other]", "[first]", ("joints",), ""),
    "a slide": ("[first, other]", "[first, slide]", ("joints", 1), "has a stroke, not an angle"),
    "a gear": ("[first, other]", "[first, mesh]", ("joints", 1), "has no coordinate"),
    "no carrier": ("[first, other]", "[first, far]", ("joints",), "share no carrier"),
    "same bodies": ("[first, other]", "[first, again]", ("joints",), "same two bodies"),
    "one axis": ("[first, other]", "[first, coaxial]", ("joints",), "turn about one axis"),
    "skew": ("[first, other]", "[first, skew]", ("joints",), "neither are parallel nor meet"),
    "apex": ("[first, other]", "[first, apex]", ("joints",), "drawn where the axes meet"),
    "both apex": ("[first, other]", "[first, corner]", ("joints",), "drawn where the axes meet"),
}
SCENE = """
planar: false
bodies:
  carrier: {mass: 1, inertia: [1, 1, 1]}
  one: {mass: 1, inertia: [1, 1, 1]}
  two: {mass: 1, inertia: [1, 1, 1], at: [0.3, 0, 0]}
  free: {mass: 1, inertia: [1, 1, 1]}
joints:
  first: {type: revolute, bodies: [carrier, one], at: [0, 0, 0]}
  other: {type: revolute, bodies: [carrier, two], at: [0.3, 0, 0]}
  again: {type: revolute, bodies: [one, carrier], at: [0, 0, 1]}
  slide: {type: prismatic, bodies: [carrier, two], axis: [1, 0, 0]}
  far: {type: revolute, bodies: [ground, free], at: [0, 0, 0]}
  coaxial: {type: revolute, bodies: [carrier, two], at: [0, 0, 1]}
  skew: {type: revolute, bodies: [carrier, two], at: [0.3, 0.1, 0], axis: [1, 0, 0]}
  apex: {type: revolute, bodies: [carrier, two], at: [0.3, 0, 0], axis: [1, 0, 0]}
  corner: {type: revolute, bodies: [carrier, two], at: [0, 0, 0], axis: [1, 0, 0]}
  mesh: {type: gear, joints: [first, other], radii: [0.1, 0.2]}
"""


@pytest.mark.parametrize("case", REFUSED)
def test_refused(case):
    old, new, path, words = REFUSED[case]
    with pytest.raises(TrsimError) as caught:
        built(SCENE.replace(old, new))
    problem = caught.value.problems[0]
    assert problem.path == ("joints", "mesh", *path)
    assert words in problem.what


BAR = """
bodies:
  one: {mass: 1, inertia: 0.02, at: [0, 0]}
  two: {mass: 1, inertia: 0.05, at: [0.4, 0]}
  arm: {type: ancf_cable, start: [0, 0], end: [0.4, 0], section: {diameter: 1 cm},
        youngs_modulus: 200 GPa, density: 7800}
joints:
  hold: {type: fixed, bodies: [ground, arm], at: [0, 0]}
  first: {type: revolute, bodies: [arm, one], at: [0, 0]}
  other: {type: revolute, bodies: [arm, two], at: [0.4, 0]}
  mesh: {type: gear, joints: [first, other], teeth: [1, 3]}
sensors: {x: {joint: first}, y: {joint: other}}
forces: {push: {type: applied_load, body: one, direction: [0, 0, 1], torque: sin(5*t)}}
solver: {end: 0.1, tolerance: 1e-6}
"""


def test_a_flexible_carrier_is_refused():
    with pytest.raises(TrsimError, match="different places of 'arm', a flexible bar"):
        built(BAR)


def test_a_coupler_on_a_flexible_bar():
    """Its row names two nodes of one bar, which meet in the mass of the bar."""
    r = run(BAR.replace("gear, joints: [first, other], teeth", "coupler, joints: [first, other], "
                        "coefficients"))  # fmt: skip
    assert np.abs(r["x"] + 3 * r["y"]).max() < 1e-12
    assert energy_error(r) < 1e-7


def test_other_drawings_are_taken_with_a_ratio():
    for joint in ("coaxial", "skew", "apex", "corner"):
        text = SCENE.replace("joints: [first, other], radii: [0.1, 0.2]",
                             f"joints: [first, {joint}], ratio: 2")  # fmt: skip
        assert "mesh.relation" in built(text).rows
