"""Damaged scenarios are refused with an error of ours, or are scenarios: nothing else happens.

All that `trsim check` does with them, in one process: load, assemble, find the start, warn.
"""

import copy
import functools
import json
import operator
import random
import re
import shutil
from pathlib import Path

import pytest
from hypothesis import given, seed, settings
from hypothesis import strategies as st

from trsim.scenario.load import load

from .checking import LARGEST, Checks, written
from .sizes import size

SCENARIOS = Path(__file__).parent.parent / "scenarios"
MECHANISM = SCENARIOS / "thrust_reverser" / "mechanism.yaml"
FILES = {  # scenario: mutants of it
    SCENARIOS / "thrust_reverser" / "clearance_ab_0.3mm.yaml": size(100, 10_000),  # static start
    MECHANISM: size(474, 47_500),
    SCENARIOS / "validation" / "slider_crank_friction.yaml": size(600, 47_500),
    SCENARIOS / "validation" / "four_bar_3d.yaml": size(226, 47_500),  # a release is looked for
    SCENARIOS / "validation" / "pendulum_3d.yaml": size(600, 47_500),
}
STRUCTURES = size(400, 50_000)
PARTS = range(size(2, 5))  # of each kind of mutant, with dice of its own: they run side by side
PIECES = [b"{", b"}", b"[", b"]", b":", b",", b"-", b"#", b"&a ", b"*a", b"!!x ", b"|", b"'", b'"',
          b"\n", b"\t", b" ", b"0", b"9", b"e9", b"-1", b"1e999", b".nan", b"null", b"\x00",
          b"\xff", b"\xc3\xa9", b"\xef\xbb\xbf", b"? ", b"<<: ", b"t", b"**9", b"()"]  # fmt: skip


def test_how_many():
    assert sum(FILES.values()) == size(2_000, 200_000)
    assert not any(count % len(PARTS) for count in (*FILES.values(), STRUCTURES))


@pytest.fixture(autouse=True)
def folder(tmp_path, monkeypatch):
    """Where mutants lie, beside the file some of them extend."""
    monkeypatch.setenv("TRSIM_DEBUG", "1")  # what is not an error of ours shows its traceback
    shutil.copy(MECHANISM, tmp_path)
    return tmp_path


# --- bytes -----------------------------------------------------------------------------------


def body_of(path):
    """The bytes of a scenario without its comments, which a mutation cannot hurt."""
    lines = path.read_bytes().splitlines(keepends=True)
    return b"".join(line for line in lines if not line.lstrip().startswith(b"#"))


def mutated(data, dice):
    for _ in range(dice.randint(1, 3)):
        k = dice.randrange(len(data))
        kind = dice.randrange(5)
        if kind == 0:
            data = data[:k] + bytes([data[k] ^ 1 << dice.randrange(8)]) + data[k + 1 :]
        elif kind == 1:
            data = data[:k] + data[k + dice.randint(1, 4) :]
        elif kind == 2:
            data = data[:k] + dice.choice(PIECES) + data[k:]
        elif kind == 3:
            data = data[:k] + dice.choice(PIECES) + data[k + 1 :]
        else:
            end = k + dice.randint(1, 40)
            data = data[:k] + data[k:end] * 2 + data[end:]
    return data


@pytest.mark.filterwarnings("error")
@pytest.mark.parametrize("part", PARTS)
@pytest.mark.parametrize("path", FILES, ids=lambda p: p.stem)
def test_mutated_bytes(path, part, folder):
    whole, dice, checks = body_of(path), random.Random(f"{path.name} {part}"), Checks()
    count = FILES[path] // len(PARTS)
    checks.warm(path)
    for _ in range(count):
        data = mutated(whole, dice)
        try:
            checks.check(written(folder / "mutant.yaml", data))
        except Exception as error:
            raise AssertionError(f"{type(error).__name__} {error}: {data!r}") from error
    print(f"{path.stem}: {checks.told()}")
    assert sum(checks.counts.values()) == count
    assert checks.counts[3] > 0.2 * count
    assert checks.largest < LARGEST


