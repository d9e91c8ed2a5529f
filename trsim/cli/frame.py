"""What all commands share: messages on stderr, one JSON document on stdout, exit codes."""

import functools
import json
import math
import os
import signal
import sys
from collections.abc import Callable
from typing import Any, NoReturn

import click

from trsim.errors import TrsimError

INTERRUPTED = {signal.SIGINT: 130, signal.SIGTERM: 143}


class Stopped(KeyboardInterrupt):
    """A signal asks the command to end."""

    def __init__(self, number: int) -> None:
        super().__init__(number)
        self.number = number


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
        for number in INTERRUPTED:
            signal.signal(number, _stop)
        try:
            function(answer, **options)
        except TrsimError as error:
            answer.fail(error)
        except KeyboardInterrupt as error:
            number = getattr(error, "number", signal.SIGINT)
            click.echo("interrupted", err=True)
            answer.exit_code = INTERRUPTED[number]
        except BrokenPipeError:
            os.dup2(os.open(os.devnull, os.O_WRONLY), sys.stdout.fileno())
            return 0
        except Exception as error:
            if os.environ.get("TRSIM_DEBUG"):
                raise
            answer.broken(error)
        return answer.close()

    options = [
        click.option("--json", "as_json", is_flag=True, help="One JSON document on stdout."),
        click.option("-q", "--quiet", is_flag=True, help="No messages but errors."),
    ]
    return functools.reduce(lambda inner, option: option(inner), options, command)


def _stop(number: int, _: Any) -> NoReturn:
    for each in INTERRUPTED:  # the second one ends the process at once
        signal.signal(each, signal.SIG_DFL)
    raise Stopped(number)


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
