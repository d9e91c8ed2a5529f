"""Every constraint: J, Phi_t and gamma are the derivatives of Phi, checked by differences.

    Phi' = J V + Phi_t     along any motion,        J V' = gamma

At constant twists V' = 0, so gamma is minus the rate of J V + Phi_t.  And the rows are forces: what
they put on the bodies and the ground adds up to no force and no moment.
"""

from itertools import pairwise

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from trsim import elements
from trsim.elements.rows import ARC

from .bench import THIRD, TWO_BODIES, bench, check_action_is_reaction, now, put_right

AXIS, PLACE = np.array([0.48, 0.6, 0.64]), np.array([0.2, 0.1, 0.0])
# of the keys a joint has
KEYS = {
    "at": "[0.2, 0.1, 0]",
    "axis": "[0.48, 0.6, 0.64]",
    "second_axis": "[0.6, -0.48, 0]",
    "x_axis": "[0.8, -0.1, 0.3]",
    "floating": "[0.44, 0.4, 0.32]",
    "pitch": "0.7",
    "points": "[[0.2, 0.1, 0], [0.5, -0.3, 0.4]]",
    "clearance": "0.03",
    "contact": "law",
}
# where a joint must be drawn another way
OTHERS = {"constant_velocity": {"second_axis": "[0.8, -0.1, 0.3]"}}
# curves in a plane of the left body, at PLACE or beside it, and what is held on them
PLANE = "x_axis: [0.6, -0.48, 0], y_axis: [0.1, 0.3, -0.4]"
AROUND = f"at: [0.2, 0.1, 0], {PLANE}, closed: true, points: " + str(
    [[0, 0], [0.9, 0.3], [1.3, 1.2], [0.4, 1.6], [-0.5, 0.8]]
)
EGG = (
    f"at: [0.2, 0.1, 0], {PLANE}, closed: true, range: [0, 2*pi], "
    "x: 0.9 - 0.9*cos(s), y: 0.5*sin(s) + 0.06*sin(2*s)"
)
BOW = f"at: [0.2, 0.1, 0], {PLANE}, range: [-0.8, 0.9], x: s + 0.2*s**2, y: 0.4*s**2 + 0.1*s**3"
ROLLER = "radius: 0.1, at: [0.2, 0.1, 0]"
CURVED = {
    "point_on_curve": f"at: [0.2, 0.1, 0], curve: {{{AROUND}}}",
    "point_on_curve, by a formula": f"at: [0.2, 0.1, 0], curve: {{{EGG}}}",
    "point_on_curve, open": f"at: [0.2, 0.1, 0], curve: {{{BOW}}}",
    "cam": f"{ROLLER}, curve: {{{AROUND.replace('[0.2, 0.1, 0]', '[0.3, 0, 0.1]')}}}",
    "cam, inside": f"{ROLLER}, curve: {{{EGG.replace('[0.2, 0.1, 0]', '[0.1, 0.2, -0.1]')}}}",
    "cam, face": f"face: [-0.6, 0.48, 0], at: [0.2, 0.1, 0], curve: {{{EGG}}}",
}
ALL = {word: elements.load(word) for word, of in elements.ELEMENTS.items() if of == "joints"}
JOINTS = {word: joint for word, joint in ALL.items() if "bodies" in joint.spec.model_fields}
LAW = """
contact_laws: {law: {normal: hunt_crossley, stiffness: 1e6, bearing_radius: 0.2, restitution: 0.9}}
"""
DRIVES = {
    "position": "position: 0.2 + 0.5*sin(3*t)",
    "velocity": "velocity: 2*cos(3*t) + t**2",
    "table": "velocity: {table: [[0, 1], [0.2, 2], [0.5, 1], [1, 0]]}",
    "constant": "velocity: 0.7",
}
# between bodies on the left one: about AXIS at PLACE, and about or along SECOND elsewhere
SECOND, AWAY = np.array([0.6, 0.0, -0.8]), np.array([-0.4, 0.3, 0.5])
HINGE, SLEEVE = (
    f"one: {{type: {word}, bodies: [left, right], at: {PLACE.tolist()}, axis: {AXIS.tolist()}}}"
    for word in ("revolute", "cylindrical")
)
OTHER, BACK = (
    f"two: {{type: revolute, bodies: [{pair}], at: {AWAY.tolist()}, axis: {SECOND.tolist()}}}"
    for pair in ("left, third", "third, left")
)
PARALLEL, LINE = (
    f"two: {{type: {word}, bodies: [left, third], at: {AWAY.tolist()}, axis: {axis.tolist()}}}"
    for word, axis in (("revolute", AXIS), ("inline", SECOND))
)
MESH = {  # joints of which a transmission relates coordinates, what it is, axis of the third body
    "gear": (HINGE, PARALLEL, "teeth: [20, 31]", AXIS),
    "gear, crossed": (HINGE, OTHER, "ratio: -2.5", SECOND),
    "gear, carrier second": (HINGE, BACK, "ratio: 0.7", SECOND),
    "worm": (HINGE, OTHER, "teeth: [2, 31], hand: left", SECOND),
    "rack_and_pinion": (HINGE, LINE, "ratio: -0.3", None),
    "coupler": (HINGE, LINE, "coefficients: [0.4, -1.3]", None),
    "coupler, three": (SLEEVE, OTHER, "coefficients: [0.4, 0.7, -0.2]", SECOND),
    "belt": (HINGE, PARALLEL, "radii: [0.1, 0.23]", AXIS),
    "belt, crossed": (HINGE, PARALLEL, "radii: [0.1, 0.23], crossed: true", AXIS),
}
ROPES = {  # bodies, and a place on each; wheels are those of a plane: test_rope.py
    "rope": ("left", "third", "right"),
    "rope, to and fro": ("ground", "right", "left", "right", "ground"),
}
SPREAD_OUT = [[0.2, 0.1, 0], [-0.4, 0.3, 0.5], [0.9, -0.3, 0.2], [0.1, 0.8, -0.4], [1, 1, 1]]
CASES = {name: (name, "", "") for name in JOINTS if name not in CURVED} | {
    name: (name, "", "") for name in CURVED
}
CASES |= {name: (name, "", "") for name in [*MESH, *ROPES]}
CASES |= {
    f"{d} of {j}'s {x}": (j, d, x)
    for j, joint in JOINTS.items() if not joint.ideal for x in joint.coordinates for d in DRIVES
    if x != ARC
}  # fmt: skip


