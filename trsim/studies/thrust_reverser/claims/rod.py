"""Section 7.1.4 of the study: rigid and flexible rod, five of them, 0.3 mm at B, and at A."""

from trsim.studies.claim import GEOMETRY, Claim, Reading, Series, of
from trsim.studies.rules import departing, falling, within
from trsim.studies.thrust_reverser.cases import EARLY, LATE, OVERTURN

RODS = (
    ("0.5 kg, same mass", "{}_03", "{}_03_flexible_light", "damping of 1 us"),
    ("3.454 kg, same mass", "{}_03_rigid_heavy", "{}_03_flexible_heavy", "damping of 1 us"),
    ("3.454 kg, same mass, undamped", "{}_03_rigid_heavy", "{}_03_flexible_undamped", ""),
    ("tables as they stand: 0.5 kg rigid, 3.454 kg flexible", "{}_03", "{}_03_flexible_undamped",
     "mass and flexibility are changed together"),
)  # fmt: skip
OBVIOUS = falling(0.1)
NOTE = "the flexible rod is the large one, by the second moment of the tables; obviously: by 10 %"

WEAKENED = (
    ("velocity", "b", "fluctuation of the door's velocity",
     f"fluctuation:door_angle.rate{OVERTURN}"),
    ("acceleration", "c", "fluctuation of the door's acceleration",
     f"fluctuation:door_angle.acceleration{OVERTURN}"),
    ("force", "d", "contact force", "peak:{}.contact_force"),
    ("force_fluctuation", "d", "fluctuation of the contact force",
     f"fluctuation:{{}}.contact_force{OVERTURN}"),
    ("drive", "e", "fluctuation of the driving force", f"fluctuation:actuator.force{OVERTURN}"),
)  # fmt: skip


def readings(word: str, at: tuple[str, ...] = ("B", "A")) -> tuple[Reading, ...]:
    """Every rod at every pin; `word` may have a place for the name of the pin."""
    return tuple(
        Reading(f"{pin}, {name}", (Series("rigid", rigid.format(pin.lower()), word.format(pin)),
                                   Series("flexible", flexible.format(pin.lower()),
                                          word.format(pin))), note)
        for pin in at for name, rigid, flexible, note in RODS
    )  # fmt: skip


def effects(word: str) -> tuple[Reading, ...]:
    """Rigid and flexible early in the turn, and late, with rods of the same mass."""
    early, late = readings(f"{word}{EARLY}"), readings(f"{word}{LATE}")
    return tuple(
        one._replace(series=tuple(
            series._replace(label=f"{series.label}, {when}")
            for when, reading in (("early", one), ("late", other)) for series in reading.series))
        for one, other in zip(early, late, strict=True) if "same mass" in one.name
    )  # fmt: skip


CLAIMS = (
    Claim(
        "rod_displacement", "7.1.4", "18a",
        "The door turns alike with the rigid and the flexible rod.",
        within(0.0, 0.0157, "below 1 % of 90 deg off the ideal mechanism"),
        readings("apart:door_angle"),
        GEOMETRY, "the rod gives way by microns, and play over lever allows no more",
    ),
    *(
        Claim(
            f"rod_{key}", "7.1.4", f"18{panel}", f"The flexible rod obviously weakens the {what}.",
            OBVIOUS, readings(word), note=NOTE,
        )
        for key, panel, what, word in WEAKENED
    ),
    Claim(
        "rod_load", "7.1.4", "18",
        "The effect of the flexible rod becomes more obvious as the load grows.",
        departing(),
        (*of("velocity", effects("fluctuation:door_angle.rate")),
         *of("contact force", effects("fluctuation:{}.contact_force")),
         *of("driving force", effects("fluctuation:actuator.force"))),
        note="taken as: fluctuations with the flexible and with the rigid rod are farther apart, "
        "as a ratio, from 350 to 480 mm than from 150 to 250 mm",
    ),
    Claim(
        "rod_damping", "7.1.4", "18",
        "The flexible body acts as a damper of the mechanism.",
        OBVIOUS, readings("fluctuation:door_angle.rate@stroke=0.2..0.48"),
        note="taken as: less is left of the fluctuation once the impacts are over",
    ),
    Claim(
        "rod_orbit", "7.1.4", "19",
        "The flexible rod significantly reduces the range of the journal's orbit.",
        OBVIOUS, readings(f"orbit:{{}}{OVERTURN}"), note=NOTE,
    ),
    Claim(
        "rod_phase", "7.1.4", "20",
        "The door's phase diagram is smaller with the flexible rod.",
        falling(),
        (*of("velocity", readings(f"range:door_angle.rate{OVERTURN}", ("B",))),
         *of("acceleration", readings(f"range:door_angle.acceleration{OVERTURN}", ("B",)))),
    ),
    Claim(
        "rod_map", "7.1.4", "21",
        "The points of the Poincar\u00e9 section are more concentrated with the flexible rod.",
        falling(), readings(f"dispersion:{{}}_orbit{OVERTURN}"),
    ),
)  # fmt: skip
