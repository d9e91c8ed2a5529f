"""Elastic forces of flexible bars, apart from all other forces, and their tangent.

Differences of forces in which the stretching of a bar takes part are as good as EA times the
rounding of its strain; its tangent is exact, and what is left is no stiffer than the rest.
"""

import numpy as np
from numpy.typing import NDArray

from trsim.assemble.equations import poses, stiffnesses
from trsim.assemble.mechanism import Mechanism
from trsim.assemble.reduce import moves
from trsim.elements.scene import Scene, carried

Array = NDArray[np.float64]


def softened_bars(mechanism: Mechanism, work: Scene, s: float) -> Scene:
    """The scene with bars of 1 / s of their stiffness."""
    par = work.par.copy()
    for e in bars(mechanism):
        par[e, list(mechanism.instances[e].element.elastic)] /= s
    return carried(work, work.replaced(par=par))


def bars_alone(mechanism: Mechanism, work: Scene) -> Scene:
    """The scene with no forces but those of bars, undamped, and their weight."""
    par = work.par.copy()
    for e in bars(mechanism):
        par[e, list(mechanism.instances[e].element.viscous)] = 0.0
    return carried(work, work.replaced(force=forces_of(work, bars=True), par=par))


def without_bars(work: Scene) -> Scene:
    """The scene with no forces of bars, nor their weight, which is the same everywhere."""
    return carried(work, work.replaced(force=forces_of(work, bars=False)))


def forces_of(work: Scene, bars: bool) -> NDArray[np.int64]:
    """The table of forces of bars, or of all else."""
    own = work.stiffness[:, 1:].tolist()
    rows = [row for row in work.force.tolist() if (row[1:] in own) == bars]
    return np.array(rows, np.int64).reshape(-1, 3)


def bars(mechanism: Mechanism) -> list[int]:
    """Rows of the flexible bars among the elements."""
    return [e for e, i in enumerate(mechanism.instances) if i.element.elastic]


def elastic_stiffness(work: Scene, y: Array) -> Array:
    """K of the elements of bars against the world-axes rates (6 (n-1), 6 (n-1))."""
    poses(work, y)
    stiffnesses(work, 0.0)
    K = np.zeros((6 * (work.n - 1), 6 * (work.n - 1)))
    for first, nodes, _, element in work.beam.tolist():
        for k in range(nodes - 1):
            at = slice(6 * (first + k - 1), 6 * (first + k + 1))
            K[at, at] += work.tangent[12 * (element + k) : 12 * (element + k + 1)]
    return K


def acted_on(mechanism: Mechanism, at_rest: bool = False) -> NDArray[np.int64]:
    """World-axes rates on which more than the elastic forces of bars may depend.

    All there are of rigid bodies and of nodes with a joint or a load, and of damped bars unless
    they are at rest.
    """
    model = mechanism.model
    frames = set[int]()
    for instance in mechanism.instances:
        own = instance.section in ("bodies", "")
        damped = not at_rest and any(instance.row.par[c] > 0.0 for c in instance.element.viscous)
        if damped or not own:
            frames |= instance.element.acts_on(instance.row)
    acted = np.zeros((model.n - 1, 6), bool)
    acted[[f - 1 for f in {*range(1, model.n_r), *frames} - {0}]] = True
    return np.flatnonzero(acted.ravel() & moves(model, model.d == 3))
