"""Runs that change their branch where branches nearly meet, and those that do not.

Cranks of nearly one length turn over at the flat places of their parallelogram, so that

    theta_0' (plate x crank 1)

never changes its sign while they move; a run that goes straight on changes it.
"""

from types import SimpleNamespace

import numpy as np
import pytest

from trsim.assemble.equations import poses
from trsim.assemble.reduce import in_solve_axes, jacobian, moves, roots, times_roots
from trsim.elements.scene import workspace
from trsim.kernels.plain import run as as_python
from trsim.solve.diagnose.doubts import doubts
from trsim.solve.diagnose.locked import dependent, locked
from trsim.solve.march import complete
from trsim.solve.march.passes import row_may_turn

from ..overconstrained import METHODS, ORDINARY, TILTED, Z, cranks, text
from ..runs import run
from ..sizes import RELEASE, size
from .test_branches import flat, turning

TOLERANCES = ("1e-2", "1e-3", "1e-4", "1e-6", "5e-7")
# a row next to such a place is the end of a step, which then seldom goes past it
SELDOM = "output: {every: 0.05}"
# all that branches are told by: extremes of forces, which are chance here, are sought for long
MOTION = "output.channels=['*.position', '*.angular_velocity']"
ROUNDING = 1e-6  # 1e-12, to which rows are closed, over the least distance of branches, 1e-5
SPACES = {"plane": ORDINARY, "tilted": TILTED}


def given(body, rate, place, pivot, R):
    """Velocities of a body that turns about a pivot."""
    way = np.asarray(place, float) - pivot
    v = [float(x) for x in R @ (rate * np.array([-way[1], way[0], 0.0]))]
    spin = [float(x) for x in R @ [0.0, 0.0, rate]]
    return [f"bodies.{body}.velocity={v}", f"bodies.{body}.angular_velocity={spin}"]


def upright(longer, R, rate=2.0):
    """Two upright cranks that carry a plate, the second one longer; text and velocities."""
    R = np.asarray(R)
    parts = cranks([1.0, 1.0 + longer], [0.0, 0.7], np.pi / 2, top=0.0)
    more = f"gravity: [0, 0, 0]\n{SELDOM}"
    planar = "true" if R is ORDINARY else "false"
    sets = [f"bodies.plate.velocity={[float(x) for x in R @ [-rate, 0.0, 0.0]]}"]
    for k, (length, x) in enumerate(((1.0, 0.0), (1.0 + longer, 0.7))):
        sets += given(f"crank{k}", rate, (x, -length / 2, 0.0), (x, -length, 0.0), R)
    return text(parts, more, R, planar=planar, end=10.0), sets


def crank_and_rod(longer, R, rate=3.0):
    """A slider-crank with a rod longer than its crank by a little."""
    R, angle = np.asarray(R), 1.0
    pin = np.array([np.cos(angle), np.sin(angle), 0.0])
    end = np.array([pin[0] + np.sqrt((1.0 + longer) ** 2 - pin[1] ** 2), 0.0, 0.0])
    joints = {
        "A": ("ground", "crank", (0, 0, 0), Z),
        "B": ("crank", "rod", pin, Z),
        "C": ("rod", "slider", end, Z),
        "track": ("ground", "slider", end, (1, 0, 0), "prismatic"),
    }
    bodies = {"crank": pin / 2, "rod": (pin + end) / 2, "slider": end}
    planar = "true" if R is ORDINARY else "false"
    scene = text((bodies, joints), SELDOM, R, planar=planar, end=10.0)
    turn = -rate * pin[0] / (end - pin)[0]
    pole = np.array([0.0, 0.0, 0.0]) + pin * (1.0 - rate / turn)  # of the rod
    slide = turn * (pole[1] - end[1])
    sets = given("crank", rate, pin / 2, (0, 0, 0), R) + given(
        "rod", turn, (pin + end) / 2, pole, R
    )
    return scene, [*sets, f"bodies.slider.velocity={[float(x) for x in R @ [slide, 0, 0]]}"]


# past two such places, or four: runs that change their branch do so at one of the first
SHORTER = {
    drawn: f"solver.end={size(usual, 6)}" for drawn, usual in ((upright, 3), (crank_and_rod, 1.7))
}


