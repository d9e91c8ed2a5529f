"""A run that was killed is recovered; so is a file that was cut short or never closed."""

import shutil
import signal
import time
from pathlib import Path

import h5py
import numpy as np
import pytest

from tests import small
from tests.elsewhere import needs
from tests.sizes import size
from tests.store import outside
from trsim.errors import FileError
from trsim.store import hdf5, salvage
from trsim.store.plain import Plain, checksum
from trsim.store.read import read, verify
from trsim.store.recover import copy, recover

KILLS = np.random.default_rng(9).uniform(0.05, 1.6, (size(1, 125), 4))  # s after the first rows
CHANNELS = "output.channels=[crank_angle, stroke, B.force, B.penetration]"


def whole(path):
    """The run in a file, after looking at all of its rows."""
    run = read(path)
    assert np.all(np.diff(run.time) > 0.0)
    for name in run.names:
        rows = run.channel(name)
        assert len(rows) == run.rows, name
        assert np.all(np.isfinite(rows)), name
    for joint in run.contacts:
        steps = run.steps(joint)
        assert np.all(np.diff(steps["time"]) > 0.0)
        assert np.all(steps["penetration"] > 0.0)
    return run


def stopped(process, told, wait):
    """Stop a process, `wait` s after its first rows; the wall time."""
    outside.blocks_until(process, wait, told)
    process.send_signal(signal.SIGSTOP)
    when = time.monotonic()
    while Path(f"/proc/{process.pid}/stat").read_text().rsplit(")", 1)[1].split()[0] != "T":
        time.sleep(0.001)
    return when


@needs("SIGSTOP")
@pytest.mark.parametrize("waits", KILLS, ids=str)
def test_killed_run(waits, tmp_path, record_property):
    """One process, stopped at each of some instants: its folder is what a kill would leave."""
    here, told, killed = tmp_path / "here", [], {}
    here.mkdir()
    process = outside.begun(here, "--set", CHANNELS)
    for wait in sorted(waits):
        killed[wait] = stopped(process, told, wait)
        shutil.copytree(here, tmp_path / f"{wait}")
        process.send_signal(signal.SIGCONT)
    outside.killed(process)
    for wait, when in killed.items():
        once = recover if wait == max(killed) else copy  # which is its work
        lost = recovered(tmp_path / f"{wait}", [one for one in told if one[1] <= when], when, once)
        record_property("lost", lost)


def recovered(folder, told, killed, recover):
    """How many s of a killed run are lost, after looking at what is not."""
    recover(folder / "runs/crank.h5.part", folder / "x.h5")
    run = whole(folder / "x.h5")
    assert run.attributes["status"] == "recovered"
    assert verify(run.path)
    # no zero rows: the crank turns at a constant rate, the force book is never empty
    np.testing.assert_allclose(run.channel("crank_angle.rate"), 5000 * np.pi / 30, rtol=1e-6)
    np.testing.assert_allclose(np.diff(run.time), 1e-5, rtol=1e-6)
    last = run.time[-1] if run.rows else -1.0
    lost = killed - next((wall for t, wall in told if t > last), killed)
    print(f"killed at {folder.name} s: {run.rows} rows, the last {lost:.2f} s lost")
    assert lost < 2.0
    assert not (folder / "runs/crank.h5").exists()
    assert {p.name for p in folder.iterdir()} == {"crank.yaml", "runs", "x.h5"}
    return lost


def test_interrupted_run(scenario, mechanism, tmp_path):
    from tests.store.test_hdf5 import broken_off

    with pytest.raises(KeyboardInterrupt):
        hdf5.write(tmp_path / "run.h5", scenario, mechanism,
                   broken_off(scenario, mechanism, KeyboardInterrupt(), blocks=4))  # fmt: skip
    copy(tmp_path / "run.h5.part", tmp_path / "x.h5")
    part, run = read(tmp_path / "run.h5.part"), whole(tmp_path / "x.h5")
    assert run.rows == part.rows == 200
    assert "interrupted" in run.attributes["reason"]
    assert run.events.time.tolist() == part.events.time.tolist()
    assert run.summary["contacts"] == part.summary["contacts"]
    assert [peak[:4] for peak in run.peaks] == [peak[:4] for peak in part.peaks] != []
    with h5py.File(tmp_path / "x.h5") as file:  # where references lead to what is there
        assert all(file["peaks"][name].dims[0].keys() == ["channel"] for name in ("value", "time"))


def test_recovered_says_what_a_complete_run_says(result, tmp_path):
    """Of a file whose rows are all there, everything that follows from them is the same."""
    with h5py.File(result.path) as complete, h5py.File(tmp_path / "p", "w", libver="v110") as file:
        for name in complete:
            complete.copy(name, file) if name not in ("summary", "peaks") else None
        file.attrs.update(dict(complete.attrs))
        file.create_group("peaks")
    copy(tmp_path / "p", tmp_path / "x.h5")
    run = whole(tmp_path / "x.h5")
    for name in result.names:
        np.testing.assert_array_equal(run.channel(name), result.channel(name))
        assert run.unit(name) == result.unit(name)
    assert run.phase.keys() == result.phase.keys()
    np.testing.assert_array_equal(run.poincare["journal"].x, result.poincare["journal"].x)
    summary, expected = run.summary["contacts"]["B"], result.summary["contacts"]["B"]
    for name in ("impacts", "fastest_impact", "steps"):
        assert summary[name] == expected[name]
    assert summary["peak_force"] == pytest.approx(expected["peak_force"], rel=0.15)
    assert {p.channel for p in run.peaks} >= {"B.contact_force", "O.reaction.x", "stroke"}
    assert run.scenario == result.scenario


