import errno
import hashlib
import json
import os

import h5py
import numpy as np
import pytest

from tests import small
from tests.sizes import RELEASE
from trsim.errors import FileError, SolverError
from trsim.solve.simulate import simulate
from trsim.store import grow, hdf5
from trsim.store.hdf5 import read, write
from trsim.store.read import verify
from trsim.store.tables import KINDS

WRITES = range(1, 101) if RELEASE else [0, 1, 7, 20, 60, 100, 150, 200, 250, 300]  # that succeed


def pieces(scenario, mechanism, rows=50):
    """A simulation in smaller blocks."""
    running = simulate(scenario, mechanism)
    while True:
        try:
            block = next(running)
        except StopIteration as stop:
            return stop.value
        for k in range(0, len(block.rows), rows):
            part = {} if k == 0 else {"steps": block.steps[:0], "events": block.events[:0]}
            yield block._replace(rows=block.rows[k : k + rows], **part)


def broken_off(scenario, mechanism, error, blocks=2):
    """A simulation that ends with an exception."""
    running = pieces(scenario, mechanism)
    for _ in range(blocks):
        yield next(running)
    raise error


# --- layout ---


def test_layout(result):
    with h5py.File(result.path) as file:
        groups = {name for name, item in file.items() if isinstance(item, h5py.Group)}
        assert groups == {
            *("steps", "events", "peaks", "summary", "solver", "phase", "poincare"),
            *("impact", "orbit"),
            *("scenario", "mechanism", "provenance"),
        }
        assert file.attrs["format"] == "trsim run"
        assert file.attrs["format_version"] == 1
        assert file.attrs["title"] == "Slider-crank with play"
        assert file.attrs["status"] == "done"
        assert file.attrs["reason"] == ""
        assert len(file.attrs["content_sha256"]) == 64


def test_every_variable_has_unit_name_and_time(result):
    with h5py.File(result.path) as file:
        for group in (file, file["steps/B"], file["events"]):
            assert group["time"].is_scale
            for name, variable in group.items():
                if not isinstance(variable, h5py.Dataset) or name.startswith("component"):
                    continue
                assert variable.attrs["long_name"], name
                assert name in ("kind", "element") or variable.attrs["units"], name
                assert variable.fletcher32, name
                if name != "time":
                    assert variable.dims[0]["time"] == group["time"], name
                if variable.ndim == 2:
                    assert variable.dims[1][0].asstr()[0] in ("x", "xx"), name


def test_rows_are_those_of_the_solver(result, scenario, mechanism):
    rows = np.concatenate([b.rows.copy() for b in simulate(scenario, mechanism)])
    np.testing.assert_array_equal(result.time, rows[:, 0])
    assert len(rows) == result.rows == 301
    for column in mechanism.columns:
        if column.wanted:
            expected = rows[:, 1 + column.start : 1 + column.start + column.size]
            np.testing.assert_array_equal(result.channel(column.name), np.squeeze(expected))
            assert result.unit(column.name) == column.unit
    np.testing.assert_array_equal(result.channel("B.force.y"), result.channel("B.force")[:, 1])


def test_only_wanted_channels_are_stored(tmp_path):
    text = small.SLIDER_CRANK.replace("every: 0.01 ms", "every: 0.01 ms, channels: [stroke]")
    text = text[: text.index("poincare:")]
    small.run(tmp_path / "run.h5", text=text)
    result = read(tmp_path / "run.h5")
    assert set(result.names) == {"stroke", "stroke.rate", "stroke.acceleration"}
    assert result.contacts == ("B",)  # its steps and peaks belong to every result
    assert any(peak.channel == "B.contact_force" for peak in result.peaks)


