"""Where drives let go on a static path: it goes on without them, or ends there.

Rows of what has let go are gone, and all else is as it was: its coordinate follows equilibrium, and
t stands for what other drives and loads do.  The path ends where nothing follows t any more, and
where nothing holds what was let go: no equilibrium is near, or it is unstable.
"""

from collections.abc import Sequence
from typing import Any

import numpy as np
from numpy.typing import NDArray

from trsim.assemble.mechanism import Mechanism
from trsim.assemble.switches import LOOSE, UserEvent
from trsim.expressions import names
from trsim.solve.path.place import Equations

Array = NDArray[np.float64]


class Held:
    """Which drives hold on, and which have let go."""

    def __init__(self, mechanism: Mechanism) -> None:
        self.mechanism, self.switches = mechanism, mechanism.stages.switches
        self.stage = np.zeros(len(self.switches.names), np.int64)

    @property
    def loose(self) -> set[str]:
        """The names of all drives that have let go."""
        return {self.switches.names[n][1] for n in np.flatnonzero(self.stage == LOOSE)}

    def without(self, events: Sequence[UserEvent]) -> tuple[Mechanism, list[str]]:
        """The mechanism after events have let drives go, and which they are."""
        before = self.loose
        for event in events:
            for n, to in event.turned:
                self.stage[n] = to
        stages = self.mechanism.stages
        found = self.mechanism.in_stage(self.stage, stages.left_out(self.stage))
        return found, sorted(self.loose - before)

    @property
    def still(self) -> bool:
        """Whether nothing follows t any more: no drive, and no load."""
        loose = self.loose
        if any(i.section == "drives" and i.name not in loose for i in self.mechanism.instances):
            return False
        # names are section.name.key
        return not any(
            follows_time(one.spec) for one in self.mechanism.functions
            if one.name.split(".")[:1] != ["drives"]
        )  # fmt: skip


def follows_time(spec: Any) -> bool:
    """Whether a function depends on t."""
    return (spec.kind == "table" and spec.of == "t") or "t" in names(spec.node or ())


def kept(before: Equations, after: Equations, lam: Array) -> Array:
    """The multipliers of the rows that are left."""
    known = dict(zip(before.mechanism.rows, lam.tolist(), strict=True))
    return np.array([known.get(name, 0.0) for name in after.mechanism.rows])


def why(gone: Sequence[str], at: str, found: str) -> str:
    """Why a path ends where drives let go."""
    whose = ", ".join(f"'{name}'" for name in gone)
    return f"{whose} let go at {at}: {found}"
