"""Sweeps that choose their cases: until a mean is sure, and between values that differ."""

import csv
import math
import shutil
from types import SimpleNamespace

import numpy as np
import pytest

from tests.analyse.studies import of_blocks
from tests.sweeps import swings
from trsim.analyse import sobol
from trsim.analyse.cases import spared, unfinished
from trsim.errors import FileError, ScenarioError, UsageError
from trsim.scenario.adaptive import Refine, Width, in_order
from trsim.scenario.vary import sweep
from trsim.statuses import NOT_NEEDED
from trsim.sweeps import job, local
from trsim.sweeps.choosing import Part, Results
from trsim.sweeps.enough import about, mean, of_indices, of_means
from trsim.sweeps.go import WHOLE, Shard, go
from trsim.sweeps.ledger import Entry
from trsim.sweeps.plan import faults, plan
from trsim.sweeps.refined import refined
from trsim.sweeps.study import study

LENGTH, INERTIA, MASS, REACHED = 0.1, 2e-3, 2.0, 1.0  # of the pendulum; rad, of the event
PENDULUM = f"""\
title: Pendulum
planar: true
parameters: {{start: 0, push: 0}}
bodies:
  bob: {{mass: {MASS}, inertia: {INERTIA}, at: [0, -{LENGTH}, 0]}}
joints:
  pin: {{type: revolute, bodies: [ground, bob], at: [0, 0, 0]}}
sensors:
  angle: {{joint: pin}}
initial: {{pin: start, pin.rate: push}}
gravity: [0, -9.81, 0]
events:
  over: {{when: angle, value: {REACHED}, do: {{end: true}}}}
solver: {{end: 0.25 s, tolerance: 1e-5}}
output: {{every: 50 ms}}
"""
# let go at rest, which swings.py makes without a solver
ANGLES = """\
sweep:
  parameters.start: uniform(0.4, 0.6)
  method: monte_carlo
  samples: 100
  seed: 4
  keep: summary
  until: {"peak:angle": 5 %}
"""
RATES = """\
sweep:
  parameters.push: lin(2, 18, 65)
  refine: {every: 16, by: {"summary:events": 0.5}}
"""


def here(tasks, run=swings.run):
    """Cases run in this process."""
    return ((task, run(task, lambda: None)) for task in tasks)


def backwards(tasks):
    """The last case ends first, as it may with several workers."""
    return reversed([*here(tasks)])


def workers(tasks):
    """Cases run by two processes."""
    return local.run(tasks, 2, job="tests.sweeps.swings:run")


def planned(folder, more):
    (folder / "pendulum.yaml").write_text(PENDULUM + more)
    found = plan(str(folder / "pendulum.yaml"), (), "one")
    assert [*faults(found)] == []
    return found


def made(of, folder, run=here, shard=WHOLE):
    """The cases that were run, in the order in which they ended."""
    return [one.case for one in go(of, folder, "one", run, shard) if not isinstance(one, int)]


def needed(folder):
    return [case.name for case in study(folder).cases if case.status != NOT_NEEDED]


@pytest.fixture(scope="module")
def angles(tmp_path_factory):
    """The folder of a sweep that went on until the mean of the peaks was sure; what it ran."""
    folder = tmp_path_factory.mktemp("angles")
    return folder, made(planned(folder, ANGLES), folder / "sw")


# --- until -----------------------------------------------------------------------------------


def test_samples_until_a_mean_is_sure(angles):
    folder, ran = angles
    found = study(folder / "sw")
    assert ran == [f"s{k:04d}" for k in range(len(ran))] == needed(folder / "sw")
    assert 16 + 8 <= len(ran) < 60
    values = [case.run().kept("peak:angle")[0] for case in found.cases[: len(ran)]]
    known = mean(values, Width(0.05, "%", ""))
    assert known.half <= 0.05 * known.mean and abs(known.mean - 0.5) <= known.half
    assert found.chosen == (
        f"{len(ran)} of 100 cases: peak:angle is {about(known.mean, known.half)} rad, "
        "asked for 5 %",
    )


