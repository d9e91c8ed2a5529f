"""Eigenfrequencies and shapes of the small motions about a start.

    A x = lambda x,      f = |Im lambda| / 2 pi,      zeta = -Re lambda / |lambda|

A is the state matrix of linearised.py, on the constraints, with drives held and contacts as they
are at the start.  Ask for `initial: {equilibrium: [...]}` to have modes about an equilibrium;
elsewhere they are those of the motion frozen there.
"""

from dataclasses import dataclass
from math import pi
from typing import Literal, get_args

import numpy as np

from trsim.assemble.equations import poses
from trsim.assemble.mechanism import Mechanism
from trsim.elements.scene import scene
from trsim.solve.diagnose.linearised import Linearised, linearised, rounding
from trsim.solve.start.consistent import Start

UNDAMPED = 1e-6  # damping ratio: a smaller one is the rounding of the differences
PARALLEL = 1e-3  # free motions that differ by less are one
NOTHING = 1e-9  # of a vector: what rounding moves in one of states of elements
Kind = Literal["oscillates", "decays", "grows", "free"]
OSCILLATES, DECAYS, GROWS, FREE = get_args(Kind)


@dataclass(frozen=True)
class Moved:
    """What a body does in a mode; the largest motion of all is 1.

    body         its name
    translation  x, y, z
    rotation     about x, y, z, rad times the mechanism's size
    """

    body: str
    translation: tuple[float, float, float]
    rotation: tuple[float, float, float]


@dataclass(frozen=True)
class Mode:
    """A small motion about the start.

    kind           oscillates, decays, grows or free
    frequency      Hz, damped; 0 where it does not oscillate
    damping_ratio  negative where it grows
    rate           real part of the eigenvalue, 1/s
    shape          the bodies that move
    """

    kind: Kind
    frequency: float
    damping_ratio: float
    rate: float
    shape: tuple[Moved, ...]


def modes(mechanism: Mechanism, begun: Start) -> list[Mode]:
    """All modes, slowest first; before them free motions, a mode for each direction.

    Where nothing damps a free motion its eigenvalue is zero twice: it has a place and a speed.
    """
    linear = linearised(mechanism, begun, order=4)
    if not linear.A.size:
        return []
    values, vectors = np.linalg.eig(linear.A)
    least = rounding(values, begun)
    still = np.abs(values) <= least
    ways = np.column_stack((vectors[: linear.Z.shape[1], ~still], free(linear, vectors[:, still])))
    values = np.append(values[~still], np.zeros(ways.shape[1] - np.sum(~still)))
    moved = turned(mechanism, begun, linear.twists) @ ways
    found = []
    for value, vector in zip(values, moved.T, strict=True):
        if value.imag < 0.0:
            continue  # the other of its pair
        rate = float(value.real) if abs(value) > least else 0.0
        swings = abs(value.imag) > least
        size = abs(value)
        found.append(Mode(
            kind=OSCILLATES if swings else FREE if rate == 0.0 else DECAYS if rate < 0.0 else GROWS,
            frequency=float(value.imag) / (2.0 * pi) if swings else 0.0,
            damping_ratio=-rate / size if swings and abs(rate) > UNDAMPED * size else 0.0,
            rate=rate,
            shape=shape(mechanism, vector),
        ))  # fmt: skip
    return sorted(found, key=lambda mode: (mode.kind != FREE, mode.frequency, abs(mode.rate)))


def free(linear: Linearised, vectors: np.ndarray) -> np.ndarray:
    """The motions of eigenvectors whose eigenvalue is zero, those that are independent, columns.

    Both of a double zero have the same motion, and those of a pair are the sum and the difference
    of two.  Vectors of states of elements alone, which move nothing, are all kept.
    """
    kept: list[np.ndarray] = []
    basis: list[np.ndarray] = []
    f = linear.Z.shape[1]
    for vector in vectors.T:
        motion = vector[:f]
        largest = motion[int(np.argmax(np.abs(motion)))] if f else 0.0
        if abs(largest) <= NOTHING * np.abs(vector).max():
            kept.append(np.zeros(f))
            continue
        for part in ((motion / largest).real, (motion / largest).imag):
            size = float(np.linalg.norm(part))
            rest = part - sum((b * (b @ part) for b in basis), np.zeros(f))
            if float(np.linalg.norm(rest)) > PARALLEL * max(1.0, size):
                kept.append(part)
                basis.append(rest / np.linalg.norm(rest))
    return np.array(kept).reshape(-1, f).T


def turned(mechanism: Mechanism, begun: Start, rates: np.ndarray) -> np.ndarray:
    """World-axes rates (6 (n-1), columns) as twists: omega = g x g' / g^2 of a slope g."""
    w = scene(mechanism.model)
    poses(w, begun.y)
    nodes = rates.reshape(w.n - 1, 6, -1).copy()
    g = w.G[w.n_r :, :3, None]
    square = np.sum(g * g, axis=1, keepdims=True)
    nodes[w.n_r - 1 :, 3:] = np.cross(g, nodes[w.n_r - 1 :, 3:], axis=1) / square
    return np.asarray(nodes.reshape(rates.shape))


def shape(mechanism: Mechanism, twists: np.ndarray) -> tuple[Moved, ...]:
    """The bodies that move, from complex world-axes rates of all of them."""
    moves = twists.reshape(-1, 6) * np.array([1.0] * 3 + [mechanism.model.size] * 3)
    largest = moves.flat[int(np.argmax(np.abs(moves)))] if moves.size else 0.0
    if largest == 0.0:
        return ()  # of element states alone
    real = (moves / largest).real
    names = {f: name for name, f in mechanism.frames.items()}
    return tuple(
        Moved(names[f], tuple(row[:3].tolist()), tuple(row[3:].tolist()))
        for f, row in enumerate(real, 1)
        if f in names and np.abs(row).max() > 1e-6
    )
