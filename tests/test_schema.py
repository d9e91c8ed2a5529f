"""The JSON Schema of scenario files against the files and against the loader."""

import json
from pathlib import Path

import pytest
from jsonschema import Draft202012Validator

from trsim.scenario.schema import schema
from trsim.scenario.text import read

FOLDER = Path(__file__).parent.parent / "scenarios"
FILES = sorted(FOLDER.rglob("*.yaml"))
SCHEMA = schema()


def fits(value):
    return Draft202012Validator(SCHEMA).is_valid(value)


@pytest.mark.parametrize("path", FILES, ids=lambda p: p.stem)
def test_scenarios_of_the_repository(path):
    assert fits(read(path.read_text(), path.name).data)


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
    assert fits(changed(**{section: {"extra": good}}))
    assert not fits(changed(**{section: {"extra": bad}}))


def test_top_level():
    assert not fits({**changed(), "bodys": {}})
    assert fits({"extends": "a.yaml", "joints": {"B": {"clearance": "1 mm"}, "C": None}})
    assert not fits({"extends": "a.yaml", "joints": {"B": {"clearence": "1 mm"}}})
    assert not fits({"joints": {"B": {"clearance": "1 mm"}}})
