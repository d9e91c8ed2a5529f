"""python -m benchmarks.docs.reference: docs/reference.md, from the specs themselves."""

from collections.abc import Iterator
from typing import Any

from benchmarks.docs.made import MADE
from benchmarks.docs.marks import DOCS, END, digest_of, opening
from trsim.cli.explain import as_written
from trsim.scenario.explain import explained

PAGE = DOCS / "reference.md"
HEAD = """\
# Reference

Every section, every element, and every key of a scenario file, with its type, unit and default,
what it means, the equations of the element, and the channels it records. This page is printed from
the specs of the program by `python -m benchmarks.docs.reference`; `trsim explain WORD` prints the
part about one word. [scenarios.md](scenarios.md) explains how they work together.

In the tables, `*` marks a key that has to be given. A number may also be a text with a unit, or an
expression.
"""


def page(mark: str = "") -> str:
    """The whole page; mark: its marker, as of now if none."""
    every = explained()
    mark = mark or opening("reference", digest_of(MADE["reference"]))
    return "\n".join([HEAD, mark, "", *_body(every), "", END, ""])


def _body(every: dict[str, list[Any]]) -> Iterator[str]:
    sections = [one["word"] for one in every["sections"]]
    yield f"**Sections**: {', '.join(map(_linked, sections))}"
    for section in sections:
        kinds = [one["word"] for one in every["elements"] if one["section"] == section]
        if kinds:
            links = [_linked(kind, kind in sections) for kind in kinds]
            yield f"\n**In `{section}`**: {', '.join(links)}"
    yield "\n**And**: [functions](#functions), [units](#units)"
    yield "\n## Sections"
    for one in every["sections"]:
        yield from _entry(one, f"{one['type']}. {_sentence(one['about'])}")
    yield "\n## Elements"
    for one in every["elements"]:
        yield from _entry(one, f"In `{one['section']}`. {_sentence(one['about'])}")
        yield from _recorded(one)
    yield from ("\n## Functions", "\n| written | meaning |", "|---|---|")
    yield from (f"| `{one['written']}` | {_cell(one['meaning'])} |" for one in every["functions"])
    yield from ("\n## Units", "\n| unit | in SI | of |", "|---|---|---|")
    for one in every["units"]:
        size = f"{one['factor']:.9g} {_cell(one['unit'])}"
        yield f"| `{one['word']}` | {size} | {one['kind'] or ''} |"


def _entry(one: dict[str, Any], about: str) -> Iterator[str]:
    """A section or an element: what it is, its equations, its keys, an example."""
    yield from (f"\n### {one['word']}", f"\n{about}")
    if one["law"]:
        yield f"\n```text shown\n{one['law']}\n```"
    if one["keys"]:
        yield from ("\n| key | type | unit | default | meaning |", "|---|---|---|---|---|")
    for key in one["keys"]:
        name = key["place"].removeprefix(f"{one['word']}.")
        default = as_written(key["default"]) if key["default"] not in (None, "") else ""
        yield (
            f"| `{name}`{' *' * key['required']} | {_cell(key['type'])} | "
            f"{_cell(key['unit'] or '')} | {_cell(default)} | {_cell(key['meaning'])} |"
        )
    if one["example"]:
        yield f"\n```yaml scene\n{one['example']}\n```"


def _recorded(one: dict[str, Any]) -> Iterator[str]:
    if one["coordinates"]:
        yield f"\nCoordinate: {', '.join(f'`{name}`' for name in one['coordinates'])}."
    if one["channels"]:
        yield from ("\n| channel | unit | numbers | meaning |", "|---|---|---|---|")
    for channel in one["channels"]:
        yield (f"| `{channel['name']}` | {_cell(channel['unit'])} | {channel['size']} | "
               f"{_cell(channel['meaning'])} |")  # fmt: skip


def _sentence(text: str) -> str:
    return text[:1].upper() + text[1:] + ("" if text.endswith(".") else ".")


def _cell(text: str) -> str:
    """In a cell of a table, as it is."""
    words = " ".join(str(text).split()).replace("|", "\\|").replace("<", "&lt;")
    return words.replace("*", "\\*").replace("_", "\\_") if "`" not in words else words


def _linked(word: str, second: bool = False) -> str:
    """second: an element with the name of a section, whose heading comes later."""
    return f"[{word}](#{word}{'-1' * second})"


if __name__ == "__main__":
    PAGE.write_text(page(), encoding="utf-8", newline="\n")
    print(PAGE)
