"""The table of a release run: what was drawn, what was wrong, what was refused and why."""

import re
from collections import Counter, defaultdict
from pathlib import Path
from typing import Any

import yaml

from benchmarks.docs.made import MADE
from benchmarks.docs.marks import END, digest_at, opening

from .families import INVALID, RIGID, TIGHT_RUN
from .judge import BROKEN, CRASH, REFUSED, RIGHT, TOLD, UNJUDGED, WRONG
from .ledger import ROOT, known

DOC = ROOT / "docs" / "truth.md"
HEAD = """# Truth: scenes drawn by the thousand

`make truth` draws random scenes of every family, runs each with trsim, and judges it by a method
that shares nothing with trsim's assembly or events. Methods, tolerances (1e-2 to 1e-10), numbers
of rows and speeds are drawn too. The references are:

* In general a small integrator of rigid bodies in maximal coordinates (`tests/truth`):
  quaternions, dense Cholesky factors, order 8, tolerance 1e-12, steps of at most a fiftieth of a
  turn. It locates every crossing by repeating the step. Where this is singular, the reference is
  one angle.
* `joints`, `joint_loops`, `geared` and `flat_joints` have all kinds of joints in chains and
  loops, links, gears, racks, worms and couplers on moving carriers. Their reference uses joint
  coordinates, which need no constraint rows (tests/truth/screws.py: products of exponentials of
  screws).
* `surface_contact` and `seal` have their own distances and forces (tests/truth/touches.py).
* `static_path` and `static_cam` are judged by positions at which no joint begins to move
  (tests/truth/statics.py); `phases` by both: a static phase, and the motion that follows it.
* Flexible bars are judged by a tight run of another method.

The reference works in units near one and in the axes of the drawing. The scene that trsim reads
has lengths, masses and times scaled by 1e-3 to 1e3, and is turned to any direction.

**Wrong** is a scene that ends `done` although one of these holds:

* A position, angle, velocity, acceleration, reaction, drive torque, load or work is off by more
  than max(100 tolerance, 10 stated error) of the largest of its kind in the scene (including
  speeds between rows). This is tested at the rows, and for stored extremes by comparison with the
  reference at all ends of its steps (tests/truth/extremes.py). Stated errors include what a run
  without projection reports: the effect of open joints on accelerations, and the work that
  projection did.
* It missed a crossing (event, touch, point of a section) that goes deeper than 10 tolerances of
  the size.

The bound grows with the growth of a small change of the start, divided by 20. If the scene would
still be wrong, the growth of changes of speeds at eight times on the way counts too. The growth
is that of positions and speeds, and at single rows that of the channel itself, because forces in
contacts grow more. Where the bound exceeds the whole scale, the horizon of prediction is passed
and nothing more is judged.

Before a scene counts as wrong, one more rule applies. If a contact in clearance opens by less
than a tolerance of the size in one of the two solutions and not in the other, nothing behind that
instant is judged: where it opens, another impact begins, with other damping. Such scenes are
counted as grazing.

For rk4, whose step is chosen, the tolerance is 1e-6 at 200 steps a turn. Refused scenes are
counted, because a valid scene must run. `told` are scenes without motion, scenes whose way is
accidental without projection, and scenes in which a constant-velocity joint folds to half a turn:
they must be refused, and were. Reactions of joints with redundant rows, which rigid bodies do not
determine, and the angle of a hinge in space that came apart, which is a convention, are not
compared.

`tests/truth/test_broken.py` breaks the bound of events, the check of dropped rows and the rule
for the turns of angles in a copy of trsim, one at a time, and verifies that the scenes find each
of them.

`python -m tests.truth FAMILY SEED --show` prints a scene and its judgement; `python -m
tests.truth --table` writes this page.
"""


def reason(text: str) -> str:
    """Without the numbers and names of one scene."""
    text = re.sub(r"'[^']*'", "NAME", text)
    return re.sub(r"[-+]?[0-9]+([.][0-9]+)?(e[-+]?[0-9]+)?", "N", text)[:110]


