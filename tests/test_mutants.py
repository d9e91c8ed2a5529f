"""Damaged scenarios are refused with an error of ours, or are scenarios: nothing else happens.

The same elements, loader, warnings and assembly as in `trsim check`, in one process.
"""

import copy
import functools
import json
import operator
import random
import time
from pathlib import Path

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from trsim.assemble.assemble import assemble
from trsim.errors import ModelError, ScenarioError, TrsimError
from trsim.spec.lint import lint
from trsim.spec.load import load, loads

SCENARIOS = Path(__file__).parent.parent / "scenarios"
FILES = [
    SCENARIOS / "thrust_reverser" / "mechanism.yaml",
    SCENARIOS / "validation" / "slider_crank_friction.yaml",
    SCENARIOS / "validation" / "four_bar_3d.yaml",
    SCENARIOS / "validation" / "pendulum_3d.yaml",
]
MUTANTS = 500  # of each file
PIECES = [b"{", b"}", b"[", b"]", b":", b",", b"-", b"#", b"&a ", b"*a", b"!!x ", b"|", b"'", b'"',
          b"\n", b"\t", b" ", b"0", b"9", b"e9", b"-1", b"1e999", b".nan", b"null", b"\x00",
          b"\xff", b"\xc3\xa9", b"\xef\xbb\xbf", b"? ", b"<<: ", b"t", b"**9", b"()"]  # fmt: skip


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
@pytest.mark.parametrize("path", FILES, ids=lambda p: p.stem)
def test_mutated_bytes(path, tmp_path):
    assemble(load(path))  # what compiles, compiles before the clock runs
    whole, dice = body_of(path), random.Random(path.name)
    counts = {"read": 0, "refused": 0, "ill-posed": 0}
    target = tmp_path / "mutant.yaml"
    slowest = 0.0
    for _ in range(MUTANTS):
        data = mutated(whole, dice)
        target.write_bytes(data)
        start = time.perf_counter()
        try:
            scenario = load(target)
            assert all(isinstance(text, str) for text in lint(scenario))
            assemble(scenario)
            counts["read"] += 1
        except ModelError as error:
            assert error.show()
            counts["ill-posed"] += 1
        except TrsimError as error:
            assert error.exit_code == ScenarioError.exit_code, data
            assert error.show()
            counts["refused"] += 1
        except Exception as error:
            raise AssertionError(f"{type(error).__name__} {error}: {data!r}") from error
        slowest = max(slowest, time.perf_counter() - start)
    print(path.stem, counts, f"slowest {slowest:.2f} s")
    assert counts["refused"] > 0.2 * MUTANTS


# --- values and structures -------------------------------------------------------------------

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
STRUCTURES = st.recursive(
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


@pytest.mark.filterwarnings("ignore::RuntimeWarning")  # of numpy, at 1e300 m
@settings(max_examples=300, deadline=1000, derandomize=True)
@given(st.data())
def test_changed_values(data):
    """Some values of a good scenario replaced by others, removed, or copied from elsewhere."""
    tree = copy.deepcopy(data.draw(st.sampled_from(TREES)))
    for _ in range(data.draw(st.integers(1, 3))):
        *above, key = data.draw(st.sampled_from(sorted(paths(tree), key=str)))
        holder = functools.reduce(operator.getitem, above, tree)
        if data.draw(st.integers(0, 4)) == 0:
            del holder[key]
        else:
            holder[key] = data.draw(STRUCTURES)
    try:
        scenario = loads(json.dumps(tree))
        assert all(isinstance(text, str) for text in lint(scenario))
        assemble(scenario)
    except TrsimError as error:
        assert error.exit_code in (3, 4)
        assert error.show()
