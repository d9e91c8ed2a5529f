"""Numbers no mechanism has are refused by name, or checked to the end: arithmetic never fails."""

import copy
import functools
import json
import operator
import random
from pathlib import Path

import pytest

from trsim.assemble.assemble import assemble
from trsim.assemble.release import release
from trsim.errors import TrsimError
from trsim.solve.projected import projected
from trsim.solve.scales import scales
from trsim.solve.skipped import skipped
from trsim.solve.start import start
from trsim.spec.load import load, loads

SCENARIOS = Path(__file__).parents[1] / "scenarios"
FILES = ("thrust_reverser/clearance_ab_0.3mm", "validation/slider_crank_friction",
         "validation/four_bar_3d", "validation/slider_crank_3d")  # fmt: skip
ABSURD = (1e50, -1e50, 1e45, 1e30, -1e30, 1e25, 1e12, 0.0, -1.0, 1e-12, 1e-30, 1e-160, 5e-324)
CASES = 60  # of each file


def numbers(data, path=()):
    """The path of every number, quantities among them."""
    for key, value in data.items() if isinstance(data, dict) else enumerate(data):
        if isinstance(value, dict | list):
            yield from numbers(value, (*path, key))
        elif isinstance(value, int | float) or (value and str(value)[0].isdigit()):
            yield (*path, key)


@pytest.mark.filterwarnings("ignore::RuntimeWarning")  # of numpy, at 1e30 kg
@pytest.mark.parametrize("name", FILES)
def test_absurd_numbers(name):
    tree, dice = load(SCENARIOS / f"{name}.yaml").resolved, random.Random(name)
    counts = {0: 0, 3: 0, 4: 0}
    for _ in range(CASES):
        changed = copy.deepcopy(tree)
        for _ in range(dice.randint(1, 2)):
            *above, key = dice.choice(sorted(numbers(changed), key=str))
            functools.reduce(operator.getitem, above, changed)[key] = dice.choice(ABSURD)
        try:
            scenario = loads(json.dumps(changed))
            mechanism = assemble(scenario)
            release(scenario, mechanism)
            begun = start(scenario, mechanism, located=True)
            scales(scenario, mechanism, begun)
            projected(mechanism, begun)
            assert skipped(scenario, mechanism)
            counts[0] += 1
        except TrsimError as error:
            assert error.show()
            counts[error.exit_code] += 1
    print(name, counts)
    assert min(counts.values()) > 0
