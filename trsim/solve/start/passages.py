"""How far a step of a search for rest may go: nothing may pass through what it would touch.

A search for a balance takes steps that know nothing of what is still open.  A ball that passes an
open profile, or a thin body, inside one of them is pressed on from behind, and comes to rest there.
So the way of a step is looked at in parts that go no further than a ball is from its surface and a
part of its own way through.  Between two looks a centre has come to the other side if its depth
would have risen, by its rates at both, beyond what it takes to get there:

    top = g_0 + r_0 x,    x = (g_1 - r_1 h - g_0) / (r_0 - r_1)        r_0 > 0 > r_1

with h the part of the step between them, by which rates are.

Then the step ends where that touch began.
"""

from collections.abc import Callable
from math import inf

import numpy as np
from numpy.typing import NDArray

from trsim.assemble.equations import gaps, poses
from trsim.assemble.mechanism import Mechanism
from trsim.elements.frames import cross
from trsim.elements.scene import Scene
from trsim.elements.touching import Own
from trsim.laws.surfaces import PLANE, PROFILE

Array = NDArray[np.float64]

SURFACES = ("surface", "outline")  # travel of what touches at a place that is sought
PART = 0.2  # of the way through: what a ball is moved on between two looks, beside its gap
BEHIND = 0.5  # of the way through: a depth that turned round beyond it is one of the other side
LOOKS = 200  # at the way of one step; it ends where they do
HALVED = 0.5  # a part that began in touch and came out behind


class Passages:
    """What balls might pass through, and which part of a step is free of that."""

    def __init__(self, mechanism: Mechanism, work: Scene) -> None:
        self.work = work
        rows = [e for e in work.contact.tolist()
                if mechanism.instances[e].row.travel in SURFACES]  # fmt: skip
        ways = {int(e): way_through(Own(work, e)) for e in rows}
        self.ways = {e: way for e, way in ways.items() if 0.0 < way < inf}

    def seen(self, y: Array, v: Callable[[], Array]) -> dict[int, tuple[float, float, float]]:
        """Depth of each touch, its rate, and how fast the ball moves along the surface's body.

        v: of the rates of a step, along the axes of the solve, at the poses of the workspace.
        """
        w, y = self.work, y.copy()
        poses(w, y)
        y[w.n_q : w.n_q + w.n_v] = v()
        poses(w, y)
        gaps(w, 0.0)
        return {e: (*w.gap[e].tolist(), self.speed(e)) for e in self.ways}

    def speed(self, e: int) -> float:
        """Of the ball's centre seen from the body of the surface, and of an outline's corners."""
        w, own = self.work, Own(self.work, e)
        i, j = int(own.i), int(own.j)
        arm = w.X[j, 3:].reshape(3, 3) @ np.array(own.p_j)
        spin = w.V[j, 3:] - w.V[i, 3:]
        off = w.X[j, :3] + arm - w.X[i, :3]
        v = w.V[j, :3] + turned(w.V[j, 3:], arm) - w.V[i, :3] - turned(w.V[i, 3:], off)
        return float(np.linalg.norm(v) + own.span * np.linalg.norm(spin))

    def free(self, place: Callable[[float], Array], v: Callable[[], Array]) -> float:
        """The part of a step, 1 of all of it, that passes through nothing.

        place: y at a part of it; v: as in `seen`.
        """
        if not self.ways:
            return 1.0
        done, share = 0.0, PART
        began: dict[int, float] = {}  # where touches began
        here = self.seen(place(0.0), v)
        for _ in range(LOOKS):
            parts = [(max(-here[e][0], 0.0) + share * way) / max(here[e][2], 1e-300)
                     for e, way in self.ways.items()]  # fmt: skip
            part = min(1.0 - done, *parts)
            there = self.seen(place(done + part), v)
            behind = [e for e, way in self.ways.items() if top(here[e], there[e], part)
                      > BEHIND * way]  # fmt: skip
            if behind:
                back = min(began.get(e, done) for e in behind)
                if back > 0.0:
                    return back
                share *= HALVED
                continue
            done += part
            if done >= 1.0:
                return 1.0
            for e, (depth, _, _) in there.items():
                if depth <= 0.0:
                    began.pop(e, None)
                elif here[e][0] <= 0.0:
                    began[e] = done
            here = there
        return done


def turned(spin: Array, arm: Array) -> Array:
    """The velocity of the end of an arm: numpy's product takes ten times as long over three."""
    return np.array(cross.python(spin.tolist(), arm.tolist()))


def way_through(own: Own) -> float:
    """How far a ball goes from its touch until its centre is on the other side, at least; inf of
    what has no other side."""
    if own.shape == PLANE or own.free < 0.0:
        return inf
    if own.shape == PROFILE:
        return float(own.ball if own.ball > 0.0 else own.sharp)
    return float(own.ball + own.radius)


def top(first: tuple[float, float, float], last: tuple[float, float, float], part: float) -> float:
    """The depth that two looks would have met between them if it rose and fell at their rates; -inf
    where it did not do both."""
    (g0, r0, _), (g1, r1, _) = first, last
    if not r0 > 0.0 > r1:
        return -inf
    return g0 + r0 * (g1 - r1 * part - g0) / (r0 - r1)