def table(lines: list[dict[str, Any]]) -> str:
    by: dict[str, list[dict[str, Any]]] = defaultdict(list)
    for line in lines:
        by[line["family"]].append(line)
    words = (RIGHT, TOLD, REFUSED, UNJUDGED, WRONG, CRASH)
    rows = [f"| family | drawn | {' | '.join(words)} | grazing | worst ratio of the right |"]
    rows.append("|---" * (len(words) + 4) + "|")
    total: Counter[str] = Counter()
    for family, of in by.items():
        count = Counter(line["verdict"] for line in of)
        total += count
        worst = max((line["ratio"] for line in of if line["verdict"] == RIGHT), default=0.0)
        grazing = sum(1 for line in of if line["grazing"])
        cells = " | ".join(str(count[w]) for w in words)
        rows.append(f"| {family} | {len(of)} | {cells} | {grazing} | {worst:.2g} |")
    cells = " | ".join(str(total[w]) for w in words)
    rows.append(f"| all | {len(lines)} | {cells} | | |")
    return "\n".join(rows)


def regressions() -> list[dict[str, Any]]:
    """Scenes that once were wrong."""
    text = (Path(__file__).parent / "regressions.yaml").read_text()
    found: list[dict[str, Any]] = yaml.safe_load(text)
    return found


def listed(lines: list[dict[str, Any]], verdicts: tuple[str, ...]) -> str:
    rows = []
    known = {(x["family"], x["seed"]): x for x in regressions()}
    for line in lines:
        if line["verdict"] in verdicts:
            what = line["what"] or line["why"]
            cause = known.get((line["family"], line["seed"]))
            if cause:
                what += f" ({cause['note']}{'' if cause.get('open') else '; mended since'})"
            text = f"* `{line['family']} {line['seed']}`, {line['method']}, tolerance "
            rows.append(f"{text}{line['tolerance']:.0e}: {line['verdict']}, {what[:240]}")
    return "\n".join(rows) or "None."


def reasons(lines: list[dict[str, Any]], verdicts: tuple[str, ...]) -> str:
    count: Counter[str] = Counter()
    for line in lines:
        if line["verdict"] in verdicts:
            count[f"{line['verdict']}, {line['family']}: {reason(line['why'])}"] += 1
    return "\n".join(f"* {n}: {text}" for text, n in count.most_common()) or "None."


def summary(lines: list[dict[str, Any]], commit: str) -> str:
    count = Counter(line["verdict"] for line in lines)
    own = sum(1 for line in lines if line["by"] not in (TIGHT_RUN, RIGID, INVALID))
    wrong = count[WRONG] + count[CRASH] + count[BROKEN]
    valid = len(lines) - count[TOLD]
    cpu = [sum(line["cpu"][k] for line in lines) for k in range(2)]
    return (
        f"Run: {len(lines)} scenes with the seeds of commit `{commit}`, {own} of them judged"
        f" without trsim's assembly and events. {wrong} were wrong; {count[REFUSED]} of {valid}"
        f" valid ones were refused ({100 * count[REFUSED] / max(valid, 1):.2f} %),"
        f" {count[UNJUDGED]} could not be judged. References took {cpu[0]:.0f} s of one processor,"
        f" trsim {cpu[1]:.0f} s.\n"
    )


def still_open(lines: list[dict[str, Any]]) -> str:
    """Scenes of the list of regressions whose cause is not mended."""
    here = {(line["family"], line["seed"]) for line in lines}
    left = [x for x in regressions() if x.get("open") and (x["family"], x["seed"]) not in here]
    return "\n".join(f"* `{x['family']} {x['seed']}`: {x['note']}" for x in left) or "None."


def marker(commit: str) -> str:
    """The first marker of what was measured with the seeds of a commit (benchmarks/docs)."""
    return opening("truth", digest_at(MADE["truth"], commit), commit)


def write(file: Path) -> Path:
    """The page of one ledger."""
    lines = list(known(file).values())
    parts = [
        HEAD,
        marker(file.stem) + "\n",
        summary(lines, file.stem),
        table(lines),
        "\n## By method\n",
        table([line | {"family": line["method"]} for line in lines]),
        "\n## Wrong\n",
        listed(lines, (WRONG, CRASH, BROKEN)),
        "\nOf earlier seeds (`tests/truth/regressions.yaml`) still open:\n",
        still_open(lines),
        "\n## Refused, and why\n",
        reasons(lines, (REFUSED,)),
        "\n## Scenes without motion, and what was said\n",
        reasons(lines, (TOLD,)),
        "\n## Not judged\n\nThe reference itself could not tell, or the horizon is at the start.\n",
        reasons(lines, (UNJUDGED,)),
        f"\n{END}\n",
    ]
    DOC.write_text("\n".join(parts))
    return DOC
