"""What the words of scenario files mean: elements, sections, keys, from the specs themselves."""

import sys
from collections.abc import Iterator
from functools import cache
from typing import Any

from trsim import elements
from trsim.errors import ScenarioError, UsageError, known
from trsim.fields import Spec
from trsim.scenario.functions import VALUES, functions
from trsim.scenario.load import unit_of
from trsim.scenario.meanings import description, inside, meanings
from trsim.scenario.scenario import Scenario
from trsim.scenario.schema import schema
from trsim.scenario.topics import NUMBERS, SWEEP, TOPICS
from trsim.statuses import STATUSES
from trsim.units import BASE, DERIVED, kind, si, unit

SIGNS = {"minimum": ">=", "exclusiveMinimum": ">", "maximum": "<=", "exclusiveMaximum": "<"}
TYPES = {"integer": "whole number", "string": "text", "boolean": "true or false", "null": ""}
FUNCTION = "number, expression or table"
# modules that tell one
LAWS = ("trsim.scenario.contact_law", "trsim.scenario.event", "trsim.scenario.phases")

Page = dict[str, Any]


@cache
def definitions() -> dict[str, Any]:
    """The schema of a scenario file; nobody writes into it."""
    return schema()


def explained(word: str | None = None) -> dict[str, list[Page]]:
    """All that a word names; without a word, all there is.

    A key is named by its place, `limit_stop.wall.normal`, or by the end of it, `normal`; the keys
    of a mapping come with it.  What a key may be, `akima`, and what is recorded, `reaction`, are
    words too, and so are units and topics.  Raises UsageError for a word nobody knows.
    """
    found = _every()
    return dict(found) if word is None else _of(word, found)


@cache
def _every() -> dict[str, list[Page]]:
    """All there is; nobody writes into it."""
    of = definitions()["$defs"]
    kinds = [_element(name, section, of) for name, section in elements.ELEMENTS.items()]
    sections = [_section(name, rule, of) for name, rule in of["Scenario"]["properties"].items()]
    keys = [key for page in (*kinds, *sections) for key in page["keys"]]
    calls = list(functions())
    return {
        "elements": kinds, "sections": sections, "keys": keys, "functions": calls,
        "values": [], "channels": [], "units": list(units()), "topics": list(_topics()),
    }  # fmt: skip


def _of(word: str, every: dict[str, list[Page]]) -> dict[str, list[Page]]:
    """What of all there is a word names."""
    found = {kind: [one for one in pages if one.get("word") == word]
             for kind, pages in every.items()}  # fmt: skip
    keys = [key for key in every["keys"] if f".{word}." in f".{key['place']}."]
    pages = (*found["elements"], *found["sections"])
    whole = tuple(f"{page['word']}." for page in pages)  # these show their keys
    found["keys"] = [key for key in keys if not key["place"].startswith(whole or "\0")]
    if not (pages or keys):
        found["values"] = [key for key in every["keys"] if word in key["type"].split(" | ")]
        calls = [page for page in every["functions"] if word in VALUES.get(page["word"], ())]
        found["functions"] += calls
    found["channels"] = [
        {"element": page["word"], **channel}
        for page in every["elements"]
        for channel in page["channels"]
        if f".{word}." in f"{channel['name'].removeprefix('NAME')}."
    ]
    if word == "units":
        found["units"] = every["units"]
    elif word == "functions":
        found["functions"] = every["functions"]
    elif not found["units"] and (page := _composed(word)):
        found["units"] = [page]
    if not any(found.values()):
        raise UsageError(f"nothing is called '{word}'", known(word, _words(every)))
    return found


def _words(every: dict[str, list[Page]]) -> list[str]:
    """All words that are known."""
    kinds = ("elements", "sections", "topics", "functions")
    named = [page["word"] for kind in kinds for page in every[kind]]
    places = [key["place"] for key in every["keys"]]
    return named + [place.rpartition(".")[2] for place in places] + places


def _topics() -> Iterator[Page]:
    ends = {word: f"A run that ended so: {text}." for word, text in STATUSES.items()}
    pages = {**ends, **TOPICS}
    for word, (of, text) in NUMBERS.items():
        told = f"`trsim show FILE {word}:{of}` prints {text}; so do `report --table` and `sweep`."
        pages[word] = f"{pages[word]} As a number of a run: {told}" if word in pages else told
    return ({"word": word, "text": text} for word, text in pages.items())


def units() -> Iterator[Page]:
    """Every word of units."""
    return (_unit(word) for word in (*BASE, *DERIVED))


def _unit(text: str) -> Page:
    factor, dimension = unit(text)
    return {"word": text, "factor": float(factor), "unit": si(text), "kind": kind(dimension)}


def _composed(text: str) -> Page | None:
    """A product or a power of units."""
    if not any(mark in text for mark in "*/^"):
        return None
    try:
        return _unit(text)
    except ScenarioError:
        return None


