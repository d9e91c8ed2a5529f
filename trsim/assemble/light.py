"""Bodies without mass, or without inertia about an axis, where the joints determine their motion.

    M a + J^T lam = F,  J a = gamma       has a solution where M is positive definite on what J
                                          leaves free, though M is not

A light body is solved for with a little of both, E, and what that makes of the equations is taken
back with the factors at hand until nothing changes:

    (M + E) a' + J^T lam' = F + E a       each time the error shrinks by about E over what of the
                                          other masses moves with the body

so a, lam and the kinetic energy are those of M.  Velocities at events are nearest in the metric of
M, too.  Positions are brought to the rows in the metric of M + E, like any that is at hand.
"""

from collections.abc import Callable
from math import nan, sqrt
from typing import Any

import numpy as np
from numpy.typing import NDArray

from trsim.assemble.dense import spaces, symmetric
from trsim.assemble.equations import DERIVATIVE, constraints, poses
from trsim.assemble.linear import solve
from trsim.assemble.on_beams import PULL, call_beams
from trsim.assemble.reduce import moves, roots, spread_out, times_roots
from trsim.assemble.schur import pull
from trsim.elements.contract import DRIVES, compiled
from trsim.elements.scene import Model, Scene
from trsim.errors import ModelError
from trsim.kernels.lazy import internal
from trsim.kernels.vectors import clear, clear_table

Array = NDArray[np.float64]

SHARE = 1e-6  # of the masses of the mechanism: what a body without any is solved with
NONE = 1e-12  # of its largest: a moment of inertia that is none
ENOUGH, MOST = 1e-14, 40  # of the accelerations; times something is taken back
LEAST = 1e-9  # of M + E: of a motion left free that has less the arithmetic knows nothing


# --- tables ----------------------------------------------------------------------------------


def lacking(
    name: str, spec: Any, reference: Callable[[], tuple[float, float]], planar: bool
) -> Array | None:
    """E of a body: a mass, and an inertia (9) along its axes; None where it lacks nothing.

    reference: what stands for a mass of the mechanism, and an arm; asked for where it lacks one.
    Raises ModelError for a mass or a moment below zero.
    """
    tensor, complete = spec.tensor
    if spec.mass > 0.0 and plainly_heavy(tensor, planar or not complete):
        return None
    found = np.zeros(10)

    def moment() -> float:
        mass, arm = reference()
        return SHARE * mass * arm * arm

    if spec.mass == 0.0:
        found[0] = SHARE * reference()[0]
    if planar or not complete:
        if tensor[8] < 0.0:
            raise below_zero(name)
        found[9] = moment() if tensor[8] == 0.0 else 0.0
        if not complete:
            found[[1, 5]] = found[9]
        return found if found.any() else None
    values, axes = symmetric(np.reshape(tensor, (3, 3)))
    none = NONE * max(float(values[-1]), 0.0)
    if values[0] < -none:
        raise below_zero(name)
    light = axes[:, values <= none]
    if light.shape[1]:
        found[1:] = (moment() * light @ light.T).ravel()
    return found if found.any() else None


def plainly_heavy(tensor: tuple[float, ...], about_z: bool) -> bool:
    """Whether a body has moments about its axes, or about z, and the former are principal ones."""
    if about_z:
        return tensor[8] > 0.0
    if tensor[1] or tensor[2] or tensor[5]:
        return False
    moments = tensor[::4]
    return min(moments) > NONE * max(moments)


def unfit(names: list[str], frames: NDArray[np.int64], rows: list[Any], rubs: bool) -> None:
    """Refuse what is not solved for beside light bodies: contacts on them, friction of joints."""
    for name, f in zip(names, frames, strict=True):
        path = ("bodies", name, "mass")
        if any(row.contact is not None and f in row.con[:2] for row in rows):
            what = "a contact or a stop acts on a body without mass or inertia: nothing slows it"
            raise ModelError(what, "give it what it weighs", path)
        if rubs:
            what = "friction of joints is not solved for beside bodies without mass or inertia"
            raise ModelError(what, "give it what it weighs", path)


