"""Cams, slots and wires: followers touch what is drawn of their curves, in every frame."""

import numpy as np
import pytest

from trsim.report.animation import curves, turns
from trsim.report.animation.guides import outline
from trsim.report.animation.motion import motion

from .filmed import closed, made, of, seen, staged, validation, volume

# an eccentric circle inside of which a roller runs, on a cam that moves itself
INSIDE = """
bodies:
  arm: {mass: 1, inertia: 0.1, at: [0.5, 0]}
  ring: {mass: 1, inertia: 0.1, at: [1, 0]}
  tappet: {mass: 0.3, inertia: 0.01, at: [1.1, 0.3]}
joints:
  base: {type: revolute, bodies: [ground, arm], at: [0, 0]}
  shaft: {type: revolute, bodies: [arm, ring], at: [1, 0]}
  guide: {type: prismatic, bodies: [arm, tappet], at: [1, 0.3], axis: [0, 1]}
  lobe: {type: cam, bodies: [ring, tappet], at: [1.0, 0.15], radius: 40 mm,
         curve: {at: [1, 0], x: "0.19*cos(s)", y: "0.19*sin(s)", range: [0, 2*pi], closed: true}}
drives: {turn: {joint: shaft, velocity: 8}, swing: {joint: base, velocity: 2}}
solver: {end: 0.5 s}
"""
# a bead on a wire of a plate that turns in space
WIRE = """
planar: false
bodies:
  frame: {mass: 5, inertia: [1, 1, 1], at: [0, 0, 0.5], angular_velocity: [1, 2, 3]}
  bead: {mass: 0.1, inertia: [1e-4, 1e-4, 1e-4], at: [0.3, 0.4, 0.5]}
joints:
  tip: {type: spherical, bodies: [ground, frame], at: [0, 0, 0]}
  way: {type: point_on_curve, bodies: [frame, bead], at: [0.3, 0.4, 0.5],
        curve: {at: [0, 0.4, 0.5], x_axis: [1, 0, 0], y_axis: [0, 0, 1],
                points: [[-1, 0.4], [0, -0.2], [0.3, 0], [1, 0.4]]}}
gravity: [0, 0, -9.81]
solver: {end: 0.3 s}
output: {every: 3 ms, channels: ["*", "*.rotation"]}
"""


def test_a_roller_touches_its_cam(tmp_path):
    """Its centre is as far from that of the eccentric circle as both radii; the plate's corners
    are on the circle."""
    run = validation(tmp_path, "cam_roller")
    moved, _, things = made(run, curves.curves)
    a, r, e = 0.040, 0.012, 0.015
    angle = 9.0 * moved.time
    middle = e * np.stack([np.cos(angle), np.sin(angle)], axis=1)
    (disc, _), _ = things["lobe roller"].pieces
    centre = seen(things["lobe roller"], volume(disc)[1][None])[:, 0, :2]
    assert np.linalg.norm(centre - middle, axis=1) == pytest.approx(a + r, abs=1e-6)
    assert np.hypot(*disc.points[:, :2].T).max() == pytest.approx(r, abs=1e-12)
    ((plate, _),) = things["lobe curve"].pieces
    closed(plate)
    corners = seen(things["lobe curve"], plate.points)[..., :2] - middle[:, None]
    assert np.linalg.norm(corners, axis=2) == pytest.approx(a, abs=1e-6)
    touch = moved.touches["lobe"]
    assert np.abs(touch.off).max() < 1e-6
    # cam and roller are in one layer
    heights = [np.ptp(mesh.points[:, 2]) for mesh in (disc, plate)]
    assert heights[0] == pytest.approx(heights[1])
    assert disc.points[:, 2].mean() == pytest.approx(plate.points[:, 2].mean(), abs=1e-12)


def test_a_flat_face_touches_its_cam(tmp_path):
    """It stands at the support function of the ellipse, and reaches to the touch."""
    run = validation(tmp_path, "cam_flat")
    moved, sizes, things = made(run, curves.curves)
    a, b, angle = 0.040, 0.030, 9.0 * moved.time
    height = np.hypot(a * np.sin(angle), b * np.cos(angle))
    ((bar, _),) = things["lobe face"].pieces
    corners = seen(things["lobe face"], bar.points)
    assert corners[..., 1].min(axis=1) == pytest.approx(height, abs=1e-6)
    ((plate, _),) = things["lobe curve"].pieces
    top = seen(things["lobe curve"], plate.points)
    # what is drawn of a curve lies inside of it, by the sagitta of a corner at most
    below = height - top[..., 1].max(axis=1)
    assert below.min() > -1e-9 and below.max() < 0.041 * (1.0 - np.cos(0.13))
    slope = (a**2 - b**2) * np.sin(angle) * np.cos(angle) / height
    assert np.abs(slope).max() > 5e-3
    assert (corners[..., 0].min(axis=1) < slope - 1e-3).all()
    assert (corners[..., 0].max(axis=1) > slope + 1e-3).all()
    assert np.ptp(corners[0, :, 0]) < np.ptp(slope) + 4.1 * sizes.radius


