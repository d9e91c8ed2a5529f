"""How close to a place where branches meet accelerations are compared with their limit, and how
sure that is."""

import numpy as np
import pytest

from trsim.assemble.beside import closes_a_loop
from trsim.assemble.equations import derivative
from trsim.assemble.instances import RowName
from trsim.assemble.linear import SMALL
from trsim.assemble.projection import close_positions, poses_and_rows, project_velocities
from trsim.elements.scene import scene

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


RATE = -3.0  # rad/s
PLACES = [0.0, 0.21, 0.53, 0.9]
DRIVEN = f"drives: {{motor: {{joint: F0, position: '{RATE} * t'}}}}\n"


@pytest.fixture(scope="module")
def four():
    """Four cranks of 1 m under a plate, lying flat at t = 0, the first one driven."""
    return built(
        text(cranks([1.0] * 4, PLACES, 0.0, top=0.0), DRIVEN, planar="true"),
        "solver.tolerance=1e-10",
    )


def lying(s, angle):
    """Their state, exact: every crank at the angle."""
    y, out = np.zeros(s.n_q + s.n_v + s.n_z), np.array([np.cos(angle), np.sin(angle)])
    for k, (x, reach, turns) in enumerate(
        [(np.mean(PLACES), 1.0, 0.0), *((p - 0.5, 0.5, 1.0) for p in PLACES)]
    ):
        y[3 * k : 3 * k + 3] = *(np.array([x, 0.0]) + reach * (out - [1.0, 0.0])), turns * angle
        v = s.n_q + 3 * k
        y[v : v + 3] = *(RATE * reach * np.array([-out[1], out[0]])), turns * RATE
    return y


@pytest.mark.parametrize("away", [-4e-3, -2e-3, -1e-3, -2e-4, 5e-4, 3e-3])
def test_the_limit_is_not_that_of_places_as_near_as_the_place_itself(four, away):
    """The rounding of a place at d is felt eps / d^3: limits from places nearer than 0.01 rad to
    where the branches meet were off by as much as what they stood for, up to 1e-6."""
    s, random, worst = scene(four.model), np.random.default_rng(4), 0.0
    s.status[5] = 1  # as of a row inside a step
    t = away / RATE
    for _ in range(20):
        y = lying(s, away)
        y[: s.n_q + s.n_v] += 1e-12 * random.standard_normal(s.n_q + s.n_v)
        close_positions(s, t, y, 1e-14 * s.size, 8)
        poses_and_rows(s, t, y)
        project_velocities(s, y)
        yd = np.zeros_like(y)
        derivative(s, t, y, yd)
        turning = yd[s.n_q + 2 : s.n_q + s.n_v : 3]
        worst = max(worst, float(np.abs(turning).max()) / RATE**2)
    print(f"{away:g} rad away: {worst:.1e}")
    assert worst < 2e-9
