"""trsim schema: the JSON Schema of scenario files, and of the documents of `--json`."""

import json
from pathlib import Path

import click

from trsim.cli.frame import NAMED, Answer, framed
from trsim.errors import UsageError, known


@click.command("schema")
@click.argument("what", default="scenario")
@click.option("-o", "--output", type=NAMED, help="File of the schema.")
@framed
def command(answer: Answer, what: str, output: str | None) -> None:
    """Print the JSON Schema of WHAT.

    That is scenario (files; the default), or a command, for the document its --json prints, or
    trsim, for that of a command line that names no command.
    """
    from trsim.cli.published import WORDS, published

    if what not in WORDS:
        raise UsageError(f"there is no schema of '{what}'", known(what, WORDS))
    found = published(what)
    answer.data |= {"what": what, "schema": found, "file": None, "modeline": None}
    text = json.dumps(found, indent=1)
    if output is None:
        answer.put(text, lines=True)
        return
    write(Path(output), text)
    answer.data |= {"schema": None, "file": output}
    answer.put(output)
    if what == "scenario":
        answer.data["modeline"] = modeline(output)
        answer.say(
            "An editor with a YAML language server checks a scenario file in this folder that "
            f"begins with the line\n{modeline(output)}"
        )


def modeline(file: str) -> str:
    """The line that names a schema file to an editor."""
    return f"# yaml-language-server: $schema={file}"


def write(target: Path, text: str) -> None:
    """Write a schema, over nothing but an older one."""
    from trsim.store.target import SCHEMA, file_errors, fresh

    with file_errors(target), fresh(target, SCHEMA) as unfinished:
        unfinished.write_text(text + "\n", encoding="utf-8", newline="\n")
