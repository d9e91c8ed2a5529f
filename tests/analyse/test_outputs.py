"""The words for numbers of a run."""

from dataclasses import replace

import numpy as np
import pytest

from tests import small
from trsim.analyse.fluctuation import fluctuation
from trsim.analyse.outputs import KINDS, scalar
from trsim.errors import UsageError
from trsim.report.display import compared
from trsim.report.studies import usual
from trsim.store.read import read

SAME = 1e-9  # numbers that are copied


@pytest.fixture(scope="module")
def run(tmp_path_factory):
    path = tmp_path_factory.mktemp("outputs") / "run.h5"
    small.run(path)
    return read(path)


def test_numbers_of_rows(run):
    time, x = run.time, run.channel("stroke.rate")
    part = (time >= 1e-3) & (time <= 2e-3)
    for kind, function in (
        ("mean", np.mean), ("std", np.std), ("rms", lambda v: np.sqrt(np.mean(v**2))),
    ):  # fmt: skip
        assert scalar(run, f"{kind}:stroke.rate") == (pytest.approx(function(x)), "m/s")
        assert scalar(run, f"{kind}:stroke.rate@1ms..2ms")[0] == pytest.approx(function(x[part]))
    assert scalar(run, "final:stroke.rate")[0] == x[-1]
    assert scalar(run, "final:stroke.rate@..1ms")[0] == x[time <= 1e-3][-1]
    assert scalar(run, "fluctuation:stroke.rate@1ms..2ms")[0] == fluctuation(time, x, 1e-3, 2e-3)


def test_extremes_are_those_of_accepted_steps(run):
    peaks = {(p.channel, p.extreme): p for p in run.peaks}
    largest = peaks["B.contact_force", "largest"]
    assert scalar(run, "peak:B.contact_force") == (largest.value, "N")
    assert scalar(run, "least:stroke.rate")[0] == peaks["stroke.rate", "smallest"].value
    assert scalar(run, "range:stroke.rate")[0] == pytest.approx(
        peaks["stroke.rate", "largest"].value - peaks["stroke.rate", "smallest"].value
    )
    steps = run.steps("B")
    after = steps["time"] > 1.5 * largest.time
    part = scalar(run, f"peak:B.contact_force@{1.5 * largest.time!r}..")[0]
    rows = run.channel("B.contact_force")[run.time > 1.5 * largest.time]
    assert part == max(steps["contact_force"][after].max(), rows.max())
    assert rows.max() < part or steps["contact_force"][after].max() < part


def test_component_of_a_vector(run):
    assert scalar(run, "mean:B.force.x") == (
        pytest.approx(run.channel("B.force")[:, 0].mean()),
        "N",
    )


def test_magnitude_of_a_vector(run):
    """A magnitude is a channel like any other; of a scalar it is the size."""
    force = run.channel("B.force")
    size = np.sqrt(force[:, 0] ** 2 + force[:, 1] ** 2 + force[:, 2] ** 2)
    np.testing.assert_allclose(run.channel("|B.force|"), size, rtol=1e-15)
    assert run.unit("|B.force|") == "N"
    assert scalar(run, "rms:|B.force|") == (pytest.approx(np.sqrt(np.mean(size**2))), "N")
    assert scalar(run, "mean:|stroke|")[0] == pytest.approx(np.mean(np.abs(run.channel("stroke"))))
    assert scalar(run, "mean:|B.force.x|")[0] == pytest.approx(np.mean(np.abs(force[:, 0])))
    with pytest.raises(UsageError, match=r"no channel named 'B\.farce'"):
        scalar(run, "mean:|B.farce|")


def test_the_peak_of_a_vector_is_that_of_its_magnitude(run):
    """sqrt of the sum of squares at one time, which the peaks of the components are not."""
    [kept] = [p for p in run.peaks if (p.channel, p.extreme) == ("A.reaction", "magnitude")]
    rows = np.linalg.norm(run.channel("A.reaction"), axis=1)
    assert kept.value > rows.max()
    for word in ("peak:A.reaction", "peak:|A.reaction|"):
        assert scalar(run, word) == (kept.value, "N")
    sides = [max(abs(scalar(run, f"{kind}:A.reaction.{axis}")[0]) for kind in ("peak", "least"))
             for axis in "xy"]  # fmt: skip
    assert max(sides) < kept.value < np.hypot(*sides)
    late = f"@{1.01 * kept.time!r}.."
    part = scalar(run, f"peak:A.reaction{late}")[0]
    assert part == rows[run.time >= 1.01 * kept.time].max()
    for word in ("least:A.reaction", "range:A.reaction", "peak:B.force", "peak:|B.force|"):
        with pytest.raises(UsageError, match=r"magnitude of '.*' is not kept"):
            scalar(run, word)


def test_the_peak_of_a_size_is_that_of_the_motion(run):
    for channel in ("B.contact_force", "motor.force", "stroke"):
        high, low = (scalar(run, f"{kind}:{channel}")[0] for kind in ("peak", "least"))
        assert scalar(run, f"peak:|{channel}|")[0] == max(abs(high), abs(low))
        least = 0.0 if low <= 0.0 <= high else min(abs(high), abs(low))
        assert scalar(run, f"least:|{channel}|")[0] == least
    assert scalar(run, "peak:|motor.force|")[0] > np.abs(run.channel("motor.force")).max()