def _element(word: str, section: str, of: dict[str, Any]) -> Page:
    element = elements.load(word)
    spec: Any = element.spec
    # gravity has no entry: the scenario's key of its name makes it
    keys = list(_keys(word, of[spec.__name__], of, spec)) if section else []
    recorded = (*element.channels, *element.reactions)
    return {
        "word": word,
        "section": section or word,
        "law": (sys.modules[f"trsim.elements.{word}"].__doc__ or "").strip(),
        "about": description(spec),
        "keys": keys,
        "coordinates": list(element.coordinates),
        "channels": [_channel(channel) for channel in recorded],
        "example": element.example.strip(),
    }


def _channel(channel: Any) -> Page:
    units = dict.fromkeys(channel.unit_on(own) for own in ("rad", "m"))
    return {
        "name": f"NAME.{channel.name}" if channel.name else "NAME",
        "unit": " or ".join(units),
        "size": channel.size,
        "meaning": channel.meaning,
    }


def _section(word: str, rule: dict[str, Any], of: dict[str, Any]) -> Page:
    [key] = _keys("", {"properties": {word: rule}}, {}, Scenario)
    held = _held(Scenario, word)
    keys = _keys(word, of[held.__name__], of, held) if held else _keys(word, rule, of)
    keys = _of_sweep() if word == "sweep" else keys
    module = sys.modules[held.__module__] if held and _tells_a_law(held) else None
    law = module.__doc__ if module else ""
    return {
        "word": word,
        "about": key["meaning"],
        "law": (law or "").strip(),
        "type": key["type"],
        "unit": key["unit"],
        "elements": [kind for kind, of in elements.ELEMENTS.items() if of == word],
        "keys": list(keys),
        "example": getattr(module, "EXAMPLE", "").strip(),
    }


def _tells_a_law(spec: type[Spec]) -> bool:
    """Whether its module does: those of the elements, of contact laws, of events and phases."""
    return spec.__module__ in LAWS or spec.__module__.startswith(f"{elements.__name__}.")


def _keys(
    place: str, entry: dict[str, Any], of: dict[str, Any], spec: type[Spec] | None = None
) -> Iterator[Page]:
    """The keys of a mapping, each followed by those of the mapping it holds."""
    meaning = meanings(spec) if spec else {}
    for name, rule in entry.get("properties", {}).items():
        here = f"{place}.{name}"
        unit, held = unit_of(spec, name), _held(spec, name)
        default = rule.get("default")
        yield {
            "place": here,
            "meaning": meaning.get(name) or rule["description"],
            "type": worded(rule),
            "unit": unit.text if unit else None,
            "required": name in entry.get("required", ()),
            "default": None if isinstance(default, dict) else default,
        }
        if held and of:
            yield from _keys(here, of[held.__name__], of, held)
    others = entry.get("additionalProperties")
    if isinstance(others, dict) and "description" in others:  # keys the user names
        yield from _keys(place, {"properties": {"NAME": others}}, of)


def _of_sweep() -> Iterator[Page]:
    """The keys of a sweep that are no path."""
    for name, worded_as, meaning in SWEEP:
        yield {"place": f"sweep.{name}", "meaning": meaning, "type": worded_as, "unit": None,
               "required": False, "default": None}  # fmt: skip


def _held(spec: type[Spec] | None, key: str) -> type[Spec] | None:
    """The spec of the mapping, or of the named mappings, that a key holds."""
    field = spec.model_fields.get(key) if spec else None
    return next(inside(field.annotation), None) if field else None


# --- types in words --------------------------------------------------------------------------


def worded(rule: dict[str, Any]) -> str:
    """What a rule of the JSON Schema allows.  A number is also a quantity or an expression."""
    if "enum" in rule:
        return " | ".join(map(str, rule["enum"]))
    if "anyOf" in rule:
        return _any(rule["anyOf"])
    if "$ref" in rule:
        return "mapping"
    if rule.get("const") is False:
        return "false"
    if rule.get("type") in ("string", "object") and "title" in rule and "$ref" not in rule:
        return str(rule["title"])
    if rule.get("type") == "object":
        return "mapping of names" if rule.get("additionalProperties") else "mapping"
    if rule.get("type") == "array":
        return _list(rule)
    bounds = ", ".join(f"{sign} {rule[key]:g}" for key, sign in SIGNS.items() if key in rule)
    return f"{TYPES.get(rule.get('type', ''), rule.get('type', 'anything'))} {bounds}".strip()


def _any(rules: list[dict[str, Any]]) -> str:
    if [rule.get("type") for rule in rules[:3]] == ["number", "string", "object"]:
        return FUNCTION
    words = list(filter(None, dict.fromkeys(map(worded, rules))))
    if any(word.startswith("number") for word in words):
        words = [word for word in words if word != "text"]
    return " or ".join(words)


def _list(rule: dict[str, Any]) -> str:
    items = [worded(item) for item in rule.get("prefixItems", ())]
    if not items:
        return f"list of {worded(rule['items'])}"
    if items == [FUNCTION] * 3:
        return f"[x, y] or [x, y, z], each a {FUNCTION}"
    if items == ["number"] * 3 and rule["minItems"] == 2:
        return "[x, y] or [x, y, z]"
    return f"[{', '.join(items)}]" if len(items) < 3 else f"{len(items)} numbers"
