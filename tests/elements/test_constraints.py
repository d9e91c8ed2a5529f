"""Every constraint: J, Phi_t and gamma are the derivatives of Phi, checked by differences.

    Phi' = J V + Phi_t     along any motion,        J V' = gamma

At constant twists V' = 0, so gamma is minus the rate of J V + Phi_t.  And the rows are forces: what
they put on the bodies and the ground adds up to no force and no moment.
"""

import numpy as np
import pytest

from trsim import elements

from .bench import bench, check_action_is_reaction, now, put_right

AXIS, PLACE = np.array([0.48, 0.6, 0.64]), np.array([0.2, 0.1, 0.0])
# of the keys a joint has
KEYS = {
    "at": "[0.2, 0.1, 0]",
    "axis": "[0.48, 0.6, 0.64]",
    "second_axis": "[0.6, -0.48, 0]",
    "x_axis": "[0.8, -0.1, 0.3]",
    "pitch": "0.7",
    "points": "[[0.2, 0.1, 0], [0.5, -0.3, 0.4]]",
    "clearance": "0.03",
    "contact": "law",
}
# where a joint must be drawn another way
OTHERS = {"constant_velocity": {"second_axis": "[0.8, -0.1, 0.3]"}}
JOINTS = {word: elements.load(word) for word, of in elements.ELEMENTS.items() if of == "joints"}
LAW = """
contact_laws: {law: {normal: hunt_crossley, stiffness: 1e6, bearing_radius: 0.2, restitution: 0.9}}
"""
DRIVES = {
    "position": "position: 0.2 + 0.5*sin(3*t)",
    "velocity": "velocity: 2*cos(3*t) + t**2",
    "table": "velocity: {table: [[0, 1], [0.2, 2], [0.5, 1], [1, 0]]}",
    "constant": "velocity: 0.7",
}
CASES = {name: (name, "", "") for name in JOINTS}
CASES |= {
    f"{d} of {j}'s {x}": (j, d, x)
    for j, joint in JOINTS.items() if not joint.ideal for x in joint.coordinates for d in DRIVES
}  # fmt: skip


def written(word):
    """A joint of a type, with the keys that it has."""
    fields = JOINTS[word].spec.model_fields
    keys = KEYS | OTHERS.get(word, {})
    own = ", ".join(f"{key}: {value}" for key, value in keys.items() if key in fields)
    return f"type: {JOINTS[word].ideal or word}, {own}"


def thrown(case, seed):
    """The joint in a random pose; with a turning drive in one that the joint allows."""
    joint, drive, coordinate = CASES[case]
    rng = np.random.default_rng(seed)
    text = f"joints: {{joint: {{bodies: [left, right], {written(joint)}}}}}\n"
    text += LAW if JOINTS[joint].ideal else ""
    of = f"joint.{coordinate}"
    text += f"drives: {{drive: {{joint: {of}, {DRIVES[drive]}}}}}\n" if drive else ""
    b = bench(text, rng)
    assert b.mechanism.model.m == len(JOINTS[joint].rows) + bool(drive)
    counted = "lead" in JOINTS[joint].rows
    if coordinate == "angle" or counted:
        # an angle is one only while the axes are parallel, and its rate while they stay so
        put_right(b, PLACE, rng.uniform(-2, 2) * AXIS, np.zeros(3))
        if not counted:
            b.V[2, 3:] = b.V[1, 3:] + rng.normal() * now(b, AXIS)
    return b


@pytest.mark.parametrize("case", CASES)
@pytest.mark.parametrize("seed", range(3))
def test_derivatives(case, seed):
    b, h = thrown(case, seed), 1e-5
    w, ahead, behind = b.rows(), b.later(h).rows(), b.later(-h).rows()
    V = np.hstack([b.V[1], b.V[2]])
    phi_dot, later, before = (s.J.reshape(-1, 12) @ V + s.phi_t for s in (w, ahead, behind))
    assert phi_dot == pytest.approx((ahead.phi - behind.phi) / (2 * h), abs=1e-7)
    assert w.gamma == pytest.approx(-(later - before) / (2 * h), abs=1e-7)


@pytest.mark.parametrize("case", CASES)
def test_rows_against_every_twist(case):
    """Each column of J by moving one body at a time (a turning drive: from where it is allowed)."""
    b, h = thrown(case, 7), 1e-5
    columns = []
    for k in range(6, 18):
        twist = np.zeros(18)
        twist[k] = 1.0
        twist = twist.reshape(3, 6)
        columns.append((b.moved(twist, h).rows().phi - b.moved(twist, -h).rows().phi) / (2 * h))
    assert pytest.approx(np.array(columns).T, abs=1e-8) == b.rows().J.reshape(-1, 12)


@pytest.mark.parametrize("case", CASES)
def test_reactions_add_no_force_and_no_moment(case):
    b = thrown(case, 9)
    put_right(b, PLACE, np.zeros(3), np.zeros(3))  # closed: off it, a pair of forces has a lever
    for row in b.rows().J.reshape(-1, 2, 6):
        check_action_is_reaction(b, np.vstack([np.zeros(6), row]))