def test_dispersion_of_a_section(run):
    points = run.poincare["journal"]
    assert len(points.x) > 3
    both = np.sqrt(np.var(points.x) + np.var(points.y))
    assert scalar(run, "dispersion:journal") == (pytest.approx(both), "m")
    assert scalar(run, "dispersion:journal.y")[0] == pytest.approx(np.std(points.y))
    assert scalar(run, "points:journal") == (len(points.x), "-")
    assert np.isnan(scalar(run, "dispersion:journal@0..1e-5")[0])
    some = points.time <= 2e-3
    assert scalar(run, "dispersion:journal.x@..2e-3")[0] == pytest.approx(np.std(points.x[some]))


def test_numbers_of_contacts_and_of_the_file(run):
    assert scalar(run, "flight:B")[0] + scalar(run, "contact:B")[0] == pytest.approx(1.0)
    assert scalar(run, "onsets:B")[0] == run.summary["contacts"]["B"]["impacts"]
    assert scalar(run, "summary:contacts.B.peak_force") == (
        run.summary["contacts"]["B"]["peak_force"], "N",
    )  # fmt: skip
    assert scalar(run, "solver:steps") == (run.group("solver")["steps"], "-")
    assert scalar(run, "between:B")[1] == "s"


@pytest.mark.parametrize(
    "word, what",
    [
        ("peek:B.contact_force", "no number of a run"),
        ("peak", "does not say of what"),
        ("peak:", "does not say of what"),
        ("peak:B.contact_forc", "no channel named"),
        ("mean:B.force", "components"),
        ("dispersion:jornal", "no section"),
        ("dispersion:journal.z", "no axis"),
        ("impacts:A", "no contact"),
        ("summary:tme", "no 'tme'"),
        ("summary:contacts", "is no number"),
        ("solver:steps@0..1", "of the whole run"),
        ("mean:stroke@0..", None),
    ],
)
def test_words_that_make_no_sense(word, what, run):
    if what is None:
        assert np.isfinite(scalar(run, word)[0])
        return
    with pytest.raises(UsageError, match=what):
        scalar(run, word)


def test_every_kind_is_described():
    import trsim.analyse.outputs as module

    assert all(kind in module.__doc__ for kind in KINDS)


def test_extremes_of_a_component_in_a_window_are_of_accepted_steps(run):
    """Between some rows of a contact its force is larger than in them, by much more than is told
    apart here; how much more depends on where steps end."""
    steps, time, x = run.steps("B"), run.time, run.channel("B.force.x")
    force = steps["force"][:, 0]
    after = np.clip(np.searchsorted(time, steps["time"]), 1, len(time) - 1)
    beyond = force - np.maximum(x[after - 1], x[after])
    k = int(np.argmax(beyond))
    assert beyond[k] > 1000 * SAME * abs(force[k])
    window = f"{time[after[k] - 1].item()!r}..{time[after[k]].item()!r}"
    inside = (steps["time"] >= time[after[k] - 1]) & (steps["time"] <= time[after[k]])
    known = [p.value for p in run.peaks if (p.channel, p.extreme) == ("B.force.x", "largest")
             and time[after[k] - 1] <= p.time <= time[after[k]]]  # fmt: skip
    largest = max([*known, force[inside].max()])
    assert scalar(run, f"peak:B.force.x@{window}")[0] == pytest.approx(largest, rel=SAME)
    assert scalar(run, f"mean:B.force.x@{window}")[0] <= max(x[after[k] - 1], x[after[k]])


@pytest.mark.parametrize("channel", ["stroke.rate", "stroke.acceleration", "B.force.y"])
def test_a_window_that_leaves_nothing_out_is_none(channel, run):
    for kind in ("peak", "least", "range"):
        assert scalar(run, f"{kind}:{channel}@0..") == scalar(run, f"{kind}:{channel}")


def test_time_is_a_channel_in_seconds(run):
    assert scalar(run, "peak:time") == (run.time[-1], "s")
    assert run.unit("time") == "s"


def test_a_run_of_one_row_has_no_fluctuation(run):
    one = replace(run, rows=1)
    assert np.isnan(scalar(one, "fluctuation:stroke")[0])
    assert scalar(one, "mean:stroke")[0] == run.channel("stroke")[0]


@pytest.mark.parametrize(("every", "there"), [("4 ms", True), ("5 ms", True), ("10 ms", False)])
def test_rows_too_far_apart_have_no_fluctuation(every, there, tmp_path):
    """The average is over one row then, and what it leaves rounding: 1e-15 of a swinging crank."""
    small.run(tmp_path / "run.h5", "solver.end=0.1", f"output.every={every}")
    coarse = read(tmp_path / "run.h5")
    assert any(word.startswith("fluctuation:") for word in usual(compared([coarse])[0])) == there
    if there:
        assert scalar(coarse, "fluctuation:stroke.rate")[0] > 1.0
        return
    with pytest.raises(UsageError, match=r"rows 0.01 s apart show nothing that is faster than 0.0"):
        scalar(coarse, "fluctuation:stroke.rate")
