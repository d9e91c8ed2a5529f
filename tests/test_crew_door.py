"""The crew door against a separate program for the same data, and against statics and momentum.

Men on its stairs, and where the roller meets the guide: tests/studies/test_crew_door.py, from runs
that are made there.
"""

import json
from pathlib import Path

import numpy as np
import pytest

from trsim.assemble.assemble import assemble
from trsim.scenario.load import load
from trsim.solve.sizing import sized

from .runs import run

DOOR = Path(__file__).parent.parent / "scenarios" / "crew_door"
OTHER = json.loads((Path(__file__).parent / "data" / "crew_door_prototype.json").read_text())


def door(name, *sets):
    return run(load(DOOR / f"{name}.yaml", list(sets)))


def test_three_freedoms_and_nothing_redundant():
    m = assemble(load(DOOR / "mechanism.yaml"))
    assert m.mobility == m.mobility_by_count == 3
    assert not m.redundant and not m.singular
    bodies = load(DOOR / "mechanism.yaml").bodies
    assert len(bodies) == 17 and sum(body.mass for body in bodies.values()) == pytest.approx(139.5)


@pytest.fixture(scope="module")
def opened():
    return door("opened")


def test_the_lifted_door(opened):
    """Angles of handles and gearbox, and the lift, at 110 deg of the latch."""
    assert np.degrees(opened["latch_angle"][-1]) == pytest.approx(110.0, abs=1e-6)
    for name, angle in OTHER["angles_at_latch_110"].items():
        assert np.degrees(opened[name][-1]) == pytest.approx(angle, abs=0.05)
    assert 1e3 * opened["lift"][-1] == pytest.approx(OTHER["lift_at_latch_110_mm"], abs=0.1)
    assert opened["latch_angle"][-1] == pytest.approx(1.5 * opened["gearbox_angle"][-1], abs=1e-9)


def about_x(angle):
    """The rotation about x."""
    c, s = np.cos(angle), np.sin(angle)
    return np.array([[1, 0, 0], [0, c, -s], [0, s, c]])


LEAN = about_x(np.radians(15.0))  # from the drawing to the world


def from_outside(r):
    """All that acts on the mechanism from the fuselage and by weight: (place, force, moment)."""
    drawn = {name: LEAN @ np.array(at) for name, at in {
        "fwd": [-0.28, 0, 0], "aft": [0.28, 0, 0], "pivot": [0.46, 0.345, 0.84],
        "jettison": [-0.36, 0.14, 1.09], "spring": [0.46, 0.90, 1.415], "wire": [0.44, 0.02, 1.30],
    }.items()}  # fmt: skip
    none = np.zeros(3)
    yield drawn["fwd"], r["hinge.locating_force"][-1], none
    yield drawn["aft"], r["hinge.floating_force"][-1], none
    for place, joint in (("pivot", "cb_pivot"), ("jettison", "jett_bearing")):
        yield drawn[place], r[f"{joint}.reaction"][-1], r[f"{joint}.reaction_moment"][-1]
    yield drawn["jettison"], none, np.array([-1.0, 0, 0]) * r["jett_hold.force"][-1]
    on_arm = np.array([0.46, 0.32501, 0.97452]) - [0.46, 0.345, 0.84]
    arm = drawn["pivot"] + LEAN @ about_x(r["cb_angle"][-1]) @ on_arm
    on_door = np.array([0.38, 0.05, 0.69]) - [0, -0.045, 0.95]
    door = r["door.position"][-1] + LEAN @ about_x(r["opening"][-1]) @ on_door
    for name, far, near in (("spring", "cb_spring", arm), ("wire", "wire", door)):
        way = drawn[name] - near
        yield near, r[f"{far}.force"][-1] * way / np.linalg.norm(way), none
    for name, body in load(DOOR / "mechanism.yaml").bodies.items():
        yield r[f"{name}.position"][-1], np.array([0, 0, -9.81 * body.mass]), none
    if "man.magnitude" in r.place:
        foot = np.array([0.2, 0.03, 1.1]) - [0, -0.045, 0.95]
        place = r["door.position"][-1] + LEAN @ about_x(r["opening"][-1]) @ foot
        yield place, np.array([0, 0, -2000.0]), none


@pytest.mark.parametrize("man", [False, True])
def test_reactions_balance_what_is_applied(opened, man):
    """Weights, a man, hinges, pivots, wire and spring of the opened door: nothing is left."""
    r = opened
    if man:
        r = door("opened_man", "parameters.foot=0.2", "parameters.stair=4")
    acting = list(from_outside(r))
    assert r["fwd_guide.normal_force"][-1] == r["fwd_seal.normal_force"][-1] == 0.0
    force = sum(f for _, f, _ in acting)
    moment = sum(np.cross(at, f) + m for at, f, m in acting)
    largest = max(np.linalg.norm(f) for _, f, _ in acting)
    assert force == pytest.approx(np.zeros(3), abs=1e-9 * largest)
    assert moment == pytest.approx(np.zeros(3), abs=1e-9 * largest)


def test_the_opened_door(opened):
    theirs = OTHER["opened"]
    assert np.degrees(opened["opening"][-1]) == pytest.approx(theirs["opening"], abs=0.01)
    assert opened["wire.force"][-1] == pytest.approx(theirs["wire"], rel=0.01)
    assert opened["cb_rod_force"][-1] == pytest.approx(theirs["cb_rod"], rel=0.01)


@pytest.fixture(scope="module")
def jettison():
    return door("jettison", "solver.tolerance=1e-7")


