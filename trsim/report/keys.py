"""What swept keys and their values are called in figures."""

from collections.abc import Mapping
from typing import Any

from trsim.report.display import Shown, short
from trsim.report.marks import spaced


def axis(one: Shown, key: str, si: str) -> str:
    """A swept key and its unit; the last two words of its path say enough."""
    unit = one.display(si)[1]
    return f"{readable(key)} ({unit})" if key != "case" else "case"


def readable(key: str) -> str:
    """joints.B.clearance -> B clearance."""
    return " ".join(key.split(".")[-2:]).replace("_", " ")


def named_value(one: Shown, units: Mapping[str, str], key: str, value: Any) -> str:
    """A key and its value, with unit; of a word the word alone."""
    if not isinstance(value, float | int):
        return str(value)
    factor, unit = one.display(units.get(key, "-"))
    return f"{readable(key)} {short(value * factor)}{'' if unit == '-' else f' {unit}'}"


def in_words(word: str) -> str:
    """peak:B.contact_force@0.3..0.9 -> peak of B, contact force (0.3..0.9)."""
    name, _, part = word.partition("@")
    kind, _, of = name.partition(":")
    return f"{kind} of {spaced(of)}" + (f" ({part})" if part else "")
