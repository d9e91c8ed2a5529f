"""What the runs of a study answer, each of them read once, and why a case has no answer.

A case has none where its run did not end well, its file cannot be read, or the run has not what is
asked for: a channel, a section, rows in a window.  It is named with the reason, and the others go
on.  Only what no case has is an error.
"""

from collections.abc import Callable, Iterable, Iterator, Mapping
from dataclasses import replace
from functools import partial
from typing import Any, NamedTuple

import numpy as np

from trsim.analyse.outputs import scalar
from trsim.errors import FileError, TrsimError, UsageError, listed
from trsim.statuses import NOT_NEEDED, WELL
from trsim.store.once import Once
from trsim.store.read import Run


class Answers(NamedTuple):
    """The answers of all cases to one question, by the names of the cases."""

    found: dict[str, Any]
    why: dict[str, str]  # of runs that ended well: what is in the way


class Numbers(NamedTuple):
    """A number of every case, by the names of the cases."""

    word: str
    unit: str
    values: dict[str, float]  # nan where a case has none
    why: dict[str, str]  # a run that ended well has none


def answers(study: Any, questions: Mapping[str, Callable[[Run], Any]]) -> dict[str, Answers]:
    """What every run of a study answers to every question.

    A question raises UsageError or FileError where a run has no answer.  Raises one of these where
    no run has, and UsageError where none ended well.
    """
    every = {key: Answers({}, {}) for key in questions}
    errors: dict[str, list[TrsimError]] = {key: [] for key in questions}
    for case in study.cases:
        for key, answer in _answered(case, questions) if case.status in WELL else ():
            if isinstance(answer, TrsimError):
                errors[key].append(answer)
                every[key].why[case.name] = reason(answer, case)
            else:
                every[key].found[case.name] = answer
    for key, one in every.items():
        if not one.found and errors[key]:  # a word that makes no sense says more than a lost file
            raise min(errors[key], key=lambda error: isinstance(error, FileError))
        if not one.found:
            raise no_result()
    return every


def _answered(case: Any, questions: Mapping[str, Callable[[Run], Any]]) -> Iterator[Any]:
    """Each question with its answer, or with the error that there is instead."""
    try:
        run = Once.of(case.run())
    except FileError as error:
        yield from ((key, error) for key in questions)
        return
    for key, question in questions.items():
        try:
            yield key, question(run)
        except (UsageError, FileError) as error:
            yield key, error


def numbers(study: Any, words: Iterable[str]) -> dict[str, Numbers]:
    """The numbers of several words (outputs.py), of every case.

    Raises UsageError or FileError for a word that no case has a number for.
    """
    every = answers(study, {word: partial(scalar, word=word) for word in words})
    found = {}
    for word, one in every.items():
        values = {c.name: one.found.get(c.name, (np.nan, ""))[0] for c in study.cases}
        empty = {name: f"nothing to make {word} of" for name in one.found if np.isnan(values[name])}
        unit = next(iter(one.found.values()))[1]
        for name, (_, own) in one.found.items():
            if own != unit:
                values[name] = np.nan
                empty[name] = f"{word} is in {own}, not in {unit} as that of other cases"
        found[word] = Numbers(word, unit, values, {**one.why, **empty})
    return found


# --- what is told of cases -------------------------------------------------------------------


def no_result() -> UsageError:
    return UsageError("no case of the study has a result", "Run the sweep first.")


def reason(error: TrsimError, case: Any) -> str:
    """What is wrong, without the file, which is that of the case."""
    return error.what.removeprefix(str(case.file)).removeprefix(":").strip()


def reasons(why: Mapping[str, str]) -> list[str]:
    """CASE: why.  Cases with the same reason share a line."""
    groups: dict[str, list[str]] = {}
    for name, text in why.items():
        groups.setdefault(text, []).append(name)
    return [f"{listed(names)}: {text}" for text, names in groups.items()]


def needed(study: Any) -> Any:
    """The study without the cases that an adaptive sweep found not to be needed."""
    cases = tuple(case for case in study.cases if case.status != NOT_NEEDED)
    return study if len(cases) == len(study.cases) else replace(study, cases=cases)


def spared(study: Any) -> list[str]:
    """How many cases were not needed, where there are any."""
    n = len(study.cases) - len(needed(study).cases)
    return [f"{n:,} of {len(study.cases):,} cases were not needed and are left out"] if n else []


def unfinished(study: Any) -> list[str]:
    """Which cases are left out, since their runs did not end well or are not there."""
    lost = [case for case in study.cases if case.status not in WELL]
    kinds = {
        "did not end well": [case.name for case in lost if case.there],
        "have a file that was changed": [case.name for case in lost if case.changed],
        "have no result": [case.name for case in lost if not (case.there or case.changed)],
    }
    return [
        f"{len(names)} of {len(study.cases)} cases {kind} and are left out: {listed(names)}"
        for kind, names in kinds.items()
        if names
    ]


def shorter(study: Any) -> list[str]:
    """Which runs ended well before others did: their numbers are of a shorter time."""
    time = numbers(study, ["summary:time"])["summary:time"].values
    last = max(t for t in time.values() if not np.isnan(t))
    groups: dict[tuple[float, str], list[str]] = {}
    for case in study.cases:
        if time[case.name] < last * (1.0 - 1e-9):
            groups.setdefault((time[case.name], case.status), []).append(case.name)
    return [
        f"{listed(names)}: {status} at {t:.6g} s, where others go on to {last:.6g} s: numbers are "
        "of that time"
        for (t, status), names in groups.items()
    ]


def without(study: Any, key: str) -> list[str]:
    """Which cases do not vary a key, and are left out of figures over it."""
    names = [case.name for case in study.cases if key not in case.values]
    return [f"{listed(names)}: without {key}, left out of figures over it"] if names else []


# --- swept keys ------------------------------------------------------------------------------


def varied(study: Any, key: str) -> list[float | str]:
    """The values of a key in the cases that vary it."""
    return [case.values[key] for case in study.cases if key in case.values]


def numeric(values: Iterable[float | str]) -> bool:
    """Whether all values are numbers, none a word."""
    return all(isinstance(value, float | int) for value in values)