def test_jettison(jettison):
    theirs, rows = OTHER["jettison"], jettison["opening"] < np.radians(113.0)
    rate = jettison["opening.rate"][rows]
    assert rate.max() == pytest.approx(theirs["largest_rate"], rel=0.01)
    at = np.degrees(jettison["opening"][rows][rate.argmax()])
    assert at == pytest.approx(theirs["at"], abs=1.5)
    assert rate[-1] == pytest.approx(theirs["rate_at_113"], rel=0.01)
    for bearing, name in (("locating", "fwd"), ("floating", "aft")):
        found = jettison[f"hinge.{bearing}_load"][rows].max()
        assert found == pytest.approx(theirs[f"hinge_{name}"], rel=0.01)


def test_the_hinges_let_go_without_a_jump(jettison):
    """No velocity changes as they do: it goes on as smoothly as it came, under the same loads."""
    free = jettison["opening"] > np.radians(113.0)
    k = int(np.flatnonzero(free)[0])
    t, v = jettison.t, jettison["door.velocity"]
    rates = np.abs(np.diff(v, axis=0)).max(axis=1) / np.diff(t)
    assert rates[k - 1] < 2.0 * rates[k - 4 : k - 1].max()
    assert (jettison["hinge.locating_load"][k:] == 0.0).all()
    assert jettison["hinge.locating_load"][k - 1] > 100.0


def test_wind_from_below_lifts_it_off_the_wire():
    r = door("opened_slack")
    assert r.outcome.status == "slack" and "wire" in r.outcome.reason
    assert r["wire.force"].min() >= -1e-9


@pytest.mark.parametrize(
    ("name", "hand", "rod", "theirs"),
    [
        ("jam_gearbox", 1334, "P7P10", OTHER["jams"]["P7P10_inner"]),
        ("jam_gearbox", -1334, "P7P10", -OTHER["jams"]["P7P10_inner"]),
        ("jam_gearbox_outer", 1334, "P7P10", OTHER["jams"]["P7P10_outer"]),
        ("jam_outer", 1334, "P2P6", OTHER["jams"]["P2P6_least"]),
        ("jam_outer", -1334, "P2P6", OTHER["jams"]["P2P6_most"]),
    ],
)
def test_jams(name, hand, rod, theirs):
    """At the first angle of the latch, where the rods carry most; what is jammed stays."""
    r = door(name, f"parameters.hand={hand}", "solver.end=0.01", "output.every=0.01")
    assert r[rod][0] == pytest.approx(theirs, rel=0.03)
    held = "outer_angle" if name == "jam_outer" else "gearbox_angle"
    assert abs(r[held][0]) < 1e-9
    idle = r["P2P6"][0]
    assert (name != "jam_gearbox") or abs(idle) < 0.01 * abs(hand) * 5


def test_the_latch_at_its_bolt_hole(opened):
    """Force and moment of the section against all that acts on the shaft beyond it, at rest."""
    r, turn = opened, opened["opening"][-1]
    door_axes = LEAN @ about_x(turn)
    latch = door_axes @ about_x(-r["latch_angle"][-1])
    p = np.array([0.05, -0.04, 0.62])

    def at(place):
        """From the station to a place of the shaft as drawn, in the world."""
        return latch @ (np.array(place) - p)

    acting = [
        (at([0.30, -0.04, 0.62]), r["latch_bearings.floating_force"][-1]),
        (at([0.12, -0.04, 0.682]), -r["crank_pin.reaction"][-1]),
        (at([0.16, -0.04, 0.63]), np.array([0, 0, -3 * 9.81])),
    ]
    force = -sum(f for _, f in acting)
    moment = -sum(np.cross(arm, f) for arm, f in acting)
    # components along y and z of the shaft, and x: the normal of the section
    axes = latch @ np.array([[0, 0, 1], [1, 0, 0], [0, 1, 0]])  # columns y, z, x as drawn
    assert r["latch_section.force"][-1] == pytest.approx(axes.T @ force, abs=1e-6)
    assert r["latch_section.moment"][-1] == pytest.approx(axes.T @ moment, abs=1e-6)
    assert r["latch_section.bending"][-1] > 10.0


def test_the_handle_is_let_go_where_its_force_changes_its_sign():
    """Found, not given; without friction of the seals the door goes on by itself, with it not."""
    smooth = ("templates.side.forces.seal.friction=0", "forces.bavett.friction=0")
    ends = {}
    for name, sets in (("stays", ()), ("goes on", smooth)):
        r = door("let_go", "output.every=0.05", *sets)
        force, latch = r["handle.force"], np.degrees(r["latch_angle"])
        free = np.flatnonzero((latch > 30.0) & (force == 0.0))[0]
        before = force[free - 1]
        assert 0.0 <= before < 1.0 and (force[free:] == 0.0).all()
        ends[name] = r.outcome.status, latch[free], latch[-1]
    status, gone, last = ends["stays"]
    assert status == "stalled" and gone == pytest.approx(OTHER["lifting"]["negative_at"], abs=1.0)
    assert last < 80.0
    assert ends["goes on"][0] == "done" and ends["goes on"][2] > 92.0


def test_the_hand_takes_over_from_the_drive():
    """Until the roller is on the guide the load put back leaves less than 1e-6 of the torque."""
    sizes = ("solver.end=3.4", "output.every=0.85")
    scenario = load(DOOR / "sizing.yaml", list(sizes))
    found = sized(scenario)
    assert found.relative[0] == 1.0 and found.relative[-1] < 1e-6
