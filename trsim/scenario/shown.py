"""The section `report`: the units of figures and tables."""

from typing import Any

from trsim.errors import ScenarioError, check_keys, described
from trsim.units import unit

UNITS = {"angle": "rad", "length": "m", "force": "N", "torque": "N*m"}  # what a choice replaces


def report(given: dict[str, Any]) -> dict[str, Any]:
    """The section as given; raises ScenarioError where its units are not those of their kind."""
    check_keys(given, ["units"])
    chosen = given.get("units")
    if chosen is None:
        return given
    if not isinstance(chosen, dict):
        what = f"must be a mapping, got {described(chosen)}"
        raise ScenarioError(what, "For example `{angle: deg, length: mm}`.", ("units",))
    for key, text in chosen.items():
        check_keys([key], UNITS, "units")
        if not isinstance(text, str):
            what = f"must be a unit, got {described(text)}"
            raise ScenarioError(what, f"For example {UNITS[key]}.", ("units", key))
        try:
            same = unit(text)[1] == unit(UNITS[key])[1]
        except ScenarioError as error:
            raise error.at("units", key) from None
        if not same:
            what = f"{described(text)} is no unit of {key}"
            raise ScenarioError(what, f"It is shown in units of {UNITS[key]}.", ("units", key))
    return given
