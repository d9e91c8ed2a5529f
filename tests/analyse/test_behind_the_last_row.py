"""A run ends where it came to: what is located behind its last output row counts."""

from functools import cache

import numpy as np
import pytest

from tests import small
from trsim.analyse.outputs import LOCATED, scalar
from trsim.analyse.window import window
from trsim.errors import UsageError
from trsim.report.display import compared
from trsim.report.figures import contact_history
from trsim.store.read import read
from trsim.store.recover import recover

TEXT = """\
bodies: {b: {mass: 2, inertia: 0.01, velocity: [0.5, 0]}}
joints: {s: {type: prismatic, bodies: [ground, b], axis: [1, 0, 0]}}
sensors: {x: {joint: s}}
forces:
  stop: {type: limit_stop, joint: s, upper: 20 mm, lower: -20 mm, stiffness: 1e5, damping: 8}
  push: {type: applied_load, body: b, direction: [1, 0], force: "2*sin(10*t)"}
poincare:
  touch: {at_onset: stop, plot: [x, x.rate]}
  beat: {every: 0.1, plot: [x, x.rate]}
solver: {end: 1 s}
output: {every: 1 ms}
"""
WORDS = (
    "points:touch", "points:beat", "dispersion:touch.x", "dispersion:beat.y", "flight:stop",
    "contact:stop", "following:stop", "impacts:stop", "onsets:stop", "between:stop",
)  # fmt: skip
EARLY = {
    "done": "events={over: {when: t, value: 0.87, do: {end: true}}}",
    "failed": "forces.push.force=2*sin(10*t) + 0*sqrt(0.87 - t)",
}


def made(folder, every, *sets):
    path = folder / f"{every}.h5".replace(" ", "")
    small.run(path, f"output.every={every}", *sets, text=TEXT)
    return read(path)


@pytest.fixture(scope="module")
def by_rows(tmp_path_factory):
    """The run with rows so far apart, made once."""
    return cache(lambda every: made(tmp_path_factory.mktemp("rows"), every))


@pytest.fixture(scope="module")
def fine(by_rows):
    return by_rows("1 ms")


@pytest.fixture(scope="module")
def told(fine):
    """What the run with the finest rows tells, found once for each word."""
    return cache(lambda word: scalar(fine, word))


@pytest.mark.parametrize("window", ["", "@0.05..", "@..0.95", "@0.7..0.99", "@0.2..7"])
@pytest.mark.parametrize("every", ["3 ms", "300 ms", "600 ms"])
def test_rows_have_no_influence_on_what_is_located(every, window, by_rows, told):
    """With 600 ms the last two stretches have no row in them, or no row at their end."""
    run = by_rows(every)
    assert run.time[-1] < 1.0 == run.reached
    assert {word.partition(":")[0] for word in WORDS} == set(LOCATED)
    for word in WORDS:
        assert scalar(run, word + window) == told(word + window), word


def test_the_numbers_are_those_that_show_tells(fine):
    assert [scalar(fine, f"{word}")[0] for word in WORDS[:2]] == [9, 11]
    assert scalar(fine, "onsets:stop")[0] == fine.summary["contacts"]["stop"]["impacts"] == 9


@pytest.mark.parametrize("status", EARLY)
def test_a_run_that_ends_early(status, tmp_path):
    runs = [made(tmp_path, every, EARLY[status]) for every in ("1 ms", "600 ms")]
    for run in runs:
        assert run.attributes["status"] == status
        assert run.reached == run.summary["time"] == pytest.approx(0.87, abs=1e-3)
        assert window(run).end == window(run, "0.1..5").end == run.reached
    for word in WORDS:
        assert scalar(runs[1], word) == scalar(runs[0], word), word


def test_words_about_rows_stay_about_rows(by_rows):
    run = by_rows("600 ms")
    x = run.channel("x")
    assert scalar(run, "mean:x")[0] == np.mean(x)
    assert scalar(run, "final:x")[0] == x[-1]
    with pytest.raises(
        UsageError, match=r"no row lies in '@0.7..0.9'; it has rows from 0 to 0.6 s"
    ):
        scalar(run, "mean:x@0.7..0.9")
    with pytest.raises(UsageError, match=r"nothing lies in '@1.5..2'; it goes from 0 to 1 s"):
        scalar(run, "onsets:stop@1.5..2")


def test_what_is_recovered_came_as_far_as_its_last_touch(by_rows, told, tmp_path):
    part = by_rows("600 ms").path
    recover(part, tmp_path / "r.h5")
    run = read(tmp_path / "r.h5")
    assert run.summary["time"] == run.reached == 1.0  # the last point of `beat`
    for word in WORDS:
        assert scalar(run, word) == told(word), word


def test_a_contact_is_drawn_to_the_end_of_the_run(by_rows):
    """A last row in the middle of a contact is no zero of its force."""
    run = by_rows("600 ms")
    steps, touches = run.steps("stop")["time"], run.events.time[run.events.element == "stop"]
    time, _ = contact_history(compared([run])[0], "stop")
    assert time[-1] == 1.0
    assert set(time) == {0.0, 1.0, *steps, *touches}
