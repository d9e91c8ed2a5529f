"""The thrust reverser in space: five chains and three actuators on one fairing.

Symmetries, balances, limits in which it is the planar one or a linear model of a fairing at rest.
"""

import json

import numpy as np
import pytest

from trsim.cli import main
from trsim.errors import ModelError
from trsim.scenario.load import load, loads
from trsim.sweeps.plan import plan

from ..linkages import REVERSER, spatial
from ..mechanisms import table
from ..runs import built, energy_error, run
from ..spatial import FEW_ROWS, NAMES, RIGID, at_speeds, done, peaks

MIRROR = {1: 5, 2: 4, 3: 3, 4: 2, 5: 1}
DOOR = ("door_angle", "door_angle.rate")
EQUAL = "parameters.uneven=0"
# steps of one length: those of adaptive methods follow rounding where stability limits them
FIXED = ("solver.method=rk4", "solver.step=1e-4")
FIRST = "solver.end=0.7"  # s, of the 1.2 s of the stroke


def apart(one, other):
    """Largest difference over the largest value."""
    return np.abs(one - other).max() / np.abs(other).max()


# --- symmetry --------------------------------------------------------------------------------


@pytest.mark.parametrize("settings", [FIXED, ("solver.tolerance=1e-9", FIRST)], ids=["rk4", "auto"])
def test_mirrored_chains_move_alike(settings):
    r = done(spatial(), EQUAL, *settings)
    for chain, mirrored in ((1, 5), (2, 4)):
        for channel in (*DOOR, "lug.normal_force"):
            assert apart(r[f"chain_{chain}_{channel}"], r[f"chain_{mirrored}_{channel}"]) < 1e-9
    left, right = r["actuator_1.reaction"], r["actuator_3.reaction"]
    assert apart(left * [1, -1, 1], right) < 1e-9
    # it is the gas load that makes them differ
    assert apart(at_speeds()["chain_1_door_angle"], at_speeds()["chain_5_door_angle"]) > 1e-6


def test_cases_of_actuator_3_mirror_those_of_actuator_1():
    one, three = (done(spatial(), EQUAL, *FIXED, f"parameters.speed_{k}=418 mm/s") for k in (1, 3))
    for k in (1, 2, 3):
        for channel in ("force", "stroke", "stroke_rate"):
            assert (
                apart(one[f"actuator_{k}.{channel}"], three[f"actuator_{4 - k}.{channel}"]) < 1e-9
            )
        reaction = one[f"actuator_{k}.reaction"] * [1, -1, 1]
        assert apart(reaction, three[f"actuator_{4 - k}.reaction"]) < 1e-9
    for chain, mirrored in MIRROR.items():
        for channel in (*DOOR, "air.magnitude", "lug.normal_force"):
            ours, theirs = one[f"chain_{chain}_{channel}"], three[f"chain_{mirrored}_{channel}"]
            assert apart(ours, theirs) < 1e-9, (chain, channel)
    assert apart(one["actuator_1.force"], three["actuator_1.force"]) > 0.01


def test_chains_on_an_ideal_guide_move_alike():
    text = spatial("drives: {actuator_1: null, actuator_3: null}", guided=True)
    r = done(text, EQUAL, "solver.tolerance=1e-9")
    for chain in (1, 2, 4, 5):
        for channel in DOOR:
            assert apart(r[f"chain_{chain}_{channel}"], r[f"chain_3_{channel}"]) < 1e-9
    assert r.largest("actuator_2.force")[0] == pytest.approx(4005, abs=10)


# --- actuators that do not give way ----------------------------------------------------------


@pytest.mark.parametrize("speed", ["420 mm/s", "418 mm/s"])
def test_rigid_actuators_on_an_ideal_guide_are_refused(speed):
    with pytest.raises(ModelError) as refused:
        built(loads(spatial(RIGID, guided=True), [f"parameters.speed_2={speed}"], folder=REVERSER))
    assert refused.value.path[:2] == ("drives", "actuator_2")
    assert "already fix" in str(refused.value) and "give it compliance" in str(refused.value)


