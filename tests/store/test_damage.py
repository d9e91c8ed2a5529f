"""Files cut short or changed: read in a process of its own, noticed or harmless."""

import json
import subprocess
import sys

import numpy as np
import pytest

from tests.store.outside import ROOT
from trsim.store.hdf5 import read

# reads damaged copies of a file: argv = original, work file, kind, first case, end, seed
READER = """
import json, sys
import numpy as np
from pathlib import Path
from trsim.errors import FileError
from trsim.store.read import read, verify

original, work, kind, begin, end, seed = sys.argv[1:]
whole = bytearray(Path(original).read_bytes())
good = read(original)
expected = {name: good.channel(name) for name in good.names}
rng = np.random.default_rng(int(seed))
places = rng.integers(1, len(whole), 10_000)
bits = rng.integers(0, 8, 10_000)
for k in range(int(begin), int(end)):
    damaged = whole.copy()
    if kind == "cut":
        del damaged[places[k]:]
    else:
        damaged[places[k]] ^= 1 << bits[k]
    Path(work).write_bytes(damaged)
    try:
        outcome = "changed" if not verify(work) else "harmless"
        if outcome == "harmless":
            run = read(work)
            same = all(np.array_equal(run.channel(n), expected[n]) for n in good.names)
            outcome = "harmless" if same else "MISSED"
    except FileError:
        outcome = "refused"
    except MemoryError:
        outcome = "refused"
    print(k, outcome, flush=True)
"""


def outcomes(result, folder, kind, count, limit=20.0):
    """What became of each damaged copy; a reader that dies or hangs costs one of them."""
    found = {}
    while len(found) < count:
        words = (result.path, folder / "d.h5", kind, len(found), count, 11)
        command = [sys.executable, "-c", READER, *map(str, words)]
        try:
            done = subprocess.run(  # noqa: S603
                command, cwd=ROOT, capture_output=True, text=True, timeout=limit
            )
            out, ended = done.stdout, "died" if done.returncode < 0 else done.stderr[-800:]
        except subprocess.TimeoutExpired as error:
            out, ended = (error.stdout or b"").decode(), "hung"
        for line in out.splitlines():
            found[int(line.split()[0])] = line.split()[1]
        if len(found) < count:
            assert ended in ("died", "hung"), ended
            found[len(found)] = ended
    names, counts = np.unique(list(found.values()), return_counts=True)
    return dict(zip(names.tolist(), counts.tolist(), strict=True))


def test_truncated(result, tmp_path):
    found = outcomes(result, tmp_path, "cut", 30)
    print(f"30 truncations: {found}")
    assert found == {"refused": 30}


def test_flipped(result, tmp_path):
    found = outcomes(result, tmp_path, "flip", 200)
    print(f"200 flipped bits: {found}")
    assert "MISSED" not in found
    assert found.get("died", 0) + found.get("hung", 0) <= 2


@pytest.mark.parametrize("share", [0.3, 0.6, 0.9])
def test_truncated_part_is_settled_at_once_and_recovered(share, running_part, tmp_path):
    """HDF5 in SWMR mode would go on looking for what is not there."""
    content = running_part.read_bytes()
    (tmp_path / "x.h5.part").write_bytes(content[: int(share * len(content))])
    for name in ("show", "recover"):
        done = subprocess.run(  # noqa: S603
            [sys.executable, "-m", "trsim", name, "x.h5.part", "--json"],
            cwd=tmp_path, env={"PYTHONPATH": str(ROOT)}, capture_output=True, text=True, timeout=20,
        )  # fmt: skip
        document = json.loads(done.stdout)
        if name == "show" and done.returncode == 7:
            assert "trsim recover" in document["errors"][0]["hint"]
            continue
        print(f"cut at {share:.0%}, {name}: {document.get('rows', document['errors'])}")
        assert done.returncode in (0, 7)
        if name == "recover" and done.returncode == 0:
            run = read(tmp_path / "x.recovered.h5")
            assert np.all(np.diff(run.time) > 0.0)
            assert np.all(np.isfinite(run.channel("B.force")))
