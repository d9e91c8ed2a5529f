"""A test bench: two bodies in space with one element between them, evaluated where one likes.

The bodies are drawn turned and away from their joint, so that no arm is zero and no axis is the
world's.  Poses are then chosen at random, or on the manifold of a joint.
"""

from dataclasses import dataclass
from functools import lru_cache
from typing import Any

import numpy as np

from trsim.assemble.equations import constraints, forces, poses, stored_energy
from trsim.assemble.mechanism import Mechanism
from trsim.elements.contract import (
    BRANCH,
    IMPACT_SPEED,
    N_BOOK,
    PHASE,
    UNLOCATED,
    WHOLE,
)
from trsim.elements.scene import scene

from ..runs import built

TWO_BODIES = """
planar: false
bodies:
  left: {mass: 2, inertia: [0.02, 0.03, 0.04], at: [0.1, -0.2, 0.3], angle: 0.7}
  right: {mass: 3, inertia: [0.05, 0.04, 0.03, 0.001, 0.002, -0.003], at: [0.5, 0.2, -0.1],
          angle: -0.4}
"""


def quaternion(rotation: np.ndarray) -> np.ndarray:
    """Unit quaternion of a rotation vector (axis times angle)."""
    angle = np.linalg.norm(rotation)
    axis = rotation / angle if angle > 0.0 else rotation
    return np.array([np.cos(angle / 2), *(np.sin(angle / 2) * axis)])


def product(p: np.ndarray, q: np.ndarray) -> np.ndarray:
    """The quaternion p o q."""
    (a, b, c, d), (e, f, g, h) = p.tolist(), q.tolist()
    return np.array([
        a * e - b * f - c * g - d * h, a * f + b * e + c * h - d * g,
        a * g + c * e + d * f - b * h, a * h + d * e + b * g - c * f,
    ])  # fmt: skip


def matrix(p: np.ndarray) -> np.ndarray:
    """Rotation matrix of a unit quaternion: 2 u u^T + (w^2 - u^2) I + 2 w u~, u of it, w before."""
    w, x, y, z = p.tolist()
    straight = w * w - x * x - y * y - z * z
    return np.array([
        [2 * x * x + straight, 2 * (x * y - w * z), 2 * (x * z + w * y)],
        [2 * (x * y + w * z), 2 * y * y + straight, 2 * (y * z - w * x)],
        [2 * (x * z - w * y), 2 * (y * z + w * x), 2 * z * z + straight],
    ])  # fmt: skip


@dataclass
class Bench:
    """A mechanism and a state of it: world-axes twists V (n, 6), what the elements remember."""

    mechanism: Mechanism
    r: np.ndarray  # (n, 3) frame 0 is the ground
    p: np.ndarray  # (n, 4)
    V: np.ndarray  # (n, 6)
    z: np.ndarray
    mem: np.ndarray
    t: float = 0.3
    branch: np.ndarray | None = None

    def state(self) -> np.ndarray:
        """y of the mechanism."""
        q = np.hstack([self.r[1:], self.p[1:]]).ravel()
        turned = [matrix(p).T @ o for p, o in zip(self.p[1:], self.V[1:, 3:], strict=True)]
        return np.concatenate([q, np.hstack([self.V[1:, :3], turned]).ravel(), self.z])

    def scene(self) -> Any:
        """The workspace after poses and forces were evaluated."""
        w = scene(self.mechanism.model)
        w.mem[:] = self.mem
        if self.branch is not None:
            w.branch[:] = self.branch
        poses(w, self.state())
        forces(w, self.t)
        return w

    def wrenches(self) -> np.ndarray:
        """Force and moment about the centre of mass of each frame (n, 6)."""
        return self.scene().F.copy()

    def energy(self) -> float:
        return stored_energy(self.scene(), self.t)

    def rows(self) -> Any:
        """The workspace after the constraints were evaluated."""
        w = self.scene()
        constraints(w, self.t)
        return w

    def moved(self, twist: np.ndarray, h: float) -> "Bench":
        """The poses after a time h at constant world-axes twists (n, 6); same velocities."""
        r = self.r + h * twist[:, :3]
        p = np.array([product(quaternion(h * o), p)
                      for o, p in zip(twist[:, 3:], self.p, strict=True)])  # fmt: skip
        return Bench(self.mechanism, r, p, self.V, self.z, self.mem, self.t, self.branch)

    def later(self, h: float) -> "Bench":
        """The motion a little later, at constant twists and rates of the elements' states."""
        there = self.moved(self.V, h)
        there.t = self.t + h
        there.z = self.z + h * self.scene().zd
        return there

    @property
    def book(self) -> np.ndarray:
        """Powers into the mechanism: drives, loads, dampers, impacts, friction (W)."""
        return self.scene().zd[:N_BOOK].copy()


