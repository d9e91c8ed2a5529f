"""Section 4.1 of the study: lifting the door."""

from trsim.studies.claim import CHOSEN, TUNED, Claim, Reading, Series, one, over
from trsim.studies.crew_door.cases import (
    CROSSES,
    DEGREE,
    FIRST,
    HANDS,
    LAST,
    LATE,
    MOTION,
    MOTION_OP,
    PRESSED,
    PUSHED,
    TOP,
)
from trsim.studies.single import apart_by, bounded, near, steps

CLAIMS = (
    Claim(
        "similar_peaks",
        "4.1",
        "23, 28",
        "The largest handle load of the motion is that of the static calculation.",
        near(0.01),
        (
            Reading("without overpressure", over(f"largest:handle.force{TOP}", *MOTION)),
            Reading("with overpressure", over(f"largest:handle.force{TOP}", *MOTION_OP)),
        ),
    ),
    Claim(
        "first_contact",
        "4.1",
        "23",
        "Without a gap at Stop1 the roller meets the guide at about 28 deg of the latch.",
        bounded(27.0 * DEGREE, 29.5 * DEGREE, "between 27 and 29.5 deg"),
        one(*over(FIRST, ("motion", "lift_inner"), ("static path", "path_inner"))),
        TUNED,
        "the nose of the guide was placed for it",
    ),
    Claim(
        "gap_angle",
        "4.1",
        "23, 26",
        "A gap of 1.3 mm at Stop1 lets the roller meet the guide some 5 deg of the latch earlier.",
        apart_by(-6.5 * DEGREE, -3.5 * DEGREE, 1.0 / DEGREE, "deg"),
        tuple(
            Reading(name, over(FIRST, ("no gap", case), ("1.3 mm", f"{case}_gap")))
            for name, case in (*HANDS, ("static path", "path_inner"))
        ),
        CHOSEN,
        "the flank of the guide was sloped for it",
    ),
    Claim(
        "gap_lift",
        "4.1",
        "24",
        "These 5 deg are about 2 mm of lift.",
        apart_by(-3e-3, -1e-3, 1e3, "mm"),
        one(
            *over(
                "begins:fwd_guide.normal_force@lift=-1..1",
                ("no gap", "lift_inner"),
                ("1.3 mm", "lift_inner_gap"),
            )
        ),
        CHOSEN,
        "the crank and the flank were chosen for it",
    ),
    Claim(
        "handover",
        "4.1",
        "27",
        "Once the roller runs on the guide Stop1 is out of use.",
        bounded(0.0, 1.0, "at most 1 N at Stop1 from 35 deg on"),
        one(*over("peak:fwd_stop1.normal_force@latch_angle=0.61..1.5", *HANDS, *PRESSED)),
    ),
    Claim(
        "sides",
        "4.1",
        "27",
        "Stop1 and guide carry alike forward and aft.",
        near(0.05),
        (
            Reading(
                "Stop1",
                (
                    Series("fwd", "lift_inner", f"peak:fwd_stop1.normal_force{TOP}"),
                    Series("aft", "lift_inner", f"peak:aft_stop1.normal_force{TOP}"),
                ),
            ),
            Reading(
                "guide",
                (
                    Series("fwd", "lift_inner", f"peak:fwd_guide.normal_force{TOP}"),
                    Series("aft", "lift_inner", f"peak:aft_guide.normal_force{TOP}"),
                ),
            ),
        ),
        TUNED,
        "our door is symmetric but for the latch and the counterbalance",
    ),
    Claim(
        "negative",
        "4.1",
        "23",
        "From about 70 deg of the latch on the handle load is negative.",
        bounded(65.0 * DEGREE, 76.0 * DEGREE, "between 65 and 76 deg"),
        one(*over(CROSSES, *HANDS)),
        CHOSEN,
        "the exit of the guide was shaped for it",
    ),
    Claim(
        "pressure",
        "4.1",
        "28, 29",
        "Overpressure raises the handle load, and the forces at Stop1 and guide.",
        steps(1, 1.0, "N or N m"),
        tuple(
            Reading(
                name,
                over(f"largest:{channel}{PUSHED}", ("none", case), ("2500 N", f"{case}_op")),
            )
            for case, hand in (("lift_inner", "inner"), ("lift_outer", "outer"))
            for name, channel in (
                (f"handle, {hand}", "handle.force"),
                (f"Stop1, {hand}", "fwd_stop1.normal_force"),
                (f"guide, {hand}", "fwd_guide.normal_force"),
            )
        ),
    ),
    Claim(
        "inertia",
        "4.1",
        "27",
        "Above 70 deg of the latch the motion departs from the static calculation by far, at less "
        "than 6 deg/s of the handle.",
        bounded(57.0, 1e9, "by more than 57 N, a tenth of the largest force at the guide"),
        (
            Reading(
                "70 to 94.5 deg",
                (Series("guide", "lift_inner", f"apart:fwd_guide.normal_force{LATE}"),),
            ),
            Reading(
                "70 deg to the end of the path",
                (Series("guide", "lift_inner", f"apart:fwd_guide.normal_force{LAST}"),),
            ),
        ),
        note="the path ends at 96 deg, where the roller leaves the guide",
    ),
    Claim(
        "inertia_pressed",
        "4.1",
        "29",
        "With overpressure motion and static calculation agree better.",
        steps(-1, 1.0, "N"),
        one(
            Series("none", "lift_inner", f"apart:fwd_guide.normal_force{LATE}"),
            Series("2500 N", "lift_inner_op", f"apart:fwd_guide.normal_force{LATE}"),
        ),
        note="70 to 94.5 deg; of the largest force there either is 1 %",
    ),
    Claim(
        "let_go_angle",
        "4.1",
        "30",
        "The handle may be let go at 58 deg of the latch, where its load would turn negative.",
        bounded(56.0 * DEGREE, 60.0 * DEGREE, "between 56 and 60 deg"),
        (
            Reading("without overpressure", over(CROSSES, ("inner handle", "lift_inner"))),
            Reading("with overpressure", over(CROSSES, ("inner handle", "lift_inner_op"))),
            Reading(
                "without friction of the seals",
                over(CROSSES, ("inner handle", "lift_inner_smooth")),
            ),
        ),
    ),
    Claim(
        "goes_on",
        "4.1",
        "30",
        "Let go there, the mechanism lifts the door on by itself.",
        bounded(1.6, 10.0, "comes to more than 92 deg of the latch"),
        (
            Reading(
                "where the load changes its sign", over("final:latch_angle", ("none", "let_go"))
            ),
            Reading("with overpressure", over("final:latch_angle", ("2500 N", "let_go_op"))),
            Reading(
                "without friction of the seals",
                over("final:latch_angle", ("no friction", "let_go_smooth")),
            ),
            Reading("let go at 80 deg", over("final:latch_angle", ("80 deg", "let_go_late"))),
        ),
    ),
    Claim(
        "let_go_guide",
        "4.1",
        "30",
        "Let go, the door presses the guide less than when the handle is driven.",
        steps(-1, 1.0, "N"),
        (
            Reading(
                "let go at 80 deg",
                over(
                    "mean:fwd_guide.normal_force@latch_angle=1.42..1.6",
                    ("driven", "lift_inner"),
                    ("let go", "let_go_late"),
                ),
            ),
            Reading(
                "with overpressure",
                over(
                    "mean:fwd_guide.normal_force@latch_angle=1.15..1.5",
                    ("driven", "lift_inner_op"),
                    ("let go", "let_go_op"),
                ),
            ),
        ),
    ),
)
