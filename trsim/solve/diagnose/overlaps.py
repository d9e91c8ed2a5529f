"""Contacts drawn so deep in each other that they throw their bodies apart as the run begins.

Let go at rest, with nothing else pressing, they part at v with m v^2 / 2 = K d^(n+1) / (n + 1).
Where other forces press them together the gap is hardly accelerated.
"""

from collections.abc import Iterator
from math import sqrt

import numpy as np

from trsim.assemble.equations import derivative, gaps, poses
from trsim.assemble.mechanism import Mechanism
from trsim.elements.contract import ContactNumbers
from trsim.elements.scene import scene, workspace
from trsim.solve.start.consistent import Start
from trsim.solve.start.velocities import gap_gradient

HELD = 0.5  # of the acceleration it would have alone: a gap that has less is pressed together
FAST = 0.1  # m/s or rad/s


def of_overlaps(mechanism: Mechanism, begun: Start) -> Iterator[str]:
    """Each of them."""
    if not len(mechanism.model.contact):
        return
    look = workspace(mechanism.model)
    look.branch[:], look.mem[:] = begun.branch, begun.mem
    poses(look, begun.y)
    gaps(look, 0.0)
    if not np.any(look.gap[mechanism.model.contact, 0] > 0.0):
        return
    w = scene(mechanism.model)
    w.branch[:], w.mem[:] = begun.branch, begun.mem
    derivative(w, 0.0, begun.y, np.empty(begun.y.size))
    gaps(w, 0.0)
    depth, A = w.gap[:, 0].copy(), w.A[1:].copy()
    for c, e in enumerate(mechanism.model.contact.tolist()):
        own, d, there = ContactNumbers(w, c), float(depth[e]), mechanism.instances[e]
        K, n, m = float(own.stiffness), float(own.exponent), float(own.mass)
        if not d > 0.0:
            continue
        apart = -float(np.sum(gap_gradient(w, begun.y, there, e) * A.ravel()))
        if not apart > HELD * K * d**n / m:
            continue
        v = sqrt(2.0 * K * d ** (n + 1.0) / ((n + 1.0) * m))
        unit = "rad" if there.row.turns else "m"
        if v > FAST:
            yield (
                f"{there.section}.{there.name}: is {d:.3g} {unit} deep in contact at the start, "
                f"which throws its bodies apart at about {v:.3g} {unit}/s; draw them apart, or "
                "begin in equilibrium (`initial: {equilibrium: all}`)"
            )
