"""How a report is asked to look: units, kind of files, size and style.

--units "angle: deg, speed: rpm"      --format svg      --size 120x80      --style slides
"""

import re
from typing import NamedTuple

from trsim.errors import ScenarioError, UsageError, described
from trsim.scenario.shown import UNITS as KINDS
from trsim.scenario.shown import replaced
from trsim.units import quantity, unit

FORMATS = ("png", "pdf", "svg")
UNITS = 'Units are KIND: UNIT, for example "angle: deg, speed: rpm".'
SIZE = "A size is WIDTHxHEIGHT in mm, or in a unit: 120x80, 16cm x 9cm; or the width alone."
SMALLEST, LARGEST = 0.02, 2.0  # m
INCH = 0.0254  # m
DOTS = (20, 1200)  # per inch


class Looks(NamedTuple):
    """What was asked for, by the words of the options; empty: as usual."""

    units: tuple[str, ...] = ()
    form: str = "png"
    size: str = ""
    dpi: int | None = None
    style: str = ""  # slides, or a file of matplotlib's


def chosen(texts: tuple[str, ...]) -> dict[str, tuple[float, str]]:
    """SI unit -> factor and the unit to show in its place.  Raises UsageError."""
    found: dict[str, tuple[float, str]] = {}
    for pair in (one.strip() for text in texts for one in re.split("[,;]", text.strip(" {}"))):
        key, colon, name = (part.strip() for part in pair.partition(":"))
        if not colon or not name:
            hint = UNITS
            if key in KINDS:
                hint = f"Say which: {key}: {KINDS[key][0]}."
            raise UsageError(f"no units: {described(pair)}", hint)
        try:
            si = replaced(key, name)
        except ScenarioError as error:
            raise UsageError(error.what, error.hint or UNITS) from None
        if si in found:
            what = f"two units for what is in {si}: '{found[si][1]}' and '{name}'"
            raise UsageError(what, "Name one of them.")
        found[si] = 1.0 / float(unit(name)[0]), name
    return found


def inches(text: str) -> tuple[float, float | None] | None:
    """Width and height of a size; nothing where none is asked for.  Raises UsageError."""
    if not text.strip():
        return None
    parts = text.lower().split("x")
    if len(parts) > 2:
        raise UsageError(f"no size: {described(text)}", SIZE)
    sides = [side(part, text) / INCH for part in parts]
    return sides[0], sides[1] if len(sides) > 1 else None


def side(part: str, text: str) -> float:
    """One side, m."""
    try:
        found = quantity(part.strip())
    except ScenarioError as error:
        raise UsageError(f"no size: {described(text)}: {error.what}", error.hint or SIZE) from None
    if found is None or (found[1] and unit(found[1])[1] != unit("m")[1]):
        raise UsageError(f"no size: {described(text)}", SIZE)
    length = found[0] if found[1] else 1e-3 * found[0]
    if not SMALLEST <= length <= LARGEST:
        what = f"a side of {1e3 * length:g} mm is no size of a figure"
        raise UsageError(what, f"Give {1e3 * SMALLEST:g} to {1e3 * LARGEST:g} mm.")
    return length
