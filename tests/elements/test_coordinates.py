"""Whatever acts along a coordinate acts along every one: of each joint, either body first.

A body hangs on the ground, turned, away from the origin, by a joint about a slanted axis, its
weight somewhere, and moves.  It is driven, locked, released, stopped, pulled by a spring and rubs.
"""

import numpy as np
import pytest

from trsim import elements
from trsim.errors import TrsimError

from ..comparing import approx
from ..runs import built, energy_error, run

AXIS, AT = np.array([0.48, 0.6, 0.64]), [0.2, 0.1, -0.3]
JOINTS = {
    word: there
    for word, section in elements.ELEMENTS.items()
    if section == "joints" and (there := elements.load(word)).coordinates
}
KEYS = {
    "second_axis": "[0.6, -0.48, 0]",
    "x_axis": "[0.8, -0.1, 0.3]",
    "pitch": "0.4",
    "floating": str((AT + 0.4 * AXIS).tolist()),
    "clearance": "0",
    "contact": "law",
}
LAW = """
contact_laws: {law: {normal: hunt_crossley, stiffness: 1e6, bearing_radius: 0.2, restitution: 0.9}}
"""
CASES = [
    (word, coordinate, swapped)
    for word, joint in JOINTS.items()
    for coordinate in joint.coordinates
    if coordinate != "arc"  # of a curve: test_point_on_curve
    for swapped in (False, True)
]
RATE = 1.5


def turns(coordinate):
    return coordinate.endswith("angle")


def scene(case, more, end=0.5, rate=RATE):
    """A body on a joint of which one coordinate moves at a rate."""
    word, coordinate, swapped = case
    fields = JOINTS[word].spec.model_fields
    keys = KEYS | {"axis": AXIS.tolist()}
    own = ", ".join(f"{key}: {value}" for key, value in keys.items() if key in fields)
    kind = JOINTS[word].ideal or word
    pair = "body, ground" if swapped else "ground, body"
    of = f"joint.{coordinate}"
    return f"""
planar: false
bodies:
  body: {{mass: 2, inertia: [0.05, 0.06, 0.07, 0.01, 0.002, -0.003], at: [0.3, 0.2, -0.1],
         angle: 0.7}}
joints:
  joint: {{type: {kind}, bodies: [{pair}], at: {AT}, {own}}}
initial: {{{of}.rate: {rate}}}
sensors: {{x: {{joint: {of}}}}}
gravity: [1, -3, 2]
solver: {{end: {end}, tolerance: 1e-8}}
output: {{every: 0.005, channels: ["*"]}}
{LAW if JOINTS[word].ideal else ""}
{more.replace("OF", of)}
"""


def of_unit(case, angle, stroke):
    return angle if turns(case[1]) else stroke


@pytest.mark.parametrize("case", CASES)
def test_it_is_driven(case):
    r = run(scene(case, "drives: {d: {joint: OF, velocity: 1.5*cos(9*t)}}"))
    x = r["x"]
    assert x == approx(x[0] + 1.5 / 9 * np.sin(9 * r.t), abs=1e-7)
    assert r["d.position"] == approx(x, abs=1e-7)
    assert np.abs(r["d.force"]).max() > 0.1
    assert energy_error(r) < 1e-6


@pytest.mark.parametrize("case", CASES)
def test_it_is_pulled_through_a_compliance(case):
    unit = of_unit(case, "N*m/rad", "N/m")
    more = f"drives: {{d: {{joint: OF, velocity: 0.5, compliance: {{stiffness: 200 {unit}}}}}}}"
    r = run(scene(case, more))
    assert r["d.force"] == approx(-200 * (r["x"] - r["x"][0] - 0.5 * r.t), abs=1e-6)
    assert energy_error(r) < 1e-6


@pytest.mark.parametrize("case", CASES)
def test_it_is_locked_and_let_go(case):
    more = """
events:
  hold: {when: t, value: 0.2, do: {lock: [OF]}}
  free: {when: t, value: 0.4, do: {unlock: [OF]}}
"""
    r = run(scene(case, more))
    held = (r.t > 0.2) & (r.t < 0.4)
    assert r["x"][held] == approx(r["x"][held][0], abs=1e-8)
    assert r["x.rate"][held] == approx(0, abs=1e-7)
    several = len(JOINTS[case[0]].coordinates) > 1
    force = r[f"joint.{case[1]}.lock.force" if several else "joint.lock.force"]
    # of planes and what flies its weight turns nothing
    if case[:2] not in (("planar", "angle"), ("parallel", "angle")):
        assert np.abs(force[held]).min() > 1e-3
        assert abs(r["x"][-1] - r["x"][held][0]) > 1e-4
    assert energy_error(r) < 1e-6


