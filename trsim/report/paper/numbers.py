"""A number of a run, told in a word: peak:B.contact_force, fluctuation:door_angle.rate@0.15..0.48.

The window behind @ is one of stroke, m, since the runs of an ensemble start at different strokes;
without one it is the whole run.
"""

import math
from collections.abc import Callable
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from trsim.analyse.fluctuation import high_pass
from trsim.errors import UsageError, known
from trsim.report.paper.runs import Member
from trsim.store.grow import Array

Inside = NDArray[np.bool_]


class Word(NamedTuple):
    """What is asked for."""

    kind: str
    of: str  # a channel, a section or a contact
    begin: float = -math.inf  # m of stroke
    end: float = math.inf


class Number(NamedTuple):
    """A value in SI."""

    value: float
    unit: str


def word(text: str) -> Word:
    """The parts of a word.  Raises UsageError."""
    kind, colon, rest = text.partition(":")
    of, _, window = rest.partition("@")
    if not colon or kind not in KINDS:
        raise UsageError(f"no such number: '{text}'", known(kind, tuple(KINDS)))
    if not window:
        return Word(kind, of)
    begin, _, end = window.partition("..")
    return Word(kind, of, float(begin), float(end))


def number(member: Member, text: str, reference: Member | None = None) -> Number:
    """The number of a member that a word tells.

    reference: the run from which `apart` measures.  Raises UsageError for an unknown word, channel
    or contact.
    """
    asked = word(text)
    if not math.isinf(asked.end) and not inside(member, asked).any():
        return Number(math.nan, "-")  # a run that ended before
    if asked.kind == "apart":
        return apart(member, asked, reference)
    return KINDS[asked.kind](member, asked)


def inside(member: Member, asked: Word) -> Inside:
    """The rows in the window."""
    return (member.stroke >= asked.begin) & (member.stroke <= asked.end)


def rows(member: Member, asked: Word) -> Array:
    """The channel in the window."""
    return member.channel(asked.of)[inside(member, asked)]


# --- kinds of numbers ------------------------------------------------------------------------


def fluctuation(member: Member, asked: Word) -> Number:
    """Root mean square of what a double moving average of 10 ms leaves over."""
    fast = high_pass(member.time, member.channel(asked.of))[inside(member, asked)]
    return Number(float(np.sqrt(np.mean(fast**2))), member.run.unit(asked.of))


def extent(member: Member, asked: Word) -> Number:
    """Largest less smallest value at output rows."""
    return Number(float(np.ptp(rows(member, asked))), member.run.unit(asked.of))


def mean(member: Member, asked: Word) -> Number:
    return Number(float(np.mean(rows(member, asked))), member.run.unit(asked.of))


def peak(member: Member, asked: Word) -> Number:
    """The largest magnitude.

    Of the whole run what the solver found, also inside steps; in a window that at accepted steps of
    a contact, of other channels that at output rows.
    """
    unit = member.run.unit(asked.of)
    if math.isinf(asked.end):
        both = [member.peaks[asked.of, extreme].value for extreme in ("largest", "smallest")]
        return Number(float(np.max(np.abs(both))), unit)
    contact, _, channel = asked.of.partition(".")
    if contact in member.run.contacts:
        steps = member.steps(contact)
        at = member.strokes(steps["time"])
        values = steps[channel][(at >= asked.begin) & (at <= asked.end)]
    else:
        values = rows(member, asked)
    return Number(float(np.max(np.abs(values), initial=0.0)), unit)


def largest(member: Member, asked: Word) -> Number:
    """The largest value, with its sign."""
    if math.isinf(asked.end):
        return Number(member.peaks[asked.of, "largest"].value, member.run.unit(asked.of))
    return Number(float(np.max(rows(member, asked))), member.run.unit(asked.of))


def place(member: Member, asked: Word) -> Number:
    """The stroke at which the largest value is met, m."""
    at = np.flatnonzero(inside(member, asked))
    found = at[np.argmax(member.channel(asked.of)[at])]
    return Number(float(member.stroke[found]), "m")


def jolt(member: Member, asked: Word) -> Number:
    """The stroke at which the magnitude is largest, m."""
    at = np.flatnonzero(inside(member, asked))
    found = at[np.argmax(np.abs(member.channel(asked.of)[at]))]
    return Number(float(member.stroke[found]), "m")


def dispersion(member: Member, asked: Word) -> Number:
    """Root of the sum of the variances of the points of a section."""
    points = member.sections[asked.of]
    at = member.strokes(points.time)
    kept = (at >= asked.begin) & (at <= asked.end)
    if np.count_nonzero(kept) < 2:
        return Number(math.nan, points.x_unit)
    spread = np.var(points.x[kept], ddof=1) + np.var(points.y[kept], ddof=1)
    return Number(float(np.sqrt(spread)), points.x_unit)


def scaled(member: Member, asked: Word) -> Number:
    """The dispersion of a section over the clearance of its joint."""
    found = dispersion(member, asked)
    joint = member.sections[asked.of].definition["x"].partition(".")[0]
    return Number(found.value / member.run.parts[joint].clearance, "-")


def orbit(member: Member, asked: Word) -> Number:
    """Root mean square distance of the journal from its mean place."""
    channels = [f"{asked.of}.eccentricity_{axis}" for axis in "xy"]
    x, y = (member.channel(channel)[inside(member, asked)] for channel in channels)
    return Number(float(np.sqrt(np.var(x) + np.var(y))), member.run.unit(channels[0]))


def flight(member: Member, asked: Word) -> Number:
    """The share of output rows without contact."""
    force = member.channel(f"{asked.of}.normal_force")[inside(member, asked)]
    return Number(float(np.mean(force == 0.0)), "-")


def impacts(member: Member, asked: Word) -> Number:
    """How often a contact closes."""
    events = member.events
    mine = (events.element == asked.of) & (events.kind == "onset")
    at = member.strokes(events.time[mine])
    return Number(float(np.count_nonzero((at >= asked.begin) & (at <= asked.end))), "-")


def drift(member: Member, asked: Word) -> Number:
    """What the energy book misses at most, over the largest kinetic energy."""
    largest_energy = np.max(np.abs(member.channel("energy.kinetic")))
    return Number(float(np.max(np.abs(member.channel(asked.of))) / largest_energy), "-")


def apart(member: Member, asked: Word, reference: Member | None) -> Number:
    """The largest difference to the reference at equal strokes, or at equal times without one."""
    if reference is None:
        raise UsageError(f"{member.file}: there is no run to measure from")
    mine, other = (
        (m.stroke, m.channel(asked.of))
        if "stroke" in m.run.units
        else (m.time, m.channel(asked.of))
        for m in (member, reference)
    )
    common = (mine[0] >= max(other[0][0], asked.begin)) & (mine[0] <= min(other[0][-1], asked.end))
    at, found = mine[0][common], mine[1][common]
    away = [np.interp(at, other[0], column) for column in np.atleast_2d(other[1].T)]
    difference = np.atleast_2d(found.T) - np.array(away)
    return Number(float(np.sqrt(np.max(np.sum(difference**2, axis=0)))), member.run.unit(asked.of))


KINDS: dict[str, Callable[..., Number]] = {
    "fluctuation": fluctuation, "range": extent, "mean": mean, "peak": peak, "largest": largest,
    "place": place, "jolt": jolt, "dispersion": dispersion, "scaled": scaled, "orbit": orbit,
    "flight": flight, "impacts": impacts, "drift": drift, "apart": apart,
}  # fmt: skip
