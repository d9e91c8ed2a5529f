"""Functions in a flat array, against Python's own arithmetic and against differences."""

import math

import numpy as np
import pytest
from hypothesis import assume, example, given, settings
from hypothesis import strategies as st

from trsim.expressions import parse
from trsim.laws.functions import (
    constant,
    expression,
    motion,
    table,
    value,
    value_and_rate,
)

from ..sizes import size

SENSORS = {"stroke": 2, "door_angle": 0}
NO_SENSORS = np.zeros((0, 2))


def clip(x):
    return min(max(x, 0.0), 1.0)


def smoothstep(x):
    return clip(x) ** 2 * (3 - 2 * clip(x))


def quintic(x):
    return clip(x) ** 3 * (10 - 15 * clip(x) + 6 * clip(x) ** 2)


def stepped(core):
    return lambda x, x0, h0, x1, h1: h0 + (h1 - h0) * core((x - x0) / (x1 - x0))


WORDS = {name: getattr(math, name) for name in ("sqrt", "sin", "cos", "tan", "atan2", "exp", "log")}
WORDS |= {"asin": math.asin, "acos": math.acos, "floor": lambda x: float(math.floor(x))}
WORDS |= {"sign": lambda x: float((x > 0) - (x < 0))}
WORDS |= {"min": min, "max": max, "abs": abs, "smoothstep": smoothstep, "pi": math.pi}
WORDS |= {"step": stepped(smoothstep), "step5": stepped(quintic), "__builtins__": {}}


def by_python(node, names):
    """The tree, evaluated the slow way; raises where Python does."""
    kind, word, *rest = node
    if kind == "number":
        return word
    if kind == "name":
        return names[word]
    if kind == "call":
        return float(WORDS[word](*(by_python(a, names) for a in rest[0])))
    if kind == "unary":
        return -by_python(rest[0], names)
    a, b = (by_python(x, names) for x in rest)
    if word == "**":
        return math.pow(a, b)
    return float(eval(f"a {word} b", {"a": a, "b": b}))  # noqa: S307


def trees(names):
    leaf = st.one_of(
        st.builds(lambda x: ("number", x), st.floats(-4, 4).map(lambda x: round(x, 3))),
        st.sampled_from([("name", name) for name in names]),
    )

    def grow(inner):
        signs = st.sampled_from(["+", "-", "*", "/", "**", "<", "<=", ">", ">=", "==", "!="])
        words = st.sampled_from(["abs", "sqrt", "sin", "cos", "tan", "exp", "log", "smoothstep",
                                 "asin", "acos", "floor", "sign"])  # fmt: skip
        pairs = st.sampled_from(["min", "max", "atan2"])
        steps = st.sampled_from(["step", "step5"])
        return st.one_of(
            st.builds(lambda s, a, b: ("binary", s, a, b), signs, inner, inner),
            st.builds(lambda a: ("unary", "-", a), inner),
            st.builds(lambda w, a: ("call", w, (a,)), words, inner),
            st.builds(lambda w, a, b: ("call", w, (a, b)), pairs, inner, inner),
            st.builds(lambda w, *a: ("call", w, a), steps, inner, *[leaf] * 4),
        )

    return st.recursive(leaf, grow, max_leaves=12)


# its first argument is 0 but for rounding, and it is as narrow as that
STEP_OF_ROUNDING = (
    "call",
    "step",
    (
        (
            "call",
            "step5",
            (
                ("number", 0.0), ("number", -1.0), ("number", 1.0), ("name", "stroke"),
                ("number", 0.0),
            ),
        ),
        ("number", 0.0), ("number", 0.0), ("name", "stroke"), ("number", 1.0),
    ),
)  # fmt: skip


def agree(got, expected):
    return got == pytest.approx(expected, rel=1e-9, abs=1e-9)


def moved(node, by):
    """The expression with each of its numbers moved by at most `by`, up and down in turn."""
    if isinstance(node, tuple):
        if node[0] == "number":
            return ("number", node[1] + by)
        return tuple(moved(part, -by if k % 2 else by) for k, part in enumerate(node))
    return node


def next_to(node, names):
    """Values of the expression at numbers and names moved by rounding."""
    for by in (1e-13, -1e-13):
        for shift in (by, -by):
            try:
                yield by_python(moved(node, by), {name: x + shift for name, x in names.items()})
            except (ArithmeticError, ValueError):
                continue


