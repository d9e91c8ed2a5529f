"""Section 8 of the study, where it says more than section 7: number of joints, speed."""

from trsim.studies.claim import Claim, Reading, of, over
from trsim.studies.rules import rising
from trsim.studies.thrust_reverser.cases import OVERTURN
from trsim.studies.thrust_reverser.claims.speed import pins

FROM_A = (("A", "a_03"), ("A, B", "ab_03"), ("A, P, Q, B", "abpq_03"))
FROM_B = (("B", "b_03"), ("A, B", "ab_03"), ("A, P, Q, B", "abpq_03"))


def readings(word: str) -> tuple[Reading, ...]:
    """One joint, two and four, beginning with either."""
    return Reading("A first", over(word, *FROM_A)), Reading("B first", over(word, *FROM_B))


CLAIMS = (
    Claim(
        "number_velocity", "8", "",
        "The vibration grows with the number of joints with clearance.",
        rising(),
        (*of("velocity", readings(f"fluctuation:door_angle.rate{OVERTURN}")),
         *of("driving force", readings(f"fluctuation:actuator.force{OVERTURN}"))),
        note="0.3 mm at each",
    ),
    Claim(
        "number_acceleration", "8", "",
        "The door's acceleration grows with the number of joints with clearance.",
        rising(),
        (*of("fluctuation", readings(f"fluctuation:door_angle.acceleration{OVERTURN}")),
         *of("largest value", readings("peak:door_angle.acceleration"))),
        note="our reading of vibration; 0.3 mm at each",
    ),
    Claim(
        "number_force", "8", "",
        "Contact forces grow with the number of joints with clearance.",
        rising(),
        (Reading("at A", over("peak:A.contact_force", *FROM_A)),
         Reading("at B", over("peak:B.contact_force", *FROM_B))),
        note="our reading of vibration; 0.3 mm at each",
    ),
    Claim(
        "number_map", "8", "",
        "The nonlinearity grows with the number of joints with clearance.",
        rising(),
        (Reading("spread of the section at A", over(f"dispersion:A_orbit{OVERTURN}", *FROM_A)),
         Reading("spread of the section at B", over(f"dispersion:B_orbit{OVERTURN}", *FROM_B))),
        note="nonlinearity taken as spread of the section; 0.3 mm at each",
    ),
    Claim(
        "speed_nonlinear", "8", "",
        "The nonlinearity grows with the driving speed.",
        rising(),
        pins(f"dispersion:{{}}_orbit{OVERTURN}"),
        note="the study says the opposite of the same section in 7.1.3",
    ),
)  # fmt: skip
