"""Universal joint: the law of a Cardan shaft, the moment in the cross, and what is refused."""

import numpy as np
import pytest

from trsim.assemble.release import release
from trsim.elements.prescribed import AnyDrive
from trsim.elements.rows import Axes
from trsim.errors import TrsimError

from ..runs import built, energy_error, run, scenario

BEND = np.pi / 6
C, S = np.cos(BEND), np.sin(BEND)
SHAFTS = f"""
planar: false
bodies:
  driver: {{mass: 1, inertia: [0.02, 0.01, 0.01], at: [-0.3, 0, 0], angular_velocity: [20, 0, 0]}}
  driven: {{mass: 1, inertia: [0.04, 0.04, 0.04], at: [{0.3 * C}, {0.3 * S}, 0]}}
joints:
  one: {{type: revolute, bodies: [ground, driver], at: [-0.5, 0, 0], axis: [1, 0, 0]}}
  two: {{type: revolute, bodies: [ground, driven], at: [{0.5 * C}, {0.5 * S}, 0],
        axis: [{C}, {S}, 0]}}
  cross: {{type: universal, bodies: [driver, driven], at: [0, 0, 0], axis: [0, 0, 2],
          second_axis: [{-S}, {C}, 0]}}
sensors: {{turn_in: {{joint: one}}, turn_out: {{joint: two}}}}
solver: {{end: 1, tolerance: 1e-11}}
output: {{every: 0.005}}
"""
MOTOR = "drives: {motor: {joint: one, velocity: 10}}\n"


def cardan(turn):
    """tan(out) = tan(in) cos(bend), unwrapped."""
    return np.unwrap(np.arctan2(C * np.sin(turn), np.cos(turn)))


@pytest.mark.parametrize("more", ["", MOTOR])
def test_cardan_shaft(more):
    r = run(SHAFTS + more)
    assert r["turn_in"][-1] > 5.0
    assert r["turn_out"] == pytest.approx(cardan(r["turn_in"]), abs=1e-8)
    assert energy_error(r) < 1e-9
    if not more:
        assert r["energy.kinetic"] == pytest.approx(r["energy.kinetic"][0], rel=1e-9)


def test_moment_is_along_the_normal_of_the_cross():
    """And it is what turns the driven shaft: I alpha = m . axis."""
    r = run(SHAFTS + MOTOR)
    turn, out = r["turn_in"], r["turn_out"]
    a = np.stack([0 * turn, -np.sin(turn), np.cos(turn)], axis=1)
    b = np.stack([-S * np.cos(out), C * np.cos(out), np.sin(out)], axis=1)
    m = r["cross.reaction_moment"]
    assert np.abs(m).max() > 0.1
    assert np.abs(np.cross(m, np.cross(a, b))).max() < 1e-9
    assert np.abs(np.sum(a * b, axis=1)).max() < 1e-9
    along = 0.04 * r["driven.angular_acceleration"] @ [C, S, 0.0]
    # the bearing of the driven shaft takes no moment about its axis
    assert m @ [C, S, 0.0] == pytest.approx(along, abs=1e-8)


def test_redundancy():
    """Two shafts in four bearings: closed with three rows too many, one of them in the cross."""
    m = built(SHAFTS)
    assert (m.mobility, m.mobility_by_count, len(m.redundant)) == (1, -2, 3)
    found = scenario(SHAFTS)
    assert release(found, m).proven


def test_isostatic_chain():
    """A four-bar in space, closed by a universal and a spherical joint: nothing is redundant."""
    m = built("""
bodies:
  crank: {mass: 1, inertia: [0.1, 0.1, 0.1], at: [0, 0.5]}
  coupler: {mass: 1, inertia: [0.1, 0.1, 0.1], at: [1, 1]}
  rocker: {mass: 1, inertia: [0.1, 0.1, 0.1], at: [2, 0.5]}
joints:
  A: {type: revolute, bodies: [ground, crank], at: [0, 0]}
  B: {type: spherical, bodies: [crank, coupler], at: [0, 1]}
  C: {type: universal, bodies: [coupler, rocker], at: [2, 1], axis: [0, 1, 0],
      second_axis: [0, 0, 1]}
  D: {type: revolute, bodies: [ground, rocker], at: [2, 0.3]}
planar: false
""")
    assert (m.mobility, m.mobility_by_count, m.redundant) == (1, 1, ())


