"""The ideal thrust reverser against the published data set and against a closed form."""

import numpy as np
import pytest
from scipy.optimize import brentq

from trsim.scenario.load import load, loads
from trsim.solve.march.record import EVENT_KIND, EVENT_ROW, EVENT_TIME, ONSET

from ..linkages import REVERSER
from ..mechanisms import table
from ..runs import energy_error, run


@pytest.fixture(scope="module")
def ideal():
    return run(load(REVERSER / "ideal.yaml"))


@pytest.mark.parametrize(
    "column, channel",
    [
        (1, lambda r: np.degrees(r["door_angle"])),
        (2, lambda r: r["air.magnitude"]),
        (3, lambda r: r["actuator.force"]),
        (4, lambda r: -r["B.reaction"][:, 1]),
        (5, lambda r: np.linalg.norm(r["Q.reaction"], axis=1)),
        (6, lambda r: r["lug.normal_force"]),
    ],
    ids=["angle", "air", "drive", "B.y", "Q", "lug"],
)
def test_table_of_the_data_set(ideal, column, channel):
    published = table("thrust_reverser_ideal.csv")
    ours = np.interp(published[:, 0], ideal["stroke"], channel(ideal))
    scale = np.abs(published[:, column]).max()
    assert ours == pytest.approx(published[:, column], abs=0.01 * scale)


def test_first_touch_and_largest_drive_force(ideal):
    names = [i.name for i in ideal.mechanism.instances]
    lug = (ideal.events[:, EVENT_ROW] == names.index("lug")) & (
        ideal.events[:, EVENT_KIND] == ONSET
    )
    assert ideal.events[lug, EVENT_TIME][0] == pytest.approx(0.2999, abs=0.0005)
    force, t = ideal.largest("actuator.force")
    assert force == pytest.approx(800, abs=8) and t == pytest.approx(0.951, abs=0.003)
    turn = np.degrees(np.ptp(ideal["door_angle"]))
    assert turn == pytest.approx(89.8, abs=0.1)


def test_energy_book_is_closed(ideal):
    assert energy_error(ideal) < 1e-4


# stage 2: the knee locked where the lug has folded it, nothing but the gas and the drive
D, A_CP, B0 = 0.195, 0.1131, np.array([-0.242, 0.241])
TINY = "mass: 1e-4, inertia: 1e-6"
LOCKED = f"""
extends: mechanism.yaml
parameters: {{speed: 0.05 m/s}}
bodies:
  door: {{mass: 1e-2, inertia: 1e-4}}
  large_rod: {{{TINY}}}
  transfer: {{{TINY}}}
  fairing: {{{TINY}}}
drives: {{knee: {{joint: P, velocity: 0}}}}
forces:
  spring: null
  seat: null
  lug: null
  air: {{at: {[*(B0 + A_CP * np.array([np.cos(np.radians(3)), -np.sin(np.radians(3))])).tolist()]},
        direction: {[float(np.sin(np.radians(3))), float(np.cos(np.radians(3)))]}}}
initial: {{guide: 0.2 m, P: KNEE}}
solver: {{end: 6 s, tolerance: 1e-9}}
output: {{every: 10 ms}}
"""


def knee_angle():
    """How far the lug folds the knee: its point reaches the line of the large rod's back."""
    pin, point = np.array([-0.074336, 0.207061]), np.array([-0.094784, 0.156003])
    normal, lever = np.array([-0.941185, -0.337890]), point - pin

    def gap(turn):
        c, s = np.cos(turn), np.sin(turn)
        return normal @ (pin + np.array([[c, -s], [s, c]]) @ lever)

    return brentq(gap, 0.0, 1.5)


def test_closed_form_of_a_massless_chain():
    """F = N (sin phi - (a/d) cos theta / sin(phi + theta)), theta the direction of S to Q."""
    text = LOCKED.replace("KNEE", str(knee_angle()))
    r = run(loads(text, folder=REVERSER))
    s, phi, N = r["stroke"], r["door_angle"], r["air.magnitude"]
    assert s[0] == pytest.approx(0.2, abs=1e-9) and s[-1] == pytest.approx(0.5, abs=1e-9)
    Q = B0 + np.stack([s, 0 * s], axis=1) + D * np.stack([np.cos(phi), -np.sin(phi)], axis=1)
    assert np.linalg.norm(Q, axis=1) == pytest.approx(0.2526, abs=1e-4)
    theta = np.arctan2(Q[:, 1], Q[:, 0])
    F = N * (np.sin(phi) - A_CP / D * np.cos(theta) / np.sin(phi + theta))
    assert r["actuator.force"] == pytest.approx(F, abs=1e-4 * np.abs(F).max())
    assert np.interp(0.475, s, F) == pytest.approx(847, abs=1)


def test_motion_that_dies_out_becomes_zero():
    """In space, joints hold what only rounding began: no number is left to be a denormal one."""
    inertia = {"fairing": 2.667, "door": 1.584e-2, "large_rod": 2.017e-3, "transfer": 1.777e-4}
    sets = [f"bodies.{name}.inertia=[{x}, {x}, {x}]" for name, x in inertia.items()]
    r = run(load(REVERSER / "ideal.yaml", ["planar=false", "solver.end=0.45", *sets]))
    y = np.abs(r.outcome.record.y)
    assert np.all((y == 0.0) | (y > 1e-60))
    planar = run(load(REVERSER / "ideal.yaml", ["solver.end=0.45"]))
    assert r["door_angle"] == pytest.approx(planar["door_angle"], abs=1e-7)


@pytest.mark.parametrize("tolerance", ["4e-7", "5e-7", "1e-6"])
def test_a_touch_before_another_one(tolerance):
    """The step that the lug's touch cuts had begun with B in flight, and brought it to touch.

    Where the search over the whole step did not see that, because B left again behind the lug's
    touch, B was found deep in its bearing: 19.9 kN for 3.8 kN.
    """
    sets = ("joints.B.clearance=0.0985 mm", "initial.guide=0.5 mm", f"solver.tolerance={tolerance}")
    done = run(load(REVERSER / "clearance_b_0.3mm.yaml", sets))
    assert energy_error(done) < 1e-8
    assert done.largest("B.contact_force")[0] == pytest.approx(3819.3, rel=0.01)
