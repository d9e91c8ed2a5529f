"""What is drawn over what, as a word: `Y, Y2 : X`, and @BEGIN..END behind it for a stretch of time.

X is any channel of a run, however it turns back, and time unless it is said.  A component is
`B.force.x`, a magnitude `|B.force|`.
"""

from typing import NamedTuple

import numpy as np

from trsim.analyse.window import between, ends, parted, scalar_channel, window
from trsim.arrays import Array
from trsim.errors import UsageError, described
from trsim.store.read import Run

WRITTEN = "A plot is 'Y, Y2 : X', for example 'door_angle.rate : door_angle'; X is time unless said"
OF_X = (
    "A window of the abscissa is BEGIN..END, for example 0..110deg or 0.1..0.5, SI without a unit."
)


class Plotted(NamedTuple):
    """The channels of a plot."""

    y: tuple[str, ...]
    x: str
    within: str  # text of the window of time


def plotted(word: str) -> Plotted:
    """The channels of a word.  Raises UsageError where it makes no sense."""
    channels, text = parted(word)
    of, colon, x = channels.partition(":")
    y = tuple(name.strip() for name in of.split(","))
    if not all(y) or (colon and not x.strip()) or ":" in x or "," in x:
        raise UsageError(f"'{word}' does not say what is drawn over what", WRITTEN)
    for name in y:
        if y.count(name) > 1:
            raise UsageError(f"'{word}' names '{name}' twice", "Once is enough.")
    return Plotted(y, x.strip() or "time", text.strip())


class Rows(NamedTuple):
    """The rows of a run that a plot is made of, SI."""

    time: Array
    x: Array
    y: dict[str, Array]


def rows(run: Run, of: Plotted) -> Rows:
    """Raises UsageError for what the run does not have."""
    inside = window(run, of.within).of(run.time)
    columns = {name: scalar_channel(run, name)[inside] for name in of.y}
    return Rows(run.time[inside], scalar_channel(run, of.x)[inside], columns)


def limits(text: str, si: str) -> tuple[float, float]:
    """The ends of `a..b`, a stretch of the abscissa, SI; all of it for an empty text."""
    if not text:
        return -np.inf, np.inf
    low, high = ends(text, si, text, OF_X)
    if low >= high:
        raise UsageError(f"window {text} has no width", OF_X)
    return low, high


def check_reached(run: Run, x: str, of: Array, text: str, within: tuple[float, float]) -> None:
    """Check that a stretch of an abscissa holds a row of a run.  Raises UsageError.

    of: the rows of the abscissa that are drawn.  text: the stretch as it was asked for.
    """
    there = of[np.isfinite(of)]
    if not text or not there.size or between(there, within).any():
        return
    si = run.unit(x)
    told = f"{x} goes from {there.min():.6g} to {there.max():.6g}{'' if si == '-' else f' {si}'}"
    raise UsageError(f"{run.path}: no row lies in {described(text)}; {told}", OF_X)
