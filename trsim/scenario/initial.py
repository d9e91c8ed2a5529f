"""The section `initial`: how the mechanism starts."""

from typing import Any, NamedTuple

from trsim.elements.coordinates import named, of_joint, split
from trsim.elements.rows import COORDINATES
from trsim.errors import ScenarioError, described, known
from trsim.numbers import number

ALL = "all"  # the joints
RATE = ".rate"  # behind a coordinate: how fast it changes at the start
PLACES = {"angle": "rad", "stroke": "m"}
UNITS = {"angle": "rad/s", "stroke": "m/s"}


class Initial(NamedTuple):
    """How the mechanism starts where that is not as drawn and moving with its drives."""

    equilibrium: tuple[str, ...] = ()  # joints free in the balance of forces
    values: dict[str, float] = {}  # of coordinates of joints, rad or m  # noqa: RUF012
    whole: bool = False  # `equilibrium: all`, of which there may be no joint
    rates: dict[str, float] = {}  # of coordinates, rad/s or m/s  # noqa: RUF012

    @property
    def settles(self) -> bool:
        """Whether forces are to balance at the start."""
        return self.whole or bool(self.equilibrium)


def initial_of(data: Any, info: Any) -> Initial:
    """The section as read; joints are those of the scenario that it begins."""
    if isinstance(data, Initial):
        return data
    if not isinstance(data, dict):
        raise ScenarioError(f"must be a mapping of keys, got {described(data)}")
    names = data.get("equilibrium") or []
    whole = names == ALL
    if whole:
        names = list(info.data.get("joints", ()))
    if not isinstance(names, list) or not all(isinstance(name, str) for name in names):
        raise ScenarioError(f"must be a list of joints, or `{ALL}`", path=("equilibrium",))
    parameters, values = (info.context or {}).get("parameters"), dict[str, float]()
    rates: dict[str, float] = {}
    of, joints = info.data.get("joints", {}), [*info.data.get("joints", ()), "equilibrium"]
    for k, name in enumerate(names):
        if name not in joints[:-1] and "joints" in info.data:
            hint = known(name, joints[:-1])
            if name in info.data.get("bodies", ()):
                hint = f"`equilibrium: {ALL}` balances all forces on all bodies"
            raise ScenarioError(f"no joint named {described(name)}", hint, ("equilibrium", k))
    for key, value in data.items():
        if key == "equilibrium":
            continue
        coordinate = key.removesuffix(RATE)
        if split(coordinate, joints)[0] not in joints and "joints" in info.data:
            raise ScenarioError(f"unknown key {described(key)}", known(key, joints), (key,))
        if not isinstance(value, str | int | float):
            raise ScenarioError(f"must be a number, got {described(value)}", path=(key,))
        if coordinate != key:
            if of:
                rates |= _rate(key, value, of, parameters, rates)
            continue
        joint, which = split(key, of)
        has_one = of_joint(joint, of)
        if which and has_one and which not in has_one.values():
            hint = known(key, [*has_one, *(f"{one}{RATE}" for one in has_one)])
            raise ScenarioError(f"joint '{joint}' has no {which}", hint, (key,))
        own, units = key, tuple(PLACES.values())
        if has_one:
            own, _, which = named(key, of, path=(key,))
            units = (PLACES[COORDINATES[which].kind],)
        try:
            values[own] = number(value, units, parameters)
        except ScenarioError as error:
            raise error.at(key) from None
    return Initial(tuple(names), values, whole, rates)


def _rate(key: str, value: Any, joints: Any, parameters: Any, others: Any) -> dict[str, float]:
    """A rate under the name of its coordinate."""
    own, _, which = named(key.removesuffix(RATE), joints, path=(key,))
    if own in others:
        raise ScenarioError(f"the rate of {own} is given twice", "Keep one of them.", (key,))
    try:
        return {own: number(value, (UNITS[COORDINATES[which].kind],), parameters)}
    except ScenarioError as error:
        raise error.at(key) from None
