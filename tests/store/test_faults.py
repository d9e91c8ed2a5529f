"""A disk that is full, signals, and a run of a million rows."""

import json
import signal
import time

import numpy as np
import pytest

from tests.cli.conftest import faults
from tests.elsewhere import needs
from tests.sizes import RELEASE, size
from tests.store import outside
from trsim.store.read import read

LIMITS = [3_000, 40_000, 300_000, 1_000_000, 4_000_000]  # bytes a file may have
if RELEASE:
    LIMITS += np.geomspace(2_000, 20_000_000, 95).astype(int).tolist()
ROWS = size(1_000_000, 10_000_000)
SIGNALS = [(signal.SIGINT, 130), (signal.SIGTERM, 143)]


@needs("resource")
@pytest.mark.parametrize("limit", LIMITS)
def test_full_disk(limit, tmp_path):
    """Told in two lines with path and bytes; what was flushed can be read."""
    process = outside.begun(tmp_path, limit=limit)
    _, err = process.communicate(timeout=60)
    assert process.returncode == 7, err
    part = tmp_path / "runs/crank.h5.part"
    assert not (tmp_path / "runs/crank.h5").exists()
    assert "runs/crank.h5" in err.splitlines()[0]
    assert "File too large" in err.splitlines()[0]
    assert len(err.splitlines()) <= 2, err
    length = part.stat().st_size if part.exists() else 0
    assert length <= limit
    rows = 0
    if "bytes: File too large" in err and length:
        assert f"beyond {length} bytes" in err
        run = read(part)
        rows = run.rows
        assert np.all(np.diff(run.time) > 0.0)
        assert all(np.all(np.isfinite(run.channel(name))) for name in run.names)
    print(f"at most {limit} bytes: {length} written, {rows} rows can be read")


@pytest.mark.parametrize("number, code", SIGNALS)
@pytest.mark.parametrize("wait", [0.0, 0.6])  # s; rows are flushed after half a second
def test_signal(number, code, wait, tmp_path):
    process = outside.begun(tmp_path, "--json")
    outside.blocks_until(process, wait)
    sent = time.monotonic()
    process.send_signal(number)
    out, err = process.communicate(timeout=20)
    took = time.monotonic() - sent
    print(f"{signal.Signals(number).name} after {wait} s: closed in {took:.2f} s")
    assert process.returncode == code
    document = json.loads(out[out.index("{") :])
    assert document["exit_code"] == code
    assert faults(document, "run") == []
    assert "Traceback" not in err
    part = tmp_path / "runs/crank.h5.part"
    if part.exists() or wait:  # before the first rows there is no file
        run = read(part)
        assert run.attributes["status"] == "interrupted"
        assert np.all(np.diff(run.time) > 0.0)
    found = {p.name for p in tmp_path.rglob("*") if p.is_file()}
    assert found <= {"crank.yaml", "crank.h5.part", "crank.h5.checkpoint"}


@pytest.mark.parametrize("number, code", SIGNALS)
def test_second_signal_ends_at_once(number, code, tmp_path):
    """The one that comes while the file is being closed, if it does not come too late."""
    process = outside.begun(tmp_path)
    outside.blocks_until(process, 0.3)
    sent = time.monotonic()
    while process.poll() is None and time.monotonic() - sent < 2.0:
        process.send_signal(number)
    process.communicate(timeout=20)
    assert process.returncode in (-number, code)
    print(f"second {signal.Signals(number).name}: ended after {time.monotonic() - sent:.2f} s")


# rows as fast as they can be made, and the memory the process held meanwhile
MANY = """
import json, os, resource, sys, time
import numpy as np
from tests import small
from trsim.assemble.assemble import assemble
from trsim.solve.simulate import simulate
from trsim.scenario.load import loads
from trsim.store.hdf5 import write

# few columns in the file; in memory a row is as long as ever
few = "output.channels=[stroke, crank_angle, B.force, B.penetration]"
scenario = loads(small.SLIDER_CRANK, [f"solver.end={10 * int(sys.argv[1])}us", few])
mechanism = assemble(scenario)
rows, held = int(sys.argv[1]), []
page = os.sysconf("SC_PAGE_SIZE")

def resident():
    with open("/proc/self/statm") as file:
        return int(file.read().split()[1]) * page

def blocks():
    running = simulate(scenario, mechanism)
    first = next(running)
    running.close()
    table = np.random.default_rng(1).normal(size=(500, first.rows.shape[1]))
    for n in range(0, rows, len(table)):
        table[:, 0] = 1e-5 * np.arange(n, n + len(table))
        yield first._replace(rows=table, steps=first.steps[:0], events=first.events[:0],
                             time=table[-1, 0])
        held.append(resident())
    raise KeyboardInterrupt

began = time.perf_counter()
try:
    write(sys.argv[2], scenario, mechanism, blocks())
except KeyboardInterrupt:
    pass
took = time.perf_counter() - began
print(json.dumps({"seconds": took, "start": held[2], "most": max(held), "end": resident(),
                  "size": os.path.getsize(sys.argv[2] + ".part")}))
"""


@needs("resource")
def test_memory_does_not_grow(tmp_path):
    process = outside.started(tmp_path, "-c", MANY, str(ROWS), "x.h5")
    out, err = process.communicate()
    assert process.returncode == 0, err
    told = json.loads(out)
    growth = (max(told["most"], told["end"]) - told["start"]) / 1e6
    rate = told["size"] / told["seconds"] / 1e6
    print(f"{ROWS} rows, {told['size'] / 1e6:.0f} MB in {told['seconds']:.1f} s, {rate:.0f} MB/s,"
          f" memory grew by {growth:.1f} MB")  # fmt: skip
    assert read(tmp_path / "x.h5.part").rows == ROWS
    assert growth <= 20.0
