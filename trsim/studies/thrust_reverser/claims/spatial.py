"""Section 7.2 of the study: five doors and three actuators, one of them asynchronous."""

from trsim.studies.claim import TUNED, Claim, Reading, Series
from trsim.studies.rules import Rule, exact
from trsim.studies.single import (
    above,
    apart,
    below,
    greatest,
    near,
    opposite,
    steps,
)
from trsim.studies.thrust_reverser.figures import sticking
from trsim.studies.thrust_reverser.figures.spatial import ACTUATORS, SHAFTS, case

ODD = (418, 419, 421, 422)  # mm/s
UNFITTED = ODD[1:]  # where no force of 1 or 3 is among the peaks that were fitted
RISING, FALLING = (418, 419, 420, 421, 422), (422, 421, 420, 419, 418)
SOME = ("0", "0.53", "5.3")  # N m/rad, of the stiffnesses of the shaft
PEAK = "largest:actuator_{}.force@stroke=0.3..0.498"  # m: under load, and to the end
LATE = "mean:actuator_{}.force@stroke=0.47..0.48"
ASSISTING = (
    "the load drives the fairing aft, so that who lags holds back more; with a load that resists "
    "it would be reversed"
)
SHARED = "the stiffnesses that were fitted to the nine peaks give these, too"
ONLY = f"our reading: the study tells of the largest only; {SHARED}"
RESISTING = "ours: a force against the motion, twice what the gas drives"
FITTED = "stiffnesses, radius and load shares were fitted to the study's nine peaks"


def forces(
    odd: int, of: tuple[int, ...], speeds: tuple[int, ...], word: str = PEAK
) -> tuple[Series, ...]:
    """Forces of actuators where one has a speed of its own, one actuator after the other."""
    return tuple(Series(f"{k} at {speed} mm/s", case(odd, speed), word.format(k))
                 for k in of for speed in speeds)  # fmt: skip


def each(odd: int, of: tuple[int, ...], speeds: tuple[int, ...]) -> tuple[Reading, ...]:
    """The actuators beside each other at each speed."""
    return tuple(Reading(f"{speed} mm/s", forces(odd, of, (speed,))) for speed in speeds)


def trend(odd: int, of: tuple[int, ...], speeds: tuple[int, ...]) -> tuple[Reading, ...]:
    """Each actuator over the speeds: its largest force, and the force late in the stroke."""
    return tuple(Reading(f"actuator {k}, {name}", forces(odd, (k,), speeds, word))
                 for name, word in (("largest", PEAK), ("at 470 to 480 mm", LATE))
                 for k in of)  # fmt: skip


def of_odd(k: int, odds: tuple[int, ...], speeds: tuple[int, ...]) -> tuple[Series, ...]:
    """The largest force of an actuator where one after the other has a speed of its own."""
    return tuple(Series(f"{odd} at {speed} mm/s", case(odd, speed), PEAK.format(k))
                 for odd in odds for speed in speeds)  # fmt: skip


def one_speed(word: str, *of: int) -> tuple[Series, ...]:
    return tuple(Series(f"actuator {k}", "spatial_420", word.format(k)) for k in of)


def ends(speeds: tuple[int, ...], stiffnesses: tuple[str, ...]) -> tuple[Series, ...]:
    """When runs of the grid end, s."""
    return tuple(Series(f"{sticking.late(speed)}, {k} N\u00b7m/rad", sticking.case(speed, k),
                        "summary:time") for speed in speeds for k in stiffnesses)  # fmt: skip


def most(*cases: tuple[str, str]) -> tuple[Series, ...]:
    """The largest magnitude of all three actuators, (label, case)."""
    return tuple(Series(label, name, "most:actuator_?.force") for label, name in cases)