PLANE = """
bodies: {{rod: {{mass: 1, inertia: 0.1, at: [0.3, 0]}}}}
joints: {{cross: {{type: universal, bodies: [ground, rod], at: [0, 0], axis: {}, second_axis: {}}}}}
gravity: [0, -9.81, 0]
solver: {{end: 1}}
"""


@pytest.mark.parametrize(
    "axis, second, mobility",
    [
        ("[0, 0, 1]", "[1, 0, 0]", 1),  # a hinge
        ("[1, 0, 0]", "[0, 1, 0]", 0),  # a weld
    ],
)
def test_in_the_plane(axis, second, mobility):
    m = built("planar: true" + PLANE.format(axis, second))
    assert m.planar and m.mobility == mobility


def test_an_oblique_cross_is_not_planar():
    text = PLANE.format("[0, 1, 1]", "[0, 1, -1]").replace("inertia: 0.1", "inertia: [1, 1, 1]")
    assert not built(text).planar
    with pytest.raises(TrsimError, match="leave the x-y plane"):
        built("planar: true" + text)


@pytest.mark.parametrize(
    "axis, second, key, words, hint",
    [
        ("[0, 0, 0]", "[1, 0, 0]", "axis", "must not be zero", "for example"),
        ("[1, 0, 0]", "[0, 0]", "second_axis", "must not be zero", "for example"),
        ("[1, 0, 0]", "[1e-5, 1, 0]", "second_axis", "cosine is 1e-05", "is [0, 1, 0]"),
        ("[1, 0, 0]", "[-3, 0, 0]", "second_axis", "cosine is -1", "across `axis`"),
    ],
)
def test_refused(axis, second, key, words, hint):
    with pytest.raises(TrsimError) as caught:
        built(PLANE.format(axis, second))
    assert caught.value.path == ("joints", "cross", key)
    assert words in caught.value.what and hint in caught.value.hint


def test_nearly_perpendicular_is_made_so():
    m = built(PLANE.format("[1, 0, 0]", "[1e-7, 1, 0]"))
    [joint] = [i for i in m.instances if i.name == "cross"]
    assert Axes.of(joint.row).u_j == (0.0, 1.0, 0.0)


# --- the angles of the cross ----------------------------------------------------------------------

ONE, TWO = "axis: [0, 0, 2]", f"second_axis: [{-S}, {C}, 0]"
ANGLES = """
sensors: {turn_in: {joint: one}, turn_out: {joint: two},
  first: {joint: cross.first_angle}, second: {joint: cross.second_angle}}
"""
BENT = SHAFTS.replace("sensors: {turn_in: {joint: one}, turn_out: {joint: two}}", ANGLES)
BENT = BENT.replace("every: 0.005", 'every: 0.005, channels: ["*"]')
BENT_BACK = BENT.replace("[driver, driven]", "[driven, driver]").replace(
    f"{ONE},", f"axis: [{-S}, {C}, 0],").replace(TWO, "second_axis: [0, 0, 2]")  # fmt: skip


def cross_angles(turn, rate):
    """Both angles, that of the driver's pin first, and their rates, for shafts drawn bent.

    Each pin swings out of the plane across the other shaft by no more than the bend."""
    out = cardan(turn)
    out_rate = rate * C / (np.cos(turn) ** 2 + C**2 * np.sin(turn) ** 2)
    angles = np.arcsin(S * np.cos(out)) - BEND, np.arcsin(S * np.sin(turn))
    return angles, (-S * np.sin(turn) * out_rate, S * np.cos(out) * rate)


