"""Section 4.2 of the study: jams while the door is lifted."""

from trsim.studies.claim import CHOSEN, Claim, Reading, one, over
from trsim.studies.single import bounded, differ, near, other_signs, part_of

CLAIMS = (
    Claim(
        "jam_gearbox",
        "4.2",
        "31",
        "With the gearbox jammed the rod P7P10 holds what the hand does at either handle.",
        bounded(1000.0, 1e9, "more than 1 kN in P7P10"),
        one(
            *over(
                "peak:P7P10",
                ("inner, opening", "jam_gearbox_inner_open"),
                ("inner, closing", "jam_gearbox_inner_close"),
                ("outer, opening", "jam_gearbox_outer_open"),
                ("outer, closing", "jam_gearbox_outer_close"),
            )
        ),
        CHOSEN,
        "the rods were laid out so",
    ),
    Claim(
        "jam_idle",
        "4.2",
        "49, 50",
        "A hand at the inner handle leaves P2P6 without load; one at the outer handle loads it.",
        part_of(0.01),
        one(
            *over(
                "peak:P2P6",
                ("inner", "jam_gearbox_inner_open"),
                ("outer", "jam_gearbox_outer_open"),
            )
        ),
        CHOSEN,
        "the rods were laid out so",
    ),
    Claim(
        "jam_signs",
        "4.2",
        "31, 32",
        "Opening and closing loads of the hand give forces of other signs.",
        other_signs(),
        (
            Reading(
                "P7P10, gearbox, outer",
                over(
                    "mean:P7P10",
                    ("opening", "jam_gearbox_outer_open"),
                    ("closing", "jam_gearbox_outer_close"),
                ),
            ),
            Reading(
                "P2P6, outer handle, without weight",
                over(
                    "mean:P2P6",
                    ("opening", "jam_outer_inner_open_weightless"),
                    ("closing", "jam_outer_inner_close_weightless"),
                ),
            ),
            Reading(
                "P2P6, outer handle",
                over(
                    "mean:P2P6",
                    ("opening", "jam_outer_inner_open"),
                    ("closing", "jam_outer_inner_close"),
                ),
            ),
        ),
    ),
    Claim(
        "jam_weight",
        "4.2",
        "32",
        "With the outer handle jammed the weight of the door has a part in P2P6.",
        differ(100.0, "N"),
        (
            Reading(
                "opening",
                over(
                    "mean:P2P6",
                    ("with weight", "jam_outer_inner_open"),
                    ("without", "jam_outer_inner_open_weightless"),
                ),
                "",
            ),
            Reading(
                "closing",
                over(
                    "mean:P2P6",
                    ("with weight", "jam_outer_inner_close"),
                    ("without", "jam_outer_inner_close_weightless"),
                ),
            ),
        ),
    ),
    Claim(
        "jam_gearbox_weight",
        "4.2",
        "31",
        "With the gearbox jammed the weight has no part in P7P10.",
        near(0.01),
        one(
            *over(
                "peak:P7P10",
                ("with weight", "jam_gearbox_inner_open"),
                ("without", "jam_gearbox_inner_open_weightless"),
            )
        ),
    ),
)
