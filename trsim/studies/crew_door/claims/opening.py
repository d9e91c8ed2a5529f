"""Section 4.3 of the study: opening the door."""

from trsim.studies.claim import Claim, Reading, Series, one, over
from trsim.studies.crew_door.cases import UNDER_WAY
from trsim.studies.single import apart_by, steps

ROD = f"peak:cb_rod_force{UNDER_WAY}"
CLAIMS = (
    Claim(
        "wind_rod",
        "4.3",
        "34, 54",
        "In opening the rod of the counterbalance carries the load from outside.",
        steps(1, 100.0, "N"),
        (
            Reading(
                "4.8 s",
                over(
                    ROD,
                    ("closing wind", "open_closing_wind"),
                    ("none", "open"),
                    ("opening wind", "open_opening_wind"),
                ),
            ),
            Reading(
                "2.5 s",
                over(
                    ROD,
                    ("closing wind", "open_fast_closing_wind"),
                    ("none", "open_fast"),
                    ("opening wind", "open_fast_opening_wind"),
                ),
            ),
        ),
        note="from 20 to 95 deg of the hinge",
    ),
    Claim(
        "open_above_opened",
        "4.3",
        "34, 36",
        "The rod of the counterbalance carries much more in opening than with the door opened.",
        apart_by(1000.0, 1e9, 1.0, "N"),
        one(
            Series("opened", "opened", "peak:cb_rod_force"),
            Series("opening wind", "open_opening_wind", ROD),
        ),
    ),
)
