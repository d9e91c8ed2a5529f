"""The figures of a study: chosen numbers over what was swept, and what else is asked of it."""

from itertools import groupby
from pathlib import Path
from typing import Any

import numpy as np

from trsim.analyse.bifurcation import diagram
from trsim.analyse.outputs import scalar
from trsim.errors import UsageError
from trsim.report.asked import Asked, Found, Value, file_name, nothing, table
from trsim.report.diagrams import bifurcation
from trsim.report.display import Shown, compared
from trsim.report.keys import Units, axis, in_words, named_value
from trsim.report.sobol import sobol
from trsim.report.style import colour, look, panels, save

SERIES = 8  # curves of a family that have a line in the legend


def shown(study: Any) -> Shown:
    """A run of the study, for its units; raises UsageError where none is done."""
    for case in study.cases:
        if case.status == "done":
            return compared([case.run()])[0]
    raise UsageError("no case of the study has a result", "Run the sweep first.")


def units(study: Any) -> Units:
    """Of what was swept."""
    return Units(study.units, study.written)


def draw(study: Any, asked: Asked, words: list[str], folder: Path) -> Found:
    """What was asked for of a study; its chosen numbers where nothing was."""
    one, found = shown(study), nothing()
    for word in asked.bifurcation:
        found.add(bifurcation(one, diagram(study, word, asked.over), folder))
    for word in asked.sobol:
        found.add(sobol(study, word, folder))
    if words or not (asked.bifurcation or asked.sobol):
        found.add(outputs(study, one, words or usual(one), asked.over, folder))
    return found


def usual(one: Shown) -> list[str]:
    """The numbers of a study that was asked for none: peaks of contacts and drives."""
    run = one.run
    found = [f"peak:{n}.{k}" for n in run.contacts for k in ("contact_force", "normal_force")
             if f"{n}.{k}" in run.units]  # fmt: skip
    found += [f"{kind}:{n}.force" for n, part in run.parts.items() if part.section == "drives"
              for kind in ("peak", "least") if f"{n}.force" in run.units]  # fmt: skip
    found += [f"fluctuation:{n}.rate" for n, part in run.parts.items()
              if part.section == "sensors" and f"{n}.rate" in run.units]  # fmt: skip
    return found or ["summary:time"]


# --- chosen numbers --------------------------------------------------------------------------


def outputs(study: Any, one: Shown, words: list[str], over: str | None, folder: Path) -> Found:
    """sweep.csv, and a figure of each number over what was swept."""
    found, columns, units = nothing(), [], []
    for word in words:
        pairs = [scalar(c.run(), word) if c.status == "done" else None for c in study.cases]
        units.append(next((pair[1] for pair in pairs if pair), "-"))
        columns.append([pair[0] if pair else np.nan for pair in pairs])
        for case, value in zip(study.cases, columns[-1], strict=True):
            found.values.append(Value(case.name, word, value, np.nan, units[-1]))
    titles = ["case", "status", *(f"{k} [{study.units.get(k, '-')}]" for k in study.keys)]
    titles += [f"{word} [{unit}]" for word, unit in zip(words, units, strict=True)]
    rows = [
        (case.name, case.status, *(case.values[key] for key in study.keys), *numbers)
        for case, *numbers in zip(study.cases, *columns, strict=True)
    ]
    found.files.append(table(folder / "sweep.csv", titles, rows))
    left = sum(case.status != "done" for case in study.cases)
    if left:
        found.lines.append(f"{left} of {len(study.cases)} cases have no result and are left out")
    for word, unit, values in zip(words, units, columns, strict=True):
        with look():
            drawn = figure(study, one, word, unit, np.array(values), over)
            found.files.append(save(drawn, folder / f"{file_name('sweep', word)}.png"))
    return found


def figure(study: Any, one: Shown, word: str, unit: str, y: Any, over: str | None) -> Any:
    """Lines over one key, a curve for each value of the others; of samples points per key."""
    keys = [key for key in study.keys if key != "case"] or list(study.keys)
    sampled = study.method in ("latin_hypercube", "monte_carlo", "sobol")
    drawn = keys if sampled and over is None else [over or keys[0]]
    if drawn[0] not in study.keys:
        raise UsageError(f"the study does not sweep '{drawn[0]}'", f"It has {', '.join(keys)}.")
    width = min(len(drawn), 3)
    made, axes = panels(-(-len(drawn) // width), width, height=2.9 if width == 1 else 2.3,
                        sharey=True)  # fmt: skip
    factor, text = one.display(unit)
    for a, key in zip(axes.flat, drawn, strict=False):
        lines(a, study, one, key, y * factor, joined=not sampled)
        a.set_xlabel(axis(one, units(study), key))
    for a in axes.flat[len(drawn) :]:
        a.axis("off")
    for a in axes[:, 0]:
        kind = word.partition(":")[0]
        a.set_ylabel(f"{kind} ({text})")
    handles, labels = axes.flat[0].get_legend_handles_labels()
    if len(labels) > 1:
        made.legend(handles, labels, loc="outside lower center",
                    ncols=1 if max(map(len, labels)) > 34 else 3)  # fmt: skip
    made.suptitle(in_words(word), fontsize=10)
    return made


def lines(axes: Any, study: Any, one: Shown, key: str, y: Any, joined: bool) -> None:
    """The values of all cases over one key; of a grid joined where all others are the same."""
    words = not all(isinstance(case.values[key], float | int) for case in study.cases)
    places = {v: k for k, v in enumerate(dict.fromkeys(str(c.values[key]) for c in study.cases))}
    factor = 1.0 if words else units(study).display(one, key)[0]

    def series(pair: Any) -> str:
        others = [k for k in study.keys if k != key and (joined or k == "case")]
        return ", ".join(named_value(one, units(study), k, pair[0].values[k]) for k in others)

    pairs = sorted(zip(study.cases, y.tolist(), strict=True), key=series)
    families = [(name, list(group)) for name, group in groupby(pairs, series)]
    order = list(dict.fromkeys(series(p) for p in zip(study.cases, y.tolist(), strict=True)))
    for k, (name, group) in enumerate(sorted(families, key=lambda f: order.index(f[0]))):
        x = [places[str(c.values[key])] if words else c.values[key] * factor for c, _ in group]
        rows = sorted(zip(x, (value for _, value in group), strict=True))
        label = name if k < SERIES else None
        axes.plot(*zip(*rows, strict=True), "o-" if joined and not words else "o", ms=3.5,
                  color=colour(k), mec="white", mew=0.4, label=label)  # fmt: skip
    if words:
        axes.set_xticks(range(len(places)), list(places), rotation=30 if len(places) > 4 else 0)
        axes.set_xlim(-0.5, len(places) - 0.5)
