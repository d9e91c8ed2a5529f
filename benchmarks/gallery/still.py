"""A picture of one moment of an animation: its triangles, seen as the viewer first shows them.

The nearest triangle counts in each pixel, and its light is that of its normal.
"""

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray
from pygltflib import GLTF2

Array = NDArray[np.float64]

TYPES = {5126: np.float32, 5123: np.uint16, 5125: np.uint32}
WIDTHS = {"SCALAR": 1, "VEC3": 3, "VEC4": 4}
LIGHT = np.array([0.35, 0.55, 0.76])  # to the right, from above, from who looks
DARK = 0.55  # of the light, where none falls
FINE = 3  # pixels of the drawing for one of the picture


class Part(NamedTuple):
    """Triangles of one colour in their place, (n, 3, 3), and their normals (n, 3)."""

    corners: Array
    normals: Array
    colour: Array


class Eye(NamedTuple):
    """Directions to the right, up and to who looks, and what is seen: its middle and its size."""

    axes: Array  # rows
    middle: Array  # (2)
    size: Array  # (2)


def values(gltf: GLTF2, number: int) -> NDArray:
    """An array of a file."""
    accessor = gltf.accessors[number]
    view = gltf.bufferViews[accessor.bufferView]
    start, wide = view.byteOffset or 0, WIDTHS[accessor.type]
    data = gltf.binary_blob()[start : start + view.byteLength]
    return np.frombuffer(data, TYPES[accessor.componentType]).reshape(-1, wide)


def frames(gltf: GLTF2) -> Array:
    """The times of the frames, s from the first one."""
    if not gltf.animations:
        return np.zeros(1)
    return values(gltf, gltf.animations[0].samplers[0].input)[:, 0].astype(float)


def parts(gltf: GLTF2, frame: int) -> list[Part]:
    """All that stands there at a frame."""
    poses = [{"translation": node.translation, "rotation": node.rotation,
              "scale": node.scale or [1.0, 1.0, 1.0]} for node in gltf.nodes]  # fmt: skip
    for animation in gltf.animations or []:
        for channel in animation.channels:
            row = values(gltf, animation.samplers[channel.sampler].output)[frame]
            poses[channel.target.node][channel.target.path] = row
    found = []
    for node, pose in zip(gltf.nodes, poses, strict=True):
        turn = rotation(np.asarray(pose["rotation"], float))
        for piece in gltf.meshes[node.mesh].primitives:
            points = values(gltf, piece.attributes.POSITION) * np.asarray(pose["scale"])
            placed = points @ turn.T + np.asarray(pose["translation"])
            corners = placed[values(gltf, piece.indices).reshape(-1, 3)]
            normals = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
            size = np.linalg.norm(normals, axis=1)
            flat = size > 0.0
            if not flat.any():  # an arrow of no force
                continue
            material = gltf.materials[piece.material].name
            colour = np.array([int(material[k : k + 2], 16) for k in (1, 3, 5)]) / 255.0
            found.append(Part(corners[flat], normals[flat] / size[flat, None], colour))
    return found


def rotation(q: Array) -> Array:
    """The matrix of a quaternion (x, y, z, w)."""
    x, y, z, w = q / np.linalg.norm(q)
    cross = np.array([[0, -z, y], [z, 0, -x], [-y, x, 0]])
    return np.eye(3) + 2 * w * cross + 2 * cross @ cross


def eye(gltf: GLTF2, shape: tuple[int, int]) -> Eye:
    """Where the viewer first looks from, and all that ever is there, in a (width, height)."""
    extras = gltf.scenes[0].extras
    if "normal" in extras:
        back = np.asarray(extras["normal"], float)
        up = np.array([0.0, 1.0, 0.0]) if abs(back[1]) < 0.9 else np.array([0.0, 0.0, 1.0])
    else:
        back, up = np.asarray(extras["back"], float), np.asarray(extras["up"], float)
    right = np.cross(up, back)
    right /= np.linalg.norm(right)
    axes = np.array([right, np.cross(back, right), back])
    seen = np.asarray(extras["outermost"], float).reshape(-1, 3) @ axes[:2].T
    low, high = seen.min(axis=0) - extras["margin"], seen.max(axis=0) + extras["margin"]
    for part in parts(gltf, 0):  # what stands out beyond joints
        flat = part.corners.reshape(-1, 3) @ axes[:2].T
        low, high = np.minimum(low, flat.min(axis=0)), np.maximum(high, flat.max(axis=0))
    scale = max((high - low) / shape) * 1.04
    return Eye(axes, (low + high) / 2, scale * np.asarray(shape, float))


def picture(gltf: GLTF2, frame: int, seen: Eye, shape: tuple[int, int]) -> tuple[Array, Array]:
    """Colours (height, width, 3) of a frame, and how much of each pixel something covers."""
    wide, high = shape[0] * FINE, shape[1] * FINE
    colours, depth = np.ones((high, wide, 3)), np.full((high, wide), -np.inf)
    scale = wide / seen.size[0]
    for part in parts(gltf, frame):
        places = part.corners @ seen.axes.T
        places[..., :2] = (places[..., :2] - seen.middle) * scale + [wide / 2, high / 2]
        light = DARK + (1 - DARK) * np.clip(part.normals @ seen.axes.T @ LIGHT, 0.0, 1.0)
        facing = part.normals @ seen.axes[2] > 0.0
        for corners, bright in zip(places[facing], light[facing], strict=True):
            fill(colours, depth, corners, np.minimum(part.colour * bright, 1.0))
    covered = np.isfinite(depth).astype(float)
    return coarse(colours[::-1]), coarse(covered[::-1, :, None])


def fill(colours: Array, depth: Array, corners: Array, colour: Array) -> None:
    """One triangle, where nothing is nearer."""
    high, wide = depth.shape
    low = np.maximum(np.floor(corners[:, :2].min(axis=0)), 0).astype(int)
    end = np.minimum(np.ceil(corners[:, :2].max(axis=0)) + 1, (wide, high)).astype(int)
    if (low >= end).any():
        return
    x, y = np.meshgrid(np.arange(low[0], end[0]) + 0.5, np.arange(low[1], end[1]) + 0.5)
    (ax, ay, az), (bx, by, bz), (cx, cy, cz) = corners
    area = (bx - ax) * (cy - ay) - (cx - ax) * (by - ay)
    if area <= 0.0:
        return
    b = ((x - ax) * (cy - ay) - (cx - ax) * (y - ay)) / area
    c = ((bx - ax) * (y - ay) - (x - ax) * (by - ay)) / area
    z = az + b * (bz - az) + c * (cz - az)
    window = (slice(low[1], end[1]), slice(low[0], end[0]))
    over = (b >= 0.0) & (c >= 0.0) & (b + c <= 1.0) & (z > depth[window])
    depth[window][over] = z[over]
    colours[window][over] = colour


def coarse(fine: Array) -> Array:
    """The mean of FINE times FINE pixels."""
    high, wide, deep = fine.shape
    return fine.reshape(high // FINE, FINE, wide // FINE, FINE, deep).mean(axis=(1, 3))


def onto(seen: Eye, places: Array, shape: tuple[int, int]) -> Array:
    """Places (n, 3) of the file as pixels, from the upper left corner."""
    flat = (places @ seen.axes[:2].T - seen.middle) * (shape[0] / seen.size[0])
    return np.column_stack([shape[0] / 2 + flat[:, 0], shape[1] / 2 - flat[:, 1]])
