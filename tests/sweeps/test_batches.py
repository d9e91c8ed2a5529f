"""Cases in batches for Dask, without Dask: how many, in which order, and what of them is lost."""

import sys
from types import SimpleNamespace

import pytest

from trsim.errors import FileError
from trsim.sweeps import dask
from trsim.sweeps.dask import AIM, MOST, Batches
from trsim.sweeps.slot import Limits

DONE = {"status": "done"}


def named(*names):
    return [{"name": name} for name in names]


def tasks(n):
    return named(*(f"t{k}" for k in range(n)))


def ended(batches, batch, seconds):
    batches.ended(batch, [(seconds, DONE)] * len(batch))


def test_as_many_as_take_the_time_aimed_at():
    batches = Batches(iter(tasks(2000)), AIM)
    assert [len(batches.following(4)) for _ in range(4)] == [1] * 4  # nothing is known yet
    for first in (30.0, 0.1, 0.1):  # the first one compiled
        ended(batches, tasks(1), first)
    assert len(batches.following(4)) == int(AIM / 0.1)
    ended(batches, tasks(30), 1e-9)
    assert len(batches.following(4)) == MOST
    ended(batches, tasks(30), 10.0)
    assert len(batches.following(4)) == 1


def test_all_in_their_order_and_smaller_towards_the_end():
    todo, batches = tasks(60), Batches(iter(tasks(60)), AIM)
    ended(batches, tasks(1), AIM / 10)
    found = []
    while batch := batches.following(4):
        found.append(batch)
    assert [task for batch in found for task in batch] == todo
    sizes = [len(batch) for batch in found]
    assert sizes[:3] == [10, 10, 10] and sizes[-1] == 1
    assert sizes == sorted(sizes, reverse=True)


def test_no_more_are_made_than_are_sent_soon():
    made = []
    batches = Batches((made.append(one) or one for one in tasks(500)), AIM)
    assert batches.following(4) and len(made) == 4
    ended(batches, tasks(1), AIM / 10)
    assert batches.following(4) and len(made) == 1 + 40


def test_a_thread_hands_back_what_it_was_given_too_much(monkeypatch):
    class Slot(SimpleNamespace):
        def run(self, message):
            return {**DONE, "of": message.task["name"]}

    monkeypatch.setattr(dask, "Slot", lambda limits, job: Slot(limits=limits, job=job))
    monkeypatch.setattr(dask, "_here", SimpleNamespace())
    batch = tasks(3)
    found = dask.attempt(batch, tuple(Limits()), enough=-1.0)
    assert [how["of"] for _, how in found] == ["t0"]
    assert len(dask.attempt(batch, tuple(Limits()), enough=60.0)) == 3
    batches = Batches([], AIM)
    batches.ended(batch, found)
    assert batches.following(4) == batch[1:] and batches.following(4) == []


class Cluster:
    """What `distributed` gives, without processes: a batch of which `kills` has a case is lost."""

    def __init__(self, kills="", lasts=99):
        self.kills, self.lasts, self.sent, self.status = kills, lasts, [], "running"

    def __call__(self, address, timeout):
        return self

    def __enter__(self):
        return self

    def __exit__(self, *_):
        self.status = "closed"

    def nthreads(self):
        return {"a": 1}

    def submit(self, function, batch, *rest, **options):
        assert self.status == "running"
        self.sent.append([task["name"] for task in batch])
        if self.kills in self.sent[-1]:
            error = type("KilledWorker", (Exception,), {})("attempt")
            return Future("error", lambda: error, None)
        return Future("finished", None, lambda timeout: [(0.001, DONE) for _ in batch])

    def wait(self, futures, **options):
        if len(self.sent) > self.lasts:
            self.status = "closed"
            for one in futures:
                one.status = "cancelled"


class Future(SimpleNamespace):
    def __init__(self, status, exception, result):
        super().__init__(status=status, exception=exception, result=result)

    __hash__ = object.__hash__


@pytest.fixture
def run(monkeypatch):
    def found(cluster, n):
        fake = SimpleNamespace(Client=cluster, wait=cluster.wait)
        monkeypatch.setitem(sys.modules, "distributed", fake)
        return dask.run(iter(tasks(n)), "tcp://here", Limits())

    return found


def test_of_a_lost_batch_only_the_case_it_was_lost_by(run):
    cluster = Cluster(kills="t5")
    told = [(task["name"], how["status"]) for task, how in run(cluster, 12)]
    assert dict(told) == {f"t{k}": "crashed" if k == 5 else "done" for k in range(12)}
    assert len(told) == 12
    (lost, alone) = [batch for batch in cluster.sent if "t5" in batch]
    assert len(lost) > 1 and alone == ["t5"]
    arrived = [name for batch in cluster.sent if batch != lost for name in batch]
    assert len(arrived) == len({*arrived}) == 12  # and nothing was run twice


@pytest.mark.parametrize("lasts, arrived", [(1, []), (2, ["t0", "t1"])])
def test_the_scheduler_ends(run, lasts, arrived):
    """What arrived is told, what is on the way is nobody's failure."""
    found = []
    with pytest.raises(FileError, match="the Dask scheduler at tcp://here is gone") as told:
        found.extend(run(Cluster(lasts=lasts), 50))
    assert "The same command goes on" in told.value.hint
    assert [(task["name"], how["status"]) for task, how in found] == [
        (name, "done") for name in arrived
    ]
