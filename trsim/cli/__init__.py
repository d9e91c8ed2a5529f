"""The command line: `trsim run`, `trsim report`, ...  One file per command, imported when used."""

import atexit
import gc
import os
import signal
import sys
from collections.abc import Sequence
from importlib import import_module
from typing import Any, NoReturn

import click

from trsim.cli.frame import EXIT_CODES, Answer, careful, emptied, opened, refused
from trsim.version import __version__

# imports make tens of thousands of objects that stay: collecting among them finds nothing
gc.set_threshold(50_000)
# nor does Python, which looks through all of them three times before a process ends
atexit.register(gc.freeze)
# numpy would start threads for matrices of a few dozen rows
os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")

# each a module of this package
COMMANDS = ("init", "run", "sweep", "status", "merge", "report", "check", "statics", "show",
            "export", "recover", "explain", "schema", "bench")  # fmt: skip
EPILOG = f"Exit codes: {', '.join(f'{code} {told}' for code, told in EXIT_CODES.items())}."


class Commands(click.Group):
    """The group of all commands."""

    def list_commands(self, ctx: click.Context) -> list[str]:
        return list(COMMANDS)

    def get_command(self, ctx: click.Context, cmd_name: str) -> click.Command | None:
        if cmd_name not in COMMANDS:
            return None
        command: click.Command = import_module(f"trsim.cli.{cmd_name}").command
        return command

    def resolve_command(self, ctx: click.Context, args: list[str]) -> Any:
        if args and args[0] not in COMMANDS:
            from trsim.errors import described, known

            ctx.fail(f"no command {described(args[0])}.  {known(args[0], COMMANDS)}")
        return super().resolve_command(ctx, args)


@click.group(cls=Commands, epilog=EPILOG, context_settings={"help_option_names": ["-h", "--help"]})
@click.version_option(__version__, message="trsim %(version)s")
def program() -> None:
    """Simulate mechanisms with clearance in their joints."""


def main(arguments: Sequence[str] | None = None) -> NoReturn:
    """Run a command line and exit."""
    opened()
    careful()
    given = list(sys.argv[1:] if arguments is None else arguments)
    named = given[0] if given and given[0] in COMMANDS else None
    answer = Answer(named, "--json" in given)  # where the command cannot give its own
    try:
        code = program.main(given, prog_name="trsim", standalone_mode=False)
    except click.ClickException as error:
        answer.refuse(error)
        code = answer.close()
    except click.Abort:
        answer.interrupted(signal.SIGINT)
        code = answer.close()
    except OSError as error:  # of --help and --version
        code = refused(error)
    emptied()
    sys.exit(code or 0)
