"""How the axes of bodies and nodes stand as drawn."""

from collections.abc import Mapping
from typing import Any

import numpy as np
from numpy.typing import NDArray

from trsim.assemble.dense import product
from trsim.assemble.members import Beam

Array = NDArray[np.float64]


def orientations(rigid: Mapping[str, Any], beams: Mapping[str, Beam]) -> tuple[Array, Array, Array]:
    """The attitudes of the ground, the rigid bodies and the nodes of the beams, in this order:

    angle (n)          about the z axis of what a body is drawn in, rad
    about_z (n)        the same about the world's z axis; means nothing where that is another one
    rotation (n, 3, 3) into world axes
    """
    angle = np.array([0.0, *(spec.angle for spec in rigid.values())])
    about_z = angle.copy()
    rotation = np.zeros((len(angle), 3, 3))
    c, s = np.cos(angle), np.sin(angle)
    rotation[:, 0, 0], rotation[:, 0, 1] = c, -s
    rotation[:, 1, 0], rotation[:, 1, 1] = s, c
    rotation[:, 2, 2] = 1.0
    for f, spec in enumerate(rigid.values(), start=1):
        if spec.drawn_in is not None:
            rotation[f] = product(np.stack(spec.drawn_in[1:], axis=1), rotation[f])
            about_z[f] += spec.drawn_in.about_z
    for beam in beams.values():
        along = [np.arctan2(beam.tangent[1], beam.tangent[0])] * beam.nodes
        angle, about_z = np.append(angle, along), np.append(about_z, along)
        rotation = np.concatenate([rotation, np.tile(beam.axes, (beam.nodes, 1, 1))])
    return angle, about_z, rotation


def quaternion(spec: Any) -> Array:
    """The quaternion of the axes of a rigid body as drawn, the scalar first."""
    c, s = np.cos(spec.angle / 2), np.sin(spec.angle / 2)
    if spec.drawn_in is None:
        return np.array([c, 0.0, 0.0, s])
    e0, e1, e2, e3 = spec.drawn_in.quaternion
    return np.array([e0 * c - e3 * s, e1 * c + e2 * s, e2 * c - e1 * s, e0 * s + e3 * c])
