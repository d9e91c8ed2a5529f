"""Files that are extended side by side: what they draw must be in one frame.

A scenario has one `frame`, in which the numbers of all its files are read.  So two files of one
list that draw something say the same of it, and so do all that say anything.  A file that only
says `frame` turns what the others draw.
"""

from typing import Any

from trsim.errors import ScenarioError, described
from trsim.scenario.template import SECTIONS

# keys of places and directions
DRAWN = {"at", "axis", "x_axis", "y_axis", "second_axis", "direction", "normal", "points", "start"}


class Drawings:
    """The files and cases of one list."""

    def __init__(self) -> None:
        self.known: list[tuple[str, Any, bool]] = []  # name, frame, whether it draws

    def agree(self, name: str, data: dict[str, Any], is_file: bool) -> None:
        """Refuse what is not in the frame of those before it.

        What a case draws is in the frame of its file.
        """
        frame = data.get("frame")
        ours = is_file and any(draws(data.get(key)) for key in (*SECTIONS, "instances"))
        for other, its, draw in self.known:
            both = frame is not None and its is not None
            if its != frame and (both or (ours and draw)):
                what = f"{described(name)} and {described(other)} are not given in the same `frame`"
                hint = "A scenario has one: turn the numbers of one, or write the same in both."
                raise ScenarioError(what, hint)
        self.known.append((name, frame, ours))


def draws(data: Any) -> bool:
    """Whether a place or a direction stands anywhere in some data."""
    if isinstance(data, list):
        return any(map(draws, data))
    if not isinstance(data, dict):
        return False
    return any((key in DRAWN and isinstance(of, list)) or draws(of) for key, of in data.items())
