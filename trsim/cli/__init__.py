"""The command line: `trsim run`, `trsim report`, ...  One file per command, imported when used.

Exit codes: 0 done, 1 bug in trsim, 2 usage, 3 scenario invalid, 4 model ill-posed, 5 solver failed,
6 some cases of a sweep failed, 7 file system, 130 and 143 interrupted.
"""

import sys
from collections.abc import Sequence
from importlib import import_module
from typing import Any, NoReturn

import click

from trsim.cli.frame import usage
from trsim.version import __version__

COMMANDS = ("run", "report", "check", "show", "export", "recover")  # each a module of this package


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


@click.group(cls=Commands, context_settings={"help_option_names": ["-h", "--help"]})
@click.version_option(__version__, message="trsim %(version)s")
def program() -> None:
    """Simulate mechanisms with clearance in their joints."""


def main(arguments: Sequence[str] | None = None) -> NoReturn:
    """Run a command line and exit."""
    given = list(sys.argv[1:] if arguments is None else arguments)
    try:
        code = program.main(given, prog_name="trsim", standalone_mode=False)
    except click.exceptions.NoArgsIsHelpError as error:
        click.echo(error.format_message(), err=True)
        code = 2
    except click.ClickException as error:
        code = usage(error, given)
    except click.Abort:
        code = 130
    sys.exit(code or 0)