@settings(max_examples=size(150, 400), deadline=None)
@given(trees(["t", "pi", "stroke", "door_angle"]), *[st.floats(-3, 3)] * 3)
@example(STEP_OF_ROUNDING, 0.0, 4.248555625442094e-16, 0.0)
def test_random_trees_against_python(node, t, stroke, angle):
    names = {"t": t, "pi": math.pi, "stroke": stroke, "door_angle": angle}
    try:
        expected = by_python(node, names)
        code = expression(node, SENSORS)
    except (ArithmeticError, ValueError):
        assume(False)
    tab = np.array([5.0, *code, 5.0])
    S = np.array([[angle, 0.0], [np.nan, np.nan], [stroke, 0.0]])
    got = value(tab, 1, t, S)
    # `step(x, 0, 0, 0, 1)` next to x = 0 is what rounding of x makes it, by Python too
    assert agree(got, expected) or any(agree(got, x) for x in next_to(node, names))
    f, _ = value_and_rate(tab, 1, t, S)
    assert f == value(tab, 1, t, S) or math.isnan(f)
    assert tab[0] == tab[-1] == 5.0


@pytest.mark.parametrize("text", ["sign(-t)", "floor(-t)", "abs(-t)"])
def test_nothing_has_no_sign(text):
    """Python's -0.0 and 0.0 are told apart by atan2 alone."""
    tab = np.array(expression(parse(text), {}))
    assert math.copysign(1.0, value(tab, 0, 0.0, np.zeros((1, 2)))) == 1.0


# every operation once, at places where it is smooth
SMOOTH = [
    "3 - t*t + 2*t",
    "1/(1 + t**2)",
    "t**3",
    "(1 + t)**-1.5",
    "(2 + t)**sin(t)",
    "2**t",
    "(t - 5)**3",
    "-cos(3*t) + tan(t/2)",
    "atan2(sin(t), 2 + t*t)",
    "exp(-t)*log(3 + t)",
    "sqrt(1 + t*t)",
    "abs(t - 9)*t",
    "min(t*t, 9, t + 40)",
    "max(t*t, -9, t - 40)*t",
    "smoothstep(t/3)",
    "step(t, -0.5, 1, 4, 7)",
    "step5(sin(t), -2, t, 3 + t, 7)",
    "t*(t > -100) + (t == 0)",
    "asin(t/2)*t",
    "acos(t*t/3 - 0.4)",
    "floor(t + 5)*t*t",
    "sign(t - 9)*t*t",
]


@pytest.mark.parametrize("text", SMOOTH)
@pytest.mark.parametrize("t", [0.31, 1.13])
def test_motion_derivatives_against_differences(text, t):
    tab = np.array([0.0, 0.0, *expression(parse(text), {})])
    f, f1, f2 = motion(tab, 2, t)
    assert f == pytest.approx(value(tab, 2, t, NO_SENSORS), rel=1e-15)
    h = 1e-5
    high, low = motion(tab, 2, t + h), motion(tab, 2, t - h)
    assert f1 == pytest.approx((high[0] - low[0]) / (2 * h), rel=1e-8, abs=1e-8)
    assert f2 == pytest.approx((high[1] - low[1]) / (2 * h), rel=1e-8, abs=1e-8)


@settings(max_examples=size(60, 150), deadline=None)
@given(trees(["t"]), st.floats(-2, 2))
def test_random_trees_have_consistent_derivatives(node, t):
    try:
        tab = np.array(expression(node, {}))
    except ValueError:
        assume(False)
    h = 1e-6
    rows = np.array([motion(tab, 0, t + k * h) for k in (-2, -1, 0, 1, 2)])
    # away from corners and poles, where forward and backward differences agree
    assume(np.isfinite(rows).all() and np.abs(rows).max() < 1e3)
    for k in (0, 1):
        slopes = np.diff(rows[:, k]) / h
        assume(np.ptp(slopes) < 1e-4)
        # beside t: two corners may cancel at t itself, as those of min(abs(t), -t) do at 0
        for beside in (1, 3):
            assert rows[beside, k + 1] == pytest.approx(slopes.mean(), abs=1e-4)


def test_rate_goes_through_sensors():
    tab = np.array(expression(parse("t*stroke**2 + sin(door_angle)"), SENSORS))
    S = np.array([[0.4, 3.0], [0.0, 0.0], [1.5, -2.0]])
    f, f1 = value_and_rate(tab, 0, 2.0, S)
    assert f == pytest.approx(2 * 1.5**2 + math.sin(0.4))
    assert f1 == pytest.approx(1.5**2 + 2 * 2 * 1.5 * -2.0 + math.cos(0.4) * 3.0)
    assert np.isnan(motion(tab, 0, 2.0)).all()


