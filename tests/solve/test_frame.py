"""A scenario drawn in a frame moves as the same one turned by hand, and as one that is not turned
under a gravity that is turned the other way."""

import json

import numpy as np
import pytest
import yaml

from tests.elements.test_examples import EXAMPLES
from tests.runs import built, run, short_run
from tests.solve.test_instances import (
    FRAME,
    PENDULUM,
    RK4,
    largest,
    rotation,
    same,
    text,
)
from trsim.errors import ModelError, ScenarioError

FLAT = {"at": [1, -2, 0.5], "x_axis": [0.6, 0.8, 0], "y_axis": [-8, 6, 0]}
STIFFEST = 1.7e7  # N, E A of the stiffest bar of the examples
PITCHED = {"at": [0.1, 2, 3], "about": [0, 1, 0], "angle": "20 deg"}


def of_frame(frame):
    """Its axes as columns, by Rodrigues' formula from what PITCHED says."""
    if "angle" not in frame:
        return rotation(frame)
    n, a = np.array(frame["about"], float), np.deg2rad(float(frame["angle"].split()[0]))
    n /= np.linalg.norm(n)
    K = np.array([[0, -n[2], n[1]], [n[2], 0, -n[0]], [-n[1], n[0], 0]])
    return np.eye(3) + np.sin(a) * K + (1 - np.cos(a)) * K @ K


def axes_only(frame):
    """The same frame without words, for `same`."""
    R = of_frame(frame)
    return {"at": frame["at"], "x_axis": R[:, 0].tolist(), "y_axis": R[:, 1].tolist()}


@pytest.mark.parametrize("frame", [FRAME, PITCHED])
def test_a_turned_scenario_moves_as_the_one_that_is_not(frame):
    g = np.array([0.0, -9.81, 1.0])
    flat = run(text({**PENDULUM, **RK4}, gravity=tuple(g)))
    turned = (of_frame(frame) @ g).tolist()
    ours = run(text({**PENDULUM, **RK4, "frame": frame}, gravity=tuple(turned)))
    assert np.ptp(flat["bob.position"], axis=0).max() > 0.05
    same(flat, ours, axes_only(frame), 1e-12, after="")


# --- turned by hand ------------------------------------------------------------------------------

MACHINE = """
planar: false
gravity: [1, 0, -9.81]
points:
  tip: {body: arm, at: [0.5, 0.2, 0.1], x_axis: [0, 1, 0], y_axis: [0, 0, 1]}
bodies:
  arm: {mass: 3, inertia: [0.1, 0.4, 0.5], at: [0.3, 0.1, 0], velocity: [0, 0.3, 0],
        angular_velocity: [0, 0, 1]}
  bob: {density: 500, shape: [{box: [0.1, 0.2, 0.3], at: [0.6, 0.2, 0.1], axis: [1, 0, 1],
        x_axis: [0, 1, 0]}], velocity: [0.1, 0.4, 0.2]}
joints:
  pin: {type: revolute, bodies: [ground, arm], at: [0, 0, 0], axis: [0.1, 0.2, 1]}
  ball: {type: spherical, bodies: [arm, bob], at: tip}
sensors:
  q: {joint: pin}
  height: {type: point, body: bob, at: [0.7, 0, 0], axis: [0, 0.6, 0.8]}
forces:
  rope: {type: spring_damper, bodies: [ground, bob], stiffness: 200, damping: 3,
         points: [[1, 1, 1], {in: tip, at: [0.1, 0, 0]}]}
  jet: {type: wrench, body: bob, at: [0.6, 0.2, 0.3], force: [2, "5*q", 0], moment: [0, 0.1, t]}
solver: {method: rk4, step: 1e-3, end: 0.2}
output: {every: 0.02}
"""