def test_what_was_not_run_is_told(angles):
    folder, ran = angles
    n = 100 - len(ran)
    with (folder / "sw/index.csv").open() as file:
        statuses = [row["status"] for row in csv.DictReader(file)]
    assert statuses == ["done"] * len(ran) + ["not needed"] * n
    found = study(folder / "sw")
    assert [case.status for case in found.cases] == statuses
    assert spared(found) == [f"{n} of 100 cases were not needed and are left out"]
    assert not any(case.there or case.failed for case in found.cases[len(ran) :])


def test_a_damaged_plan_is_told(angles, tmp_path):
    text = (angles[0] / "sw/plan.json").read_text()
    for old, new, what in (
        ('"not_needed": true', '"not_needed": "no"', "does not say whether it was needed"),
        ('"chosen": ["', '"chosen": [3, "', "chosen are no texts"),
    ):
        assert old in text
        (tmp_path / "plan.json").write_text(text.replace(old, new))
        with pytest.raises(FileError, match=what):
            study(tmp_path)


def test_the_same_cases_whoever_runs_them(angles, tmp_path):
    """The last case first; on two workers; killed in the second batch, and gone on with."""
    folder, ran = angles
    of = planned(tmp_path, ANGLES)
    assert sorted(made(of, tmp_path / "back", backwards)) == ran
    assert sorted(made(of, tmp_path / "two", workers)) == ran
    killed = go(of, tmp_path / "killed", "one", backwards)
    before = [one.case for _, one in zip(range(21), killed, strict=False) if hasattr(one, "case")]
    killed.close()
    assert len(before) == 19  # two numbers of cases among them
    found = study(tmp_path / "killed")
    assert found.adaptive and found.chosen == ()
    assert [case.status for case in found.cases].count("missing") == 81
    rest = made(of, tmp_path / "killed")
    assert sorted(before + rest) == ran and {*before}.isdisjoint(rest)
    for name in ("back", "two", "killed"):
        assert study(tmp_path / name).chosen == study(folder / "sw").chosen
        assert needed(tmp_path / name) == ran
        assert [case.entry.content for case in study(tmp_path / name).cases[: len(ran)]] == [
            case.entry.content for case in study(folder / "sw").cases[: len(ran)]
        ]


def test_again_and_otherwise(angles, tmp_path):
    """Again nothing is run; a wider width needs no more; without one all are run."""
    folder, ran = angles
    shutil.copytree(folder / "sw", tmp_path / "sw")
    assert made(planned(tmp_path, ANGLES), tmp_path / "sw") == []
    assert needed(tmp_path / "sw") == ran
    assert made(planned(tmp_path, ANGLES.replace("5 %", "0.2 rad")), tmp_path / "sw") == []
    assert study(tmp_path / "sw").chosen[0].startswith("24 of 100 cases: ")
    assert needed(tmp_path / "sw") == ran  # those that are there stay
    all_of_them = ANGLES.replace("until", "numbers").replace('{"peak:angle": 5 %}', "[peak:angle]")
    running = go(planned(tmp_path, all_of_them), tmp_path / "sw", "one", here)
    assert next(running) == 100 - len(ran)
    running.close()
    found = study(tmp_path / "sw")
    assert not found.adaptive and found.chosen == ()
    assert unfinished(found)[0].startswith(f"{100 - len(ran)} of 100 cases have no result")


@pytest.mark.parametrize(
    "until, what",
    [
        ('{"peak:angle": 2 N}', "peak:angle is in rad, its width cannot be 2 N"),
        ('{"peak:angle": 2}', "peak:angle is in rad, its width cannot be 2"),
        ('{"peak:angel": 2 %}', "no case has peak:angel: no channel named 'angel'"),
    ],
)
def test_what_a_number_says_against_its_width(until, what, tmp_path):
    """It is found with the first cases, which are kept."""
    text = ANGLES.replace('{"peak:angle": 5 %}', until)
    with pytest.raises(UsageError, match=what):
        made(planned(tmp_path, text), tmp_path / "sw")
    assert sum(case.there for case in study(tmp_path / "sw").cases) == 16


def test_shards_choose_no_cases(tmp_path):
    with pytest.raises(UsageError, match="choose cases from what all others gave"):
        made(planned(tmp_path, ANGLES), tmp_path / "sw", shard=Shard(1, 2))
    assert not (tmp_path / "sw").exists()


