"""Flexible bars as rigid ones and back: a start is found for the mechanism with stiff bars.

A rigid bar lies where the chord of the flexible one does, from its first node to its last, and
carries the velocities of a rigid body to all of its nodes: no bar starts with an axial wave.
"""

import numpy as np
from numpy.typing import NDArray

from trsim.assemble.dense import length, product
from trsim.assemble.mechanism import Mechanism
from trsim.assemble.members import Beam
from trsim.assemble.reduce import world_rates

Array = NDArray[np.float64]


def node_columns(mechanism: Mechanism, beam: Beam, start: int) -> NDArray[np.int64]:
    """Where place and slope of its nodes (nodes, 2 width) stand in y; start: 0 or n_q."""
    model = mechanism.model
    first = start + (model.q_node if start == 0 else model.v_node)
    first += model.d_node * (beam.first - model.n_r)
    return first + np.arange(model.d_node * beam.nodes).reshape(beam.nodes, model.d_node)


def places(mechanism: Mechanism, beam: Beam, y: Array) -> tuple[Array, Array]:
    """Places and slopes of its nodes in three dimensions (nodes, 3)."""
    width = mechanism.model.d_node // 2
    found = y[node_columns(mechanism, beam, 0)]
    r, g = np.zeros((beam.nodes, 3)), np.zeros((beam.nodes, 3))
    r[:, :width], g[:, :width] = found[:, :width], found[:, width:]
    if width == 2:
        r[:, 2] = beam.places[:, 2]
    return r, g


def moving(mechanism: Mechanism) -> dict[str, int]:
    """The frames by name, but for the ground."""
    return {name: f for name, f in mechanism.frames.items() if f > 0}


def as_rigid(flexible: Mechanism, stiff: Mechanism, y: Array) -> Array:
    """Positions and velocities of the mechanism with stiff bars; its z zero."""
    out = stiff.y0.copy()
    a, b = flexible.model, stiff.model
    width, q = (3, 3) if b.d == 3 else (6, 7)
    twists = world_rates(a, y).reshape(-1, 6)
    for name, f in moving(stiff).items():
        here, rate = slice(q * (f - 1), q * f), b.n_q + width * (f - 1)
        if name in flexible.beams:
            beam = flexible.beams[name]
            r, _ = places(flexible, beam, y)
            chord = (r[-1] - r[0]) / length(r[-1] - r[0])
            ends = twists[[beam.first - 1, beam.first + beam.nodes - 2], :3]
            omega = np.cross(chord, ends[1] - ends[0]) / beam.whole
            out[here] = pose(0.5 * (r[0] + r[-1]), np.array(beam.tangent), chord, b.d)
            twist = np.concatenate([ends.mean(axis=0), omega])
            if b.d == 3:
                out[rate : rate + 3] = twist[[0, 1, 5]]
            else:
                out[rate : rate + 3] = twist[:3]
                out[rate + 3 : rate + 6] = product(turned(out[here][3:]).T, omega)
        else:
            k = flexible.frames[name]
            out[here] = y[q * (k - 1) : q * k]
            out[rate : rate + width] = y[a.n_q + width * (k - 1) : a.n_q + width * k]
    out[b.n_q + b.n_v :] = 0.0
    return out


def as_flexible(flexible: Mechanism, stiff: Mechanism, y: Array) -> Array:
    """Positions of the mechanism with flexible bars, straight; velocities and z as drawn."""
    out = flexible.y0.copy()
    q = 3 if stiff.model.d == 3 else 7
    for name, f in moving(stiff).items():
        here = y[q * (f - 1) : q * f]
        if name in flexible.beams:
            beam = flexible.beams[name]
            width = flexible.model.d_node // 2
            centre = here[:2] if q == 3 else here[:3]
            R = turned(np.array([0.0]) if q == 3 else here[3:], here[2] if q == 3 else None)
            along = np.linspace(-0.5, 0.5, beam.nodes)[:, None] * beam.whole
            t = product(R, np.array(beam.tangent))[:width]
            nodes = np.hstack([centre + along * t, np.tile(t, (beam.nodes, 1))])
            out[node_columns(flexible, beam, 0)] = nodes
        else:
            k = flexible.frames[name]
            out[q * (k - 1) : q * k] = here
    return out


def moving_as_rigid(flexible: Mechanism, stiff: Mechanism, y: Array, v: Array) -> Array:
    """World-axes rates of the flexible mechanism where its bars move like rigid ones.

    v: world-axes twists (6 (n - 1)) of the mechanism with stiff bars.
    """
    out = np.zeros((flexible.model.n - 1, 6))
    for name, f in moving(stiff).items():
        twist = v[6 * (f - 1) : 6 * f]
        if name in flexible.beams:
            beam = flexible.beams[name]
            r, g = places(flexible, beam, y)
            part = slice(beam.first - 1, beam.first + beam.nodes - 1)
            out[part, :3] = twist[:3] + np.cross(twist[3:], r - 0.5 * (r[0] + r[-1]))
            out[part, 3:] = np.cross(twist[3:], g)
        else:
            out[flexible.frames[name] - 1] = twist
    return out.ravel()


def pose(centre: Array, drawn: Array, now: Array, d: int) -> Array:
    """Coordinates of a bar whose tangent turned from `drawn` to `now` along the shortest way."""
    if d == 3:
        angle = np.arctan2(drawn[0] * now[1] - drawn[1] * now[0], product(drawn[None], now)[0])
        return np.array([centre[0], centre[1], angle])
    half = drawn + now
    size = length(half)
    if size < 1e-9:  # straight back: about any axis across
        axis = np.cross(drawn, np.eye(3)[int(np.argmin(np.abs(drawn)))])
        return np.concatenate([centre, [0.0], axis / length(axis)])
    half /= size
    return np.concatenate([centre, [product(drawn[None], half)[0]], np.cross(drawn, half)])


def turned(p: Array, angle: float | None = None) -> Array:
    """Rotation matrix of a quaternion, or of an angle about z."""
    if angle is not None:
        p = np.array([np.cos(0.5 * angle), 0.0, 0.0, np.sin(0.5 * angle)])
    e0, e = p[0], p[1:]
    cross = np.array([[0.0, -e[2], e[1]], [e[2], 0.0, -e[0]], [-e[1], e[0], 0.0]])
    return np.asarray(np.eye(3) + 2.0 * e0 * cross + 2.0 * product(cross, cross))
