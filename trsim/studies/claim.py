"""A claim of a study, in our words, and the readings of it that can be decided."""

from collections.abc import Iterable
from typing import NamedTuple

from trsim.studies.rules import Rule

Cases = tuple[tuple[str, str], ...]  # (label, case) of what is compared

# what agreement with a claim is worth
INDEPENDENT = "independent"
TUNED = "tuned"  # our data were made to agree: it proves nothing
CHOSEN = "chosen"  # of several choices the one that agrees was taken: a selection
GEOMETRY = "geometry"  # lengths and clearances leave nothing else, however it moves: no finding
BOOKKEEPING = "bookkeeping"  # nor do a formula, a count or a balance, which no run could miss
WORTH = {
    INDEPENDENT: "",
    TUNED: "by construction",
    CHOSEN: "by selection",
    GEOMETRY: "geometry",
    BOOKKEEPING: "bookkeeping",
}

LAW = "law"  # instead of a case: a number of trsim.laws, see `law` of a study


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
    worth: str = (
        ""  # of agreement with it, where that is not what agreement with the claim is worth
    )


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


def one(*series: Series, note: str = "") -> tuple[Reading, ...]:
    """The only reading."""
    return (Reading("", series, note),)
