"""Sizing of a load: runs that are repeated until a drive has nothing left to do.

    F_0 = 0,   F_1 = d,   F_k+1 = F_k - T_k / g_k        of every output row, as a table of a sensor
    g = (T_k - T_k-1) / (F_k - F_k-1)                    what the load does to the drive

T is the force of the drive, which goes on to prescribe the motion.  d is a small load of one size,
to see what g is.  Where reactions, contacts and places do not depend on where the force acts one
pass behind it is exact; where they do g follows as long as the passes differ enough to tell it.
"""

import copy
import json
from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from trsim.assemble.assemble import assemble
from trsim.errors import ScenarioError, SolverError, known
from trsim.scenario.load import loads
from trsim.solve.blocks import Blocks
from trsim.solve.simulate import simulate
from trsim.statuses import WELL

Array = NDArray[np.float64]

TRIAL = 1e-2  # of the largest force of the drive: the load of the second pass
IDLE = 1e-6  # of the largest: where a load does less to the drive it cannot take over
TOLD_APART = 1e-7  # of the largest load: a change that tells what it does
TRUSTED = 4.0  # times what a load did before: as far as that may change from pass to pass


@dataclass(frozen=True)
class Sized:
    """A scenario with the load that was found, and how it came to it."""

    scenario: Any
    x: Array  # of the sensor
    load: Array
    left: tuple[float, ...]  # the largest force of the drive in every pass, N or N*m

    @property
    def relative(self) -> list[float]:
        """What was left in every pass, of the first."""
        return [left / self.left[0] if self.left[0] else 0.0 for left in self.left]

    @property
    def in_words(self) -> str:
        """The same as a text."""
        return ", ".join(f"{left:.6g}" for left in self.relative)


def sized(scenario: Any, look: Callable[[int, float], None] = lambda *_: None) -> Sized:
    """The load that takes over what a drive gives.

    look: called with the number of a pass and what it left, of the first.
    Raises ScenarioError, ModelError, and SolverError where no load is found.
    """
    wanted = scenario.sizing
    check(scenario)
    x, T = motion(scenario, 0.0)
    peak = float(np.abs(T).max())
    left, F, gear = [peak], np.zeros_like(x), np.zeros_like(x)
    look(0, 1.0)
    trial = np.full_like(x, TRIAL * peak)
    for count in range(1, wanted.passes + 2):
        if left[-1] <= wanted.below * peak:
            break
        F_new = trial if count == 1 else F - T / gear
        new, T_new = motion(scenario, table(x, F_new, wanted.of))
        many = min(len(x), len(new))
        x, F, F_new, T, T_new, gear = (
            a[:many] for a in (new, F, F_new, T, T_new, gear)
        )  # of runs that an event ends
        gear = told(F_new - F, T_new - T, F_new, gear if count > 1 else None)
        if np.abs(gear).min() <= IDLE * np.abs(gear).max():
            where = x[int(np.argmin(np.abs(gear)))]
            raise ScenarioError(
                f"does no work where '{wanted.of}' is {where:.6g}: it cannot take over the force "
                f"of '{wanted.drive}' there",
                "let it act at a lever, along the motion",
                ("sizing", "load"),
            )
        F, T = F_new, T_new
        left.append(float(np.abs(T).max()))
        look(count, left[-1] / peak)
    if left[-1] > wanted.below * peak:
        raise SolverError(
            f"sizing: after {wanted.passes} passes {left[-1] / peak:.2g} of the force of "
            f"'{wanted.drive}' is left, more than {wanted.below:g}",
            "More `passes`, or a larger `below`; does the load change where contacts are?",
        )
    whole = with_load(scenario, table(x, F, wanted.of), final=True)
    return Sized(whole, x, F, tuple(left))


def told(dF: Array, dT: Array, F: Array, before: Array | None) -> Array:
    """What a load does to a drive, by two passes; as before in rows that tell nothing."""
    if before is None:
        return np.asarray(dT / dF)
    apart = np.abs(dF) > TOLD_APART * np.abs(F).max()
    found = np.divide(dT, dF, out=before.copy(), where=apart)
    ratio = found / before
    return np.where((ratio > 1.0 / TRUSTED) & (ratio < TRUSTED), found, before)


def check(scenario: Any) -> None:
    """Refuse names that there are not."""
    wanted = scenario.sizing
    for name, what, there, key in (
        (wanted.drive, "drive", scenario.drives, "drive"),
        (wanted.of, "sensor", scenario.sensors, "of"),
    ):
        if name not in there:
            raise ScenarioError(f"no {what} named '{name}'", known(name, there), ("sizing", key))
    parts = wanted.load.split(".")
    at = scenario.resolved
    for part in parts[:-1]:
        if not isinstance(at, dict) or part not in at:
            hint = "write the path of a key, such as forces.hand.force"
            raise ScenarioError(f"no entry '{wanted.load}'", hint, ("sizing", "load"))
        at = at[part]
    if parts[-1] not in at:
        hint = f"Write `{parts[-1]}: 0` there: it is what is found."
        raise ScenarioError(f"no key '{wanted.load}'", hint, ("sizing", "load"))


def table(x: Array, F: Array, of: str) -> dict[str, Any]:
    """A load as the file would have it."""
    order = np.argsort(x)
    return {"table": np.stack([x, F], axis=1)[order].tolist(), "of": of}


def with_load(scenario: Any, load: Any, final: bool = False) -> Any:
    """The scenario with a load in place of that to be found; final: as it is to be run."""
    data = copy.deepcopy(scenario.resolved)
    at, parts = data, scenario.sizing.load.split(".")
    for part in parts[:-1]:
        at = at[part]
    at[parts[-1]] = load
    if final:
        del data["sizing"]
    else:
        data.setdefault("output", {})["channels"] = ["*"]
    made = loads(json.dumps(data), (), "sizing")
    made._text, made._tree.files = scenario.source.text, scenario.source.files
    return made


def motion(scenario: Any, load: Any) -> tuple[Array, Array]:
    """The sensor and the force of the drive at the rows of a run with a load."""
    wanted, made = scenario.sizing, with_load(scenario, load)
    mechanism = assemble(made)
    place = {c.name: 1 + c.start for c in mechanism.columns}
    run, rows = Blocks(simulate(made, mechanism)), []
    for block in run:
        rows.append(block.rows[:, [place[wanted.of], place[f"{wanted.drive}.force"]]].copy())
    if run.outcome.status not in WELL:
        raise SolverError(f"sizing: a pass failed: {run.outcome.reason}")
    x, T = np.vstack(rows).T
    step = np.diff(x)
    if len(x) < 2 or not (np.all(step > 0.0) or np.all(step < 0.0)):
        raise ScenarioError(
            f"'{wanted.of}' turns round or stands still on the way, and a load that depends on it "
            "is the same both ways",
            "take a sensor that rises or falls throughout, or end the run where it turns",
            ("sizing", "of"),
        )
    return x, T
