"""A number that may vary, as a user writes it: a number, an expression, a table.

    force: Function("N")                              of t and of sensors
    elastic: Function("N", of="stretch")              of a variable of its own

An expression has its parameters replaced by their values; a table has its columns in SI units.
"""

import math
from dataclasses import dataclass, replace
from typing import Annotated, Any, Literal

from pydantic_core import core_schema

from trsim import expressions
from trsim.errors import ScenarioError, check_keys, described, within
from trsim.fields import Unit
from trsim.numbers import number, written
from trsim.units import check_dimension, quantity, titled, unit


@dataclass(frozen=True)
class FunctionSpec:
    """A number that may vary: a constant, an expression of t and sensors, or a table."""

    kind: Literal["constant", "expression", "table"]
    value: float = 0.0  # of a constant
    node: tuple = ()  # of an expression, parameters replaced by their values
    x: tuple[float, ...] = ()  # of a table
    y: tuple[float, ...] = ()
    of: str = "t"  # the variable of a table: t or a sensor
    ends: Literal["hold", "extrapolate", "refuse"] = "hold"
    interpolation: Literal["akima", "linear", "spline"] = "akima"
    units: tuple[str, str] = ("", "")  # of x and y as written; of a constant the second

    def scaled(self, factor: float) -> "FunctionSpec":
        """`factor` times it."""
        if self.kind == "constant" or factor == 0.0:
            value = factor * self.value if factor else 0.0
            return FunctionSpec("constant", value, units=self.units)
        if self.kind == "table":
            return replace(self, y=tuple(factor * y for y in self.y))
        return replace(self, node=("binary", "*", ("number", factor), self.node))

    @property
    def inputs(self) -> frozenset[str]:
        """What it depends on beside t: sensors and their rates, `stroke` and `stroke.rate`."""
        found = {self.of} if self.kind == "table" else set()
        if self.kind == "expression":
            found = expressions.names(self.node)
        return frozenset(found - {"t", "pi"})

    @property
    def sensors(self) -> frozenset[str]:
        """The sensors it depends on, by themselves or by their rates."""
        return frozenset(name.removesuffix(RATE) for name in self.inputs)


OUTSIDE = {"hold": "hold", "extend": "extrapolate", "error": "refuse"}  # word -> what it means
ENDS = ("hold", "extrapolate", "refuse")  # the same by the key `ends`
INTERPOLATIONS = ("akima", "linear", "spline")
TABLE_KEYS = ("table", "of", "interpolation", "outside", "ends", "units")
RATE = ".rate"  # behind the name of a sensor
VARIABLES = ("s", "m", "rad", "m/s", "rad/s")  # units of what a table may be a function of


class Column:
    """A column of a table: the unit all its numbers have, or else each its own of one kind."""

    def __init__(self, text: str, allowed: tuple[str, ...]) -> None:
        self.unit, self.allowed, self.whole = text, allowed, bool(text)
        self.factor = float(unit(text)[0]) if text else 1.0

    def number(self, item: Any, parameters: dict) -> float:
        """The SI value of an entry.  Raises ScenarioError, also for a unit that does not fit."""
        found = written(item, parameters, self.allowed) if isinstance(item, str) else None
        if found and found[1]:
            if self.whole:
                what = f"{described(item)} has a unit, and so has its column: {self.unit}"
                raise ScenarioError(what, "Write one of the two.")
            self.unit = self.unit or found[1]
            if unit(found[1])[1] != unit(self.unit)[1]:
                what = f"a column has one kind of unit, not {self.unit} and {found[1]}"
                raise ScenarioError(what)
        return number(item, self.allowed, parameters) * self.factor


