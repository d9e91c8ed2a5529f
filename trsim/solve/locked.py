"""Why a run could not go on: whether the mechanism locks where it stands.

At a dead centre that a drive or the motion runs into, the rows of the constraints come to depend on
each other: speeds and reactions grow without bound before it, like 1/sqrt(t* - t), and behind it
there is no position at all.  It shows in the singular values of J, its rows of unit length, angles
taken times the mechanism's size.
"""

import numpy as np
from numpy.typing import NDArray

from trsim.assemble.mechanism import Mechanism
from trsim.assemble.reduce import jacobian

Array = NDArray[np.float64]

NEARLY = 1e-3  # smallest singular value, of the largest: a place that steps were too short to pass
TAKES_PART = 0.1  # of the largest entry of the dependent combination of rows


def locked(mechanism: Mechanism, t: float, y: Array) -> str:
    """Which rows depend on each other at (t, y), in words; empty where none do."""
    names, smallest = dependent(mechanism, t, y)
    if smallest > NEARLY:
        return ""
    return (
        f"the mechanism locks here: {', '.join(names)} leave it no way on (their rows depend on "
        f"each other to {smallest:.1g}); start it elsewhere, drive another joint, or end "
        "before"
    )


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
