"""Values of swept keys: numbers in SI where they are numbers, and the units they have."""

import json
from collections.abc import Mapping, Sequence
from typing import Any

from trsim.errors import TrsimError
from trsim.scenario.load import unit_of
from trsim.scenario.merge import keys_of
from trsim.units import quantity, si


def value(written: Any) -> float | str:
    """A value as a number in SI, where it is one."""
    if isinstance(written, int | float) and not isinstance(written, bool):
        return float(written)
    if not isinstance(written, str):
        return json.dumps(written)
    try:
        found = quantity(written)
    except TrsimError:
        return written
    return found[0] if found else written


def written(found: Sequence[Any], keys: tuple[str, ...]) -> dict[str, str]:
    """The unit of the first value of each key that has one."""
    units = {}
    for key in keys:
        value = next(case.values[key] for case in found if key in case.values)
        one = quantity(value) if isinstance(value, str) else None
        if one and one[1]:
            units[key] = one[1]
    return units


def units(
    scenarios: Mapping[str, Any],
    found: Sequence[Any],
    keys: tuple[str, ...],
    written: Mapping[str, str],
) -> dict[str, str]:
    """The SI unit of each key: of its values, or of the field it is."""
    units = {}
    for key in keys:
        if key in written:
            units[key] = si(written[key])
            continue
        case = next(case for case in found if key in case.values)
        try:
            units[key] = _of_field(scenarios[case.case].scenario(case), key)
        except TrsimError:  # found, and told, when the cases are checked
            units[key] = "-"
    return units


def _of_field(scenario: Any, key: str) -> str:
    inner, words = scenario, scenario.meant(keys_of(key))
    for k, word in enumerate(words):
        if isinstance(inner, dict):
            inner = inner.get(word)
            continue
        unit = unit_of(type(inner), word) if hasattr(type(inner), "model_fields") else None
        if unit and not isinstance(getattr(inner, word, None), dict):
            return unit.units[0]
        if k == len(words) - 1:
            break
        inner = getattr(inner, word, None)
    return "-"
