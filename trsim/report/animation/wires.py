"""Round wires along plane lines."""

import numpy as np

from trsim.report.animation.solids import Array, Mesh, skin

SIDES = 6


def wire(line: Array, radius: float, normal: Array, closed: bool = False) -> Mesh:
    """A wire along a line (n, 3) in a plane of this normal; at an open end it closes to a point."""
    line = np.concatenate([line, line[:1]]) if closed else line
    along = np.diff(line, axis=0)
    along /= np.linalg.norm(along, axis=1, keepdims=True)
    before = np.concatenate([along[-1:] if closed else along[:1], along])
    after = np.concatenate([along, along[:1] if closed else along[-1:]])
    heading = before + after
    heading /= np.maximum(np.linalg.norm(heading, axis=1, keepdims=True), 1e-300)
    # in a corner the wire is wider across it
    wide = 1.0 / np.maximum(np.sum(heading * after, axis=1, keepdims=True), 0.3)
    aside, thick = np.cross(normal, heading), np.full(len(line), radius)
    if not closed:
        ends = [0, *range(len(line)), len(line) - 1]
        line, aside, wide = line[ends], aside[ends], wide[ends]
        thick = np.pad(thick, 1)
    angle = 2.0 * np.pi * np.linspace(0.0, 1.0, SIDES + 1)[:, None]
    out = np.cos(angle) * aside[:, None], np.sin(angle) * normal
    points = line[:, None] + thick[:, None, None] * (wide[:, None] * out[0] + out[1])
    normals = out[0] + out[1]
    return Mesh(points.reshape(-1, 3), normals.reshape(-1, 3), skin(len(line), SIDES))


def arc(
    middle: Array, radius: float, first: float, sweep: float, axes: Array, step: float
) -> Array:
    """Points of an arc (n, 3) about the third of the axes, at most `step` rad apart."""
    angle = first + sweep * np.linspace(0.0, 1.0, max(int(np.ceil(abs(sweep) / step)), 1) + 1)
    return middle + radius * np.stack([np.cos(angle), np.sin(angle)], axis=1) @ axes[:2]
