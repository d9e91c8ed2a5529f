"""Kinematic analysis: the reactions of the dynamic one from the time alone, or a refusal."""

import re
from pathlib import Path

import numpy as np
import pytest

from tests.runs import run
from trsim.assemble.assemble import assemble
from trsim.errors import ModelError, ScenarioError
from trsim.scenario.load import load, loads
from trsim.solve import simulate as simulation
from trsim.solve.methods.kinematic import beyond_simpson
from trsim.solve.simulate import simulate

FOUR_BAR = """
bodies:
  crank: {{mass: 1 kg, inertia: [0.02, 0.03, 0.01], at: [0.05, 0.0]}}
  rod: {{mass: 2 kg, inertia: [0.01, 0.04, 0.03], at: [0.25, 0.1]}}
  rocker: {{mass: 1.5 kg, inertia: [0.02, 0.01, 0.02], at: [0.4, 0.1]}}
joints:
  a: {{type: revolute, bodies: [ground, crank], at: [0, 0]}}
  b: {{type: {b}, bodies: [crank, rod], at: [0.1, 0]}}
  c: {{type: {c}, bodies: [rocker, rod], at: [0.4, 0.2]}}
  d: {{type: revolute, bodies: [ground, rocker], at: [0.4, 0]}}
drives:
  motor: {{joint: a, {motion}}}
sensors:
  swing: {{joint: d}}
  turn: {{joint: a}}
gravity: {gravity}
forces:
  wind: {{type: applied_load, body: rod, at: [0.3, 0.1], direction: [1, 2, {z}],
          force: "20*cos(7*t)"}}
output: {{channels: ["*"], every: {every}}}
solver: {{end: {end}, method: {method}, tolerance: {tolerance}}}
"""
PLANE = {"b": "revolute", "c": "revolute", "gravity": "[0, -9.81, 0]", "z": 0}
SPACE = {"b": "spherical", "c": "universal, axis: [0, 0, 1], second_axis: [1, 0, 0]",
         "gravity": "[1, -9.81, 3]", "z": 3}  # fmt: skip
GROUND, CRANK, ROD, ROCKER = 0.4, 0.1, np.hypot(0.3, 0.2), 0.2


def four_bar(method="kinematic", scene=PLANE, motion='position: "20*t + 3*sin(5*t)"', **more):
    given = {"every": 1e-3, "end": 1, "tolerance": 1e-11, "motion": motion} | scene | more
    return FOUR_BAR.format(method=method, **given)


def rocker_at(angle):
    """How far the rocker has swung, by the triangle of the coupler, on the branch as drawn."""
    b = CRANK * np.array([np.cos(angle), np.sin(angle)])
    d = np.array([GROUND, 0.0])[:, None] - b
    far = np.hypot(*d)
    along = (far**2 + ROD**2 - ROCKER**2) / (2 * far)
    across = np.sqrt(ROD**2 - along**2)
    c = b + (along * d + across * np.array([-d[1], d[0]])) / far
    return np.arctan2(c[1], c[0] - GROUND) - np.pi / 2


def same(found, known, error=1e-6, skip=("energy.work", "energy.residual")):
    """Every channel of two runs."""
    worst = ("", 0.0)
    for name in known.place:
        if name.startswith(skip) or shared(found, name):
            continue
        x, y = known[name], found[name]
        scale = max(np.abs(x).max(), 1e-3 * largest_of_its_kind(known, name))
        worst = max(worst, (name, np.abs(x - y).max() / max(scale, 1e-12)), key=lambda w: w[1])
    print(f"worst: {worst[0]} {worst[1]:.1e}")
    assert worst[1] < error, worst


def shared(r, name):
    """Whether it is a reaction that the motion does not determine."""
    joints = {row.split(".")[0] for row in r.mechanism.not_unique}
    return name.split(".")[0] in joints and ".reaction" in name


def largest_of_its_kind(r, name):
    unit = {c.name: c.unit for c in r.mechanism.columns}
    return max(np.abs(r[n]).max() for n in r.place if unit[n] == unit[name])


