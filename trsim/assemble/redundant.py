"""Which rows are redundant: those that depend on others at the drawn position and near it.

Rows are judged by rank at several consistent positions: what is dependent only at the drawn one (a
dead centre, a parallelogram lying flat) is singular, not redundant, and kept.
"""

from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from trsim.assemble.dense import least_squares, product
from trsim.assemble.equations import poses
from trsim.assemble.onward import Branches
from trsim.assemble.rank import DEPENDENT, dependent_rows
from trsim.assemble.reduce import closed, displaced, jacobian, weights, world_rates
from trsim.elements.scene import Model, workspace

Array = NDArray[np.float64]

NEARLY = 1e-6  # the same at nearby positions, where an error of the drawing has grown
SAMPLES = 4
ROUNDING = 1e-9  # of the rates given
SPREAD = 0.03  # of the mechanism's size and rad: how far positions are perturbed


@dataclass(frozen=True)
class Dependence:
    """One dependent row."""

    row: int
    everywhere: bool  # at all nearby positions: redundant; only as drawn: singular


def dependences(
    model: Model, y: Array, keep: NDArray[np.bool_], order: list[int], geometric: list[int],
    here: set[int] | None = None,
) -> list[Dependence]:  # fmt: skip
    """Dependent rows as drawn, and whether they stay so at nearby consistent positions.

    keep: world-axes rates that there are; order: priority of the rows; geometric: the rows
    positions must keep to when perturbed (all but the drives); here: the dependent rows as drawn,
    where they are known.
    """
    scale = weights(model)[keep]
    if here is None:
        here = dependent_rows(jacobian(model, 0.0, y)[2][:, keep], scale, order)
    if not here:
        return []
    samples = [jacobian(model, 0.0, near)[2][:, keep] for near in nearby(model, y, keep, geometric)]
    always = everywhere(samples, scale, order, here) if samples else here
    return [Dependence(k, k in always) for k in sorted(here | always)]


def everywhere(samples: list[Array], scale: Array, order: list[int], here: set[int]) -> set[int]:
    """Rows that may go at all samples of J; as many as depend on others at each of them, where one
    choice serves for all.

    Of two rows either of which may go, the one goes that leaves rows which hold as drawn too: here,
    the choice at the drawn position, comes first, then a part of it.
    """
    last = sorted(order, key=lambda k: k in here)
    there = []
    for J in samples:
        found = dependent_rows(J, scale, order, NEARLY)
        if len(found) > len(here):  # no rank is lower there: these rows are nearly parallel
            found = dependent_rows(J, scale, order)
        there.append(found)
    fewest = min(map(len, there))
    always = set.intersection(*there)
    some = [dependent_rows(J, scale, last, NEARLY) for J in samples]
    for chosen in (here, *some, always, *there):
        left = [k for k in order if k not in chosen]
        if len(chosen) == fewest and all(
            len(dependent_rows(J, scale, left, NEARLY)) <= len(found) - fewest
            for J, found in zip(samples, there, strict=True)
        ):
            return chosen
    return always


def nearby(
    model: Model, y: Array, keep: NDArray[np.bool_], geometric: list[int]
) -> Iterator[Array]:
    """Consistent positions around y, SPREAD away in the world-axes rates `keep`.

    geometric: the rows positions keep to.  At most one on the way of the velocities given and of
    drives, which is the branch that counts, and SAMPLES; always the same ones.  They are reached
    along motions the rows allow, and that go on where branches meet: from elsewhere Newton follows
    the nearly dependent directions of redundant rows far away, to where these rows happen to be
    independent.  Where such a motion ends at once (a dead centre, nothing moves) they are reached
    from anywhere, but for the first.
    """
    work = workspace(model)
    rng = np.random.default_rng(0)
    rows = np.array(geometric, np.int64)
    scale = weights(model)[keep]
    J = jacobian(model, 0.0, y)[2][rows][:, keep]
    branches = Branches(work, y, geometric, moving=keep)
    size = np.tile([model.size] * 3 + [1.0] * 3, model.n - 1)[keep]
    ways = [SPREAD * rng.normal(size=size.size) * size for _ in range(SAMPLES)]
    for along, way in ((True, begun(model, y, keep, size)), *((False, way) for way in ways)):
        free = way - scale * least_squares(J * scale, product(J, way), DEPENDENT)
        if model.n == model.n_r:
            goes = np.zeros(keep.size)
            goes[keep] = free
            free = branches.onward(goes, at_rest=False)[keep]
        far = np.max(np.abs(free / size))
        moving = free * (SPREAD / max(far, 1e-3 * SPREAD))
        for step in (moving,) if along else (moving, way):
            dx = np.zeros(keep.size)
            dx[keep] = step
            near, left = closed(model, displaced(model, y, dx), rows, keep)
            moved = distance(model, y, near)
            if left <= 1e-9 * model.size and (moved > 0.1 * SPREAD or step is way):
                yield near
                break


def begun(model: Model, y: Array, keep: NDArray[np.bool_], size: Array) -> Array:
    """The rates `keep` nearest to those given that rows and drives allow, made as long as SPREAD;
    zero where nothing moves."""
    _, phi_t, J = jacobian(model, 0.0, y)
    scale, J = weights(model)[keep], J[:, keep]
    given = world_rates(model, y)[keep]
    off = product(J, given) + phi_t
    rates = np.asarray(given - scale * least_squares(J * scale, off, DEPENDENT))
    far = float(np.max(np.abs(rates / size), initial=0.0))
    if far <= ROUNDING * float(np.max(np.abs(given / size), initial=0.0)):
        return np.zeros_like(given)
    return rates * (SPREAD / far)


def distance(model: Model, y: Array, near: Array) -> float:
    """How far one position is from another: of the mechanism's size, or in the axes of a body."""
    w = workspace(model)
    poses(w, y)
    before = w.X.copy()
    poses(w, near)
    apart = np.abs(w.X - before)
    apart[:, :3] /= model.size
    return float(np.max(apart))
