"""Sobol indices as bars with their intervals, and how they settle with more cases."""

from pathlib import Path
from typing import Any

import numpy as np

from trsim.analyse.outputs import scalar
from trsim.analyse.sobol import Indices, blocks, factors, impossible, indices, named, places
from trsim.report.asked import Found, Value, file_name, nothing, table
from trsim.report.display import short
from trsim.report.keys import in_words, readable
from trsim.report.style import COLOURS, colour, look, panels, save


def sobol(study: Any, word: str, folder: Path) -> Found:
    """Indices of one number, of each named case, as figure and table."""
    found, units = nothing(), []

    def number(case: Any) -> float:
        if case.status != "done":
            return float("nan")
        value, unit = scalar(case.run(), word)
        units.append(unit)
        return value

    for name, cases in named(study).items():
        values, left_out = blocks(places(study, cases), number)
        of = indices(factors(study), values, word, units[-1], left_out)
        file = file_name("sobol", f"{word} {name}")
        with look():
            found.files.append(save(indexed(of, name), folder / f"{file}.png"))
        rows = [tuple(one[:7]) for one in of.indices]
        titles = ("key", "first", "first low", "first high", "total", "total low", "total high")
        found.files.append(table(folder / f"{file}.csv", titles, rows))
        for one in of.indices:
            what = f"{word}: of {one.key}"
            half = [0.5 * (one.first_high - one.first_low), 0.5 * (one.total_high - one.total_low)]
            found.values.append(Value(name, f"{what}, first", one.first, half[0], "-"))
            found.values.append(Value(name, f"{what}, total", one.total, half[1], "-"))
            noise = "  (ought to have none: noise)" if one.noise else ""
            found.lines.append(
                f"{what}: first {one.first:.3f} ({one.first_low:.3f} .. {one.first_high:.3f}), "
                f"total {one.total:.3f} ({one.total_low:.3f} .. {one.total_high:.3f}){noise}"
            )
        found.lines.extend(f"{word}: too few rows: {what}" for what in impossible(of))
    return found


def indexed(of: Indices, name: str) -> Any:
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
    mean = f"mean {short(of.mean)}, standard deviation {short(of.deviation, 3)} {of.unit}"
    left = f", {of.left_out} rows left out" if of.left_out else ""
    head = f"Sobol indices of {in_words(of.word)}{f' ({name})' if name else ''}"
    made.suptitle(f"{head}\n{mean}{left}", fontsize=10)
    return made
