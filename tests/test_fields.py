"""Numbers as users write them: quantities, dimensions, expressions of parameters, tables."""

import json
import math
from typing import Annotated, Literal

import pytest
from annotated_types import Ge
from pydantic import ValidationError
from pydantic_core import ValidationError as CoreError

from trsim.errors import ScenarioError
from trsim.fields import Flag, Spec, SpecError, Unit, direction, number, vector
from trsim.units import BASE, DERIVED, quantity, unit
from trsim.varying import Function, FunctionSpec

EXACT = {
    "0.3 mm": 0.0003,
    "0.7mm": 0.0007,
    "207 GPa": 207e9,
    "0.1 ms": 1e-4,
    "1e-3": 1e-3,
    "0.5 m/s": 0.5,
    "2000 N/mm": 2e6,
    "5 N*m": 5.0,
    "3 N*m/rad": 3.0,
    "3 N·mm": 3e-3,
    "2 kg*m^2": 2.0,
    "2 kg*m**2": 2.0,
    "2 m/s²": 2.0,
    "-5.5e2 N/mm^2": -5.5e8,
    "1/s": 1.0,
    "5/s": 5.0,
    "20 1/s": 20.0,
    "2 1/(m*s)": 2.0,
    "4 m/s/s": 4.0,
    "3 s^-2": 3.0,
    "50 %": 0.5,
    "1 g0": 9.80665,
    "2 t": 2000.0,
    ".5 µm": 5e-7,
}


@pytest.mark.parametrize("text", EXACT)
def test_quantity(text):
    assert quantity(text)[0] == EXACT[text]


@pytest.mark.parametrize(
    "text, value",
    [
        ("5000 rpm", 5000 * 2 * math.pi / 60),
        ("90 deg", math.pi / 2),
        ("2 rev", 4 * math.pi),
        ("60 kt", 30.8666667),
        ("1 lbf", 4.4482216),
        ("1 psi", 6894.757),
        ("1 N/mm^1.5", 1000**1.5),
    ],
)
def test_inexact_quantity(text, value):
    assert quantity(text)[0] == pytest.approx(value, rel=1e-7)


def test_every_unit_has_a_factor():
    for word in [*BASE, *DERIVED]:
        assert unit(word)[0] > 0


@pytest.mark.parametrize("text", ["speed", "2*speed", "2 * 3", "-x", "2(3)", "2 < 3", "1/2", ""])
def test_no_quantity(text):
    assert quantity(text) is None


def test_a_parameter_called_s_makes_it_an_expression():
    assert number("5/s", ("1/s",)) == 5.0
    assert number("5/s", ("1/s",), {"s": 2.0}) == 2.5
    assert number("5 m/s", ("m/s",), {"s": 2.0}) == 5.0


@pytest.mark.parametrize(
    "value, units, what",
    [
        ("5 N", ("m",), "wrong unit: 'N' is a force; this number is a length, in m"),
        ("10 Hz", ("rad/s",), "wrong unit: 'Hz' is a frequency; this number is an angular"),
        (
            "3 N*m",
            ("N*m/rad",),
            "wrong unit: 'N*m' is a torque or an energy; this number is a tors",
        ),
        (
            "3 kg*N",
            ("rad", "m"),
            "wrong unit: 'kg*N'; this number is an angle, in rad, or a length",
        ),
        ("3 m", ("-",), "wrong unit: 'm' is a length; this number is a plain number"),
        ("3 mn", ("N",), "unknown unit 'mn'"),
        ("3 N m", ("N*m",), "not a unit: 'N m'"),
        ("3 N*", ("N",), "not a unit: 'N*'"),
        ("3 (N", ("N",), "not an expression"),
        ("3 m^99", ("m",), "not a unit: 'm^99'"),
        ("3 m^", ("m",), "not a unit: 'm^'"),
        ("3 1/(m", ("m",), "not a unit: '1/(m'"),
        ("5 N + 2", ("N",), "not a unit: 'N + 2'"),
        ("1e400", ("m",), "must be a finite number"),
        ("1e99999999999999 mm", ("m",), "must be a finite number"),
        (10**400, ("m",), "must be a finite number"),
        (math.nan, ("m",), "must be a finite number"),
        (-math.inf, ("m",), "must be a finite number"),
        (True, ("m",), "must be a number, got true"),
        ("nan", ("m",), "no parameter named 'nan'"),
        ("sped", ("m/s",), "no parameter named 'sped'"),
        ("2*t", ("m/s",), "this number cannot depend on t"),
        ("0,3 mm", ("m",), "not an expression: '0,3 mm'"),
        ("9**9**9", ("m",), "9 ** 3.8742e+08 has no finite value"),
        ("010 mm", ("m",), "a number does not begin with 0: '010 mm'"),
    ],
)
def test_refused_number(value, units, what):
    with pytest.raises(ScenarioError) as caught:
        number(value, units, {"speed": 1.0})
    assert caught.value.what.startswith(what)