def test_steps_and_events(result, scenario, mechanism):
    steps = result.steps("B")
    assert np.all(np.diff(steps["time"]) > 0.0)
    assert np.all(steps["penetration"] > 0.0)
    events = result.events
    assert set(events.kind) == {"onset", "separation"} < set(KINDS)
    assert set(events.element) == {"B"}
    assert list(events.kind[:2]) == ["onset", "separation"]
    onsets = np.count_nonzero(events.kind == "onset")
    assert result.summary["contacts"]["B"]["impacts"] == onsets
    # every step lies in a contact: after as many onsets as separations plus one
    onset, separation = (events.time[events.kind == kind] for kind in ("onset", "separation"))
    before = np.searchsorted(onset, steps["time"], "left")
    after = np.searchsorted(separation, steps["time"], "left")
    assert np.all(before - after == 1)


def test_peaks(result):
    peaks = {(peak.channel, peak.extreme): peak for peak in result.peaks}
    force = peaks["B.contact_force", "largest"]
    steps = result.steps("B")
    assert force.value >= steps["contact_force"].max()
    assert force.value == pytest.approx(steps["contact_force"].max(), rel=0.15)
    reaction = peaks["O.reaction", "magnitude"]
    size = np.linalg.norm(result.channel("O.reaction"), axis=1)
    assert size.max() <= reaction.value <= 1.02 * size.max()  # rows pass it by
    with h5py.File(result.path) as file:
        assert file["peaks/time"].attrs["units"] == "s"
        assert "between steps" in file["peaks"].attrs["extremes"]
        assert file["peaks/stroke"].attrs["units"] == file["stroke"].attrs["units"]
    near = result.time[size.argmax()]
    assert abs(reaction.time - near) <= result.time[1] - result.time[0]
    stroke = np.interp(reaction.time, result.time, result.channel("stroke"))
    assert reaction.stroke == pytest.approx(stroke, rel=1e-12)
    stroke = np.interp(force.time, result.time, result.channel("stroke"))
    assert force.stroke == pytest.approx(stroke, rel=1e-12)


def test_scenario_is_stored_and_runs_again(result, tmp_path):
    assert result.text("scenario/text") == small.SLIDER_CRANK
    digest = hashlib.sha256(small.SLIDER_CRANK.encode()).hexdigest()
    assert result.text("scenario/sha256") == digest
    small.run(tmp_path / "again.h5", text=json.dumps(result.scenario))
    again = read(tmp_path / "again.h5")
    np.testing.assert_array_equal(again.channel("stroke"), result.channel("stroke"))


def test_mechanism_is_described(result):
    assert result.parts["B"].clearance == 0.5e-3
    assert result.parts["B"].bodies == ("rod", "slider")
    assert result.parts["stroke"].joint == "guide"
    assert result.group("mechanism")["planar"]
    assert result.group("solver")["method"] == "dop853"
    assert result.group("provenance")["command"] == "test"


# --- how a run ends ---


def test_part_is_renamed(tmp_path):
    path = tmp_path / "deeper" / "run.h5"
    path.parent.mkdir()
    path.write_text("an old result")
    summary = small.run(path)
    assert summary["file"] == str(path)
    assert [p.name for p in path.parent.iterdir()] == ["run.h5"]
    assert read(path).rows == 301


def test_old_result_stays_until_the_new_one_is_complete(scenario, mechanism, tmp_path):
    path = tmp_path / "run.h5"
    small.run(path)
    before = path.read_bytes()
    with pytest.raises(KeyboardInterrupt):
        write(path, scenario, mechanism, broken_off(scenario, mechanism, KeyboardInterrupt()))
    assert path.read_bytes() == before


def test_interrupted_run_is_closed_as_part(scenario, mechanism, tmp_path):
    with pytest.raises(KeyboardInterrupt):
        write(tmp_path / "run.h5", scenario, mechanism,
              broken_off(scenario, mechanism, KeyboardInterrupt()))  # fmt: skip
    part = read(tmp_path / "run.h5.part")
    assert part.attributes["status"] == "interrupted"
    assert 10 < part.rows < 301
    assert [p.name for p in tmp_path.iterdir()] == ["run.h5.part"]


