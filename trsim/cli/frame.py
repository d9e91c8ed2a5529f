"""What all commands share: messages on stderr, one JSON document on stdout, exit codes."""

import functools
import io
import json
import math
import os
import shlex
import signal
import sys
import warnings
from collections.abc import Callable
from contextlib import AbstractContextManager, suppress
from pathlib import Path
from typing import IO, Any

import click

from trsim.api.hearing import Cases, Listener, Meter
from trsim.api.stop import INTERRUPTED, Stop, listening
from trsim.errors import FileError, Place, TrsimError, UsageError, one_line, shown

EXIT_CODES = {
    0: "done",
    1: "bug in trsim",
    2: "usage",
    3: "scenario invalid",
    4: "model ill-posed",
    5: "solver failed",
    6: "some cases of a sweep failed",
    7: "file system",
    130: "interrupted by SIGINT",
    143: "interrupted by SIGTERM",
}
WORKED_ON = ("scenario", "run", "part")  # arguments that are one file
READ = (
    *WORKED_ON,
    "runs",
    "scenarios",
    "folder",
    "folders",
)  # that may be result files, or hold some


class Answer(Listener):
    """What a command has to tell, collected while it works; documents/ says what that may be."""

    def __init__(self, command: str | None, as_json: bool, quiet: bool = False) -> None:
        super().__init__()
        self.as_json, self.quiet = as_json, quiet
        self.exit_code = 0
        self.data: dict[str, Any] = {
            "command": command,
            "exit_code": 0,
            "errors": [],
            "unlisted": 0,
        }

    def say(self, text: str) -> None:
        """A message, a line."""
        if not self.quiet:
            tell(one_line(text))

    def warn(self, about: str, text: str) -> None:
        """A warning; one that was said is not said again."""
        message = f"{about}: warning: {text}"
        if message not in self.warned:
            self.say(message)
        self.warned.add(message)

    def lost(self, error: TrsimError) -> None:
        """What is not to be had; the rest is done all the same."""
        self.fail(error)

    @property
    def command(self) -> str:  # type: ignore[override]
        """The command line."""
        return shlex.join(["trsim", *sys.argv[1:]])

    @property
    def again(self) -> str:  # type: ignore[override]
        """The command line that goes on with a run."""
        return self.command if "--resume" in sys.argv else f"{self.command} --resume"

    def doing(self, name: str) -> AbstractContextManager[Callable[[str], None]]:
        from trsim.cli import progress

        return progress.Doing(self, name)

    def meter(self, name: str, total: float) -> Meter:
        from trsim.cli import progress

        return progress.Meter(self, name, total)

    def cases(self, name: str, total: int) -> Cases:
        from trsim.cli import progress

        return progress.Cases(self, name, total)

    def put(self, text: str, lines: bool = False) -> None:
        """Data, for a reader, in a line or several; with --json it is in the document instead."""
        if self.as_json:
            return
        try:
            click.echo(shown(text) if lines else one_line(text))
        except BrokenPipeError:
            raise
        except OSError as error:
            unheard(sys.stdout)
            raise FileError(f"standard output: {error.strerror or error}") from None

    def fail(self, error: TrsimError, about: str | None = None) -> None:
        """Tell an error.  The exit code is that of the first one; about: the file at work."""
        tell(f"error: {error.show()}")
        self.exit_code = self.exit_code or error.exit_code
        self.data["unlisted"] += getattr(error, "unlisted", 0)
        for one in error.problems:
            file = one.file if one.file or isinstance(one, UsageError) else about
            self.entry(one.what, one.hint, one.exit_code, one.path, one.place, file)

    def broken(self, error: Exception) -> None:
        """Tell a bug."""
        kind = f"{type(error).__name__}: {error}".splitlines()[0]
        hint = "This is a bug in trsim: please report it.  TRSIM_DEBUG=1 shows the traceback."
        tell(f"internal error: {kind}\n  {hint}")
        self.exit_code = 1
        self.entry(kind, hint, 1)

    def interrupted(self, number: int | None, left: str = "") -> None:
        """Tell that a signal ended the command, and what it left."""
        tell(f"interrupted: {left}" if left else "interrupted")
        self.exit_code = INTERRUPTED[number or signal.SIGINT]
        self.entry(EXIT_CODES[self.exit_code], left, self.exit_code)

    def refuse(self, error: click.ClickException) -> None:
        """Tell what is wrong with the command line."""
        told = io.StringIO()
        error.show(told)
        tell(told.getvalue().removesuffix("\n"))
        self.exit_code = error.exit_code
        self.entry(error.format_message(), "", error.exit_code)

    def entry(
        self, what: str, hint: str, code: int, path: tuple = (), place: Place | None = None,
        file: str | None = None,
    ) -> None:  # fmt: skip
        """Add an error to the document."""
        told = {"what": what, "hint": hint, "path": ".".join(map(str, path)), "exit_code": code}
        for name in ("file", "line", "column"):
            told[name] = getattr(place, name, None)
        told["file"] = told["file"] or file
        self.data["errors"].append(told)

    def close(self) -> int:
        """Print the document; the exit code."""
        self.data["exit_code"] = self.exit_code
        try:
            if self.as_json:
                # the one control character that JSON leaves as it is
                click.echo(json.dumps(plain(self.data), indent=1).replace("\x7f", "\\u007f"))
            sys.stdout.flush()
        except OSError as error:
            code = refused(error)
            return self.exit_code or code
        return self.exit_code


