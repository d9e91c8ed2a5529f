"""Values of swept keys: numbers in SI where they are numbers, and the units they have."""

import json
from collections.abc import Iterator, Mapping, Sequence
from typing import Any

from trsim.errors import TrsimError, UsageError
from trsim.scenario.load import unit_of
from trsim.scenario.merge import keys_of
from trsim.units import quantity, si, unit


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
    return {key: own[0] for key in keys if (own := _units(found, key))[0]}


def mixed(found: Sequence[Any], keys: tuple[str, ...]) -> Iterator[tuple[Any, TrsimError]]:
    """Cases with a value of another kind of unit than others: a table has one in a column."""
    for key in keys:
        those = [case for case in found if key in case.values]
        own = _units(those, key)
        first = next(filter(None, own), "")
        for case, one in zip(those, own, strict=True):
            if one and unit(one)[1] != unit(first)[1]:
                what = f"values of {key} are in {first} and in {one}"
                yield case, UsageError(what, "Write all of them in units of one kind.")
                break


def _units(found: Sequence[Any], key: str) -> list[str]:
    """The units that the values of a key are written with; empty where none is."""
    values = [_quantity(case.values[key]) for case in found if key in case.values]
    return [one[1] if one else "" for one in values]


def _quantity(value: Any) -> tuple[float, str] | None:
    """The quantity that a value is, where it is one."""
    try:
        return quantity(value) if isinstance(value, str) else None
    except TrsimError:  # of units; found, and told, when the cases are checked
        return None


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
