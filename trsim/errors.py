"""Errors a user can act on: where, what, and what to do next.

Every class has the exit code of the command line.  An error knows its `path` in the scenario
tree; whoever holds the tree adds the `place` in a file.
"""

import difflib
import os
import re
import stat
from collections.abc import Callable, Iterable
from functools import partial
from itertools import islice
from typing import Any, NamedTuple

WIDTH = 90  # columns of an excerpt
LISTED = 14  # words of a "Known:" list
LOOKED = 500  # files of a folder: among these one is looked for that was meant
# control characters but tab and end of line; ends of lines and directions of Unicode; half letters
OBEYED = re.compile(
    "[\0-\x08\x0b-\x1f\x7f-\x9f\u061c\u200e\u200f\u2028-\u202e\u2066-\u2069\ud800-\udfff]"
)


class Place(NamedTuple):
    """A place in a text.  Line and column count from 1; line 0: a text without lines."""

    file: str
    line: int
    column: int
    excerpt: str  # the whole line

    def show(self) -> str:
        return f"{self.file}:{self.line}:{self.column}" if self.line else self.file

    def caret(self) -> str:
        """The line and, under it, a caret at the column; a long line is cut around it."""
        start = max(0, self.column - 1 - WIDTH * 2 // 3) if len(self.excerpt) > WIDTH else 0
        shown = printable(self.excerpt[start : start + WIDTH].rstrip())
        return f"    {shown}\n    {' ' * (self.column - 1 - start)}^"


class TrsimError(Exception):
    """What is wrong, a hint what to do, and where; shown without a traceback."""

    exit_code: int = 1

    def __init__(
        self, what: str, hint: str = "", path: tuple = (), place: Place | None = None,
        file: str | None = None,
    ) -> None:  # fmt: skip
        """file: it is about, where there is no place."""
        super().__init__(what)
        self.what, self.hint, self.path, self.place = what, hint, tuple(path), place
        self.file = file

    @property
    def problems(self) -> tuple["TrsimError", ...]:
        return (self,)

    def at(self, *path: str | int) -> "TrsimError":
        """This error, with its path seen from further out."""
        return type(self)(self.what, self.hint, path + self.path, self.place, self.file)

    def show(self) -> str:
        """file:line:column: dotted.path: what, the line with a caret, the hint."""
        where = [self.place.show()] if self.place else []
        where += [".".join(printable(str(key), 60) for key in self.path)] if self.path else []
        # lines of a text from a file do not begin as ours do
        text = ": ".join([*where, self.what.replace("\n", "\n    ")])
        text += f"\n{self.place.caret()}" if self.place and self.place.excerpt.strip() else ""
        return text + (f"\n  {self.hint}" if self.hint else "")

    def __str__(self) -> str:
        return self.show()


class TrsimWarning(UserWarning):
    """What is worth knowing of a scenario or a result, told to Python as a warning."""


class UsageError(TrsimError):
    """The command line asks for something that makes no sense."""

    exit_code = 2


class ScenarioError(TrsimError, ValueError):
    """Something in a scenario file.  A ValueError, so that pydantic collects it."""

    exit_code = 3


class ModelError(TrsimError):
    """The scenario reads well, but the mechanism it describes cannot be solved."""

    exit_code = 4


class SolverError(TrsimError):
    """The solver could not go on; what it had is kept, for Python as `result`."""

    exit_code = 5
    result: Any = None


class CasesFailed(TrsimError):
    """Some cases of a sweep failed; the others, and what these left, are kept, for Python as
    `result`."""

    exit_code = 6
    result: Any = None


class FileError(TrsimError):
    """A file could not be read or written."""

    exit_code = 7


class Problems(TrsimError):
    """Several errors at once, each shown."""

    def __init__(self, problems: Iterable[TrsimError], unlisted: int = 0) -> None:
        self._problems = tuple(problems)
        self.unlisted = unlisted
        count = len(self._problems) + unlisted
        super().__init__(f"{count} problems")
        self.exit_code = self._problems[0].exit_code

    def __reduce__(self) -> tuple:
        return Problems, (self._problems, self.unlisted)

    @property
    def problems(self) -> tuple[TrsimError, ...]:
        return self._problems

    def at(self, *path: str | int) -> "Problems":
        return Problems([problem.at(*path) for problem in self._problems], self.unlisted)

    def show(self) -> str:
        more = [f"... and {self.unlisted} more problems"] if self.unlisted else []
        return "\n".join([problem.show() for problem in self._problems] + more)


def what_it_is(mode: int) -> str:
    """What a file is that is no regular one, by the mode the system tells."""
    kinds = {
        stat.S_IFDIR: "a folder",
        stat.S_IFIFO: "a FIFO",
        stat.S_IFSOCK: "a socket",
        stat.S_IFCHR: "a device",
        stat.S_IFBLK: "a device",
    }
    return kinds.get(stat.S_IFMT(mode), "something else")


def unreadable(path: str | os.PathLike) -> FileError | None:
    """Why a path cannot be read as a file: it is not there, or is a folder, a FIFO ..."""
    try:
        mode = os.stat(path).st_mode
    except FileNotFoundError:
        return FileError(f"{path}: no such file", meant(path), file=str(path))
    except (OSError, ValueError) as error:
        reason = getattr(error, "strerror", None) or error
        return FileError(f"{path}: {reason}", file=str(path))
    if stat.S_ISREG(mode):
        return None
    return FileError(f"{path} is {what_it_is(mode)}, not a file", file=str(path))


def meant(path: str | os.PathLike) -> str:
    """The hint for a file that is not there: one beside it with nearly its name."""
    folder, name = os.path.split(path)
    stem, ending = os.path.splitext(name)
    try:
        with os.scandir(folder or ".") as there:
            names = (os.path.splitext(one.name) for one in islice(there, LOOKED))
            stems = [other for other, same in names if same == ending]
    except (OSError, ValueError):
        return ""
    close = closest(stem, stems)
    return f"Did you mean {os.path.join(folder, close + ending)}?" if close else ""


def some(
    texts: Iterable[Any], most: int, more: str = " and {} more", between: str = ", "
) -> str:  # fmt: skip
    """The first of some texts, and how many more there are."""
    texts = list(texts)
    left = len(texts) - most
    return between.join(map(str, texts[:most])) + (more.format(left) if left > 0 else "")


listed = partial(some, most=LISTED, more=" ... ({} more)")


def known(word: object, words: Iterable[str], close: str | None = None) -> str:
    """The hint of every 'no such name' error; `close` is the guess, if there is a better one."""
    words = list(dict.fromkeys(words))
    if not words:
        return "None is known."
    close = close or closest(word, words)
    guess = f"Did you mean '{close}'?  " if close else ""
    return f"{guess}Known: {listed(words)}{'.' if len(words) <= LISTED else ''}"


def check_keys(given: Iterable[Any], words: Iterable[str], *path: str) -> None:
    """Raise ScenarioError for the first key of a mapping, which is at `path`, that nobody knows."""
    words = list(words)
    for key in given:
        if key not in words:
            raise ScenarioError(f"unknown key {described(key)}", known(key, words), (*path, key))


def closest(word: object, words: Iterable[str]) -> str | None:
    """The word that was probably meant: nearest by edits, then by likeness."""
    wrong, words = str(word)[:60], list(words)[:500]
    furthest = 1 if len(wrong) < 5 else 2
    distance = {right: edits(wrong.casefold(), right.casefold()) for right in words}
    near = [right for right in words if distance[right] <= min(furthest, len(right) - 1)]
    if near:
        return min(near, key=lambda right: (distance[right], -likeness(wrong, right)))
    return next(iter(difflib.get_close_matches(wrong, words[:100], n=1)), None)


def likeness(a: str, b: str) -> float:
    return difflib.SequenceMatcher(None, a, b).ratio()


def edits(a: str, b: str) -> int:
    """Letters to insert, delete, replace or swap to turn a into b; 3 when it is 3 or more."""
    if abs(len(a) - len(b)) > 2:
        return 3
    before, row = [], list(range(len(b) + 1))
    for i, x in enumerate(a):
        before, last, row = row, before, [i + 1]
        for j, y in enumerate(b):
            cost = before[j] if x == y else min(before[j], before[j + 1], row[j]) + 1
            if i and j and x == b[j - 1] and a[i - 1] == y:
                cost = min(cost, last[j - 1] + 1)
            row.append(cost)
        if min(row) > 2 and min(before) > 2:  # it only grows from here
            return 3
    return min(row[-1], 3)


def shown(text: str) -> str:
    """Text without what a terminal obeys, but ends of lines: colours, cursor, titles, direction."""
    return OBEYED.sub("?", text)


def one_line(text: str) -> str:
    """`shown` without ends of lines: nothing in it looks like a line of its own."""
    return shown(text).replace("\n", "?")


def printable(text: str, length: int = 1000) -> str:
    """Text that is safe on a terminal, cut at a length."""
    cut = text[: length - 3] + "..." if len(text) > length else text
    return "".join(c if c.isprintable() else " " if c == "\t" else "?" for c in cut)


def described(value: Any) -> str:
    """A value as it is called in messages."""
    if isinstance(value, str):
        return f"'{printable(value, 60)}'"
    if isinstance(value, dict):
        return "a mapping"
    if isinstance(value, list | tuple):
        return f"a list of {len(value)}"
    if value is None:
        return "nothing"
    return str(value).lower() if isinstance(value, bool) else repr(value)


def within(key: str | int, function: Callable[..., Any], *arguments: Any) -> Any:
    """Call, and tell in an error which entry it was about."""
    try:
        return function(*arguments)
    except ScenarioError as error:
        raise error.at(key) from None
