"""The figures of a study: chosen numbers over what was swept, and what else is asked of it."""

from collections.abc import Mapping
from itertools import chain, groupby
from pathlib import Path
from typing import Any

import numpy as np

from trsim.analyse.bifurcation import check_swept, diagram
from trsim.analyse.cases import (
    Numbers,
    no_result,
    numbers,
    numeric,
    reasons,
    shorter,
    spared,
    unfinished,
    varied,
    without,
)
from trsim.analyse.cases import needed as of_needed
from trsim.analyse.fluctuation import shows
from trsim.errors import FileError, UsageError
from trsim.report import case_bars, case_table, envelopes, maps, style
from trsim.report.asked import Asked, Found, Value, file_name, nothing
from trsim.report.asked import words as parted_words
from trsim.report.diagrams import bifurcation
from trsim.report.display import Shown, compared
from trsim.report.keys import Units, axis, in_words, named_value
from trsim.report.sobol import sobol
from trsim.report.style import NO_NUMBER, colour, missed, panels
from trsim.scenario.vary import SAMPLED
from trsim.statuses import WELL

SERIES = 8  # curves of a family that have a line in the legend


def shown(study: Any, asked: Mapping[str, tuple[float, str]] | None = None) -> Shown:
    """A run of the study, for its units; raises UsageError or FileError where none can be read."""
    wrong: UsageError | FileError = no_result()
    for case in study.cases:
        if case.status in WELL:
            try:
                return compared([case.run()], asked)[0]
            except FileError as error:
                wrong = error
    raise wrong


def units(study: Any) -> Units:
    """The units of what was swept."""
    return Units(study.units, study.written)


def draw(
    study: Any,
    asked: Asked,
    words: list[str],
    folder: Path,
    chosen: Mapping[str, tuple[float, str]] | None = None,
) -> Found:
    """What was asked for of a study; its chosen numbers where nothing was.

    chosen: units in place of SI ones.  Cases that were not needed are in maps and designs alone.
    """
    one, found = shown(study, chosen), nothing()
    whole, study = study, of_needed(study)
    if not any((words, asked.bifurcation, asked.sobol, asked.map, asked.bars, asked.envelope)):
        words = usual(one)
    bars = [parted_words([text]) for text in asked.bars]
    of = numbers(study, dict.fromkeys([*words, *asked.sobol, *asked.map, *chain(*bars)]))
    for word in asked.bifurcation:
        drawn = diagram(study, word, asked.over)
        found.add(bifurcation(one, drawn, folder))
        found.lines.extend(without(study, drawn.over))
    for word in asked.sobol:
        found.add(sobol(whole, one, of[word], folder))
    for word in asked.map:
        found.add(maps.drawn(whole, one, of[word], asked.over, folder))
    for group in bars:
        found.add(case_bars.draw(study, one, [of[word] for word in group], folder))
    if asked.envelope:
        found.add(envelopes.draw(study, one, asked, folder))
    if bars:
        found.lines.extend(shorter(study))
    if words:
        found.add(outputs(study, one, [of[word] for word in words], asked.over, folder))
    lines = [*found.lines, *spared(whole), *unfinished(study)]
    found.lines[:] = dict.fromkeys(lines)  # what is in the way of several is told once
    return found


def usual(one: Shown) -> list[str]:
    """The numbers of a study asked for none: peaks of contacts and drives, fluctuations."""
    run = one.run
    found = [f"peak:{n}.{k}" for n in run.contacts for k in ("contact_force", "normal_force")
             if f"{n}.{k}" in run.units]  # fmt: skip
    found += [f"{kind}:{n}.force" for n, part in run.parts.items() if part.section == "drives"
              for kind in ("peak", "least") if f"{n}.force" in run.units]  # fmt: skip
    words = [f"fluctuation:{n}.rate" for n, part in run.parts.items()
             if part.section == "sensors" and f"{n}.rate" in run.units]  # fmt: skip
    found += [word for word in words if run.kept(word) is not None or shows(run.time)]
    return found or ["summary:time"]


