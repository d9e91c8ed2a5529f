"""Section 4.3 of the study: opening the door."""

from trsim.studies.claim import Claim, Reading, one, over
from trsim.studies.single import apart_by, steps

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
                    "peak:cb_rod_force",
                    ("closing wind", "open_closing_wind"),
                    ("none", "open"),
                    ("opening wind", "open_opening_wind"),
                ),
            ),
            Reading(
                "2.5 s",
                over(
                    "peak:cb_rod_force",
                    ("closing wind", "open_fast_closing_wind"),
                    ("none", "open_fast"),
                    ("opening wind", "open_fast_opening_wind"),
                ),
            ),
        ),
    ),
    Claim(
        "open_above_opened",
        "4.3",
        "34, 36",
        "The rod of the counterbalance carries much more in opening than with the door opened.",
        apart_by(1000.0, 1e9, 1.0, "N"),
        one(
            *over("peak:cb_rod_force", ("opened", "opened"), ("opening wind", "open_opening_wind"))
        ),
    ),
)