def few_evaluations(r):
    rows = len(r.t)
    print(f"{r.outcome.statistics['evaluations'] / rows:.2f} evaluations per row")
    assert r.outcome.statistics["evaluations"] <= 4 * rows


@pytest.mark.parametrize("scene", [PLANE, SPACE], ids=["plane", "space"])
@pytest.mark.parametrize("speed", [0.1, 1.0, 30.0])
def test_as_the_dynamic_analysis(scene, speed):
    """Inertia included, at any speed; redundant rows of the scene in space are those left out."""
    motion = f'position: "{20 * speed}*t + 3*sin({5 * speed}*t)"'
    more = {"scene": scene, "motion": motion, "every": 1e-3 / speed, "end": 1 / speed}
    found, known = run(four_bar(**more)), run(four_bar("dop853", **more))
    assert found.mechanism.planar == (scene is PLANE) and found.mechanism.mobility == 0
    same(found, known, error=1e-7)
    few_evaluations(found)
    assert found.outcome.statistics["energy_residual_relative"] < 1e-6
    for name in ("motor.force", "swing.rate", *(("d.reaction",) if scene is PLANE else ())):
        value, at = known.largest(name)
        assert found.largest(name)[0] == pytest.approx(value, rel=1e-7)
        assert found.largest(name)[1] == pytest.approx(at, abs=1e-4 / speed)


def test_places_by_the_triangle():
    """Seen in rows that are far apart: 1.7 rad of the crank between two of them."""
    r = run(four_bar(motion='position: "17*t"', every=0.1, end=20))
    assert r["turn"] == pytest.approx(17 * r.t, abs=1e-12)
    assert r["swing"] == pytest.approx(rocker_at(17 * r.t), abs=1e-12)
    assert r.outcome.statistics["energy_residual_relative"] < 1e-3
    dense = rocker_at(np.linspace(0, 2 * np.pi, 200_001))
    assert r.largest("swing")[0] == pytest.approx(dense.max(), abs=1e-8)


@pytest.mark.parametrize("scene", [PLANE, SPACE], ids=["plane", "space"])
def test_drive_by_velocity(scene):
    """Its place is a time integral, by quadrature: 5 t + 2 (1 - cos 3t)."""
    motion = 'velocity: "5 + 6*sin(3*t)"'
    r = run(four_bar(scene=scene, motion=motion, every=0.02, end=4, tolerance=1e-8))
    assert r["turn"] == pytest.approx(5 * r.t + 2 * (1 - np.cos(3 * r.t)), abs=1e-12)
    known = run(four_bar("dop853", scene=scene, motion=motion, every=0.02, end=4))
    same(r, known, error=1e-7)


def test_rates_that_jump():
    """An impulse, as in the dynamic analysis; steps end on the jump."""
    motion = 'velocity: "5 + 3*(t > 0.3333)"'
    found, known = (
        run(four_bar(method, motion=motion, every=0.01)) for method in ("kinematic", "dop853")
    )
    same(found, known)
    assert found["energy.work.events"][-1] == pytest.approx(known["energy.work.events"][-1])
    assert found.outcome.record.n_jolts == 1
    assert found.outcome.statistics["energy_residual_relative"] < 1e-5


SLIDER = """
bodies:
  crank: {{mass: 1 kg, inertia: 0.01, at: [0, 0.05]}}
  rod: {{mass: 1 kg, inertia: 0.01, at: [0.15, 0.05]}}
  slider: {{mass: 1 kg, inertia: 0.01, at: [0.3, 0]}}
joints:
  a: {{type: revolute, bodies: [ground, crank], at: [0, 0]}}
  b: {{type: revolute, bodies: [crank, rod], at: [0, 0.1]}}
  c: {{type: revolute, bodies: [rod, slider], at: [0.3, 0]}}
  guide: {{type: prismatic, bodies: [ground, slider], axis: [1, 0, 0]}}
drives:
  ram: {{joint: guide, position: "{motion}"}}
sensors: {{turn: {{joint: a}}}}
output: {{every: {every}}}
solver: {{end: 2, method: kinematic}}
"""
REACH = 0.1 + np.hypot(0.3, 0.1) - 0.3  # of the slider, from where it is drawn
WAYS = {
    "0.1*t": lambda t: 0.1 * t,
    "0.1*t + 0.005*sin(30*t)": lambda t: 0.1 * t + 0.005 * np.sin(30 * t),
}


