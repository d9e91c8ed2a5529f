"""Which channels a scenario asks for."""

import re
from fnmatch import translate
from functools import cache
from typing import Any

from trsim.elements.scene import COMPONENTS

NOT_BY_DEFAULT = ("*.rotation", "*.damping_loss", "*.friction_loss")
ALL = ("*",)


def matches(name: str, patterns: tuple[str, ...]) -> bool:
    """Whether a channel is asked for: by name, by pattern, or by the name of its element."""
    return _any_of(patterns).match(name) is not None


@cache
def _any_of(patterns: tuple[str, ...]) -> re.Pattern[str]:
    """One expression for all of them: scenarios have hundreds of channels."""
    parts = [part for p in patterns for part in (translate(p), re.escape(p + "."))]
    return re.compile("|".join(f"(?:{part})" for part in parts) or r"(?!)", re.DOTALL)


def is_asked(name: str, patterns: tuple[str, ...]) -> bool:
    """Whether a channel is recorded; with `*`, the default, some are not that cost more."""
    if patterns == ALL:
        return not matches(name, NOT_BY_DEFAULT)
    return matches(name, patterns)


def points_of(scenario: Any) -> set[str]:
    """The channels that sections, portraits and events of a scenario name, with and without a
    component."""
    portraits = [(spec.x, spec.y) for spec in scenario.phase_portraits.values()]
    sections = [(spec.when or "", *spec.plot) for spec in scenario.poincare.values()]
    named = {channel for group in (*portraits, *sections) for channel in group}
    named |= {spec.when for spec in scenario.events.values()}
    return named | {channel[:-2] for channel in named if channel[-2:] in COMPONENTS}
