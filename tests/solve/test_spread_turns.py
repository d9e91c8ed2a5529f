"""Bounds of bends and of whole turns inside a step, against turns that are followed closely."""

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from trsim.assemble.travel import BEND, SWING, of_instance
from trsim.kernels import plain
from trsim.solve.march.spread import of_angle
from trsim.solve.march.spread_turns import of_bend, of_swing

from ..elements.bench import bench, put_right

TEXT = """
joints: {ball: {type: spherical, bodies: [left, right], at: [0.2, 0.1, 0], axis: [0.48, 0.6, 0.64],
                second_axis: [0.8, -0.1, 0.3]}}
sensors: {bend: {joint: ball.bend}}
forces: {spring: {type: ball_spring, joint: ball, elastic: angle}}
"""
H = 0.1  # s


def shown(b, kind, twist, times, e, entry):
    """The scene at the end, and what was shown until then, both bodies turning evenly."""
    found = []
    for t in times:
        w = b.moved(twist, t).scene()
        found.append(w.S[entry, 0])
    return w, np.array(found)


@pytest.mark.parametrize("kind, bound", [(BEND, of_bend), (SWING, of_swing)])
@pytest.mark.parametrize("seed", range(12))
def test_nothing_goes_beyond_its_bounds(kind, bound, seed):
    rng = np.random.default_rng(seed)
    b = bench(TEXT, rng)
    turn = Rotation.random(random_state=seed).as_rotvec() * (0.1, 0.5, 0.8, 1.0)[seed % 4]
    if kind == BEND and seed % 4 != 3:  # next to straight, or to half a turn
        axis = np.cross([0.48, 0.6, 0.64], [0.8, -0.1, 0.3])
        turn = axis / np.linalg.norm(axis) * (-0.7, 1.7, 2.0)[seed % 4]
    put_right(b, np.array([0.2, 0.1, 0.0]), turn, np.zeros(3))
    instances = b.mechanism.instances
    e = next(k for k in range(len(instances)) if of_instance(instances, k)[0] == kind)
    entry = instances[e].row.con[2]
    twist = np.zeros((3, 6))
    twist[1:, 3:] = 3 * rng.normal(size=(2, 3))
    size = [np.linalg.norm(row) for row in twist[1:, 3:]]
    turns = plain.plain(of_angle.python)((size[0], 0.0), (size[1], 0.0))
    told = 0
    for length in (H, H / 8, H / 64):
        times = np.linspace(0.0, length, 101)
        step = times[1]
        w, x = shown(b, kind, twist, times, e, entry)
        once, twice = np.diff(x) / step, np.diff(x, 2) / step**2
        for sign in (1.0, -1.0):
            L, M = plain.plain(bound.python)(w, e, turns, sign, length)
            assert np.abs(once).max() <= L * (1 + 1e-9)
            if np.isfinite(M):
                told += 1
                assert (-sign * twice).max() <= M + 1e-4 * L / length
                if sign < 0.0:
                    assert np.abs(twice).max() <= M + 1e-4 * L / length
    assert told >= 1


@pytest.mark.parametrize("way, sign", [(1, -1.0), (-1, 1.0), (-1, -1.0)])
def test_they_are_close_where_nothing_but_the_way_round_counts(way, sign):
    """A stud that goes round a cone next to straight, or to half a turn: all that it has is W^2 cot
    of how far that is."""
    axis = str([0.5 * way, 0.6 * way, 0.64 * way])
    b = bench(TEXT.replace("[0.8, -0.1, 0.3]", axis), np.random.default_rng(1))
    put_right(b, np.array([0.2, 0.1, 0.0]), np.zeros(3), np.zeros(3))
    instances = b.mechanism.instances
    e = next(k for k in range(len(instances)) if of_instance(instances, k)[0] == BEND)
    s = b.scene()
    x = s.S[instances[e].row.con[2], 0]
    _, M = plain.plain(of_bend.python)(s, e, (2.0, 0.0), sign, 0.0)
    assert pytest.approx(4 * (0.5 + way / np.tan(x)), rel=1e-9) == M