@pytest.mark.parametrize("flags", [0x01, 0x05])
def test_file_that_was_never_closed(flags, result, tmp_path):
    """As after a kill while the last things are added: HDF5 alone refuses such a file."""
    content = bytearray(result.path.read_bytes())
    content[11] = flags
    content[44:48] = checksum(bytes(content[:44])).to_bytes(4, "little")
    (tmp_path / "p").write_bytes(content)
    with pytest.raises(OSError, match="already open for write"), h5py.File(tmp_path / "p"):
        pass
    copy(tmp_path / "p", tmp_path / "x.h5")
    assert whole(tmp_path / "x.h5").rows == result.rows


def test_superblock_checksum(result):
    content = result.path.read_bytes()
    assert checksum(content[:44]) == int.from_bytes(content[44:48], "little")
    with Plain(result.path) as file:
        assert file.read() == content


def test_tables_are_cut_to_what_is_whole(result, tmp_path):
    """Datasets of different length, rows never written, a time that falls back."""

    def broken(change):
        (tmp_path / "p").write_bytes(result.path.read_bytes())
        with h5py.File(tmp_path / "p", "r+") as file:
            change(file)
        copy(tmp_path / "p", tmp_path / "x.h5")
        return whole(tmp_path / "x.h5").rows

    def unwritten(file):
        file["B.force"].resize(250, axis=0)
        file["B.force"].resize(301, axis=0)
        file["B.force"][250:] = np.nan

    def falls(file):
        file["time"][120] = 0.0

    assert broken(lambda file: file["stroke"].resize(200, axis=0)) == 200
    assert broken(unwritten) == 250
    assert broken(falls) == 120


def test_two_at_one_time(tmp_path):
    """Steps that are shorter than the time resolves, and events recorded together, are no end."""
    event = "{when: crank_angle, value: 0.3, do: {record: true}}"
    both = f"events:\n  one: {event}\n  other: {event}\n"
    small.run(tmp_path / "p", text=small.SLIDER_CRANK + both)
    with h5py.File(tmp_path / "p", "r+") as file:
        steps, recorded = file["steps/B/time"], file["recorded/time"]
        steps[7] = steps[6]
        many = len(steps), len(recorded)
        assert many[0] > 20 and many[1] == 2 and recorded[0] == recorded[1]
        peak = file["steps/B/contact_force"][:].max()
    copy(tmp_path / "p", tmp_path / "x.h5")
    run = read(tmp_path / "x.h5")
    assert run.summary["contacts"]["B"]["steps"] == many[0]
    assert run.summary["contacts"]["B"]["peak_force"] == peak
    with h5py.File(tmp_path / "x.h5") as file:
        assert len(file["recorded/time"]) == many[1]


def test_what_was_never_written_is_not_zero(scenario, mechanism, tmp_path):
    """Rows that were made room for, but not filled, read as NaN."""
    from tests.store.test_hdf5 import broken_off

    with pytest.raises(KeyboardInterrupt):
        hdf5.write(tmp_path / "run.h5", scenario, mechanism,
                   broken_off(scenario, mechanism, KeyboardInterrupt()))  # fmt: skip
    with h5py.File(tmp_path / "run.h5.part", "r+") as file:
        n = len(file["time"])
        for name in ("time", "B.force", "events/time", "events/kind"):
            file[name].resize(len(file[name]) + 5000, axis=0)
        assert np.all(np.isnan(file["B.force"][n:]))
        assert np.all(np.isnan(file["time"][n:]))
        assert not np.any(file["events/kind"][-5000:])


def test_what_cannot_be_recovered(result, tmp_path):
    (tmp_path / "p").write_bytes(b"title: x")
    with pytest.raises(FileError, match="is not a result file"):
        recover(tmp_path / "p", tmp_path / "x.h5")
    with pytest.raises(FileError, match="no such file"):
        recover(tmp_path / "none", tmp_path / "x.h5")
    (tmp_path / "p").write_bytes(result.path.read_bytes()[:2000])
    with pytest.raises(FileError, match="cannot be recovered"):
        recover(tmp_path / "p", tmp_path / "x.h5")
    with pytest.raises(FileError, match="could not read it within 0 s"):
        recover(result.path, tmp_path / "x.h5", patience=0.01)
    assert [p.name for p in tmp_path.iterdir()] == ["p"]


def test_an_event_without_an_angle_is_not_an_unwritten_row(tmp_path):
    """A stop has no angle: NaN there is what was written."""
    with h5py.File(tmp_path / "events.h5", "w") as file:
        file["time"], file["angle"] = [0.1, 0.2, 0.3], [np.nan, 0.5, np.nan]
        file["speed"] = [1.0, 2.0, np.nan]
        items = {name: file[name] for name in ("time", "angle", "speed")}
        piece = salvage._piece(items, False, 0, 0.0)
    assert piece["time"].tolist() == [0.1, 0.2]
