"""Cases with play at A and B that claims and figures compare: (label, case)."""

Cases = tuple[tuple[str, str], ...]


def clearances(name: str) -> Cases:
    """The case of each clearance; `name` has a place for its tenths of a millimetre."""
    return tuple((f"0.{tenths} mm", name.format(tenths)) for tenths in (1, 3, 5))


AB, A, B = clearances("ab_0{}"), clearances("a_0{}"), clearances("b_0{}")
SOFT, GIVES = clearances("ab_0{}_soft"), clearances("ab_0{}_compliant")
SPEED_B = (("0.5 m/s", "b_05"), ("1.0 m/s", "b_05_fast"))
SPEED_AB = (("0.5 m/s", "ab_05"), ("1.0 m/s", "ab_05_fast"))
