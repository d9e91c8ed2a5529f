"""The words for numbers of a run."""

import numpy as np
import pytest

from tests import small
from trsim.analyse.fluctuation import fluctuation
from trsim.analyse.outputs import KINDS, scalar, scalars
from trsim.errors import UsageError
from trsim.store.read import read


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


def test_several(run):
    assert scalars(run, ["final:stroke", "points:journal"]) == [
        scalar(run, "final:stroke"), scalar(run, "points:journal"),
    ]  # fmt: skip
