"""Points of Poincare sections that the tolerance does not resolve.

A channel that a joint, a lock or friction holds at zero trembles there by rounding, or by what
joints are open, and each tremble is a crossing.  What a run resolves of a channel is

    tolerance * the largest value of a channel with its unit, of angles at least 1 rad

so points next to swings that go less far are told.  They stay in the file: a small motion by itself
may well be right.
"""

from collections.abc import Iterable, Iterator
from math import floor, log10
from typing import Any

import numpy as np

from trsim.assemble.mechanism import Mechanism
from trsim.assemble.sections import WHEN
from trsim.solve.march import record as rec
from trsim.solve.march.record import Record

ANGLE, WHOLE = "rad", 1.0


def of_sections(scenario: Any, mechanism: Mechanism, r: Record) -> Iterator[str]:
    """Sections with points between swings too small to be resolved."""
    for k, section in enumerate(mechanism.sections):
        swings = r.section[k, rec.SWINGS :]
        if not section.when or not np.any(swings):
            continue
        unit = unit_of(mechanism, int(mechanism.model.section[k, WHEN]))
        largest = max(reached(swings), largest_of(mechanism, r, unit))
        least = resolved(scenario.solver.tolerance, largest, unit)
        faint, every = below(swings, least), int(np.sum(swings))
        if faint:
            yield said(f"poincare.{section.name}", section.when, faint, every, least, unit)


def said(where: str, when: str, faint: int, every: int, least: float, unit: str) -> str:
    """The sentence about them."""
    return (
        f"{where}: of the {every} swings of {when} between two crossings {faint} go less far than "
        f"{least:.1g}{'' if unit == '-' else ' ' + unit}, which the tolerance does not resolve: "
        f"their points may be rounding; does something hold {when} at zero?"
    )


def resolved(tolerance: float, largest: float, unit: str) -> float:
    """How far a swing goes at least that the tolerance resolves."""
    return tolerance * max(largest, WHOLE if unit == ANGLE else 0.0)


def below(swings: Any, least: float) -> int:
    """How many swings go less far; counted by decades: surely less, that is."""
    if not least > rec.LEAST:
        return 0
    return int(np.sum(swings[: 1 + max(floor(log10(least / rec.LEAST)), 0)]))


def reached(swings: Any) -> float:
    """How far the longest swing went, to a decade."""
    return float(rec.LEAST * 10.0 ** (int(np.flatnonzero(swings)[-1]) - 1))


def unit_of(mechanism: Mechanism, column: int) -> str:
    """The unit of an output column."""
    return next(c.unit for c in mechanism.columns if c.start <= column < c.start + c.size)


def largest_of(mechanism: Mechanism, r: Record, unit: str) -> float:
    """The largest value of any channel with a unit."""
    peaks = [r.peak[:, c.start : c.start + c.size] for c in mechanism.columns if c.unit == unit]
    return largest(np.abs(p[[rec.PEAK_MAX, rec.PEAK_MIN]]) for p in peaks)


def largest(values: Iterable[Any]) -> float:
    """The largest finite magnitude in some arrays; what was never looked at is 1e300."""
    found = 0.0
    for value in values:
        sound = np.abs(value[np.isfinite(value) & (np.abs(value) < 1e299)])
        found = max(found, float(np.max(sound, initial=0.0)))
    return found
