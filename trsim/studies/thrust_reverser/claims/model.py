"""Sections 3 and 6.2 of the study: contact and friction laws, the pendulum that verifies."""

from trsim.studies.claim import BOOKKEEPING, LAW, Claim, Series, one
from trsim.studies.rules import exact, undecided

CLAIMS = (
    Claim(
        "restitution", "3.1", "3c",
        "The contact law of Lankarani and Nikravesh represents an impact accurately.",
        exact(0.98, 1.02, "delivers 0.98 to 1.02 of the restitution it is given"),
        one(Series("at 0.9", LAW, "restitution:0.9")),
        note="at 0.9, which the study has; at 0.5 it delivers 0.725",
    ),
    Claim(
        "coulomb", "3.2", "3a",
        "Coulomb's friction force jumps where the motion stops.",
        exact(0.5999, 0.6001, "jumps by twice the coefficient of friction"),
        one(Series("jump over normal force", LAW, "jump:coulomb")), BOOKKEEPING,
    ),
    Claim(
        "modified_coulomb", "3.2", "3b",
        "The modified law has no such jump.",
        exact(0.0, 1e-9, "no jump at rest"),
        one(Series("jump over normal force", LAW, "jump:modified_coulomb")),
        BOOKKEEPING, "in return a loaded joint never rests: it creeps at v0, 0.1 mm/s",
    ),
    Claim(
        "pendulum", "6.2", "7",
        "The motion of the flexible pendulum agrees closely with published curves.",
        undecided(
            "the published curves are not at hand; two meshes and the energy book are compared"
        ),
        one(
            Series("tip, 8 and 16 elements apart", "pendulum_8", "apart:rod.tip"),
            Series("middle, 8 and 16 elements apart", "pendulum_8", "apart:rod.middle"),
            Series("energy missed, 8 elements", "pendulum_8", "drift:energy.residual"),
            Series("energy missed, 16 elements", "pendulum_16", "drift:energy.residual"),
        ),
        note="square section of 5 mm, gravity along -y, released horizontal: the study does not "
        "say; its beam is planar, its pendulum is not",
    ),
)  # fmt: skip
