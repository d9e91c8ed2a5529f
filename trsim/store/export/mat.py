"""MAT (version 5): a column for each channel, and `trsim`, which tells names and units.

    x = load('run.mat');  plot(x.time, x.B_contact_force)

A variable has the name of its channel with what is no letter or digit as `_`; where two would have
the same, or one that is a word of the language, `_` and a number are added.
"""

import io
import re
from typing import IO

import numpy as np

from trsim.store.export.columns import Columns

LONGEST = 63  # letters of a name
TEXT = b"MATLAB 5.0 MAT-file, written by trsim".ljust(116)
WORDS = re.findall(
    r"\w+",
    "break case catch classdef continue else elseif end for function global if otherwise parfor "
    "persistent return spmd switch try while trsim",
)


def write(columns: Columns, out: IO[bytes]) -> None:
    from scipy.io import savemat

    names, table, title = variables(columns.names), columns.whole(), columns.run.attributes["title"]
    about = {
        "title": str(title),
        "variables": cells(names),
        "channels": cells(columns.names),
        "units": cells(columns.units),
    }
    values = dict(zip(names, table.T, strict=True)) | {"trsim": about}
    made = io.BytesIO()
    savemat(made, values, do_compression=True, oned_as="column")
    # scipy writes the machine and the time of day
    out.write(TEXT + made.getbuffer()[len(TEXT) :])


def cells(texts: list[str]) -> np.ndarray:
    """A cell array of texts."""
    return np.array(texts, dtype=object)


def variables(names: list[str]) -> list[str]:
    """A name for each channel that the language allows, no two alike."""
    found: list[str] = []
    for name in names:
        plain = re.sub(r"[^A-Za-z0-9_]", "_", name)
        plain = (plain if plain[:1].isalpha() else f"x{plain}")[:LONGEST]
        text, k = plain, 1
        while text in WORDS or text in found:
            k += 1
            text = f"{plain[: LONGEST - 6]}_{k}"
        found.append(text)
    return found