def test_named_cases_choose_by_themselves(tmp_path):
    """One of them is sure of its mean, the other one has a grid of its own, all of which is run."""
    own = "sweep: {parameters.start: [0.1, 0.2], numbers: ['peak:angle'], keep: summary}"
    text = f"cases:\n  drawn: {{}}\n  chosen: {{{own}}}\n{ANGLES}"
    ran = made(planned(tmp_path, text), tmp_path / "sw")
    assert ran[16:18] == ["chosen,start=0.1", "chosen,start=0.2"]
    assert {name.partition(",")[0] for name in ran[18:]} == {"drawn"}
    assert [text[:6] for text in study(tmp_path / "sw").chosen] == ["drawn:"]


# --- what is enough --------------------------------------------------------------------------


class Known:
    """Numbers of cases that are numbers themselves."""

    def __init__(self, values, status="done"):
        self.values, self.ended = values, status

    def check(self, *_):
        pass

    def status(self, case):
        return self.ended if isinstance(self.ended, str) else self.ended(case)

    def number(self, case, word):
        return self.values[case]

    def unit(self, word):
        return ""


def run_out(choosing):
    """The batches of a choice, and what it says at last."""
    found = []
    try:
        while True:
            found.append(next(choosing))
    except StopIteration as end:
        return found, end.value


def until(values, width, **more):
    """What is run of samples with these numbers."""
    of = SimpleNamespace(until=(("w", width),), **more)
    return run_out(of_means(Part("", tuple(range(len(values))), of), Known(values)))


def test_an_interval_holds_the_mean_as_often_as_it_says():
    """Stopping where the cases are alike by chance would be right less often: of 400 sweeps 95 %
    are right but for chance, three standard deviations of which are 3.3 %."""
    rng, right, sizes = np.random.default_rng(7), 0, []
    width = Width(0.2, "", "0.2")
    for _ in range(400):
        values = rng.exponential(1.0, 600).tolist()
        n = sum(map(len, until(values, width)[0]))
        right += abs(np.mean(values[:n]) - 1.0) <= width.value
        sizes.append(n)
    assert right >= 400 * (0.95 - 3.0 * math.sqrt(0.95 * 0.05 / 400))
    # as many as are needed where the deviation is known, and an eighth or two for being sure
    assert 0.9 < np.mean(sizes) / (1.96 / width.value) ** 2 < 1.4


def test_once_is_not_enough():
    """The first 16 are alike, the next ones are not."""
    values = [1.0] * 16 + [0.0, 5.0] * 200
    batches, said = until(values, Width(0.3, "", "0.3"))
    assert batches[:2] == [[*range(16)], [*range(16, 24)]]
    assert len(batches) > 3 and said.startswith(f"{sum(map(len, batches))} of 416 cases: w is")
    assert until([2.0] * 30, Width(0.01, "%", "1 %"))[1] == (
        "24 of 30 cases: w is 2 +- 0, asked for 1 %"
    )


def test_few_numbers_that_are_alike_are_not_enough():
    """Of the first 64 cases eight have a number, the same one."""
    values = ([1.0] + [math.nan] * 7) * 40
    batches, said = until(values, Width(0.01, "%", "1 %"))
    assert [len(batch) for batch in batches[:4]] == [16, 16, 32, 64]
    assert said.startswith(f"{sum(map(len, batches))} of 320 cases: w is 1 +- 0")


def test_a_run_that_failed_has_no_number(tmp_path):
    """Its peak is that of the time until then."""
    entry = Entry("a", "d", "e", "done", "", 1, "c", 10, 20, 3.0, 0.5, {"w": 3.0, "v": None})
    of = Results(tmp_path, {"a": entry, "b": entry._replace(status="failed")})
    done, failed = SimpleNamespace(name="a"), SimpleNamespace(name="b")
    assert of.number(done, "w") == 3.0
    assert math.isnan(of.number(failed, "w")) and math.isnan(of.number(done, "v"))