def below_zero(name: str) -> ModelError:
    """The error of an inertia that no body has."""
    return ModelError(
        "a moment of inertia below zero", "check the moments and products",
        ("bodies", name, "inertia"),
    )  # fmt: skip


def check_determined(mechanism: Any, model: Model, work: Scene, y: Array) -> None:
    """Refuse a light body whose motion is left open in a stage of a run, by its name.

    model, work: of the stage that begins; work knows the turns and places on curves of y.
    """
    if not len(model.light):
        return
    planar = model.d == 3
    poses(work, y)
    constraints(work, 0.0)
    J = spread_out(work, model.m)
    C, keep = roots(work, y, planar), moves(model, planar)
    rows = times_roots(J, C)[:, keep]  # against motions that have the mass 1 in M + E
    size = np.sqrt(np.sum(rows * rows, axis=1))
    rows = rows[size > 0.0] / size[size > 0.0, None]
    free = spaces(rows, 1e-10)[1] if len(rows) else np.eye(int(np.sum(keep)))
    if not len(free):
        return
    ways = np.zeros((len(free), len(C), 6))
    ways.reshape(len(free), -1)[:, keep] = free
    lost = np.zeros((len(free), len(free)))
    parts = []
    for q, f in enumerate(model.light):
        part = ways[:, f - 1] @ (C[f - 1].T @ of_light(work, q, f) @ C[f - 1])
        parts.append(part @ ways[:, f - 1].T)
        lost += parts[-1]
    share, vectors = symmetric(np.eye(len(free)) - lost)
    if share[0] > LEAST:
        return
    q = int(np.argmax([vectors[:, 0] @ part @ vectors[:, 0] for part in parts]))
    f = int(model.light[q])
    name = next(name for name, frame in mechanism.frames.items() if frame == f)
    twist = C[f - 1] @ (vectors[:, 0] @ ways[:, f - 1])
    turns = np.linalg.norm(twist[3:]) * model.size > np.linalg.norm(twist[:3])
    key = "inertia" if turns else "mass"
    raise ModelError(
        f"a body without {key} is free to {'turn' if turns else 'move'} where the joints leave it "
        "so: nothing with mass moves with it, and its motion is not determined",
        f"give it {'an inertia' if turns else 'a mass'}, or a joint that holds it",
        ("bodies", name, key),
    )


def of_light(work: Scene, q: int, f: int) -> Array:
    """E of a light body against its world-axes rates (6, 6)."""
    R, E = work.X[f, 3:].reshape(3, 3), np.zeros((6, 6))
    E[:3, :3] = work.lacking[q, 0] * np.eye(3)
    E[3:, 3:] = R @ work.lacking[q, 1:].reshape(3, 3) @ R.T
    return E


# --- accelerations ---------------------------------------------------------------------------


@compiled(DERIVATIVE)
def lightened(s, t, y, yd):
    """The multipliers and accelerations of M, from those of M + E just solved for."""
    clear_table(s.given_back)
    for _ in range(MOST):
        for f in range(1, s.n_r):
            pull(s, f, s.x)
        if s.n_r < s.n:
            call_beams(s.on_beams[PULL], s, s.x, s.x, 0)
        changed = give_back(s)
        clear(s.x)
        if changed <= ENOUGH:
            return
        felt_by_rows(s)
        solve(s, s.x)
        for k in range(s.m):
            s.lam[k] += s.x[k]
            s.zd[DRIVES] += s.x[k] * s.phi_t[k]
    s.status[3] += 1
    for k in range(s.x.size):
        s.x[k] = nan


@internal
def felt_by_rows(s):
    """x += J of what light bodies were just given back, in s.moved."""
    for f in s.light:
        for p in range(s.frame_start[f], s.frame_start[f + 1]):
            for a in range(s.d):
                s.x[s.slot_row[p]] += s.B[p, a] * s.moved[f, a]


