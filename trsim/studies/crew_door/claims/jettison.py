"""Section 4.5 of the study: jettison."""

from trsim.studies.claim import Claim, Reading, one, over
from trsim.studies.single import bounded, near, steps

CLAIMS = (
    Claim(
        "less_inertia",
        "4.5",
        "38",
        "With less inertia of the door its angular acceleration is higher.",
        steps(1, 0.1, "rad/s^2"),
        one(
            *over(
                "peak:opening.acceleration@opening=0.08..0.8",
                ("45 kg m^2", "jettison_heavy"),
                ("30 kg m^2", "jettison"),
                ("20 kg m^2", "jettison_light"),
            )
        ),
        note="inertia about x at its centre of mass",
    ),
    Claim(
        "hinges_differ",
        "4.5",
        "39",
        "Other inertias change the hinge forces in jettison slightly.",
        near(0.1),
        tuple(
            Reading(
                name,
                over(
                    f"peak:hinge.{bearing}_load@opening=0.08..1.95",
                    ("heavy", "jettison_heavy"),
                    ("as drawn", "jettison"),
                    ("light", "jettison_light"),
                ),
            )
            for name, bearing in (("forward", "locating"), ("aft", "floating"))
        ),
    ),
    Claim(
        "lever_off",
        "4.5",
        "",
        "Once the air loads turn the door the jettison lever is no longer in touch.",
        bounded(0.0, 0.0, "no force at the lever from 5 deg of the hinge on"),
        one(
            *over(
                "peak:jett_contact.normal_force@opening=0.09..1.9",
                ("jettison", "jettison"),
                ("with overpressure", "jettison_op"),
            )
        ),
    ),
)
