"""Solids and sheets seen from afar, without perspective, the farther ones behind the nearer."""

from typing import Any

import numpy as np
from numpy.typing import NDArray

from trsim.report.animation.solids import Mesh

Array = NDArray[np.float64]


def view(azimuth: float, elevation: float) -> Array:
    """Where it is seen from: rows right, up and towards the eye, (3, 3).

    From an azimuth about z, from x towards y, and an elevation above x-y; degrees.
    """
    a, e = np.radians([azimuth, elevation])
    towards = np.array([np.cos(e) * np.cos(a), np.cos(e) * np.sin(a), np.sin(e)])
    right = np.array([-np.sin(a), np.cos(a), 0.0])
    return np.stack([right, np.cross(towards, right), towards])


class Canvas:
    """What is to be painted."""

    def __init__(self, seen_from: Array) -> None:
        self.view = seen_from
        self.light = seen_from.T @ np.array([-0.4, 0.6, 0.7])
        self.faces: list[tuple[float, Array, Array]] = []  # nearness, (k, 2), red green blue alpha

    def seen(self, points: Array) -> Array:
        """Right, up and nearness of points (..., 3)."""
        return points @ self.view.T

    def solid(self, mesh: Mesh, colour: str) -> None:
        """A closed solid; what faces away is not seen."""
        corners = mesh.points[mesh.triangles]
        normals = mesh.normals[mesh.triangles].mean(axis=1)
        for face, normal in zip(corners, normals, strict=True):
            if normal @ self.view[2] > -0.05:
                self._add(face, normal, colour, 1.0)

    def sheet(self, grid: Array, colour: str, alpha: float = 1.0) -> None:
        """A sheet through a grid of points (n, m, 3), seen from both sides."""
        for k in range(len(grid) - 1):
            for m in range(grid.shape[1] - 1):
                face = grid[[k, k + 1, k + 1, k], [m, m, m + 1, m + 1]]
                normal = np.cross(face[2] - face[0], face[3] - face[1])
                normal /= np.linalg.norm(normal)
                self._add(face, normal * np.sign(normal @ self.view[2] or 1.0), colour, alpha)

    def _add(self, face: Array, normal: Array, colour: str, alpha: float) -> None:
        from matplotlib.colors import to_rgb

        shade = 0.62 + 0.38 * float(np.clip(normal @ self.light / np.linalg.norm(self.light), 0, 1))
        seen = self.seen(face)
        self.faces.append((float(seen[:, 2].mean()), seen[:, :2],
                           np.array([*(shade * np.array(to_rgb(colour))), alpha])))  # fmt: skip

    def paint(self, axes: Any) -> None:
        """Put everything on axes of equal scales."""
        from matplotlib.collections import PolyCollection

        _, places, colours = zip(*sorted(self.faces, key=lambda face: face[0]), strict=True)
        opaque = [(*c[:3], c[3] if c[3] == 1.0 else 0.0) for c in colours]  # hides the seams
        axes.add_collection(PolyCollection(places, facecolors=colours, edgecolors=opaque,
                                           linewidths=0.3))  # fmt: skip
        axes.set_aspect("equal")
        axes.autoscale_view()
        axes.axis("off")

    def line(self, axes: Any, points: Array, **options: Any) -> None:
        """A line over everything."""
        seen = self.seen(points)
        axes.plot(seen[:, 0], seen[:, 1], **options)

    def number(self, axes: Any, at: Array, text: str, colour: str) -> None:
        """A number in a disc over everything."""
        x, y, _ = self.seen(at)
        axes.annotate(text, (x, y), ha="center", va="center", fontsize=8, color="white", zorder=9,
                      fontweight="bold", bbox={"boxstyle": "circle,pad=0.25", "fc": colour,
                                               "ec": "white", "lw": 0.8})  # fmt: skip
