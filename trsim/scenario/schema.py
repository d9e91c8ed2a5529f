"""The JSON Schema of scenario files, made from the specs that also read them.

A file that `extends` another may leave out what is required, and remove things with null: it is
held to the `part` of the schema, a file that stands alone to the `whole`.
"""

from typing import Any

from pydantic.json_schema import models_json_schema

from trsim import elements
from trsim.fields import Spec
from trsim.scenario.initial import ALL
from trsim.scenario.load import unit_of
from trsim.scenario.meanings import description, meanings, specs
from trsim.scenario.scenario import Scenario
from trsim.scenario.template import SECTIONS

DIALECT = "https://json-schema.org/draft/2020-12/schema"
EXTENDS = {
    "description": "file, or list of files, that this one overrides key by key",
    "anyOf": [{"type": "string"}, {"type": "array", "items": {"type": "string"}}],
}
NUMBER = {"anyOf": [{"type": "number"}, {"type": "string"}]}  # 0.3, 0.3 mm, k/2
INITIAL = {
    "type": "object",
    "properties": {
        "equilibrium": {
            "description": "joints that are free to move until the forces balance, or `all`",
            "anyOf": [{"enum": [ALL]}, {"type": "array", "items": {"type": "string"}}],
        }
    },
    "additionalProperties": {
        "description": "coordinate of the joint (rad or m); for JOINT.rate its rate (rad/s or m/s)",
        **NUMBER,
    },
}


def schema() -> dict[str, Any]:
    """The schema of a scenario file, all elements included."""
    of_word: dict[str, Any] = {word: elements.load(word).spec for word in elements.ELEMENTS}
    every = dict.fromkeys(spec for top in (Scenario, *of_word.values()) for spec in specs(top))
    made, given = models_json_schema([(spec, "validation") for spec in every])
    definitions, keys = given["$defs"], {spec: key for (spec, _), key in made.items()}
    for spec in every:
        _describe(_definition(definitions, keys[spec]), spec)
    root = _definition(definitions, keys[Scenario])
    for word, section in elements.ELEMENTS.items():
        if section:
            _typed(_definition(definitions, keys[of_word[word]]), word, section)
    for section in set(elements.ELEMENTS.values()) - {""}:
        entries = [keys[of_word[word]] for word, of in elements.ELEMENTS.items() if of == section]
        root["properties"][section]["additionalProperties"] = (
            {"anyOf": entries} if len(entries) > 1 else entries[0]
        )
    _templates(root, definitions)
    root["properties"]["initial"] |= INITIAL
    del root["properties"]["initial"]["default"]  # as drawn, the drives at speed
    root["properties"]["extends"] = EXTENDS
    root["properties"]["parameters"]["additionalProperties"] = NUMBER
    parts = {f"part_{name}": _part(value) for name, value in definitions.items()}
    whole = keys[Scenario]["$ref"]
    return {
        "$schema": DIALECT,
        "title": "trsim scenario",
        "$defs": {**definitions, **parts},
        "if": {"required": ["extends"]},
        "then": {"$ref": whole.replace("#/$defs/", "#/$defs/part_")},
        "else": {"$ref": whole},
    }


def _templates(root: dict[str, Any], definitions: dict[str, Any]) -> None:
    """Let templates hold what the sections of a scenario do, and instances parts of it."""
    for name in ("Template", "Instance"):
        keys = definitions[name]["properties"]
        keys["parameters"]["additionalProperties"] = NUMBER
        for section in SECTIONS:
            entries = root["properties"][section]["additionalProperties"]
            keys[section]["additionalProperties"] = (
                entries if name == "Template" else _or_null(_part(entries))
            )


def _definition(definitions: dict[str, Any], reference: Any) -> dict[str, Any]:
    return definitions[reference["$ref"].removeprefix("#/$defs/")]


def _describe(entry: dict[str, Any], spec: type[Spec]) -> None:
    """Add what the keys mean, and their units."""
    entry["description"] = description(spec)
    meaning = meanings(spec)
    for key, rule in entry["properties"].items():
        unit = unit_of(spec, key)
        told = f" ({unit.text})" if unit and unit.text != "-" else ""
        rule["description"] = meaning.get(key, "") + told
        rule.pop("title", None)  # the key again


def _typed(entry: dict[str, Any], word: str, section: str) -> None:
    """Add the key `type` that chooses the element."""
    words = [word, *(first for first, (_, other) in elements.BECOMES.items() if other == word)]
    kind = {"description": "which kind of entry", "enum": words}
    entry["properties"] = {"type": kind, **entry["properties"]}
    if elements.DEFAULT.get(section) != word:
        entry["required"] = ["type", *entry.get("required", ())]


def _part(value: Any) -> Any:
    """This schema with nothing required and null allowed for every key."""
    if isinstance(value, list):
        return [_part(item) for item in value]
    if not isinstance(value, dict):
        return value.replace("#/$defs/", "#/$defs/part_") if _is_reference(value) else value
    found = {}
    for key, inner in value.items():
        if key == "required" and isinstance(inner, list):
            continue
        if key == "properties":
            found[key] = {name: _or_null(_part(item)) for name, item in inner.items()}
        elif key == "additionalProperties" and isinstance(inner, dict):
            found[key] = _or_null(_part(inner))
        else:
            found[key] = _part(inner)
    return found


def _is_reference(value: Any) -> bool:
    return isinstance(value, str) and value.startswith("#/$defs/")


def _or_null(value: dict[str, Any]) -> dict[str, Any]:
    return {"anyOf": [value, {"type": "null"}]}
