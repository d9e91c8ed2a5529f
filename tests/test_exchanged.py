"""Scenarios with things exchanged: types, nulls, sections, names, sizes, units, entries.

Mutants of the example of every element, and of a scene with templates, events and tables, as `trsim
check` sees them, in one process: refused with an error of ours, or scenarios, and nothing else.
"""

import copy
import json
import os
import random
import re
from pathlib import Path

import pytest

from trsim import elements
from trsim.scenario import event
from trsim.scenario.load import loads
from trsim.units import BASE, DERIVED

from .checking import Checks, written
from .sizes import size
from .test_mutants import at, paths

COUNT, PARTS = size(300, 20_000), range(4)
TEMPLATES = """\
parameters: {a: 0.2 m, n: 3}
templates:
  arm:
    parameters: {load: 2, far: a/2}
    frame: {at: [0, 0.1, 0]}
    bodies:
      rod: {mass: load, inertia: 0.05, at: [far, 0]}
      tip: {mass: 1 kg, inertia: 1e-3 kg*m^2, at: [2*far, 0]}
    joints:
      pin: {type: revolute, bodies: [ground, rod], at: [0, 0]}
      end: {type: revolute, bodies: [rod, tip], at: [2*far, 0]}
    sensors: {angle: {joint: pin}}
    forces:
      coil: {type: torsion_spring, joint: end, stiffness: 5 N*m/rad, damping: 0.1}
      push: {type: applied_load, body: rod, direction: [0, 1],
             force: {table: [[0, 0], [0.1, 3], [0.2, 1]], of: angle, units: [rad, N]}}
instances:
  left: {template: arm}
  right: {template: arm, frame: {at: [1, 0, 0], x_axis: [0, 1, 0], y_axis: [-1, 0, 0]},
          parameters: {load: 3}}
events:
  late: {when: t, value: 50 ms, do: {lock: [left_pin], record: true}}
  far_out: {when: right_angle, value: 20 deg, do: {release: [right_end]}}
gravity: [0, -9.81, 0]
phase_portraits: {motion: {x: left_angle, y: left_angle.rate}}
poincare: {section: {when: left_angle.rate, crosses: up, plot: [left_angle, right_angle]}}
solver: {end: 0.1 s, tolerance: 1e-5}
output: {every: 1 ms}
report: {units: {angle: deg, length: mm}}
"""
TEXTS = [elements.load(word).example for word in elements.ELEMENTS]
SCENES = [loads(text).resolved for text in (*filter(None, TEXTS), event.EXAMPLE, TEMPLATES)]
UNITS = [*BASE, *DERIVED, "N*m", "m/s", "rad/s", "N*m/rad", "kg*m^2", "m^", "N m", "1/0", "-"]
NUMBER = re.compile(r"[-+]?[0-9.]+(?:e[-+]?[0-9]+)?")
SIZES = [0.0, -1.0, 1e-320, 1e-300, 1e-60, 1e-12, 1e-3, 1e3, 1e9, 1e12, 1e30, 1e49, 1e60, 1e300,
         2**63, 10**30, -1e300]  # fmt: skip
THINGS = [None, True, False, 0, -1, "", "x", "t", "0 m", "ground", [], {}, [0], [0, 0], [0, 0, 0],
          [[0, 0]], {"a": 1}, {"table": [[0, 0], [1, 1]]}, {"type": "drive"}, "1/0", "sqrt(-1)",
          ["ground", "ground"], "1 N", "a/b", ".", "\u00e9", 1.5, float("1e308")]  # fmt: skip


def thing(tree, places, dice):
    """A value of any type, or none."""
    *above, key = dice.choice(places)
    holder = at(tree, above)
    if dice.random() < 0.2:
        del holder[key]
    else:
        holder[key] = copy.deepcopy(dice.choice(THINGS))


def number(tree, places, dice):
    """A number of another size."""
    numbers = [p for p in places if NUMBER.match(str(at(tree, p)))]
    *above, key = dice.choice(numbers or places)
    old, value = at(tree, (*above, key)), dice.choice(SIZES)
    at(tree, above)[key] = NUMBER.sub(repr(value), old, 1) if isinstance(old, str) else value


