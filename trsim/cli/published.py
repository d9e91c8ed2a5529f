"""The JSON Schemas that trsim publishes: of scenario files, and of the document of each command.

The schema of a document is closed and knows with which exit codes its command can end.  To add a
command, or a code, is one line in `ENDS` and one type in documents/.
"""

from collections.abc import Iterator
from typing import Any, get_args, get_type_hints

from pydantic import TypeAdapter

from trsim.cli import COMMANDS, documents
from trsim.cli.frame import EXIT_CODES
from trsim.scenario import schema as scenario
from trsim.scenario.meanings import description, meanings

ALWAYS = {0, 1, 2, 7, 130, 143}
ENDS = {command: ALWAYS for command in COMMANDS} | {
    "run": ALWAYS | {3, 4, 5},
    "sweep": ALWAYS | {3, 4, 6},
    "check": ALWAYS | {3, 4},
    "statics": ALWAYS | {3, 4},
    "bench": ALWAYS | {3, 4, 5},
    "trsim": {2, 130},  # a command line that names no command
}
WORDS = ("scenario", *ENDS)


def published(what: str) -> dict[str, Any]:
    """The schema of one of WORDS."""
    return scenario.schema() if what == "scenario" else of_document(what)


def of_document(command: str) -> dict[str, Any]:
    """The schema of what `trsim COMMAND --json` prints."""
    kind = getattr(documents, "Document" if command == "trsim" else command.capitalize())
    found = TypeAdapter(kind).json_schema()
    definitions = found.pop("$defs", {}) | {kind.__name__: found}
    kinds = {kind.__name__: kind for kind in _inside(kind)}
    for name, entry in definitions.items():
        _close(entry, kinds[name])
    common, own = documents.Document.__required_keys__, found["required"]
    codes = [code for code in EXIT_CODES if code in ENDS[command]]
    found["properties"]["command"] = {"const": None if command == "trsim" else command}
    found["properties"]["exit_code"]["enum"] = codes
    definitions["Error"]["properties"]["exit_code"]["enum"] = [code for code in codes if code]
    del definitions[kind.__name__]
    return {
        "$schema": scenario.DIALECT,
        **found,
        "title": f"trsim {command} --json" if command in COMMANDS else "trsim --json",
        "required": sorted(common),
        "if": {"properties": {"exit_code": {"const": 0}}},
        "then": {"required": own, "properties": {"errors": {"maxItems": 0}}},
        "else": {"properties": {"errors": {"minItems": 1}}},
        "$defs": definitions,
    }


def _inside(kind: Any) -> Iterator[Any]:
    """A typed dictionary, and those in it."""
    if hasattr(kind, "__required_keys__"):
        yield kind
    for part in get_type_hints(kind).values() if isinstance(kind, type) else get_args(kind):
        yield from _inside(part)


def _close(entry: dict[str, Any], kind: Any) -> None:
    """Allow no other keys, and say what each one means."""
    entry["additionalProperties"] = False
    entry["description"] = description(kind)
    told = _meanings(kind)
    for key, rule in entry["properties"].items():
        rule["description"] = told.get(key, "")
        rule.pop("title", None)


def _meanings(kind: Any) -> dict[str, str]:
    """The meanings of the keys of a typed dictionary, whose bases are no part of its __mro__."""
    found: dict[str, str] = {}
    for base in getattr(kind, "__orig_bases__", ()):
        found |= _meanings(base) if hasattr(base, "__required_keys__") else {}
    return found | meanings(kind)
