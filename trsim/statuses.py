"""How a run stands or ended: the word `status` of result files, of `--json` and of reports."""

from typing import Literal

# said by the solver, said by the writer of the file
Ended = Literal["done", "jammed", "stalled", "slack", "released", "limit", "painleve", "failed"]
# a run says what it was asked
WELL: tuple[Ended, ...] = ("done", "jammed", "stalled", "slack", "released", "limit")
ILL: tuple[Ended, ...] = ("painleve", "failed")  # it does not
Status = Literal["running", Ended, "interrupted", "recovered"]

STATUSES: dict[Status, str] = {
    "running": "goes on, or was killed: `trsim recover` copies what it left",
    "done": "reached its end, or an event of the scenario ended it",
    "jammed": "a drive reached what it can do, drives lost their synchronism, or a curve ended",
    "stalled": "motion came to rest before what was to end its phase",
    "slack": "a rope that must stay taut went slack",
    "released": "all that the scenario asks of was let go",
    "limit": "a static path ended: no equilibrium is near ahead",
    "painleve": "the friction of a joint has no solution from there on, or several",
    "failed": "the solver could not go on; the file holds what was computed until then",
    "interrupted": "ended by a signal; the file was closed and is named .part",
    "recovered": "copied out of a .part file",
}
NOT_NEEDED = "not needed"  # of a case of a sweep: what was asked is known without it
