"""How close to a place where branches meet accelerations are compared with their limit."""

import pytest

from trsim.assemble.beside import closes_a_loop
from trsim.assemble.linear import SMALL
from trsim.assemble.mechanism import RowName

from ..overconstrained import cranks, text
from ..runs import built


def near(*sets):
    scene = text(cranks([1.0, 1.0], [0.0, 0.7], 0.3, top=0.0), "gravity: [2, -5, 0]\n")
    return built(scene, *sets).model.near


def rows(*instances):
    """The first two rows of each instance, given by its frames."""
    return [
        RowName(f"joint{n}", str(k), n, k, frames, False)
        for n, frames in enumerate(instances)
        for k in range(2)
    ]


def test_the_zone_is_where_rounding_reaches_the_tolerance():
    assert near("solver.tolerance=1e-6") == pytest.approx(1e-7)
    assert near("solver.tolerance=1e-8") == pytest.approx(1e-5)
    assert near("solver.tolerance=1e-12") == SMALL


def test_there_is_none_where_nobody_looks_at_the_steps():
    assert near("solver.method=scipy:RK45") == 0.0


def test_open_chains_and_trees_have_none():
    assert not closes_a_loop(rows((0, 1), (1, 2), (2, 3), (1, 4)))
    assert not closes_a_loop([])


@pytest.mark.parametrize(
    "instances", [[(0, 1), (1, 2), (2, 0)], [(0, 1), (0, 1)], [(3, 1), (2, 3), (0, 4), (1, 2)]]
)
def test_loops_have_one(instances):
    assert closes_a_loop(rows(*instances))


def test_a_bar_joins_its_nodes():
    ends = rows((0, 5), (0, 9))  # a bar of nodes 5 to 9, held at both ends
    assert not closes_a_loop(ends)
    assert closes_a_loop(ends, [(5, 5)])
