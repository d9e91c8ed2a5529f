"""Published studies, each run and judged with what any user has: one line each."""

from importlib import import_module
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from trsim.studies.study import Study

# word of `trsim report --paper` -> module
STUDIES = {
    "thrust-reverser": "trsim.studies.thrust_reverser",
    "crew-door": "trsim.studies.crew_door",
}


def load(word: str) -> "Study":
    """Import one study."""
    found: Study = import_module(STUDIES[word]).STUDY
    return found