def test_failed_solver_leaves_a_complete_file(scenario, mechanism, tmp_path):
    summary = write(tmp_path / "run.h5", scenario, mechanism,
                    broken_off(scenario, mechanism, SolverError("step too small")))  # fmt: skip
    result = read(tmp_path / "run.h5")
    assert summary["status"] == result.attributes["status"] == "failed"
    assert result.attributes["reason"] == "step too small"
    assert result.rows == summary["rows"] > 10
    assert verify(result.path)


def test_failed_outcome_leaves_a_complete_file(tmp_path):
    text = small.SLIDER_CRANK.replace("method: dop853", "method: rk4, force: true, step: 0.05 ms")
    summary = small.run(tmp_path / "run.h5", text=text)
    assert summary["status"] == "failed"
    assert "not finite" in summary["reason"]
    assert np.all(np.diff(read(tmp_path / "run.h5").time) > 0.0)


def test_bug_is_raised_and_the_rows_are_kept(scenario, mechanism, tmp_path):
    with pytest.raises(ZeroDivisionError):
        write(tmp_path / "run.h5", scenario, mechanism,
              broken_off(scenario, mechanism, ZeroDivisionError("oops")))  # fmt: skip
    assert "oops" in read(tmp_path / "run.h5").attributes["reason"]


def test_run_that_never_starts_leaves_no_file(scenario, mechanism, tmp_path):
    with pytest.raises(SolverError):
        write(tmp_path / "run.h5", scenario, mechanism,
              broken_off(scenario, mechanism, SolverError("no start"), blocks=0))  # fmt: skip
    assert not list(tmp_path.iterdir())


def test_part_can_be_read_while_it_is_written(scenario, mechanism, tmp_path, monkeypatch):
    monkeypatch.setattr(hdf5, "FLUSHED", 0.0)
    seen = []

    def watched():
        for block in pieces(scenario, mechanism):
            yield block
            seen.append(read(tmp_path / "run.h5.part").rows)
        raise SolverError("enough")

    write(tmp_path / "run.h5", scenario, mechanism, watched())
    assert seen == [50, 100, 150, 200, 250, 300, 301]


@pytest.mark.parametrize("n", WRITES)
@pytest.mark.parametrize("number", [errno.ENOSPC, errno.EIO])
def test_write_fault(number, n, scenario, mechanism, tmp_path, monkeypatch):
    """Writes fail after the n-th: told with path and bytes, what was flushed is there."""
    monkeypatch.setattr(hdf5, "FLUSHED", 0.0)
    original, calls = grow.extended, [0]

    def faulty(*arguments):
        calls[0] += 1
        if calls[0] > n:
            raise OSError(number, os.strerror(number))
        original(*arguments)

    monkeypatch.setattr(grow, "extended", faulty)
    path = tmp_path / "run.h5"
    said = rf"run\.h5\.part: .* \d+ bytes: {os.strerror(number)}"
    with pytest.raises(FileError, match=said) as caught:
        write(path, scenario, mechanism, pieces(scenario, mechanism))
    assert caught.value.exit_code == 7
    assert not path.exists()
    part = read(tmp_path / "run.h5.part")
    assert np.all(np.diff(part.time) > 0.0)


def test_folder_that_cannot_be_made(scenario, mechanism, tmp_path):
    (tmp_path / "file").write_text("")
    for path in (tmp_path / "file" / "run.h5", tmp_path):
        with pytest.raises(FileError, match=str(tmp_path)):
            write(path, scenario, mechanism, simulate(scenario, mechanism))


def test_an_event_records_where_few_channels_are_wanted(tmp_path):
    text = (
        small.SLIDER_CRANK
        + "events: {m: {when: stroke, crosses: down, value: -1 mm, do: {record: true}}}\n"
    )
    small.run(tmp_path / "all.h5", text=text)
    small.run(tmp_path / "few.h5", "output.channels=[O, stroke]", text=text)
    one, few = read(tmp_path / "all.h5").recorded, read(tmp_path / "few.h5").recorded
    assert {"stroke", "O.reaction"} < few.keys() < one.keys() and len(few["time"]) > 0
    for name, values in few.items():
        np.testing.assert_array_equal(values, one[name])
