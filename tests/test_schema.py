"""The JSON Schema of scenario files against the files and against the loader."""

import json
from pathlib import Path

import pytest

from trsim.spec.schema import schema
from trsim.spec.text import read

FOLDER = Path(__file__).parent.parent / "scenarios"
FILES = sorted(FOLDER.rglob("*.yaml"))
SCHEMA = schema()
TYPES = {
    "object": dict,
    "array": list,
    "string": str,
    "number": (int, float),
    "integer": int,
    "boolean": bool,
    "null": type(None),
}
MARKS = {"$schema", "$defs", "title", "description", "default", "then", "else", "if"}


def of_type(value, kind):
    return isinstance(value, TYPES[kind]) and (kind == "boolean" or not isinstance(value, bool))


def fits(value, rule):
    """Whether a value keeps a rule: as much of JSON Schema as the schema uses, and no more."""
    if isinstance(rule, bool):
        return rule
    if "if" in rule:
        branch = rule["then"] if fits(value, rule["if"]) else rule["else"]
        return fits(value, branch)
    return all(CHECKS[word](value, own, rule) for word, own in rule.items() if word not in MARKS)


def of_mapping(value, rules, rule):
    return not isinstance(value, dict) or all(
        fits(value[k], own) for k, own in rules.items() if k in value
    )


def of_others(value, own, rule):
    known = rule.get("properties", {})
    return not isinstance(value, dict) or all(
        fits(v, own) for k, v in value.items() if k not in known
    )


def of_front(value, rules, rule):
    return not isinstance(value, list) or all(map(fits, value, rules))


def of_items(value, own, rule):
    return not isinstance(value, list) or all(fits(item, own) for item in value)


def of_number(holds):
    return lambda value, own, rule: not of_type(value, "number") or holds(value, own)


def of_size(holds):
    return lambda value, own, rule: not isinstance(value, list) or holds(len(value), own)


CHECKS = {
    "$ref": lambda v, own, rule: fits(v, SCHEMA["$defs"][own.removeprefix("#/$defs/")]),
    "type": lambda v, own, rule: of_type(v, own),
    "enum": lambda v, own, rule: v in own,
    "const": lambda v, own, rule: v == own,
    "anyOf": lambda v, own, rule: any(fits(v, branch) for branch in own),
    "required": lambda v, own, rule: not isinstance(v, dict) or set(own) <= set(v),
    "properties": of_mapping,
    "additionalProperties": of_others,
    "prefixItems": of_front,
    "items": of_items,
    "minItems": of_size(lambda n, own: n >= own),
    "maxItems": of_size(lambda n, own: n <= own),
    "minimum": of_number(lambda v, own: v >= own),
    "exclusiveMinimum": of_number(lambda v, own: v > own),
    "maximum": of_number(lambda v, own: v <= own),
    "exclusiveMaximum": of_number(lambda v, own: v < own),
}


@pytest.mark.parametrize("path", FILES, ids=lambda p: p.stem)
def test_scenarios_of_the_repository(path):
    assert fits(read(path.read_text(), path.name).data, SCHEMA)


def test_is_plain_json():
    assert json.loads(json.dumps(SCHEMA)) == SCHEMA


def changed(**sections):
    data = read((FOLDER / "thrust_reverser" / "mechanism.yaml").read_text(), "").data
    for section, entries in sections.items():
        data[section] = {**data.get(section, {}), **entries}
    return data


GUIDE = {"type": "prismatic", "bodies": ["ground", "fairing"], "axis": [1, 0, 0]}
STOP = {"type": "limit_stop", "joint": "A", "upper": "30 deg", "stiffness": 1e6}
JOINT = {"type": "revolute", "bodies": ["fairing", "door"], "at": [0, "1 mm"]}


@pytest.mark.parametrize(
    ("section", "good", "bad"),
    [
        ("joints", GUIDE, {**GUIDE, "axes": 1}),
        ("joints", GUIDE, {**GUIDE, "type": "prismatik"}),
        ("joints", GUIDE, {**GUIDE, "axis": [1]}),
        ("joints", GUIDE, {**GUIDE, "clearance": 1e-4}),
        ("joints", {**JOINT, "clearance": "0.1 mm"}, {**JOINT, "clearance": -1}),
        ("forces", STOP, {**STOP, "stiffness": 0}),
        ("forces", STOP, {"type": "limit_stop"}),
        ("bodies", {"mass": "1 kg", "inertia": [1, 1, 1]}, {"mass": 1}),
        ("bodies", {"mass": 1, "inertia": 1}, {"mass": 1, "inertia": [1, 2]}),
        ("drives", {"joint": "A", "velocity": "2*t"}, {"joint": "A", "speed": 1}),
        ("parameters", 1.0, None),
    ],
)
def test_refuses_what_the_loader_refuses(section, good, bad):
    assert fits(changed(**{section: {"extra": good}}), SCHEMA)
    assert not fits(changed(**{section: {"extra": bad}}), SCHEMA)


def test_top_level():
    assert not fits({**changed(), "bodys": {}}, SCHEMA)
    assert fits({"extends": "a.yaml", "joints": {"B": {"clearance": "1 mm"}, "C": None}}, SCHEMA)
    assert not fits({"extends": "a.yaml", "joints": {"B": {"clearence": "1 mm"}}}, SCHEMA)
    assert not fits({"joints": {"B": {"clearance": "1 mm"}}}, SCHEMA)