# --- balance ---------------------------------------------------------------------------------


def placed(r, body, local):
    """World place of a point of a body, given in its axes from its centre of mass: (n, 3)."""
    return r[f"{body}.position"] + turned(r, body, local)


def turned(r, body, local):
    return np.einsum("tij,j->ti", r[f"{body}.rotation"].reshape(-1, 3, 3), local)


def from_outside(r):
    """Forces on the moving bodies from the ground and the air: [(place, force, moment)], (n, 3)."""
    read, still = r.scenario, np.zeros((len(r.t), 3))
    centre = np.array(read.bodies["fairing"].at)
    found = []
    for name in NAMES:
        end = placed(r, "fairing", np.array(read.drives[name].points[1]) - centre)
        found.append((end, r[f"{name}.reaction"], still))
    for name in ("rail_1_front", "rail_1_rear", "rail_2_front", "rail_2_rear"):
        slider = placed(r, "fairing", np.array(read.forces[name].at) - centre)
        found.append((slider, r[f"{name}.force"], r[f"{name}.moment"]))
    for chain in MIRROR:
        air = placed(r, f"chain_{chain}_door", [-0.129056 + 0.144634, 0.235081 - 0.235897, 0])
        found.append((air, r[f"chain_{chain}_air.load"], still))
        support = still + read.joints[f"chain_{chain}_A"].at
        reaction, moment = r[f"chain_{chain}_A.reaction"], r[f"chain_{chain}_A.reaction_moment"]
        found.append((support, reaction, moment))
    return found


def inertial(r):
    """Rates of momentum and of angular momentum about the origin of all moving bodies: (n, 3)."""
    P, L = 0.0, 0.0
    frames, model = r.mechanism.frames, r.mechanism.model
    for body in r.scenario.bodies:
        R = r[f"{body}.rotation"].reshape(-1, 3, 3)
        inertia = R @ model.inertia[frames[body]].reshape(3, 3) @ R.transpose(0, 2, 1)
        omega, alpha = r[f"{body}.angular_velocity"], r[f"{body}.angular_acceleration"]
        force = model.mass[frames[body]] * r[f"{body}.acceleration"]
        spin = np.einsum("tij,tj->ti", inertia, omega)
        P = P + force
        L = L + np.cross(r[f"{body}.position"], force) + np.cross(omega, spin)
        L = L + np.einsum("tij,tj->ti", inertia, alpha)
    return P, L


@pytest.mark.parametrize("slow", [420, 418])
def test_forces_are_mass_times_acceleration(slow):
    """Of all bodies together, of every row of the run: X, Y, Z and about the origin."""
    r = at_speeds(speed_2=slow)
    assert len(r.scenario.bodies) == 16
    outside = from_outside(r)
    force = sum(F for _, F, _ in outside)
    moment = sum(np.cross(p, F) + M for p, F, M in outside)
    P, L = inertial(r)
    largest = max(np.abs(F).max() for _, F, _ in outside)
    assert np.abs(force - P).max() < 1e-8 * largest
    assert np.abs(moment - L).max() < 1e-8 * largest  # arms are of 1 m
    assert np.abs(P).max() > 10  # something was accelerated


@pytest.mark.parametrize("slow", [420, 418])
def test_reactions_across_the_stroke_are_small(slow):
    r = at_speeds(speed_2=slow)
    for name in NAMES:
        x, y, z = np.abs(r[f"{name}.reaction"]).max(axis=0)
        assert 0.0 < max(y, z) < 0.01 * x
        assert r[f"{name}.force"] == pytest.approx(-r[f"{name}.reaction"][:, 0], rel=1e-5, abs=1e-3)


# --- one chain is the planar mechanism ---------------------------------------------------------

ONE = """
drives:
  actuator_1: null
  actuator_2: null
  actuator_3: null
  actuator: {{joint: guide, velocity: 0.5 m/s, sign: -1}}
initial: {{equilibrium: [chain_{}_B]}}
"""
TIGHT = ("solver.tolerance=1e-10", "solver.end=1 s", "output.every=1 ms")


