"""What options say: a method, a tolerance, a step, a setting of a run."""

from typing import Any

from trsim.errors import ScenarioError, UsageError, known
from trsim.scenario.methods import METHODS

NO_MOTION = "a static path is no motion, which another method could check"


def known_method(name: str) -> str:
    if name.strip() not in METHODS:
        raise UsageError(f"no method '{name}'", known(name, METHODS))
    if METHODS[name.strip()].rests:
        raise UsageError(NO_MOTION, "Name a method that computes motions.")
    return name.strip()


def tolerance(text: str) -> float:
    from trsim.analyse.precision import LOOSEST, TIGHTEST

    try:
        value = float(text)
    except ValueError:
        value = 0.0
    if not TIGHTEST <= value <= LOOSEST:
        told = f"a tolerance is a number from {TIGHTEST:g} to {LOOSEST:g}"
        raise UsageError(f"'{text}' is no tolerance", f"{told}, for example 1e-6.")
    return value


def seconds(text: str) -> float:
    from trsim.numbers import number

    try:
        value = number(text, ("s",))
    except ScenarioError as error:
        raise UsageError(f"'{text}' is no step: {error.what}", error.hint) from None
    if value <= 0.0:
        raise UsageError(f"'{text}' is no step", "A step is positive, for example 1e-6 or '1 us'.")
    return value


def chosen(text: str, what: str = "reference", option: str = "--reference") -> Any:
    """METHOD:TOLERANCE; the method may have a colon of its own."""
    from trsim.analyse.trajectory import Setting

    method, _, value = text.rpartition(":")
    if not method:
        raise UsageError(f"'{text}' is no {what}", "Write for example radau:1e-10.")
    method = known_method(method)
    if not METHODS[method].adaptive:
        hint = f"Name an adaptive method: {option} radau:1e-10"
        raise UsageError(f"{method} has no tolerance", hint)
    return Setting(method, tolerance(value))
