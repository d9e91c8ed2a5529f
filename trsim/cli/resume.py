"""Spans of time on the command line."""

import math
from typing import Any

import click


class Seconds(click.FloatRange):
    """A span of time: NaN compares with nothing, so a range lets it pass."""

    def convert(self, value: Any, param: Any, ctx: Any) -> Any:
        found = super().convert(value, param, ctx)
        if not math.isfinite(found):
            self.fail(f"{value} is not a number of seconds; 0 is for never.", param, ctx)
        return found
