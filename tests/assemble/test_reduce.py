"""Planar reduction, redundant rows and mobility: what is not solved, and that it is told."""

import numpy as np
import pytest

from trsim.assemble.reduce import jacobian, moves, roots, weights
from trsim.assemble.redundant import SAMPLES, nearby
from trsim.errors import ModelError
from trsim.scenario.load import load

from ..elements.bench import bench, matrix
from ..linkages import DOOR, REVERSER, flat_parallelogram, four_bar, slider_crank
from ..runs import assemble, built, run

# every planar element there is: springs, stops, loads, a compliant drive and a sensor
LOADED = """
gravity: [1, -9.81]
drives: {motor: {joint: A, velocity: 3 + t, compliance: {stiffness: 500, damping: 5}}}
sensors: {turn: {joint: C}, stroke: {joint: track}}
forces:
  coil: {type: torsion_spring, joint: B, stiffness: 4, damping: 0.1, preload: 1}
  spring: {type: spring_damper, bodies: [ground, rod], points: [[0, 1], [1, 0]], stiffness: 50}
  stop: {type: limit_stop, joint: track, lower: -0.1, stiffness: 1e4, damping: 20, ramp: 1 mm}
  load: {type: applied_load, body: slider, at: [1.25, 0.1], frame: rod, direction: [1, 1],
         force: 3*t - turn}
"""


def test_planar_run_is_the_spatial_run():
    tight = "solver.tolerance=1e-12"
    flat, space = (run(slider_crank(p, LOADED), tight) for p in ("true", "false"))
    assert flat.mechanism.planar and not space.mechanism.planar
    assert flat.mechanism.model.n_v == 9 and space.mechanism.model.n_v == 18
    assert flat["stop.normal_force"].max() > 1.0
    for name in ("turn", "stroke", "slider.position", "rod.velocity", "rod.angular_velocity"):
        assert flat[name] == pytest.approx(space[name], abs=1e-9), name
    for name in ("A.reaction", "B.reaction", "C.reaction"):
        scale = np.abs(space[name]).max()
        assert flat[name][:, :2] == pytest.approx(space[name][:, :2], abs=1e-6 * scale), name
    # and nothing leaves the plane by itself
    assert np.abs(space["rod.position"][:, 2]).max() < 1e-12


@pytest.mark.parametrize("linkage", [four_bar, slider_crank])
def test_three_redundant_rows_of_a_planar_loop_in_space(linkage):
    m = built(linkage())
    assert m.mobility == 1
    assert len(m.redundant) == 3 and not m.singular
    assert all(name.split(".")[0] in ("A", "B", "C", "D", "track") for name in m.redundant)
    # moments go before forces, and what is left in the plane is unique
    assert all(name.split(".")[1].startswith(("tilt", "turn")) for name in m.redundant)
    assert {"A.x", "A.y", "B.x", "C.y"}.isdisjoint(m.not_unique)
    assert {"A.z", "A.tilt 1", "B.tilt 2"} <= set(m.not_unique)


@pytest.mark.parametrize("linkage", [four_bar, slider_crank])
def test_nothing_is_redundant_in_the_plane(linkage):
    m = built(linkage("true"))
    assert (m.mobility, m.redundant, m.singular, m.not_unique) == (1, (), (), ())


def test_spatial_slider_crank_moves_as_it_must():
    r = run(slider_crank("false", "drives: {motor: {joint: A, velocity: 5}}"))
    angle = np.radians(30) + 5 * r.t
    stroke = 0.3 * np.cos(angle) + np.sqrt(1 - (0.3 * np.sin(angle)) ** 2)
    assert r["slider.position"][:, 0] == pytest.approx(stroke, abs=1e-9)


def test_door_on_two_hinges():
    m = built(DOOR)
    assert m.mobility == 1 and len(m.redundant) == 5
    # the horizontal pair is statically determined, but shared moments are not
    r = run(DOOR)
    assert r["top.reaction"] + r["bottom.reaction"] == pytest.approx(
        np.tile([0, 0, 10.0], (len(r.t), 1)), abs=1e-9
    )


def test_parallelogram_lying_flat_is_singular_and_not_redundant():
    m = built(flat_parallelogram())
    assert len(m.singular) == 1 and not m.redundant
    assert len(m.rows) == 8
    m = built(flat_parallelogram("false"))
    assert len(m.redundant) == 3 and m.singular


@pytest.mark.parametrize("planar", ["true", "false"])
def test_parallelogram_leaves_the_flat_position_on_its_branch(planar):
    more = "drives: {motor: {joint: A, velocity: 1}}\nsensors: {swing: {joint: D}}"
    # extremes of forces are chance at a flat place, and are sought for long
    told = "output.channels=[swing, coupler.position]"
    r = run(flat_parallelogram(planar, more, end=0.3), told)
    assert r["swing"] == pytest.approx(-r.t, abs=1e-7)
    assert r["coupler.position"][:, 1] == pytest.approx(np.sin(r.t), abs=1e-7)


def test_positions_judged_are_near_the_drawing():
    """A perturbed position is closed again and not far from where it started."""
    model = built(slider_crank()).model
    y = built(slider_crank()).y0
    found = list(nearby(model, y, moves(model, False), list(range(model.m))))
    assert len(found) == SAMPLES
    for near in found:
        assert np.abs(jacobian(model, 0.0, near)[0]).max() < 1e-9
        moved = np.abs(near - y)[: model.n_q].reshape(-1, 7)
        assert 1e-4 < moved[:, :3].max() < 0.3 * model.size
        assert moved[:, 3:].max() < 0.3  # half an angle


