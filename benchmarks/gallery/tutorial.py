"""A page that one follows: its files are written, its commands typed, in their order.

```sh                  commands; `sh by-hand` are not typed, `sh fails=3` end with that code
```yaml file=NAME      a whole file
```yaml fragment=NAME before=KEY    lines that go into it, in front of one of its keys
```text                lines that were said by the commands before
"""

import re
import shlex
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import NamedTuple

BLOCK = re.compile(r"^```(\w+)([^\n]*)\n(.*?)^```", re.DOTALL | re.MULTILINE)
PICTURE = re.compile(r"!\[[^]]*\]\(([^)]+)\)")


class Step(NamedTuple):
    """A block of a page."""

    kind: str
    marks: dict[str, str]
    text: str


class Ended(NamedTuple):
    """A command, as typed, with what it has to end with, what it ended with, and what it said."""

    line: str
    wanted: int
    code: int
    said: str


def steps(page: str) -> Iterator[Step]:
    for kind, marks, text in BLOCK.findall(page):
        yield Step(kind, dict((mark + "=").split("=")[:2] for mark in marks.split()), text)


def follow(page: str, typed: Callable[[list[str]], tuple[int, str]]) -> Iterator[Ended | str]:
    """Do what a page says, in the current folder; what is said to be said and was not, as text.

    typed: runs the words behind `trsim`, and gives its exit code and all it said.
    """
    said = ""
    for step in steps(page):
        if step.kind == "sh" and "by-hand" not in step.marks:
            said = ""
            for line in step.text.splitlines():
                program, *words = shlex.split(line, comments=True)
                if program != "trsim":
                    raise ValueError(f"what is not trsim is done by hand: {line}")
                code, told = typed(words)
                said += told
                yield Ended(line, int(step.marks.get("fails", 0)), code, told)
        elif step.kind == "yaml":
            write(step)
        elif step.kind == "text":
            for line in step.text.splitlines():
                if line not in said:
                    yield line


def write(step: Step) -> None:
    """A file, or lines in one; what is only shown has no marks."""
    if not step.marks:
        return
    if "file" in step.marks:
        Path(step.marks["file"]).write_text(step.text, encoding="utf-8")
        return
    path, key = Path(step.marks["fragment"]), f"\n{step.marks['before']}:"
    whole = path.read_text(encoding="utf-8")
    if whole.count(key) != 1:
        raise ValueError(f"{path} has not one key {key.strip()}")
    path.write_text(whole.replace(key, f"\n{step.text.rstrip()}{key}"), encoding="utf-8")


def pictures(page: str, folder: str) -> list[str]:
    """The names of the pictures of a page that lie in a folder."""
    return [
        found.split("/")[-1] for found in PICTURE.findall(page) if found.startswith(f"{folder}/")
    ]
