"""Commands without processes of their own, which take half a second to begin: where it matters what
comes of them, and not where.  tests/sweeps, tests/store and tests/test_system.py have the others.
"""

import json

from trsim.errors import FileError
from trsim.store import describe, recover
from trsim.sweeps import job


def plain(told):
    """What arrives of it in another process."""
    return json.loads(json.dumps(told))


def sweeps(monkeypatch):
    """From now on cases run in this process, one after the other, without limits."""

    def run(tasks, _jobs, _limits=None, _first_alone=False, kept=None):
        for task in tasks:
            yield task, {**plain(job.run(plain(task), lambda: None)), "attempts": 1}

    monkeypatch.setattr("trsim.sweeps.local.run", run)


def recovering(monkeypatch):
    """From now on files are recovered in this process: not those that HDF5 may die of."""

    def copied(part, unfinished, _final, _patience):
        try:
            return plain(recover.copy(part, unfinished))
        except (OSError, RuntimeError, KeyError, ValueError) as error:
            what = f"{part} cannot be recovered: {describe.cause(error)}"
            raise FileError(what, file=str(part)) from None

    monkeypatch.setattr(recover, "_copied", copied)
