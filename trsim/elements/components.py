"""Six components of a load in one table: rows [x, Fx, Fy, Fz, Mx, My, Mz].

x is t, a sensor or its rate, and rises.  A row of titles may stand first, with units in brackets.
Each column is a function of x; one of zeros is nothing.
"""

from math import inf
from typing import Annotated, Any, ClassVar, Literal, NamedTuple

from pydantic import model_validator
from pydantic_core import core_schema

from trsim.errors import ScenarioError, described
from trsim.fields import Spec
from trsim.units import check_dimension, titled
from trsim.varying import OUTSIDE, VARIABLES, Column, FunctionSpec

TITLES = ("Fx", "Fy", "Fz", "Mx", "My", "Mz")
ALLOWED = (VARIABLES, *[("N",)] * 3, *[("N*m",)] * 3)  # units of the seven columns
WIDTH = len(ALLOWED)
ROW = f"[x, {', '.join(TITLES)}]"


class SevenColumns(NamedTuple):
    """A table by its columns, SI, and the units as they are written."""

    x: tuple[float, ...]
    y: tuple[tuple[float, ...], ...]
    units: tuple[str, ...]


class _Rows:
    """Marks rows of seven numbers; the name of a file stands for those in it."""

    def __get_pydantic_core_schema__(self, source: Any, handler: Any) -> Any:
        def convert(value: Any, info: Any) -> SevenColumns:
            return columns_of(value, (info.context or {}).get("parameters") or {})

        return core_schema.with_info_plain_validator_function(convert)

    def __get_pydantic_json_schema__(self, schema: Any, handler: Any) -> Any:
        one = {"anyOf": [{"type": "number"}, {"type": "string"}]}
        row = {"type": "array", "items": one, "minItems": WIDTH, "maxItems": WIDTH}
        return {"anyOf": [{"type": "string"}, {"type": "array", "items": row, "minItems": 2}]}


def columns_of(value: Any, parameters: dict) -> SevenColumns:
    """The columns of rows.  Raises ScenarioError with the place among them."""
    if not isinstance(value, list) or not value:
        raise ScenarioError(f"must be rows {ROW} or a CSV file, got {described(value)}")
    for k, row in enumerate(value):
        if not isinstance(row, list) or len(row) != WIDTH:
            raise ScenarioError(f"a row is {ROW}, got {described(row)}", path=(k,))
    units, first = _head(value[0])
    columns = [Column(*pair) for pair in zip(units, ALLOWED, strict=True)]
    found: list[tuple[float, ...]] = []
    for k, row in enumerate(value[first:], start=first):
        numbers = tuple(
            _number(column, cell, parameters, (k, c))
            for c, (column, cell) in enumerate(zip(columns, row, strict=True))
        )
        last = found[-1][0] if found else -inf
        if numbers[0] <= last:
            raise ScenarioError(f"x must rise, got {numbers[0]:g} after {last:g}", path=(k,))
        found.append(numbers)
    if len(found) < 2:
        raise ScenarioError(f"must be two or more rows {ROW}")
    x, *y = zip(*found, strict=True)
    return SevenColumns(x, tuple(y), tuple(column.unit for column in columns))


def _head(row: list) -> tuple[list[str], int]:
    """The units in a row of titles, and how many rows of titles there are: one or none."""
    titles = all(isinstance(cell, str) for cell in row)
    if not titles or not any(cell.rstrip().endswith("]") for cell in row):
        return [""] * WIDTH, 0
    units = [titled(cell)[1] for cell in row]
    for c, text in enumerate(units):
        if text:
            try:
                check_dimension(text, ALLOWED[c])
            except ScenarioError as error:
                raise error.at(0, c) from None
    return units, 1


def _number(column: Column, cell: Any, parameters: dict, path: tuple[int, int]) -> float:
    if not isinstance(cell, str | int | float):
        raise ScenarioError(f"must be a number, got {described(cell)}", path=path)
    try:
        return column.number(cell, parameters)
    except ScenarioError as error:
        raise error.at(*path) from None


class Components(Spec):
    """Six components of a load as functions of one variable.

    table          rows [x, Fx, Fy, Fz, Mx, My, Mz], x rising, or the name of a CSV file
    columns        columns of the file, as seven titles or numbers from 1. Unless given: those with
                   the titles Fx to Mz, or all columns of a file that has seven and no such titles
    of             what x is: t, a sensor, or the rate of one
    interpolation  between rows: akima, a smooth local curve; linear; or spline, a smooth cubic
                   spline
    outside        before the first and after the last row: hold their values, extend the curve, or
                   end the run (error)
    """

    type: ClassVar[str] = "components"
    table: Annotated[SevenColumns, _Rows()]
    columns: Any = None
    of: str = "t"
    interpolation: Literal["akima", "linear", "spline"] = "akima"
    outside: Literal["hold", "extend", "error"] = "hold"

    @model_validator(mode="after")
    def of_a_file(self) -> "Components":
        if self.columns is not None:  # those of a file are chosen when it is read (wide_table.py)
            what = "columns are those of a file, and here are rows"
            raise ScenarioError(what, "name the file beside them: `table: air.csv`", ("columns",))
        return self

    @property
    def functions(self) -> tuple[FunctionSpec, ...]:
        """The six of them; of a column of zeros a constant, which leaves a scene in its plane."""
        x, y, units = self.table
        words: Any = {"of": self.of, "ends": OUTSIDE[self.outside]}
        return tuple(
            FunctionSpec(
                "table",
                x=x,
                y=of,
                units=(units[0], unit),
                interpolation=self.interpolation,
                **words,
            )
            if any(of)
            else FunctionSpec("constant")
            for of, unit in zip(y, units[1:], strict=True)
        )
