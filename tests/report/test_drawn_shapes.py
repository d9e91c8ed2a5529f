"""Bodies that are made of solids: what is drawn is what is weighed, where the body is."""

import numpy as np
import pytest

from trsim.elements.solid import Solid
from trsim.elements.weighing import of_solid
from trsim.report.animation import bodies, film, shapes
from trsim.report.animation.plates import annulus, anticlockwise, plate, triangles
from trsim.report.animation.solids import circle
from trsim.report.animation.things import PIN
from trsim.report.animation.wires import wire

from .filmed import closed, made, of, seen, staged, validation, volume

L = [[0, 0], [0.3, 0], [0.3, 0.1], [0.1, 0.1], [0.1, 0.3], [0, 0.3]]
PLACED = {"at": [1, 2, 3], "axis": [1, 2, -1], "x_axis": [0, 1, 3]}
SOLIDS = [
    {"box": [0.3, 0.2, 0.1]},
    {"cylinder": 0.2, "length": 0.5},
    {"cylinder": 0.2, "length": 0.5, "wall": 0.03},
    {"sphere": 0.3},
    {"polygon": L, "length": 0.05},
    {"polygon": L[::-1], "length": 0.05},
]
BOX = """
planar: false
bodies:
  part:
    density: 2000
    shape:
      - {box: [0.4, 0.1, 0.2], at: [0.2, 0, 0.1]}
      - {polygon: [[0, 0], [0.3, 0], [0.3, 0.1], [0.1, 0.1], [0.1, 0.3], [0, 0.3]], length: 0.05,
         at: [0.1, 0.2, 0.3], axis: [1, 2, 2]}
    angular_velocity: [3, 5, -2]
joints:
  tip: {type: spherical, bodies: [ground, part], at: [-0.2, 0.1, 0]}
gravity: [0, 0, -9.81]
solver: {end: 0.4 s}
output: {every: 4 ms, channels: ["*", "*.rotation"]}
"""


@pytest.mark.parametrize("given", SOLIDS)
def test_a_solid_is_drawn_where_it_weighs(given):
    """Closed; its centroid is the centre of mass; round ones lack what is beyond their corners."""
    solid = Solid(**given, **PLACED)
    mesh, bulk = shapes.mesh(solid), of_solid(solid, 1.0)
    closed(mesh)
    whole, centre = volume(mesh)
    assert centre == pytest.approx(bulk.centre, abs=1e-12)
    exact = solid.box is not None or solid.polygon is not None
    assert whole == pytest.approx(bulk.mass, rel=1e-12 if exact else 0.06)


def test_a_prism_stands_on_its_axes():
    """The L by hand: two rectangles, 0.03 and 0.02 m^2, about the axes of the solid."""
    solid = Solid(polygon=L, length=0.1, at=(1, 0, 0), axis=(0, 0, -1), x_axis=(0, 1, 0))
    _, centre = volume(shapes.mesh(solid))
    x = (0.03 * 0.15 + 0.02 * 0.05) / 0.05
    y = (0.03 * 0.05 + 0.02 * 0.2) / 0.05
    # z x x: the y axis of the solid is (0, 0, -1) x (0, 1, 0) = (1, 0, 0)
    assert centre == pytest.approx([1 + y, x, 0.0], abs=1e-12)


def test_a_shape_moves_with_its_body(tmp_path):
    """The centroid of all that is drawn is the recorded centre of mass, in every frame."""
    text = BOX.replace("at: [-0.2, 0.1, 0]", "at: [0.1, 0, 0.1]")
    run = of(tmp_path, text=text)  # the joint is inside: there is no link to it
    moved, _, things = made(run, bodies.links)
    ((mesh, _),) = things["part"].pieces
    _, centre = volume(mesh)
    there = seen(things["part"], centre[None])[:, 0]
    assert there == pytest.approx(run.channel("part.position")[moved.rows], abs=1e-12)
    # a corner of the box, by the recorded rotation
    corner = np.array([0.4, 0.05, 0.2])
    own = corner - moved.drawn.bodies["part"]
    near = np.linalg.norm(mesh.points - own, axis=1).argmin()
    R = run.channel("part.rotation").reshape(-1, 3, 3)[moved.rows]
    wanted = run.channel("part.position")[moved.rows] + R @ own
    assert seen(things["part"], mesh.points[near : near + 1])[:, 0] == pytest.approx(
        wanted, abs=1e-9
    )


