"""Phases that nothing ended before the run did, and those that ended as they began."""

from collections.abc import Iterator
from typing import Any

from trsim.errors import some
from trsim.solve.march import record as rec
from trsim.solve.march.load_steps import phase_of
from trsim.solve.march.record import Record
from trsim.solve.outcome import Outcome

SHOWN = 4  # names of a list


def left(mechanism: Any, r: Record, ended: bool) -> int:
    """How many phases were to be ended and were not; ended: whether an event ended the run."""
    switches = mechanism.stages.switches
    if not switches.phases:
        return 0
    now, last = phase_of(mechanism, r), len(switches.phases) - 1
    if now == last and (ended or not waits(switches.events, now)):
        return 0
    return last - now + int(waits(switches.events, last))


def waits(events: Any, phase: int) -> bool:
    """Whether something is to end a phase."""
    return any(event.phase == phase and event.role in ("until", "for") for event in events)


def of_phases(mechanism: Any, outcome: Outcome) -> Iterator[str]:
    """What to say of phases once a run has ended."""
    r, switches = outcome.record, mechanism.stages.switches
    contacts = len(mechanism.model.contact)
    for k, event in enumerate(switches.events):
        if r.watch[k, rec.AT_ONCE]:
            there = "it was beyond it already" if event.role == "until" else "it was slack already"
            yield (
                f"phases.{switches.phases[event.phase]}: ended as it began: {event.falls()}, and "
                f"{there}; begin it earlier, or leave it out"
            )
    if not outcome.statistics.get("phases_left"):
        return
    now = phase_of(mechanism, r)
    asked = [
        f"{event.falls()}; it is {float(r.gap[contacts + k, 0]) + event.value:.6g}"
        if not event.lasts
        else f"{event.lasts:g} s after its begin"
        for k, event in enumerate(switches.events)
        if event.phase == now and event.role in ("until", "for")
    ]
    never = switches.phases[now + 1 :]
    more = f"; {some(never, SHOWN)} did not begin" if never else ""
    yield (
        f"phases.{switches.phases[now]}: nothing had ended it when the run ended at "
        f"{outcome.time:.6g} s (what ends it: {' or '.join(asked)}){more}; let the run last "
        "longer, or give the phase `stall` or `for`"
    )