def cross(u, v):
    return u[:, 0] * v[:, 1] - u[:, 1] * v[:, 0]


def changes(r, x):
    """How often x changes its sign, what is zero to ten tolerances left out: on a branch it is some
    0.7 wide, and a row in a step past such a place is no better than its tolerance.  The last row
    may be just behind such a place, and is the end of a step: on the joints to rounding, whatever
    the tolerance, so that its sign is that of its branch."""
    zero = 10.0 * r.scenario.solver.tolerance
    counted = np.abs(x) > max(0.02, zero)
    counted[-1] = abs(x[-1]) > ROUNDING
    sign = np.sign(x[counted])
    return int(np.sum(sign[1:] != sign[:-1]))


def of_cranks(r, R):
    feet = [np.array(r.scenario.joints[f"F{k}"].at) for k in (0, 1)]
    first, second = (2.0 * (r[f"crank{k}.position"] - feet[k]) @ R for k in (0, 1))
    plate = (feet[1] - feet[0]) @ R + second - first
    return changes(r, (r["crank0.angular_velocity"] @ R)[:, 2] * cross(plate, second))


def of_rod(r, R):
    rod = (r["rod.position"] - 2.0 * r["crank.position"]) @ R
    return changes(r, (r["crank.angular_velocity"] @ R)[:, 2] * rod[:, 0])


def told(r):
    """What is said of branches."""
    return [x for x in doubts(r.scenario, r.mechanism, r.outcome) if "another branch" in x]


@pytest.mark.parametrize("R", SPACES.values(), ids=SPACES)
@pytest.mark.parametrize("method", ["dop853", "radau"])
@pytest.mark.parametrize("scene", [(upright, of_cranks), (crank_and_rod, of_rod)], ids=["", "rod"])
def test_a_run_says_when_it_changed_its_branch_and_only_then(scene, method, R):
    drawn, branches = scene
    wrong = 0
    for k, longer in enumerate((1e-9, 1e-8, 1e-7, 1e-6, 1e-5, -1e-8, -1e-6, -1e-9)):
        for tolerance in TOLERANCES if RELEASE else TOLERANCES[k % 3 :: 3][: 1 + (k == 0)]:
            made, sets = drawn(longer, R)
            ways = (f"solver.method={method}", f"solver.tolerance={tolerance}")
            r = run(made, *sets, *ways, MOTION, SHORTER[drawn], fails=None)
            if r.outcome.status == "failed":  # it says so, where a step came to end between them
                assert "branches of the motion nearly meet" in r.outcome.reason
                continue
            changed = branches(r, np.asarray(R)) > 0
            assert bool(told(r)) == changed, (longer, tolerance)
            wrong += changed
    assert wrong > 4  # else nothing was tested


def test_a_part_that_ends_between_the_branches_hides_no_change():
    """A row turns round in two parts of a step, in each by some 80 degrees."""
    made, sets = upright(-1e-6, SPACES["tilted"])
    ways = ("solver.method=radau", "solver.tolerance=1e-2", "solver.first_step=0.1473")
    r = run(made, *sets, *ways)
    assert of_cranks(r, np.asarray(SPACES["tilted"])) > 0
    assert told(r)


def test_a_change_just_before_the_end_counts():
    """Nearer to such a place, at the end, than ten tolerances."""
    made, sets = upright(1e-7, ORDINARY)
    ways = ("solver.method=dop853", "solver.tolerance=1e-3", "solver.end=6")
    r = run(made, *sets, *ways, MOTION)
    assert bool(told(r)) == (of_cranks(r, np.asarray(ORDINARY)) > 0)


@pytest.mark.parametrize("R", SPACES.values(), ids=SPACES)
@pytest.mark.parametrize("method", ["auto", "dop853", "radau", "ggl"])
@pytest.mark.parametrize("number", [2, 3])
def test_nothing_is_said_where_branches_meet(number, method, R):
    tolerances = ("1e-2", "1e-4", "1e-6") if RELEASE else ("1e-2", f"1e-{2 * number}")
    for tolerance in tolerances:
        sets = (*METHODS[method], f"solver.tolerance={tolerance}")
        r = run(flat(number, "", R, end=size(1, 5)), *turning(number, 6.0, R), *sets, MOTION)
        assert not told(r), tolerance