def largest_and_each(
    key: str, odd: int, rule: Rule, of: tuple[int, ...], unfitted: tuple[int, ...], *told: str
) -> tuple[Claim, Claim]:
    """A claim on the largest forces where one actuator has a speed of its own, and the same on the
    forces at each speed; unfitted: those where nothing was fitted."""
    largest, at_each = (f"With actuator {odd} asynchronous {what}" for what in told)
    whole = (Reading("", forces(odd, of, ODD)),)
    figure = str(23 + odd)
    return (
        Claim(key, "7.2", figure, largest, greatest(rule, 4), whole, TUNED, FITTED),
        Claim(f"{key}_each", "7.2", figure, at_each, rule, each(odd, of, unfitted), TUNED, ONLY),
    )


def moves(
    key: str, odd: int, told: str, side: int, of: tuple[int, ...], speeds: tuple[int, ...]
) -> Claim:
    """A claim that forces rise (side 1) or fall (-1) with the speed of one actuator."""
    readings = trend(odd, of, speeds)
    note = f"{SHARED}; {ASSISTING}"
    return Claim(key, "7.2", str(23 + odd), told, steps(side), readings, TUNED, note)


CLAIMS = (
    # all at one speed
    Claim(
        "synchronous_alike", "7.2", "23",
        "At one speed the forces of actuators 1 and 3 are basically alike.",
        apart(), (Reading("", one_speed(PEAK, 1, 2, 3)),), TUNED, FITTED,
    ),
    Claim(
        "synchronous_above", "7.2", "23",
        "At one speed the forces of actuators 1 and 3 are above that of actuator 2.",
        above(), (Reading("actuator 1", one_speed(PEAK, 2, 1)),
                  Reading("actuator 3", one_speed(PEAK, 2, 3))), TUNED, FITTED,
    ),
    Claim(
        "synchronous_along", "7.2", "23",
        "The actuators are loaded along X, and hardly in Y and Z.",
        exact(0.0, 0.01, "across X below 1 % of along X"),
        (Reading("", one_speed("sideways:actuator_{}.reaction", 1, 2, 3)),),
        TUNED, "ball ends, which we assume, let no other force through than one along the line",
    ),
    # actuator 1 at another speed
    *largest_and_each(
        "one_alike", 1, apart(), ACTUATORS, UNFITTED,
        "the forces of 1 and 3 are similar, and unlike that of 2.",
        "they are so at each speed, not the largest alone.",
    ),
    *largest_and_each(
        "one_above", 1, above(), (3, 1), UNFITTED,
        "the force of 1 is above that of 3.",
        "its force is above that of 3 at each speed.",
    ),
    moves("one_rises", 1, "The forces of 1 and 3 rise as actuator 1 becomes slower.",
          1, (1, 3), FALLING),
    moves("one_falls", 1, "The force of 2 falls as actuator 1 becomes slower.",
          -1, (2,), FALLING),
    # actuator 2
    *largest_and_each(
        "two_alike", 2, apart(), ACTUATORS, UNFITTED[:-1],
        "the forces of 1 and 3 are alike, and unlike that of 2.",
        "they are so at each speed, not the largest alone.",
    ),
    moves("two_rises", 2, "The forces of 1 and 3 rise as actuator 2 becomes faster.",
          1, (1, 3), RISING),
    moves("two_falls", 2, "The force of 2 falls as it becomes faster.", -1, (2,), RISING),
    Claim(
        "two_opposite", "7.2", "25",
        "That is opposite to what the speed of actuator 1 does.",
        opposite(),
        tuple(Reading(f"actuator {k}", of_odd(k, (1, 2), (418, 422))) for k in ACTUATORS),
        TUNED, "forces follow the second difference of the three strokes, in which 2 has the "
        f"other sign: so it is for 1 and 3 about 2, too; {SHARED}",
    ),
    # actuator 3, and all compared
    Claim(
        "three_mirrors", "7.2", "26",
        "Actuator 3 asynchronous is the mirror of actuator 1 asynchronous.",
        greatest(near(0.05), 4),
        tuple(Reading(name, forces(1, (mine,), ODD) + forces(3, (mirrored,), ODD))
              for name, mine, mirrored in (("the odd one", 1, 3), ("actuator 2", 2, 2),
                                           ("the far one", 3, 1))),
        TUNED, "the mechanism is symmetric, but for 1 % of load from door to door",
    ),
    Claim(
        "two_largest", "7.2", "24, 25, 26",
        "All forces are largest where actuator 2 is the asynchronous one.",
        greatest(above(), 4),
        tuple(Reading(f"actuator {k}", of_odd(k, (1, 3, 2), ODD)) for k in ACTUATORS),
        TUNED, FITTED,
    ),
    # a synchronising shaft
    Claim(
        "shaft_adjusts", "7.2", "25",
        "A synchronising shaft adjusts the motion of actuators that have come apart.",
        below(),
        tuple(Reading(f"actuator 2 at 418 mm/s, {label}",
                      most(("without", "spatial_shaft_without"), (label, name)))
              for label, name in SHAFTS[1:]),
        note="taken as: the largest force on the fairing falls; pistons that give way behind "
        "their supply are ours",
    ),
    Claim(
        "shaft_holds", "7.2", "25",
        "The adjustment keeps the mechanism from sticking.",
        steps(1, 0.001, "s"),
        tuple(Reading(f"2 slower by {sticking.late(speed)}", ends((speed,), sticking.STIFFNESSES))
              for speed in (416, 408)),
        note="our reading: a stiffer shaft puts the end of the run off; stalls at 3 kN of the "
        "supply, against which the shaft drags the slow piston",
    ),
    Claim(
        "sticks", "7.2", "25",
        "Where the speeds differ enough the adjustment fails and the mechanism sticks.",
        exact(0.0, 1.0, "stalls before 1 s, the stroke takes 1.19 s"),
        tuple(Reading(f"2 slower by 12 mm/s, shaft of {k} N\u00b7m/rad", ends((408,), (k,)))
              for k in SOME),
        TUNED, "that it sticks follows from a stall force, 3 kN, which is ours",
    ),
    Claim(
        "sticks_earlier", "7.2", "25",
        "The larger the difference of the speeds, the earlier the mechanism sticks.",
        steps(-1, 0.001, "s"),
        tuple(Reading(f"shaft of {k} N\u00b7m/rad", ends(sticking.SPEEDS, (k,)))
              for k in SOME),
        TUNED, "our reading; stalls at 3 kN of the supply, ours, of forces that grow as the fitted "
        "trends have it",
    ),
)  # fmt: skip

