"""Impulses of events: M (v+ - v-) = J^T Lambda of every body, from the lines a run leaves."""

import numpy as np
import pytest

from trsim.solve.march.record import USER

from ..runs import run

# lines of impulses: time, event, row, body, Lambda, force (3), moment (3)
LAMBDA, FORCE, MOMENT = 4, slice(5, 8), slice(8, 11)
# lines of jumps: time, event, body, velocities before and after, angular ones before and after
V, V_AFTER, SPIN, SPIN_AFTER = slice(3, 6), slice(6, 9), slice(9, 12), slice(12, 15)

LOOP = """
bodies:
  crank: {mass: 2, inertia: [0.01, 0.02, 0.03], at: [0.05, 0.1, 0]}
  rod: {mass: 3, inertia: [0.02, 0.05, 0.06, 0.001, -0.002, 0.003], at: [0.3, 0.2, 0]}
  arm: {mass: 4, inertia: [0.03, 0.02, 0.05], at: [0.55, 0.1, 0]}
  ball: {mass: 1, inertia: [0.004, 0.005, 0.006, 0.0005, 0, 0], at: [0.3, 0.5, 0.1]}
joints:
  O: {type: revolute, bodies: [ground, crank], at: [0, 0, 0], axis: [0, 0, 1]}
  A: {type: revolute, bodies: [crank, rod], at: [0.1, 0.2, 0], axis: [0, 0, 1]}
  B: {type: revolute, bodies: [rod, arm], at: [0.5, 0.2, 0], axis: [0, 0, 1]}
  C: {type: revolute, bodies: [ground, arm], at: [0.6, 0, 0], axis: [0, 0, 1]}
  D: {type: spherical, bodies: [rod, ball], at: [0.3, 0.3, 0]}
gravity: [0, -9.81, 3]
initial: {O.rate: 5 rad/s}
output: {channels: ["*", "*.rotation"]}
solver: {end: 0.1, tolerance: 1e-9}
"""
SPATIAL = """
bodies:
  a: {mass: 2, inertia: [0.01, 0.02, 0.03], at: [0.1, 0, 0], velocity: [1, 0, 0.3]}
  b: {mass: 3, inertia: [0.02, 0.05, 0.06, 0.001, -0.002, 0.003], at: [0.3, 0.1, 0.2],
      angular_velocity: [3, -2, 1], velocity: [0.2, 1, 0]}
  c: {mass: 1.5, inertia: [0.02, 0.01, 0.03], at: [0.5, 0.2, 0.1], angular_velocity: [0, 4, 1]}
joints:
  P: {type: universal, bodies: [ground, a], at: [0, 0, 0], axis: [0, 0, 1],
      second_axis: [0, 1, 0]}
  Q: {type: revolute, bodies: [a, b], at: [0.2, 0, 0.1], axis: [1, 1, 0]}
  R: {type: cylindrical, bodies: [b, c], at: [0.4, 0.2, 0.2], axis: [0, 1, 2]}
gravity: [0, -9.81, 3]
output: {channels: ["*", "*.rotation"]}
solver: {end: 0.1, tolerance: 1e-9}
"""
PLANAR = """
bodies:
  crank: {mass: 2, inertia: 0.03, at: [0.05, 0.1]}
  rod: {mass: 3, inertia: 0.06, at: [0.3, 0.2]}
  arm: {mass: 4, inertia: 0.05, at: [0.55, 0.1]}
joints:
  O: {type: revolute, bodies: [ground, crank], at: [0, 0]}
  A: {type: revolute, bodies: [crank, rod], at: [0.1, 0.2]}
  B: {type: revolute, bodies: [rod, arm], at: [0.5, 0.2]}
  C: {type: revolute, bodies: [arm, ground], at: [0.6, 0]}
gravity: [0, -9.81]
initial: {O.rate: 5 rad/s}
output: {channels: ["*", "*.rotation"]}
solver: {end: 0.1, tolerance: 1e-9}
"""
EVENTS = "events: {stop: {when: t, value: 0.05, do: {record: true, %s}}}\n"


def momenta(r):
    """Of every body what it gains, and its impulses: (n, 6) each, about its centre of mass."""
    bodies, frames = r.scenario.bodies, r.mechanism.frames
    gained, given = [], []
    for name, spec in bodies.items():
        f = frames[name]
        [line] = r.jumps[r.jumps[:, 2] == f]
        start, _ = r.place[f"{name}.rotation"]
        R = r.recorded[0, 2 + start : 11 + start].reshape(3, 3)
        inertia = R @ np.reshape(spec.tensor[0], (3, 3)) @ R.T
        turned = inertia @ (line[SPIN_AFTER] - line[SPIN])
        gained.append([*(spec.mass * (line[V_AFTER] - line[V])), *turned])
        own = r.impulses[r.impulses[:, 3] == f]
        given.append(np.sum(own[:, 5:], axis=0))
    gained = np.array(gained)
    if r.mechanism.planar:
        gained[:, [2, 3, 4]] = 0.0
    return gained, np.array(given)


