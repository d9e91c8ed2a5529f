"""Where two runs part is found, and what lies there is marked."""

import tracemalloc

import h5py
import numpy as np
import pytest

from trsim.analyse.apart import Window, windows
from trsim.analyse.certificate import certificate
from trsim.analyse.levels import verdict
from trsim.store.certificate import of, store, whole

TEXT = h5py.string_dtype()
TIME = np.linspace(0.0, 10.0, 10_001)
EVENTS = ((1.0, "onset"), (2.0, "separation"), (7.5, "onset"))


def written(path, channels, events=EVENTS, time=TIME):
    """The least that a complete file has; channels: name -> unit and values."""
    with h5py.File(path, "w") as file:
        file.attrs.update({"status": "done", "reason": ""})
        file["time"] = time
        for name, (unit, values) in channels.items():
            file[name] = values[: len(time)]
            file[name].attrs["units"] = unit
        file["mechanism/name"] = np.array(["s", "B"], dtype=TEXT)
        file["mechanism/section"] = np.array(["sensors", "joints"], dtype=TEXT)
        file["events/time"] = [when for when, _ in events]
        file["events/kind"] = np.array([kind for _, kind in events], "S10")
        file["events/element"] = np.array(["B"] * len(events), "S1")
        file["steps/B/time"] = np.zeros(3)
        file.create_group("peaks")
        file.create_group("summary").attrs["time"] = max(time, default=0.0)
        file.create_group("solver").attrs.update({"method": "radau", "tolerance": 1e-9})
    return path


@pytest.fixture
def compared(tmp_path):
    """The certificate of two sets of channels."""

    def made(mine, other, **of_twin):
        paths = written(tmp_path / "a.h5", mine), written(tmp_path / "b.h5", other, **of_twin)
        with h5py.File(paths[0], "r") as run, h5py.File(paths[1], "r") as twin:
            return certificate(run, twin)

    return made


def diverging(rate=3.0, seed=1e-9):
    """A swing, and one whose difference grows as exp(rate t) until it is as large."""
    x = np.sin(2.0 * TIME)
    return x, x + np.minimum(seed * np.exp(rate * TIME), 0.5) * np.cos(7.0 * TIME)


def test_horizon_of_diverging_series(compared):
    x, y = diverging()
    found = compared({"s": ("m", x)}, {"s": ("m", y)})
    known = TIME[np.argmax(np.abs(x - y) > 0.01 * np.ptp(x))]
    assert found.about["apart"] == known
    assert 5.4 < known < 6.0  # 1e-9 exp(3 t) = 0.02
    assert found.about["apart_channel"] == "s"
    assert np.isnan(found.windows[0].end)
    assert found.about["difference"] <= 0.01
    by = {q.quantity: q for q in found.quantities}
    assert not (by["final"].certain or by["mean"].certain or by["rms"].certain)
    assert by["final"].difference == x[-1] - y[-1]


def test_runs_that_stay_together(compared):
    x, _ = diverging()
    found = compared({"s": ("m", x)}, {"s": ("m", x + 1e-3)})
    assert np.isnan(found.about["apart"])
    assert (found.windows, found.levels) == ([], [])
    assert found.about["difference"] == pytest.approx(1e-3 / np.ptp(x))
    assert all(q.certain for q in found.quantities)
    assert found.about["quantity_difference"] == pytest.approx(1e-3 / np.ptp(x))


def test_extremes_are_marked_by_their_times(compared):
    """The largest value lies before the runs part, the smallest after."""
    bump = 5.0 * np.exp(-((TIME - 1.0) ** 2) / 0.01) - 5.0 * np.exp(-((TIME - 8.0) ** 2) / 0.01)
    x, y = diverging()
    found = compared({"s": ("m", x + bump)}, {"s": ("m", y + bump)})
    by = {q.quantity: q.certain for q in found.quantities}
    assert by["largest"] and not by["smallest"]


def test_what_adds_up_does_not_come_together_again(compared):
    x = np.sin(TIME)
    apart = (TIME > 4.0) & (TIME < 6.0)
    same = np.where(apart, 3.0, x)
    work = TIME + 0.3 * np.clip(TIME - 4.0, 0.0, 2.0)
    found = compared({"s": ("m", x), "energy.work.impacts": ("J", TIME)},
                     {"s": ("m", same), "energy.work.impacts": ("J", work)})  # fmt: skip
    [window] = found.windows
    assert (window.begin, window.end, window.share) == pytest.approx((4.001, 6.0, 1.0), abs=1e-9)
    by = {(q.channel, q.quantity): q.certain for q in found.quantities}
    assert by["s", "final"] and not by["energy.work.impacts", "final"]
    assert by["energy.work.impacts", "smallest"] and not by["energy.work.impacts", "largest"]


def test_forces_and_rest_say_nothing(compared):
    x, y = diverging()
    still = 1e-12 * x
    mine = {"s": ("m", x), "B.force": ("N", x), "b.position": ("m", still)}
    other = {"s": ("m", x), "B.force": ("N", y), "b.position": ("m", -still)}
    found = compared(mine, other)
    assert np.isnan(found.about["apart"])
    assert found.about["motion"] == 1
    assert {c.channel: c.motion for c in found.curves} == {
        "s": True, "B.force": False, "b.position": False
    }  # fmt: skip