def unit(tree, places, dice):
    """A number in another unit."""
    numbers = [p for p in places if NUMBER.match(str(at(tree, p)))]
    *above, key = dice.choice(numbers or places)
    value = NUMBER.match(str(at(tree, (*above, key))))
    at(tree, above)[key] = f"{value[0] if value else 1} {dice.choice(UNITS)}"


def swapped(tree, places, dice):
    """Two values, of entries or of sections, exchanged."""
    one, two = dice.choice(places), dice.choice(places)
    if one[: len(two)] == two or two[: len(one)] == one:
        return
    a, b = at(tree, one), at(tree, two)
    at(tree, one[:-1])[one[-1]], at(tree, two[:-1])[two[-1]] = b, a


def renamed(tree, places, dice):
    """A key under another name: of its own kind, of another, or reserved."""
    keys = [p for p in places if isinstance(p[-1], str)]
    *above, key = dice.choice(keys)
    new = dice.choice(
        [*(p[-1] for p in keys), "mechanism", "orbit", "component", "time", "a.b", ""]
    )
    holder = at(tree, above)
    if new not in holder:
        holder[new] = holder.pop(key)


def referred(tree, places, dice):
    """A text that names something names something else."""
    words = [p for p in places if isinstance(at(tree, p), str)]
    if words:
        *above, key = dice.choice(words)
        names = [p[-1] for p in places if isinstance(p[-1], str)]
        at(tree, above)[key] = dice.choice([*names, at(tree, dice.choice(words))])


def doubled(tree, places, dice):
    """An entry once more, or a list that is longer."""
    path = dice.choice(places)
    *above, key = path
    holder = at(tree, above)
    if isinstance(holder, list):
        holder.insert(key, copy.deepcopy(holder[key]))
    else:
        holder[f"{key}_2"] = copy.deepcopy(holder[key])


def grafted(tree, places, dice):
    """A part of another scene, in the same place or anywhere."""
    other = dice.choice(SCENES)
    path = dice.choice(list(paths(other)))
    value = copy.deepcopy(at(other, path))
    if len(path) > 1 and dice.random() < 0.7:
        section = tree.setdefault(path[0], {})
        if isinstance(section, dict) and len(path) == 2:
            section[path[1]] = value
            return
    *above, key = dice.choice(places)
    at(tree, above)[key] = value


CHANGES = (thing, thing, number, number, unit, swapped, renamed, referred, doubled, grafted)


def mutant(dice):
    """A scene with one to three changes, and what they were."""
    tree, told = copy.deepcopy(dice.choice(SCENES)), []
    for _ in range(dice.choice([1, 1, 2, 3])):
        places = list(paths(tree))
        if places:
            change = dice.choice(CHANGES)
            change(tree, places, dice)
            told.append(change.__name__)
    return tree, told


@pytest.mark.filterwarnings("ignore::RuntimeWarning")  # of numpy, at 1e300 m
@pytest.mark.parametrize("part", PARTS)
def test_exchanged(part, tmp_path, monkeypatch):
    monkeypatch.setenv("TRSIM_DEBUG", "1")
    checks, count = Checks(), COUNT // len(PARTS)
    kept = Path(os.environ["FUZZ"]) / f"exchanged_{part}" if "FUZZ" in os.environ else None
    first = int(kept.read_text()) if kept and kept.exists() else 0
    bad = []
    for k in range(first, count):
        tree, told = mutant(random.Random(f"exchanged {part} {k}"))
        text = json.dumps(tree)
        try:
            checks.check(written(tmp_path / "mutant.yaml", text.encode()))
        except BaseException as error:
            if isinstance(error, KeyboardInterrupt):
                raise
            bad.append(f"{k} {told} {type(error).__name__} {error}: {text}")
            print(f"bad: {bad[-1]}", flush=True)
        if kept:
            kept.write_text(str(k + 1))
    print(f"exchanged {first}..{count}: {checks.told()}")
    assert not bad
