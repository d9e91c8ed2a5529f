"""What a twin says of a run."""

from typing import Literal

from typing_extensions import TypedDict  # pydantic wants this one before Python 3.12

from trsim.cli.documents.common import Number
from trsim.statuses import Ended


class Parted(TypedDict):
    """A stretch of time in which the two runs are apart.

    number  from 1
    begin   s
    end     s, where they are together again; null where they never are
    rows    output rows in it
    share   of these rows, that are apart
    """

    number: int
    begin: Number
    end: Number
    rows: int
    share: Number


class Onsets(TypedDict):
    """How often a contact closed.

    contact      joint or stop
    impacts      of the run
    twin         of the twin
    before       of the run, before the two part
    twin_before  of the twin, before the two part
    """

    contact: str
    impacts: int
    twin: int
    before: int
    twin_before: int


class Certified(TypedDict):
    """What a twin says of a run, in a few numbers.

    method          of the twin
    tolerance       of the twin
    status          how the twin ended
    reason          why it failed, or ""
    time            simulated until by the twin, s
    steps           accepted by the twin
    evaluations     right-hand sides of the twin
    compared_until  time of the last output row that both have, s
    rows            output rows compared
    motion          channels of positions and velocities that say whether the two are apart
    apart           s: here one of these differs by more than 1 % of its range for the first time;
                    null where none does
    apart_channel   which one; "" for none
    difference      largest of motion while the two are together, over the range of its channel
    difference_channel  which one
    quantity_difference  largest of a summary quantity of which nothing lies where the two are
                    apart, over the range of its channel; null where there is none
    quantity        which one: "channel, quantity"
    agree           means, RMS and shares of contact, while apart, that agree
    differ          that do not
    unknown         that have no interval
    windows         stretches of time in which the two are apart
    contacts        how often each contact closed
    """

    method: str
    tolerance: Number
    status: Ended
    reason: str
    time: Number
    steps: int
    evaluations: int
    compared_until: Number
    rows: int
    motion: int
    apart: Number
    apart_channel: str
    difference: Number
    difference_channel: str
    quantity_difference: Number
    quantity: str
    agree: int
    differ: int
    unknown: int
    windows: list[Parted]
    contacts: list[Onsets]


class Curve(TypedDict):
    """One channel while the two runs are together.

    channel     name
    difference  largest, over the range; null where the channel does not move
    range       largest less smallest value, of all components the largest, SI
    motion      whether it has a part in where the two are apart
    unit        SI
    """

    channel: str
    difference: Number
    range: Number
    motion: bool
    unit: str


class Quantity(TypedDict):
    """One summary quantity of one component of a channel.

    channel     with its component
    quantity    which one; extremes are of output rows and, where kept, of accepted steps
    value       of the run
    twin        of the twin
    difference  value less that of the twin
    certain     whether nothing of it lies where the two are apart
    unit        SI
    """

    channel: str
    quantity: Literal["largest", "smallest", "final", "mean", "rms"]
    value: Number
    twin: Number
    difference: Number
    certain: bool
    unit: str


class Level(TypedDict):
    """A mean over a stretch in which the two are apart, with 95 % intervals from batch means.

    window     number of the stretch
    channel    with its component; of `in contact` the joint or stop
    quantity   which one; `in contact` is the share of time
    value      of the run
    twin       of the twin
    half       of the interval of the run; null without one
    twin_half  of the interval of the twin; null without one
    off_half   of the interval of their difference; null without one
    verdict    agree where an interval covers the difference, or that is below 1 % of both
    unit       SI
    """

    window: int
    channel: str
    quantity: Literal["mean", "rms", "in contact"]
    value: Number
    twin: Number
    half: Number
    twin_half: Number
    off_half: Number
    verdict: Literal["agree", "differ", "unknown"]
    unit: str


class Onset(TypedDict):
    """One of the first onsets of a contact.

    contact  joint or stop
    number   from 1
    time     of the run, s; null where it has none
    twin     of the twin, s; null where it has none
    """

    contact: str
    number: int
    time: Number
    twin: Number


class Certificate(Certified):
    """All that a twin says of a run.

    curves      every channel while the two are together
    quantities  every component in a few numbers
    levels      means while the two are apart
    onsets      the first ones of each contact
    """

    curves: list[Curve]
    quantities: list[Quantity]
    levels: list[Level]
    onsets: list[Onset]