@pytest.mark.parametrize("text", [BENT, BENT_BACK], ids=["driver first", "driven first"])
def test_angles_of_a_cardan_shaft(text):
    """The second body against the first: the other way round where the driven shaft is first."""
    r = run(text + MOTOR)
    assert r["turn_in"][-1] > 6.3
    names = ["first", "second"] if text is BENT else ["second", "first"]
    sign = 1.0 if text is BENT else -1.0
    angles, rates = cross_angles(r["turn_in"], 10.0)
    for name, angle, rate in zip(names, angles, rates, strict=True):
        assert sign * r[name] == pytest.approx(angle, abs=1e-8)
        assert sign * r[f"{name}.rate"] == pytest.approx(rate, abs=1e-7)
        slope = np.gradient(r[f"{name}.rate"], r.t)[1:-1]
        assert r[f"{name}.acceleration"][1:-1] == pytest.approx(slope, abs=0.1)


@pytest.mark.parametrize("text", [BENT, BENT_BACK], ids=["driver first", "driven first"])
def test_viscous_friction_in_the_cross(text):
    """What the motor gives is the energy the shafts gain and c (first'^2 + second'^2)."""
    c = (0.03, 0.05) if text is BENT else (0.05, 0.03)
    dampers = "".join(
        f"  {name}: {{type: torsion_spring, joint: cross.{name}, stiffness: 0, damping: {k}}}\n"
        for name, k in zip(("first_angle", "second_angle"), c, strict=True)
    )
    r = run(text + MOTOR + "forces:\n" + dampers)
    turn = r["turn_in"]
    _, (first, second) = cross_angles(turn, 10.0)
    lost = 0.03 * first**2 + 0.05 * second**2
    out_rate = 10.0 * C / (np.cos(turn) ** 2 + C**2 * np.sin(turn) ** 2)
    slope = C * 100 * np.sin(2 * turn) * S**2 / (np.cos(turn) ** 2 + C**2 * np.sin(turn) ** 2) ** 2
    assert r["motor.power"] == pytest.approx(lost + 0.04 * out_rate * slope, abs=1e-6)
    work = np.append(0.0, np.cumsum(np.diff(r.t) * (lost[1:] + lost[:-1]) / 2))
    assert r["energy.work.dampers"] == pytest.approx(-work, abs=2e-4 * work[-1])
    assert energy_error(r) < 1e-9


def pendulum(joint, forces, bodies="ground, rod", solver="tolerance: 1e-10", more=""):
    """A rod that swings in a plane about an axis along y, drawn at 0.4 rad from the vertical."""
    return f"""
planar: false
bodies:
  rod: {{mass: 2, inertia: [0.05, 0.06, 0.07], at: [{1 + 0.5 * np.sin(0.4)}, 2,
        {-0.5 * np.cos(0.4)}]}}
joints: {{pin: {{bodies: [{bodies}], at: [1, 2, 0], {joint}}}}}
forces: {{{forces}}}
gravity: [0, 0, -9.81]
solver: {{end: 1, {solver}}}
output: {{every: 0.01, channels: ["*"]}}
{more}"""


PINS = {
    "first": ("cross", "type: universal, axis: [0, 2, 0], second_axis: [1, 0, 1]"),
    "second": ("cross", "type: universal, axis: [3, 0, 0], second_axis: [0, -1, 0]"),
}
HINGE = "type: revolute, axis: [0, 1, 0]"
RUBS = ", radius: 30 mm, friction: {law: modified_coulomb, coefficient: 0.3, v0: 0, v1: 1 mm/s}"


@pytest.mark.parametrize("which", PINS)
@pytest.mark.parametrize("bodies", ["ground, rod", "rod, ground"])
def test_a_pin_rubs_like_a_hinge(which, bodies):
    """A pendulum that swings about one of the pins; the forces across it are the same."""
    wanted = run(pendulum(HINGE, "rub: {type: joint_friction, joint: pin" + RUBS + "}"))
    turned = {"first": "second", "second": "first"}[which] if bodies == "rod, ground" else which
    joint = PINS[which][1]
    if bodies == "rod, ground":  # its pins are those of the other body each
        joint = joint.replace("second_axis", "OTHER").replace("axis", "second_axis")
        joint = joint.replace("OTHER", "axis")
    rub = f"rub: {{type: joint_friction, joint: pin.{turned}_angle{RUBS}}}"
    r = run(pendulum(joint, rub, bodies))
    assert r["rod.position"] == pytest.approx(wanted["rod.position"], abs=1e-8)
    assert r["rub.normal_force"] == pytest.approx(wanted["rub.normal_force"], rel=1e-6)
    assert np.abs(r["rub.force"]) == pytest.approx(np.abs(wanted["rub.force"]), rel=1e-6)
    work = r["energy.work.friction"]
    assert work == pytest.approx(wanted["energy.work.friction"], abs=1e-7)
    assert work[-1] < -0.1
    assert energy_error(r) < 1e-8


