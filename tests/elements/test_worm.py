"""Worm gears: flanks slide along the thread only, closed forms, and what is refused.

With r the pitch radius of the wheel the lead of the worm is 2 pi r starts / teeth.  Where they
touch, on the line across both axes, the two may move against each other along the thread, and not
across it: nu = cos(lambda) a_1 - sin(lambda) (a_1 x rho), tan(lambda) = lead / (2 pi r_1), which
says the hand by itself.
"""

import numpy as np
import pytest

from trsim.errors import TrsimError

from ..runs import built, energy_error, run
from ..trains import Train

X, Y, Z = np.eye(3)
APART, WHEEL = 0.25, 0.2  # m, between the axes; pitch radius of the wheel
ABOVE = (0.03 * X, APART * Y + 0.1 * Z)  # the worm along X, the wheel about Z above it
CASES = {
    "right": (Train(ABOVE, (X, Z)), 1, 30, "right"),
    "right unless said": (Train(ABOVE, (X, Z)), 1, 30, ""),
    "left": (Train(ABOVE, (X, Z)), 1, 30, "left"),
    "worm about the other way": (Train(ABOVE, (-X, Z)), 2, 31, "right"),
    "wheel about the other way": (Train(ABOVE, (X, -Z)), 2, 31, "right"),
    "wheel below": (Train((0 * X, -APART * Y), (X, Z)), 1, 30, "left"),
    "carrier second": (Train(ABOVE, (X, Z), second=(True, False)), 3, 40, "right"),
    "carrier second, twice": (Train(ABOVE, (X, Z), second=(True, True)), 3, 40, "left"),
    "turned against the drawing": (
        Train(ABOVE, (X, Z), turned=np.eye(3), spin=Z, angles=(3.5, -2.9, 4.1)), 1, 30, "right",
    ),
    "far away": (Train(ABOVE, (X, Z), place=np.array([300.0, -200.0, 80.0])), 1, 30, "right"),
}  # fmt: skip


def across_the_thread(train, starts, teeth, hand):
    """Where the two touch, and the direction in which they may not slide."""
    side = np.sign(train.at[1][1])  # of the wheel
    touch, rho, a = side * (APART - WHEEL) * Y, side * Y, train.axis[0]
    slope = WHEEL * starts / teeth / (APART - WHEEL) * (-1 if hand == "left" else 1)
    nu = a - slope * np.cross(a, rho)
    return touch, nu / np.linalg.norm(nu)


@pytest.mark.parametrize("case", CASES)
def test_flanks_slide_along_the_thread(case):
    train, starts, teeth, hand = CASES[case]
    told = f", hand: {hand}" if hand else ""
    mesh = f"type: worm, joints: [first, other], teeth: [{starts}, {teeth}]{told}"
    r = run(train.text(mesh))
    assert r.mechanism.mobility == 0
    assert np.abs(r["y"]).max() == pytest.approx(starts / teeth * np.abs(r["x"]).max())
    touch, nu = across_the_thread(train, starts, teeth, hand)
    far = np.abs(train.place).max()
    assert np.abs(train.slip(r, touch)).max() > 0.1
    assert np.abs(train.slip(r, touch, nu)).max() < 1e-10 * max(1.0, far)
    assert energy_error(r) < 1e-6


DRIVEN = """
planar: false
bodies:
  screw: {mass: 1, inertia: [1e-3, 2e-3, 2e-3], at: [0, 0, 0], angle: 0}
  wheel: {mass: 2, inertia: [0.01, 0.01, 0.9], at: [0, 0.06, 0], angle: 4}
joints:
  bearing: {type: revolute, bodies: [ground, screw], at: [0, 0, 0], axis: [1, 0, 0]}
  shaft: {type: revolute, bodies: [ground, wheel], at: [0, 0.06, 0], axis: [0, 0, 1]}
  teeth: {type: worm, joints: [bearing, shaft], ratio: -30}
forces:
  push: {type: applied_load, body: screw, direction: [1, 0, 0], torque: 0.3}
  lift: {type: applied_load, body: wheel, direction: [0, 0, 1], torque: -2}
sensors: {x: {joint: bearing}, y: {joint: shaft}}
solver: {end: 2, tolerance: 1e-9}
"""


def test_a_worm_under_load():
    """(I_1 + I_2/n^2) x'' = T_1 + T_2/n,  n = -30, and the wheel drives the worm as well."""
    r = run(DRIVEN)
    acceleration = (0.3 + 2 / 30) / (1e-3 + 0.9 / 900)
    assert r["x"][-1] > 100 * np.pi
    assert r["x"] == pytest.approx(acceleration * r.t**2 / 2, rel=1e-8, abs=1e-8)
    assert r["y"] == pytest.approx(-r["x"] / 30, abs=1e-10)
    assert r["teeth.torque_1"] == pytest.approx(1e-3 * acceleration - 0.3, rel=1e-8)
    assert r["teeth.torque_2"] == pytest.approx(30 * (1e-3 * acceleration - 0.3), rel=1e-8)
    assert energy_error(r) < 1e-9


REFUSED = {
    "parallel": ("axis: [1, 0, 0]", "axis: [0, 0, 1]", ("joints",), "are parallel"),
    "antiparallel": ("axis: [1, 0, 0]", "axis: [0, 0, -2]", ("joints",), "are parallel"),
    "axes that meet": ("at: [0, 0.06, 0], axis", "at: [0, 0, 0], axis", ("joints",), "meet"),
    "half a start": ("teeth: [1, 40]", "teeth: [0.5, 40]", ("teeth", 0), "whole number"),
    "no teeth": ("teeth: [1, 40]", "teeth: [1, 0]", ("teeth", 1), "must be > 0"),
    "no such hand": ("hand: right", "hand: both", ("hand",), "must be"),
    "ratio and hand": ("teeth: [1, 40]", "ratio: 40", (), "has a sign"),
    "ratio of zero": ("teeth: [1, 40], hand: right", "ratio: 0", ("ratio",), "must not be zero"),
    "nothing": ("teeth: [1, 40], hand: right", "hand: left", (), "got none"),
    "same bodies": ("[bearing, shaft]", "[bearing, bearing]", ("joints",), "twice"),
    "no carrier": ("[ground, wheel]", "[other, wheel]", ("joints",), "share no carrier"),
}


@pytest.mark.parametrize("case", REFUSED)
def test_refused(case):
    old, new, path, words = REFUSED[case]
    text = DRIVEN.replace("ratio: -30", "teeth: [1, 40], hand: right")
    text = text.replace("  wheel: {", "  other: {mass: 1, inertia: [1, 1, 1]}\n  wheel: {")
    with pytest.raises(TrsimError) as caught:
        built(text.replace(old, new))
    problem = caught.value.problems[0]
    assert problem.path == ("joints", "teeth", *path)
    assert words in problem.what