@pytest.mark.parametrize("chi", [0, 36])
def test_one_chain_is_the_planar_mechanism(chi):
    flat = run(load(REVERSER / "ideal.yaml", TIGHT))
    one = {0: 3, 36: 4}[chi]
    r = done(spatial(ONE.format(one), [one], guided=True), EQUAL, *TIGHT)
    assert not r.mechanism.planar and flat.mechanism.planar
    e_r = np.array([0, np.sin(np.radians(chi)), np.cos(np.radians(chi))])
    e_t = np.cross([1, 0, 0], e_r)
    ours, theirs = r[f"chain_{one}_B.reaction"], flat["B.reaction"]
    assert r.t == pytest.approx(flat.t, abs=1e-12)
    for mine, its, scale in (
        (r["actuator.force"], flat["actuator.force"], 800),
        (r[f"chain_{one}_door_angle"], flat["door_angle"], 1),
        (r[f"chain_{one}_lug.normal_force"], flat["lug.normal_force"], 800),
        (ours[:, 0], theirs[:, 0], 800), (ours @ e_r, theirs[:, 1], 800), (ours @ e_t, 0, 800),
    ):  # fmt: skip
        assert np.abs(mine - its).max() < 1e-6 * scale


# --- the synchronising shaft -------------------------------------------------------------------

SHAFT = REVERSER / "spatial_shaft.yaml"


def with_shaft(case, *sets):
    """A case of the scenario with the shaft."""
    planned = plan(SHAFT, (FEW_ROWS, *sets))
    (found,) = (c for c in planned.cases if c.name == case)
    r = run(planned.scenario(found))
    assert energy_error(r) < 1e-8
    return r


def test_shaft_between_prescribed_speeds_only_tells_its_torque():
    tight = "solver.tolerance=1e-8"
    r, without = (
        with_shaft("prescribed", tight),
        done(spatial(), "parameters.speed_2=418 mm/s", tight),
    )
    expected = 0.53 * 754 * 2e-3 * r.t
    assert r["shaft_1_3.torque_1"] == pytest.approx(-expected, abs=1e-9)
    assert r["shaft_1_3.torque_2"] == pytest.approx(expected, abs=1e-9)
    assert np.interp(2.26e-3, r["shaft_1_3.difference"], expected) == pytest.approx(0.90, abs=0.005)
    for name in without.place:
        if not name.startswith("energy."):
            # works of the shaft have a say in the steps: the same to the tolerance, which rails
            # and lines enlarge in accelerations
            scale = np.abs(without[name]).max()
            assert np.abs(r[name] - without[name]).max() <= 1e-4 * max(scale, 1.0), name


def test_shaft_takes_its_share_of_the_difference():
    """The stiffer it is, the less the rails are strained: by as much as at rest."""
    predicted = table("spatial_reverser_shaft.csv")[:, 1]
    cases = [with_shaft(case, "parameters.speed_2=422 mm/s")
             for case in ("without", "softer", "active", "stiffer")]  # fmt: skip
    forces = np.array([peaks(r).max() for r in cases])
    assert forces[0] == pytest.approx(peaks(at_speeds(speed_2=422)).max(), rel=1e-3)
    assert forces[0] - forces == pytest.approx(predicted[0] - predicted, abs=5)
    differences = [r["shaft_1_3.difference"][-1] for r in cases]
    assert (np.diff(differences) < 0).all()


def test_a_stalled_actuator_ends_the_run_as_jammed(tmp_path, capsys):
    sets = ("--set", "drives.actuator_2.stall=1500 N", "--set", "output.every=10 ms")
    with pytest.raises(SystemExit) as ended:
        main(["run", str(SHAFT), *sets, "-o", str(tmp_path / "x.h5"), "--json", "-q"])
    (told,) = json.loads(capsys.readouterr().out)["runs"]
    assert ended.value.code == 0 and told["status"] == "jammed"
    assert "actuator_2" in told["reason"]