CONCLUSIONS = (
    Claim(
        "advice_faster", "8", "25",
        "Where actuator 2 is to differ, slower than 1 and 3 gives lower peaks than faster.",
        below(),
        (*(Reading(f"{slow} and {fast} mm/s", most((f"{fast} mm/s", case(2, fast)),
                                                   (f"{slow} mm/s", case(2, slow))))
           for slow, fast in ((418, 422), (419, 421))),
         Reading("418 and 422 mm/s, a load that resists",
                 most(("422 mm/s", "spatial_resisted_422"), ("418 mm/s", "spatial_resisted_418")),
                 RESISTING)),
        TUNED, f"largest magnitude of all three actuators; {SHARED}; {ASSISTING}",
    ),
    Claim(
        "advice", "8", "25",
        "Running actuator 2 slower than 1 and 3 reduces the peak of the driving force.",
        below(),
        (*(Reading(f"{slow} mm/s, against one speed",
                   most(("420 mm/s", "spatial_420"), (f"{slow} mm/s", case(2, slow))))
           for slow in (418, 419)),
         Reading("418 mm/s, against one speed, a load that resists",
                 most(("420 mm/s", "spatial_resisted_420"), ("418 mm/s", "spatial_resisted_418")),
                 RESISTING)),
        TUNED, f"largest magnitude of all three actuators; {SHARED}; {ASSISTING}",
    ),
)  # fmt: skip