def test_a_pin_stays_in_its_slot(tmp_path):
    """The slot of a Geneva wheel: straight walls, a pin's radius beside the line to the axle."""
    run = validation(tmp_path, "geneva")
    moved, sizes, things = made(run, curves.curves)
    axle = np.array([0.05 * 2**0.5, 0.0])
    ((walls, _),) = things["slot curve"].pieces
    closed(walls)
    pin = moved.point("crank", moved.drawn.guides[0].at)[:, :2]
    angle = moved.time * 2.0 - 0.7
    assert pin == pytest.approx(0.05 * np.stack([np.cos(angle), np.sin(angle)], 1), abs=1e-6)
    way = (pin - axle) / np.linalg.norm(pin - axle, axis=1, keepdims=True)
    corners = seen(things["slot curve"], walls.points)[..., :2] - axle
    along = np.sum(corners * way[:, None], axis=2)
    aside = corners[..., 1] * way[:, None, 0] - corners[..., 0] * way[:, None, 1]
    straight = (along > 0.0151) & (along < 0.0519)
    assert not straight.any()  # the walls have corners at their ends only
    inner = np.isclose(np.abs(aside), 0.5 * sizes.radius, rtol=0, atol=1e-6).sum(axis=1)
    outer = np.isclose(np.abs(aside), 0.95 * sizes.radius, rtol=0, atol=1e-6).sum(axis=1)
    assert inner.min() >= 16 and outer.min() >= 16  # two ends, two walls, both faces, both sides
    assert motion(run).warnings == ()


def test_a_roller_inside_of_a_moving_ring(tmp_path):
    """The ring is beyond the curve; the roller touches it from inside, wherever both go."""
    moved, sizes, things = made(of(tmp_path, text=INSIDE), curves.curves)
    ((ring, _),) = things["lobe curve"].pieces
    closed(ring)
    # both in the layer of the ring, which is not that of the tappet
    assert sizes.height("ring") != sizes.height("tappet")
    for mesh in (ring, things["lobe roller"].pieces[0][0]):
        assert mesh.points[:, 2].mean() == pytest.approx(sizes.height("ring"), abs=1e-12)
    middle = moved.places["ring"]
    corners = seen(things["lobe curve"], ring.points) - middle[:, None]
    size = np.linalg.norm(corners[..., :2], axis=2)
    assert size.min() == pytest.approx(0.19, abs=1e-9)
    assert size.max() > 0.195
    centre = moved.point("tappet", np.array([1.0, 0.15, 0.0]))
    assert np.linalg.norm((centre - middle)[:, :2], axis=1) == pytest.approx(0.15, abs=1e-6)
    assert np.abs(moved.touches["lobe"].off).max() < 1e-6


def test_a_bead_on_a_wire_in_space(tmp_path):
    """The wire turns with its body; the bead is on it, by the recorded places and rotations."""
    run = of(tmp_path, text=WIRE)
    moved, sizes, things = made(run, curves.curves)
    ((wire, _),) = things["way curve"].pieces
    closed(wire)
    guide = moved.drawn.guides[0]
    R = run.channel("frame.rotation").reshape(-1, 3, 3)[moved.rows]
    own = np.einsum("nji,nj->ni", R, moved.places["bead"] - moved.places["frame"])
    assert own[:, 1] == pytest.approx(0.4, abs=1e-6)  # in the plane of the curve
    assert np.abs(moved.touches["way"].off).max() < 1e-6
    # between two corners of what is drawn
    line = outline(guide, curves.TURN)
    a, b, p = line[:-1], line[1:], own[:, [0, 2]]
    d, u = p[:, None] - a, (b - a) / np.linalg.norm(b - a, axis=1, keepdims=True)
    part = np.clip(np.sum(d * u, axis=2), 0.0, np.linalg.norm(b - a, axis=1))
    off = np.linalg.norm(d - part[..., None] * u, axis=2).min(axis=1)
    assert off.max() < curves.WIRE * sizes.radius
    assert np.ptp(own[:, 0]) > 0.02


ELSEWHERE = [
    ("cam_flat", "initial={shaft: 100 deg}"),
    ("cam_flat", "drives.motor={joint: shaft, position: 1.2 + 9*t}"),
    ("cam_roller", "initial={shaft: 100 deg}"),
    ("whitworth", "initial={shaft: 130 deg}"),
    ("whitworth", "drives.motor={joint: shaft, position: 5*t - 2}"),
    ("geneva", "initial={shaft: 15 deg}"),
]


@pytest.mark.parametrize(("name", "start"), ELSEWHERE)
def test_a_start_that_is_not_the_drawing(name, start, tmp_path):
    """Attitudes follow from the curve and the joint that was given; they are those recorded."""
    run = validation(tmp_path, name, start, 'output.channels=["*", "*.rotation"]')
    units = {key: unit for key, unit in run.units.items() if not key.endswith(".rotation")}
    without = motion(type(run)(**{**vars(run), "units": units}))
    for body, turned in motion(run).turns.items():
        q = turns.product(turned, turns.back(without.turns[body]))
        assert 2.0 * np.linalg.norm(q[:, :3], axis=1).max() < 1e-6, body
    assert without.warnings == ()


def test_a_follower_that_comes_off_is_told(tmp_path):
    """What is drawn apart is measured: here the place of the curve is falsified."""
    moved, _ = staged(validation(tmp_path, "cam_roller"))
    guide = moved.drawn.guides[0]
    false = guide._replace(origin=guide.origin + np.array([0.0, 0.01, 0.0]))
    from trsim.report.animation.motion import touched

    assert np.abs(touched(moved, false).off).max() == pytest.approx(0.01, rel=0.2)
