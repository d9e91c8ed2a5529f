"""What goes with positions: the turn every angle is on, and the states that follow a joint."""

from dataclasses import replace
from typing import Any

import numpy as np
from numpy.typing import NDArray

from trsim.assemble.equations import poses
from trsim.assemble.mechanism import Mechanism
from trsim.elements.contract import N_BOOK
from trsim.elements.scene import scene, workspace

Array = NDArray[np.float64]


def with_scene(mechanism: Mechanism) -> Any:
    """The mechanism with a scene for its model: one workspace, and angles that keep their turn."""
    work = scene(mechanism.model)
    for x in mechanism.coordinates.values():
        work.branch[x.entry] = x.drawn
    return replace(mechanism, model=work)


def remember(model: Any, y: Array) -> None:
    """Let angles unwrap from their values at y on."""
    poses(model, y)
    model.branch[:] = model.S[:, 0]


def follow(mechanism: Mechanism, y: Array) -> Array:
    """y with the states that start at a joint coordinate set to its value."""
    model = mechanism.model
    y = y.copy()
    w = workspace(model)
    poses(w, y)
    for k, s in enumerate(mechanism.follows):
        if s >= 0:
            y[model.n_q + model.n_v + N_BOOK + k] = w.S[s, 0]
    return y
