"""The table beside a figure of a study: a line for each case, in the units of the figure."""

from collections.abc import Sequence
from pathlib import Path
from typing import Any

import numpy as np

from trsim.analyse.cases import Numbers
from trsim.report.asked import table
from trsim.report.display import Shown


def written(path: Path, study: Any, one: Shown, of: Sequence[Numbers]) -> Path:
    """How each case ended, what was swept, and its numbers; nothing is left out."""
    keys = {key: one.told(study.units.get(key, "-")) for key in study.keys}
    numbers = [one.told(each.unit) for each in of]
    titles = ["case", "status", *(f"{key} [{text}]" for key, (_, text) in keys.items())]
    titles += [f"{each.word} [{text}]" for each, (_, text) in zip(of, numbers, strict=True)]
    rows = [
        (case.name, case.status,
         *(scaled(case.values.get(key, ""), factor) for key, (factor, _) in keys.items()),
         *(each.values.get(case.name, np.nan) * factor
           for each, (factor, _) in zip(of, numbers, strict=True)))
        for case in study.cases
    ]  # fmt: skip
    return table(path, titles, rows)


def scaled(value: Any, factor: float) -> Any:
    """A value of a key in another unit; a word, or a number in its own unit, as it is."""
    return value if factor == 1.0 or not isinstance(value, float | int) else value * factor
