"""Touches: the stretches of a profile that a ball touches one at a time, against geometry."""

from math import cos, pi, sin

import numpy as np
import pytest

from trsim.laws.profiles import Flaw, profile, smooth
from trsim.laws.surfaces import beside
from trsim.laws.touches import touches


def depths(found, places, r):
    """How deep balls of radius r at some places are in each of the touches."""
    tabs = [np.array(touch.numbers) for touch in found]
    return np.array([[r - beside(tab, 0, 2, *p)[0] for tab in tabs] for p in places])


def vee(half, corner=0.0, long=1.0):
    """A groove that opens upwards, of that half angle."""
    x, y = long * sin(half), long * cos(half)
    return profile([[-x, y], [0, 0], [x, y]], corner, False, 1, inward=True)


@pytest.mark.parametrize("half", [0.1, 0.5, 1.0, 1.4, 1.5])
@pytest.mark.parametrize("corner", [0.0, 0.02])
def test_a_ball_in_a_groove_touches_both_flanks(half, corner):
    r = 0.05 if half > 0.2 else 0.03
    got = touches(vee(half, corner), False, 1, r)
    assert len(got) == 2
    rest = [0.0, r / sin(half)]
    rng = np.random.default_rng(1)
    places = rest + rng.uniform(-0.02, 0.02, (300, 2)) * r * cos(half)
    # of each flank: the distance from its line
    want = np.sort([[r - (y * sin(half) - x * cos(half)), r - (y * sin(half) + x * cos(half))]
                    for x, y in places], axis=1)  # fmt: skip
    assert np.sort(depths(got, places, r), axis=1) == pytest.approx(want, abs=1e-12)
    assert all(one.reach > r for one in got)


@pytest.mark.parametrize("turn", [0.0, 2.0])
@pytest.mark.parametrize("closed", [False, True])
def test_a_ball_on_the_edges_of_a_notch(closed, turn):
    w, r = 0.4, 0.3
    points = np.array([[0, 1], [1, 1], [1, 0.2], [1 + w, 0.2], [1 + w, 1], [3, 1]])
    if closed:
        points = np.array([*points, [3.0, -1.0], [0.0, -1.0]])[::-1]
    R = np.array([[cos(turn), -sin(turn)], [sin(turn), cos(turn)]])
    found = profile(points @ R.T, 0.0, closed, 1, inward=True)
    if not closed:
        found = profile(points @ R.T, 0.0, closed, 1, inward=True)
    got = touches(found, closed, 1, r)
    assert len(got) == 2
    place = np.array([1 + w / 2 + 0.01, 1 + np.sqrt(r * r - (w / 2) ** 2) - 0.005])
    want = sorted(r - np.hypot(*(place - [x, 1])) for x in (1, 1 + w))
    assert sorted(depths(got, [R @ place], r)[0]) == pytest.approx(want, abs=1e-12)


def test_a_closed_block_with_a_groove_is_cut_at_a_seam():
    """Both flanks belong to one way round the block: it is cut where that is halfway."""
    block = [[-1, -1], [1, -1], [1, 1], [0.5, 1], [0, 0.5], [-0.5, 1], [-1, 1]]
    got = touches(profile(block, 0.0, True, 1, inward=True), True, 1, 0.1)
    assert len(got) == 2
    seams = [seam for one in got for seam in one.seams]
    assert len(seams) == 2
    for x, y in seams:
        assert y == pytest.approx(-1.0, abs=0.01)  # the bottom
        assert abs(x) < 0.1
    place = [0.0, 0.5 + 0.1 * np.sqrt(2) - 1e-3]
    deep = 1e-3 / np.sqrt(2)
    assert depths(got, [place], 0.1)[0] == pytest.approx([deep, deep], abs=1e-12)
    # on the top beside the groove it touches one
    assert (depths(got, [[0.8, 1.099]], 0.1) > 0.0).sum() == 1


def test_a_rectangular_slot_has_touches_that_are_shared():
    """Opposite sides are never touched at once, neighbours are."""
    slot = profile([[0, 0], [1, 0], [1, 0.3], [0, 0.3]], 0.0, True, -1, inward=True)
    got = touches(slot, True, -1, 0.1)
    assert len(got) == 2
    one, other = depths(got, [[0.5, 0.099], [0.9005, 0.2004]], 0.1)
    assert sorted(one) == pytest.approx([-0.4, 0.001])
    assert sorted(other) == pytest.approx([0.0004, 0.0005])


def test_a_rack_needs_two_touches_however_many_teeth():
    points = [[0.5 * k, 0.3 * (k % 2)] for k in range(41)]
    assert len(touches(profile(points, 0.0, False, 1, inward=True), False, 1, 0.05)) == 2


def test_a_smooth_hollow_narrower_than_the_ball():
    """Inside an ellipse: near its long ends the ball touches above and below the axis at once."""
    u = np.arange(100) * 2 * pi / 100
    inside = smooth(np.column_stack([2.0 * np.cos(u), np.sin(u)]), True, -1, 1e-7)
    r = 0.8
    got = touches(inside, True, -1, r)
    assert len(got) == 2
    c = np.sqrt((1 - r * r) * 3)  # the centre of the ball that touches twice
    c += 1e-3
    v = np.linspace(0, pi, 200001)
    near = np.hypot(2 * np.cos(v) - c, np.sin(v)).min()
    assert depths(got, [[c, 0.0]], r)[0] == pytest.approx([r - near] * 2, abs=2e-6)


@pytest.mark.parametrize("points, corner, closed, side, r, what", [
    ([[-1, 0.02], [0, 0], [1, 0.02]], 0.0, False, 1, 0.1, "nearly one"),
    ([[0, 0], [1, 0], [1, 0.3], [0, 0.3]], 0.0, True, -1, 0.3, "fits nowhere"),
    ([[0, 0], [1, 0], [1, 0.3], [0, 0.3]], 0.0, True, -1, 1e-6, "too small"),
    ([[-1, 1], [0, 0], [1, 1]], 0.09, False, 1, 0.1, "nearly one"),
])  # fmt: skip
def test_what_is_refused(points, corner, closed, side, r, what):
    with pytest.raises(Flaw, match=what):
        touches(profile(points, corner, closed, side, inward=True), closed, side, r)


def test_a_star_of_too_many_touches():
    """A ball that touches the tips of many teeth at once."""
    u = np.arange(40) * pi / 20
    R = np.where(np.arange(40) % 2, 0.4, 0.3)
    star = np.column_stack([R * np.cos(u), R * np.sin(u)])
    with pytest.raises(Flaw, match="places at once"):
        touches(profile(star, 0.0, True, -1, inward=True), True, -1, 0.31)


def test_a_flank_reaches_to_the_corner():
    """Pressed deep into one flank of a shallow groove, the ball meets the other one near the
    corner: it is felt by its distance from that line there too."""
    half, r = 1.3, 0.1
    got = touches(vee(half), False, 1, r)
    one, other = np.array([[cos(half), sin(half)], [-cos(half), sin(half)]])  # normals of flanks
    place = np.linalg.solve([one, other], [0.93 * r, 0.999 * r])
    assert sorted(depths(got, [place], r)[0]) == pytest.approx([0.001 * r, 0.07 * r], abs=1e-12)


@pytest.mark.parametrize("size", [1e-3, 1.0, 1e3])
def test_touches_are_as_many_in_any_unit(size):
    half, r = 0.5, 0.05
    got = touches(vee(half, long=size), False, 1, r * size)
    assert len(got) == 2
    depth = depths(got, [[0.0, r * size / sin(half)]], r * size)
    assert depth == pytest.approx(0.0, abs=1e-9 * size)