def test_too_few_samples_are_told():
    values = [0.0, 1.0] * 20
    batches, said = until(values, Width(0.05, "", "0.05"))
    assert sum(map(len, batches)) == 40
    assert said == (
        "all 40 cases: w is 0.50 +- 0.16, asked for 0.05: not reached, more `samples` are "
        "needed, about 420"
    )
    values[3] = values[5] = math.nan
    assert "(2 without it)" in until(values, Width(0.05, "", "0.05"))[1]


@pytest.mark.parametrize(
    "value, half, told",
    [(1234.4, 19.7, "1,234 +- 20"), (0.51234, 0.0123, "0.512 +- 0.012"), (1.0, 0.0, "1 +- 0"),
     (123456.0, 4321.0, "123,500 +- 4,300"), (1.2e-9, 3.4e-11, "1.2e-09 +- 3.4e-11")],
)  # fmt: skip
def test_numbers_have_the_digits_that_are_known(value, half, told):
    assert about(value, half) == told


def design(samples):
    """A function of two numbers in all cases of a design: indices 0.8 and 0.2."""
    drawn = np.random.default_rng(3).random((samples, 4))
    cases = of_blocks(drawn[:, :2], drawn[:, 2:], ("k.x", "k.y"), samples).cases
    return [2.0 * case.values["k.x"] + case.values["k.y"] for case in cases]


def indices_until(values, width, samples):
    axes = tuple(SimpleNamespace(key=key, same_as="") for key in ("k.x", "k.y"))
    of = SimpleNamespace(until=(("w", Width(width, "", str(width))),), samples=samples, axes=axes)
    return run_out(of_indices(Part("", tuple(range(len(values))), of), Known(values)))


def test_rows_until_indices_are_sure(monkeypatch):
    """Batches are the first rows of all blocks, twice as many each time."""
    monkeypatch.setattr(sobol, "RESAMPLES", 100)
    values = design(256)
    batches, said = indices_until(values, 0.2, 256)
    assert batches[0] == [256 * block + row for block in range(4) for row in range(32)]
    assert batches[1] == [256 * block + row for block in range(4) for row in range(32, 64)]
    rows = sum(map(len, batches)) // 4
    assert rows in (64, 128)
    assert said.startswith(f"{4 * rows:,} of 1,024 cases: Sobol indices of w are within +- 0.1")
    batches, said = indices_until(design(64), 0.001, 64)
    assert sum(map(len, batches)) == 256
    assert said.startswith("all 256 cases: ") and "not reached, more `samples`" in said
    assert "no Sobol indices of w: w is the same" in indices_until([1.0] * 256, 0.1, 64)[1]


def test_indices_that_moved_are_not_sure(monkeypatch):
    """However narrow their intervals are: from row 64 on the two keys have changed places."""
    monkeypatch.setattr(sobol, "RESAMPLES", 100)
    table = np.array(design(512)).reshape(4, 512)
    assert sum(map(len, indices_until(table.ravel(), 0.2, 512)[0])) == 4 * 128
    table[2:, 64:] = table[[3, 2], 64:]
    assert sum(map(len, indices_until(table.ravel(), 0.2, 512)[0])) == 4 * 256


# --- refine ----------------------------------------------------------------------------------


def test_a_bifurcation_is_found_to_the_finest_step(tmp_path):
    """Whether the pendulum swings over an angle: its energy says from which rate on.

    At first nothing is said of events.  The files of those cases have them, their lines have not.
    """
    lever = MASS * LENGTH**2 + INERTIA
    rate = math.sqrt(2.0 * MASS * 9.81 * LENGTH * (1.0 - math.cos(REACHED)) / lever)
    bare = planned(tmp_path, RATES.replace(', by: {"summary:events": 0.5}', ""))
    ran = made(bare, tmp_path / "sw", lambda tasks: here(tasks, job.run))
    assert ran == [bare.cases[j].name for j in (0, 16, 32, 48, 64)]
    of = planned(tmp_path, RATES)
    ran += made(of, tmp_path / "sw", lambda tasks: here(tasks, job.run))
    found = study(tmp_path / "sw")
    rates = np.array([case.values["parameters.push"] for case in found.cases])
    k = int(np.searchsorted(rates, rate))
    assert 0 < k < len(rates)
    both = [found.cases[k - 1], found.cases[k]]
    assert [case.entry.summary["events"] for case in both] == [0, 1]
    assert len(ran) == 5 + 4  # a halving each: 8, 4, 2, 1
    assert found.chosen == (
        "9 of 65 cases: neighbours that differ in status, summary:events by more than 0.5 are "
        "next to each other on the axes",
    )
    assert made(of, tmp_path / "sw") == []


