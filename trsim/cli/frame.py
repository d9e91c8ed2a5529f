"""What all commands share: messages on stderr, one JSON document on stdout, exit codes."""

import functools
import json
import math
import os
import signal
import sys
import threading
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from typing import Any

import click

from trsim.errors import FileError, Place, TrsimError

EXIT_CODES = {  # 6 is kept for sweeps of which some cases failed
    0: "done",
    1: "bug in trsim",
    2: "usage",
    3: "scenario invalid",
    4: "model ill-posed",
    5: "solver failed",
    7: "file system",
    130: "interrupted by SIGINT",
    143: "interrupted by SIGTERM",
}
INTERRUPTED: dict[int, int] = {signal.SIGINT: 130, signal.SIGTERM: 143}


class Stop:
    """What a signal asked for.  Compiled code must not be broken off by an exception of ours: while
    `patient`, whoever can stop safely looks here."""

    number: int | None = None
    patient = False


class Answer:
    """What a command has to tell, collected while it works; documents/ says what that may be."""

    def __init__(self, command: str | None, as_json: bool, quiet: bool = False) -> None:
        self.as_json, self.quiet = as_json, quiet
        self.exit_code = 0
        self.warned: set[str] = set()
        self.data: dict[str, Any] = {
            "command": command,
            "exit_code": 0,
            "errors": [],
            "unlisted": 0,
        }

    def say(self, text: str) -> None:
        """A message."""
        if not self.quiet:
            click.echo(text, err=True)

    def warn(self, about: str, text: str) -> None:
        """A warning; one that was said is not said again."""
        message = f"{about}: warning: {text}"
        if message not in self.warned:
            self.say(message)
        self.warned.add(message)

    def put(self, text: str) -> None:
        """Data, for a reader; with --json it is in the document instead."""
        if not self.as_json:
            click.echo(text)

    def fail(self, error: TrsimError, text: str = "") -> None:
        """Tell an error.  The exit code is that of the first one."""
        click.echo(text or f"error: {error.show()}", err=True)
        self.exit_code = self.exit_code or error.exit_code
        self.data["unlisted"] += getattr(error, "unlisted", 0)
        for one in error.problems:
            self.entry(one.what, one.hint, one.exit_code, one.path, one.place)

    def broken(self, error: Exception) -> None:
        """Tell a bug."""
        kind = f"{type(error).__name__}: {error}".splitlines()[0]
        hint = "This is a bug in trsim: please report it.  TRSIM_DEBUG=1 shows the traceback."
        click.echo(f"internal error: {kind}\n  {hint}", err=True)
        self.exit_code = 1
        self.entry(kind, hint, 1)

    def interrupted(self, number: int | None) -> None:
        """Tell that a signal ended the command."""
        click.echo("interrupted", err=True)
        self.exit_code = INTERRUPTED[number or signal.SIGINT]
        self.entry(EXIT_CODES[self.exit_code], "", self.exit_code)

    def refuse(self, error: click.ClickException) -> None:
        """Tell what is wrong with the command line."""
        error.show(sys.stderr)
        self.exit_code = error.exit_code
        self.entry(error.format_message(), "", error.exit_code)

    def entry(
        self, what: str, hint: str, code: int, path: tuple = (), place: Place | None = None
    ) -> None:
        """Add an error to the document."""
        told = {"what": what, "hint": hint, "path": ".".join(map(str, path)), "exit_code": code}
        for name in ("file", "line", "column"):
            told[name] = getattr(place, name, None)
        self.data["errors"].append(told)

    def close(self) -> int:
        """Print the document; the exit code."""
        self.data["exit_code"] = self.exit_code
        try:
            if self.as_json:
                click.echo(json.dumps(plain(self.data), indent=1))
            sys.stdout.flush()
        except OSError as error:
            unheard()
            if not isinstance(error, BrokenPipeError):
                click.echo(f"error: standard output: {error.strerror or error}", err=True)
                return self.exit_code or FileError.exit_code
        return self.exit_code


def framed(function: Callable[..., None]) -> Callable[..., int]:
    """Turns function(answer, **options) into a command that never ends in a traceback."""

    @functools.wraps(function)
    def command(as_json: bool = False, quiet: bool = False, **options: Any) -> int:
        answer = Answer(function.__module__.rsplit(".", 1)[-1], as_json, quiet)
        try:
            with listening():
                function(answer, **options)
        except TrsimError as error:
            answer.fail(error)
        except KeyboardInterrupt:
            answer.interrupted(Stop.number)
        except BrokenPipeError:
            unheard()
            return answer.exit_code
        except OSError as error:  # of a file that is none of ours: kernels being compiled, for one
            what = f"{error.filename or 'file system'}: {error.strerror or error}"
            answer.fail(FileError(what))
        except Exception as error:
            if Stop.number:  # numba's own way of telling that an exception passed through
                answer.interrupted(Stop.number)
            elif os.environ.get("TRSIM_DEBUG"):
                raise
            else:
                answer.broken(error)
        return answer.close()

    options = [
        click.option("--json", "as_json", is_flag=True, help="One JSON document on stdout."),
        click.option("-q", "--quiet", is_flag=True, help="No messages but errors."),
    ]
    return functools.reduce(lambda inner, option: option(inner), options, command)


@contextmanager
def listening() -> Iterator[None]:
    """Signals are told to Stop; afterwards everything is as it was."""
    Stop.number, Stop.patient = None, False
    if threading.current_thread() is not threading.main_thread():
        yield
        return
    before = {number: signal.signal(number, _stop) for number in INTERRUPTED}
    try:
        yield
    finally:
        for number, handler in before.items():
            signal.signal(number, handler)


def _stop(number: int, _: Any) -> None:
    for each in INTERRUPTED:  # the second one ends the process at once
        signal.signal(each, signal.SIG_DFL)
    Stop.number = number
    if not Stop.patient:
        raise KeyboardInterrupt


def unheard() -> None:
    """Nobody reads standard output any more: what is still to be said goes to nowhere."""
    os.dup2(os.open(os.devnull, os.O_WRONLY), sys.stdout.fileno())


def plain(value: Any) -> Any:
    """Data as JSON knows it: a number that is not finite becomes null."""
    if isinstance(value, dict):
        return {str(key): plain(inner) for key, inner in value.items()}
    if isinstance(value, list | tuple):
        return [plain(inner) for inner in value]
    if hasattr(value, "item"):
        value = value.item()
    return None if isinstance(value, float) and not math.isfinite(value) else value
