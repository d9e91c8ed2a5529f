"""docs/gallery.md, from the templates themselves."""

from pathlib import Path

from benchmarks.docs.made import MADE
from benchmarks.docs.marks import END, digest_of, marked, opening
from trsim.scenario.shipped import FOLDERS, TEMPLATES, Template, template

DOCS = Path(__file__).parents[2] / "docs"
PAGE, PICTURES = DOCS / "gallery.md", DOCS / "gallery"
TOP = """\
# Gallery

Each of these comes with trsim. `trsim init NAME` writes the file that is shown here into the
current folder, and prints what to type next. The first line of the file says what to expect, and
a test checks this by a closed form or by an independent integration. The picture shows the
mechanism as `trsim report --animate` draws it, with other moments in pale colours, and the first
plot of the file. `python -m benchmarks.gallery` renews the pictures and the page.

{contents}

{mark}
"""
ONE = """
## {name}

**{title}.** {about}

![{title}](gallery/{name}.png)

```sh
{commands}
```

{text}"""


def page(mark: str = "") -> str:
    """The whole page; mark: the marker of its pictures (benchmarks/docs), as of now if none."""
    mark = mark or opening("gallery", digest_of(MADE["gallery"]))
    every = [template(name) for name in TEMPLATES]
    contents = "\n".join(f"* [{one.name}](#{one.name}): {one.title}" for one in every)
    return TOP.format(contents=contents, mark=mark) + "".join(map(entry, every)) + f"\n{END}\n"


def marker() -> str:
    """The marker that stands on the page."""
    text = PAGE.read_text(encoding="utf-8")
    return text.splitlines()[marked(PAGE, text)[0].line - 1]


def entry(one: Template) -> str:
    """A template: what it is, its picture, its commands, its file."""
    step = [f"cd {one.name}"] if one.name in FOLDERS else []
    commands = "\n".join([f"trsim init {one.name}", *step, *one.commands])
    return ONE.format(name=one.name, title=one.title, about=sentence(one.about),
                      commands=commands, text=shown(one))  # fmt: skip


def sentence(text: str) -> str:
    return text[:1].upper() + text[1:].rstrip(",;:") + ("" if text.endswith(".") else " ...")


def shown(one: Template) -> str:
    """Its file; of a folder the one to begin with, and a list of the others."""
    block = f"```yaml file={one.first}\n{one.text.rstrip()}\n```\n"
    others = [file for file in one.files if file != one.first]
    if not others:
        return block
    told = ", ".join(f"`{file}`" for file in others)
    return f"{block}\nWith it {'come' if len(others) > 1 else 'comes'} {told}.\n"