# --- chosen numbers --------------------------------------------------------------------------


def outputs(study: Any, one: Shown, of: list[Numbers], over: str | None, folder: Path) -> Found:
    """sweep.csv, and a figure of each number over what was swept."""
    found, names = nothing(), [case.name for case in study.cases]
    keys = drawn_over(study, over)
    found.values.extend(
        Value(n, each.word, each.values[n] * factor, np.nan, text)
        for each in of
        for factor, text in [one.told(each.unit)]
        for n in names
    )
    found.files.append(case_table.written(folder / "sweep.csv", study, one, of))
    for each in of:
        found.lines.extend(reasons(each.why))
        y = np.array([each.values[name] for name in names])
        path = folder / f"{file_name('sweep', each.word)}.png"
        found.files.append(style.draw(path, figure, study, one, each.word, each.unit, y, over))
    for key in keys:
        found.lines.extend(without(study, key))
    return found


def drawn_over(study: Any, over: str | None) -> list[str]:
    """The keys that figures are over: of samples each, else the first unless one is named."""
    keys = [key for key in study.keys if key != "case"] or list(study.keys)
    check_swept(study, over)
    return [over] if over else keys if study.method in SAMPLED else keys[:1]


def figure(study: Any, one: Shown, word: str, unit: str, y: Any, over: str | None) -> Any:
    """Lines over one key, a curve for each value of the others; of samples points per key."""
    drawn = drawn_over(study, over)
    width = min(len(drawn), 3)
    made, axes = panels(-(-len(drawn) // width), width, height=2.9 if width == 1 else 2.3,
                        sharey=True)  # fmt: skip
    factor, text = one.display(unit)
    for a, key in zip(axes.flat, drawn, strict=False):
        lines(a, study, one, key, y * factor, joined=study.method not in SAMPLED)
        a.set_xlabel(axis(one, units(study), key))
    for a in axes.flat[len(drawn) :]:
        a.axis("off")
    for a in axes[:, 0]:
        kind = word.partition(":")[0]
        a.set_ylabel(f"{kind} ({text})")
    handles, labels = axes.flat[0].get_legend_handles_labels()
    if len(labels) > 1 or NO_NUMBER in labels:
        made.legend(handles, labels, loc="outside lower center",
                    ncols=1 if max(map(len, labels)) > 34 else 3)  # fmt: skip
    made.suptitle(in_words(word), fontsize=10)
    return made


def lines(axes: Any, study: Any, one: Shown, key: str, y: Any, joined: bool) -> None:
    """The values of all cases over one key; of a grid joined where all others are the same.

    A case without a number keeps its place on the axis, and has a cross there.
    """
    values = varied(study, key)
    words = not numeric(values)
    places = {v: k for k, v in enumerate(dict.fromkeys(map(str, values)))}
    factor = 1.0 if words else units(study).display(one, key)[0]

    def place(case: Any) -> float:
        return places[str(case.values[key])] if words else case.values[key] * factor

    def series(pair: Any) -> str:
        case = pair[0]
        others = [
            k for k in study.keys if k != key and k in case.values and (joined or k == "case")
        ]
        return ", ".join(named_value(one, units(study), k, case.values[k]) for k in others)

    given = [pair for pair in zip(study.cases, y.tolist(), strict=True) if key in pair[0].values]
    families = [(name, list(group)) for name, group in groupby(sorted(given, key=series), series)]
    order = list(dict.fromkeys(map(series, given)))
    for k, (name, group) in enumerate(sorted(families, key=lambda f: order.index(f[0]))):
        rows = sorted((place(case), value) for case, value in group)
        label = name if k < SERIES else None
        axes.plot(*zip(*rows, strict=True), "o-" if joined and not words else "o", ms=3.5,
                  color=colour(k), mec="white", mew=0.4, label=label)  # fmt: skip
    missed(axes, [place(case) for case, value in given if np.isnan(value)])
    if words:
        axes.set_xticks(range(len(places)), list(places), rotation=30 if len(places) > 4 else 0)
        axes.set_xlim(-0.5, len(places) - 0.5)
