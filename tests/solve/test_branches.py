"""Accelerations and torques where branches of the motion meet: cranks that lie flat.

Two or three cranks of length 1 that carry a plate and turn by theta as one:

    (I + sum of m p'^2) theta'' = 2 (g_y cos theta - g_x sin theta) + torque    for two of mass 1
"""

import numpy as np
import pytest

from trsim.solve.diagnose.doubts import doubts

from ..overconstrained import METHODS, ORDINARY, TILTED, cranks, text
from ..runs import run
from ..sizes import RELEASE

OF_ONE_KIND = {name: sets for name, sets in METHODS.items() if name != "auto"}
GRAVITY = np.array([2.0, -5.0, 0.0])
# all that is looked at: extremes of forces that are zero but for rounding are sought for long
ACCELERATIONS = "output.channels=['*.angular_acceleration']"
# near such a place a row is as dear as many steps, and tests of the start read one row
STARTED = (ACCELERATIONS, "output.every=1e-2")
TOLERANCES = (1e-3, 1e-4, 1e-6)


def inertia(number, R=ORDINARY):
    """About theta: cranks of mass 1 and 0.15 kg m2 about z, and the plate of mass 1."""
    axis = np.asarray(R)[:, 2]  # bodies are placed, not turned
    return number * (axis @ np.diag([0.1, 0.12, 0.15]) @ axis + 0.25) + 1.0


def weight(number, theta):
    way = np.array([-np.sin(theta), np.cos(theta), 0.0])
    return (0.5 * number + 1.0) * (GRAVITY @ way)


def flat(number, more, R=ORDINARY, angle=0.0, end=0.5):
    """Lying flat on each other's line at angle 0."""
    parts = cranks([1.0] * number, np.cumsum([0.0, 0.7, 0.9])[:number], angle, top=0.0)
    g = "[" + ", ".join(repr(float(x)) for x in R @ GRAVITY) + "]"
    planar = "true" if R is ORDINARY else "false"
    return text(parts, f"gravity: {g}\n{more}", R, planar=planar, end=end)


def turning(number, rate, R=ORDINARY):
    """Velocities of the bodies at theta = 0."""
    spin = [float(x) for x in R @ [0, 0, rate]]
    given = [f"bodies.plate.velocity={[float(x) for x in R @ [0, rate, 0]]}"]
    for k in range(number):
        given += [f"bodies.crank{k}.velocity={[float(x) for x in R @ [0, rate / 2, 0]]}"]
        given += [f"bodies.crank{k}.angular_velocity={spin}"]
    return given


def spins(r, number, R):
    """Angular accelerations about the cranks' axis of all bodies at the rows."""
    names = ["plate", *(f"crank{k}" for k in range(number))]
    return np.column_stack([r[f"{name}.angular_acceleration"] @ R[:, 2] for name in names])


@pytest.mark.parametrize("method", OF_ONE_KIND.values(), ids=OF_ONE_KIND)
@pytest.mark.parametrize("number", [2, 3])
def test_a_start_where_branches_meet_has_the_accelerations_of_its_branch(number, method):
    r = run(flat(number, "", end=1e-2), *turning(number, 3.0), *method, *STARTED)
    a = spins(r, number, ORDINARY)[0]
    assert a[0] == pytest.approx(0.0, abs=1e-8)
    assert a[1:] == pytest.approx(weight(number, 0.0) / inertia(number), rel=1e-8)


@pytest.mark.parametrize("R", [ORDINARY, TILTED], ids=["plane", "tilted"])
def test_the_same_in_space(R):
    r = run(flat(3, "", R, end=1e-2), *turning(3, 3.0, R), *STARTED)
    a = spins(r, 3, np.asarray(R))[0]
    # the drawing is rounded, 1e-16, and looked at 1e-3 beside it, by rows at small angles
    assert a[0] == pytest.approx(0.0, abs=1e-7)
    assert a[1:] == pytest.approx(weight(3, 0.0) / inertia(3, R), rel=1e-7)


@pytest.mark.parametrize("law", ["velocity: 2 + t", "position: 2*t + 0.5*t**2"])
def test_a_drive_from_where_branches_meet_has_its_torque(law):
    more = f"drives: {{motor: {{joint: F0, {law}}}}}"
    recorded = "output.channels=['*.angular_acceleration', motor.force]"
    r = run(flat(3, more, end=1e-2), "output.every=1e-2", recorded)
    assert spins(r, 3, ORDINARY)[0] == pytest.approx([0.0, 1.0, 1.0, 1.0], abs=1e-8)
    assert r["motor.force"][0] == pytest.approx(inertia(3) - weight(3, 0.0), rel=1e-8)