@lru_cache(maxsize=256)
def assembled(text: str) -> Mechanism:
    """The mechanism of a text, made once: poses and memory are in each Bench, nothing is in it."""
    return built(text)


def bench(
    text: str, rng: np.random.Generator, bodies: str = TWO_BODIES, speed: float = 1.0
) -> Bench:
    """The mechanism of a text, its bodies thrown into random poses and twists."""
    mechanism = assembled(bodies + text)
    n = mechanism.model.n
    r, V = rng.normal(size=(n, 3)), speed * rng.normal(size=(n, 6))
    p = rng.normal(size=(n, 4))
    p /= np.linalg.norm(p, axis=1)[:, None]
    r[0], V[0], p[0] = 0.0, 0.0, (1.0, 0.0, 0.0, 0.0)
    mem = np.zeros((len(mechanism.model.con), mechanism.model.n_mem))
    mem[:, PHASE], mem[:, IMPACT_SPEED], mem[:, BRANCH] = UNLOCATED, 0.8, WHOLE
    z = np.zeros(mechanism.model.n_z)
    return Bench(mechanism, r, p, V, z, mem)


THIRD = """
  third: {mass: 1, inertia: [0.02, 0.05, 0.04, 0.002, 0.001, 0.003], at: [-0.3, 0.4, 0.2],
          angle: 1.1}
"""


def drawn(b: Bench, name: str) -> tuple[np.ndarray, np.ndarray]:
    """Position and quaternion of a body as drawn."""
    spec = {
        "left": (0.1, -0.2, 0.3, 0.7),
        "right": (0.5, 0.2, -0.1, -0.4),
        "third": (-0.3, 0.4, 0.2, 1.1),
    }[name]
    return np.array(spec[:3]), quaternion(np.array([0.0, 0.0, spec[3]]))


def put_right(
    b: Bench, at: np.ndarray, turn: np.ndarray, shift: np.ndarray, name: str = "right"
) -> None:
    """Place the right body, or another, so that it is as drawn against the left one, but for a turn
    about the point `at` and then a shift, both in world axes as drawn."""
    (r_i, p_i), (r_j, p_j) = drawn(b, "left"), drawn(b, name)
    f = b.mechanism.frames[name]
    q = quaternion(turn)
    r_j, p_j = at + matrix(q) @ (r_j - at) + shift, product(q, p_j)
    now = product(b.p[1], p_i * [1, -1, -1, -1])  # from drawn axes to those of the left body now
    b.r[f], b.p[f] = b.r[1] + matrix(now) @ (r_j - r_i), product(now, p_j)


def now(b: Bench, direction: np.ndarray) -> np.ndarray:
    """A world direction as drawn, turned with the left body."""
    _, p_i = drawn(b, "left")
    return matrix(product(b.p[1], p_i * [1, -1, -1, -1])) @ direction


# --- properties ------------------------------------------------------------------------------


def check_gradient(b: Bench, h: float = 1e-5, rel: float = 1e-7) -> None:
    """The wrenches are minus the gradient of the stored energy.  Velocities are taken away."""
    still = Bench(b.mechanism, b.r, b.p, 0.0 * b.V, b.z, b.mem, b.t, b.branch)
    F = still.wrenches()[1:].ravel()
    gradient = []
    for k in range(6, 6 * len(b.r)):
        twist = np.zeros(6 * len(b.r))
        twist[k] = 1.0
        twist = twist.reshape(-1, 6)
        gradient.append(
            (still.moved(twist, h).energy() - still.moved(twist, -h).energy()) / (2 * h)
        )
    assert np.abs(F).max() > 0.0, "nothing acts"
    np.testing.assert_allclose(F, -np.array(gradient), rtol=0, atol=rel * np.abs(F).max())


def check_action_is_reaction(b: Bench, F: np.ndarray | None = None) -> None:
    """Forces, and moments about any point, add up to zero over all bodies and the ground."""
    F = b.wrenches() if F is None else F
    assert np.abs(F).max() > 0.0, "nothing acts"
    about = np.array([0.3, -1.0, 2.0])
    moments = np.cross(b.r - about, F[:, :3]) + F[:, 3:]
    size = np.abs(moments).max() + np.abs(F).max()
    assert np.abs(F[:, :3].sum(axis=0)).max() < 1e-13 * size
    assert np.abs(moments.sum(axis=0)).max() < 1e-13 * size


def check_power(b: Bench, h: float = 1e-5, rel: float = 1e-7) -> None:
    """What the book takes in is what the bodies get and what is stored:  F . V + E' = powers."""
    given = float(np.sum(b.wrenches() * b.V))
    stored = (b.later(h).energy() - b.later(-h).energy()) / (2 * h)
    scale = np.abs(b.wrenches() * b.V).sum() + abs(stored)
    assert scale > 0.0
    assert abs(given + stored - b.book.sum()) < rel * scale