def test_what_a_shape_holds_outside_is_linked(tmp_path):
    """A thin rod from the solid to the joint."""
    run = of(tmp_path, text=BOX)
    moved, sizes, things = made(run, bodies.links)
    ((mesh, _),) = things["part"].pieces
    joint = np.array([-0.2, 0.1, 0.0]) - moved.drawn.bodies["part"]
    away = np.linalg.norm(mesh.points - joint, axis=1)
    assert away.min() == pytest.approx(0.4 * 0.6 * sizes.radius, rel=1e-6)


def test_holes_are_lines(tmp_path):
    """Dark rings around both ends, as far from the axis as the hole is wide; nothing is cut."""
    hole = (
        "      - {cylinder: 40 mm, length: 0.1, at: [0.3, 0, 0.1], axis: [0, 1, 0], hole: true}\n"
    )
    text = BOX.replace("    angular", hole + "    angular")
    moved, sizes, things = made(of(tmp_path, text=text), bodies.links)
    (_, _), (rings, colour) = things["part"].pieces
    assert colour == PIN
    place = rings.points + moved.drawn.bodies["part"] - [0.3, 0.0, 0.1]
    thick = 0.12 * sizes.radius
    assert np.abs(np.hypot(place[:, 0], place[:, 2]) - 0.02).max() < 1.1 * thick
    assert np.abs(np.abs(place[:, 1]) - 0.05).max() < 1.1 * thick
    closed(rings)


FLAT = """
bodies:
  one: {density: 1000, shape: [{box: [0.4, 0.1, 0.02], at: [0.2, 0, 0]}]}
  two: {density: 1000, shape: [{box: [0.4, 0.1, 0.02], at: [0.6, 0, 0]}]}
joints:
  a: {type: revolute, bodies: [ground, one], at: [0, 0]}
  b: {type: revolute, bodies: [one, two], at: [0.4, 0]}
gravity: [0, -9.81, 0]
solver: {end: 0.2 s}
"""


def test_plates_of_a_flat_mechanism_pass_each_other(tmp_path):
    """Their places in the plane are those drawn; their layers have room for them."""
    _, sizes, things = made(of(tmp_path, text=FLAT), bodies.links)
    assert sizes.normal.tolist() == [0.0, 0.0, 1.0]
    heights = []
    for name in ("one", "two"):
        ((mesh, _),) = things[name].pieces
        assert volume(mesh)[1][:2] == pytest.approx([0.0, 0.0], abs=1e-12)
        heights.append([mesh.points[:, 2].min(), mesh.points[:, 2].max()])
    assert heights[1][0] > heights[0][1]


def test_a_deep_body_is_seen_in_space(tmp_path):
    """A door that hangs on one vertical hinge is no flat mechanism, deep as it is."""
    door = """
planar: false
bodies: {door: {density: 700, shape: [{box: [0.8, 0.04, 2], at: [0.4, 0, 1]}]}}
joints: {hinge: {type: revolute, bodies: [ground, door], at: [0, 0, 1], axis: [0, 0, 1]}}
gravity: [0, 0, -9.81]
solver: {end: 0.1 s}
"""
    _, sizes, _ = made(of(tmp_path, text=door), bodies.links)
    assert sizes.normal is None


def test_the_same_bytes(tmp_path):
    run = of(tmp_path, text=BOX)
    assert film(run).glb == film(run).glb


# --- plates of any outline -------------------------------------------------------------------


def ragged(seed):
    """A simple outline about the origin with many hollows."""
    rng = np.random.default_rng(seed)
    n = int(rng.integers(5, 60))
    angle = 2.0 * np.pi * np.arange(n) / n
    return rng.uniform(0.1, 1.0, n)[:, None] * np.stack([np.cos(angle), np.sin(angle)], axis=1)