@pytest.mark.parametrize("case", CASES)
def test_its_joint_is_released(case):
    r = run(scene(case, "events: {off: {when: t, value: 0.2, do: {release: [joint]}}}"))
    free = r.t > 0.2
    assert r["joint.reaction"][free] == approx(0, abs=0)
    weight = np.array([1.0, -3.0, 2.0])
    assert r["body.acceleration"][free] == approx(weight + 0 * r["body.velocity"][free])
    held = "reaction_moment" if case[0] == "parallel" else "reaction"
    if case[:2] != ("parallel", "stroke"):  # which holds nothing here, as nothing turns
        assert np.abs(r[f"joint.{held}"][~free]).max() > 1e-3


@pytest.mark.parametrize("case", CASES)
def test_it_meets_a_stop(case):
    stiffness, ramp = of_unit(case, ("2e4 N*m/rad", "1e-4 rad"), ("2e5 N/m", "0.1 mm"))
    found = run(scene(case, "", end=0.02))["x"]
    upper = float(found[0]) + RATE * 0.1
    more = f"""
forces: {{stop: {{type: limit_stop, joint: OF, upper: {upper!r}, stiffness: {stiffness},
         ramp: {ramp}}}}}
drives: {{push: {{joint: OF, velocity: 1.5, compliance: {{stiffness: 500}}}}}}
"""
    r = run(scene(case, more))
    assert upper - 0.01 < r["x"].max() < upper + 0.04
    assert r["stop.normal_force"].max() > 1.0
    assert r["stop.penetration"] == approx(r["x"] - upper, abs=1e-9)
    assert energy_error(r) < 1e-5


@pytest.mark.parametrize("case", CASES)
def test_a_spring_and_a_damper(case):
    k, c, preload = of_unit(case, ("9 N*m/rad", "0.3 N*m*s/rad", "2 N*m"),
                            ("90 N/m", "3 N*s/m", "2 N"))  # fmt: skip
    number = float(k.split()[0])
    more = f"""
forces: {{s: {{type: torsion_spring, joint: OF, stiffness: {k}, damping: {c}, preload: {preload}}}}}
"""
    r = run(scene(case, more))
    channel = r[of_unit(case, "s.torque", "s.force")]
    damping = float(c.split()[0])
    wanted = 2 - number * (r["x"] - r["x"][0]) - damping * r["x.rate"]
    assert channel == approx(wanted, abs=1e-9)
    assert r["energy.work.dampers"][-1] < -1e-3
    assert energy_error(r) < 1e-6


@pytest.mark.parametrize("case", [c for c in CASES if not JOINTS[c[0]].ideal])
@pytest.mark.parametrize("law", ["modified_coulomb", "sticking"])
def test_friction(case, law):
    numbers = {
        "modified_coulomb": "law: modified_coulomb, v0: 0, v1: 1e-3",
        "sticking": "law: sticking, stribeck_speed: 1e-3, bristle_stiffness: 1e5,"
        " bristle_damping: 300",
    }[law]
    thread = case[0] == "screw"
    sizes = "radius: 50 mm, " if turns(case[1]) or thread else ""
    if case[0] == "parallel":  # its moment is all that presses
        sizes += of_unit(case, "length: 2 mm, ", "length: 0.5, ")
    else:
        sizes += "thrust_radius: 30 mm, " if turns(case[1]) and not thread else ""
    constant = of_unit(case, "0.1 N*m", "1 N")
    more = f"""
forces: {{f: {{type: joint_friction, joint: OF, {sizes}constant: {constant},
         friction: {{{numbers}, coefficient: 0.1}}}}}}
"""
    r = run(scene(case, more))
    force, speed, load = r["f.force"], r["f.sliding_speed"], r["f.normal_force"]
    moves = np.abs(r["x.rate"]) > 1e-2
    gear = (speed[moves] / r["x.rate"][moves])[0]
    full = (np.abs(speed) > 0.01) & (r.t > 0.03)
    wanted = -np.sign(speed) * (0.1 * load * gear + np.sign(gear) * float(constant.split()[0]))
    assert full.sum() > 10 and load.max() > 0.01
    assert force[full] == approx(wanted[full], rel=1e-6 if law == "sticking" else 1e-9)
    assert r["energy.work.friction"][-1] < -1e-3
    assert energy_error(r) < 1e-5


@pytest.mark.parametrize("case", [case for case in CASES if not case[2]])
def test_it_begins_where_it_is_told_in_its_own_unit(case):
    value = of_unit(case, "20 deg", "30 mm")
    text = scene(case, "").replace(".rate: 1.5}", f": {value}}}").replace("end: 0.5", "end: 0.01")
    r = run(text)
    assert r["x"][0] == approx(of_unit(case, np.deg2rad(20), 0.03), abs=1e-9)
    with pytest.raises(TrsimError, match="unit") as caught:
        built(text.replace(value, of_unit(case, "30 mm", "20 deg")))
    assert caught.value.path[0] == "initial"
