"""Sweeps on a Dask cluster of two worker processes, of which one is killed."""

import os
import signal
import threading
import time

import pytest

from tests.elsewhere import PATH
from tests.sweeps.test_go import FINE, TEXT, contents, made
from tests.sweeps.test_local import JOB, ended, tasks
from trsim.errors import FileError
from trsim.sweeps import dask
from trsim.sweeps.go import go
from trsim.sweeps.plan import plan
from trsim.sweeps.slot import Limits

distributed = pytest.importorskip("distributed", exc_type=ImportError)


@pytest.fixture(scope="module")
def cluster():
    """Two processes of one thread."""
    before = os.environ.get("PYTHONPATH")
    os.environ["PYTHONPATH"] = PATH
    with distributed.LocalCluster(
        n_workers=2, threads_per_worker=1, processes=True, dashboard_address=None
    ) as found:
        yield found
    os.environ.pop("PYTHONPATH") if before is None else os.environ.update(PYTHONPATH=before)


def test_each_task_ends(cluster, tmp_path):
    what = ["end", "die once", "die", "sleep", "end"]
    limits = Limits(time=1.0, retries=1)
    found = ended(dask.run(tasks(tmp_path, *what), cluster.scheduler_address, limits, JOB))
    told = [(found[f"t{k}"]["status"], found[f"t{k}"]["attempts"]) for k in range(5)]
    assert told == [("done", 1), ("done", 2), ("crashed", 2), ("over time", 1), ("done", 1)]


def test_nobody_there(monkeypatch):
    monkeypatch.setattr(dask, "CONNECTING", 0.5)
    with pytest.raises(FileError, match="no Dask scheduler at"):
        list(dask.run([{"name": "a"}], "tcp://127.0.0.1:9", Limits()))
    with pytest.raises(FileError, match="no Dask scheduler at"):
        list(dask.run([{"name": "a"}], "nonsense://x", Limits()))


def test_a_worker_killed(cluster, tmp_path):
    """The sweep is the one of a single machine, to the last bit."""
    scenario = tmp_path / "crank.yaml"
    scenario.write_text(TEXT)
    made(scenario, tmp_path / "calm", sets=FINE)
    workers = [nanny.process.process.pid for nanny in cluster.workers.values()]
    planned, folder = plan(str(scenario), FINE, "one"), tmp_path / "stormy"
    found, killed = [], threading.Event()
    for one in go(
        planned, folder, "one", lambda todo: dask.run(todo, cluster.scheduler_address, Limits())
    ):
        if isinstance(one, int):
            continue
        found.append(one)
        if len(found) == 2:
            os.kill(workers[0], signal.SIGKILL)
            killed.set()
    assert killed.is_set()
    assert [one.status for one in found] == ["done"] * 6
    assert contents(folder) == contents(tmp_path / "calm")
    time.sleep(0.1)
    assert not list((folder / "cases").glob("*.part"))
