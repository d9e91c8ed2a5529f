"""Every scenario of the repository opens with its expected answer and runs."""

from pathlib import Path

import numpy as np
import pytest
from scipy.special import ellipk

from trsim.scenario.load import load

from .runs import energy_error, run

FOLDER = Path(__file__).parent.parent / "scenarios"
PARTS = ("mechanism.yaml", "spatial_mechanism.yaml", "paper.yaml")  # of scenarios, not one each
FILES = sorted(p for p in FOLDER.rglob("*.yaml") if p.name not in PARTS)
VALIDATION = FOLDER / "validation"


def test_every_scenario_says_what_to_expect():
    for path in FILES:
        assert path.read_text().startswith("# "), path


@pytest.mark.parametrize("path", FILES, ids=lambda p: f"{p.parent.name}/{p.stem}")
def test_runs_for_a_while(path):
    """A tenth of the long runs, all of the short ones."""
    end = load(path).solver.end
    part = 0.1 if path.parent.name == "thrust_reverser" or path.stem == "beam_spin_up" else 1.0
    r = run(load(path, [f"solver.end={part * end!r}", f"output.every={end / 1000!r}"]))
    assert r.outcome.status == "done"
    assert np.isfinite(r.rows).all()
    assert energy_error(r) < 1e-4


def test_conical_pendulum():
    r = run(load(VALIDATION / "pendulum_3d.yaml"))
    assert r["ball.position"][:, 2] == pytest.approx(-0.8660254, abs=1e-7)
    assert r["ball.position"][-1] == pytest.approx([0.5, 0.0, -0.8660254], abs=1e-5)


def test_slider_crank_in_space():
    r = run(load(VALIDATION / "slider_crank_3d.yaml"))
    assert len(r.mechanism.redundant) == 3 and not r.mechanism.planar
    a = 10.0 * r.t
    x = 0.05 * np.cos(a) + np.sqrt(0.12**2 - (0.05 * np.sin(a)) ** 2)
    assert r["slider.position"][:, 0] == pytest.approx(x, abs=1e-8)


def test_four_bar_in_space():
    r = run(load(VALIDATION / "four_bar_3d.yaml"))
    assert len(r.mechanism.redundant) == 3 and not r.mechanism.planar
    assert energy_error(r) < 1e-6
    b = r["crank.position"] * 2.0
    c = 2.0 * r["rocker.position"] - [0.3, 0.0, 0.0]
    assert np.linalg.norm(c - b, axis=1) == pytest.approx(0.3, abs=1e-5)


def test_screw_jack():
    """A thread without friction: 2 pi T = p F."""
    r = run(load(VALIDATION / "screw_jack.yaml", ["output.channels=['*']"]))
    assert r.mechanism.mobility == 0 and len(r.mechanism.redundant) == 4
    assert r["height"] == pytest.approx(6e-3 * r["turn"] / (2 * np.pi), abs=1e-9)
    lift = 100 * (9.81 + r["table.acceleration"][:, 2])
    torque = r["crank.force"] + 0.004 * r["spindle.angular_acceleration"][:, 2]
    assert 2 * np.pi * torque == pytest.approx(6e-3 * lift, abs=1e-6)
    assert r["crank.force"][-1] == pytest.approx(0.9368, abs=1e-4)


def test_kitchen_door():
    r = run(load(VALIDATION / "kitchen_door.yaml", ["output.channels=['*']"]))
    m = r.mechanism
    assert (m.mobility, m.mobility_by_count) == (1, -4)
    assert len(m.redundant) == 5 and {row.split(".")[0] for row in m.redundant} <= {"bottom", "top"}
    rate = np.sqrt(12 * 9.81 * np.sin(np.deg2rad(5)) * 0.3 / (0.36 + 12 * 0.09))
    period = 4 * ellipk(np.sin(np.deg2rad(20)) ** 2) / rate
    assert (period, 2 * np.pi / rate) == pytest.approx((4.4323, 4.2977), abs=1e-4)
    assert r["opening"][0] == pytest.approx(np.deg2rad(40), abs=1e-9)
    again = np.interp(period, r.t, r["opening"])
    assert again == pytest.approx(np.deg2rad(40), abs=1e-5)
    both = r["bottom.reaction"] + r["top.reaction"]
    g = 9.81 * np.array([np.sin(np.deg2rad(5)), 0, -np.cos(np.deg2rad(5))])
    assert both == pytest.approx(12 * (r["door.acceleration"] - g), abs=1e-6)


