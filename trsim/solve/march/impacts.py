"""Touches that take no time: velocities jump, and every joint takes its part of the blow.

    M (v+ - v-) = W p - J^T Lambda,   J v+ = -Phi_t          W: what an impulse of 1 does to bodies
    G = W^T (v+ - v-)                 of impulses of 1: inverse masses, with all joints

which laws/impact.py turns into p.  Impacts of one instant come one after the other: the fastest
approach first, and of equal ones that which stands first in the file, until nothing approaches
faster than its slowest impact.  What rests on its spring is struck too, and what touches in flight.
What then still approaches of those that have just met is brought to rest by a blow without
restitution, and rests.  Springs, and friction of joints, do nothing in no time.
"""

from functools import partial
from typing import Any

import numpy as np
from numpy.typing import NDArray

from trsim.assemble.equations import derivative, gaps, poses, strikes
from trsim.assemble.light import block, given_back_in_own, nearest_in_mass
from trsim.assemble.projection import project_velocities
from trsim.elements.contract import (
    CONTACT,
    DRIVES,
    FLIGHT,
    FRICTION,
    IMPACTS,
    ContactNumbers,
    Impact,
    Memory,
)
from trsim.elements.scene import Scene
from trsim.errors import ModelError
from trsim.laws.impact import Blow, NoImpact, impact
from trsim.solve.march import record as rec
from trsim.solve.march.events import hertz_step
from trsim.solve.march.impulses import N_IMPULSE, OUT_OF_PLANE, Jump, no_jump, together, told
from trsim.solve.march.phases import settle
from trsim.solve.march.record import Buffers, Record, Settings, note_event

Array = NDArray[np.float64]

TOUCHES = 1e-10  # of the mechanism's size: a gap in flight that is none
ALIKE = 1e-9  # of the fastest approach: as fast
STILL = 1e-6  # of the slowest impact: at rest
GIVES_WAY = 1e-10  # of what a free body would give way by


def strike(mechanism: Any, work: Scene, r: Record, b: Buffers, setting: Settings) -> Jump:
    """Do the impacts of this instant, if there are any.

    Raises ModelError where nothing gives way, or no end of them is found.
    """
    found = [(c, e) for c, e in enumerate(work.contact.tolist()) if work.contact_impact[c]]
    if not found:
        return no_jump()
    return _Striking(mechanism, work, r, b, found).done(setting)


