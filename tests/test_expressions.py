"""Expressions: what is allowed gives Python's own numbers, everything else is refused."""

import math

import pytest
from hypothesis import given
from hypothesis import strategies as st

from trsim.errors import ScenarioError
from trsim.expressions import DEEPEST, degree, evaluate, names, parse, substitute, written


def test_a_name_may_be_that_of_a_function():
    """`floor` was a name of bodies and joints before it was a function."""
    assert evaluate(parse("floor(floor + 0.75)*sign"), {"floor": 2.5, "sign": 2.0}) == 6.0


def test_nodes():
    assert parse("2*stroke + B.angle") == (
        "binary",
        "+",
        ("binary", "*", ("number", 2.0), ("name", "stroke")),
        ("name", "B.angle"),
    )
    assert parse("-sin(t)") == ("unary", "-", ("call", "sin", (("name", "t"),)))


@pytest.mark.parametrize(
    "text, value",
    [
        ("2 + 3*4**2/8 - 1", 7.0),
        ("-2**2", -4.0),
        ("+x", 3.0),
        ("2**-1", 0.5),
        ("(x > 2)*(x <= 3) + (x == 3) + (x != 3) + (x >= 4) + (x < 0)", 2.0),
        ("min(3, x, 1) + max(x, 5)", 6.0),
        ("abs(-2) + sqrt(9) + exp(0) + log(1)", 6.0),
        ("sin(pi/2) + cos(pi) + tan(0) + atan2(0, 1)", 0.0),
        ("smoothstep(0.25) + smoothstep(-1) + smoothstep(7)", 0.15625 + 1.0),
        ("step(x, 2, 10, 4, 20)", 15.0),
        ("step(x, 4, 20, 2, 10)", 15.0),
        ("step5(2.5, 2, 10, 4, 20)", 10 + 10 * (10 / 64 - 15 / 256 + 6 / 1024)),
        ("step5(9, 2, 10, 4, 20)", 20.0),
        ("havsin(2.5, 2, 10, 4, 20)", 15 - 5 * math.sqrt(0.5)),
        ("sign(0)", 0.0),
        ("sign(3) + 4*sign(-3)", -3.0),
        ("floor(-0.5) + 4*floor(2)", 7.0),
        ("asin(0.5)", math.pi / 6),
        ("acos(-0.5)", 2 * math.pi / 3),
        ("havsin(1, 2, 10, 4, 20) + havsin(9, 2, 10, 4, 20)", 30.0),
        ("A.b.c + 1e-3", 5.001),
    ],
)
def test_value(text, value):
    values = {"x": 3.0, "A.b.c": 5.0}
    assert evaluate(parse(text), values) == pytest.approx(value, abs=1e-15)
    folded = substitute(parse(text), values)
    assert folded == ("number", evaluate(parse(text), values))


@pytest.mark.parametrize(("text", "wanted"), [
    ("3", 0), ("pi*2", 0), ("x", 1), ("-x + 2", 1), ("x*(y - 1)", 2), ("x**3/2", 3),
    ("(x*y)**2", 4),
    ("x**0", 0), ("x < 2", 0), ("(x < 2)*x", 1), ("min(x, y**2, 3)", 2), ("abs(x - 1)", 1),
    ("smoothstep((x - 1)/3)", 3), ("step(x, 0, 0, 1, 5)", 3), ("step5(x, 0, 0, 1, 5)", 5),
    ("2000*smoothstep((stroke - 0.15)/0.325)", 3),
    ("exp(x)", math.inf), ("sin(50*x) > 0.99", math.inf), ("1/x", math.inf), ("x**0.5", math.inf),
    ("x**-1", math.inf), ("2**x", math.inf), ("x**y", math.inf), ("sqrt(x)", math.inf),
    ("step(x, y, 0, 1, 5)", math.inf), ("max(x, cos(x))", math.inf),
])  # fmt: skip
def test_degree(text, wanted):
    """Of the polynomials that it is made of between its corners."""
    assert degree(parse(text)) == wanted


def test_names_and_substitute():
    node = parse("speed*t + pi*min(B.x, speed)")
    assert names(node) == {"speed", "t", "pi", "B.x"}
    rest = substitute(node, {"speed": 2.0})
    assert names(rest) == {"t", "B.x"}
    assert evaluate(rest, {"t": 3.0, "B.x": 1.0}) == 6.0 + math.pi