def written(word):
    """A joint of a type, with the keys that it has."""
    if word in CURVED:
        return f"type: {word.split(',')[0]}, {CURVED[word]}"
    fields = JOINTS[word].spec.model_fields
    keys = KEYS | OTHERS.get(word, {})
    own = ", ".join(f"{key}: {value}" for key, value in keys.items() if key in fields)
    return f"type: {JOINTS[word].ideal or word}, {own}"


def meshing(case, rng):
    """A transmission between three bodies, in a random pose that their hinges allow."""
    one, two, how, axis = MESH[case]
    names = "one, two" if "cylindrical" not in one else "one.angle, two, one.stroke"
    text = (
        f"joints: {{{one}, {two}, mesh: {{type: {case.split(',')[0]}, joints: [{names}], {how}}}}}"
    )
    b = bench(text, rng, TWO_BODIES + THIRD[1:])
    shift = rng.normal() * AXIS if "cylindrical" in one else np.zeros(3)
    put_right(b, PLACE, rng.uniform(-2, 2) * AXIS, shift)
    b.V[2, 3:] = b.V[1, 3:] + rng.normal() * now(b, AXIS)
    if axis is not None:
        put_right(b, AWAY, rng.uniform(-2, 2) * axis, np.zeros(3), "third")
        b.V[3, 3:] = b.V[1, 3:] + rng.normal() * now(b, axis)
    assert "mesh.relation" in b.mechanism.rows
    return b