def test_both_pins_rub_and_carry_the_moment_on_their_ends():
    """Of each pin |R/2 + M x a/l| + |R/2 - M x a/l|, from the reaction that is told."""
    rubs = "".join(
        f"  rub_{name}: {{type: joint_friction, joint: cross.{name}_angle, length: 80 mm{RUBS}}}\n"
        for name in ("first", "second")
    )
    text = BENT.replace("two: {type: revolute", "two: {type: inline").replace(
        "second: {joint: cross.second_angle}", ""
    )
    text = text.replace(", turn_out: {joint: two}", "")
    r = run(text + MOTOR + f"forces:\n{rubs}\ngravity: [0, 0, -9.81]\n")
    turn, out = r["turn_in"], cardan(r["turn_in"])
    pins = {
        "first": np.stack([0 * turn, -np.sin(turn), np.cos(turn)], 1),
        "second": np.stack([-S * np.cos(out), C * np.cos(out), np.sin(out)], 1),
    }
    R, M = r["cross.reaction"], r["cross.reaction_moment"]
    for (name, pin), rate in zip(pins.items(), cross_angles(turn, 10.0)[1], strict=True):
        half = (R - pin * np.sum(R * pin, 1, keepdims=True)) / 2
        tilt = np.cross(M, pin) / 0.08
        load = np.linalg.norm(half + tilt, axis=1) + np.linalg.norm(half - tilt, axis=1)
        assert r[f"rub_{name}.normal_force"] == pytest.approx(load, rel=1e-9, abs=1e-9)
        assert load.max() > 5.0
        assert r[f"rub_{name}.sliding_speed"] == pytest.approx(0.03 * rate, abs=1e-8)
        full = 0.03 * np.abs(rate) > 1.1e-3
        assert full.mean() > 0.9
        wanted = -np.sign(rate) * 0.3 * 0.03 * load
        assert r[f"rub_{name}.force"][full] == pytest.approx(wanted[full], rel=1e-9)
    assert energy_error(r) < 1e-6


SHAFT = "type: universal, axis: [0, 1, 0], second_axis: [1, 0, 0]"


@pytest.mark.parametrize(
    "forces, words",
    [
        ("rub: {type: joint_friction, joint: pin" + RUBS + "}", "each pin of 'pin' rubs by itself"),
        (
            ", ".join(
                f"r{k}: {{type: joint_friction, joint: pin.first_angle{RUBS}}}" for k in (1, 2)
            ),
            "'r1' is friction in 'pin' already",
        ),
        ("k: {type: torsion_spring, joint: pin, stiffness: 1}", "has several coordinates"),
        ("k: {type: torsion_spring, joint: pin.angle, stiffness: 1}", "has no angle"),
    ],
)
def test_one_pin_is_named(forces, words):
    with pytest.raises(TrsimError, match=words):
        built(pendulum(SHAFT, forces))


def test_a_wheel_turns_about_an_axis_of_its_carrier():
    """A gear on the pin of the other body, which leaves its place."""
    text = """
planar: false
bodies:
  arm: {mass: 1, inertia: [0.1, 0.1, 0.1], at: [0.5, 0, 0]}
  one: {mass: 1, inertia: [0.1, 0.1, 0.1], at: [1, 0, 0]}
  two: {mass: 1, inertia: [0.1, 0.1, 0.1], at: [1, 1, 0]}
joints:
  base: {type: revolute, bodies: [ground, arm], at: [0, 0, 0]}
  cross: {type: universal, bodies: [arm, one], at: [1, 0, 0], axis: [0, 0, 1],
          second_axis: [1, 0, 0]}
  pin: {type: revolute, bodies: [arm, two], at: [1, 1, 0], axis: AXIS}
  mesh: {type: gear, joints: [cross.NAME, pin], ratio: 2}
solver: {end: 0.1}
"""
    built(text.replace("AXIS", "[0, 0, 1]").replace("NAME", "first_angle"))
    with pytest.raises(TrsimError, match="does not turn with the carrier 'arm'"):
        built(text.replace("AXIS", "[1, 0, 0]").replace("NAME", "second_angle"))


