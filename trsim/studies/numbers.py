"""A number of a run, told in a word: fluctuation:door_angle.rate@stroke=0.15..0.48.

Words are those of trsim.analyse.outputs, and a few that only a study needs.  The window is one of a
channel in SI, of a stroke or an angle that the motion passes through, since the runs of an ensemble
start at different places; without one it is the whole run.
"""

import fnmatch
import math
from collections.abc import Callable
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from trsim.analyse.outputs import scalar
from trsim.errors import UsageError, known
from trsim.studies.runs import Member

STROKE = "stroke"  # over which places are told without a window
SEEN = 1.0  # N: a contact force from which on a contact has begun
Inside = NDArray[np.bool_]


class Word(NamedTuple):
    """What is asked for."""

    kind: str
    of: str  # a channel, a section or a contact
    text: str  # the whole of it
    over: str = STROKE  # the channel of the window
    begin: float = -math.inf
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
        return Word(kind, of, text)
    over, _, bounds = window.partition("=")
    begin, _, end = bounds.partition("..")
    if not over or not end:
        raise UsageError(f"not a window of a channel: '{text}'", f"Write @{STROKE}=0.15..0.48.")
    return Word(kind, of, text, over, float(begin), float(end))


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
    own = KINDS[asked.kind]
    return own(member, asked) if own else Number(*scalar(member.run, text))


def inside(member: Member, asked: Word) -> Inside:
    """The rows in the window."""
    if math.isinf(asked.end):
        return np.ones(member.time.size, dtype=bool)
    place = member.channel(asked.over)
    return (place >= asked.begin) & (place <= asked.end)


# --- kinds of numbers ------------------------------------------------------------------------


def peak(member: Member, asked: Word) -> Number:
    """The largest magnitude."""
    tail = asked.text.partition(":")[2]
    (high, unit), (low, _) = (scalar(member.run, f"{kind}:{tail}") for kind in ("peak", "least"))
    return Number(max(abs(high), abs(low)), unit)


def largest(member: Member, asked: Word) -> Number:
    """The largest value, with its sign."""
    return Number(*scalar(member.run, f"peak:{asked.text.partition(':')[2]}"))


def scaled(member: Member, asked: Word) -> Number:
    """The dispersion of a section over the clearance of its joint."""
    found, _ = scalar(member.run, f"dispersion:{asked.text.partition(':')[2]}")
    joint = member.run.poincare[asked.of].definition["x"].partition(".")[0]
    return Number(found / member.run.parts[joint].clearance, "-")


def place(member: Member, asked: Word) -> Number:
    """Where the largest value is met, of a jolt the largest magnitude, in the channel of the
    window."""
    at = np.flatnonzero(inside(member, asked))
    values = member.channel(asked.of)[at]
    found = at[np.argmax(np.abs(values) if asked.kind == "jolt" else values)]
    return where(member, asked, int(found))


def where(member: Member, asked: Word, row: int) -> Number:
    """The channel of the window in one row."""
    return Number(float(member.channel(asked.over)[row]), member.run.unit(asked.over))


def begins(member: Member, asked: Word) -> Number:
    """Where a force first exceeds what is seen, in the channel of the window; nan: nowhere."""
    found = np.flatnonzero(inside(member, asked) & (member.channel(asked.of) > SEEN))
    if not found.size:
        return Number(math.nan, member.run.unit(asked.over))
    return where(member, asked, int(found[0]))


def turns(member: Member, asked: Word) -> Number:
    """Where a channel first falls through zero, by a line between rows; nan: nowhere."""
    x, place = member.channel(asked.of), member.channel(asked.over)
    found = np.flatnonzero(inside(member, asked)[:-1] & (x[:-1] > 0.0) & (x[1:] <= 0.0))
    if not found.size:
        return Number(math.nan, member.run.unit(asked.over))
    k = int(found[0])
    share = x[k] / (x[k] - x[k + 1])
    at = place[k] + share * (place[k + 1] - place[k])
    return Number(float(at), member.run.unit(asked.over))


def left(member: Member, asked: Word) -> Number:
    """What a pass of a sizing left of the first force of the drive, by the number of the pass."""
    passes = str(member.run.group("provenance")["sizing"]).split(",")
    return Number(float(passes[int(asked.of)]), "-")


def mechanism(member: Member, asked: Word) -> Number:
    """A count of the mechanism, as `trsim check` tells it."""
    counts = {"mobility": member.run.group("mechanism")["mobility"]}
    if asked.of not in counts:
        raise UsageError(f"no '{asked.of}' of a mechanism", known(asked.of, tuple(counts)))
    return Number(float(counts[asked.of]), "-")


def status(member: Member, asked: Word) -> Number:
    """1 where the run ended so, else 0."""
    return Number(float(member.run.attributes["status"] == asked.of), "-")


def most(member: Member, asked: Word) -> Number:
    """The largest magnitude of all channels that a pattern fits."""
    fitting = fnmatch.filter(member.run.units, asked.of)
    if not fitting:
        raise UsageError(f"{member.file}: no channel fits '{asked.of}'")
    every = [peak(member, word(asked.text.replace(asked.of, channel))) for channel in fitting]
    return max(every)


def sideways(member: Member, asked: Word) -> Number:
    """The largest size of a vector across x, over its largest component along x."""
    vector = member.channel(asked.of)
    across = np.max(np.linalg.norm(vector[:, 1:], axis=1))
    return Number(float(across / np.max(np.abs(vector[:, 0]))), "-")


def orbit(member: Member, asked: Word) -> Number:
    """Root mean square distance of the journal from its mean place."""
    channels = [f"{asked.of}.eccentricity_{axis}" for axis in "xy"]
    x, y = (member.channel(channel)[inside(member, asked)] for channel in channels)
    return Number(float(np.sqrt(np.var(x) + np.var(y))), member.run.unit(channels[0]))


def drift(member: Member, asked: Word) -> Number:
    """What the energy book misses at most, over the largest kinetic energy."""
    largest_energy = np.max(np.abs(member.channel("energy.kinetic")))
    return Number(float(np.max(np.abs(member.channel(asked.of))) / largest_energy), "-")


def apart(member: Member, asked: Word, reference: Member | None) -> Number:
    """The largest difference to the reference at equal places, or at equal times without one."""
    if reference is None:
        raise UsageError(f"{member.file}: there is no run to measure from")
    over = asked.over if asked.over in member.run.units else "time"
    mine, other = ((m.channel(over), m.channel(asked.of)) for m in (member, reference))
    common = (mine[0] >= max(other[0][0], asked.begin)) & (mine[0] <= min(other[0][-1], asked.end))
    at, found = mine[0][common], mine[1][common]
    away = [np.interp(at, other[0], column) for column in np.atleast_2d(other[1].T)]
    difference = np.atleast_2d(found.T) - np.array(away)
    return Number(float(np.sqrt(np.max(np.sum(difference**2, axis=0)))), member.run.unit(asked.of))


# as in outputs.py
SHARED = (
    *("fluctuation", "range", "mean", "final", "least", "dispersion", "flight", "impacts"),
    *("summary", "solver"),
)
KINDS: dict[str, Callable[..., Number] | None] = {
    **dict.fromkeys(SHARED),
    "peak": peak,
    "largest": largest,
    "place": place,
    "jolt": place,
    "scaled": scaled,
    "most": most,
    "sideways": sideways,
    "orbit": orbit,
    "drift": drift,
    "apart": apart,
    "begins": begins,
    "turns": turns,
    "status": status,
    "mechanism": mechanism,
    "left": left,
}
