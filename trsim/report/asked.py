"""What `trsim report` was asked for beside its ordinary figures, and what came of it."""

import csv
import re
from collections.abc import Iterable, Sequence
from pathlib import Path
from typing import Any, NamedTuple

from trsim.errors import UsageError
from trsim.store.target import Kind, file_errors, fresh, headed


class Asked(NamedTuple):
    """Analyses, by the words of their options."""

    plot: tuple[str, ...] = ()  # Y, Y2 : X[@WINDOW]
    window: str = ""  # of the abscissa of plots
    zoom: str = ""  # the stretch of it that plots enlarge; off: none
    second_axis: bool = False  # of plots
    magnitude: bool = False  # of vectors in plots
    laws: bool = False
    section: tuple[str, ...] = ()  # when=CHANNEL,crosses=up,plot=X:Y
    portrait: tuple[str, ...] = ()  # X:Y[@WINDOW]
    spectrum: tuple[str, ...] = ()  # CHANNEL[@WINDOW]
    lyapunov: tuple[str, ...] = ()  # CHANNEL[@WINDOW]
    compare: bool = False
    channels: tuple[str, ...] = ()  # patterns of what is compared
    against: str = ""  # channel in place of the time
    overlay: tuple[str, ...] = ()  # FILE.csv:CHANNEL; with plots FILE.csv
    table: tuple[str, ...] = ()  # words of analyse/outputs.py
    bifurcation: tuple[str, ...] = ()  # SECTION[:AXIS][@WINDOW]
    sobol: tuple[str, ...] = ()  # words
    map: tuple[str, ...] = ()  # words
    bars: tuple[str, ...] = ()  # WORD[, WORD ...], a figure each
    envelope: str = ""  # patterns of quantities; `forces`: all forces and moments
    at: str = ""  # abscissa that an envelope tells
    along: tuple[str, ...] = ()  # channels whose values it tells as well
    over: str | None = None  # swept key


class Value(NamedTuple):
    """A number that an analysis found.

    run    file, case, or what tells the run from the others
    what   the word that asked for it, or what it is
    value  in the unit; none where the run has nothing to make it of
    half   of its 95 % interval; none without one
    unit   SI, or as chosen
    """

    run: str
    what: str
    value: float
    half: float
    unit: str


class Found(NamedTuple):
    """What an analysis leaves."""

    files: list[Path]
    values: list[Value]
    lines: list[str]  # for a reader

    def add(self, other: "Found") -> None:
        self.files.extend(other.files)
        self.values.extend(other.values)
        self.lines.extend(other.lines)


def nothing() -> Found:
    return Found([], [], [])


def file_name(kind: str, word: str) -> str:
    """A name for the figure of a word: letters and digits, joined.

    Signs that make another word of the same letters are written out: |B.force|@-3..-1 is
    magnitude_B_force_minus3_to_minus1.
    """
    said = re.sub(r"\|([^|]*)\|", r" magnitude \1 ", word)
    said = re.sub(r"-(?=[\d.])", " minus", said).replace("..", " to ")
    return "_".join([kind, *"".join(c if c.isalnum() else " " for c in said).split()])


def table(
    path: Path,
    titles: Sequence[str],
    rows: Iterable[Sequence[Any]],
    kind: Kind | None = None,
    given: Iterable[str] = (),
) -> Path:
    """Write rows as CSV, numbers in full.

    kind: of the older tables it may replace; those with the same first two titles unless given.
    given: files that are read, and stay.
    """
    with (
        file_errors(path),
        fresh(path, kind or headed(*titles[:2]), given) as unfinished,
        unfinished.open("w", newline="", encoding="utf-8") as file,
    ):
        out = csv.writer(file)
        out.writerow(titles)
        for row in rows:
            out.writerow([repr(float(v)) if isinstance(v, float) else v for v in row])
    return path


def words(text: Iterable[str]) -> list[str]:
    """Words of options that take several, separated by commas."""
    found = [word.strip() for one in text for word in one.split(",") if word.strip()]
    for word in found:
        if found.count(word) > 1:
            raise UsageError(f"'{word}' is asked for twice", "Once is enough.")
    return found
