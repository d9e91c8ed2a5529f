"""Chosen numbers of runs as a table."""

from pathlib import Path

import numpy as np

from trsim.analyse.outputs import scalar
from trsim.report.asked import Found, Value, nothing, table
from trsim.report.display import Shown
from trsim.report.spectra import label


def draw(runs: list[Shown], words: list[str], folder: Path) -> Found:
    """numbers.csv: a line for each run and word, in SI units or in those asked for."""
    found = nothing()
    for shown in runs:
        for word in words:
            value, si = scalar(shown.run, word)
            factor, unit = shown.told(si)
            value *= factor
            found.values.append(Value(label(shown), word, value, np.nan, unit))
            found.lines.append(f"{label(shown)}: {word} = {value:.6g} {unit}".rstrip(" -"))
    rows = [(one.run, one.what, one.value, one.unit) for one in found.values]
    found.files.append(table(folder / "numbers.csv", ("run", "number", "value", "unit"), rows))
    return found