@pytest.mark.parametrize("swapped", [False, True])
@pytest.mark.parametrize("flip", [1, -1])
def test_angles_in_the_plane(swapped, flip):
    """A hinge about z, drawn turned: as drawn it is at 0, as in space; -1.5 rad/s the right way."""
    axes = f"axis: [0, 0, {flip}], second_axis: [1, 0, 0]"
    own = "second" if swapped else "first"
    if swapped:
        axes = f"axis: [1, 0, 0], second_axis: [0, 0, {flip}]"
    for plane in ("true", "false"):
        r = run(f"""
planar: {plane}
bodies: {{rod: {{mass: 1, inertia: [0.1, 0.1, 0.1], at: [0.3, 0], angle: 0.7,
               velocity: [0, {-0.45 * flip}], angular_velocity: [0, 0, {-1.5 * flip}]}}}}
joints: {{cross: {{type: universal, bodies: [ground, rod], at: [0, 0], {axes}}}}}
sensors: {{x: {{joint: cross.{own}_angle}}}}
forces: {{stop: {{type: limit_stop, joint: cross.{own}_angle, lower: -9, stiffness: 1e3}}}}
solver: {{end: 1}}
output: {{every: 0.1, channels: ["*"]}}
""")
        assert r["x"] == pytest.approx(-1.5 * r.t, abs=1e-9)
        assert r["stop.penetration"] == pytest.approx(-9 + 1.5 * r.t, abs=1e-9)


@pytest.mark.parametrize("which", PINS)
def test_a_stop_tells_its_torque_on_the_second_body(which):
    """A rod that leans on a stop of one pin: it holds up the weight, about y."""
    joint = PINS[which][1].replace("[0, -1, 0]", "[0, 1, 0]")
    stop = f"stop: {{type: limit_stop, joint: pin.{which}_angle, upper: 0.001, stiffness: 1e5,"
    r = run(pendulum(joint, stop + " damping: 3000}").replace("end: 1,", "end: 3,"))
    assert r["pin.reaction"].shape[1] == 3
    lean = 0.4 - r["stop.penetration"][-1] - 0.001
    torque = 2 * 9.81 * 0.5 * np.sin(lean)
    assert r["stop.force"][-1] == pytest.approx([0, -torque, 0], abs=1e-3 * torque)


@pytest.mark.parametrize("name, inertia", [("first", 0.03 + 3 * 0.04), ("second", 0.05 + 3 * 0.05)])
@pytest.mark.parametrize("back", [False, True])
def test_a_damping_ratio_is_one_of_the_second_body(name, inertia, back):
    """About the pin that is driven: I + m d^2 of the second body at [0.1, -0.2, 0]."""
    order = "two, one" if back else "one, two"
    m = built(f"""
planar: false
bodies:
  one: {{mass: 7, inertia: [1, 2, 3], at: [1, 1, 1]}}
  two: {{mass: 3, inertia: [0.03, 0.04, 0.05], at: [0.1, -0.2, 0]}}
joints: {{cross: {{type: universal, bodies: [{order}], at: [0, 0, 0], axis: [1, 0, 0],
                second_axis: [0, 0, 1]}}}}
drives: {{d: {{joint: cross.{name}_angle, velocity: 1,
            compliance: {{stiffness: 50, damping_ratio: 0.5}}}}}}
solver: {{end: 1}}
""")
    if back:
        inertia = {"first": 1 + 7 * 2, "second": 3 + 7 * 2}[name]
    [drive] = [i for i in m.instances if i.name == "d"]
    assert AnyDrive.of(drive.row).damping == pytest.approx((50 * inertia) ** 0.5)
