"""Sobol indices as bars with their intervals, and how they settle with more cases."""

from pathlib import Path
from typing import Any

import numpy as np

from trsim.analyse.cases import Numbers, reasons
from trsim.analyse.sobol import Indices, blocks, factors, impossible, indices, named, places
from trsim.errors import Problems, TrsimError, UsageError
from trsim.report.asked import Found, Value, file_name, nothing, table
from trsim.report.display import Shown, short
from trsim.report.keys import in_words, readable
from trsim.report.style import COLOURS, colour, draw, panels


def sobol(study: Any, one: Shown, of: Numbers, folder: Path) -> Found:
    """Indices of one number, of each named case, as figure and table.

    A named case that has none is told of; raises UsageError where no one has.
    """
    found, wrong = nothing(), list[TrsimError]()
    for name, cases in named(study).items():
        try:
            values, left_out = blocks(
                places(study, cases), lambda case: of.values.get(case.name, np.nan)
            )
            each = indices(factors(study, cases), values, of.word, of.unit, left_out)
        except UsageError as error:
            what = f"{name}: {error.what}" if name else error.what
            wrong.append(UsageError(what, error.hint))
            continue
        found.add(written(each, name, one, folder))
    if not found.files:
        raise wrong[0] if len(wrong) == 1 else Problems(wrong)
    found.lines.extend(f"{error.what}: no Sobol indices of {of.word}" for error in wrong)
    found.lines.extend(reasons(of.why))
    return found


def written(of: Indices, name: str, one: Shown, folder: Path) -> Found:
    """The figure, the table and the lines of the indices of one named case."""
    found, file = nothing(), file_name("sobol", f"{of.word} {name}")
    found.files.append(draw(folder / f"{file}.png", indexed, of, name, one))
    titles = ("key", "first", "first low", "first high", "total", "total low", "total high")
    found.files.append(table(folder / f"{file}.csv", titles, [tuple(i[:7]) for i in of.indices]))
    for each in of.indices:
        what = f"{of.word}: of {each.key}"
        half = [0.5 * (each.first_high - each.first_low), 0.5 * (each.total_high - each.total_low)]
        found.values.append(Value(name, f"{what}, first", each.first, half[0], "-"))
        found.values.append(Value(name, f"{what}, total", each.total, half[1], "-"))
        noise = "  (ought to have none: noise)" if each.noise else ""
        found.lines.append(
            f"{what}: first {each.first:.3f} ({each.first_low:.3f} .. {each.first_high:.3f}), "
            f"total {each.total:.3f} ({each.total_low:.3f} .. {each.total_high:.3f}){noise}"
        )
    found.lines.extend(f"{of.word}: too few rows: {what}" for what in impossible(of))
    return found


def indexed(of: Indices, name: str, run: Shown) -> Any:
    """Bars with intervals; beside them how they settle with the number of rows."""
    made, axes = panels(1, 2, height=4.0, width_ratios=(3, 2))
    bars, settling = axes[0]
    at = np.arange(len(of.indices))
    for shift, kind, k in ((-0.2, "first", 0), (0.2, "total", 1)):
        value = np.array([getattr(one, kind) for one in of.indices])
        low = np.array([getattr(one, f"{kind}_low") for one in of.indices])
        high = np.array([getattr(one, f"{kind}_high") for one in of.indices])
        bars.bar(at + shift, value, 0.36, color=COLOURS[k], alpha=0.85, label=f"{kind} order",
                 yerr=np.maximum([value - low, high - value], 0.0), ecolor="0.2",
                 error_kw={"lw": 0.8, "capsize": 2})  # fmt: skip
    names = [readable(one.key) + (" (noise)" if one.noise else "") for one in of.indices]
    bars.set_xticks(at, names, rotation=25 if len(at) > 2 else 0, ha="right" if len(at) > 2
                    else "center")  # fmt: skip
    bars.set_ylabel("share of the variance (-)")
    bars.axhline(0.0, color="0.3", lw=0.6)
    bars.legend(loc="lower center", bbox_to_anchor=(0.5, 1.0), ncols=2)
    rows = [step[0] for step in of.convergence]
    for i, each in enumerate(names):
        totals = [step[2][i] for step in of.convergence]
        settling.plot(rows, totals, "o-", ms=3, color=colour(i), label=each)
    settling.set_xscale("log", base=2)
    settling.set_xticks(rows, [str(n) for n in rows])
    settling.minorticks_off()
    settling.set_xlabel("rows of each block")
    settling.set_ylabel("total index (-)")
    lines, told = settling.get_legend_handles_labels()
    made.legend(lines, told, loc="outside lower center", ncols=3, title="total index of")
    factor, unit = run.display(of.unit)
    numbers = short(of.mean * factor), short(of.deviation * factor, 3)
    mean = f"mean {numbers[0]}, standard deviation {numbers[1]}{'' if unit == '-' else f' {unit}'}"
    left = f", {of.left_out} rows left out" if of.left_out else ""
    head = f"Sobol indices of {in_words(of.word)}{f' ({name})' if name else ''}"
    made.suptitle(f"{head}\n{mean}{left}", fontsize=10)
    return made
