"""Sections 3 and 5.2 of the study: how contacts are modelled, and the load of the hand."""

from trsim.studies.claim import Claim, Reading, Series, one, over
from trsim.studies.crew_door.cases import TOP
from trsim.studies.single import bounded, grows, near, steps

CLAIMS = (
    Claim(
        "penetration",
        "3.1",
        "15",
        "A softer contact at the guide lets the roller sink in deeper.",
        steps(1, 1e-6, "m"),
        one(
            *over(
                f"largest:fwd_guide.penetration{TOP}",
                ("6e8", "lift_inner_stiff"),
                ("3e8", "lift_inner"),
                ("3e7", "lift_inner_soft"),
            )
        ),
    ),
    Claim(
        "chopped",
        "3.1",
        "40",
        "Penetration takes the top of the cam off: the roller passes it more easily.",
        grows(0.01),
        (
            Reading(
                "largest force at the guide",
                over(
                    f"peak:fwd_guide.normal_force{TOP}",
                    ("3e7", "lift_inner_soft"),
                    ("6e8", "lift_inner_stiff"),
                ),
            ),
            Reading(
                "torque at the inner handle",
                over(
                    f"peak:handle.force{TOP}",
                    ("3e7", "lift_inner_soft"),
                    ("6e8", "lift_inner_stiff"),
                ),
            ),
        ),
        note="stiffness of the contact in N/m^1.5, a tenth and twice that of the other cases",
    ),
    Claim(
        "springs",
        "3.1",
        "18",
        "Seven springs a side in place of three make no large difference.",
        near(0.02),
        (
            Reading(
                "torque at the inner handle",
                over(
                    f"peak:handle.force{TOP}",
                    ("3", "lift_inner_three"),
                    ("7", "lift_inner_seven"),
                    ("integrated", "lift_inner"),
                ),
            ),
            Reading(
                "guide",
                over(
                    f"peak:fwd_guide.normal_force{TOP}",
                    ("3", "lift_inner_three"),
                    ("7", "lift_inner_seven"),
                    ("integrated", "lift_inner"),
                ),
            ),
        ),
    ),
    Claim(
        "residual",
        "3.2",
        "",
        "A hand load put back in place of the measured torque leaves a few per cent of it at most.",
        bounded(0.0, 0.03, "at most 3 % of the first peak"),
        one(Series("after one pass", "sizing", "left:2")),
        note="the load is then put back again until less than 1e-6 is left",
    ),
)