def turned_by_hand(frame):
    """The machine, each vector of it turned here, into numbers of the world."""
    R, at = of_frame(frame), np.array(frame["at"], float)
    whole = yaml.safe_load(MACHINE)

    def free(v):
        return (R @ v).tolist()

    def place(v):
        return (R @ v + at).tolist()

    tip = whole["points"]["tip"]
    tip.update(at=place(tip["at"]), x_axis=free(tip["x_axis"]), y_axis=free(tip["y_axis"]))
    arm, bob = whole["bodies"]["arm"], whole["bodies"]["bob"]
    I = R @ np.diag(arm["inertia"]) @ R.T
    arm["inertia"] = [I[0, 0], I[1, 1], I[2, 2], I[0, 1], I[0, 2], I[1, 2]]
    arm.update(at=place(arm["at"]), velocity=free(arm["velocity"]))
    arm["angular_velocity"] = free(arm["angular_velocity"])
    bob["velocity"], box = free(bob["velocity"]), bob["shape"][0]
    box.update(at=place(box["at"]), axis=free(box["axis"]), x_axis=free(box["x_axis"]))
    pin = whole["joints"]["pin"]
    pin.update(at=place(pin["at"]), axis=free(pin["axis"]))
    height = whole["sensors"]["height"]
    height.update(at=place(height["at"]), axis=free(height["axis"]), origin=at.tolist())
    rope, jet = whole["forces"]["rope"], whole["forces"]["jet"]
    rope["points"][0] = place(rope["points"][0])
    whole["points"]["drawn"] = {"body": "ground", "at": at.tolist(), "x_axis": R[:, 0].tolist(),
                                "y_axis": R[:, 1].tolist()}  # fmt: skip
    jet.update(at=place(jet["at"]), frame="drawn")
    return whole


@pytest.mark.parametrize("frame", [FRAME, PITCHED])
def test_a_turned_scenario_is_the_one_turned_by_hand(frame):
    ours = run(MACHINE + f"\nframe: {json.dumps(frame)}\n")
    theirs = run(json.dumps(turned_by_hand(frame)))
    compared = [c for c in ours.mechanism.columns if not c.name.endswith(".rotation")]
    assert len(compared) > 20
    for c in compared:
        size = max(1.0, np.abs(theirs[c.name]).max())
        assert np.abs(ours[c.name] - theirs[c.name]).max() <= 1e-12 * size, c.name


# --- every element -------------------------------------------------------------------------------


def example(word, frame=None, planar=True):
    """The example of an element for a few steps, drawn in a frame, under the same gravity there."""
    whole = yaml.safe_load(EXAMPLES[word])
    method = whole["solver"].get("method", "rk4")
    own = {"method": "rk4", "step": 5e-6} if method != "kinematic" else {"method": method}
    whole |= {"solver": {**own, "end": 2.5e-5}, "planar": planar}
    whole["output"] = {"every": 5e-6}
    if frame is not None:
        g = np.append(whole.get("gravity", [0, 0, 0]), 0.0)[:3].astype(float)
        whole |= {"frame": frame, "gravity": (of_frame(frame) @ g).tolist()}
    return json.dumps(whole)


def fits(word, planar):
    """Whether the example may be solved in the plane, or in space."""
    try:
        built(example(word, planar=planar))
    except (ModelError, ScenarioError):
        return False
    return True


@pytest.mark.parametrize("word", EXAMPLES)
def test_every_element(word):
    """In the plane turned about z, in space by any angle; channels say which are in world axes."""
    ways = [planar for planar in (True, False) if fits(word, planar)]
    assert ways
    for planar in ways:
        frame = FLAT if planar else FRAME
        flat, ours = (
            short_run(example(word, planar=planar)),
            short_run(example(word, frame, planar)),
        )
        assert ours.mechanism.planar == planar
        for c in flat.mechanism.columns:
            theirs, mine = seen(flat[c.name], c, frame), ours[c.name]
            if c.unit == "J":  # the height of a weight is from another origin
                theirs, mine = theirs - theirs[0], mine - mine[0]
            near = 1e-10 * largest(flat, c.unit)
            if c.unit == "N" and flat.mechanism.beams:  # E A times the rounding of a strain
                near = max(near, 1e-13 * STIFFEST)
            assert np.abs(mine - theirs).max() <= near, (planar, c.name)


def seen(values, column, frame):
    """A channel turned into the frame where it is in world axes; a place moved too."""
    R, at = of_frame(frame), np.array(frame["at"])
    if column.size == 9:
        return (R @ values.reshape(-1, 3, 3)).reshape(-1, 9)
    if column.size == 3 and ("world" in column.meaning or ".reaction" in column.name):
        place = column.unit == "m"
        return values @ R.T + (at if place else 0.0)
    return values
