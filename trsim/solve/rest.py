"""Static equilibrium as a result of its own: places, reactions, loads, and whether it is stable.

    Z^T (F - J^T lam) = 0,     J^T lam = F           found by start/statics.py
    K v = w^2 N^T M N v        lowest w^2            of linearised.py, N^T M N = 1

Drives stand where they are at t = 0, loads are those of t = 0, and nothing moves: no inertia, no
damping, no friction.  K = N^T K N has the stiffness of springs, contacts and bars, that of loads
that change with the place, and the curvature of the constraints under their reactions.  A balance
with w^2 < 0 is left at the smallest push; one with w^2 = 0 is held by nothing.  Where K is not
symmetric, as with a force that turns with its body, eigenvalues may be complex: it then flutters,
and is not stable either.

Multipliers are those of least norm of all rows, redundant ones too: moments count over the size of
the mechanism.  Where a reaction is unique that is the one.
"""

import time
from collections.abc import Generator
from dataclasses import dataclass, replace
from math import pi, sqrt
from typing import Any, Literal, get_args

import numpy as np
from numpy.typing import NDArray

from trsim.assemble.assemble import assemble
from trsim.assemble.dense import least_squares
from trsim.assemble.equations import constraints, forces, poses
from trsim.assemble.mechanism import Mechanism
from trsim.assemble.outputs import measure
from trsim.assemble.reduce import along_rates, moves, spread_out
from trsim.elements.contract import SCENE, compiled
from trsim.elements.prescribed import AnyDrive, rates_at
from trsim.elements.rotations import rotation_vector
from trsim.elements.scene import Scene, scene
from trsim.errors import ModelError
from trsim.kernels.signatures import A1, void
from trsim.scenario.initial import Initial
from trsim.scenario.scenario import SolverSpec
from trsim.solve.diagnose.linearised import linearised
from trsim.solve.diagnose.modes import Moved, shape, turned
from trsim.solve.march.record import N_PEAK, PEAK_MAX, PEAK_MIN
from trsim.solve.outcome import Block, Outcome, new_record, statistics
from trsim.solve.start.consistent import Start, positions, start
from trsim.solve.start.statics import INDIFFERENT
from trsim.varying import FunctionSpec

Array = NDArray[np.float64]
Verdict = Literal["stable", "indifferent", "unstable"]
STABLE, INDIFFERENT_ONE, UNSTABLE = get_args(Verdict)
NOTHING = 1e-9  # of the largest stiffness: rounding of one that is none
UNBALANCED = 1e-6  # of the largest force: what a stiff contact makes of rounding is less
DEPENDENT = 1e-10  # relative size of a row that is not independent
FORCES = ("N", "N*m")
STILL = (0.0, 0.0, 0.0)
NO_BALANCE = (
    "does something hold every load?  A scenario may also be drawn nearer to the place, or hold a "
    "joint there by a drive"
)


@dataclass(frozen=True)
class Resting:
    """A static equilibrium.

    verdict     stable, indifferent or unstable
    freedoms    motions that the joints and the drives at rest leave
    eigenvalue  the lowest of the stiffness against the mass, 1/s^2; null without a freedom
    frequency   of the slowest vibration, without damping, Hz; null unless it is stable
    stiffness   against the motion of that eigenvalue, N/m or N*m/rad of what moves most
    direction   that motion: of an unstable one the direction in which it falls
    residual    force or moment that is left, N or N*m
    """

    verdict: Verdict
    freedoms: int
    eigenvalue: float | None
    frequency: float | None
    stiffness: float | None
    direction: tuple[Moved, ...]
    residual: float


@dataclass(frozen=True)
class AtRest:
    """A mechanism that stands still, where, with all channels there, and what was found."""

    scenario: Any
    mechanism: Mechanism
    begun: Start
    channels: Array  # (n_out)
    turns: dict[str, list[float]]  # of bodies against the drawing: rotation vectors, rad
    found: Resting


@compiled(void(SCENE, A1))
def measure_at_rest(s, y):
    """All channels at the last evaluation, with the multipliers in s.lam."""
    measure(s, 0.0, y, 0.0, 0.0)
    s.out[s.n_out - 1] = 0.0  # no motion, no book


def at_rest(scenario: Any) -> AtRest:
    """The equilibrium that is reached from the drawing, or from values of `initial`.

    Raises ScenarioError, ModelError where there is none.
    """
    still = standing(scenario, assemble(scenario))
    mechanism = assemble(still)
    as_drawn = mechanism.y0
    whole = Initial(tuple(still.joints), {}, True)
    try:
        if scenario.initial.values:
            y, *_ = positions(still, mechanism, Initial((), scenario.initial.values))
            mechanism = replace(mechanism, y0=y)
        still = still.model_copy(update={"initial": whole})
        begun = start(still, mechanism, True, lambda *_: None)
    except ModelError as error:
        if error.path[:1] != ("initial",) or error.path[1:2] not in ((), ("equilibrium",)):
            raise
        raise ModelError(error.what, NO_BALANCE) from None
    begun = replace(begun, y=without_rates(mechanism, begun.y))
    work, load, left = balanced(mechanism, begun)
    measure_at_rest(work, begun.y)
    load = max(load, carried(mechanism, work))
    if left > UNBALANCED * load:
        raise ModelError(
            f"no static equilibrium found: a force of {left:.3g} N is left", NO_BALANCE
        )
    found = judged(mechanism, begun, load, left)
    drawn = scene(mechanism.model)
    poses(drawn, as_drawn)
    turns = {
        name: turn(*(w.X[f, 3:].reshape(3, 3) for w in (work, drawn)))
        for name, f in mechanism.frames.items()
        if 0 < f < work.n_r
    }
    return AtRest(still, mechanism, begun, work.out[: work.n_out].copy(), turns, found)


