"""Chosen numbers of runs as a table."""

from pathlib import Path

import numpy as np

from trsim.analyse.outputs import scalar
from trsim.report.asked import Found, Value, nothing, table
from trsim.report.display import Shown
from trsim.report.spectra import label

TITLES = ("run", "number", "value", "unit", "file")


def draw(runs: list[Shown], words: list[str], folder: Path) -> Found:
    """numbers.csv: a line for each run and word, in SI units or in those asked for."""
    found, files = nothing(), []
    for shown in runs:
        for word in words:
            value, si = scalar(shown.run, word)
            factor, unit = shown.told(si)
            value *= factor
            files.append(str(shown.run.path))
            found.values.append(Value(label(shown), word, value, np.nan, unit))
            found.lines.append(f"{label(shown)}: {word} = {value:.6g} {unit}".rstrip(" -"))
    rows = [
        (one.run, one.what, one.value, one.unit, file)
        for one, file in zip(found.values, files, strict=True)
    ]
    found.files.append(table(folder / "numbers.csv", TITLES, rows))
    return found
