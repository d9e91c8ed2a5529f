"""trsim init: write a scenario to begin with."""

import os
from pathlib import Path
from typing import TYPE_CHECKING

import click

from trsim.cli.frame import NAMED, Answer, framed
from trsim.errors import UsageError, closest, described

if TYPE_CHECKING:
    from trsim.scenario.shipped import Template

DEFAULT = "pendulum"
FILES = (".yaml", ".yml")


def names(_context: click.Context, _parameter: click.Parameter, begun: str) -> list[str]:
    """The templates whose names begin so, for a shell that completes them."""
    from trsim.scenario.shipped import TEMPLATES

    return [name for name in TEMPLATES if name.startswith(begun)]


@click.command("init")
@click.argument("name", required=False, type=NAMED, shell_complete=names)
@click.option(
    "--template", "word", metavar="NAME", shell_complete=names, help="Which one: see --list."
)
@click.option("--list", "listed", is_flag=True, help="Say which templates there are.")
@click.option("--force", is_flag=True, help="Write over files that are there.")
@framed
def command(answer: Answer, name: str | None, word: str | None, listed: bool, force: bool) -> None:
    """Write a commented scenario to begin with, into the current folder or a folder NAME.

    NAME may also be that of a template, or a file: `trsim init four-bar`,
    `trsim init crane.yaml`, `trsim init mine.yaml --template four-bar`.  Without NAME
    and --template the templates are listed.
    """
    from trsim.scenario.shipped import template

    answer.data |= {"template": None, "title": None, "about": None, "files": [], "commands": []}
    answer.data["templates"] = []
    if listed or (name is None and word is None):
        if name is not None or word is not None:
            raise UsageError("--list writes nothing", "Leave out the name, or --list.")
        listing(answer)
        return
    word, name = asked(name, word)
    found = template(word)
    folder, found = placed(found, name)
    targets = [folder / file for file in found.files]
    write(targets, found, force)
    answer.data |= {"template": found.name, "title": found.title, "about": found.about,
                    "files": list(map(str, targets)), "commands": found.commands}  # fmt: skip
    for target in targets:
        answer.put(str(target))
    answer.say(f"{found.title}: {found.about}")
    answer.say("Try:")
    for line in [f"cd {folder}"] * (folder != Path()) + found.commands:
        answer.say(f"  {line}")


def listing(answer: Answer) -> None:
    """All templates, one a line."""
    from trsim.scenario.shipped import TEMPLATES, template

    wide = max(map(len, TEMPLATES)) + 2
    for found in map(template, TEMPLATES):
        row = {"name": found.name, "title": found.title, "about": found.about,
               "files": list(found.files)}  # fmt: skip
        answer.data["templates"].append(row)
        answer.put(f"{found.name:{wide}}{found.title}")
    answer.say(f"`trsim init {DEFAULT}` writes the first of them.")


def asked(name: str | None, word: str | None) -> tuple[str, str | None]:
    """Which template, and where to: a name may be that of either."""
    from trsim.scenario.shipped import TEMPLATES, named

    if word is not None or name is None:
        return word or "", name
    path = Path(name)
    last = path.stem if path.suffix in FILES else path.name
    if named(last):
        return last, None if name == last else name
    if close := closest(last, TEMPLATES):
        what = f"no template is named {described(last)}"
        hint = f"Did you mean '{close}'?  For something of that name give --template as well."
        raise UsageError(what, hint)
    return DEFAULT, name


def placed(found: "Template", name: str | None) -> tuple[Path, "Template"]:
    """The folder to write into, and what is written there."""
    from trsim.scenario.shipped import FOLDERS

    if name is None:
        return Path(found.name if found.name in FOLDERS else ""), found
    target = Path(name)
    if target.suffix not in FILES:
        return target, found
    if len(found.files) > 1:
        what = f"the template {found.name} has several files, {name} is one"
        raise UsageError(what, "Name a folder.")
    return target.parent, found.called(target.name)


def write(targets: list[Path], found: "Template", force: bool) -> None:
    """Write all files or, where one is there already, none."""
    from trsim.store.target import Kind, file_errors, fresh

    if taken := [str(target) for target in targets if os.path.lexists(target) and not force]:
        told = ", ".join(taken[:5]) + (f" and {len(taken) - 5} more" if len(taken) > 5 else "")
        raise UsageError(
            f"{told} exist{'s' if len(taken) == 1 else ''} already: nothing was written",
            "Name another folder, or write over them with --force.",
        )
    anything = Kind("file", lambda _: True)
    for target, data in zip(targets, found.files.values(), strict=True):
        with file_errors(target), fresh(target, anything) as unfinished:
            unfinished.write_bytes(data)