@pytest.mark.parametrize("every", [1e-3, 0.05, 0.7])
@pytest.mark.parametrize("motion", WAYS)
def test_ends_at_a_turning_point(every, motion):
    """Pushed to its dead centre: told with the time, the coordinate and the joints."""
    r = run(SLIDER.format(every=every, motion=motion), fails=True)
    t = np.linspace(0, 2, 2_000_001)
    beyond = t[np.argmax(WAYS[motion](t) > REACH)]
    assert r.outcome.time == pytest.approx(beyond, abs=2e-6)
    reason = r.outcome.reason
    assert "singular position, 'ram' at 0.116227766 m" in reason and "turning point" in reason
    assert all(np.isfinite(r.rows).ravel())


def test_turns_round_before_it():
    r = run(SLIDER.format(every=0.01, motion="0.058*(1 - cos(3*t))"))
    x = 0.3 + 0.058 * (1 - np.cos(3 * r.t))
    angle = np.arccos((0.1**2 + x**2 - 0.3**2 - 0.1**2) / (0.2 * x)) - np.pi / 2
    assert r["turn"] == pytest.approx(angle, abs=1e-9)


PARALLELOGRAM = """
bodies:
  crank: {{mass: 1 kg, inertia: 0.01, at: [0, 0.05]}}
  rod: {{mass: 1 kg, inertia: 0.01, at: [0.15, 0.1]}}
  rocker: {{mass: 1 kg, inertia: 0.01, at: [0.3, 0.05]}}
joints:
  a: {{type: revolute, bodies: [ground, crank], at: [0, 0]}}
  b: {{type: revolute, bodies: [crank, rod], at: [0, 0.1]}}
  c: {{type: revolute, bodies: [rod, rocker], at: [0.3, 0.1]}}
  d: {{type: revolute, bodies: [ground, rocker], at: [0.3, 0]}}
drives:
  motor: {{joint: a, position: "{motion}"}}
output: {{every: {every}}}
solver: {{end: 1, method: kinematic}}
"""


@pytest.mark.parametrize("every", [1e-3, 0.0123, 0.3])
def test_ends_where_branches_meet(every):
    """Cranks of equal length, lying flat: a parallelogram could fold there."""
    r = run(PARALLELOGRAM.format(every=every, motion="-pi*t"), fails=True)
    assert r.outcome.time == pytest.approx(0.5, abs=1e-3)
    assert "branches of the motion meet" in r.outcome.reason


def test_start_in_a_singular_position():
    flat = PARALLELOGRAM.replace("0, 0.1]", "0.1, 0]").replace("0.3, 0.1]", "0.4, 0]")
    with pytest.raises(ModelError, match=r"where the run begins.*'motor' at 0 rad.*singular"):
        run(flat.format(every=0.01, motion="t"))


FREE = """
bodies:
  rod: {{mass: 1 kg, inertia: 0.05, at: [0.2, 0]}}
  tip: {{mass: 1 kg, inertia: 0.05, at: [0.6, 0]}}
joints:
  hinge: {{type: revolute, bodies: [ground, rod], at: [0, 0]}}
  elbow: {{type: revolute, bodies: [rod, tip], at: [0.4, 0]}}
drives:
  motor: {{joint: hinge, position: "t"}}
{more}
solver: {{end: 1, method: kinematic{solver}}}
"""
ELBOW = "  bend: {joint: elbow, position: '0.1*t'"


