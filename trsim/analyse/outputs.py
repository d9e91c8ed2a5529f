"""A number of a run, as a word: peak:B.contact_force, std:door_angle.rate@0.3..0.98, impacts:B.

This is the one place that turns words into numbers: tables, sweeps, bifurcations and Sobol indices
all ask here.  A word is KIND:OF, and @WINDOW behind it where only a stretch of the run counts
(window.py).

    peak, least          largest and smallest value: of the motion for the whole run; in a
                         window of rows, of the steps of a contact, and of the extremes of the run
                         that lie in it.  The peak of a vector is that of its magnitude
    range                peak - least
    mean, rms, std       of the rows, each counting alike: sums over n rows by n, no integral over
                         time, in which the first and the last row count half
    fluctuation          rms of what is faster than 10 ms (fluctuation.py), of rows that show it
    final                last row
    dispersion:SECTION   sqrt(var x + var y) of the points of a section; SECTION.x, SECTION.y: one
    points:SECTION       how many there are
    flight, contact, following, impacts, onsets, between : of a clearance joint (shares.py)
    summary:KEY          of the summary: time, rows, contacts.B.peak_force; solver:KEY: steps ...
"""

from collections.abc import Callable, Iterable
from functools import partial
from typing import Any

import numpy as np
from numpy.typing import NDArray

from trsim.analyse.extremes import LARGEST, SMALLEST, extreme
from trsim.analyse.fluctuation import WIDTH, fluctuation, shows
from trsim.analyse.shares import shares
from trsim.analyse.window import Window, parted, rows_in, scalar_channel, window
from trsim.arrays import Array
from trsim.errors import ScenarioError, UsageError, described, known
from trsim.store.read import Run
from trsim.units import unit as unit_of

Number = tuple[float, str]

FORM = "A number of a run is KIND:OF, for example peak:B.contact_force or mean:stroke@0.3..0.9."


def scalar(run: Run, word: str) -> Number:
    """The number a word asks for, and its SI unit; nan where the run has nothing to make it of.

    Raises UsageError for a word that makes no sense, or names what the run does not have.
    """
    if not isinstance(word, str):
        raise UsageError(f"a number of a run is a word, not {described(word)}", FORM)
    if (kept := run.kept(word)) is not None:
        return kept
    check_word(word, run)
    name, text = parted(word)
    kind, _, of = name.partition(":")
    within = window(run, text, rows=kind not in LOCATED)
    value, unit = KINDS[kind](run, of, within, bool(text))
    return float(value), unit


def check_word(word: str, run: Run | None = None) -> None:
    """Check that a word has the form of a number; run: whose channels may be meant.

    Raises UsageError.
    """
    name, text = parted(word)
    kind, colon, of = name.partition(":")
    if kind not in KINDS:
        raise _no_kind(word, name, kind, run)
    if not colon or not of:
        raise UsageError(f"{described(word)} does not say of what", FORM)
    if kind in WHOLE and text:
        raise UsageError(f"{described(word)}: {kind} is of the whole run", "Leave out the window.")


def _no_kind(word: str, name: str, kind: str, run: Run | None) -> UsageError:
    """What is wrong with a word that does not begin with the kind of a number."""
    if run is not None and run.stores(name):
        what = f"{described(name)} does not say which number of the channel"
        return UsageError(what, f"Write peak:{name}, mean:{name} or final:{name}.")
    if kind in MEANT and ":" in word:
        return UsageError(
            f"no number of a run: {described(word)}",
            f"Write {MEANT[kind]}:{word[len(kind) + 1 :]}.",
        )
    hint = known(kind, KINDS) if ":" in word else FORM
    if run is not None and ":" not in word:
        hint = f"{FORM}  {known(name, run.names)}"
    return UsageError(f"no number of a run: {described(word)}", hint)


def pressed(run: Run, word: str) -> str:
    """What to say of a reaction of 0 that a word asks for, of a pin with play.

    In a plane nothing but its contact holds it: its rows, and so its reaction, are out of it.
    """
    name = parted(word)[0].partition(":")[2].strip("|")
    joint, dot, channel = name.partition(".")
    other = f"{joint}.contact_force"
    asked = dot and channel.startswith("react")  # the force or the moment
    if not asked or other not in run.names:
        return ""
    return f"{word}: {other} is the force in that pin, which has play"


def in_units(word: str, number: Number, units: tuple[str, ...]) -> Number:
    """A number in the one of some units that is of its kind; as it is where none is given.

    Raises UsageError for what is no unit, and where none of them is of its kind.
    """
    value, si = number
    for text in units:
        try:
            factor, dimension = unit_of(text)
        except ScenarioError as error:
            raise UsageError(error.what, error.hint) from None
        if dimension == unit_of(si)[1]:
            return value / float(factor), text
    if units:
        told = ", ".join(described(text) for text in units)
        told = f"{told} is no unit" if len(units) == 1 else f"none of {told} is a unit"
        what = "without a unit" if si == "-" else f"in {si}"
        raise UsageError(f"{told} of {word}", f"It is a number {what}.")
    return number


# --- of channels -----------------------------------------------------------------------------


def _of_rows(
    function: Callable[[Array], Any], run: Run, channel: str, within: Window, _: bool
) -> Number:
    return function(rows_in(run, channel, within)[1]), run.unit(channel)