REFUSED = {
    "9**9**9": "9 ** 3.8742e+08 has no finite value",
    "10.0**400*x": "10 ** 400 has no finite value",
    "open(x)": "no function named 'open'",
    "open('/etc/passwd')": '"\'" cannot stand in an expression',
    "__import__(x)": "no function named '__import__'",
    "().__class__.__bases__": "a dot may follow a name only",
    "t.__class__": "not a name: 't.__class__'",
    "x.y()": "only the listed functions can be called, by position",
    "f.g(1)": "only the listed functions can be called, by position",
    "sin(1)(2)": "only the listed functions can be called, by position",
    "sin(x=1)": "only the listed functions can be called, by position",
    "sin(*x)": "not allowed in an expression: '*x'",
    "lambda: 1": "':' cannot stand in an expression",
    "[x for x in y]": "'[' cannot stand in an expression",
    "(x := 1)": "':' cannot stand in an expression",
    "a and b": "not allowed in an expression: 'and': multiply comparisons, or use min",
    "a or b": "not allowed in an expression: 'or': add comparisons, or use max",
    "not x": "not allowed in an expression: 'not': write 1 - x",
    "a if b else c": "not allowed in an expression: 'if': multiply by a comparison, or use step",
    "a < b < c": "comparison of three",
    "x^2": "'^' cannot stand in an expression",
    "x % 2": "'%' cannot stand in an expression",
    "x // 2": "not allowed in an expression: '//'",
    "x is y": "not allowed in an expression: 'x is y'",
    "1, 2": "not allowed in an expression: a comma outside a function (a decimal point is '.')",
    "True": "not allowed in an expression: 'True'",
    "1j": "not allowed in an expression: '1j'",
    "sin": "sin is a function: write sin(...)",
    "sin(1, 2)": "sin takes 1 argument, got 2",
    "min(1)": "min takes 2 or more arguments, got 1",
    "1/0": "1 / 0 has no finite value",
    "x + sqrt(-1)": "sqrt(-1) has no finite value",
    "(-8)**(1/3)": "-8 ** 0.333333 has no finite value",
    "step(t, 1, 0, 1, 5)": "step from x0 to x1 = x0",
    "1e999": "a number in an expression is too large",
    "9" * 999: "a number in an expression is too large",
    "1+" * 600 + "1": "expression of 1201 characters; at most 1000",
    "-" * 900 + "1": f"expression nested more than {DEEPEST} deep",
    "x\0": "'\\x00' cannot stand in an expression",
    "\u017fin(1)": "'\u017f' cannot stand in an expression",
}


@pytest.mark.parametrize("text", REFUSED, ids=lambda text: text[:30])
def test_refused(text):
    with pytest.raises(ScenarioError) as caught:
        parse(text)
    assert caught.value.what == REFUSED[text]


@pytest.mark.parametrize("text", ["", "x y", "(((", "(" * 900, "1+", "010 + 1", "x\n\n("])
def test_not_an_expression(text):
    with pytest.raises(ScenarioError, match="not an expression"):
        parse(text)


@pytest.mark.parametrize(
    "text",
    [
        "1/(x - 1)", "a - (b - c)", "a/(b*c)", "(-x)**2", "-x**2", "2**-1.5*x", "(a < b) < c",
        "a < b + c", "x*(y > 2)", "step(t, 0, 0.1, 1, 2e-7)", "(a**b)**c", "a**b**c", "-(a + b)",
        "B.angle - 2*(a + 1e-30)",
    ],
)  # fmt: skip
def test_written_is_read_as_the_same(text):
    assert parse(written(parse(text))) == parse(text)


def test_misspelt_function():
    with pytest.raises(ScenarioError) as caught:
        parse("smothstep(t)")
    assert caught.value.hint.startswith("Did you mean 'smoothstep'?")


def test_no_value():
    with pytest.raises(ScenarioError, match="no value for 'x'"):
        evaluate(parse("x + 1"), {"y": 1.0})
    with pytest.raises(ScenarioError, match="1 / 0 has no finite value"):
        evaluate(parse("1/x"), {"x": 0.0})


@given(st.text("0123456789.e+-*/()<>=!, xtpisincomax_B", max_size=60))
def test_nothing_but_a_node_or_a_scenario_error(text):
    try:
        node = parse(text)
        assert math.isfinite(evaluate(node, dict.fromkeys(names(node), 0.5)))
    except ScenarioError:
        pass