def test_mobility_in_a_dead_centre_is_that_around_it():
    m = built(flat_parallelogram(more="drives: {motor: {joint: A, velocity: 1}}"))
    assert (m.mobility, m.mobility_by_count, len(m.singular)) == (0, 0, 1)


def test_mobility_of_the_reverser():
    ideal = load(REVERSER / "ideal.yaml")
    assert assemble(ideal).mobility == 1
    assert assemble(ideal, drives={}).mobility == 2
    for name, playing in (("clearance_a_0.3mm", 1), ("clearance_ab_0.3mm", 2)):
        m = assemble(load(REVERSER / f"{name}.yaml"))
        assert m.planar and not m.planar_assumed
        assert m.mobility == 1 + 2 * playing


@pytest.mark.parametrize("planar", ["true", "false"])
def test_each_clearance_adds_two(planar):
    law = (
        "contact_laws: {law: {normal: flores, stiffness: 1e6, bearing_radius: 0.1, restitution: 1}}"
    )
    one = built(slider_crank(planar, law), "joints.C.clearance=1mm")
    two = built(slider_crank(planar, law), "joints.C.clearance=1mm", "joints.B.clearance=1mm")
    none = built(slider_crank(planar, law), "joints.C.clearance=0mm")
    assert (none.mobility, one.mobility, two.mobility) == (1, 3, 5)
    count = none.mobility_by_count
    assert (one.mobility_by_count, two.mobility_by_count) == (count + 2, count + 4)
    assert count == (1 if planar == "true" else -2)


def test_planar_motion_assumed_is_said():
    m = built("bodies: {disc: {mass: 1, inertia: 1}}")
    assert m.planar and m.planar_assumed and "planar motion assumed" in m.notes[0]
    m = built("bodies: {disc: {mass: 1, inertia: 1}}", "planar=true")
    assert m.planar and not m.notes


@pytest.mark.parametrize(
    "load",
    ["direction: [0, 0, 1], force: 1", "direction: [1, 0, 0], torque: 1",
     "at: [0, 0, 1], direction: [1, 0, 0], force: 1"],
)  # fmt: skip
def test_loads_out_of_the_plane_make_a_scene_spatial(load):
    text = """
bodies: {{disc: {{mass: 1, inertia: {}}}}}
forces: {{f: {{type: applied_load, body: disc, {}}}}}
"""
    assert not built(text.format("[1, 1, 1]", load)).planar
    with pytest.raises(ModelError) as caught:
        built(text.format("1", load))
    assert caught.value.path == ("bodies", "disc", "inertia")


def test_planar_true_is_refused_out_of_the_plane():
    with pytest.raises(ModelError) as caught:
        built(DOOR.replace("planar: false", "planar: true"))
    assert caught.value.path == ("planar",)


PARALLELOGRAM = """
parameters: {{x: {length}*cos({angle}), y: {length}*sin({angle})}}
bodies:
  c1: {{mass: 1, inertia: 0.1, at: [x/2, y/2]}}
  c2: {{mass: 1, inertia: 0.1, at: [1 + x/2, y/2]}}
  c3: {{mass: 1, inertia: 0.1, at: [2 + x/2, y/2]}}
  bar: {{mass: 1, inertia: 0.1, at: [1 + x, y]}}
joints:
  a1: {{type: revolute, bodies: [ground, c1], at: [0, 0]}}
  a2: {{type: revolute, bodies: [ground, c2], at: [1, 0]}}
  a3: {{type: revolute, bodies: [ground, c3], at: [2 + {off}, 0]}}
  b1: {{type: revolute, bodies: [c1, bar], at: [x, y]}}
  b2: {{type: revolute, bodies: [c2, bar], at: [1 + x, y]}}
  b3: {{type: revolute, bodies: [c3, bar], at: [2 + x, y]}}
drives: {{{drive}}}
"""


@pytest.mark.parametrize("drive", ["", "motor: {joint: a1, velocity: 1}"])
@pytest.mark.parametrize("off", [0.0, 1e-10, 1e-9])
@pytest.mark.parametrize(("length", "angle"), [(1, 0.3), (1, 0.785), (0.2, 0.3), (0.02, 1.2)])
def test_a_parallelogram_of_three_cranks_moves(length, angle, off, drive):
    """One row too many; the rest of the positions judged are on the same branch."""
    text = PARALLELOGRAM.format(length=length, angle=angle, off=f"{off * length:.1e}", drive=drive)
    m = built(text)
    assert (m.mobility, m.mobility_by_count) == ((0, -1) if drive else (1, 0))
    assert len(m.redundant) == 1 and not m.singular


def test_units_and_roots_of_masses_against_world_axes_rates():
    """C C^T is the inverse of the mass matrix; turns count by a body's radius of gyration."""
    b = bench("", np.random.default_rng(3))
    model, y = b.mechanism.model, b.state()
    own = model.inertia[1:].reshape(-1, 3, 3)
    C, units = roots(model, y, False), weights(model).reshape(-1, 6)
    for k, (mass, trace) in enumerate(((2.0, 0.09), (3.0, 0.12))):
        R = matrix(b.p[1 + k])
        inverse = np.zeros((6, 6))
        inverse[:3, :3] = np.eye(3) / mass
        inverse[3:, 3:] = R @ np.linalg.inv(own[k]) @ R.T
        assert C[k] @ C[k].T == pytest.approx(inverse, abs=1e-10 * np.abs(inverse).max())
        arm = np.sqrt(trace / mass)
        assert units[k] == pytest.approx([1.0, 1.0, 1.0, 1 / arm, 1 / arm, 1 / arm])