class _FunctionUnit(Unit):
    def __init__(self, *units: str, of: str = "") -> None:
        super().__init__(*units)
        self.of = of  # the one variable it may have; else t and sensors

    def __get_pydantic_core_schema__(self, source: Any, handler: Any) -> Any:
        def convert(value: Any, info: Any) -> Any:
            return self.convert(value, info.context or {})

        return core_schema.with_info_plain_validator_function(convert)

    def __get_pydantic_json_schema__(self, schema: Any, handler: Any) -> Any:
        return {"anyOf": [{"type": "number"}, {"type": "string"}, {"type": "object"}]}

    def convert(self, value: Any, context: dict, words: tuple[str, ...] = ()) -> Any:
        parameters, names = context.get("parameters") or {}, context.get("names") or {}
        if isinstance(value, FunctionSpec):
            return value
        if self.of:
            return self._of_one(value, parameters)
        return self._read(value, parameters, names)

    def _of_one(self, value: Any, parameters: dict) -> FunctionSpec:
        """A function of a variable of its own."""
        if self.of in parameters:
            what = f"`{self.of}` means what this is a function of, and is the name of a parameter"
            raise ScenarioError(what, "Give the parameter another name.")
        if isinstance(value, dict):
            value = {"of": self.of, **value}
        found = self._read(value, parameters, {})
        if others := sorted((found.inputs | _of_t(found)) - {self.of}):
            what = f"'{others[0]}' cannot stand here: this is a function of `{self.of}` alone"
            raise ScenarioError(what, "What depends on others is an applied_load.")
        return found

    def _read(self, value: Any, parameters: dict, names: dict) -> FunctionSpec:
        if isinstance(value, dict):
            return self._table(value, parameters, names)
        if isinstance(value, str) and quantity(value, {"t", *parameters}, self.units) is None:
            node = expressions.substitute(expressions.parse(value), parameters)
            if node[0] != "number":
                return FunctionSpec("expression", node=expressions.renamed(node, names))
        if not isinstance(value, str | int | float):
            what = "must be a number, an expression or a table"
            raise ScenarioError(f"{what}, got {described(value)}")
        return FunctionSpec("constant", number(value, self.units, parameters))

    def _table(self, given: dict, parameters: dict, names: dict) -> FunctionSpec:
        """{table: [[x, y], ...], of: stroke, outside: hold, units: [mm, N]}

        The units may also stand in a first row of titles, as in a file: ["s [mm]", "force [N]"].
        """
        check_keys(given, TABLE_KEYS)
        if "table" not in given:
            raise ScenarioError("field required: table", "A table is {table: [[x, y], ...]}.")
        of, ends, way = given.get("of", "t"), _outside(given), given.get("interpolation", "akima")
        if not isinstance(of, str):
            raise ScenarioError("must be t or the name of a sensor", path=("of",))
        if way not in INTERPOLATIONS:
            what = f"must be one of {', '.join(INTERPOLATIONS)}, got {described(way)}"
            raise ScenarioError(what, path=("interpolation",))
        rows, own, head = given["table"], given.get("units"), ()
        if isinstance(rows, list) and rows and _is_head(rows[0]):
            head, rows = rows[0], rows[1:]
            own = within("table", within, 0, _of_titles, head, own)
        columns = within("table" if head else "units", self._own, own)
        x, y, units = within("table", self._columns, rows, columns, parameters, bool(head))
        first, dot, rest = of.partition(".")
        of = names.get(first, first) + dot + rest
        return FunctionSpec("table", x=x, y=y, of=of, ends=ends, units=units, interpolation=way)

    def _own(self, units: Any) -> list[Column]:
        """The two columns with the units they have as a whole; without: each number its own."""
        if units is None:
            units = ["", ""]
        if not isinstance(units, list) or [type(text) for text in units] != [str, str]:
            raise ScenarioError("must be two units, [of x, of y]")
        allowed = (VARIABLES, self.units)
        for k, text in enumerate(units):
            if text:
                within(k, check_dimension, text, allowed[k])
        return [Column(*pair) for pair in zip(units, allowed, strict=True)]

    def _columns(self, rows: Any, columns: list[Column], parameters: dict, headed: bool) -> Any:
        """x, y and their units as written; headed: whether there was a row of titles as well."""
        if not isinstance(rows, list | tuple) or len(rows) < 2:
            raise ScenarioError(f"must be two or more rows [x, y], got {described(rows)}")
        last = -math.inf
        points = []
        for k, row in enumerate(rows, headed):
            if not isinstance(row, list | tuple) or len(row) != 2:
                raise ScenarioError(f"a row is [x, y], got {described(row)}", path=(k,))
            if not all(isinstance(item, str | int | float) for item in row):
                raise ScenarioError("a row is two numbers", path=(k,))
            pairs = enumerate(zip(columns, row, strict=True))
            x, y = (
                within(k, within, j, column.number, item, parameters) for j, (column, item) in pairs
            )
            if x <= last:
                raise ScenarioError(f"x must rise, got {x:g} after {last:g}", path=(k,))
            last = x
            points.append((x, y))
        return *zip(*points, strict=True), tuple(column.unit for column in columns)


def _outside(given: dict) -> Any:
    """What a table is outside of its rows, by its key `outside` or `ends`."""
    if "outside" in given and "ends" in given:
        raise ScenarioError("give `outside` or `ends`, which say the same", path=("ends",))
    for key, words in (("outside", tuple(OUTSIDE)), ("ends", ENDS)):
        if key in given and given[key] not in words:
            what = f"must be one of {', '.join(words)}, got {described(given[key])}"
            raise ScenarioError(what, path=(key,))
    if "outside" in given:
        return OUTSIDE[given["outside"]]
    return given.get("ends", "hold")


def _is_head(row: Any) -> bool:
    """Whether a row of a table is one of titles: two texts, one of which ends with a bracket."""
    if not isinstance(row, list) or [type(item) for item in row] != [str, str]:
        return False
    return any(text.rstrip().endswith("]") for text in row)


def _of_titles(head: list[str], own: Any) -> Any:
    """The units in a row of titles; `own`, the key `units`, must not say something else."""
    found = [within(k, titled, text)[1] for k, text in enumerate(head)]
    others = own if isinstance(own, list) and len(own) == 2 else found
    for k, (text, other) in enumerate(zip(found, others, strict=True)):
        if text and other and text != other:
            what = f"the title says {text}, `units` says {described(other)}"
            raise ScenarioError(what, "Leave out `units` where titles tell.", (k,))
    return [text or other for text, other in zip(found, others, strict=True)]


def _of_t(f: FunctionSpec) -> set[str]:
    """`t` where a function depends on it."""
    used = {f.of} if f.kind == "table" else expressions.names(f.node) if f.node else set()
    return used & {"t"}


def Function(*units: str, of: str = "") -> Any:
    """The type of a number that may vary with t and with sensors: see FunctionSpec.

    of: with one variable of its own instead, which has this name.
    """
    return Annotated[FunctionSpec, _FunctionUnit(*units, of=of)]