@pytest.mark.parametrize("R", SPACES.values(), ids=SPACES)
def test_crank_and_rod_of_one_length_go_on_along_their_branch(R):
    made, sets = crank_and_rod(0.0, R)
    for tolerance in ("1e-2", "1e-4", "1e-6"):
        r = run(made, *sets, f"solver.tolerance={tolerance}", MOTION)
        assert of_rod(r, np.asarray(R)) > 4
        assert not told(r)


@pytest.mark.parametrize("method", ["dop853", "radau", "generalized_alpha", "auto"])
def test_no_first_step_hides_a_change(method):
    """What a step goes past depends on where steps happen to lie.

    Where the rows of a place nearly decide, a run may lose its speed there instead: what brings it
    back to the joints then does most of the energy, and says that branches nearly meet.
    """
    rng, wrong = np.random.default_rng(11), 0
    for _ in range(size(12 if method == "generalized_alpha" else 8, 1500)):
        R = SPACES[str(rng.choice(list(SPACES)))]
        drawn, branches = [(upright, of_cranks), (crank_and_rod, of_rod)][rng.integers(2)]
        longer = 10.0 ** -float(rng.integers(5, 10))
        made, sets = drawn(-longer if drawn is upright and rng.random() < 0.3 else longer, R)
        tolerance, first = 10 ** rng.uniform(-6, -2), rng.choice(np.geomspace(1e-3, 1.0, 60))
        if method == "generalized_alpha":  # of second order: ten thousand steps, none of them long
            tolerance = max(tolerance, size(1, 0) * 1e-5)
        ways = (f"method={method}", f"tolerance={tolerance}", f"first_step={first}")
        given = [f"solver.{way}" for way in ways]
        r = run(made, *sets, *given, "output.every=0.01", MOTION, SHORTER[drawn], fails=None)
        if r.outcome.status == "failed":
            continue  # it says so
        changed = branches(r, np.asarray(R)) > 0
        said = [x for x in doubts(r.scenario, r.mechanism, r.outcome) if "branch" in x]
        assert said or not changed, (longer, ways)
        wrong += changed
    assert wrong > 1  # else nothing was tested


def test_a_motion_that_lost_its_speed_is_not_called_right():
    """Extremes next to such a place are chance, and the motion behind it is another one."""
    made, sets = upright(1e-9, SPACES["plane"])
    found = 0
    for first in np.geomspace(1e-3, 1.0, 12)[:: size(2, 1)]:
        ways = ("solver.method=radau", "solver.tolerance=1.1e-6", f"solver.first_step={first}")
        r = run(made, *sets, *ways, SHORTER[upright], fails=None)
        said = list(doubts(r.scenario, r.mechanism, r.outcome))
        if any("bringing" in x or "another branch" in x for x in said):
            found += any("are chance" in x for x in said)
            assert not any("motion is right" in x for x in said), first
    assert found  # else nothing was tested


def test_what_is_said():
    """The time, the joints, and what to do."""
    made, sets = upright(1e-8, ORDINARY)
    r = run(made, *sets, "solver.tolerance=1e-3", "solver.method=dop853")
    (said,) = told(r)
    assert said.startswith("joints.F0: at t = ")
    assert "F0, T0, F1, T1" in said
    assert "times in all" in said
    assert "`tolerance`" in said


def test_two_mechanisms_flat_at_once_one_of_them_nearly():
    """Where the branches of one meet, those of the other need not."""
    for longer in (0.0, 1e-8):
        bodies, joints, sets = {}, {}, []
        for name, extra, y in (("a", 0.0, 0.0), ("b", longer, 5.0)):
            up = np.array([0.0, y, 0.0])
            parts = cranks([1.0, 1.0 + extra], [0.0, 0.7], np.pi / 2, top=0.0)
            for body, place in parts[0].items():
                bodies[name + body] = np.array(place) + up
            for joint, (i, j, place, axis) in parts[1].items():
                i = i if i == "ground" else name + i
                joints[name + joint] = (i, name + j, np.array(place) + up, axis)
            sets += [
                word.replace("bodies.", f"bodies.{name}") for word in upright(extra, ORDINARY)[1]
            ]
        more = f"gravity: [0, 0, 0]\n{SELDOM}"
        made = text((bodies, joints), more, planar="true", end=1.0, tolerance=1e-3)
        r = run(made, *sets, "solver.method=dop853", MOTION)
        assert bool(told(r)) == (longer > 0.0)


