"""trsim schema: the JSON Schema of scenario files, and of the documents of `--json`."""

import json
from pathlib import Path

import click

from trsim.cli.frame import Answer, framed
from trsim.errors import FileError, UsageError, known

TITLE = "trsim "  # of every schema


@click.command("schema")
@click.argument("what", default="scenario")
@click.option("-o", "--output", type=click.Path(), help="File of the schema.")
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
        answer.put(text)
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
    try:
        if target.exists() and not is_schema(target.read_bytes()):
            raise UsageError(f"{target} exists and is not a schema of trsim", "Name another file.")
        target.parent.mkdir(parents=True, exist_ok=True)
        target.write_text(text + "\n", encoding="utf-8")
    except OSError as error:
        raise FileError(f"{target}: {error.strerror or error}") from None


def is_schema(content: bytes) -> bool:
    """Whether it is empty or a schema of ours."""
    try:
        found = json.loads(content or b'{"title": "trsim "}')
    except ValueError:
        return False
    return isinstance(found, dict) and str(found.get("title", "")).startswith(TITLE)
