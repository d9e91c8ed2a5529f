"""Section 4.4 of the study: the opened door."""

from trsim.studies.claim import Claim, Reading, one, over
from trsim.studies.crew_door.cases import STEPS
from trsim.studies.single import near, steps

CLAIMS = (
    Claim(
        "wire",
        "4.4",
        "37, 57",
        "With the door opened the wire carries the load from outside.",
        steps(1, 100.0, "N"),
        one(*over("final:wire.force", ("own weight", "opened"), *STEPS)),
    ),
    Claim(
        "rod_idle",
        "4.4",
        "36, 56",
        "With the door opened the rod of the counterbalance carries the counterbalance alone.",
        near(0.01),
        (
            Reading(
                "one man running", over("final:cb_rod_force", ("own weight", "opened"), *STEPS)
            ),
            Reading(
                "three men, wind",
                over(
                    "final:cb_rod_force",
                    ("own weight", "opened"),
                    ("three men", "three_men"),
                    ("wind", "wind_60kt"),
                ),
            ),
        ),
    ),
)
