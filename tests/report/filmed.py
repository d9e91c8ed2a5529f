"""Runs for tests of animations, and where their meshes are over the frames."""

from pathlib import Path

import numpy as np

from tests import small
from trsim.report.animation import turns
from trsim.report.animation.motion import motion
from trsim.report.animation.things import look
from trsim.store.read import read

VALIDATION = Path(__file__).parents[2] / "scenarios" / "validation"

ROD = """
gravity: [0, -9.81, 0]
bodies:
  rod: {type: ancf_cable, start: [0, 0], end: [1, 0], elements: 4, section: {width: 5 mm},
        youngs_modulus: 1.6e6, density: 320}
joints: {pin: {type: revolute, bodies: [ground, rod], at: [0, 0]}}
solver: {end: 0.2 s, tolerance: 1e-4}
"""

# a hatch on a rail, pushed by an actuator, with two equal flaps held by springs
HATCH = """
planar: false
templates:
  flap:
    parameters: {z: 0}
    frame: {at: [0, 0, z]}
    bodies: {leaf: {mass: 0.1, inertia: [1e-3, 1e-3, 1e-3], at: [0, 0.3, 0],
                    angular_velocity: [6, 0, 0]}}
    joints: {hinge: {type: revolute, bodies: [hatch, leaf], at: [0, 0.2, 0], axis: [1, 0, 0]}}
    forces: {hold: {type: spring_damper, bodies: [hatch, leaf], points: [[0.2, 0.1], [0.2, 0.4]],
                    stiffness: 2}}
instances: {low: {template: flap}, high: {template: flap, parameters: {z: 0.8}}}
bodies:
  hatch: {mass: 3, inertia: [0.2, 0.2, 0.2], at: [0, 0, 0.4]}
drives:
  jack: {type: actuator, bodies: [ground, hatch], points: [[-0.8, 0.1, 0.4], [-0.3, 0, 0.4]],
         velocity: "0.4*smoothstep(t/0.2)", stiffness: 1e5, damping: 500}
forces:
  rail: {type: bushing, bodies: [ground, hatch], at: [0, 0, 0.4], stiffness: [0, 1e5, 1e5],
         rotational_stiffness: [1e3, 1e3, 1e3], rotational_damping: [10, 10, 10]}
  mount: {type: bushing, bodies: [hatch, high_leaf], at: [0, 0.4, 0.8], stiffness: [1, 1, 1]}
solver: {end: 0.5 s}
output: {every: 5 ms}
"""


def of(folder, *sets, text=small.SLIDER_CRANK):
    small.copy(folder / "run.h5", *sets, text=text)
    return read(folder / "run.h5")


def validation(folder, name, *sets):
    """The run of a scenario of that folder."""
    return of(folder, *sets, text=(VALIDATION / f"{name}.yaml").read_text())


def staged(run):
    """Its motion and the sizes it is drawn in."""
    moved = motion(run)
    return moved, look(moved.drawn)


def made(run, *kinds):
    """The same, and its things of some kinds by name."""
    moved, sizes = staged(run)
    return moved, sizes, {thing.name: thing for kind in kinds for thing in kind(moved, sizes)}


def seen(thing, points):
    """Points (m, 3) of a thing over the frames, (n, m, 3), world axes."""
    scale = np.ones((1, 3)) if thing.scale is None else thing.scale
    own = scale[:, None, :] * points
    return thing.place[:, None, :] + turns.turned(thing.turn[:, None, :], own)


def volume(mesh):
    """Volume and centroid of a closed mesh, by the divergence theorem."""
    a, b, c = np.moveaxis(mesh.points[mesh.triangles], 1, 0)
    parts = np.sum(a * np.cross(b, c), axis=1) / 6.0
    return parts.sum(), (parts[:, None] * (a + b + c) / 4.0).sum(axis=0) / parts.sum()


def closed(mesh):
    """Refuse a mesh that has a hole, or shows a triangle's back."""
    corners = mesh.points[mesh.triangles]
    normal = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    size = np.abs(normal).sum()
    assert np.abs(normal.sum(axis=0)).max() < 1e-12 * size
    outward = mesh.normals[mesh.triangles].mean(axis=1)
    assert np.sum(normal * outward, axis=1).min() >= -1e-9 * np.abs(normal).max()
    assert np.abs(np.linalg.norm(mesh.normals, axis=1) - 1.0).max() < 1e-9


def arrays(glb):
    """The file as pygltflib reads it, and its accessors as arrays."""
    from pygltflib import GLTF2

    gltf = GLTF2.load_from_bytes(glb)
    blob, kinds = gltf.binary_blob(), {5123: np.uint16, 5125: np.uint32, 5126: np.float32}
    found = []
    for accessor in gltf.accessors:
        view = gltf.bufferViews[accessor.bufferView]
        assert view.byteOffset % 4 == 0
        width = {"SCALAR": 1, "VEC3": 3, "VEC4": 4}[accessor.type]
        data = blob[view.byteOffset : view.byteOffset + view.byteLength]
        values = np.frombuffer(data, kinds[accessor.componentType]).reshape(-1, width)
        assert len(values) == accessor.count
        found.append(values)
    return gltf, found