def test_hints_of_numbers():
    for value, hint in (
        ("sped", "Did you mean 'speed'?"),
        ("3 mps", "This number is a speed, in m/s."),
        (True, "This number is a speed, in m/s."),
        ("0,3 mm", "This number is a speed, in m/s.  A decimal point is '.'"),
    ):
        with pytest.raises(ScenarioError) as caught:
            number(value, ("m/s",), {"speed": 1.0})
        assert caught.value.hint.startswith(hint)


def test_a_plain_number_is_an_angle_in_rad():
    assert number("0.5", ("rad",)) == 0.5
    assert number("50 %", ("rad",)) == 0.5


class Example(Spec):
    stiffness: Annotated[float, Ge(0), Unit("N*m/rad")] = 1.0
    law: Annotated[Literal["internal", "paper"] | Annotated[float, Ge(0)], Unit("N/m^1.5")] = 1.0
    span: Annotated[tuple[float, float], Unit("m")] = (0.0, 1.0)
    at: vector("m") = (0.0, 0.0, 0.0)
    points: tuple[vector("m"), ...] = ()
    force: Function("N") | None = None
    free: Flag = False


def example(**given):
    return Example.model_validate(given, context={"parameters": {"speed": 2.0}})


def test_fields():
    spec = example(
        stiffness="2*speed",
        law="paper",
        span=["1 mm", "speed"],
        at=["1 cm", 2],
        points=[[1, 2], [3, "4 mm", 5]],
    )
    assert spec.stiffness == 4.0
    assert spec.law == "paper"
    assert spec.span == (0.001, 2.0)
    assert spec.at == (0.01, 2.0, 0.0)
    assert spec.points == ((1.0, 2.0, 0.0), (3.0, 0.004, 5.0))
    assert example(law="2 N/m^1.5").law == 2.0
    with pytest.raises(CoreError):
        spec.stiffness = 2.0


def problem(**given):
    """The one thing wrong, with its path."""
    with pytest.raises(ValidationError) as caught:
        example(**given)
    outer = caught.value.errors()[0]["ctx"]["error"]
    assert isinstance(outer, SpecError) and outer.spec is Example
    (error,) = outer.error.errors()
    return error["loc"], error.get("ctx", {}).get("error", error)


