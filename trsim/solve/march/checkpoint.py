"""The state of a run between two calls of the march, as named arrays: all it needs to go on.

    record.NAME   the arrays of the Record, whatever they are
    start.NAME    the Start, which the statistics of the whole run tell of
    scene.status  evaluations and factorisations so far
    cpu           s the march has taken so far

Nothing else of a run lasts from one step to the next (tests/solve/test_checkpoint.py), so a run put
back to such a state takes the same steps, to the last bit, as one that was never interrupted.
"""

from dataclasses import fields
from typing import Any

import numpy as np
from numpy.typing import NDArray

from trsim.assemble.mechanism import Mechanism
from trsim.elements.scene import Scene
from trsim.errors import FileError
from trsim.solve.march.record import Record
from trsim.solve.start.consistent import Start

UNFIT, ANEW = "the checkpoint does not fit this run", "Without --resume the run starts anew."
State = dict[str, NDArray[Any]]


def state(r: Record, work: Scene, begun: Start, cpu: float) -> State:
    """A copy: it stays as it is while the run goes on."""
    return {
        **{f"record.{name}": array.copy() for name, array in r.arrays().items()},
        **{f"start.{f.name}": np.array(getattr(begun, f.name)) for f in fields(begun)},
        "scene.status": work.status.copy(),
        "cpu": np.array(cpu),
    }


def begun_at(checkpoint: State, mechanism: Mechanism, work: Scene) -> Start:
    """The start of the run that a checkpoint was taken of.

    Raises FileError where it is not that of a run of this mechanism.
    """
    like = {"y": mechanism.y0, "mem": work.mem, "branch": work.branch,
            "depth": np.zeros(len(work.contact_par))}  # fmt: skip
    found: dict[str, Any] = {}
    for f in fields(Start):
        array, wanted = checkpoint.get(f"start.{f.name}"), like.get(f.name, np.array(0.0))
        if array is None or array.shape != wanted.shape or array.dtype.kind not in "fi":
            raise FileError(f"{UNFIT}: start.{f.name}", ANEW)
        found[f.name] = array if array.ndim else array.item()
    return Start(**found)


def put_back(checkpoint: State, r: Record, work: Scene) -> float:
    """Bring the record and the counters to a checkpoint; the cpu time spent until then, s.

    Raises FileError, as begun_at does, where it is not one of this mechanism.
    """
    wanted = {f"record.{name}": array for name, array in r.arrays().items()}
    wanted |= {"scene.status": work.status, "cpu": np.array(0.0)}
    for name, array in wanted.items():
        other = checkpoint.get(name)
        if other is None or (other.shape, other.dtype) != (array.shape, array.dtype):
            raise FileError(f"{UNFIT}: {name}", ANEW)
    for name, array in r.arrays().items():
        array[:] = checkpoint[f"record.{name}"]
    work.status[:] = checkpoint["scene.status"]
    return float(checkpoint["cpu"])
