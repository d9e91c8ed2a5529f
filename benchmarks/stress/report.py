"""Tells of the cells: docs/stress.md with its tables, and the map docs/stress.png."""

from collections import Counter
from pathlib import Path
from typing import Any

import numpy as np

from benchmarks.docs.marks import END, opening
from benchmarks.measure import ROOT
from benchmarks.stress.cells import METHODS, SYSTEMS
from benchmarks.stress.judge import CONVERGED, REFUSED, SAID_SO, UNJUDGED, WRONG

VERDICTS = (CONVERGED, REFUSED, SAID_SO, UNJUDGED, WRONG)
COLOURS = {CONVERGED: "#2a9d5c", REFUSED: "#7a8fb0", SAID_SO: "#e9b949", UNJUDGED: "#cccccc",
           WRONG: "#c0322b"}  # fmt: skip
DOC, MAP = ROOT / "docs" / "stress.md", ROOT / "docs" / "stress.png"
Cell = dict[str, Any]


def counted(cells: list[Cell], key: str, values: tuple[Any, ...]) -> str:
    """A table: verdicts over the values of one key."""
    lines = [f"| {key} | {' | '.join(VERDICTS)} |", "|---" * (len(VERDICTS) + 1) + "|"]
    for value in values:
        count = Counter(cell["verdict"] for cell in cells if cell[key] == value)
        told = value if isinstance(value, str) else f"{value:g}"
        lines.append(f"| {told} | {' | '.join(str(count[v]) for v in VERDICTS)} |")
    return "\n".join(lines)


def levels(cells: list[Cell], key: str) -> tuple[Any, ...]:
    return tuple(sorted({cell[key] for cell in cells}))


def reasons(cells: list[Cell]) -> str:
    """How often each reason was given, numbers and names left out."""
    count: Counter[str] = Counter()
    for cell in cells:
        if cell["verdict"] in (REFUSED, SAID_SO, UNJUDGED):
            count[f"{cell['verdict']}: {plain(cell['reason'])}"] += 1
    return "\n".join(f"* {n} {told}" for told, n in count.most_common())


def plain(reason: str) -> str:
    """The kind of a reason."""
    for words in ("not stable: rk4 needs", "energy book open", "more than", "no static equilibrium",
                  "indifferent", "without bound", "locks", "works of the energy book",
                  "faster than", "too large",
                  "too unequal", "resolution of time", "horizon did not end"):  # fmt: skip
        if words in reason:
            return {"more than": "more steps than allowed"}.get(words, words)
    return reason.splitlines()[0][:80] if reason else "?"


def write(cells: list[Cell], commit: str) -> None:
    """Both files."""
    judged = [c for c in cells if c["verdict"] in (CONVERGED, WRONG)]
    errors = np.array([c["peak_error"] for c in judged])
    text = DOC_TEXT.format(
        n=len(cells), cases=len({c["case"] for c in cells}), commit=commit,
        counts=", ".join(f"{v}: {sum(c['verdict'] == v for c in cells)}" for v in VERDICTS),
        median=np.median(errors), most=np.quantile(errors, 0.95), worst=errors.max(),
        chaotic=np.mean([c["horizon"] < 1.0 for c in judged]),
        methods=counted(cells, "method", METHODS), systems=counted(cells, "system", tuple(SYSTEMS)),
        clearance=counted(cells, "clearance", levels(cells, "clearance")),
        stiffness=counted(cells, "stiffness", levels(cells, "stiffness")),
        speed=counted(cells, "speed", levels(cells, "speed")),
        friction=counted(cells, "friction", levels(cells, "friction")),
        restitution=counted(cells, "restitution", levels(cells, "restitution")),
        mark=marker(cells), end=END, reasons=reasons(cells), wrong="\n".join(
            f"* {c['case']}, {c['method']} at {c['setting']:g}: peaks off by "
            f"{100 * c['peak_error']:.2g} %, path by {c['path_error']:.2g}, "
            f"horizon {c['horizon']:.2f} of the run"
            for c in cells if c["verdict"] == WRONG) or "None.",
    )  # fmt: skip
    DOC.write_text(text)
    draw(cells, MAP)


