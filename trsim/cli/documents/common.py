"""What all documents have."""

from functools import cache
from typing import Any, get_args, get_origin, get_type_hints

from typing_extensions import TypedDict  # pydantic wants this one before Python 3.12

Number = float | None


@cache
def of(kind: type, *without: str) -> Any:
    """What a dataclass or a named tuple becomes: a typed dictionary, and that of what it holds.

    Its numbers may be null, tuples are lists, a complex number is the list of its two parts.
    """
    keys = {n: _json(t) for n, t in get_type_hints(kind).items() if n not in without}
    found = TypedDict(kind.__name__, keys)  # type: ignore[operator]
    found.__doc__ = kind.__doc__
    return found


def _json(kind: Any) -> Any:
    if kind in (float, complex):
        return Number if kind is float else list[Number]
    if getattr(kind, "__module__", "").startswith("trsim."):
        return of(kind)
    if get_origin(kind) is tuple:
        return list[_json(get_args(kind)[0])]
    if get_origin(kind) is dict:
        return dict[str, _json(get_args(kind)[1])]
    return kind


class Subject(TypedDict):
    """A mechanism, and what the assembly found out.

    title       of the scenario
    mobility    degrees of freedom by rank, drives counted as constraints
    not_unique  reactions that the motion does not determine
    """

    file: str
    title: str
    mobility: int
    redundant: list[str]
    not_unique: list[str]


class Result(Subject):
    """A run of it.

    warnings    what looks wrong: in the scenario, at the start, in the results
    fired       user event -> how often it happened
    """

    reason: str
    warnings: list[str]
    fired: dict[str, int]


class Error(TypedDict):
    """What is wrong.

    what       in a sentence
    hint       what to do about it, or ""
    path       of a key in the scenario, dotted as for --set; of the mapping that lacks a key or has
               an unknown one; "" where the error is not about a scenario
    file       it is about: of the scenario, or --set; a file that cannot be read or written; with
               an error of the solver the scenario; null of the command line
    line       in it, from 1; 0 in --set
    column     in it, from 1
    exit_code  of this error alone
    """

    what: str
    hint: str
    path: str
    file: str | None
    line: int | None
    column: int | None
    exit_code: int


class Document(TypedDict):
    """What every command tells.

    command    its name; null where the command line names none
    exit_code  that of the process: of the first error, or of the bug or signal that ended it
    errors     all that is wrong, none with exit code 0
    unlisted   how many more errors there are
    """

    command: str | None
    exit_code: int
    errors: list[Error]
    unlisted: int
