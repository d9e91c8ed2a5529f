"""A number as a user writes it: 3, 3e0, 3 N*m/rad, k/2."""

import math
from typing import Any

from trsim import expressions
from trsim.errors import ScenarioError, described, known
from trsim.units import check_dimension, quantity, units_hint

LARGEST = 1e50  # its fourth power is still a number


def number(value: Any, units: tuple[str, ...] = ("-",), parameters: Any = None) -> float:
    """The SI value of a YAML number, a quantity or an expression of parameters."""
    parameters = parameters or {}
    if isinstance(value, str):
        found = quantity(value, parameters)
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
            raise ScenarioError(f"no parameter named {described(name)}", hint)
    return expressions.evaluate(node, parameters)
