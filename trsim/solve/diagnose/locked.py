"""Why a run could not go on: whether the mechanism locks where it stands.

At a dead centre that a drive or the motion runs into, the rows of the constraints come to depend on
each other: speeds and reactions grow without bound before it, like 1/sqrt(t* - t), and behind it
there is no position at all.  It shows in the singular values of J, its rows of unit length, angles
taken times the mechanism's size.
"""

import numpy as np
from numpy.typing import NDArray

from trsim.assemble.equations import derivative, poses
from trsim.assemble.mechanism import Mechanism
from trsim.assemble.reduce import (
    closest,
    displaced,
    jacobian,
    moves,
    roots,
    times_roots,
    world_rates,
)
from trsim.elements.scene import Model, Scene, workspace

Array = NDArray[np.float64]

NEARLY = 1e-3  # smallest singular value, of the largest: a place that steps were too short to pass
AHEAD = 0.02  # rad, or of the mechanism's size: how far is looked for a way on
CLOSED = 1e-9  # of the mechanism's size
PARTLY = 0.5  # of that way: a place found nearer is the one it stands at
BACK = -0.9  # cosine: between branches that nearly meet a motion may turn round, but not go back
TURNS = np.pi * np.array([0.5, -0.5, 0.25, -0.25, 0.75, -0.75])  # from the velocity
MOTIONS, APART = 6, 0.1  # how many motions are looked along; the sine of an angle with the velocity
PAIRS = ((2, 1), (0, 2), (1, 0))  # entries of a skew matrix that are its vector
TAKES_PART = 0.1  # of the largest entry of the dependent combination of rows


def locked(mechanism: Mechanism, t: float, y: Array) -> str:
    """Which rows depend on each other at (t, y), in words; empty where none do."""
    names, smallest = dependent(mechanism, t, y)
    if smallest > NEARLY:
        return ""
    if goes_on(mechanism.model, t, y):
        return (
            "steps became too short to pass a place where branches of the motion nearly meet "
            f"(rows of {', '.join(names)} depend on each other to {smallest:.1g}): the motion goes "
            "on, but as sharply as these are apart; draw lengths that are to be equal to more "
            "digits, or take another `method`"
        )
    return (
        f"the mechanism locks here: {', '.join(names)} leave it no way on (their rows depend on "
        f"each other to {smallest:.1g}); start it elsewhere, drive another joint, or end "
        "before"
    )


def goes_on(model: Model, t: float, y: Array) -> bool:
    """Whether there are positions ahead, as far on as a dead centre would show."""
    if model.n > model.n_r:
        return False
    w, yd = workspace(model), np.zeros_like(y)
    derivative(w, t, y, yd)
    unit = np.tile([model.size] * 3 + [1.0] * 3, model.n - 1)
    speeds = world_rates(w, y) / unit
    speed = float(np.linalg.norm(speeds))
    if speed == 0.0:
        return False
    d, velocity, before = AHEAD / speed, speeds / speed, places(w)
    for way in ways_on(w, t, y, velocity, unit):
        start = displaced(w, y, AHEAD * way * unit)
        start[model.n_q + model.n_v :] += d * yd[model.n_q + model.n_v :]  # where drives are
        near, left = closest(w, t + d, start)
        poses(w, near)
        moved = displacement(before, places(w)) / unit
        far = float(np.linalg.norm(moved))
        along = float(moved @ velocity)
        if left <= CLOSED * model.size and far > PARTLY * AHEAD and along > BACK * far:
            return True
    return False


def ways_on(model: Model, t: float, y: Array, velocity: Array, unit: Array) -> Array:
    """Unit vectors (k, 6 (n-1)) to look along: the velocity's, then others in the planes of it and
    of each motion that the rows leave free but for their nearly dependent combination."""
    planar = model.d == 3
    C, there = roots(model, y, planar), moves(model, planar)
    rows = times_roots(jacobian(model, t, y)[2], C)[:, there]
    _, _, motions = np.linalg.svd(rows / np.linalg.norm(rows, axis=1, keepdims=True))
    ways = [velocity]
    for motion in motions[model.m - 1 :][:MOTIONS]:
        whole = np.zeros(there.size)
        whole[there] = motion
        free = np.einsum("fij,fj->fi", C, whole.reshape(C.shape[:2])).ravel() / unit
        across = free - (free @ velocity) * velocity
        length = float(np.linalg.norm(across))
        if length > APART * float(np.linalg.norm(free)):  # else it is the velocity's
            ways += [np.cos(x) * velocity + np.sin(x) * across / length for x in TURNS]
    return np.array(ways)


def places(work: Scene) -> tuple[Array, Array]:
    """Places (n-1, 3) and attitudes (n-1, 3, 3) of the moving frames, copied."""
    return work.X[1:, :3].copy(), work.X[1:, 3:].reshape(-1, 3, 3).copy()


def displacement(before: tuple[Array, Array], after: tuple[Array, Array]) -> Array:
    """The displacement (6 (n-1)) from one place to another near it."""
    turn = 0.5 * np.einsum("fij,fkj->fik", after[1], before[1])
    spin = np.stack([(turn - turn.transpose(0, 2, 1))[:, i, j] for i, j in PAIRS], axis=1)
    return np.concatenate([after[0] - before[0], spin], axis=1).ravel()


def dependent(mechanism: Mechanism, t: float, y: Array) -> tuple[list[str], float]:
    """Joints and drives whose rows depend on each other most, and how nearly they do.

    0 where they do, 1 where there are none or a value is not finite.
    """
    model = mechanism.model
    if model.m == 0 or not np.all(np.isfinite(y)):
        return [], 1.0
    J = jacobian(model, t, y)[2] / np.tile([1.0] * 3 + [model.size] * 3, model.n - 1)
    length = np.linalg.norm(J, axis=1, keepdims=True)
    if not np.all(np.isfinite(J)) or not np.all(length > 0.0):
        return [], 1.0
    u, s, _ = np.linalg.svd(J / length)
    smallest = float(s[-1]) if len(s) == model.m else 0.0
    part = np.abs(u[:, -1])
    rows = [n for n, x in zip(mechanism.rows, part, strict=True) if x > TAKES_PART * part.max()]
    names = dict.fromkeys(name.rpartition(".")[0] for name in rows)
    return list(names), smallest / float(s[0])
