"""`Sweep`: the folder of a sweep as Python reads it: cases, and their numbers in a table."""

import os
from collections.abc import Iterator
from pathlib import Path
from typing import TYPE_CHECKING, Any

from trsim.api.result import Result, factor
from trsim.errors import FileError, UsageError, described, known
from trsim.sweeps.study import Case, study

if TYPE_CHECKING:
    import pandas

    from trsim.sweeps.study import Study


class Sweep:
    """All cases of a sweep, in the order of its plan.

    folder  of the sweep
    cases   each with `name`, `status`, `reason`, and `values` of what varies, SI
    chosen  of `until` and `refine`: what came of them, and of how many cases, in words
    """

    def __init__(self, folder: str | os.PathLike) -> None:
        """Raises FileError where there is no sweep that can be read; UsageError."""
        if not isinstance(folder, str | os.PathLike):
            what = f"a sweep is the name of its folder, not {described(folder)}"
            raise UsageError(what, 'Write for example trsim.Sweep("runs/clearance").')
        self.folder = Path(folder)
        self.study: Study = study(self.folder)
        self.cases: tuple[Case, ...] = self.study.cases
        self.chosen: tuple[str, ...] = self.study.chosen

    def __repr__(self) -> str:
        done = sum(case.there for case in self.cases)
        return f"<Sweep {self.folder}: {len(self)} cases, {done} with results>"

    def __len__(self) -> int:
        return len(self.cases)

    def __iter__(self) -> Iterator[Result]:
        """The results of all cases that have a result file."""
        return (Result(case.file) for case in self.cases if case.filed)

    def __getitem__(self, case: str | int) -> Result:
        """The result of a case, by its name or its number.  Raises FileError where it has none."""
        if isinstance(case, str) and case not in self.study.named:
            hint = known(case, self.study.named)
            raise UsageError(f"{self.folder}: no case named '{case}'", hint)
        found = self.study.named[case] if isinstance(case, str) else self.cases[case]
        found.run()  # tells why there is none
        if not found.filed:
            hint = f"`trsim run {self.folder} '{found.name}'` makes it; `frame` has its numbers."
            raise FileError(f"{found.file}: the sweep kept the numbers of the case only", hint)
        return Result(found.file)

    def frame(self, *words: str, units: dict[str, str] | None = None) -> "pandas.DataFrame":
        """A row for each case: what varies, the status, and numbers by their words.

        words  as in `Result.number`
        units  word or varied key -> unit; SI where none is said.  They are in `attrs`.
        """
        import pandas

        wanted = dict(units or {})
        for name in wanted:
            if name not in (*self.study.keys, *words):
                hint = known(name, (*self.study.keys, *words))
                raise UsageError(f"a unit for '{name}', which is no column", hint)
        told = {key: wanted.get(key) or self.study.units[key] for key in self.study.keys}
        rows: list[dict[str, Any]] = []
        for case in self.cases:
            row: dict[str, Any] = {key: case.values.get(key) for key in self.study.keys}
            for key in wanted.keys() & row.keys():
                if isinstance(row[key], int | float):
                    row[key] *= factor(self.study.units[key], wanted[key])
            row["status"] = case.status
            if words:
                row |= numbers(case, words, wanted, told)
            rows.append(row)
        columns = [*self.study.keys, "status", *words]
        index = pandas.Index([case.name for case in self.cases], name="name")
        found = pandas.DataFrame(rows, index=index, columns=columns)
        found.attrs["units"] = told
        return found

    def _repr_html_(self) -> str:
        """A notebook shows the cases."""
        found: str = self.frame().to_html()
        return found


def numbers(
    case: Case, words: tuple[str, ...], wanted: dict[str, str], told: dict[str, str]
) -> dict[str, float]:
    """The numbers of a case, not a number where it has no result; `told` learns their units."""
    from trsim.analyse.outputs import scalar

    if not case.there:
        return dict.fromkeys(words, float("nan"))
    run, found = case.run(), {}
    for word in words:
        value, si = scalar(run, word)
        found[word] = value * factor(si, wanted.get(word, ""))
        told[word] = wanted.get(word) or si
    return found