def test_derivatives_at_rest_are_finite():
    # a fixed exponent, a root and a base of zero that do not move
    for text in ("0**(t*0 + 2) + t", "sqrt(0*t) + t", "t**1", "t**2", "(0*t)**0.5 + t"):
        assert np.isfinite(motion(np.array(expression(parse(text), {})), 0, 0.0)).all()
    assert motion(np.array(expression(parse("t**2"), {})), 0, 0.0) == (0.0, 0.0, 2.0)
    assert motion(np.array(expression(parse("t**3"), {})), 0, 0.0) == (0.0, 0.0, 0.0)


def test_the_drawn_load_case():
    tab = np.array(expression(parse("2000*smoothstep((stroke - 0.15)/0.325)"), SENSORS))
    S = np.zeros((3, 2))
    for stroke, force in [(0.0, 0.0), (0.15, 0.0), (0.3125, 1000.0), (0.475, 2000.0), (9, 2000.0)]:
        S[2] = stroke, 0.5
        assert value(tab, 0, 0.0, S) == pytest.approx(force, abs=1e-9)
    S[2] = 0.3125, 0.5
    assert value_and_rate(tab, 0, 0.0, S)[1] == pytest.approx(2000 * 1.5 / 0.325 * 0.5)


def test_tables_of_time_and_of_a_sensor():
    x, y = np.array([0.0, 1.0, 2.0, 4.0]), np.array([0.0, 2.0, 1.0, 5.0])
    S = np.array([[0.0, 0.0], [1.6, 3.0]])
    of_t, of_s = table(x, y), table(x, y, 1, "extrapolate")
    tab = np.array([*of_t, *of_s])
    f, f1, f2 = motion(tab, 0, 1.6)
    assert value(tab, 0, 1.6, S) == f == value(tab, len(of_t), 99.0, S)
    assert value_and_rate(tab, 0, 1.6, S) == (f, f1)
    assert value_and_rate(tab, len(of_t), 99.0, S) == (f, 3.0 * f1)
    h = 1e-5
    assert f1 == pytest.approx((motion(tab, 0, 1.6 + h)[0] - motion(tab, 0, 1.6 - h)[0]) / (2 * h))
    assert f2 == pytest.approx((motion(tab, 0, 1.6 + h)[1] - motion(tab, 0, 1.6 - h)[1]) / (2 * h))
    assert value(tab, 0, 9.0, S) == 5.0
    S[1, 0] = 9.0
    assert value(tab, len(of_t), 0.0, S) > 10.0
    assert np.isnan(motion(tab, len(of_t), 0.0)).all()


def test_constants():
    assert expression(parse("2*pi/4"), {}) == constant(math.pi / 2)
    tab = np.array(constant(3.5))
    assert value(tab, 0, 1.0, NO_SENSORS) == 3.5
    assert value_and_rate(tab, 0, 1.0, NO_SENSORS) == (3.5, 0.0)
    assert motion(tab, 0, 1.0) == (3.5, 0.0, 0.0)


def test_names_alone_and_zero_of_either_sign():
    S = np.array([[0.7, 2.0]])
    assert value_and_rate(np.array(expression(("name", "t"), {})), 0, 4.0, S) == (4.0, 1.0)
    assert value_and_rate(np.array(expression(("name", "a"), {"a": 0})), 0, 4.0, S) == (0.7, 2.0)
    zeros = ("call", "atan2", (("number", 0.0), ("name", "t")))
    other = ("call", "atan2", (("number", -0.0), ("name", "t")))
    tab = np.array(expression(("binary", "-", zeros, other), {}))
    assert value(tab, 0, -1.0, S) == pytest.approx(2 * math.pi)


def test_equal_parts_are_computed_once():
    once = expression(parse("sin(t)"), {})
    assert expression(parse("sin(t)*sin(t)"), {})[2] == once[2] + 1


@pytest.mark.parametrize(
    "node, message",
    [
        (("name", "stork"), "nothing here is called 'stork'.  Known: t, pi, stroke"),
        (("binary", "/", ("number", 1.0), ("number", 0.0)), "infinite or undefined"),
        (("binary", "/", ("name", "t"), ("number", 0.0)), "divides by zero"),
        (("call", "log", (("number", -1.0),)), "infinite or undefined"),
        (("call", "open", (("number", 1.0),)), "no function open of 1 argument"),
        (("call", "step", (("name", "t"),)), "no function step of 1 argument"),
    ],
)
def test_what_cannot_be_a_function_is_refused(node, message):
    with pytest.raises(ValueError, match=message):
        expression(node, SENSORS)