class _Striking:
    """The impacts of one instant, while they come."""

    def __init__(
        self, mechanism: Any, work: Scene, r: Record, b: Buffers, found: list[tuple[int, int]]
    ) -> None:
        self.mechanism, self.work, self.r, self.b, self.found = mechanism, work, r, b, found
        self.t = float(r.t)

    def done(self, setting: Settings) -> Jump:
        """What came of them; the record goes on from there."""
        work, r = self.work, self.r
        jumps: list[Jump] = []
        derivative(work, self.t, r.y, np.empty(r.y.size))  # rows and factors of this place
        while (next_one := self.next_one()) is not None:
            if len(jumps) == rec.MOST_BLOWS:
                raise self.at(next_one[0], f"more than {rec.MOST_BLOWS} impacts at t = {self.t:.9g}"
                              " s: they hand on what approaches for ever")  # fmt: skip
            jumps.append(self.struck(*next_one))
        if not jumps and not r.struck.any():
            return no_jump()
        self.parted(setting)
        settle(work, r, self.b, setting)
        return together(jumps)

    def at(self, c: int, what: str) -> ModelError:
        """An error of a contact."""
        there = self.mechanism.instances[int(self.work.contact[c])]
        return ModelError(what, "", (there.section, there.name))

    def next_one(self) -> tuple[int, bool] | None:
        """The contact that is struck next, and whether it bounces; None where all is at rest."""
        work, r = self.work, self.r
        poses(work, r.y)
        gaps(work, self.t)
        fast, slow = [], []
        for c, e in self.found:
            depth, rate = work.gap[e].tolist()
            slowest = float(ContactNumbers(work, c).slowest_impact)
            closed = Memory(r, e).phase == CONTACT
            touches = not closed and depth >= -TOUCHES * work.size
            if rate > slowest and (closed or touches):
                fast.append((c, rate))
            elif rate > STILL * slowest and (touches or r.struck[c]):
                slow.append((c, rate))
        of = fast or slow
        if not of:
            return None
        most = max(rate for _, rate in of)
        return next(c for c, rate in of if rate >= (1.0 - ALIKE) * most), bool(fast)

    def struck(self, c: int, bounces: bool) -> Jump:
        """One impact: the velocities after it, its line among the events, and its impulses."""
        work, r, e = self.work, self.r, int(self.work.contact[c])
        speed, twists = float(work.gap[e, 1]), work.V.copy()
        if Memory(r, e).phase == FLIGHT:
            self.touch(c, e, speed)
        strikes(work, self.t, e)
        blow = work.blow.copy()
        if work.d == 3:
            blow[:, list(OUT_OF_PLANE) + [6 + k for k in OUT_OF_PLANE]] = 0.0
        law = self.mechanism.instances[e].row.contact.impact
        before = self.velocity(e, blow)
        found = self.solved(c, blow, law, bounces)
        drives = self.moved(e, found.impulse @ blow)
        mean = 0.5 * (before + self.velocity(e, blow))
        self.book(e, speed, found, float(mean @ found.impulse), drives)
        k = len(self.mechanism.stages.switches.events) + c
        jump = told(self.mechanism, work, r, k, twists)
        return Jump(np.vstack([jump.impulses, self.lines(c, k, found, blow)]), jump.velocities)

    def touch(self, c: int, e: int, speed: float) -> None:
        """A contact in flight that touches begins, as one that is located does."""
        work, r, memory = self.work, self.r, Memory(self.r, e)
        memory.phase, r.struck[c] = CONTACT, 1
        r.events += 1
        note_event.python(r, self.b, self.t, rec.ONSET, e, speed)
        if work.contact_state[c] >= 0:
            first = work.n_q + work.n_v + int(work.contact_state[c])
            r.y[first : first + int(work.contact_states[c])] = 0.0

    def solved(self, c: int, blow: Array, law: Impact, bounces: bool) -> Blow:
        """The impulses of a contact."""
        work, e = self.work, int(self.work.contact[c])
        u, before = self.velocity(e, blow), self.velocities.copy()
        rubs = law.static > 0.0 or law.kinetic > 0.0
        G = np.zeros((3, 3))
        held = self.nearest(before)
        for k in range(3 if rubs else 1):
            free = self.by_masses(e, blow[k])
            self.velocities[:] = free
            gives = float(self.velocity(e, blow)[k])
            if gives == 0.0:
                continue
            some = float(np.abs(u).max()) / gives  # about the impulse it will be
            self.velocities[:] = (self.nearest(before + some * free) - held) / some
            G[:, k] = self.velocity(e, blow)
            if k == 0 and not G[0, 0] > GIVES_WAY * gives:
                raise self.at(c, f"an impact at t = {self.t:.9g} s of bodies that joints or drives "
                              "hold along its normal: nothing gives way")  # fmt: skip
        self.velocities[:] = before
        poses(work, self.r.y)
        if not rubs:
            G[1:], u[1:] = 0.0, 0.0
        try:
            e_or_none = law.restitution if bounces else 0.0
            return impact(u, 0.5 * (G + G.T), (law.static, law.kinetic), e_or_none, law.rule)
        except NoImpact:
            raise self.at(c, f"no impact is found at t = {self.t:.9g} s") from None

    @property
    def velocities(self) -> Array:
        """Those of the state, as they are."""
        work = self.work
        return np.asarray(self.r.y[work.n_q : work.n_q + work.n_v])

    def velocity(self, e: int, blow: Array) -> Array:
        """Of body j against body i at a contact, along the normal and across it."""
        work, (i, j) = self.work, self.bodies(e)
        poses(work, self.r.y)
        return np.asarray(blow[:, :6] @ work.V[j] + blow[:, 6:] @ work.V[i])

    def bodies(self, e: int) -> tuple[int, int]:
        i, j = self.mechanism.instances[e].row.con[:2]
        return i, j

    def by_masses(self, e: int, wrench: Array) -> Array:
        """How impulses on the two bodies of a contact would change velocities without joints."""
        work, found, (i, j) = self.work, np.zeros(self.work.n_v), self.bodies(e)
        for f, own in ((j, wrench[:6]), (i, wrench[6:])):
            if f == 0:
                continue
            inverse = block(work, work.mass_inverse[f], work.inertia_inverse[f])
            given = own[[0, 1, 5]] if work.d == 3 else own.copy()
            if work.d == 6:
                given[3:] = work.X[f, 3:].reshape(3, 3).T @ own[3:]
            found[work.d * (f - 1) : work.d * f] += inverse @ given
        return found

    def nearest(self, given: Array) -> Array:
        """The velocities that joints allow nearest to those given, in the metric of M."""
        work, v = self.work, self.velocities

        def onto(wanted: Array) -> Array:
            v[:] = wanted
            poses(work, self.r.y)
            if work.m > 0:
                project_velocities(work, self.r.y)
            return v.copy()

        return nearest_in_mass(
            len(work.light), given.copy(), onto, partial(given_back_in_own, work)
        )

    def moved(self, e: int, wrench: Array) -> float:
        """Jump, by impulses on the two bodies of a contact; the work of drives that go on, J."""
        work = self.work
        v = self.velocities
        v[:] = self.nearest(v + self.by_masses(e, wrench))
        return float(work.x[: work.m] @ work.phi_t[: work.m]) if work.m > 0 else 0.0

    def book(self, e: int, speed: float, found: Blow, done: float, drives: float) -> None:
        """The work of an impact, and its line among the events."""
        work, r, b = self.work, self.r, self.b
        first = work.n_q + work.n_v
        r.y[first + IMPACTS] += found.work
        r.y[first + FRICTION] += done - found.work
        r.y[first + DRIVES] += drives
        lost = self.mechanism.instances[e].row.contact.lost
        if lost >= 0:
            r.y[first + lost] -= found.work
            r.y[first + lost + 1] -= done - found.work
        note_event.python(r, b, self.t, rec.IMPACT, e, speed)
        line = b.events[r.event_rows - 1]
        line[rec.EVENT_WORK], line[rec.EVENT_IMPULSE] = done, found.impulse[0]

    def lines(self, c: int, k: int, found: Blow, blow: Array) -> Array:
        """Lines of impulses: the contact's own on both its bodies."""
        i, j = self.bodies(int(self.work.contact[c]))
        first = len(self.mechanism.stages.every) + 3 * c
        rows = [
            [self.t, k, first + a, f, p, *(p * blow[a, own])]
            for a, p in enumerate(found.impulse.tolist())
            for f, own in ((j, slice(0, 6)), (i, slice(6, 12)))
            if p != 0.0
        ]
        return np.array(rows).reshape(-1, N_IMPULSE)

    def parted(self, setting: Settings) -> None:
        """What has just met flies on, or rests on its spring from now on."""
        work, r, rests = self.work, self.r, 1e300
        poses(work, r.y)
        gaps(work, self.t)
        for c, e in self.found:
            if not r.struck[c]:
                continue
            own, memory, rate = ContactNumbers(work, c), Memory(r, e), float(work.gap[e, 1])
            slowest = float(own.slowest_impact)
            if rate < -STILL * slowest:
                memory.phase, memory.impact_speed = FLIGHT, 0.0
                r.events += 1
                note_event.python(r, self.b, self.t, rec.SEPARATION, e, rate)
                continue
            memory.impact_speed = slowest
            law = float(own.stiffness), float(own.exponent), float(own.mass)
            rests = min(rests, hertz_step.python(*law, slowest, setting.step_error))
        r.struck[:] = 0
        if setting.fixed_step > 0.0:
            return
        if rests < 1e300:
            r.h = min(r.h, rests)
        elif all(Memory(r, e).phase != CONTACT for e in work.contact.tolist()):
            r.h, r.free_since = max(r.h, r.free_h), self.t