EIGHTH = {"a.x": 8, "a.y": 8}


def grid(n, ended, every=EIGHTH, numbers=None, by=()):
    """What is run of a grid of n x n cases, each known by its places (row, column)."""
    names = [(i, j) for i in range(n) for j in range(n)]
    axes = tuple(SimpleNamespace(key=key, same_as="", values=range(n)) for key in ("a.x", "a.y"))
    of = SimpleNamespace(axes=axes, refine=Refine(tuple(every.items()), by))
    known = Known(numbers or dict.fromkeys(names, math.nan), ended)
    batches, said = run_out(refined(Part("", tuple(names), of), known))
    every_one = [k for batch in batches for k in batch]
    assert len(every_one) == len({*every_one})
    return {names[k] for k in every_one}, said


def unseen(n, ended, ran):
    """Neighbours of a grid that differ, of which one was not run."""
    pairs = [((i, j), (i + a, j + 1 - a)) for i in range(n) for j in range(n) for a in (0, 1)
             if i + a < n and j + 1 - a < n]  # fmt: skip
    return [pair for pair in pairs if ended(pair[0]) != ended(pair[1]) and not {*pair} <= ran]


def test_a_curve_across_a_map_is_followed():
    def ended(place):
        return "jammed" if math.dist(place, (20, 29)) < 17.0 else "done"

    ran, said = grid(65, ended)
    assert unseen(65, ended, ran) == []
    assert 81 < len(ran) < 65 * 65 / 5
    assert said.startswith(f"{len(ran):,} of 4,225 cases")


def test_a_finer_neighbour_shows_what_corners_do_not():
    """A tongue enters a cell between its corners, from a cell that was cut."""

    def ended(place):
        across, up = place
        return "jammed" if up < 5 or (up < 14 and 9 <= across <= 15) else "done"

    ran, _ = grid(33, ended)
    assert unseen(33, ended, ran) == []


def test_a_key_that_is_not_named_has_all_its_values():
    """It differs from value to value, and that is no reason to look closer at the other key."""
    ran, _ = grid(9, lambda place: f"{place[0]}" if place[1] < 3 else "done", {"a.y": 4})
    assert ran == {(i, j) for i in range(9) for j in (0, 4, 8, 2, 3)}


def test_numbers_that_differ():
    """By more than a share of the larger one, or where one alone is there; alike, however large."""
    step = {(i, j): 100.0 if i < 11 else 104.0 for i in range(33) for j in range(33)}
    for width, cut in ((Width(0.05, "%", ""), False), (Width(0.03, "%", ""), True)):
        ran, _ = grid(33, "done", numbers=step, by=(("w", width),))
        assert ((10, 0) in ran and (11, 0) in ran) == cut
        assert (len(ran) == 25) != cut
    lost = {place: math.nan if place[0] < 11 else 1.0 for place in step}
    assert (11, 0) in grid(33, "done", numbers=lost, by=(("w", Width(1e9, "", "")),))[0]


def test_a_slope_is_cut_along_itself():
    """The other key, which has no influence, stays coarse."""
    slope = {(i, j): math.exp(0.1 * i) for i in range(33) for j in range(33)}
    ran, _ = grid(33, "done", numbers=slope, by=(("w", Width(0.3, "%", "")),))
    assert ran == {(i, j) for i in range(0, 33, 2) for j in range(0, 33, 8)}


