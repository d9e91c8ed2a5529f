"""A number as a user writes it: 3, 3e0, 3 N*m/rad, k/2."""

import math
import re
from typing import Any

from trsim import expressions
from trsim.errors import ScenarioError, described, known
from trsim.units import BASE, DERIVED, check_dimension, quantity, unit, units_hint

LARGEST = 1e50  # its fourth power is still a number

_ALONE = re.compile(r"\s*([+-]?)\s*([A-Za-z_]\w*)\s*")


class Measured(float):
    """A parameter that was written with a unit; the unit is empty where it was computed of such
    with an angle in their units: whether its number is one of a radian then nobody can see."""

    unit: str

    @classmethod
    def of(cls, value: float, unit: str) -> "Measured":
        """A value, SI, and the unit it was written with."""
        made = cls(value)
        made.unit = unit
        return made


def written(
    text: str, parameters: Any = None, wanted: tuple[str, ...] = ()
) -> tuple[float, str] | None:  # fmt: skip
    """The SI value and the unit of `0.3 mm`, or of a parameter named alone, `gap` or `-gap`.

    None where the text is neither: a number, or an expression.  wanted: as of `quantity`.
    """
    parameters = parameters or {}
    found, alone = quantity(text, parameters, wanted), _ALONE.fullmatch(text)
    if found is None and alone and isinstance(one := parameters.get(alone[2]), Measured):
        return (-float(one) if alone[1] == "-" else float(one)), one.unit
    return found


def angular(text: str, parameters: Any) -> bool:
    """Whether an expression is made of parameters with an angle in their units, as 5 mm/turn."""
    named = [parameters.get(name) for name in expressions.names(expressions.parse(text))]
    return any(
        isinstance(one, Measured) and (not one.unit or bool(unit(one.unit)[1][3])) for one in named
    )


def number(value: Any, units: tuple[str, ...] = ("-",), parameters: Any = None) -> float:
    """The SI value of a YAML number, a quantity or an expression of parameters."""
    parameters = parameters or {}
    if isinstance(value, str):
        found = quantity(value, parameters, units)
        if found is None:
            return _of_parameters(value, units, parameters)
        if found[1]:
            check_dimension(found[1], units)
        value = found[0]
    if isinstance(value, bool):
        raise ScenarioError(f"must be a number, got {described(value)}", units_hint(units))
    try:
        result = float(value)
    except OverflowError:
        result = math.inf
    if not math.isfinite(result):
        raise ScenarioError("must be a finite number", units_hint(units))
    if abs(result) > LARGEST:
        raise ScenarioError(f"no quantity of a mechanism is {result:.0e}", units_hint(units))
    return result


def unit_meant(name: str) -> str:
    """What to do where a name of an expression is that of a unit; else nothing."""
    if name not in {**BASE, **DERIVED}:
        return ""
    return (
        f"'{name}' is a unit; expressions compute in SI. A number with its unit may be a "
        f"parameter: `parameters: {{x: 10 {name}}}`, and x here."
    )


def _of_parameters(text: str, units: tuple[str, ...], parameters: Any) -> float:
    try:
        node = expressions.parse(text)
    except ScenarioError as error:
        raise ScenarioError(error.what, f"{units_hint(units)}  {error.hint}".strip()) from None
    for name in sorted(expressions.names(node) - {"pi"}):
        if name not in parameters:
            if name == "t":
                raise ScenarioError("this number cannot depend on t", units_hint(units))
            hint = known(name, parameters) if parameters else units_hint(units)
            hint = "  ".join(filter(None, [hint, unit_meant(name)]))
            raise ScenarioError(f"no parameter named {described(name)}", hint)
    alone = written(text, parameters)
    if alone and alone[1]:
        try:
            check_dimension(alone[1], units)
        except ScenarioError as error:
            what = f"{error.what}; {described(text)} is a parameter in {alone[1]}"
            raise ScenarioError(what, error.hint) from None
    return expressions.evaluate(node, parameters)