def spiral():
    t = np.linspace(0.0, 4.0 * np.pi, 80)[:, None]
    way = np.concatenate([np.cos(t), np.sin(t)], axis=1)
    return np.concatenate([(1.0 + t) * way, (1.8 + t)[::-1] * way[::-1]])


OUTLINES = [
    *(ragged(seed) for seed in range(20)),
    spiral(),
    np.array([[0, 0], [1, 0], [2, 0], [2, 1], [1, 1], [1, 0.5], [1, 0.25], [0, 1.0]]),
]


@pytest.mark.parametrize("outline", OUTLINES)
def test_an_outline_is_filled_once(outline):
    """As many triangles as corners but two, none turned over, together as large as the outline."""
    flat = anticlockwise(outline)
    found = triangles(flat)
    assert len(found) == len(flat) - 2
    a, b, c = np.moveaxis(flat[found], 1, 0)
    areas = 0.5 * ((b - a)[:, 0] * (c - a)[:, 1] - (b - a)[:, 1] * (c - a)[:, 0])
    x, y = flat.T
    whole = 0.5 * (x @ np.roll(y, -1) - y @ np.roll(x, -1))
    assert areas.min() >= -1e-12
    assert areas.sum() == pytest.approx(whole, rel=1e-12)
    mesh = plate(outline, 0.3, np.eye(3))
    closed(mesh)
    assert volume(mesh)[0] == pytest.approx(0.3 * whole, rel=1e-12)


def test_rings_and_wires_are_closed():
    ring = annulus(circle(2.0), circle(1.0), 0.5, np.eye(3))
    closed(ring)
    area = 12.0 * np.sin(np.pi / 12.0)  # of 24 corners on a circle of radius 1
    assert volume(ring)[0] == pytest.approx(0.5 * 3.0 * area, rel=1e-12)
    line = np.insert(circle(1.0, 60), 2, 0.0, axis=1)
    for is_closed in (True, False):
        mesh = wire(line, 0.05, np.array([0.0, 0.0, 1.0]), is_closed)
        closed(mesh)
        length = 2.0 * np.pi * (1.0 if is_closed else 59.0 / 60.0)
        hexagon = 1.5 * 3.0**0.5 * 0.05**2
        assert volume(mesh)[0] == pytest.approx(hexagon * length, rel=0.01)


# --- bodies without a shape ------------------------------------------------------------------


def test_a_body_reaches_to_its_load(tmp_path):
    """What a force acts on is a part of the body: the bucket of an excavator has its tip."""
    moved, sizes = staged(validation(tmp_path, "excavator_arm", "solver.end=10 ms"))
    ends = {tuple(at) for pair in bodies.skeleton(moved.drawn, sizes, "bucket") for at in pair}
    assert (6.4, -1.6, 0.0) in ends


def test_a_door_has_a_leaf(tmp_path):
    """What hangs on one line would be seen as that line, which does not turn."""
    moved, sizes = staged(validation(tmp_path, "kitchen_door", "solver.end=10 ms"))
    found = bodies.skeleton(moved.drawn, sizes, "door")
    wanted = [[[0, 0, 0.2], [0, 0, 1.6]], [[0, 0, 0.9], [0.3, 0, 0.9]]]
    assert np.array(found) == pytest.approx(np.array(wanted), abs=1e-12)


def test_what_rests_takes_no_room(tmp_path):
    """What stays where it is, but for rounding, has no motion in the file: the cam only turns."""
    from pygltflib import GLTF2

    gltf = GLTF2.load_from_bytes(film(validation(tmp_path, "cam_flat")).glb)
    (animation,) = gltf.animations
    moving = {"translation": set(), "rotation": set()}
    for channel in animation.channels:
        moving[channel.target.path].add(gltf.nodes[channel.target.node].name)
    assert moving["translation"] == {"tappet", "lobe face"}
    assert moving["rotation"] == {"lobe curve", "shaft pin"}