def test_all_values_of_words_are_run(tmp_path):
    text = "sweep:\n  parameters.push: lin(1, 9, 9)\n  bodies.bob.mass: [2, 3]\n"
    text += "  refine: {every: 8}\n"
    found = planned(tmp_path, text)
    ran = made(found, tmp_path / "sw", lambda tasks: ((t, {"status": "done", "reason": ""})
                                                      for t in tasks))  # fmt: skip
    assert ran == ["push=1.0,mass=2", "push=1.0,mass=3", "push=9.0,mass=2", "push=9.0,mass=3"]
    assert in_order(["1 mm", "2 mm", "1 m"]) and in_order([3, 2, 1])
    assert not in_order([1, 2]) and not in_order([1, 3, 2]) and not in_order(["a", "b", "c"])
    assert not in_order([1, 2, 2])


# --- as written ------------------------------------------------------------------------------

DRAWN = {"a.b": "uniform(1, 2)", "method": "monte_carlo", "samples": 64}
LISTED = {"a.b": "lin(0, 1, 9)"}


def test_as_written():
    found = sweep({**DRAWN, "until": {"peak:x": "2 %", "mean:y": "3 kN"}, "numbers": ["rms:z"]})
    assert found.until == (
        ("peak:x", Width(0.02, "%", "2 %")),
        ("mean:y", Width(3e3, "kN", "3 kN")),
    )
    assert found.numbers == ("rms:z", "peak:x", "mean:y")
    found = sweep({**DRAWN, "method": "sobol", "until": {"peak:x": "5 %"}})
    assert found.until == (("peak:x", Width(0.05, "", "5 %")),)
    found = sweep({**LISTED, "refine": {"every": 4, "by": {"peak:x": 0.5}}})
    assert found.refine == Refine((("a.b", 4),), (("peak:x", Width(0.5, "", "0.5")),))
    assert found.numbers == ("peak:x",)


@pytest.mark.parametrize(
    "block, path, what",
    [
        ({**LISTED, "until": {"peak:x": "2 %"}}, ("until",), "for monte_carlo and sobol, not"),
        ({**DRAWN, "until": {}}, ("until",), "says of no number"),
        ({**DRAWN, "until": ["peak:x"]}, ("until",), "must be a mapping of numbers"),
        ({**DRAWN, "until": {"peak:x": "tight"}}, ("until", "peak:x"), "a share or a number"),
        ({**DRAWN, "until": {"peak:x": "-2 %"}}, ("until", "peak:x"), "larger than 0"),
        ({**DRAWN, "until": {"peak:x": True}}, ("until", "peak:x"), "a share or a number"),
        ({**DRAWN, "until": {"peak:x": "2 M"}}, ("until", "peak:x"), "unit"),
        ({**DRAWN, "method": "sobol", "until": {"peak:x": "2 N"}}, ("until", "peak:x"), "a share"),
        ({**DRAWN, "method": "sobol", "until": {"peak:x": 2}}, ("until", "peak:x"), "less than 1"),
        ({**DRAWN, "refine": {"every": 8}}, ("refine",), "for a grid, not for monte_carlo"),
        ({**LISTED, "refine": 8}, ("refine",), "must be a mapping"),
        ({**LISTED, "refine": {}}, ("refine", "every"), "field required"),
        ({**LISTED, "refine": {"every": 1}}, ("refine", "every"), "from 2 to"),
        ({**LISTED, "refine": {"every": 8, "to": 2}}, ("refine", "to"), "unknown key"),
        ({**LISTED, "refine": {"every": 8, "by": {"x": "a"}}}, ("refine", "by", "x"), "a share"),
        ({**LISTED, "refine": {"every": {"a.c": 8}}}, ("refine", "every", "a.c"), "'a.c' has no"),
        ({**LISTED, "refine": {"every": {"a.b": 0}}}, ("refine", "every", "a.b"), "from 2 to"),
        ({"a.b": [1, 2], "refine": {"every": 8}}, ("refine",), "between which others lie"),
    ],
)  # fmt: skip
def test_refused(block, path, what):
    with pytest.raises(ScenarioError, match=what) as caught:
        sweep(block)
    assert caught.value.path == path


def test_a_word_that_is_no_number_is_told_at_its_place(tmp_path):
    with pytest.raises(ScenarioError, match="no number of a run") as caught:
        planned(tmp_path, ANGLES.replace("peak:angle", "paek:angle"))
    assert caught.value.path == ("sweep", "until", "paek:angle")
    assert caught.value.place is not None