@internal
def give_back(s):
    """free += (M + E)^-1 (E a + omega x E omega) less what was given back before, which is left in
    s.moved; by how much that changes accelerations, of their size."""
    most = 0.0
    for q in range(s.light.shape[0]):
        f, E, given = s.light[q], s.lacking[q], s.given_back[q]
        a, more = s.free[f], s.moved[f]
        by_mass, K = s.mass_inverse[f], s.inertia_inverse[f]
        width = 2 if s.d == 3 else 3
        size, change = 0.0, 0.0
        for c in range(width):
            more[c] = by_mass * E[0] * a[c] - given[c]
            size, change = size + a[c] * a[c], change + more[c] * more[c]
        if s.d == 3:
            more[2] = K[8] * E[9] * a[2] - given[2]
            size, change = size + (s.size * a[2]) ** 2, change + (s.size * more[2]) ** 2
        else:
            X, V = s.X, s.V
            o0 = X[f, 3] * V[f, 3] + X[f, 6] * V[f, 4] + X[f, 9] * V[f, 5]
            o1 = X[f, 4] * V[f, 3] + X[f, 7] * V[f, 4] + X[f, 10] * V[f, 5]
            o2 = X[f, 5] * V[f, 3] + X[f, 8] * V[f, 4] + X[f, 11] * V[f, 5]
            h0 = E[1] * o0 + E[2] * o1 + E[3] * o2
            h1 = E[4] * o0 + E[5] * o1 + E[6] * o2
            h2 = E[7] * o0 + E[8] * o1 + E[9] * o2
            m0 = E[1] * a[3] + E[2] * a[4] + E[3] * a[5] + (o1 * h2 - o2 * h1)
            m1 = E[4] * a[3] + E[5] * a[4] + E[6] * a[5] + (o2 * h0 - o0 * h2)
            m2 = E[7] * a[3] + E[8] * a[4] + E[9] * a[5] + (o0 * h1 - o1 * h0)
            for c in range(3):
                now = K[3 * c] * m0 + K[3 * c + 1] * m1 + K[3 * c + 2] * m2
                more[3 + c] = now - given[3 + c]
                size += (s.size * a[3 + c]) ** 2
                change += (s.size * more[3 + c]) ** 2
        for c in range(s.d):
            a[c] += more[c]
            given[c] += more[c]
        if change > 0.0:
            most = max(most, sqrt(change / size) if size > 0.0 else 1.0)
    return most


# --- velocities ------------------------------------------------------------------------------


def nearest_in_mass(
    number: int, given: Array, nearest: Callable[[Array], Array], shared: Callable[[Array], Array]
) -> Array:
    """Of the velocities that rows allow the nearest to some in the metric of M.

    number: of light bodies; nearest: v -> those nearest to v in the metric of M + E; shared: v ->
    (M + E)^-1 E v.
    """
    v = nearest(given)
    for _ in range(MOST if number else 0):
        before, v = v, nearest(given + shared(v - given))
        if np.abs(v - before).max() <= ENOUGH * np.abs(before).max():
            break
    return v


def given_back(work: Scene, C: Array, v: Array) -> Array:
    """(M + E)^-1 E v of world-axes rates (6 (n-1)), with C C^T = (M + E)^-1; poses as they are."""
    found = np.zeros_like(v)
    for q, f in enumerate(work.light):
        own = slice(6 * (f - 1), 6 * f)
        found[own] = C[f - 1] @ C[f - 1].T @ of_light(work, q, f) @ v[own]
    return found


def given_back_in_own(work: Scene, v: Array) -> Array:
    """The same of velocities in the axes of the solve (n_v)."""
    found = np.zeros_like(v)
    for q, f in enumerate(work.light):
        own = slice(work.d * (f - 1), work.d * f)
        inverse = block(work, work.mass_inverse[f], work.inertia_inverse[f])
        found[own] = inverse @ block(work, work.lacking[q, 0], work.lacking[q, 1:]) @ v[own]
    return found


def block(work: Model, mass: float, inertia: Array) -> Array:
    """A mass and an inertia (9) as a matrix (d, d) in the axes of the solve."""
    if work.d == 3:
        return np.diag([mass, mass, inertia[8]])
    found = np.zeros((6, 6))
    found[:3, :3], found[3:, 3:] = mass * np.eye(3), inertia.reshape(3, 3)
    return found