def marker(cells: list[Cell]) -> str:
    """The first marker (benchmarks/docs); no digest where cells are of different sources."""
    made = {cell.get("from", "") for cell in cells}
    return opening("stress", made.pop() if len(made) == 1 and "" not in made else "0" * 12)


def draw(cells: list[Cell], path: Path) -> None:
    """A square for each cell: cases from left to right, methods from top to bottom."""
    import matplotlib as mpl

    mpl.use("Agg")
    import matplotlib.pyplot as plt
    from matplotlib.patches import Patch

    figure, every = plt.subplots(len(SYSTEMS), 1, figsize=(11, 12), layout="constrained")
    for axes, system in zip(every, SYSTEMS, strict=True):
        own = [c for c in cells if c["system"] == system]
        order = {"stiffness": 0, "clearance": 1, "friction": 2}
        cases = sorted({(*(c[k] for k in order), c["case"]) for c in own})
        column = {case[-1]: k for k, case in enumerate(cases)}
        for c in own:
            x, y = column[c["case"]], METHODS.index(c["method"])
            axes.add_patch(plt.Rectangle((x, y), 0.92, 0.88, color=COLOURS[c["verdict"]]))
            if c["verdict"] in (CONVERGED, WRONG):
                axes.text(x + 0.46, y + 0.46, f"{np.log10(max(c['peak_error'], 1e-9)):.0f}",
                          ha="center", va="center", fontsize=7, color="white")  # fmt: skip
        axes.set(xlim=(0, len(cases)), ylim=(len(METHODS), 0), title=system)
        axes.set_yticks(np.arange(len(METHODS)) + 0.44, METHODS, fontsize=8)
        labels = [f"{k:g}\n{1e3 * c:g}\n{f:g}" for k, c, f, _ in cases]
        axes.set_xticks(np.arange(len(cases)) + 0.46, labels, fontsize=7)
        axes.tick_params(length=0)
        axes.set_xlabel(
            "stiffness factor, clearance in mm, friction (from top to bottom)", fontsize=8
        )
    figure.legend(handles=[Patch(color=COLOURS[v], label=v) for v in VERDICTS], ncols=5,
                  loc="outside lower center")  # fmt: skip
    figure.suptitle("Stress: verdict of every cell; numbers: log10 of the error of the peaks")
    figure.savefig(path, dpi=110, bbox_inches="tight")
    plt.close(figure)


DOC_TEXT = """# Stress: contact far from comfortable

`make stress` runs {n} cells: {cases} cases, each by five methods. Run it again to resume. The
cases cover clearance from 1 µm to 5 mm, restitution 0 to 1, friction 0 to 1, speed 0.01 to 10
m/s, and contact stiffness 1/1000 to 1000 times that of steel. Every level occurs equally often in
each of five mechanisms: the reverser from before the touch of its lug with clearance at one or
two pins, the same with clearance at both ends of a light rod (0.5 kg and 0.3 kg), and a
slider-crank. Tolerances are 1e-4, 1e-5 and 1e-6; steps of rk4 10, 2 and 1 µs. A run has at most
150 000 steps, by generalised-alpha, whose steps are short and cheap, 600 000.

The truth of a cell is another method at a tolerance 100 times tighter. A run is also compared
with a twin, which has a fifth of its tolerance and another first step. At the *predictability
horizon* the two part: the path of a journal differs by 0.5 % of itself, or a largest force by 1
%. Before the horizon the largest force of every contact must agree with the truth to 2 %. Before
a cell counts as wrong, the twin must agree with its own twin too.

* **converged**: done, energy book closed to 1e-3, peaks within 2 % of the truth
* **refused**: not begun, with the reason
* **said so**: ended `failed` with a reason, or done with a warning that the
  energy book is open or its works are wrong
* **unjudged**: done, but no other method reached the end at the tighter tolerance
* **WRONG**: done without a warning that its books are open or its works wrong, and not within 2 %

{mark}

{counts}.  Version {commit}.  Errors of the peaks of what was judged: median {median:.1e}, 95 %
below {most:.1e}, worst {worst:.1e}; {chaotic:.0%} of these runs part from their twin before their
end.

![map](stress.png)

{methods}

{systems}

{clearance}

{stiffness}

{speed}

{friction}

{restitution}

## Reasons given

{reasons}

## Wrong

{wrong}

{end}
"""
