"""A scenario by other methods: its motion at the output times, and the CPU time it takes.

A `Problem` is assembled twice: `full` with every channel, whose rows are compared; `lean` with one
row at the end and no channels but those of contacts, whose time is taken.
"""

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import Any, NamedTuple

import numpy as np

from trsim.analyse.pair import MOVING
from trsim.arrays import Array
from trsim.errors import ScenarioError, SolverError, UsageError, known
from trsim.solve.blocks import Blocks

Look = Callable[[], None]  # at what is done so far, between two blocks

CONTACT = ("contact_force", "normal_force")  # of these a contact's first one is compared


def unwatched() -> None:
    """Nobody looks in while a run goes on."""


class Setting(NamedTuple):
    """How a run is made: with a tolerance, or with a fixed step.

    method     as in a scenario
    tolerance  of the runs; null with fixed steps
    step       s; null without fixed ones
    """

    method: str
    tolerance: float | None = None
    step: float | None = None


@dataclass(frozen=True)
class Problem:
    """A scenario, assembled with its rows and without them."""

    full: tuple[Any, Any]  # scenario, mechanism
    lean: tuple[Any, Any]
    quantities: tuple[Any, ...]  # columns that are compared, see assemble/layout.py
    contacts: dict[str, int]  # name -> column of its force


@dataclass(frozen=True)
class Trajectory:
    """A run that reached its end."""

    time: Array  # (n) s
    values: dict[str, Array]  # quantity -> (n, size)
    peaks: dict[str, float]  # contact -> largest force, N or N*m
    outcome: Any


def problem(scenario: Any, patterns: Sequence[str] = ()) -> Problem:
    """The scenario made ready.

    patterns: names or patterns of channels, or names of elements; without any, the coordinates and
    rates of the sensors, or else the positions of the bodies.  Accelerations have to be asked for:
    they jump with the contact forces.

    Raises ScenarioError, ModelError, and UsageError where a pattern fits no channel.
    """
    from trsim.assemble.assemble import assemble
    from trsim.solve.outcome import settings

    full = changed(scenario, "output", channels=("*",))
    mechanism = assemble(full)
    # the same largest step, whatever the rows
    longest = settings(changed(full, "solver", method="auto"), mechanism).h_max
    full = changed(full, "solver", max_step=float(longest))
    lean = changed(full, "output", every=scenario.solver.end, channels=())
    names = [mechanism.instances[e].name for e in mechanism.model.contact]
    columns = {column.name: column for column in mechanism.columns}
    forces = {n: [columns[c] for k in CONTACT if (c := f"{n}.{k}") in columns] for n in names}
    return Problem(
        (full, mechanism),
        (lean, assemble(lean)),
        tuple(chosen(mechanism, patterns)),
        {name: found[0].start for name, found in forces.items() if found},
    )


def chosen(mechanism: Any, patterns: Sequence[str]) -> list[Any]:
    """The columns that are compared; a channel's own name is no name of an element."""
    from trsim.assemble.asked import matches

    def fits(name: str, pattern: str) -> bool:
        return name == pattern if pattern in names else matches(name, (pattern,))

    names = [column.name for column in mechanism.columns]
    if not patterns:
        parts = [(i.section, i.name) for i in mechanism.instances]
        sensors = [name for section, name in parts if section == "sensors"]
        own = {f"{name}{rate}" for name in sensors for rate in ("", ".rate")}
        patterns = [c.name for c in mechanism.columns if c.name in own and c.unit in MOVING]
        patterns = patterns or [f"{n}.position" for section, n in parts if section == "bodies"]
        return [column for column in mechanism.columns if column.name in patterns]
    for pattern in patterns:
        if not any(fits(name, pattern) for name in names):
            raise UsageError(f"no channel fits '{pattern}'", known(pattern, names))
    return [column for column in mechanism.columns if any(fits(column.name, p) for p in patterns)]


def changed(scenario: Any, section: str, **values: Any) -> Any:
    """The scenario with other values in one of its sections."""
    inner = getattr(scenario, section).model_copy(update=values)
    return scenario.model_copy(update={section: inner})


def varied(scenario: Any, setting: Setting, first: float | None = None) -> Any:
    """The scenario by another method or at another tolerance, and with a first step (s)."""
    values = {"method": setting.method, "first_step": first, "step": setting.step}
    values["force"] = True  # the table shows what too long a step does
    values |= {} if setting.tolerance is None else {"tolerance": setting.tolerance}
    return changed(scenario, "solver", **values)


def marched(scenario: Any, mechanism: Any, look: Look = unwatched) -> tuple[Array, Any]:
    """All rows (n, 1 + n_out) of a run, and its outcome; `look` is called now and then."""
    from trsim.solve.simulate import simulate

    rows, run = [], Blocks(simulate(scenario, mechanism))
    for block in run:
        rows.append(block.rows.copy())
        look()
    return np.vstack(rows), run.outcome


def ended(scenario: Any, mechanism: Any, look: Look = unwatched) -> tuple[Array, Any]:
    """Rows and outcome of a run that reached its end; raises SolverError where it did not."""
    try:
        rows, outcome = marched(scenario, mechanism, look)
    except ScenarioError as error:  # of a step and rows that do not go together
        raise SolverError(error.what, error.hint) from None
    if outcome.status != "done":
        raise SolverError(f"{outcome.reason}, at t = {outcome.time:.6g} s")
    return rows, outcome


def trajectory(
    of: Problem, setting: Setting, first: float | None = None, look: Look = unwatched
) -> Trajectory:
    """A run with its rows; raises SolverError where it does not reach its end."""
    scenario, mechanism = of.full
    rows, outcome = ended(varied(scenario, setting, first), mechanism, look)
    values = {q.name: rows[:, 1 + q.start : 1 + q.start + q.size] for q in of.quantities}
    peaks = {name: float(outcome.peaks[column, 0]) for name, column in of.contacts.items()}
    return Trajectory(rows[:, 0], values, peaks, outcome)


def work(
    of: Problem, setting: Setting, first: float | None = None, look: Look = unwatched
) -> dict[str, float]:
    """What the solver did in a run without rows: `integration_cpu` (s), steps, evaluations."""
    scenario, mechanism = of.lean
    found: dict[str, float] = ended(varied(scenario, setting, first), mechanism, look)[1].statistics
    return found


def own_first_step(outcome: Any, tolerance: float, end: float) -> float:
    """About what the solver starts with, s."""
    from trsim.solve.outcome import step_of

    return step_of(outcome.start.length, outcome.start.speed, tolerance, end)