def standing(scenario: Any, moving: Mechanism) -> Any:
    """The scenario with nothing in motion: drives stay where they are at t = 0.

    moving: its mechanism.
    """
    rows = {i.name: i.row for i in moving.instances if i.section == "drives"}
    drives = {}
    for name, spec in scenario.drives.items():
        own = AnyDrive.of(rows[name])
        if own.state >= 0:
            held = {"velocity": FunctionSpec("constant", 0.0)}
        else:
            place, _, _ = rates_at(moving.model.tab, own.motion, 0.0)
            held = {"position": FunctionSpec("constant", place)}
        drives[name] = spec.model_copy(update=held)
    none = {"velocity": STILL, "angular_velocity": STILL}
    return scenario.model_copy(update={
        "drives": drives,
        "bodies": {n: spec.model_copy(update=none) for n, spec in scenario.bodies.items()},
        "events": {},
        "poincare": {},
        "phase_portraits": {},
        "initial": Initial(),
        "solver": SolverSpec(end=scenario.solver.end or 1.0),
    })  # fmt: skip


def without_rates(mechanism: Mechanism, y: Array) -> Array:
    """y at rest."""
    y = y.copy()
    y[mechanism.model.n_q : mechanism.model.n_q + mechanism.model.n_v] = 0.0
    return y


def balanced(mechanism: Mechanism, begun: Start) -> tuple[Scene, float, float]:
    """A scene at rest with multipliers of least norm; the largest force, and what is left of it."""
    # here all rows are solved at once, without the factors that shares loads between them takes
    work = scene(mechanism.model.replaced(shared_out=0))
    work.mem[:], work.branch[:] = begun.mem, begun.branch
    poses(work, begun.y)
    forces(work, 0.0)
    constraints(work, 0.0)
    rows = len(work.row_unit)
    work.A[:] = 0.0
    there = moves(work, work.d == 3)
    F = along_rates(work, work.F)[there]
    left, load = F, float(np.abs(F).max(initial=0.0))
    if rows:
        J = spread_out(work, rows)[:, there].T
        # what a row holds is a force, or a moment over the size
        unit = work.size / np.asarray(work.row_unit[:rows])
        lam = unit * least_squares(J * unit, F, DEPENDENT)
        work.lam[:rows] = lam
        left = F - J @ lam
        load = max(load, float(np.abs(lam).max(initial=0.0)))
    return work, load, float(np.abs(left).max(initial=0.0))


def carried(mechanism: Mechanism, work: Scene) -> float:
    """The largest force or moment that an element tells: bodies in balance feel none in sum."""
    told = [work.out[c.start : c.start + c.size] for c in mechanism.columns if c.unit in FORCES]
    return float(max((np.abs(values).max(initial=0.0) for values in told), default=0.0))


def judged(mechanism: Mechanism, begun: Start, load: float, left: float) -> Resting:
    """Whether a balance is stable, by the motion that meets least stiffness."""
    linear = linearised(mechanism, begun, order=4)
    freedoms = linear.K.shape[0]
    if freedoms == 0:
        return Resting(STABLE, 0, None, None, None, (), left)
    values, vectors = np.linalg.eig(linear.K)
    motions = linear.twists @ vectors
    most = np.abs(motions).max(axis=0)
    resist = values / np.maximum(most, 1e-300) ** 2  # N/m or N*m/rad
    least = max(INDIFFERENT * load / mechanism.model.size, NOTHING * np.abs(resist).max())
    flutters = np.abs(resist.imag) > least
    k = int(np.argmin(np.where(flutters, -np.inf, values.real)))
    verdict: Verdict = STABLE
    if flutters[k] or resist[k].real < -least:
        verdict = UNSTABLE
    elif resist[k].real <= least:
        verdict = INDIFFERENT_ONE
    value = float(values[k].real)
    return Resting(
        verdict,
        freedoms,
        value,
        sqrt(value) / (2.0 * pi) if verdict == STABLE else None,
        float(resist[k].real),
        shape(mechanism, turned(mechanism, begun, linear.twists) @ vectors[:, k]),
        left,
    )


def turn(R: Array, R0: Array) -> list[float]:
    """What turns the axes R0 into R: along the axis in world axes, rad."""
    drawn, now = (tuple(tuple(axis) for axis in A.T.tolist()) for A in (R0, R))
    return (R0 @ rotation_vector.python(drawn, now)).tolist()


def blocks(resting: AtRest) -> Generator[Block, None, Outcome]:
    """The equilibrium as a run of one row, for the writer of result files."""
    mechanism, begun, row = resting.mechanism, resting.begun, resting.channels
    work, clock = scene(mechanism.model), time.process_time()
    r = new_record(work, begun, (), 1)
    squares = [np.linalg.norm(row[k : k + 3]) for k in work.vector.tolist()]
    peaks = np.zeros((N_PEAK, len(row) + len(squares)))
    peaks[PEAK_MAX] = peaks[PEAK_MIN] = r.peak[PEAK_MAX] = r.peak[PEAK_MIN] = [*row, *squares]
    empty = np.zeros((0, 1))
    yield Block(
        np.concatenate([[0.0], row])[None, :],
        empty,
        np.zeros((0, 8)),
        0.0,
        0.0,
        0,
        np.zeros((0, 2 + len(row))),
        np.zeros((0, 4)),
    )
    told = resting.found.verdict
    return Outcome("done", f"static equilibrium, {told}", 0.0,
                   statistics(r, work, begun, time.process_time() - clock), peaks.T.copy(), r,
                   begun)  # fmt: skip
