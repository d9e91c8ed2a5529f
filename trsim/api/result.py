"""`Result`: a result file as Python reads it: channels, events, peaks, numbers, figures."""

import os
import warnings
from collections.abc import Mapping
from html import escape
from pathlib import Path
from typing import TYPE_CHECKING, Any

from trsim.errors import TrsimWarning, UsageError, described, known

if TYPE_CHECKING:
    import pandas
    import xarray
    from numpy.typing import NDArray

    from trsim.api.pictures import Pictures
    from trsim.store.read import Run

TOLD = 10  # peaks in a notebook


class Result:
    """What a run left in its result file; numbers are read when they are asked for.

    file     the result file
    summary  a run in a few numbers, with the words of `trsim run --json`
    """

    def __init__(self, file: str | os.PathLike, summary: Mapping[str, Any] | None = None) -> None:
        """Raises FileError where the file is no result file that can be read; UsageError."""
        from trsim.store.read import read

        if not isinstance(file, str | os.PathLike):
            what = f"a result is the name of its file, not {described(file)}"
            raise UsageError(what, 'Write for example trsim.Result("crank.h5").')
        self.file = Path(file)
        self.run: Run = read(self.file)
        self.summary: dict[str, Any] = dict(self.run.summary if summary is None else summary)

    def __repr__(self) -> str:
        return f"<Result {self.file}: {self.status}, {self.run.rows} rows, {len(self)} channels>"

    # --- what it is ------------------------------------------------------------------------------

    @property
    def title(self) -> str:
        return str(self.run.attributes["title"])

    @property
    def status(self) -> str:
        """How the run ended: done, failed, painleve, interrupted ..."""
        return str(self.run.attributes["status"])

    @property
    def reason(self) -> str:
        """Why it failed, or which event ended it."""
        return str(self.run.attributes["reason"])

    @property
    def warnings(self) -> tuple[str, ...]:
        """What was said before and after the run."""
        return self.run.warnings

    @property
    def solver(self) -> dict[str, Any]:
        """What the solver did: steps, how the joints closed, how the energy adds up ..."""
        return self.run.group("solver")

    @property
    def scenario(self) -> dict[str, Any]:
        """The scenario it was made from, all files and changes put in."""
        return self.run.scenario

    # --- channels --------------------------------------------------------------------------------

    @property
    def names(self) -> tuple[str, ...]:
        """The channels."""
        return self.run.names

    @property
    def units(self) -> Mapping[str, str]:
        """Channel -> its SI unit."""
        return self.run.units

    @property
    def time(self) -> "NDArray[Any]":
        """Of the rows, s."""
        return self.run.time

    def __len__(self) -> int:
        return len(self.names)

    def __contains__(self, name: object) -> bool:
        return isinstance(name, str) and self.run.stores(name)

    def __getitem__(self, name: str) -> "NDArray[Any]":
        """The rows of a channel in SI units, (n) or (n, size).

        "B.force.x" is a component, "|B.force|" the magnitude.  Raises UsageError.
        """
        check_words("the name of a channel", name)
        return self.run.channel(name)

    def channel(self, name: str, unit: str = "") -> "NDArray[Any]":
        """The same in a unit of one's own: "kN"."""
        return self[name] * factor(self.run.unit(name), unit)

    def frame(self, *names: str, units: Mapping[str, str] | None = None) -> "pandas.DataFrame":
        """Channels side by side over time; all of them where none is named.

        units  channel -> its unit in the table; SI where none is said.  They are in `attrs`.
        """
        import pandas

        from trsim.store.grow import components

        wanted, columns, told = dict(units or {}), {}, {}
        chosen = names or self.names
        for name in wanted:
            if name not in chosen:
                raise UsageError(
                    f"a unit for '{name}', which is not asked for", known(name, chosen)
                )
        for name in chosen:
            rows = self.channel(name, wanted.get(name, ""))
            size = rows.shape[1] if rows.ndim == 2 else 1
            for k, column in enumerate(components(name, size)):
                columns[column] = rows[:, k] if rows.ndim == 2 else rows
                told[column] = wanted.get(name) or self.run.unit(name)
        found = pandas.DataFrame(columns, index=pandas.Index(self.time, name="time"))
        found.attrs["units"] = {"time": "s", **told}
        return found

    def dataset(self, *names: str) -> "xarray.Dataset":
        """Channels as xarray has them, with units and meanings in SI; all where none is named."""
        try:
            import xarray
        except ImportError:
            raise UsageError("xarray is not installed", "Type: pip install xarray") from None
        from trsim.store.grow import AXES, LABELS

        data: dict[str, Any] = {}
        axes: dict[str, Any] = {"time": ("time", self.time, {"units": "s"})}
        for name in names or self.names:
            rows, dims = self[name], ["time"]
            if rows.ndim == 2:
                axis = AXES.get(rows.shape[1], f"component_{rows.shape[1]}")
                dims.append(axis)
                axes[axis] = (axis, list(LABELS.get(axis, range(rows.shape[1]))))
            about = {"units": self.run.unit(name), "long_name": self.run.meaning(name)}
            data[name] = (dims, rows, about)
        return xarray.Dataset(data, axes, {"title": self.title, "status": self.status})

    # --- tables and numbers ----------------------------------------------------------------------

    @property
    def events(self) -> "pandas.DataFrame":
        """When contacts opened and closed, and what events of the scenario did; SI units."""
        import pandas

        there = self.run.events._asdict()
        if not len(there["did"]):  # without events of the scenario
            there |= {"did": "", "work": 0.0}
        return pandas.DataFrame(there)

    @property
    def peaks(self) -> "pandas.DataFrame":
        """The extremes of every channel, between rows too, with their times."""
        import pandas

        from trsim.store.peaks import Peak

        return pandas.DataFrame([one._asdict() for one in self.run.peaks], columns=Peak._fields)

    def number(self, word: str, unit: str = "") -> float:
        """One number, by the words of `trsim report --table`: "peak:B.contact_force@0.3..0.9".

        unit  of it; SI where none is said.  Raises UsageError.
        """
        from trsim.analyse.outputs import pressed, scalar

        value, si = scalar(self.run, word)
        if value == 0.0 and (text := pressed(self.run, word)):
            warnings.warn(text, TrsimWarning, stacklevel=2)
        return value * factor(si, unit)

    # --- figures ---------------------------------------------------------------------------------

    def plot(self, *words: str, window: str = "", overlay: tuple[str, ...] = ()) -> "Pictures":
        """Figures, by the words of `trsim report --plot`: "pin.contact_force : crank.angle".

        window   of the abscissa: "0..110deg"
        overlay  tables (CSV) drawn beside

        Those of `trsim report` where there is no word.  A notebook shows them.
        """
        from trsim.api.pictures import pictures

        check_words("a figure", *words)
        check_words("a window", window)
        return pictures([self.file], words, window, overlay)

    def report(self, folder: str | os.PathLike) -> list[Path]:
        """Write all figures and tables of `trsim report` into a folder; the files."""
        from trsim.report import report

        if not isinstance(folder, str | os.PathLike):
            raise UsageError(f"a folder has a name, not {described(folder)}")
        return report(self.file, folder)

    def _repr_html_(self) -> str:
        """A notebook shows how it ended and what is largest in it."""
        reason = f": {escape(self.reason)}" if self.reason else ""
        head = f"<b>{escape(self.title or self.file.name)}</b> {escape(self.status)}{reason}"
        rows = [
            f"<tr><td>{escape(one.channel)}</td><td>{escape(one.extreme)}</td>"
            f"<td>{one.value:.6g} {escape(one.unit)}</td><td>{one.time:.6g} s</td></tr>"
            for one in self.run.peaks[:TOLD]
        ]
        more = len(self.run.peaks) - len(rows)
        tail = f"<p>and {more} more in <code>.peaks</code></p>" if more > 0 else ""
        said = "".join(f"<p>warning: {escape(text)}</p>" for text in self.warnings)
        size = f"{self.run.rows} rows of {len(self)} channels in {escape(str(self.file))}"
        return f"<p>{head}</p><p>{size}</p>{said}<table>{''.join(rows)}</table>{tail}"


def check_words(what: str, *words: Any) -> None:
    """Check that words are text.  Raises UsageError."""
    for word in words:
        if not isinstance(word, str):
            raise UsageError(f"{what} is a word, not {described(word)}")


def factor(si: str, wanted: str) -> float:
    """What a number in an SI unit is multiplied by.  Raises UsageError for another dimension."""
    from trsim.errors import ScenarioError
    from trsim.units import fits, unit

    check_words("a unit", wanted)
    if not wanted:
        return 1.0
    try:
        good, size = fits(wanted, si), float(unit(wanted)[0])
    except ScenarioError as error:
        raise UsageError(error.what, error.hint) from None
    if not good:
        raise UsageError(f"'{wanted}' is no unit of a number in {si}", f"It is {si} without one.")
    return 1.0 / size
