"""What a user-written number is made of: units, quantities, expressions of parameters.

    stiffness: Annotated[float, Ge(0), Unit("N*m/rad")]     3, 3e0, 3 N*m/rad, 3000 N*mm/rad, k/2
    at: point("m")                                          [1, 2] or [1, 2, 0], each as above
    axis: vector("-")                                       the same; a free vector
    force: Function("N")                                    a number, an expression, a table

A point may also be the name of one of the scenario's `points`, and a direction an axis of such a
point, `tip.x`.

A plain number is SI.  A quantity has the dimension of its field.  The validation context may hold
`parameters`, {"speed": 0.5}; `frame`, from which vectors are turned, and points moved too, into
the world; `names`, {"door": "left_door"}, what references mean; `points`, {"tip": a spec with a
`frame`}, what places may be named after.
"""

import math
from collections.abc import Iterable
from dataclasses import dataclass, replace
from functools import cache
from typing import Annotated, Any, ClassVar, Literal, get_args

from pydantic import (
    BaseModel,
    BeforeValidator,
    ConfigDict,
    Field,
    PrivateAttr,
    ValidationError,
    model_validator,
)
from pydantic_core import core_schema

from trsim import expressions
from trsim.errors import ScenarioError, check_keys, described, known
from trsim.frame import Frame
from trsim.numbers import number, written
from trsim.references import renamed
from trsim.units import check_dimension, quantity, titled, unit, units_hint


class Unit:
    """Marks a number, or a tuple or union of numbers, with its unit (or one of several)."""

    def __init__(self, *units: str) -> None:
        self.units = units
        self.text = " or ".join(units)
        for text in units:
            unit(text)

    def __get_pydantic_core_schema__(self, source: Any, handler: Any) -> Any:
        words = tuple(_words(source))

        def convert(value: Any, info: Any) -> Any:
            return self.convert(value, info.context or {}, words)

        return core_schema.with_info_before_validator_function(convert, handler(source))

    def __get_pydantic_json_schema__(self, schema: Any, handler: Any) -> Any:
        return _or_text(handler(schema))

    def convert(self, value: Any, context: dict, words: tuple[str, ...] = ()) -> Any:
        """Numbers for texts; what cannot be one is left to the field itself."""
        if isinstance(value, list | tuple):
            return tuple(_at(k, self.convert, item, context) for k, item in enumerate(value))
        if value in words or not isinstance(value, str | int | float):
            return value
        try:
            return number(value, self.units, context.get("parameters"))
        except ScenarioError as error:
            if words and error.what.startswith("no parameter"):
                what = f"must be a number or one of the words, got {described(value)}"
                raise ScenarioError(what, known(value, words)) from None
            raise


def _at(key: str | int, function: Any, *arguments: Any) -> Any:
    """Call, and tell in an error which entry of a list it was."""
    try:
        return function(*arguments)
    except ScenarioError as error:
        raise error.at(key) from None


def _words(source: Any) -> list[str]:
    """The literal words a type allows."""
    inner = get_args(source)
    own = [word for word in inner if isinstance(word, str)]
    return own + [word for part in inner for word in _words(part)]


def _or_text(schema: Any) -> Any:
    """A JSON schema that also takes a text wherever it takes a number."""
    if isinstance(schema, list):
        return [_or_text(part) for part in schema]
    if not isinstance(schema, dict):
        return schema
    if schema.get("type") == "number":
        return {"anyOf": [schema, {"type": "string"}]}
    return {key: _or_text(part) for key, part in schema.items()}


