"""The generator finds trsim broken on purpose: in a copy, one function at a time."""

import os
import shutil
import subprocess
import sys
from pathlib import Path

import pytest

from tests.sizes import RELEASE

from .ledger import ROOT

BREAKS = {
    # no interval is looked into: what changes and changes back inside a step is missed
    "events": (
        "stops",
        [
            (
                "trsim/solve/march/events.py",
                "    if L >= 0.0 and f0 + f1 > L * length:\n",
                "    if L < 9e99:\n",
            )
        ],
    ),
    # nobody looks at rows that were dropped, or at mechanisms that move to first order only
    "rows": (
        "taut",
        [
            (
                "trsim/solve/outcome.py",
                "elif len(model.redundant) or mechanism.stages.switches.names:",
                "elif False:",
            ),
            (
                "trsim/assemble/rows.py",
                '    """Refuse joints that are proved',
                '    return\n    """',
            ),
        ],
    ),
    # extremes are those of rows and ends of steps
    "peaks": (
        "loop",
        [
            (
                "trsim/solve/march/peaks.py",
                "    if s.sought.size == 0:  #",
                "    if s.sought.size >= 0:  #",
            )
        ],
    ),
    # the axis of a slide that a gear moves turns with its carrier, and has no Coriolis term
    "geared": (
        "geared",
        [
            (
                "trsim/elements/transmission.py",
                "        + 2.0 * dot(cross(spin(V, i), axis), d_dot)\n",
                "        + 1.0 * dot(cross(spin(V, i), axis), d_dot)\n",
            )
        ],
    ),
    # steps may turn a joint by any angle
    "branch": (
        "turns",
        [("trsim/solve/march/turns.py", "MOST, ASIDE = 2.0, 1.0", "MOST, ASIDE = 9e9, 9e9")],
    ),
}
TRY = """
import sys
from tests.truth.trial import cautious
for seed in range({n}):
    v = cautious({family!r}, seed)
    if v.verdict == "WRONG":
        sys.exit(f"found: {{v.family}} {{v.seed}} {{v.what}}")
"""


def broken(name: str, folder: Path, n: int = 40) -> str:
    """What the generator says of a broken copy."""
    family, edits = BREAKS[name]
    for part in ("trsim", "tests"):
        shutil.copytree(ROOT / part, folder / part, ignore=shutil.ignore_patterns("data"))
    for file, old, new in edits:
        text = (folder / file).read_text()
        assert text.count(old) == 1, (file, old)
        (folder / file).write_text(text.replace(old, new))
    env = {**os.environ, "PYTHONPATH": str(folder)}
    asked = [sys.executable, "-c", TRY.format(n=n, family=family)]
    done = subprocess.run(asked, cwd=folder, env=env, capture_output=True, text=True, check=False)  # noqa: S603
    return done.stderr


@pytest.mark.parametrize("name", BREAKS)
def test_what_is_to_break_is_there(name):
    """So that the others, which only a release tries, break what they say."""
    for file, old, new in BREAKS[name][1]:
        assert (ROOT / file).read_text().count(old) == 1, (file, old)
        assert new != old


@pytest.mark.skipif(not RELEASE, reason="compiles a solver for each: TRSIM_SIZE=release")
@pytest.mark.parametrize("name", BREAKS)
def test_what_is_broken_is_found(name, tmp_path):
    said = broken(name, tmp_path)
    assert "found:" in said, said[-2000:]