def stopped_upright(longer, R):
    """Cranks stopped where they next are flat."""
    made, sets = upright(longer, R)
    ends = (f"solver.end={np.pi / 4}", "solver.tolerance=1e-10", "solver.max_step=1e-2")
    return run(made, *sets, *ends, MOTION, fails=None)


def drawn_flat(number, R):
    """Cranks that have hardly left where they are flat: there a row is as dear as many steps."""
    ways = ("output.every=1e-7", MOTION)
    return run(flat(number, "", R, end=1e-7), *turning(number, 3.0, np.asarray(R)), *ways)


STOPPED = {
    "equal": lambda R: stopped_upright(0.0, R),
    "nearly equal": lambda R: stopped_upright(1e-9, R),
    "drawn flat": lambda R: drawn_flat(2, R),
    "three drawn flat": lambda R: drawn_flat(3, R),
}


@pytest.mark.parametrize("R", SPACES.values(), ids=SPACES)
@pytest.mark.parametrize("stopped", STOPPED.values(), ids=STOPPED)
def test_no_velocity_there_is_said_to_lock(stopped, R):
    """Along either branch and across both: a step between the branches may end with any."""
    r = stopped(R)
    model, y, t = r.mechanism.model, r.outcome.record.y.copy(), r.outcome.time
    assert dependent(r.mechanism, t, y)[1] < 1e-3
    planar = model.d == 3
    C, there = roots(model, y, planar), moves(model, planar)
    rows = times_roots(jacobian(model, t, y)[2], C)[:, there]
    free = np.zeros((2, there.size))
    free[:, there] = np.linalg.svd(rows / np.linalg.norm(rows, axis=1, keepdims=True))[2][-2:]
    free = np.einsum("fij,kfj->kfi", C, free.reshape(2, *C.shape[:2])).reshape(2, -1)
    work = workspace(model)
    for angle in np.linspace(0.0, 2.0 * np.pi, size(8, 16), endpoint=False):
        rates = 3.0 * (np.cos(angle) * free[0] + np.sin(angle) * free[1])
        poses(work, y)
        y[model.n_q : model.n_q + model.n_v] = in_solve_axes(work, rates)
        said = locked(r.mechanism, t, y)
        assert "nearly meet" in said and "locks" not in said, angle


@pytest.mark.parametrize("last", [0.0, 1.0])
def test_what_does_not_move_does_not_turn_round(last):
    """A row with nothing of its own, too."""
    s = SimpleNamespace(row=np.zeros(1, int), column_start=np.zeros(2, int), m=1)
    for way, may in ((0.0, False), (0.1, True)):
        assert as_python(row_may_turn.python, s, np.zeros((3, 1)), way, last, 0) == may


@pytest.mark.parametrize("tolerance, allowed", [(1e-6, 1e-7), (1e-12, 1e-11)])
@pytest.mark.parametrize("lost", [0.9, -0.9, 1.2, -1.2])
def test_how_much_energy_may_go_astray_in_a_step(monkeypatch, tolerance, allowed, lost):
    """Of 3 J a tenth of the tolerance, or 1e-11 (docs/numerics.md)."""
    s, b = SimpleNamespace(n_out=2, out=np.zeros(2)), SimpleNamespace(out=np.zeros(2), **BARE)
    r = SimpleNamespace(y=2.0, work_projection=0.0, energy_0=0.0)

    def measure(s, t, y, done, energy_0):
        s.out[1] = lost * allowed * 3.0

    monkeypatch.setattr(complete, "kinetic", lambda s, y: y)
    monkeypatch.setattr(complete, "measure", measure)
    setting = SimpleNamespace(fixed_step=0.0, step_error=tolerance, t_end=1.0)
    assert complete.leaked.python(s, r, b, setting) == (abs(lost) > 1)


BARE = {"t1": 0.1, "h": 0.1, "y1": 3.0, "projected": 0.0}
