"""Documents about sweeps."""

from typing import NotRequired

from typing_extensions import TypedDict  # pydantic wants this one before Python 3.12

from trsim.cli.documents.common import Document, Number


class Needed(TypedDict):
    """A case that is to be run.

    case  its name
    why   it is missing, changed, or tried again
    """

    case: str
    why: str


class Failed(TypedDict):
    """A case without a good result.

    case    its name
    status  how its run ended, or why there is none
    reason  in words
    """

    case: str
    status: str
    reason: str


class Sweep(Document):
    """trsim sweep.

    folder  of the sweep
    cases   of the plan
    ran     how many were run now
    counts  status -> how many cases have it; of this share
    chosen  of `until` and `refine`: what came of them, and of how many cases
    needed  what is to be run, with --dry-run and --explain
    """

    folder: str
    cases: int
    ran: int
    counts: dict[str, int]
    chosen: list[str]
    needed: NotRequired[list[Needed]]


class Status(Document):
    """trsim status.

    folder          of the sweep
    source          its scenario
    cases           of the plan
    counts          status -> how many cases have it
    failed          the cases that failed
    wall_of_a_case  mean wall time of those that were run, s
    chosen          of `until` and `refine`: what came of them, and of how many cases
    """

    folder: str
    source: str
    cases: int
    counts: dict[str, int]
    failed: list[Failed]
    wall_of_a_case: Number
    chosen: list[str]


class LeftOut(TypedDict):
    """A case whose result is not what its folder tells of.

    case    its name
    folder  where it is told of
    why     in words
    """

    case: str
    folder: str
    why: str


class Merge(Document):
    """trsim merge.

    folder    that was made
    cases     of the plan
    taken     how many were taken from the other folders now
    counts    status -> how many cases have it
    left_out  the cases that are left out
    """

    folder: str
    cases: int
    taken: int
    counts: dict[str, int]
    left_out: list[LeftOut]
