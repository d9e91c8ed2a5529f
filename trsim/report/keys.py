"""What swept keys and their values are called in figures."""

from collections.abc import Mapping
from typing import Any, NamedTuple

from trsim.report.display import Shown, short, written
from trsim.report.marks import spaced
from trsim.units import unit


class Units(NamedTuple):
    """The units of swept keys: SI, and as the scenario has them."""

    si: Mapping[str, str]
    written: Mapping[str, str]

    def display(self, one: Shown, key: str) -> tuple[float, str]:
        """Factor and text of the unit in figures: as chosen, else as written in the scenario."""
        si = self.si.get(key, "-")
        if key not in self.written or si in one.asked:
            return one.display(si)
        return 1.0 / float(unit(self.written[key])[0]), written(self.written[key])


def axis(one: Shown, units: Units, key: str) -> str:
    """A swept key and its unit; the last two words of its path say enough."""
    shown = units.display(one, key)[1]
    return f"{readable(key)} ({shown})" if key != "case" else "case"


def readable(key: str) -> str:
    """joints.B.clearance -> B clearance."""
    return " ".join(key.split(".")[-2:]).replace("_", " ")


def named_value(one: Shown, units: Units, key: str, value: Any) -> str:
    """A key and its value, with unit; of a word the word alone."""
    if not isinstance(value, float | int):
        return str(value)
    factor, shown = units.display(one, key)
    return f"{readable(key)} {short(value * factor)}{'' if shown == '-' else f' {shown}'}"


def in_words(word: str) -> str:
    """peak:B.contact_force@0.3..0.9 -> peak of B contact force (0.3..0.9)."""
    name, _, part = word.partition("@")
    kind, _, of = name.partition(":")
    return f"{kind} of {spaced(of)}" + (f" ({part})" if part else "")
