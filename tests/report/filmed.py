"""Runs for tests of animations, and where their meshes are over the frames."""

from pathlib import Path

import numpy as np

from tests import small
from trsim.report.animation import turns
from trsim.report.animation.motion import motion
from trsim.report.animation.things import look
from trsim.store.read import read

VALIDATION = Path(__file__).parents[2] / "scenarios" / "validation"


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