CASES = {
    "plane": (PLANAR, "lock: [A]"),
    "plane, park": (PLANAR, "park: [rod]"),
    "plane, a lock that adds nothing": (PLANAR, "lock: [O, A, B, C]"),
    "plane, a body without mass": (
        PLANAR.replace("mass: 3, inertia: 0.06", "mass: 0, inertia: 0"),
        "lock: [A]",
    ),
    "plane, a drive goes on otherwise": (
        PLANAR.replace("initial: {O.rate: 5 rad/s}", "drives: {m: {joint: O, velocity: 5}}"),
        "set: {m: {velocity: -2}}",
    ),
    "loop in space, redundant": (LOOP, "lock: [O]"),
    "loop in space, redundant locks": (LOOP, "lock: [O, A, B]"),
    "loop in space, park": (LOOP, "park: [ball]"),
    "chain in space": (SPATIAL, "lock: [Q, R.angle]"),
    "chain in space, stroke": (SPATIAL, "lock: [R.stroke]"),
    "chain in space, park": (SPATIAL, "park: [b]"),
}


@pytest.mark.parametrize("method", ["dop853", "radau", "radau, formulation: ggl"])
@pytest.mark.parametrize("far", [0.0, 1e3])
@pytest.mark.parametrize("text, did", CASES.values(), ids=CASES)
def test_every_body_gains_its_impulses(text, did, far, method):
    if "ggl" in method and "mass: 0" in text:
        pytest.skip("bodies without mass are not solved for with ggl")
    frame = f"frame: {{at: [{far}, {-far}, 0]}}\n" if far else ""
    text = text.replace("end: 0.1,", f"end: 0.1, method: {method},")
    r = run(frame + text + EVENTS % did)
    gained, given = momenta(r)
    size = np.abs(gained).max()
    assert size > 0.1  # something jumps
    assert np.abs(gained - given).max() < 1e-10 * max(size, 1.0)


@pytest.mark.parametrize("text, did", CASES.values(), ids=CASES)
def test_all_momentum_goes_to_the_ground(text, did):
    """The ground's lines are minus what all bodies gain together, moments about the origin."""
    r = run(text + EVENTS % did)
    gained, _ = momenta(r)
    names = r.scenario.bodies
    places = [r.recorded[0, 2 + r.place[f"{n}.position"][0] :][:3] for n in names]
    spin = gained[:, 3:] + np.cross(places, gained[:, :3])
    if r.mechanism.planar:
        spin[:, :2] = 0.0
    ground = np.sum(r.impulses[r.impulses[:, 3] == 0][:, 5:], axis=0)
    whole = np.concatenate([np.sum(gained[:, :3], axis=0), np.sum(spin, axis=0)])
    assert np.abs(ground + whole).max() < 1e-10 * max(np.abs(gained).max(), 1.0)


RELEASES = {
    "plane": (PLANAR, "release: [B]"),
    "loop in space": (LOOP, "release: [C, D]"),
    "chain in space": (SPATIAL, "release: [P, Q]"),
}


@pytest.mark.parametrize("text, did", RELEASES.values(), ids=RELEASES)
def test_a_release_changes_no_velocity(text, did):
    r = run(text + EVENTS % did)
    assert len(r.jumps) == len(r.scenario.bodies)
    for before, after in ((V, V_AFTER), (SPIN, SPIN_AFTER)):
        assert np.abs(r.jumps[:, after] - r.jumps[:, before]).max() < 1e-10
    assert np.abs(r.impulses[:, LAMBDA]).max(initial=0.0) < 1e-10


def test_a_lock_against_the_formula():
    """A rod turning about its end is locked: Lambda of the lock is I_O omega, with the sign of the
    angle; the hinge has none, for its point is at rest, and the ground gets it all."""
    r = run("""
bodies: {rod: {mass: 2, inertia: 0.05, at: [0.4, 0]}}
joints: {hinge: {type: revolute, bodies: [ground, rod], at: [0, 0]}}
initial: {hinge.rate: 3 rad/s}
solver: {end: 0.1, tolerance: 1e-10}
events: {stop: {when: t, value: 0.05, do: {lock: [hinge]}}}
""")
    moment = (0.05 + 2 * 0.16) * 3.0
    rows = r.mechanism.stages.every
    lock = r.impulses[[rows[int(k)] == "hinge.lock.motion" for k in r.impulses[:, 2]]]
    assert lock[:, LAMBDA] == pytest.approx([-moment, -moment], abs=1e-10)
    hinge = r.impulses[[rows[int(k)].startswith("hinge.") and "lock" not in rows[int(k)]
                        for k in r.impulses[:, 2]]]  # fmt: skip
    on_rod = hinge[hinge[:, 3] == 1]
    angle = 3.0 * 0.05
    stop = -2 * 0.4 * 3.0 * np.array([-np.sin(angle), np.cos(angle)])
    assert np.sum(on_rod[:, 5:7], axis=0) == pytest.approx(stop, abs=1e-10)
    ground = np.sum(r.impulses[r.impulses[:, 3] == 0][:, 5:], axis=0)
    assert ground == pytest.approx([*-stop, 0, 0, 0, moment], abs=1e-10)


def test_lost_energy_is_that_of_the_jump():
    """work of the event is half the impulses times the sum of both velocities of each body."""
    r = run(SPATIAL + EVENTS % "lock: [Q]")
    _, given = momenta(r)
    twists = [
        np.concatenate([line[V] + line[V_AFTER], line[SPIN] + line[SPIN_AFTER]]) for line in r.jumps
    ]
    work = 0.5 * np.sum(given * np.array(twists))
    [event] = r.events[r.events[:, 1] == USER]
    assert work < 0.0 and event[5] == pytest.approx(work, rel=1e-9)
