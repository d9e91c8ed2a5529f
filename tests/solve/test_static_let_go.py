"""Drives that let go on static paths, against closed forms."""

import numpy as np
import pytest
from scipy.optimize import brentq

import trsim
from tests.solve.test_static_path import events, path

G = 9.81
USER = 5
# a rod of 2 kg at 0.2 m: k phi - T0 + 2 g 0.2 cos phi is what a hand gives and a load takes
ROD = """
bodies:
  rod: {mass: 2 kg, inertia: [0.01, 0.02, 0.05], at: [FAR2, FAR]}
joints:
  hinge: {type: revolute, bodies: [BODIES], at: [FAR, FAR]}
drives:
  hand: {joint: hinge, MOTION}
sensors: {turn: {joint: hinge}}
forces:
  spring: {type: torsion_spring, joint: hinge, stiffness: K, preload: T0}
  LOAD
events:
  let_go: {when: WHEN, crosses: both, times: 1, do: {release: [hand]}}
"""
PUSH = 'push: {type: applied_load, body: rod, torque: "3*max(t - 0.5, 0)", direction: [0, 0, 1]}'


def rod(
    load="", when="hand.force", k=20, T0=8, bodies="ground, rod", motion='position: "t"', far=0
):
    found = ROD.replace("BODIES", bodies).replace("MOTION", motion).replace("LOAD", load)
    found = found.replace("WHEN", when).replace("K", str(k)).replace("T0", str(T0))
    return found.replace("FAR2", str(far + 0.2)).replace("FAR", str(far))


def rests(torque=0.0, k=20.0, T0=8.0):
    return brentq(lambda phi: k * phi - T0 + 2 * G * 0.2 * np.cos(phi) - torque, -1, 3, xtol=1e-15)


@pytest.mark.parametrize("bodies, side", [("ground, rod", 1), ("rod, ground", -1)])
@pytest.mark.parametrize("motion", ['position: "{}*t"', "velocity: {}"])
@pytest.mark.parametrize("far, plane", [(0, ""), (300, ""), (0, "planar: false")])
def test_what_is_let_go_follows_the_load(bodies, side, motion, far, plane):
    text = rod(PUSH, bodies=bodies, motion=motion.format(side), far=far, T0=side * 8)
    r = path(plane + text)
    assert r.outcome.status == "done" and dict(r.outcome.fired) == {"let_go": 1}
    ((time, _),) = events(r, USER)
    assert time == pytest.approx(rests(), abs=1e-9)
    free = r.t > time
    assert side * r["turn"][free] == pytest.approx(
        [rests(3 * max(t - 0.5, 0)) for t in r.t[free]], abs=1e-8
    )
    assert np.all(r["hand.force"][free] == 0.0) and np.all(r["hand.force"][~free] != 0.0)
    assert r["hand.position"] == pytest.approx(r["turn"], abs=1e-9)
    assert side * r["turn"][~free] == pytest.approx(r.t[~free], abs=1e-9)


def test_nothing_is_left_that_drives():
    r = path(rod())
    assert r.outcome.status == "released"
    assert "'hand' let go" in r.outcome.reason and "rests there" in r.outcome.reason
    assert r.outcome.time == pytest.approx(rests(), abs=1e-9)
    assert r.t[-1] == r.outcome.time and r["turn"][-1] == pytest.approx(rests(), abs=1e-9)


def test_a_drive_that_holds_still_goes_on():
    """Another drive goes on, of a body that nothing joins to the first."""
    more = """
bodies: {other: {mass: 1 kg, inertia: 0.1 kg*m^2, at: [1, 0]}}
joints: {pin: {type: revolute, bodies: [ground, other], at: [0.5, 0]}}
drives: {motor: {joint: pin, position: "2*t"}}
"""
    both = rod()
    for line in more.strip().splitlines():
        section, inner = line.split(": ", 1)
        both = both.replace(f"{section}:\n", f"{section}:\n  {inner[1:-1]}\n", 1)
    r = path(both)
    assert r.outcome.status == "done"
    assert r["motor.force"] == pytest.approx(0.5 * G * np.cos(2 * r.t), abs=1e-8)
    assert r["turn"][-1] == pytest.approx(rests(), abs=1e-8)
    book = r["energy.residual"] if "energy.residual" in r.place else None
    assert book is None or np.abs(book).max() < 1e-3


def test_over_its_centre_it_goes_by_itself():
    """Without the spring the rod is held up to the top, where the force of the hand turns round."""
    r = path(rod(k=0, T0=0, motion='position: "2*t"'))
    assert r.outcome.status == "released" and "unstable" in r.outcome.reason
    assert r["turn"][-1] == pytest.approx(np.pi / 2, abs=1e-8)


def test_let_go_under_load_jumps_and_says_so():
    r = path(rod(PUSH, when="turn, value: 0.1"))
    assert r.outcome.status == "done"
    (said,) = [text for text in r.outcome.said if "let go" in text]
    assert "jumps by" in said
    assert r["turn"][r.t > 0.11][0] == pytest.approx(rests(), abs=1e-8)
    r = path(rod(when="turn, value: 0.1"))
    assert r.outcome.status == "released" and "of its size away" in r.outcome.reason


def test_what_nothing_holds():
    """A slide without a spring, let go under a load along it."""
    text = """
bodies: {block: {mass: 1 kg, inertia: 0.1 kg*m^2, at: [0, 0]}}
joints: {rail: {type: prismatic, bodies: [ground, block], axis: [1, 0]}}
drives: {hand: {joint: rail, position: "t"}}
sensors: {x: {joint: rail}}
forces: {pull: {type: applied_load, body: block, direction: [1, 0, 0], force: 5}}
events: {let_go: {when: x, value: 0.5, do: {release: [hand]}}}
"""
    r = path(text)
    assert r.outcome.status == "released" and "nothing holds it" in r.outcome.reason
    assert r["hand.force"][-1] == pytest.approx(-5, abs=1e-9)


@pytest.mark.filterwarnings("ignore::trsim.TrsimWarning")
def test_the_run_of_a_file_ends_released(tmp_path):
    """It is written whole, with what speaks against believing it."""
    file = tmp_path / "rod.yaml"
    text = rod().replace("[0.01, 0.02, 0.05]", "0.05")
    text += f"gravity: [0, -{G}]\nsolver: {{method: static_path, end: 1 s}}\n"
    text += "output: {every: 0.1}\n"
    file.write_text(text, encoding="utf-8", newline="\n")
    result = trsim.run(file, tmp_path / "rod.h5")
    assert result.status == "released"
    assert result["turn"][-1] == pytest.approx(rests(), abs=1e-8)
