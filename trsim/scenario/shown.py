"""The section `report`: the units of figures and tables."""

from typing import Any

from trsim.errors import ScenarioError, check_keys, described, known
from trsim.units import unit

# what a choice replaces: the one that has the dimension of the unit that is chosen
UNITS: dict[str, tuple[str, ...]] = {
    "angle": ("rad",),
    "length": ("m",),
    "time": ("s",),
    "mass": ("kg",),
    "speed": ("m/s", "rad/s"),
    "acceleration": ("m/s^2", "rad/s^2"),
    "angular_speed": ("rad/s",),
    "angular_acceleration": ("rad/s^2",),
    "force": ("N",),
    "torque": ("N*m",),
    "energy": ("J",),
    "power": ("W",),
    "frequency": ("1/s",),
}
# other words for these kinds, and the one that is meant
MEANT = {
    "velocity": "speed", "rate": "speed", "angular_velocity": "angular_speed", "rpm": "speed",
    "moment": "torque", "work": "energy", "distance": "length", "way": "length",
    "position": "length", "stroke": "length", "rotation": "angle", "load": "force",
}  # fmt: skip


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
        if str(key).casefold() not in MEANT:
            check_keys([key], UNITS, "units")
        if not isinstance(text, str):
            what = f"must be a unit, got {described(text)}"
            raise ScenarioError(what, f"For example {UNITS[key][0]}.", ("units", key))
        try:
            replaced(key, text)
        except ScenarioError as error:
            raise error.at("units", key) from None
    return given


def replaced(key: str, text: str) -> str:
    """The SI unit in place of which a kind of quantity is shown in a unit.

    Raises ScenarioError for what is no unit of that kind.
    """
    plain = str(key).casefold().replace("velocities", "velocity")
    if plain in MEANT and key not in UNITS:
        raise ScenarioError(f"unknown key {described(key)}", known(key, UNITS, MEANT[plain]))
    check_keys([key], UNITS)
    dimension = unit(text)[1]
    for si in UNITS[key]:
        if unit(si)[1] == dimension:
            return si
    what = f"{described(text)} is no unit of {key}"
    raise ScenarioError(what, f"It is shown in units of {' or '.join(UNITS[key])}.")
