"""A claim of the study, in our words, and the readings of it that can be decided."""

from collections.abc import Iterable
from typing import NamedTuple

from trsim.studies.thrust_reverser.cases import Cases
from trsim.studies.thrust_reverser.rules import Rule

# what agreement with a claim is worth
INDEPENDENT = "independent"
TUNED = "tuned"  # our data were made to agree: it proves nothing
CHOSEN = "chosen"  # of several pins the one that agrees was taken for B: a selection
WORTH = {INDEPENDENT: "", TUNED: "by construction", CHOSEN: "by selection"}

LAW = "law"  # instead of a case: a number of trsim.laws, see laws.py
OVERTURN = "@stroke=0.15..0.48"  # m of stroke: from the touch of the lug to before the end
ONSET = "@stroke=0.149..0.2"  # the impacts after the touch
EARLY, LATE = "@stroke=0.15..0.25", "@stroke=0.35..0.48"


class Series(NamedTuple):
    """A number of the ensemble of one case."""

    label: str
    case: str
    word: str


class Reading(NamedTuple):
    """What a claim is taken to mean; name "" where there is one reading only."""

    name: str
    series: tuple[Series, ...]
    note: str = ""  # what is assumed in this reading


class Claim(NamedTuple):
    """A sentence that runs can confirm or contradict."""

    key: str
    section: str  # of the study
    figure: str  # of the study, where it has one
    statement: str
    rule: Rule
    readings: tuple[Reading, ...]
    worth: str = INDEPENDENT
    note: str = ""  # what is assumed in all readings


def over(word: str, *cases: tuple[str, str]) -> tuple[Series, ...]:
    """One number of several cases, (label, case)."""
    return tuple(Series(label, case, word) for label, case in cases)


def of(what: str, readings: Iterable[Reading]) -> tuple[Reading, ...]:
    """Readings with what they are of before their names."""
    return tuple(reading._replace(name=f"{what}, {reading.name}") for reading in readings)


def b_above_a(cases: Cases, name: str = "{}") -> tuple[Reading, ...]:
    """The spread of the section at A and at B; `name` has a place for the label of a case."""
    return tuple(Reading(name.format(label), tuple(
        Series(pin, case, f"dispersion:{pin}_orbit{OVERTURN}") for pin in "AB"))
        for label, case in cases)  # fmt: skip


def one(*series: Series, note: str = "") -> tuple[Reading, ...]:
    """The only reading."""
    return (Reading("", series, note),)
