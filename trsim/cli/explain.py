"""trsim explain: what an element, a section or a key of a scenario file is."""

import textwrap
from collections.abc import Iterator
from typing import Any

import click

from trsim.cli.frame import Answer, framed

WIDTH = 96
INDENT = 4


@click.command("explain")
@click.argument("word", required=False)
@framed
def command(answer: Answer, word: str | None) -> None:
    """Say what WORD is: an element, a section, a key or a function of a scenario file, what a key
    may be, what is recorded, a unit, or a topic such as friction.

    Without WORD, list all there are.  A key may be named by its place: limit_stop.wall.normal.
    """
    from trsim.scenario.explain import explained

    found = explained(word)
    answer.data |= {"word": word, **found}
    for text in lines(found) if word else listed(found):
        answer.put(text, lines=True)


def listed(found: dict[str, list[Any]]) -> Iterator[str]:
    """All words, by what they are."""
    names = {kind: [page["word"] for page in found[kind]] for kind in ("elements", "sections")}
    names["keys"] = sorted({key["place"].rpartition(".")[2] for key in found["keys"]})
    names["functions and keys of tables"] = [page["word"] for page in found["functions"]]
    names["units"] = [page["word"] for page in found["units"]]
    names["topics"] = [page["word"] for page in found["topics"]]
    for kind, words in names.items():
        yield f"{kind}:"
        yield from _wrapped("  ".join(words), INDENT)


def lines(found: dict[str, list[Any]]) -> Iterator[str]:
    """The pages of one word."""
    parts = [_wrapped(f"{page['word']}: {page['text']}", 0) for page in found["topics"]]
    parts += [list(element(page)) for page in found["elements"]]
    parts += [list(section(page)) for page in found["sections"]]
    parts += [list(key(page, page["place"], 0)) for page in found["keys"]]
    parts += [list(key(page, page["place"], 0)) for page in found["values"]]
    parts += [list(function(page)) for page in found["functions"]]
    parts += [list(channel(page)) for page in found["channels"]]
    parts += [[unit(page) for page in found["units"]]] if found["units"] else []
    for k, part in enumerate(parts):
        yield from ["", *part] if k else part


def element(page: dict[str, Any]) -> Iterator[str]:
    yield f"{page['word']}: an element, in `{page['section']}`"
    yield from ("", page["law"], "", page["about"])
    yield from keys(page)
    if page["coordinates"]:
        of = {"joints": "joint "}.get(page["section"], "")
        yield from ("", f"{of}coordinate: {', '.join(page['coordinates'])}")
    if page["channels"]:
        yield from ("", "channels:")
    for channel in page["channels"]:
        size = f", {channel['size']} numbers" if channel["size"] > 1 else ""
        yield f"    {channel['name']}  [{channel['unit']}{size}]"
        yield from _wrapped(channel["meaning"], 2 * INDENT)
    yield from ("", "example:", textwrap.indent(page["example"], " " * INDENT))


def section(page: dict[str, Any]) -> Iterator[str]:
    unit = f", {page['unit']}" if page["unit"] else ""
    yield f"{page['word']}: a section: {page['type']}{unit}"
    yield from ("", page["about"])
    yield from ("", page["law"]) if page["law"] else ()
    if page["elements"]:
        yield from ("", "elements:", *_wrapped("  ".join(page["elements"]), INDENT))
    yield from keys(page)
    if page["example"]:
        yield from ("", "example:", textwrap.indent(page["example"], " " * INDENT))


def keys(page: dict[str, Any]) -> Iterator[str]:
    if page["keys"]:
        yield from ("", "keys:")
    for one in page["keys"]:
        yield from key(one, one["place"].removeprefix(f"{page['word']}."), INDENT)


def key(one: dict[str, Any], name: str, indent: int) -> Iterator[str]:
    facts = [one["type"]]
    facts += [one["unit"]] if one["unit"] not in (None, "-") else []
    facts += ["required"] if one["required"] else []
    facts += [f"default {as_written(one['default'])}"] if one["default"] not in (None, "") else []
    told_of = _wrapped(f"{name}: {', '.join(facts)}", indent)
    yield from (line if k == 0 else f"{' ' * INDENT}{line}" for k, line in enumerate(told_of))
    yield from _wrapped(one["meaning"], indent + INDENT)


def function(page: dict[str, str]) -> Iterator[str]:
    yield page["written"]
    yield from _wrapped(page["meaning"], INDENT)


def channel(page: dict[str, Any]) -> Iterator[str]:
    size = f", {page['size']} numbers" if page["size"] > 1 else ""
    yield f"{page['name']}: a channel of {page['element']}  [{page['unit']}{size}]"
    yield from _wrapped(page["meaning"], INDENT)


def unit(page: dict[str, Any]) -> str:
    """A unit, its size in SI, and what is measured in it."""
    size = "" if page["word"] == page["unit"] else f" = {page['factor']:.9g} {page['unit']}"
    return f"1 {page['word']}{size.removesuffix(' -')}" + (f", {page['kind']}" * bool(page["kind"]))


def as_written(default: Any) -> str:
    """A default as one would write it."""
    if isinstance(default, list | tuple):
        return f"[{', '.join(map(as_written, default))}]"
    if isinstance(default, bool):
        return str(default).lower()
    return f"{default:g}" if isinstance(default, float) else str(default)


def _wrapped(text: str, indent: int) -> list[str]:
    space = " " * indent
    return textwrap.wrap(text, WIDTH, initial_indent=space, subsequent_indent=space)