def _extreme(word: str, run: Run, channel: str, within: Window, part: bool) -> Number:
    return extreme(run, word, channel, within, part).value, run.unit(channel)


def _range(run: Run, channel: str, within: Window, part: bool) -> Number:
    high, unit = KINDS["peak"](run, channel, within, part)
    return high - KINDS["least"](run, channel, within, part)[0], unit


def _fluctuation(run: Run, channel: str, within: Window, _: bool) -> Number:
    time, x = run.time, scalar_channel(run, channel)
    if len(time) > 1 and not shows(time):
        what = f"rows {time[1] - time[0]:.3g} s apart show nothing that is faster than {WIDTH:g} s"
        raise UsageError(
            f"{run.path}: {what}: no fluctuation of {channel}",
            f"Run it with `output: {{every: {0.1 * WIDTH:g}}}`.",
        )
    return fluctuation(time, x, *within), run.unit(channel)


# --- of sections and contacts ----------------------------------------------------------------


def _points(run: Run, name: str, within: Window) -> tuple[Any, NDArray[np.bool_]]:
    """A section, and which of its points lie in a window."""
    found = run.poincare
    if name not in found:
        hint = known(name, found) if found else "Declare one in the scenario under `poincare`."
        raise UsageError(f"{run.path}: no section '{name}'", hint)
    points = found[name]
    return points, within.of(points.time)


def _dispersion(run: Run, of: str, within: Window, _: bool) -> Number:
    name, axis = [*of.split(".", 1), ""][:2]
    points, inside = _points(run, name, within)
    units = {"x": points.x_unit, "y": points.y_unit}
    if axis and axis not in units:
        raise UsageError(f"a section has no axis '{axis}'", known(axis, units))
    if not axis and points.x_unit != points.y_unit:
        what = f"section '{name}' has {points.x_unit} and {points.y_unit}: no common dispersion"
        raise UsageError(what, f"Say dispersion:{name}.x or dispersion:{name}.y.")
    axes = [axis] if axis else list(units)
    if not inside.any():
        return np.nan, units[axes[0]]
    variances = [np.var(getattr(points, one)[inside]) for one in axes]
    return float(np.sqrt(np.sum(variances))), units[axes[0]]


def _count(run: Run, name: str, within: Window, _: bool) -> Number:
    return float(np.count_nonzero(_points(run, name, within)[1])), "-"


def of_shares(run: Run, joint: str, within: Window, words: Iterable[str]) -> list[float]:
    """The numbers of a contact that these words of OF_SHARES name."""
    found = shares(run, joint, within)
    return [float(getattr(found, OF_SHARES[word][0])) for word in words]


def _of_shares(word: str, run: Run, joint: str, within: Window, _: bool) -> Number:
    return of_shares(run, joint, within, [word])[0], OF_SHARES[word][1]


# --- of the file -----------------------------------------------------------------------------

UNITS = {"time": "s", "peak_time": "s", "integration_cpu": "s"}
UNITS |= {"energy_residual": "J", "work_of_projection": "J"}
OF_CONTACTS = {
    "peak_force": ("contact_force", "normal_force"),
    "fastest_impact": ("penetration",),
}


def _kept(group: str, run: Run, path: str, _: Window, __: bool) -> Number:
    inner: Any = run.summary if group == "summary" else run.group(group)
    for key in path.split("."):
        if not isinstance(inner, dict) or key not in inner:
            words = inner if isinstance(inner, dict) else ()
            raise UsageError(f"{run.path}: no '{path}' in its {group}", known(key, words))
        inner = inner[key]
    if not isinstance(inner, int | float):
        raise UsageError(f"{run.path}: '{path}' in its {group} is no number", FORM)
    return float(inner), _unit_of(run, path)


def _unit_of(run: Run, path: str) -> str:
    """The unit of a number of the summary or of the solver."""
    first, _, rest = path.partition(".")
    joint, _, key = rest.rpartition(".")
    if first != "contacts" or key not in OF_CONTACTS or joint not in run.contacts:
        return UNITS.get(path.rpartition(".")[2], "-")
    own = run.contact_unit(joint, *OF_CONTACTS[key])
    return own if key == "peak_force" else f"{own}/s"


# what shares.py calls them, and their units
OF_SHARES = {word: (word, "-") for word in ("flight", "contact", "following", "impacts", "onsets")}
OF_SHARES["between"] = "mean_between", "s"
WHOLE = ("summary", "solver")
MEANT = {"max": "peak", "maximum": "peak", "min": "least", "minimum": "least", "average": "mean",
         "end": "final", "last": "final"}  # fmt: skip
KINDS: dict[str, Callable[[Run, str, Window, bool], Number]] = {
    "peak": partial(_extreme, LARGEST),
    "least": partial(_extreme, SMALLEST),
    "range": _range,
    "mean": partial(_of_rows, np.mean),
    "rms": partial(_of_rows, lambda x: np.sqrt(np.mean(x**2))),
    "std": partial(_of_rows, np.std),
    "fluctuation": _fluctuation,
    "final": partial(_of_rows, lambda x: x[-1]),
    "dispersion": _dispersion,
    "points": _count,
    **{word: partial(_of_shares, word) for word in OF_SHARES},
    **{group: partial(_kept, group) for group in WHOLE},
}
# of what the solver located: the output rows have no say
LOCATED = ("dispersion", "points", *OF_SHARES)
