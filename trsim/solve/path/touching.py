"""What rubs where it touches: how it slides along a path, and what sticks.

Friction along a path is full beyond a way that is next to nothing, the ramp.  What sticks lies
within, and a guess that is off by more has the friction of full sliding, which no Newton's method
finds its way back from.  So where a step is not found it is looked for with the ramp of what sticks
drawn on beyond its ends, and then with the law as it is from there.
"""

from collections.abc import Iterator
from contextlib import contextmanager
from math import isfinite
from typing import Any

import numpy as np
from numpy.typing import NDArray

from trsim.elements.contract import BRANCH, CONTACT, PHASE
from trsim.elements.scene import Scene
from trsim.laws.friction import CODES

Array = NDArray[np.float64]

ON_RAMP = 1.0  # the branch of `modified_coulomb` that its ramp is


class Touching:
    """Contacts that rub in a direction of their own."""

    def __init__(self, mechanism: Any, work: Scene) -> None:
        self.work = work
        self.kernels: dict[int, Any] = {}
        self.tables: set[int] = set()  # whose branch is that of a table as well
        for e in work.contact.tolist():
            one = mechanism.instances[e]
            kernel, rubs = one.element.kernels.get("slip"), one.element.slides
            if kernel is not None and work.con[e, rubs[0]] != CODES["none"]:
                self.kernels[e] = kernel
                if isfinite(one.row.contact.known_to):
                    self.tables.add(e)

    def slips(self) -> Iterator[tuple[int, Array]]:
        """Sliding velocities of those that are in, at the poses of the scene."""
        w = self.work
        for e, kernel in self.kernels.items():
            if w.mem[e, PHASE] == CONTACT:
                kernel(0.0, w, e, e + 1)
                yield e, w.blow[0, :3].copy()

    @contextmanager
    def on_ramps(self, rows: set[int]) -> Iterator[None]:
        """The law of these with its ramp drawn on."""
        at = sorted(rows)
        before = self.work.mem[at, BRANCH].copy()
        self.work.mem[at, BRANCH] = ON_RAMP
        try:
            yield
        finally:
            self.work.mem[at, BRANCH] = before
