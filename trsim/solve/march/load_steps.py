"""Phases in a run: clocks that start as one begins, and what has ended it already.

A clock is an event that watches the time; when it comes to its end stands in the record and, for
the compiled code, in `watch_at` of the scene, which all stages of a run share.

A phase ends as it begins where something that is to end it lies beyond its value already, or on it
and going on in the direction asked for, or is what has just ended the phase before.
"""

from collections.abc import Sequence
from typing import Any

import numpy as np

from trsim.assemble.equations import kinetic, poses
from trsim.assemble.switches import CHANNEL, FAR, UserEvent
from trsim.assemble.tables import BAND_AT, VALUE_AT
from trsim.elements.scene import Scene
from trsim.solve.march import record as rec
from trsim.solve.march.record import Record

LOOKS = 16  # at whether anything moves, in the time for which nothing must
ENDS = ("until", "taut")  # roles of what may lie beyond its value as a phase begins


def phase_of(mechanism: Any, r: Record) -> int:
    """The phase in force; -1 where there are none."""
    switch = mechanism.stages.switches.phase
    return int(r.stage[switch]) if switch >= 0 else -1


def counts(mechanism: Any, r: Record, event: UserEvent) -> bool:
    """Whether an event is one of the phase in force, or of all."""
    return event.phase in (-1, phase_of(mechanism, r))


def set_clock(work: Scene, r: Record, k: int, due: float) -> None:
    """Let clock k come to its end at a time; FAR: it does not run."""
    r.watch[k, rec.DUE] = work.watch_at[k, VALUE_AT] = due
    r.gap[len(work.contact) + k, 0] = float(r.t) - due
    r.watch[k, rec.SIDE] = -1.0


def clocks_of(work: Scene, r: Record, events: Sequence[UserEvent]) -> None:
    """Let the clocks of a scene go on as a record says."""
    for k, event in enumerate(events):
        if event.lasts:
            work.watch_at[k, VALUE_AT] = r.watch[k, rec.DUE] or FAR


def at_rest(work: Scene, r: Record, event: UserEvent) -> bool:
    """Whether nothing moves, and nothing begins to.

    The kinetic energy is below the bound, and so is what the accelerations would make of it until
    the next look: what swings to and fro is fast, or turned round, at any look.
    """
    poses(work, r.y)
    first, apart = work.n_q, event.lasts / LOOKS
    y = r.y.copy()
    y[first : first + work.n_v] = apart * r.yd[first : first + work.n_v]
    return bool(max(kinetic(work, r.y), kinetic(work, y)) < event.energy)


def look(work: Scene, r: Record, k: int, event: UserEvent) -> bool:
    """Look whether anything moves, and set the clock of the next look; whether nothing has for as
    long as asked for."""
    r.watch[k, rec.LOOKED] = r.watch[k, rec.LOOKED] + 1.0 if at_rest(work, r, event) else 0.0
    set_clock(work, r, k, float(r.t) + event.lasts / LOOKS)
    return bool(r.watch[k, rec.LOOKED] > LOOKS)


def started(
    work: Scene, r: Record, events: Sequence[UserEvent], phase: int, before: UserEvent
) -> int:
    """Start the clocks of a phase; the event that has ended it already, or -1.

    before: the event with which it begins.
    """
    over = -1
    for k, event in enumerate(events):
        if event.phase != phase:
            continue
        if event.role == "for":
            set_clock(work, r, k, float(r.t) + event.lasts)
        elif event.role == "stall":
            r.watch[k, rec.LOOKED] = 0.0
            look(work, r, k, event)
        elif event.role in ENDS and over < 0 and reached(work, r, k, event, before):
            over = k
    return over


def reached(work: Scene, r: Record, k: int, event: UserEvent, before: UserEvent) -> bool:
    """Whether what ends a phase is there already."""
    asked = (event.when, event.value, event.direction)
    if asked == (before.when, before.value, before.direction) and before.role in ENDS:
        return True
    g, rate = r.gap[len(work.contact) + k]
    band = float(work.watch_at[k, BAND_AT])
    if event.kind == CHANNEL:
        band = float(work.tolerance) * max(abs(event.value), abs(g + event.value))
    ahead = event.direction * float(g)
    return ahead > band or (abs(ahead) <= band and event.direction * float(rate) > 0.0)


def standing(mechanism: Any, work: Scene, r: Record) -> str:
    """Where what was to end the phase in force stands, in words."""
    events, phase = mechanism.stages.switches.events, phase_of(mechanism, r)
    told = []
    for k, event in enumerate(events):
        if event.role != "until" or event.phase != phase:
            continue
        now = float(r.gap[len(work.contact) + k, 0]) + event.value
        told.append(f"{event.when} is {now:.6g} {event.shown}, and {event.value:.6g} ends it")
    return "; ".join(told)


def fastest(mechanism: Any, work: Scene) -> str:
    """The largest acceleration of a centre of mass, and whose it is."""
    sizes = np.sqrt(np.sum(work.A[: work.n_r, :3] ** 2, axis=1))
    f = int(np.argmax(sizes))
    names = {frame: name for name, frame in mechanism.frames.items()}
    return f"the largest acceleration is {sizes[f]:.3g} m/s^2" + (
        f" of '{names[f]}'" if sizes[f] > 0.0 else ""
    )