class _VectorUnit(Unit):
    """Two or three numbers; z = 0 when omitted.  From the frame of the context into the world.

    {in: seat, at: [1, 2]} are the same seen from a named point, along its axes as drawn.
    """

    into_world = staticmethod(Frame.turned)
    is_place = False
    otherwise = "axis of a point"  # what may stand instead of numbers

    def __init__(self, *units: str, named: bool = True) -> None:
        super().__init__(*units)
        self.by_name = named and (units == ("-",) or self.is_place)
        self.framed = named

    def convert(self, value: Any, context: dict, words: tuple[str, ...] = ()) -> Any:
        if isinstance(value, str) and self.by_name and context.get("points") is not None:
            return self.named(value, context)
        frame = context.get("frame")
        seen = isinstance(value, dict) and not value.keys().isdisjoint(("in", "at"))
        if seen and self.framed and context.get("points") is not None:
            frame, value = _seen_from(value, context)
        whole = self.three(value, context)
        return self.into_world(frame, whole) if frame else whole

    def three(self, value: Any, context: dict) -> Any:
        """Three numbers in SI units."""
        if not isinstance(value, list | tuple) or len(value) not in (2, 3):
            hint = f"About z it is [0, 0, {value}]." if self.turns(value) else ""
            raise ScenarioError(f"must be [x, y] or [x, y, z], got {described(value)}", hint)
        for k, item in enumerate(value):  # a frame moves numbers, whatever pydantic says later
            if not isinstance(item, str | int | float):
                what = f"must be a number, got {described(item)}"
                raise ScenarioError(what, units_hint(self.units), (k,))
        numbers = [_at(k, Unit.convert, self, item, context) for k, item in enumerate(value)]
        return tuple([*numbers, 0.0][:3])

    def turns(self, value: Any) -> bool:
        """Whether one number stands where an angular velocity should."""
        return isinstance(value, str | int | float) and "rad/s" in self.units

    def named(self, value: str, context: dict) -> Any:
        """The axis of a point: world axes, whatever frame this is read in."""
        name, _, axis = value.rpartition(".")
        if name.isidentifier() and axis in ("x", "y", "z"):
            return getattr(_frame_of(name, context), axis)
        what = f"must be [x, y], [x, y, z] or an axis of a point, got {described(value)}"
        raise ScenarioError(what, "The axes of a point `tip` are tip.x, tip.y and tip.z.")

    def __get_pydantic_json_schema__(self, schema: Any, handler: Any) -> Any:
        numbers = {**super().__get_pydantic_json_schema__(schema, handler), "minItems": 2}
        if not self.framed:
            return numbers
        named = {"type": "string", "title": self.otherwise}
        seen = {
            "type": "object", "title": "these seen from a point", "required": ["in", "at"],
            "properties": {"in": {"type": "string"}, "at": numbers}, "additionalProperties": False,
        }  # fmt: skip
        return {"anyOf": [numbers, *([named] if self.by_name else ()), seen]}


class _PointUnit(_VectorUnit):
    into_world = staticmethod(Frame.moved)
    is_place = True
    otherwise = "name of a point"

    def named(self, value: str, context: dict) -> Any:
        if value.isidentifier():
            return _frame_of(value, context).at
        what = f"must be [x, y], [x, y, z] or the name of a point, got {described(value)}"
        raise ScenarioError(what)


def _seen_from(value: dict, context: dict) -> tuple[Frame, Any]:
    """The frame of {in: seat, at: [1, 2]}, in world axes as drawn, and the numbers seen from it."""
    check_keys(value, ("in", "at"))
    for key in ("in", "at"):
        if key not in value:
            what = f"field required: {key}"
            raise ScenarioError(what, "Seen from a point it is {in: NAME, at: [x, y, z]}.")
    if not isinstance(value["in"], str):
        what = f"must be the name of a point, got {described(value['in'])}"
        raise ScenarioError(what, path=("in",))
    return _at("in", _frame_of, value["in"], context), value["at"]


def _frame_of(name: str, context: dict) -> Frame:
    """The frame of one of the points of the context, in world axes as drawn."""
    points = context["points"]
    try:
        found: Frame = points[(context.get("names") or {}).get(name, name)].frame
    except KeyError:
        hint = known(name, points) if points else "Describe it under `points`."
        raise ScenarioError(f"no point named {described(name)}", hint) from None
    return found


def vector(*units: str, named: bool = True) -> Any:
    """The type of a free vector (a direction, a velocity): three floats; two or three numbers.

    named: it may also be seen from a point, and a direction may be an axis of one.
    """
    mark = _VectorUnit(*units, named=named)
    return Annotated[tuple[float, float, float], mark]