def test_windows():
    apart = np.zeros(1000, bool)
    apart[[100, 105, 300]] = True
    apart[990:] = True
    assert windows(apart) == [Window(100, 106), Window(300, 301), Window(990, 1000)]
    assert windows(np.zeros(5, bool)) == []


def test_a_twin_that_ended_early(compared):
    x, _ = diverging()
    found = compared({"s": ("m", x)}, {"s": ("m", x)}, time=TIME[:4000])
    assert found.about["compared_until"] == TIME[3999]
    assert found.about["rows"] == 4000
    assert [(o.number, o.time, o.twin) for o in found.onsets] == [(1, 1.0, 1.0)]


def test_no_row_in_common(compared):
    x, _ = diverging()
    found = compared({"s": ("m", x)}, {"s": ("m", x)}, time=TIME[:0])
    assert found.about["rows"] == 0
    assert found.quantities == []


def test_share_of_contact(compared):
    """In contact from 7.5 s on, of a window of about 4.3 s."""
    x, y = diverging()
    found = compared({"s": ("m", x)}, {"s": ("m", y)})
    share = next(row for row in found.levels if row.quantity == "in contact")
    assert share.value == pytest.approx(2.5 / (10.0 - found.about["apart"]), rel=1e-9)
    numbers = found.contacts[0]
    assert (numbers.impacts, numbers.twin, numbers.before, numbers.twin_before) == (2, 2, 1, 1)


def test_contact_that_never_opens(compared):
    x, y = diverging()
    found = compared({"s": ("m", x)}, {"s": ("m", y)}, events=())
    share = next(row for row in found.levels if row.quantity == "in contact")
    assert (share.twin, share.value < 1.0) == (pytest.approx(1.0), True)


def test_verdicts():
    nan = np.nan
    assert verdict(1.0, 1.3, 0.2, 0.3, nan) == "agree"
    assert verdict(1.0, 1.3, 0.1, 0.1, nan) == "differ"
    assert verdict(1.0, 1.3, nan, 0.1, nan) == "unknown"
    assert verdict(1.0, 1.3, nan, nan, 0.4) == "agree"  # a common drift
    assert verdict(1.0, 1.3, nan, nan, 0.2) == "differ"
    assert verdict(1.0, 1.009, nan, nan, 1e-9) == "agree"  # small beside them


@pytest.mark.parametrize("shift, verdict", [(0.0, "agree"), (0.5, "differ")])
def test_a_common_drift_cancels(shift, verdict, compared):
    """Neither has an interval of its own, the difference has one."""
    noise = np.random.default_rng(3).standard_normal((2, len(TIME)))
    mine, other = TIME + noise[0], TIME + noise[1] + shift
    found = compared({"s": ("m", mine)}, {"s": ("m", other)}, events=()).levels
    [mean] = [row for row in found if row.quantity == "mean"]
    assert np.isnan(mean.half) and np.isnan(mean.twin_half)
    assert mean.off_half == pytest.approx(2.0 * np.sqrt(2.0 / len(TIME)), rel=0.5)
    assert mean.verdict == verdict


def test_means_of_two_independent_runs_agree_about_as_often_as_promised(compared):
    noise = np.random.default_rng(7).standard_normal((200, 2, len(TIME)))
    mine = {f"b{k}.velocity": ("m/s", pair[0]) for k, pair in enumerate(noise)}
    other = {f"b{k}.velocity": ("m/s", pair[1]) for k, pair in enumerate(noise)}
    verdicts = [row.verdict for row in compared(mine, other).levels if row.quantity == "mean"]
    assert len(verdicts) == 200
    assert verdicts.count("agree") >= 180


def test_memory_does_not_grow_with_the_rows(tmp_path):
    """Four times the rows, and a byte for each of them."""
    used = []
    for rows in (20_000, 80_000):
        time = np.linspace(0.0, 10.0, rows)
        x = np.sin(time)
        mine = {f"b{k}.velocity": ("m/s", x) for k in range(8)}
        other = {**mine, "b7.velocity": ("m/s", x + 0.1 * (time > 5.0))}
        paths = [written(tmp_path / f"{k}.h5", c, time=time) for k, c in enumerate((mine, other))]
        with h5py.File(paths[0], "r") as run, h5py.File(paths[1], "r") as twin:
            tracemalloc.start()
            found = certificate(run, twin)
            used.append(tracemalloc.get_traced_memory()[1])
            tracemalloc.stop()
        assert found.about["rows"] == rows
        assert found.about["apart"] == pytest.approx(5.0, abs=1e-3)
    assert used[1] - used[0] < 4.0 * 60_000


def test_stored_and_read(compared, tmp_path):
    x, y = diverging()
    found = compared({"s": ("m", x)}, {"s": ("m", y)})
    with h5py.File(tmp_path / "c.h5", "w") as file:
        assert of(file) is None and whole(file)
        store(file, found)
        again = of(file)
        assert whole(file)
        np.testing.assert_equal(again._asdict(), found._asdict())
        file["certificate/quantities/value"][0] += 1.0
        assert not whole(file)