@pytest.mark.parametrize(
    "more, solver, what",
    [
        ("", "", "1 is left: angle of 'elbow'"),
        (ELBOW + ", compliance: {stiffness: 10}}", "", "gives way"),
        (ELBOW + "}", ", stabilisation: none", "stabilisation"),
        (ELBOW + "}\nsensors: {x: {joint: hinge}}\n"
         "events: {e: {when: x, value: 0.5, do: {release: [elbow]}}}", "", "record or end"),
        (ELBOW + "}\nforces: {stop: {type: limit_stop, joint: elbow, upper: 1 rad,"
         " stiffness: 100}}", "", "contact"),
    ],
)  # fmt: skip
def test_refused(more, solver, what):
    with pytest.raises((ScenarioError, ModelError), match=what) as caught:
        run(FREE.format(more=more, solver=solver))
    print(caught.value)


def test_forces_with_corners():
    """A load that meets its corners by a sensor: steps end there, with pieces held as elsewhere."""
    more = """  lug: {type: applied_load, body: rocker, at: [0.4, 0.2], direction: [1, 0, 0],
        force: "max(0, 300*swing) + 20*min(1, 9*swing - 2)"}"""
    text = four_bar(every=0.004).replace("output:", f"{more}\noutput:")
    found, known = run(text), run(text.replace("method: kinematic", "method: dop853"))
    same(found, known)
    assert found.outcome.statistics["energy_residual_relative"] < 1e-5