# --- values and structures -------------------------------------------------------------------

EXPONENTS = (-300, -12, -6, 3, 6, 9, 12, 20, 49, 100, 155, 300)
TREES = [load(path).resolved for path in FILES]
VALUES = (
    st.none()
    | st.booleans()
    | st.integers(-3, 3)
    | st.floats(allow_nan=False, allow_infinity=False)
    | st.sampled_from(
        [1e-300, 1e300, 1e49, -1.0, "0 m", "1e-9 mm", "90 deg", "t", "1/0", "ground", ""]
    )
    | st.sampled_from(["fairing", "door", "guide", "stroke", "B", "sqrt(-1)", "exp(1e9)", "pi"])
)
SHAPES = st.recursive(
    VALUES,
    lambda inner: (
        st.lists(inner, max_size=4)
        | st.dictionaries(
            st.sampled_from(["type", "joint", "at", "mass", "table"]), inner, max_size=3
        )
    ),
    max_leaves=6,
)


def paths(data, path=()):
    """The path of everything in a tree but the tree itself."""
    for key, value in data.items() if isinstance(data, dict) else enumerate(data):
        yield (*path, key)
        if isinstance(value, dict | list):
            yield from paths(value, (*path, key))


def at(tree, path):
    return functools.reduce(operator.getitem, path, tree)


def numeric(tree):
    """The paths of numbers, with or without a unit."""
    return [path for path in sorted(paths(tree), key=str) if NUMBER.match(str(at(tree, path)))]


NUMBER = re.compile(r"[-+]?[0-9.]+(e[-+]?[0-9]+)?")
SHARES = [0, *(2 * [1, 2, 3, 4])]  # a static start costs as much as all the others
ANYWHERE = [sorted(paths(tree), key=str) for tree in TREES]
NUMBERS = [numeric(tree) for tree in TREES]
EXTREMES = st.sampled_from([0.0, -1.0, *(s * 10.0**e for s in (1, -1) for e in EXPONENTS)])


def change_number(data, tree, path):
    """Another number in place of one, in the same unit."""
    *above, key = path
    value = data.draw(EXTREMES | st.floats(-10.0, 10.0))
    old = at(tree, path)
    at(tree, above)[key] = NUMBER.sub(repr(value), old, count=1) if isinstance(old, str) else value


def change_anything(data, tree, path):
    """Any value in place of one, or none."""
    *above, key = path
    try:
        holder = at(tree, above)
        if data.draw(st.integers(0, 4)) == 0:
            del holder[key]
        else:
            holder[key] = data.draw(SHAPES)
    except (LookupError, TypeError):  # it went with an earlier change
        return


def changed(data):
    """A good scenario with one to three changes: of numbers only, or of anything."""
    which = data.draw(st.sampled_from(SHARES))
    change, places = data.draw(
        st.sampled_from([(change_number, NUMBERS[which]), (change_anything, ANYWHERE[which])])
    )
    tree = copy.deepcopy(TREES[which])
    for path in data.draw(st.lists(st.sampled_from(places), min_size=1, max_size=3, unique=True)):
        change(data, tree, path)
    return tree


@pytest.mark.filterwarnings("ignore::RuntimeWarning")  # of numpy, at 1e300 m
@pytest.mark.parametrize("part", PARTS)
def test_changed_values(part, folder):
    checks, count = Checks(), STRUCTURES // len(PARTS)
    for path in FILES:
        checks.warm(path)

    @seed(part)
    @settings(max_examples=count, deadline=None, derandomize=True, database=None)
    @given(st.data())
    def change(data):
        text = json.dumps(changed(data))
        checks.check(written(folder / "mutant.yaml", text.encode()))

    change()
    print(f"structures: {checks.told()}")
    assert sum(checks.counts.values()) >= count
    assert checks.largest < LARGEST