def thrown(case, seed):
    """The joint in a random pose; with a turning drive in one that the joint allows."""
    joint, drive, coordinate = CASES[case]
    rng = np.random.default_rng(seed)
    if case in MESH:
        return meshing(case, rng)
    if case in ROPES:
        places = zip(ROPES[case], SPREAD_OUT, strict=False)
        through = ", ".join(f"{{body: {body}, at: {at}}}" for body, at in places)
        text = f"joints: {{line: {{type: rope, through: [{through}]}}}}"
        return bench(text, rng, TWO_BODIES + THIRD[1:])
    text = f"joints: {{joint: {{bodies: [left, right], {written(joint)}}}}}\n"
    kind = joint.split(",")[0]
    text += LAW if JOINTS[kind].ideal else ""
    of = f"joint.{coordinate}"
    text += f"drives: {{drive: {{joint: {of}, {DRIVES[drive]}}}}}\n" if drive else ""
    b = bench(text, rng)
    assert b.mechanism.model.m == len(JOINTS[kind].rows) + bool(drive)
    counted = "lead" in JOINTS[kind].rows
    if coordinate in ("first_angle", "second_angle"):
        crossed(b, rng)
    elif coordinate == "angle" or counted:
        # an angle is one only while the axes are parallel, and its rate while they stay so
        put_right(b, PLACE, rng.uniform(-2, 2) * AXIS, np.zeros(3))
        if not counted:
            b.V[2, 3:] = b.V[1, 3:] + rng.normal() * now(b, AXIS)
    return b


def crossed(b, rng):
    """Right turned about both pins of a cross, the first on left, and turning about these."""
    pin = np.array([0.6, -0.48, 0.0]) / np.hypot(0.6, 0.48)
    first = Rotation.from_rotvec(rng.uniform(-2, 2) * AXIS)
    both = first * Rotation.from_rotvec(rng.uniform(-2, 2) * pin)
    put_right(b, PLACE, both.as_rotvec(), np.zeros(3))
    b.V[2, 3:] = b.V[1, 3:] + rng.normal() * now(b, AXIS) + rng.normal() * now(b, first.apply(pin))


def jacobian(w):
    """J of all frames, row by row."""
    J = np.zeros((w.m, w.n, 6))
    for k, (a, b) in enumerate(pairwise(w.row_start)):
        for line in range(a, b):
            J[k, w.line_frame[line]] += w.J[line]
    return J


def test_every_joint_has_a_case():
    assert {case.split(",")[0] for case in CASES if " of " not in case} == {*ALL}


@pytest.mark.parametrize("case", CASES)
@pytest.mark.parametrize("seed", range(3))
def test_derivatives(case, seed):
    b, h = thrown(case, seed), 1e-5
    w, ahead, behind = b.rows(), b.later(h).rows(), b.later(-h).rows()
    phi_dot, later, before = (np.tensordot(jacobian(s), b.V) + s.phi_t for s in (w, ahead, behind))
    assert phi_dot == pytest.approx((ahead.phi - behind.phi) / (2 * h), abs=1e-7)
    assert w.gamma == pytest.approx(-(later - before) / (2 * h), abs=1e-7)


@pytest.mark.parametrize("case", CASES)
def test_gamma_is_that_of_any_twists(case):
    """Also where an axis turns that bodies do not turn about alone: J V' = gamma keeps J V."""
    b, h = thrown(case, 5), 1e-5
    b.V[1:] = np.random.default_rng(5).normal(size=b.V[1:].shape)
    later, before = (
        np.tensordot(jacobian(s), b.V) + s.phi_t for s in (b.later(h).rows(), b.later(-h).rows())
    )
    assert b.rows().gamma == pytest.approx(-(later - before) / (2 * h), abs=1e-7)


@pytest.mark.parametrize("case", CASES)
def test_rows_against_every_twist(case):
    """Each column of J by moving one body at a time (a turning drive: from where it is allowed)."""
    b, h = thrown(case, 7), 1e-5
    columns = []
    for k in range(6, b.V.size):
        twist = np.zeros(b.V.size)
        twist[k] = 1.0
        twist = twist.reshape(-1, 6)
        columns.append((b.moved(twist, h).rows().phi - b.moved(twist, -h).rows().phi) / (2 * h))
    J = jacobian(b.rows())[:, 1:].reshape(-1, b.V.size - 6)
    assert pytest.approx(np.array(columns).T, abs=1e-8) == J


@pytest.mark.parametrize("case", CASES)
def test_reactions_add_no_force_and_no_moment(case):
    b = thrown(case, 9)
    put_right(b, PLACE, np.zeros(3), np.zeros(3))  # closed: off it, a pair of forces has a lever
    if len(b.V) > 3:
        put_right(b, AWAY, np.zeros(3), np.zeros(3), "third")
    for row in jacobian(b.rows()):
        check_action_is_reaction(b, row)
