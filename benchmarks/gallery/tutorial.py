"""A page that one follows: its files are written, its commands typed, in their order.

```sh                  commands; `sh by-hand` are not typed, `sh fails=3` end with that code, and of
                       `sh end=1ms` runs are cut there; of `sh says` a comment is what is said,
                       with ... for some of it
```yaml file=NAME      a whole file
```yaml fragment=NAME before=KEY    lines that go into it, in front of one of its keys
```yaml scene          a whole scenario, which is checked
```yaml extends=NAME   what is added to a scenario of docs/scenes, which is checked then; with
                       `run`, it is run as well, with `end=1ms` until then, and with `cases` its
                       sweep or its cases are
```python              run as it stands
```text                lines that were said by the commands before
```KIND shown          what is only looked at
"""

import re
import shlex
import shutil
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import NamedTuple

SCENES = Path(__file__).parents[2] / "docs" / "scenes"
ENDS = ("run", "sweep", "bench")  # commands whose runs can be cut
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
        if "shown" in step.marks:
            continue
        if step.kind == "sh" and "by-hand" not in step.marks:
            said = ""
            for line in step.text.splitlines():
                words = worded(line, step.marks.get("end"))
                code, told = typed(words)
                said += told
                yield Ended(line, int(step.marks.get("fails", 0)), code, told)
                first, _, last = line.partition("#")[2].strip().partition("...")
                if "says" in step.marks and not (
                    told.strip().startswith(first) and told.strip().endswith(last)
                ):
                    yield f"{line}: said {told.strip()}"
        elif step.kind == "python":
            exec(step.text, {})  # noqa: S102
        elif step.kind == "yaml" and step.marks.keys() & {"scene", "extends"}:
            for words in added(step):
                yield Ended(f"{' '.join(words)} of\n{step.text}", 0, *typed(words))
        elif step.kind in ("yaml", "csv"):
            write(step)
        elif step.kind == "text":
            for line in step.text.splitlines():
                if line not in said:
                    yield line


def worded(line: str, end: str | None) -> list[str]:
    """The words behind `trsim`; end: of the runs."""
    program, *words = shlex.split(line, comments=True)
    if program != "trsim":
        raise ValueError(f"what is not trsim is done by hand: {line}")
    return [*words, "--set", f"solver.end={end}"] if end and words[0] in ENDS else words


def added(step: Step) -> Iterator[list[str]]:
    """Write a scenario, or what is added to one; what is to be typed then."""
    text, name = step.text, "added.yaml"
    if base := step.marks.get("extends"):
        if SCENES.exists():
            shutil.copytree(SCENES, ".", dirs_exist_ok=True)
        text = f"extends: {base}\n{text}"
    Path(name).write_text(text, encoding="utf-8", newline="\n")
    yield ["check", name]
    if "cases" in step.marks:
        yield ["sweep", name, "--dry-run", "-o", "added"]
    if "run" in step.marks or "end" in step.marks:
        yield worded(f"trsim run {name} -o added.h5", step.marks.get("end"))


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
