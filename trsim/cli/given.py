"""What options say: a method, a tolerance, a step, a setting of a run."""

from typing import Any

from trsim.errors import ScenarioError, UsageError, known


def known_method(name: str) -> str:
    from trsim.scenario.scenario import METHODS as words

    if name.strip() not in words:
        raise UsageError(f"no method '{name}'", known(name, words))
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
    if method == "rk4":
        raise UsageError("rk4 has no tolerance", f"Name an adaptive method: {option} radau:1e-10")
    if not method:
        raise UsageError(f"'{text}' is no {what}", "Write for example radau:1e-10.")
    return Setting(known_method(method), tolerance(value))
