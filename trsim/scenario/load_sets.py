"""Load sets: loads that act together, with the factors of limit and ultimate load.

    load_sets:
      gust: {loads: [wind, pressure], ultimate: 1.5}
    loads: {gust: ultimate}

A load of no set acts as it is written.  Once there are sets `loads` says which act.
"""

from typing import Annotated, Any, ClassVar, Literal

from annotated_types import Gt, MinLen

from trsim.errors import ScenarioError, described, known
from trsim.fields import Spec, Unit

Factor = Annotated[float, Gt(0), Unit("-")]
LEVELS = ("limit", "ultimate")
Level = Annotated[float | Literal["limit", "ultimate"], Unit("-")]


class LoadSet(Spec):
    """Loads that act together.

    loads     entries of `forces`: applied loads and the like
    limit     factor of the limit load, the largest load expected in service
    ultimate  factor of the ultimate load
    """

    type: ClassVar[str] = "load_set"
    loads: Annotated[tuple[str, ...], MinLen(1)]
    limit: Factor = 1.0
    ultimate: Factor = 1.5


def acting(sets: dict[str, LoadSet], loads: dict[str, Any] | None) -> dict[str, float]:
    """The factor of every set; 0 of one that does not act.  Raises ScenarioError with its path."""
    if not sets:
        if loads:
            raise ScenarioError("there are no load_sets", "describe them there", ("loads",))
        return {}
    if loads is None:
        hint = f"for example `loads: {{{next(iter(sets))}: limit}}`; `loads: {{}}` is none"
        raise ScenarioError("`loads` must say which of the load_sets act", hint, ("load_sets",))
    for name in loads:
        if name not in sets:
            what = f"no load set named {described(name)}"
            raise ScenarioError(what, known(name, sets), ("loads", name))
    return {name: _factor(loads.get(name, 0.0), of) for name, of in sets.items()}


def _factor(level: Any, of: LoadSet) -> float:
    return float(getattr(of, level)) if level in LEVELS else float(level)


def scaled(
    sets: dict[str, LoadSet], loads: dict[str, Any] | None, forces: dict[str, Any]
) -> dict[str, Any]:
    """The loads of all sets as they act."""
    factors, found = acting(sets, loads), dict[str, Any]()
    of: dict[str, str] = {}
    for name, one in sets.items():
        for k, load in enumerate(one.loads):
            path = ("load_sets", name, "loads", k)
            if load not in forces:
                raise ScenarioError(f"no force named '{load}'", known(load, forces), path)
            if load in of:
                what = f"'{load}' is in load set '{of[load]}' already"
                raise ScenarioError(what, "a load is in one set", path)
            if not hasattr(forces[load], "scaled"):
                what = f"'{load}' ({forces[load].type}) is no load"
                raise ScenarioError(what, "a set has applied loads and the like", path)
            of[load] = name
            found[load] = forces[load].scaled(factors[name])
    return found


def told(scenario: Any) -> dict[str, str]:
    """Which sets act and with what factor, in words."""
    factors = acting(scenario.load_sets, scenario.loads)
    return {name: _in_words(factors[name], of) for name, of in scenario.load_sets.items()}


def _in_words(factor: float, of: LoadSet) -> str:
    acts = f"times {factor:g}" if factor else "does not act"
    return f"{acts}: {', '.join(of.loads)}"