@pytest.mark.parametrize("method", OF_ONE_KIND.values(), ids=OF_ONE_KIND)
def test_a_row_exactly_where_branches_meet(method):
    """A quarter turn at half a second, with rows there and nowhere near."""
    more = "drives: {motor: {joint: F0, velocity: -3.141592653589793}}\noutput: {every: 0.25}"
    r = run(flat(3, more, angle=np.pi / 2, end=1.0), *method)
    there = np.flatnonzero(np.abs(r.t - 0.5) < 1e-9)[0]
    tolerance = r.scenario.solver.tolerance
    assert spins(r, 3, ORDINARY)[there] == pytest.approx(0.0, abs=max(1e-7, 1e3 * tolerance))
    assert r["motor.force"][there] == pytest.approx(-weight(3, 0.0), rel=max(1e-7, 1e3 * tolerance))


@pytest.mark.parametrize("R", [ORDINARY, TILTED], ids=["plane", "tilted"])
@pytest.mark.parametrize("method", ["dop853", "radau", "ggl"])
@pytest.mark.parametrize("number", [2, 3])
def test_rows_next_to_where_branches_meet(number, method, R):
    """At constant speed nothing accelerates; rounding makes eps/d^3 of that at d from a flat place:
    a row at the start, between others and at the end of a run was off by the largest of all.

    The rows of a run are at d before one flat place, d behind the next and 3 d behind another; or
    upright, and at d and 3 d behind flat places.
    """
    rate = 20.0
    drive = f"drives: {{motor: {{joint: F0, velocity: {-rate}}}}}\noutput: {{every: "
    wrong = {}
    for k, past in enumerate((1e-5, 2e-5, 1e-4, 3e-4)):
        ways = ((past, np.pi + 2.0 * past, 2), (np.pi / 2, np.pi / 2 + past, 3))
        for angle, turn, rows in ways if RELEASE else ways[: 1 + (k == 0)]:
            every = turn / rate
            scene = flat(number, f"{drive}{every!r}}}", R, angle=angle, end=rows * every)
            for tolerance in TOLERANCES if RELEASE else TOLERANCES[k % 3 :: 3]:
                r = run(scene, *METHODS[method], f"solver.tolerance={tolerance}", ACCELERATIONS)
                off = np.abs(spins(r, number, R)).max(axis=1) / rate**2
                assert len(off) == 1 + rows
                if not np.all(off < 100.0 * tolerance):
                    wrong[past, tolerance, angle] = off / tolerance
    assert not wrong


EVENTS = {
    "set": "events: {{a: {{when: t, value: {}, do: {{set: {{motor: {{velocity: -20.0}}}}}}}}}}",
    "load": "forces: {{l: {{type: applied_load, body: crank0, torque: '1e-30*(t > {})', "
    "direction: [0, 0, 1]}}}}",
}


