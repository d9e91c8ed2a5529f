"""What friction in a joint does to an explicit method, pressed as at the start.

    ramp       N mu / ((v1 - v0) m)                           of modified Coulomb friction
    bristles   m s'' + N sigma1 s' + N sigma0 s = 0           at rest
               sigma0 |s'| / mu                               sliding

1/m = g Z Z^T g^T with g the gradient of what slides against the twists and Z the free motions.
"""

from collections.abc import Iterator
from typing import Any

import numpy as np

from trsim.assemble.equations import derivative
from trsim.assemble.mechanism import Mechanism
from trsim.assemble.reduce import against_rates
from trsim.elements.contract import Load
from trsim.elements.scene import scene
from trsim.solve.diagnose.linearised import Linearised
from trsim.solve.start.consistent import Start


def rub_scales(
    mechanism: Mechanism, begun: Start, linear: Linearised
) -> Iterator[tuple[complex, str]]:
    """Eigenvalues of every friction of a joint by itself, 1/s, and its name."""
    model = mechanism.model
    if not len(model.rubbing):
        return
    w = scene(model)
    w.mem[:], w.branch[:] = begun.mem, begun.branch
    derivative(w, 0.0, begun.y, np.zeros_like(begun.y))
    for e in model.rubbing[:, 0].tolist():
        instance = mechanism.instances[e]
        stiffness, damping, bending = instance.row.grips
        load = Load(w, e)
        N, slip = load.normal + load.preload, abs(load.slip)
        inverse = mobility(w, e, instance, linear.twists)
        k, c = N * stiffness * inverse, 0.5 * N * damping * inverse
        found = -c - np.emath.sqrt(c * c - k)
        for value in (found, -bending * slip):
            if value != 0.0:
                yield complex(value), instance.name


def mobility(w: Any, e: int, instance: Any, twists: Any) -> float:
    """1/m of what slides there, 1/kg."""
    w.F[:] = 0.0
    w.rubbed[:] = 0.0
    w.rubbed[e] = 1.0
    instance.element.kernels["rub"](0.0, w, e, e + 1)
    return float(np.sum((against_rates(w, w.F[1:].reshape(1, -1))[0] @ twists) ** 2))
