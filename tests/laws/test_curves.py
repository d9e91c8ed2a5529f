"""Curves: what their numbers say of a circle, a spline and a formula, and the places nearest."""

import numpy as np
import pytest
from scipy.interpolate import CubicSpline

from trsim.elements.curve import Curve, sampled
from trsim.laws.curves import BEND, end_of, footpoint, length, length_of, place, touch

CIRCLE = {"x": "0.2*cos(s) + 0.1", "y": "0.2*sin(s)", "range": [0, "2*pi"], "closed": True}
POINTS = [[0, 0], [0.9, 0.3], [1.3, 1.2], [0.4, 1.6], [-0.5, 0.8]]
CURVES = {
    "circle": CIRCLE,
    "closed spline": {"points": POINTS, "closed": True},
    "natural spline": {"points": POINTS},
    "clamped spline": {"points": POINTS, "tangents": [[0, 2], [-1, -1]]},
    "parabola": {"x": "s", "y": "s**2", "range": [-1, 2]},
    "line": {"points": [[0, 0], [3, 4]]},
}


def curve(given, **more):
    return sampled(Curve.model_validate(given | more, context={"parameters": {}}))


def tab(given):
    return np.array(curve(given).numbers)


@pytest.mark.parametrize("name", CURVES)
def test_derivatives(name):
    t = tab(CURVES[name])
    end, h = end_of(t, 0), 1e-5
    for u in np.linspace(0.013, 0.987, 23) * end:
        (_, c1, c2), ahead, behind = place(t, 0, u), place(t, 0, u + h), place(t, 0, u - h)
        assert np.subtract(ahead[0], behind[0]) / (2 * h) == pytest.approx(c1, abs=1e-8)
        assert np.subtract(ahead[1], behind[1]) / (2 * h) == pytest.approx(c2, abs=1e-8)
        slope = (length(t, 0, u + h) - length(t, 0, u - h)) / (2 * h)
        assert slope == pytest.approx(np.hypot(*c1), abs=1e-8)
        assert abs(c1[0] * c2[1] - c1[1] * c2[0]) <= 1.001 * BEND * np.hypot(*c1) ** 2


@pytest.mark.parametrize("name", ["natural spline", "clamped spline", "parabola", "line"])
def test_no_jump_at_the_ends(name):
    t = tab(CURVES[name])
    for u in (0.0, end_of(t, 0)):
        for before, after in zip(place(t, 0, u - 1e-9), place(t, 0, u + 1e-9), strict=True):
            assert before == pytest.approx(after, abs=1e-8)
        assert length(t, 0, u + 1e-7) - length(t, 0, u - 1e-7) > 0.0


@pytest.mark.parametrize("name", ["circle", "closed spline"])
def test_a_closed_curve_begins_anew(name):
    t = tab(CURVES[name])
    end = end_of(t, 0)
    for u in (0.0, 0.3, end - 1e-9):
        for k in (-3, 2):
            for one, other in zip(place(t, 0, u), place(t, 0, u + k * end), strict=True):
                assert one == pytest.approx(other, abs=1e-8)
            turns = length(t, 0, u + k * end) - length(t, 0, u)
            assert turns == pytest.approx(k * length_of(t, 0), rel=1e-9)


def test_splines_are_those_of_scipy():
    """By the length of chords, with the ends asked for."""
    p = np.array(POINTS, float)
    closed = np.vstack([p, p[:1]])
    ends = {
        "closed spline": (closed, "periodic"),
        "natural spline": (p, "natural"),
        "clamped spline": (p, ((1, [0, 1]), (1, [-np.sqrt(0.5)] * 2))),
    }
    for name, (points, how) in ends.items():
        chords = np.append(0, np.cumsum(np.hypot(*np.diff(points, axis=0).T)))
        spline, t = CubicSpline(chords, points, bc_type=how), tab(CURVES[name])
        for part in np.linspace(0, 1, 57):
            c, c1, _ = place(t, 0, part * end_of(t, 0))
            assert c == pytest.approx(spline(part * chords[-1]), abs=1e-13)
            slope = spline(part * chords[-1], 1)
            along = c1[0] * slope[1] - c1[1] * slope[0]
            assert along == pytest.approx(0.0, abs=1e-12)


def test_lengths():
    assert length_of(tab(CIRCLE), 0) == pytest.approx(0.4 * np.pi, rel=1e-14)
    assert length_of(tab(CURVES["line"]), 0) == pytest.approx(5.0, rel=1e-14)
    whole = [(0.5 * s * np.sqrt(1 + 4 * s**2) + 0.25 * np.arcsinh(2 * s)) for s in (-1, 2)]
    assert length_of(tab(CURVES["parabola"]), 0) == pytest.approx(whole[1] - whole[0], rel=1e-13)


@pytest.mark.parametrize("radius", [0.01, 0.19, 0.21, 3.0])
def test_the_nearest_place_of_a_circle(radius):
    """Also from nearly half a turn away."""
    t = tab(CIRCLE)
    for angle in np.linspace(-3.1, 3.1, 9):
        p = (0.1 + radius * np.cos(1 + angle), radius * np.sin(1 + angle))
        u = footpoint(t, 0, 1 / BEND, p)
        assert u * BEND == pytest.approx(1 + angle, abs=1e-12)


def test_downhill_and_no_further():
    """A figure of eight: at its crossing the search stays on the piece it came on."""
    eight = {"x": "sin(s)", "y": "0.5*sin(2*s)", "range": [0, "2*pi"], "closed": True}
    t = tab(eight)
    per = 2 * np.pi / end_of(t, 0)
    for begin in (0.0, np.pi):
        for s in np.linspace(-0.3, 0.3, 13):
            p = place(t, 0, (begin + s) / per)[0]
            assert footpoint(t, 0, (begin - 0.4) / per, p) * per == pytest.approx(begin + s)


def test_a_line_touches_an_ellipse():
    given = {"x": "3*cos(s)", "y": "2*sin(s)", "range": [0, "2*pi"], "closed": True}
    t = tab(given)
    for angle in np.linspace(0.0, 2.5, 9):
        m = (np.cos(angle), np.sin(angle))
        c, _, _ = place(t, 0, touch(t, 0, 0.0, m))
        far = np.hypot(3 * m[0], 2 * m[1])
        assert c == pytest.approx((9 * m[0] / far, 4 * m[1] / far), abs=1e-12)