@pytest.mark.parametrize(
    "given, path, what",
    [
        ({"span": [1, "2 N"]}, (1,), "wrong unit: 'N'"),
        ({"at": [1, True]}, (1,), "must be a number, got true"),
        ({"at": 1}, (), "must be [x, y] or [x, y, z], got 1"),
        ({"at": [1]}, (), "must be [x, y] or [x, y, z], got a list of 1"),
        ({"law": "papr"}, (), "must be a number or one of the words, got 'papr'"),
        ({"free": "no"}, (), "must be true or false, got 'no'"),
        ({"free": 1}, (), "must be true or false, got 1"),
        ({"force": "5 kg"}, (), "wrong unit: 'kg' is a mass; this number is a force, in N"),
        ({"force": True}, (), "must be a number, got true"),
        ({"force": [1]}, (), "must be a number, an expression or a table, got a list of 1"),
        ({"force": "open(1)"}, (), "no function named 'open'"),
        ({"force": {}}, (), "field required: table"),
        ({"force": {"table": 1}}, ("table",), "must be two or more rows [x, y], got 1"),
        ({"force": {"table": [[0, 1]]}}, ("table",), "must be two or more rows [x, y]"),
        ({"force": {"table": [[0, 1], [0, 2]]}}, ("table", 1), "x must rise, got 0 after 0"),
        ({"force": {"table": [[0, 1], [1, "2 m"]]}}, ("table", 1, 1), "wrong unit: 'm'"),
        ({"force": {"table": [[0, 1], [1]]}}, ("table", 1), "a row is [x, y], got a list of 1"),
        ({"force": {"table": [[0, 1], [1, None]]}}, ("table", 1), "a row is two numbers"),
        ({"force": {"table": [[0, 1], [1, 2]], "of": 3}}, ("of",), "must be t or the name"),
        ({"force": {"table": [[0, 1], [1, 2]], "ends": "x"}}, ("ends",), "must be one of hold"),
        (
            {"force": {"table": [[0, 1], [1, 2]], "outside": "x"}},
            ("outside",),
            "must be one of hold",
        ),
        (
            {"force": {"table": [[0, 1], [1, 2]], "outside": "hold", "ends": "hold"}},
            ("ends",),
            "give `outside` or `ends`",
        ),
        (
            {"force": {"table": [[0, 1], [1, 2]], "interpolation": "x"}},
            ("interpolation",),
            "must be one of akima, linear, spline",
        ),
        ({"force": {"table": [[0, 1], [1, 2]], "units": ["mm", "kg"]}}, ("units", 1), "wrong unit"),
        ({"force": {"table": [[0, 1], [1, 2]], "units": "mm"}}, ("units",), "must be two units"),
        ({"force": {"table": [[0, 1], [1, 2]], "end": "hold"}}, ("end",), "unknown key 'end'"),
    ],
)
def test_refused_field(given, path, what):
    location, error = problem(**given)
    assert location[0] == next(iter(given))
    assert error.path == path
    assert error.what.startswith(what)


def test_functions():
    assert example(force=3).force == FunctionSpec("constant", 3.0)
    assert example(force="2 kN").force == FunctionSpec("constant", 2000.0)
    assert example(force="2*speed").force == FunctionSpec("constant", 4.0)
    varying = example(force="speed*t + B.angle").force
    assert varying.kind == "expression"
    assert varying.sensors == {"B.angle"}
    assert varying.node[2] == ("binary", "*", ("number", 2.0), ("name", "t"))


def test_table():
    table = example(force={"table": [[0, "1 kN"], ["20 mm", 2]], "of": "stroke"}).force
    assert (table.x, table.y) == ((0.0, 0.02), (1000.0, 2.0))
    assert (table.of, table.ends, table.sensors) == ("stroke", "hold", {"stroke"})
    table = example(force={"table": [[0, 1], [20, 2]], "units": ["mm", "kN"], "ends": "refuse"})
    assert (table.force.x, table.force.y) == ((0.0, 0.02), (1000.0, 2000.0))
    assert table.force.of == "t"
    for word, ends in (("hold", "hold"), ("extend", "extrapolate"), ("error", "refuse")):
        given = {"table": [[0, 1], [20, 2]], "outside": word, "interpolation": "spline"}
        table = example(force=given).force
        assert (table.ends, table.interpolation) == (ends, "spline")


def test_json_schema_takes_quantities():
    schema = json.loads(json.dumps(Example.model_json_schema()))["properties"]
    assert {"type": "string"} in schema["stiffness"]["anyOf"]
    assert {"minimum": 0, "type": "number"} in schema["stiffness"]["anyOf"]
    assert schema["at"]["anyOf"][0]["minItems"] == 2


@pytest.mark.parametrize("size", [1e-320, 1e-300, 1.0, 1e50])
def test_direction_of_any_size(size):
    x, y, z = direction((3 * size, 0.0, -4 * size))
    assert (x, y, z) == pytest.approx((0.6, 0.0, -0.8), rel=1e-3 if size < 1e-308 else 1e-15)
    assert math.hypot(x, y, z) == pytest.approx(1.0, abs=1e-15)
