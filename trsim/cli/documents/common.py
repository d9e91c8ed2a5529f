"""What all documents have."""

from typing_extensions import TypedDict  # pydantic wants this one before Python 3.12

Number = float | None


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