@pytest.mark.parametrize("name, c", [("cardan_shaft", 1.0), ("cardan_shaft_phase_error", None)])
def test_cardan_shaft(name, c):
    """tan(out) = c tan(in), by the phase of the forks."""
    c = c or np.cos(np.deg2rad(25)) ** 2
    r = run(load(VALIDATION / f"{name}.yaml"))
    turn = r["turn_in"]
    assert turn[-1] == pytest.approx(6 * np.pi, abs=1e-7) and r.mechanism.mobility == 0
    out = np.unwrap(np.arctan2(c * np.sin(turn), np.cos(turn)))
    assert r["turn_out"] == pytest.approx(out, abs=1e-7)
    ratio = r["turn_out.rate"] / r["turn_in.rate"]
    assert ratio == pytest.approx(c / (np.cos(turn) ** 2 + (c * np.sin(turn)) ** 2), abs=1e-7)
    assert (ratio.min(), ratio.max()) == pytest.approx((c, 1 / c), abs=1e-3)


def test_planetary_gear():
    r = run(load(VALIDATION / "planetary_gear.yaml"))
    assert r.mechanism.planar and r.mechanism.mobility == 0
    rate = r["sun_angle.rate"]
    assert rate[-1] == pytest.approx(300.0)
    assert r["carrier_angle.rate"] == pytest.approx(2 / 7 * rate, abs=1e-11 * 300)
    assert r["planet_angle.rate"] + r["carrier_angle.rate"] == pytest.approx(
        -2 / 3 * rate, abs=1e-11 * 300
    )
    for name, ratio in (("carrier_angle", 2 / 7), ("planet_angle", -20 / 21)):
        assert np.abs(r[name] - ratio * r["sun_angle"]).max() < 1e-12 * r["sun_angle"].max()
    steady = r.t > 0.5
    assert r["motor.force"][steady] == pytest.approx(2 / 7 * 35, rel=1e-7)
    # all on the ring together: torques on the carrier, the second body of its bearing
    ring = sum(r[f"outer{k}.torque_1"] for k in (1, 2, 3))[steady]
    sun = sum(r[f"inner{k}.torque_2"] for k in (1, 2, 3))[steady]
    assert -ring == pytest.approx(-5 / 7 * 35, rel=1e-7)
    assert np.abs(sun).max() > 1.0


def test_differential():
    r = run(load(VALIDATION / "differential.yaml"))
    assert r.mechanism.mobility == 2 and not r.mechanism.planar
    case, left, right = (r[f"{name}.angular_velocity"][:, 2] for name in ("case", "left", "right"))
    assert case == pytest.approx((left + right) / 2, abs=1e-10)
    # pinions turn at half the difference; their mass goes round with the case
    about = 0.03 + 2 * (0.2 * 0.04**2 + 3e-5)
    spin = 2 * 4e-5
    M = 0.02 * np.eye(2) + about / 4 * np.ones((2, 2)) + spin / 4 * np.array([[1, -1], [-1, 1]])
    rates = np.linalg.solve(M, [10.0 - 4.0, 10.0])
    assert np.stack([left, right]) == pytest.approx(np.outer(rates, r.t), abs=1e-7)
    assert r["left_angle"] == pytest.approx(-r["right_angle"], abs=1e-10)


def test_rack_and_pinion():
    r = run(load(VALIDATION / "rack_and_pinion.yaml"))
    assert r["stroke"] == pytest.approx(-7 * r.t**2 / 2, abs=1e-7)
    assert np.abs(r["angle"] * 0.05 - r["stroke"]).max() < 1e-12
    assert r["teeth.force_2"] == pytest.approx(5.62, rel=1e-6)
    assert r["teeth.torque_1"] == pytest.approx(-5.62 * 0.05, rel=1e-6)


def periodic(*sets):
    """The points of the section `turn`, and how far those of every second turn lie apart, m."""
    points = run(load(VALIDATION / "slider_crank_periodic.yaml", [*sets])).section("turn")[:, 1:]
    assert len(points) == 31
    return points, max(np.ptp(points[k::2], axis=0).max() for k in range(2))


@pytest.mark.parametrize("tolerance", ["1e-6", "1e-7"])
def test_slider_crank_of_period_two(tolerance):
    points, apart = periodic(f"solver.tolerance={tolerance}")
    assert apart < 1e-11
    assert points[-2] == pytest.approx([311.15e-6, 18.92e-6], abs=1e-8)
    assert points[-1] == pytest.approx([312.03e-6, -4.81e-6], abs=1e-8)


