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

from trsim.errors import FileError, TrsimError

INTERRUPTED: dict[int, int] = {signal.SIGINT: 130, signal.SIGTERM: 143}


class Stop:
    """What a signal asked for.  Compiled code must not be broken off by an exception of ours: while
    `patient`, whoever can stop safely looks here."""

    number: int | None = None
    patient = False


class Answer:
    """What a command has to tell, collected while it works."""

    def __init__(self, command: str, as_json: bool, quiet: bool) -> None:
        self.as_json, self.quiet = as_json, quiet
        self.exit_code = 0
        self.data: dict[str, Any] = {"command": command, "exit_code": 0, "errors": []}

    def say(self, text: str) -> None:
        """A message."""
        if not self.quiet:
            click.echo(text, err=True)

    def put(self, text: str) -> None:
        """Data, for a reader; with --json it is in the document instead."""
        if not self.as_json:
            click.echo(text)

    def fail(self, error: TrsimError, text: str = "") -> None:
        """Tell an error.  The exit code is that of the first one."""
        click.echo(text or f"error: {error.show()}", err=True)
        self.exit_code = self.exit_code or error.exit_code
        self.data["errors"] += [told(problem) for problem in error.problems]

    def broken(self, error: Exception) -> None:
        """Tell a bug."""
        kind = f"{type(error).__name__}: {error}".splitlines()[0]
        hint = "This is a bug in trsim: please report it.  TRSIM_DEBUG=1 shows the traceback."
        click.echo(f"internal error: {kind}\n  {hint}", err=True)
        self.exit_code = 1
        self.data["errors"].append({"what": kind, "hint": hint, "exit_code": 1})

    def interrupted(self) -> None:
        """Tell that a signal ended the command."""
        click.echo("interrupted", err=True)
        self.exit_code = INTERRUPTED.get(Stop.number or signal.SIGINT, 130)

    def close(self) -> int:
        """Print the document; the exit code."""
        self.data["exit_code"] = self.exit_code
        if self.as_json:
            click.echo(json.dumps(plain(self.data), indent=1, ensure_ascii=False))
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
            answer.interrupted()
        except BrokenPipeError:
            os.dup2(os.open(os.devnull, os.O_WRONLY), sys.stdout.fileno())
            return 0
        except OSError as error:  # of a file that is none of ours: kernels being compiled, for one
            what = f"{error.filename or 'file system'}: {error.strerror or error}"
            answer.fail(FileError(what))
        except Exception as error:
            if Stop.number:  # numba's own way of telling that an exception passed through
                answer.interrupted()
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


def told(error: TrsimError) -> dict[str, Any]:
    """An error as data."""
    place = error.place
    return {
        "what": error.what,
        "hint": error.hint,
        "path": ".".join(map(str, error.path)),
        "file": place.file if place else None,
        "line": place.line if place else None,
        "column": place.column if place else None,
        "exit_code": error.exit_code,
    }


def usage(error: click.ClickException, given: list[str]) -> int:
    """Tell a wrong command line."""
    error.show(sys.stderr)
    if "--json" in given:
        told = {"what": error.format_message(), "hint": "", "exit_code": error.exit_code}
        document = {"command": given[0], "exit_code": error.exit_code, "errors": [told]}
        click.echo(json.dumps(document, indent=1, ensure_ascii=False))
    return error.exit_code


def plain(value: Any) -> Any:
    """Data as JSON knows it: a number that is not finite becomes null."""
    if isinstance(value, dict):
        return {str(key): plain(inner) for key, inner in value.items()}
    if isinstance(value, list | tuple):
        return [plain(inner) for inner in value]
    if hasattr(value, "item"):
        value = value.item()
    return None if isinstance(value, float) and not math.isfinite(value) else value
