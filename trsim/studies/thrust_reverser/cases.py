"""Cases with play at A and B that claims and figures compare, and windows of the stroke."""

from trsim.studies.claim import Cases, Reading, Series

OVERTURN = "@stroke=0.15..0.48"  # m of stroke: from the touch of the lug to before the end
ONSET = "@stroke=0.149..0.2"  # the impacts after the touch
EARLY, LATE = "@stroke=0.15..0.25", "@stroke=0.35..0.48"


def clearances(name: str) -> Cases:
    """The case of each clearance; `name` has a place for its tenths of a millimetre."""
    return tuple((f"0.{tenths} mm", name.format(tenths)) for tenths in (1, 3, 5))


def fine(cases: Cases) -> Cases:
    """The same members with rows ten times as fine, for what is seen enlarged."""
    return tuple((label, f"{name}_fine") for label, name in cases)


AB, A, B = clearances("ab_0{}"), clearances("a_0{}"), clearances("b_0{}")
SOFT, GIVES = clearances("ab_0{}_soft"), clearances("ab_0{}_compliant")
SPEED_B = (("0.5 m/s", "b_05"), ("1.0 m/s", "b_05_fast"))
SPEED_AB = (("0.5 m/s", "ab_05"), ("1.0 m/s", "ab_05_fast"))


def b_above_a(cases: Cases, name: str = "{}") -> tuple[Reading, ...]:
    """The spread of the section at A and at B; `name` has a place for the label of a case."""
    return tuple(Reading(name.format(label), tuple(
        Series(pin, case, f"dispersion:{pin}_orbit{OVERTURN}") for pin in "AB"))
        for label, case in cases)  # fmt: skip
