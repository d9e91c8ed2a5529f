"""The claims against the runs: a row for each reading, with every number it rests on."""

import math
from collections.abc import Callable, Iterator, Sequence
from typing import NamedTuple

import numpy as np

from trsim.studies.claim import LAW, Claim, Reading, Series
from trsim.studies.numbers import Number, number
from trsim.studies.rules import UNDETERMINED, Judged, interval
from trsim.studies.runs import Member, Runs

OF_LAWS = "trsim.laws"  # instead of a run file


class Source(NamedTuple):
    """One number of one run."""

    claim: str
    reading: str
    label: str
    case: str
    member: int
    word: str
    value: float
    unit: str
    file: str


class Row(NamedTuple):
    """A reading of a claim, judged."""

    claim: Claim
    reading: Reading
    judged: Judged
    numbers: tuple[str, ...]  # of each case: its ensemble, for the reader
    sources: tuple[Source, ...]

    @property
    def worth(self) -> str:
        """What agreement is worth."""
        return self.reading.worth or self.claim.worth

    @property
    def files(self) -> tuple[str, ...]:
        return tuple(dict.fromkeys(source.file for source in self.sources))


Display = Callable[[str], tuple[float, str]]
Law = Callable[[str], Number]
Reference = Callable[[str], str]


def judged(
    runs: Runs, claims: Sequence[Claim], display: Display, law: Law, reference: Reference
) -> Iterator[Row]:
    """A row for each reading of each claim.

    law: the number of laws that a word of LAW tells.  reference: the case from which `apart` of
    another one is measured.
    """
    known = evaluated(runs, claims, law, reference)
    for claim in claims:
        for reading in claim.readings:
            yield row(runs, claim, reading, display, known)


Known = dict[tuple[str, int, str], Number]  # case, member, word -> number


def evaluated(runs: Runs, claims: Sequence[Claim], law: Law, reference: Reference) -> Known:
    """All numbers the claims rest on; run by run, as some of them fill much memory."""
    words: dict[str, dict[str, None]] = {}
    for series in (s for claim in claims for reading in claim.readings for s in reading.series):
        words.setdefault(series.case, {})[series.word] = None
    known: Known = {}
    for word in words.pop(LAW, ()):
        known[LAW, 0, word] = law(word)
    for case, asked in words.items():
        for member in runs.sound(case):
            for word in asked:
                found = number(member, word, other(runs, member, word, reference))
                known[case, member.index, word] = found
            member.forget()
    return known


def row(runs: Runs, claim: Claim, reading: Reading, display: Display, known: Known) -> Row:
    """One reading; undetermined where runs are missing."""
    cases = list(dict.fromkeys(series.case for series in reading.series if series.case != LAW))
    absent = [case for case in cases if not runs.sound(case)]
    if absent:
        told = f"not run: {', '.join(absent)}"
        return Row(claim, reading, Judged(UNDETERMINED, told, 0, 0), (), ())
    of = [{m.index for m in runs.sound(case)} for case in cases]
    members = sorted(set.intersection(*of)) if of else [0]
    sources = [[source(runs, claim, reading, series, index, known) for index in members]
               for series in reading.series]  # fmt: skip
    values = np.array([[s.value for s in line] for line in sources])
    found = Judged(UNDETERMINED, "not defined in every run", 0, len(members))
    if np.isfinite(values).all():
        found = claim.rule.judge(values)
    planned = max((runs.planned[case] for case in cases), default=1)
    if len(members) < planned:
        found = found._replace(told=f"{found.told}; {len(members)} of {planned} members")
    numbers = tuple(f"{line[0].label}: {shown(v, *display(line[0].unit))}"
                    for line, v in zip(sources, values, strict=True))  # fmt: skip
    return Row(claim, reading, found, numbers, tuple(s for line in sources for s in line))


def source(
    runs: Runs, claim: Claim, reading: Reading, series: Series, index: int, known: Known
) -> Source:
    """The number of one member, and where it is from."""
    member = runs.of(series.case, index)
    file = runs.named(member) if member else OF_LAWS
    found = known[series.case, index, series.word]
    return Source(claim.key, reading.name, *series[:2], index, series.word, *found, file)


def other(runs: Runs, member: Member, word: str, reference: Reference) -> Member | None:
    """What `apart` is measured from."""
    if not word.startswith("apart:"):
        return None
    case = reference(member.case)
    return runs.stated(case) if runs.has(case) else None


def shown(values: np.ndarray, factor: float, unit: str) -> str:
    """The mean of an ensemble with its interval, in a display unit."""
    b = interval(factor * values)
    unit = "" if unit == "-" else f" {unit}"
    if len(values) < 2 or math.isclose(b.low, b.high, rel_tol=1e-12):
        return f"{b.mean:.4g}{unit}"
    half = b.high - b.mean
    digits = 1 - math.floor(math.log10(half))  # two digits of the interval
    if digits > 6:
        return f"{b.mean:.4g}{unit}"
    mean, half = round(b.mean, digits), round(half, digits)
    return f"{mean:.{max(0, digits)}f} \u00b1 {half:.{max(0, digits)}f}{unit}"