@pytest.mark.parametrize("R", [ORDINARY, TILTED], ids=["plane", "tilted"])
@pytest.mark.parametrize("method", ["dop853", "radau", "ggl"])
@pytest.mark.parametrize("event", EVENTS.values(), ids=EVENTS)
def test_extremes_behind_events_next_to_where_branches_meet(event, method, R):
    """The same behind an event that changes nothing: what it leaves behind is an extreme, too."""
    rate = 20.0
    drive = f"drives: {{motor: {{joint: F0, velocity: {-rate}}}}}\noutput: {{every: 0.5}}\n"
    wrong = {}
    for k, past in enumerate((-1e-5, 1e-5, 2e-5)):
        more = drive + event.format(repr((np.pi / 2 + past) / rate))
        for tolerance in TOLERANCES[:2] if RELEASE or k == 1 else TOLERANCES[k // 2 : k // 2 + 1]:
            sets = (*METHODS[method], f"solver.tolerance={tolerance}", ACCELERATIONS)
            r = run(flat(3, more, R, angle=np.pi / 2, end=0.1), *sets)
            place = r.place["crank1.angular_acceleration"][0]
            off = np.abs(r.outcome.peaks[place : place + 3, [0, 2]]).max() / rate**2
            if not off < 100.0 * tolerance:
                wrong[past, tolerance] = off / tolerance
    assert not wrong


@pytest.mark.parametrize("R", [ORDINARY, TILTED], ids=["plane", "tilted"])
@pytest.mark.parametrize("method", ["dop853", "radau"])
def test_steps_go_past_where_branches_meet(method, R):
    """Two cranks that turn about 25 times: no step ends close to a flat place because it is one,
    and the energy is kept past all of them."""
    recorded = "output.channels=[plate.velocity, crank0.angular_velocity]"
    sets = (f"solver.method={method}", "solver.tolerance=1e-9", "output.every=0.01", recorded)
    r = run(flat(2, "", R, end=20.0), *turning(2, 8.0, R), *sets)
    told = r.outcome.statistics
    turned = np.sum(np.abs(r["crank0.angular_velocity"] @ R[:, 2])) * 0.01 / (2.0 * np.pi)
    assert turned > 20.0
    assert told["steps"] < (40 if method == "dop853" else 800) * turned
    assert told["rejected_steps"] < 0.4 * told["steps"]
    assert told["energy_residual_relative"] < 1e-7
    v = r["plate.velocity"] @ R
    theta = np.arctan2(-v[:, 0], v[:, 1])  # the plate goes round as the cranks' ends do
    omega = r["crank0.angular_velocity"] @ R[:, 2]
    theta = np.where(omega > 0.0, theta, theta + np.pi)
    work = 2.0 * (GRAVITY[0] * (np.cos(theta) - 1.0) + GRAVITY[1] * np.sin(theta))
    assert 0.5 * inertia(2, R) * (omega**2 - 64.0) == pytest.approx(work, abs=1e-5)


def test_stiff_forces_do_not_matter_to_the_limit():
    """A spring far stiffer than the motion is fast: forces are those of the place itself."""
    more = "forces: {s: {type: torsion_spring, joint: F0, stiffness: 1e9, preload: 1e3}}"
    r = run(flat(2, more, end=1e-7), *turning(2, 3.0), ACCELERATIONS, "output.every=1e-7")
    a = spins(r, 2, ORDINARY)[0]
    assert a[1:] == pytest.approx((1e3 + weight(2, 0.0)) / inertia(2), rel=1e-8)


def test_rest_where_branches_meet_is_told():
    """Whether the two cranks turn as one or against each other nobody has said."""

    def said(load, *more):
        r = run(flat(2, load, end=1e-3), *more, "output.every=1e-3", ACCELERATIONS)
        return [x for x in doubts(r.scenario, r.mechanism, r.outcome) if "branches" in x]

    torque = "forces: {s: {type: torsion_spring, joint: F0, stiffness: 0, preload: 3}}"
    told = said(torque)[0]
    assert "F0, T0" in told
    assert "not determined" in told
    assert not said(torque, *turning(2, 1.0))
    assert not said("")  # they are moved alike


LEAD_SCREW = """
planar: false
bodies:
  shaft: {mass: 1, inertia: [0.001, 0.001, 0.001], at: [0, 0, 0.2]}
  nut: {mass: 2, inertia: [0.01, 0.01, 0.02], at: [0.1, 0, 0.3]}
joints:
  bearing: {type: revolute, bodies: [ground, shaft], at: [0, 0, 0], axis: [0, 0, 1]}
  guide: {type: prismatic, bodies: [ground, nut], at: [0.1, 0, 0.3], axis: [0, 0, 1]}
  thread: {type: screw, bodies: [shaft, nut], at: [0, 0, 0.3], axis: [0, 0, 1], pitch: PITCH}
initial: {bearing.rate: RATE}
gravity: [0, 0, -9.81]
solver: {end: 1}
"""


@pytest.mark.parametrize("pitch", [0.02, -0.3])
@pytest.mark.parametrize("rate", [0.0, 50.0])
def test_a_lead_screw_has_one_branch(pitch, rate):
    """Four of its rows are redundant everywhere: (m + J/h^2) z'' = -m g."""
    made = run(LEAD_SCREW.replace("PITCH", str(pitch)).replace("RATE", str(rate)))
    assert not any(
        "branches" in line for line in doubts(made.scenario, made.mechanism, made.outcome)
    )
    h = pitch / (2 * np.pi)
    way = -h * rate - 0.5 * 2 * 9.81 / (2 + 0.001 / h**2)  # the nut goes back on what turns in it
    assert made["nut.position"][-1, 2] - 0.3 == pytest.approx(way, abs=1e-7)
