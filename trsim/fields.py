"""What a user-written number is made of: units, quantities, expressions of parameters.

    stiffness: Annotated[float, Ge(0), Unit("N*m/rad")]     3, 3e0, 3 N*m/rad, 3000 N*mm/rad, k/2
    at: point("m")                                          [1, 2] or [1, 2, 0], each as above
    axis: vector("-")                                       the same; a free vector
    force: Function("N")                                    a number that varies     varying.py

A point may also be the name of one of the scenario's `points`, and a direction an axis of such a
point, `tip.x`.

A plain number is SI.  A quantity has the dimension of its field.  The validation context may hold
`parameters`, {"speed": 0.5}; `frame`, from which vectors are turned, and points moved too, into
the world; `names`, {"door": "left_door"}, what references mean; `points`, {"tip": a spec with a
`frame`}, what places may be named after.
"""

import math
from collections.abc import Iterable
from functools import cache
from typing import Annotated, Any, ClassVar, get_args

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

from trsim.errors import ScenarioError, check_keys, described, known, within
from trsim.frame import Frame
from trsim.numbers import number
from trsim.references import renamed
from trsim.units import unit, units_hint


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
            return tuple(within(k, self.convert, item, context) for k, item in enumerate(value))
        if value in words or not isinstance(value, str | int | float):
            return value
        try:
            return number(value, self.units, context.get("parameters"))
        except ScenarioError as error:
            if words and error.what.startswith("no parameter"):
                what = f"must be a number or one of the words, got {described(value)}"
                raise ScenarioError(what, known(value, words)) from None
            raise


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
        numbers = [within(k, Unit.convert, self, item, context) for k, item in enumerate(value)]
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
            "type": "object", "title": "these relative to a point", "required": ["in", "at"],
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
    return within("in", _frame_of, value["in"], context), value["at"]


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
    away = -math.frexp(max(map(abs, v)))[1]
    near_one = [math.ldexp(c, away) for c in v]
    length = math.sqrt(sum([c * c for c in near_one]))
    return tuple([c / length for c in near_one])


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
        own = self.__pydantic_private__  # asking by its name takes ten times as long
        return own["_drawn_in"] if own else None

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
