"""Surfaces and balls are drawn where they are, and touch where the run says they do."""

import numpy as np
import pytest

from trsim.report.animation.shoot import shoot
from trsim.report.animation.touched import touched

from .filmed import closed, made, of, seen, validation

SHAPES = {
    "plane": "shape: plane",
    "sphere": "shape: sphere, radius: 0.2",
    "bowl": "shape: sphere, radius: 0.6, hollow: true",
    "cylinder": "shape: cylinder, radius: 0.2",
    "hole": "shape: cylinder, radius: 0.6, hollow: true",
    "profile": "shape: profile, points: [[-1, -0.1], [1, -0.1], [1, 0.1], [-1, 0.1]], closed: true",
    "notch": "shape: profile, closed: true, points: [[-1, -0.4], [1, -0.4], [1, 0.1], [0.5, 0.1], "
    "[0, -0.1], [-0.5, 0.1], [-1, 0.1]]",
    "plate": "shape: profile, points: [[-1, 0.1], [1, 0.1]]",
}
TEXT = """
planar: {planar}
bodies: {{ball: {{mass: 1, inertia: [1e-3, 1e-3, 1e-3], at: [0, 0.35, 0], velocity: [0.2, -1, 0]}}}}
forces:
  meets: {{type: surface_contact, surface: {{body: ground, {shape}}},
          ball: {{body: ball, at: [0, 0.35, 0], radius: {radius}}}}}
contact_laws: {{law: {{normal: impact, stiffness: 1e7, damping: 10, ramp: 1e-3}}}}
solver: {{end: 0.3}}
"""


@pytest.mark.parametrize("shape", SHAPES)
@pytest.mark.parametrize("planar", ["true", "false"])
def test_every_shape_is_drawn(shape, planar, tmp_path):
    run = of(tmp_path, text=TEXT.format(planar=planar, shape=SHAPES[shape], radius=0.1))
    _, _, things = made(run, touched)
    assert set(things) == {"meets ground", "meets ball"}
    for thing in things.values():
        for mesh, _ in thing.pieces:
            closed(mesh)
    assert shoot(run, 1.0).glb


def test_a_roller_is_drawn_on_its_box(tmp_path):
    run = validation(tmp_path, "roller_over_a_box")
    _, _, things = made(run, touched)
    box = seen(things["box ground"], things["box ground"].pieces[0][0].points)[0]
    assert box[:, :2].min(axis=0) == pytest.approx([-0.25, -0.1], abs=1e-4)
    assert box[:, :2].max(axis=0) == pytest.approx([0.1, 0.03], abs=1e-4)
    roller = seen(things["box roller"], things["box roller"].pieces[0][0].points)
    lowest = roller[0, :, 1].min()
    assert lowest == pytest.approx(0.03, abs=1e-3)
    middle = 0.5 * (roller.min(axis=1) + roller.max(axis=1))
    assert np.ptp(middle[:, 0]) == pytest.approx(0.311, abs=1e-3)


def test_a_point_is_drawn_too(tmp_path):
    text = TEXT.format(planar="true", shape="shape: sphere, radius: 0.2", radius=0)
    run = of(tmp_path, text=text)
    _, _, things = made(run, touched)
    assert np.ptp(things["meets ball"].pieces[0][0].points, axis=0).max() > 0.0


def test_an_outline_is_drawn_with_its_round_edge(tmp_path):
    run = validation(tmp_path, "cam_flat_contact", "solver.end=0.1", "output.every=5 ms")
    _, _, things = made(run, touched)
    for thing in things.values():
        closed(thing.pieces[0][0])
    face = seen(things["face tappet"], things["face tappet"].pieces[0][0].points)[0]
    assert face[:, 0].min() == pytest.approx(-0.017, abs=1e-4)
    assert face[:, 0].max() == pytest.approx(0.017, abs=1e-4)
    assert face[:, 1].min() == pytest.approx(0.03, abs=1e-4)
    assert face[:, 1].max() == pytest.approx(0.04, abs=1e-4)