class Named(click.Path):
    """A name of a file or folder to write; a shell variable that is not set gives none."""

    def convert(self, value: Any, param: Any, ctx: Any) -> Any:
        if not value:
            self.fail("the name of the output is empty", param, ctx)
        return super().convert(value, param, ctx)


NAMED = Named()


def framed(function: Callable[..., None]) -> Callable[..., int]:
    """Turns function(answer, **options) into a command that never ends in a traceback."""

    @functools.wraps(function)
    def command(as_json: bool = False, quiet: bool = False, **options: Any) -> int:
        answer = Answer(function.__module__.rsplit(".", 1)[-1], as_json, quiet)
        about = next((options[key] for key in WORKED_ON if options.get(key)), None)
        try:
            with listening():
                function(answer, **options)
        except TrsimError as error:
            answer.fail(error, about)
        except KeyboardInterrupt as stop:
            answer.interrupted(Stop.number, str(stop))
        except BrokenPipeError:
            unheard(sys.stdout)
            return answer.exit_code
        except OSError as error:  # of a file that is none of ours: kernels being compiled, for one
            what = f"{error.filename or 'file system'}: {error.strerror or error}"
            answer.fail(FileError(what, file=error.filename and os.fspath(error.filename)))
        except Exception as error:
            if Stop.number:  # numba's own way of telling that an exception passed through
                answer.interrupted(Stop.number)
            elif os.environ.get("TRSIM_DEBUG"):
                raise
            elif blamed := at_fault(options):
                answer.fail(blamed)
            else:
                answer.broken(error)
        return answer.close()

    options = [
        click.option("--json", "as_json", is_flag=True, help="One JSON document on stdout."),
        click.option("-q", "--quiet", is_flag=True, help="No messages but errors."),
    ]
    return functools.reduce(lambda inner, option: option(inner), options, command)


def at_fault(options: dict[str, Any]) -> TrsimError | None:
    """What is wrong with a result file that was read, where something unexpected happened."""
    from trsim.api.source import is_result
    from trsim.store.suspect import blamed

    given = [options[key] for key in READ if options.get(key)]
    names = [name for one in given for name in ([one] if isinstance(one, str) else one)]
    for name in names:
        cases = sorted(Path(name).glob("cases/*.h5")) if os.path.isdir(name) else [Path(name)]
        for path in cases:
            with suppress(Exception):
                if is_result(str(path)) and (found := blamed(path)):
                    return found
    return None


def tell(text: str) -> None:
    """A line on standard error; where that cannot be written to, nobody is left to be told."""
    with suppress(OSError):
        click.echo(shown(text), err=True)


def careful() -> None:
    """Warnings of Python, which may hold texts of files, as our own messages are."""
    formatted = warnings.formatwarning
    if formatted.__module__ == "warnings":
        warnings.formatwarning = lambda *told, **named: shown(formatted(*told, **named))


def unheard(stream: IO[str]) -> None:
    """Nobody reads a stream any more: what is still to be said there goes to nowhere."""
    os.dup2(os.open(os.devnull, os.O_WRONLY), stream.fileno())


def refused(error: OSError) -> int:
    """The exit code where standard output cannot be written to; 0 where nobody reads it."""
    unheard(sys.stdout)
    if isinstance(error, BrokenPipeError):
        return 0
    tell(f"error: standard output: {error.strerror or error}")
    return FileError.exit_code


def emptied() -> None:
    """Write what standard error still holds.  What it refuses Python would try again at its end,
    and end with a code of its own."""
    try:
        sys.stderr.flush()
    except OSError:
        unheard(sys.stderr)


def opened() -> None:
    """Give a standard stream that was closed to nowhere: its number must not become a file's."""
    while (handle := os.open(os.devnull, os.O_RDWR)) <= 2:
        pass
    os.close(handle)
    for name in ("stdin", "stdout", "stderr"):
        if getattr(sys, name) is None:
            mode = "r" if name == "stdin" else "w"
            setattr(sys, name, open(os.devnull, mode, encoding="utf-8"))  # noqa: SIM115


def plain(value: Any) -> Any:
    """Data as JSON knows it: a number that is not finite becomes null."""
    if isinstance(value, dict):
        return {str(key): plain(inner) for key, inner in value.items()}
    if isinstance(value, list | tuple):
        return [plain(inner) for inner in value]
    if hasattr(value, "item"):
        value = value.item()
    return None if isinstance(value, float) and not math.isfinite(value) else value