@pytest.mark.parametrize("tolerance", ["1e-6", "7e-7", "1e-7"])
def test_slider_crank_of_other_periods(tolerance):
    """0.05 mm: all points are one; 0.0625 mm: four; 0.35 mm: none comes again.

    Between 0.075 mm and 0.2 mm motions of several periods are stable side by side, and a long
    irregular beginning leads to one of them: to which, rounding decides.  At these two there is
    one, reached within 30 turns; steps alone leave 2e-11 m between turns.
    """
    sets = f"solver.tolerance={tolerance}"
    points, apart = periodic("joints.pin.clearance=0.05 mm", sets)
    assert np.ptp(points, axis=0).max() < 1e-10
    points, apart = periodic("joints.pin.clearance=0.0625 mm", sets)
    again = {k: np.abs(points[k:] - points[:-k])[-8:].max() for k in (1, 2, 4)}
    assert again[4] < 1e-9 and again[2] > 1e-6 and again[1] > 1e-6
    points, apart = periodic("joints.pin.clearance=0.35 mm", sets)
    assert apart > 1e-4
    assert np.hypot(*points.std(axis=0)) == pytest.approx(1.4e-4, rel=0.3)


def test_the_readme_scenario_runs(tmp_path):
    text = (FOLDER.parent / "README.md").read_text()
    block = text.split("```yaml")[1].split("```")[0]
    (tmp_path / "slider_crank.yaml").write_text(block)
    r = run(load(tmp_path / "slider_crank.yaml", ["solver.end=1 ms"]))
    assert r.outcome.status == "done"


def test_a_point_of_a_coupler():
    r = run(load(VALIDATION / "coupler_point.yaml"))
    a = 10.0 * r.t
    b = np.arcsin(50.0 / 120.0 * np.sin(a))
    b_dot = 10.0 * (50.0 / 120.0) * np.cos(a) / np.cos(b)
    s = np.array([0.08 * np.cos(b) + 0.03 * np.sin(b), 0.03 * np.cos(b) - 0.08 * np.sin(b)])
    v = 0.5 * np.array([-np.sin(a), np.cos(a)]) - b_dot * np.array([-s[1], s[0]])
    there = 0.05 * np.array([np.cos(a), np.sin(a)]) + s
    assert r["tracer.position"][:, :2] == pytest.approx(there.T, abs=1e-8)
    assert r["tracer.velocity"][:, :2] == pytest.approx(v.T, abs=1e-7)
    # the derivative of v by hand, from b'' = (b'^2 sin b - 100 (50/120) sin a)/cos b
    b_ddot = (b_dot**2 * np.sin(b) - 100.0 * (50.0 / 120.0) * np.sin(a)) / np.cos(b)
    turned = np.array([-s[1], s[0]])
    acceleration = -5.0 * np.array([np.cos(a), np.sin(a)]) - b_ddot * turned - b_dot**2 * s
    assert r["tracer.acceleration"][:, :2] == pytest.approx(acceleration.T, abs=1e-5)
    assert r["tracer.acceleration"][0] == pytest.approx([-6.388889, -0.520833, 0.0], abs=1e-6)


def test_a_four_bar_begun_by_one_rate():
    r = run(load(VALIDATION / "four_bar_one_rate.yaml"))
    assert r["coupler.velocity"][0] == pytest.approx([-10.0, 0.0, 0.0], abs=1e-9)
    assert r["coupler.angular_velocity"][0, 2] == pytest.approx(0.0, abs=1e-9)
    assert r["rocker.angular_velocity"][0, 2] == pytest.approx(5.0, abs=1e-9)
    assert r["energy.kinetic"] == pytest.approx(81.25, rel=1e-6)


def test_what_a_rod_carries_at_a_station():
    r = run(load(VALIDATION / "rod_section.yaml"))
    x, w, a = 0.4, 20 + 30 * r.t, 30.0
    # on the part beyond: inwards, against the normal, and forwards
    force = np.outer(w**2, [0, 0, x**2 - 1]) + a * np.array([1 - x**2, 0, 0])
    assert r["cut.force"] == pytest.approx(force, rel=1e-9, abs=1e-9)
    moment = 2 * a * (1 / 3 - x / 2 + x**3 / 6)
    # y of the section is z x x = (1, 0, 0) x (0, 1, 0), the z of the world
    assert r["cut.moment"][:, 1] == pytest.approx(np.full(r.t.size, moment), rel=1e-9)
    assert not r["cut.moment"][:, [0, 2]].any()
    told = [abs(r["cut.force"][-1, 2]), r["cut.shear"][-1], r["cut.bending"][-1]]
    assert told == pytest.approx([1029.0, 25.2, 8.64], rel=1e-9)
