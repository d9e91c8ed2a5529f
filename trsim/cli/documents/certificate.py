"""What a twin says of a run."""

from typing_extensions import TypedDict  # pydantic wants this one before Python 3.12

from trsim.cli.documents.common import Number, of
from trsim.statuses import Ended
from trsim.store.certificate import Curve, Level, Onset, Onsets, Parted, Quantity


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
    windows: list[of(Parted)]
    contacts: list[of(Onsets)]


class Certificate(Certified):
    """All that a twin says of a run.

    curves      every channel while the two are together
    quantities  every component in a few numbers
    levels      means while the two are apart
    onsets      the first ones of each contact
    """

    curves: list[of(Curve)]
    quantities: list[of(Quantity)]
    levels: list[of(Level)]
    onsets: list[of(Onset)]