@pytest.mark.parametrize("scene", [PLANE, SPACE], ids=["plane", "space"])
@pytest.mark.parametrize("motion", ["position: '20*t + 3*sin(5*t)'", "velocity: 5 + 6*sin(3*t)"])
def test_goes_on_to_the_last_bit(scene, motion, monkeypatch):
    """A checkpoint holds all that a row needs of those before it."""
    read = loads(four_bar(scene=scene, motion=motion, every=0.01))
    monkeypatch.setattr(simulation, "VISIT", 1)
    mechanism = assemble(read)
    blocks = [copied(block) for block in simulate(read, mechanism)]
    whole = np.vstack([rows for rows, _ in blocks])
    for k in (0, 3, len(blocks) // 2):
        again = [rows for rows, _ in map(copied, simulate(read, mechanism, blocks[k][1]))]
        part = np.vstack([rows for rows, _ in blocks[: k + 1]])
        assert np.array_equal(np.vstack([part, *again]), whole)


def copied(block):
    return block.rows.copy(), block.state


def test_far_away_and_turned():
    """The same mechanism 200 m from the origin, bodies and rows of joints in another order."""
    found, far = run(four_bar(every=0.01)), run(moved(four_bar(every=0.01), 200.0, -100.0))
    for name in ("motor.force", "swing", "d.reaction", "rod.angular_acceleration"):
        size = np.abs(found[name]).max()
        assert far[name] == pytest.approx(found[name], abs=1e-9 * size), name


def moved(text, x, y):
    """A planar scene with all its places moved."""
    place = re.compile(r"at: \[([-.0-9]+), ([-.0-9]+)\]")
    return place.sub(lambda m: f"at: [{float(m[1]) + x!r}, {float(m[2]) + y!r}]", text)


def test_force_that_is_no_number():
    text = four_bar(every=0.01).replace("20*cos(7*t)", "log(0.505 - t)")
    r = run(text, fails=True)
    assert "forces.wind" in r.outcome.reason and "log is taken of 0.505 - t" in r.outcome.reason
    assert np.all(np.isfinite(r.rows)) and r.t[-1] == pytest.approx(0.5)


def wrenches(r, row):
    """What joints put on the bodies at a row: forces, and moments about their centres."""
    bodies = {"crank": np.zeros(6), "rod": np.zeros(6), "rocker": np.zeros(6)}
    pairs = {"a": (None, "crank", [0, 0, 0]), "b": ("crank", "rod", [0.1, 0, 0]),
             "c": ("rocker", "rod", [0.4, 0.2, 0]), "d": (None, "rocker", [0.4, 0, 0])}  # fmt: skip
    drawn = {"crank": [0.05, 0, 0], "rod": [0.25, 0.1, 0], "rocker": [0.4, 0.1, 0]}
    for joint, (i, j, at) in pairs.items():
        f, m = r[f"{joint}.reaction"][row], r[f"{joint}.reaction_moment"][row]
        place = r[f"{j}.position"][row] + r[f"{j}.rotation"][row].reshape(3, 3) @ (
            np.array(at) - drawn[j]
        )
        for body, sign in ((i, -1.0), (j, 1.0)):
            if body:
                arm = place - r[f"{body}.position"][row]
                bodies[body] += sign * np.concatenate([f, m + np.cross(arm, f)])
    return np.concatenate(list(bodies.values()))


DOUBLE = SPACE | {"b": "revolute", "c": "revolute"}


def test_least_norm_of_redundant_rows():
    """Hinges in space repeat each other; what their rows carry is what it is by other methods."""
    more = {"scene": DOUBLE, "every": 0.0025}
    found, known = run(four_bar(**more)), run(four_bar("dop853", **more))
    assert len(found.mechanism.redundant) == 3 and found.mechanism.not_unique
    same(found, known, error=1e-7)
    for name in "abcd":
        for what in ("reaction", "reaction_moment"):
            one, other = found[f"{name}.{what}"], known[f"{name}.{what}"]
            np.testing.assert_allclose(one, other, atol=1e-6 * np.abs(other).max() + 1e-9)
    few_evaluations(found)


GAP = """
planar: {planar}
bodies:
  crank: {{mass: 1 kg, inertia: [0.01, 0.02, 0.03], at: [0, 0.25]}}
  rod: {{mass: 2 kg, inertia: [0.01, 0.02, 0.03], at: [0.5, 0.5]}}
  rocker: {{mass: 1 kg, inertia: [0.01, 0.02, 0.03], at: [1, 0.25]}}
joints:
  a: {{type: revolute, bodies: [ground, crank], at: [0, 0]}}
  b: {{type: spherical, bodies: [rod, crank], at: [0, 0.5]}}
  c: {{type: revolute, bodies: [rod, rocker], at: [{x}, 0.5]}}
  d: {{type: revolute, bodies: [ground, rocker], at: [1, 0]}}
drives:
  motor: {{joint: a, position: "2.6*sin(8*t)"}}
sensors: {{swing: {{joint: d}}}}
output: {{every: 0.028}}
solver: {{end: 0.6, method: kinematic}}
"""


@pytest.mark.parametrize("planar", ["true", "false"])
@pytest.mark.parametrize("off", [3e-3, 1e-4, 1e-6, -3e-3, -1e-4, -1e-6])
def test_branches_that_nearly_meet(off, planar):
    """Not quite a parallelogram: it turns sharply, or cannot get past; never straight on.

    In space rows across the plane depend on each other at the same place, and det J keeps its sign.
    """
    r = run(GAP.format(x=1 + off, planar=planar), fails=None)
    q = 2.6 * np.sin(8 * r.t)
    b = 0.5 * np.array([-np.sin(q), np.cos(q)])
    d = np.array([1.0, 0.0])[:, None] - b
    rod, rocker, far = 1 + off, np.hypot(off, 0.5), np.hypot(*d)
    along = (far**2 + rod**2 - rocker**2) / (2 * far)
    square = rod**2 - along**2
    assert np.all(square > -1e-12)  # a triangle, at all rows
    across = np.sqrt(np.maximum(square, 0.0))
    c = b + (along * d + across * np.array([-d[1], d[0]])) / far
    swing = np.arctan2(c[1], c[0] - 1) - np.arctan2(0.5, off)
    left = np.abs((r["swing"] - swing + np.pi) % (2 * np.pi) - np.pi)
    print(r.outcome.status, r.outcome.time, left.max())
    assert np.max(left * across) < 1e-9
    assert r.outcome.status == "done" or "singular" in r.outcome.reason


@pytest.mark.parametrize("scene", [PLANE, SPACE, DOUBLE], ids=["plane", "space", "double"])
@pytest.mark.parametrize("tolerance", [1e-6, 1e-8, 1e-11])
def test_extremes_between_rows_far_apart(scene, tolerance):
    """37 rows a turn: what the middles of steps show spares looks between rows; none is missed."""
    more = {"scene": scene, "tolerance": tolerance}
    found, known = (run(four_bar(every=every, **more)) for every in (8.5e-3, 1e-4))
    few_evaluations(found)
    sought = found.mechanism.model.sought
    named = {c.start + k: c.name for c in found.mechanism.columns for k in range(c.size)}
    units = {c.start + k: c.unit for c in found.mechanism.columns for k in range(c.size)}
    high, low = known.outcome.peaks[:, 0], known.outcome.peaks[:, 2]
    checked = 0
    for k in sought[sought < len(named)]:
        if named[k].startswith("energy") or shared(known, named[k]):
            continue
        kinds = ("N", "N*m") if units[k] == "N*m" else (units[k],)  # 1 N at 1 m is 1 N m
        most = max(abs(high[j] - low[j]) for j in sought if units.get(j) in kinds)
        allowed = tolerance * max(high[k] - low[k], 0.01 * most) + 1e-11 * most
        assert found.outcome.peaks[k, 0] == pytest.approx(high[k], abs=allowed), named[k]
        assert found.outcome.peaks[k, 2] == pytest.approx(low[k], abs=allowed), named[k]
        checked += 1
    assert checked > 10


@pytest.mark.parametrize("back", [0.3, 0.5, 1.7])
def test_works_of_quartic_powers(back):
    for n in range(5):
        p0, p, p1, q, q0 = (x**n for x in (0.0, 0.5, 1.0, -back, -2.0 * back))
        inside, whole = beyond_simpson.python((p0, p, p1, q, q0), back)
        by_half = (5.0 * p0 + 8.0 * p - p1) / 24.0 + inside
        assert by_half == pytest.approx(0.5 ** (n + 1) / (n + 1), abs=1e-14)
        assert (p0 + 4.0 * p + p1) / 6.0 + whole == pytest.approx(1.0 / (n + 1), abs=1e-14)


def test_rounding_is_no_extreme():
    """Both outer shafts turn evenly: their accelerations are rounding, and no extreme is sought."""
    steady = Path(__file__).parents[2] / "scenarios" / "validation" / "cardan_shaft.yaml"
    r = run(load(steady, ["solver.method=kinematic"]))
    assert np.abs(r["turn_out.acceleration"]).max() < 1e-10
    assert r.outcome.statistics["evaluations"] <= 2.1 * len(r.t)


@pytest.mark.parametrize("every", [8.5e-3, 1e-3])
def test_events(every):
    """Of an angle, a reaction and a power: where the dynamic analysis finds them."""
    events = """
events:
  swung: {when: swing, value: 0.3, crosses: both, do: {record: true}}
  pressed: {when: d.reaction.x, value: -20, crosses: both, do: {record: true}}
  pulled: {when: motor.power, value: 0, crosses: both, do: {record: true}}
"""
    text = four_bar(every=every)
    found, known = (run(a + events) for a in (text, four_bar("dop853", every=every)))
    assert len(found.events) == len(known.events) > 12
    assert found.events[:, 0] == pytest.approx(known.events[:, 0], abs=1e-10)
    end = "events: {late: {when: swing.rate, value: 12, do: {end: true}}}"
    assert run(text + end).outcome.time == pytest.approx(0.029849010372859, abs=1e-12)


def test_events_that_change_something_are_refused():
    for what in ("release: [d]", "set: {motor: {position: 0.1*t}}"):
        text = f"{four_bar()}events: {{late: {{when: swing, value: 0.3, do: {{{what}}}}}}}"
        with pytest.raises(ScenarioError, match="record or end a run alone"):
            run(text)