def point(*units: str, named: bool = True) -> Any:
    """The type of a place: three floats, given as two or three numbers.

    named: or by the name of a point, or seen from one.
    """
    return Annotated[tuple[float, float, float], _PointUnit(*units, named=named)]


def direction(v: Iterable[float]) -> tuple[float, ...]:
    """The unit vector along v, which is not zero; no square vanishes."""
    v = tuple(v)
    exponent = math.frexp(max(map(abs, v)))[1]
    v = tuple(math.ldexp(c, -exponent) for c in v)
    length = math.sqrt(sum(c * c for c in v))
    return tuple(c / length for c in v)


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
        found = written(item, parameters) if isinstance(item, str) else None
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
        if isinstance(value, str) and quantity(value, {"t", *parameters}) is None:
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
            own = _at("table", _at, 0, _of_titles, head, own)
        columns = _at("table" if head else "units", self._own, own)
        x, y, units = _at("table", self._columns, rows, columns, parameters)
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
                _at(k, check_dimension, text, allowed[k])
        return [Column(*pair) for pair in zip(units, allowed, strict=True)]

    def _columns(self, rows: Any, columns: list[Column], parameters: dict) -> Any:
        """x, y and their units as written."""
        if not isinstance(rows, list | tuple) or len(rows) < 2:
            raise ScenarioError(f"must be two or more rows [x, y], got {described(rows)}")
        last = -math.inf
        points = []
        for k, row in enumerate(rows):
            if not isinstance(row, list | tuple) or len(row) != 2:
                raise ScenarioError(f"a row is [x, y], got {described(row)}", path=(k,))
            if not all(isinstance(item, str | int | float) for item in row):
                raise ScenarioError("a row is two numbers", path=(k,))
            pairs = zip(columns, row, strict=True)
            x, y = (_at(k, column.number, item, parameters) for column, item in pairs)
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
    found = [_at(k, titled, text)[1] for k, text in enumerate(head)]
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


def _true_or_false(value: Any) -> Any:
    if not isinstance(value, bool):
        raise ScenarioError(f"must be true or false, got {described(value)}")
    return value


EMPTY: Any = Field(default_factory=dict)  # a mapping that may be left out
Flag = Annotated[bool, BeforeValidator(_true_or_false)]


class SpecError(ValueError):
    """What pydantic found wrong in a mapping, and the class that was to be made of it."""

    def __init__(self, spec: type["Spec"], error: ValidationError) -> None:
        super().__init__(spec, error)
        self.spec, self.error = spec, error

    def __str__(self) -> str:
        return str(self.error)


class Spec(BaseModel):
    """What a user writes under one name: a closed set of keys, frozen once read."""

    model_config = ConfigDict(
        frozen=True, extra="forbid", allow_inf_nan=False, arbitrary_types_allowed=True
    )
    type: ClassVar[str] = ""  # the word after `type:`
    _drawn_in: Frame | None = PrivateAttr(None)

    @property
    def drawn_in(self) -> Frame | None:
        """The frame of its instance or of the scenario; None: the world's."""
        return self._drawn_in

    @model_validator(mode="wrap")
    @classmethod
    def _in_context(cls, data: Any, handler: Any, info: Any) -> Any:
        context = info.context or {}
        frame = context.get("frame")
        if context.get("names") and isinstance(data, dict):
            data = renamed(cls.model_fields, data, context["names"])
        if frame and isinstance(data, dict):  # the default axis is one of the frame, too
            data = {**_default_vectors(cls), **data}
        try:
            made = handler(data)
        except ValidationError as error:
            raise SpecError(cls, error) from None
        if frame:
            made._drawn_in = frame
        return made


@cache
def _default_vectors(spec: type[Spec]) -> dict[str, Any]:
    """The vectors that may be left out, and what they are then."""
    return {
        key: field.default
        for key, field in spec.model_fields.items()
        if isinstance(field.default, tuple)
        and any(isinstance(mark, _VectorUnit) for mark in field.metadata)
    }
