"""scipy's integrators as independent checks: the same equations, other steps.

`OdeSolver.step()` is driven directly, because `solve_ivp` has no hook after an accepted step: that
is where positions and velocities are projected, contacts change their phase and rows are written,
by the code of the march.  scipy's dense output is handed over as values at Chebyshev nodes.
Slow, 50 to 100 us of overhead per step, and worth it: step, error estimate and interpolation share
nothing with the compiled methods.
"""

import time
from collections.abc import Generator
from math import hypot, sqrt
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from trsim.assemble.dense import length as size_of
from trsim.assemble.equations import derivative, evaluate
from trsim.assemble.mechanism import Mechanism
from trsim.elements.contract import N_BOOK, SCENE, compiled
from trsim.elements.scene import Scene
from trsim.kernels.signatures import float64
from trsim.kernels.vectors import clear, copy_to
from trsim.scenario.methods import METHODS
from trsim.solve.diagnose.blame import undecided, why
from trsim.solve.diagnose.mesh_error import Bends
from trsim.solve.diagnose.no_number import refuse_no_number, unshown
from trsim.solve.march import record as rec
from trsim.solve.march.accelerations import (
    ALLOWED,
    FURTHEST,
    ONE,
    WIDEST,
    apart,
    largest,
    settles,
    share,
)
from trsim.solve.march.anew import anew, begun_with
from trsim.solve.march.calls import INTERPOLATE, method_row
from trsim.solve.march.complete import AT_POLE, SMOOTH_STEP, STRAYED, WORTHLESS, WOUND, complete
from trsim.solve.march.dense_output import measure_in
from trsim.solve.march.features import next_time
from trsim.solve.march.land import land
from trsim.solve.march.loop import begin
from trsim.solve.march.norm import weigh
from trsim.solve.march.peaks import between, finish, sample
from trsim.solve.march.record import (
    BUFFERS,
    RECORD,
    SETTINGS,
    Buffers,
    Record,
    Settings,
    crowded,
    fresh_buffers,
)
from trsim.solve.march.rounding import EPS, MARGIN
from trsim.solve.march.stiffness import size_of as size_of_swing
from trsim.solve.march.stiffness import turned
from trsim.solve.march.works import ROUNDING
from trsim.solve.methods.jacobian import PART
from trsim.solve.outcome import (
    CRAWLS,
    Outcome,
    called_by,
    emptied,
    first_step,
    most_points,
    new_record,
    runaway,
    settings,
    statistics,
    untrue,
)
from trsim.solve.start.consistent import exceeded, start
from trsim.statuses import Ended

Array = NDArray[np.float64]

NODES = 0.5 - 0.5 * np.cos(np.pi * np.arange(9) / 8)  # Chebyshev-Lobatto on 0..1
SIGNS = np.array([0.5, -1, 1, -1, 1, -1, 1, -1, 0.5])  # their barycentric weights
# by values at the nodes: second and third derivative in the middle of a step as long as one
SECOND, THIRD = np.linalg.inv(np.vander(NODES - 0.5, increasing=True))[2:4] * [[2.0], [6.0]]
# and its first at the end
LEAVING = np.linalg.inv(np.vander(NODES - 1.0, increasing=True))[1]
LAST = 2  # row of K with y' at the end of a step; row 1 is scratch of the march
SLOWLY = 5_000  # vanishing steps in a row that are followed: each costs a thousand compiled ones
# of the unit of errors: local errors of BDF add up from turn to turn; RK45 estimates a kink in the
# middle of a step, between its third and its fourth stage, to be 15 to 50 times less than it is
ADDING = {"scipy:BDF": 0.05, "scipy:RK45": 0.05}
EASED = 1.2  # times the part allowed before, at most: restarts cost BDF its order
LONGER = 1.2  # a step: what a bound made shorter may be again
BLIND = 1e-12  # of the mechanism's size: of differences, what rounding leaves
SHOWN = 0.5  # of the error allowed: what Newton's method leaves of it in third derivatives
NOISE = 25.0  # of rates, in third derivatives: as what Newton's method leaves, a fiftieth of that
TOO_LONG = 0.03  # of how fine steps were: one that asks for less is made again
SEEING = 3  # degree of a polynomial that has a third derivative
FIRST = 1.0  # rad: what a first step may hold of a vibration that counts
OWN = 4.0  # over h: what is slow beside it, and stiff
RELATIVE = 1e-13  # scipy's smallest sensible rtol: tolerances are absolute, by the units of the run


class Run(NamedTuple):
    """What a run works with."""

    method: str  # one of scipy's
    s: Scene  # another where other rows are solved
    r: Record
    b: Buffers
    setting: Settings


@compiled(INTERPOLATE)
def interpolate(P, y, theta, out):
    """The polynomial through the values P at the nodes, barycentric form."""
    for k in range(NODES.size):
        if theta == NODES[k]:
            copy_to(out, P[k])
            return
    bottom = 0.0
    clear(out)
    for k in range(NODES.size):
        part = SIGNS[k] / (theta - NODES[k])
        bottom += part
        for c in range(out.size):
            out[c] += part * P[k, c]
    for c in range(out.size):
        out[c] /= bottom


def simulate(scenario: Any, mechanism: Mechanism) -> Generator[Any, None, Any]:
    """As solve/simulate.py's, with scipy's solver making the steps."""
    setting = settings(scenario, mechanism)
    begun = start(scenario, mechanism, located=setting.locate > 0)
    s, left_out = begun_with(mechanism, begun)
    r = new_record(s, begun, left_out, NODES.size)
    room = most_points(mechanism, setting)
    b = fresh_buffers(s, r.y.size, LAST + 1, NODES.size, points=room)
    run = Run(scenario.solver.method, s, r, b, setting)
    method = method_row(
        interpolate=interpolate.address(),
        complete=complete.address(),
        last=LAST,
        estimate=1,
        degree=NODES.size - 1,
        sample=sample.address(),
        finish=finish.address(),
        between=between.address(),
        land=land.address(),
        measure_in=measure_in.address(),
        **called_by(mechanism, setting),
    )
    clock0 = time.process_time()
    begin(s, r, b, setting)
    refuse_no_number(mechanism, b.rows[0, 1:])
    r.h = first_step(scenario, r)
    status: Ended = "done"
    reason = ""
    limited = any(instance.row.limits for instance in mechanism.instances)
    limit, crawled = scenario.solver.max_steps or 2**62, 0
    solver, finer = restarted(run, 1.0)
    while r.t < setting.t_end:
        reason = stopped(solver)
        if reason:
            status = "failed"
            break
        h = solver.t - solver.t_old
        hand_over(solver, b)
        before = finer
        seen = getattr(solver, "order", SEEING) >= SEEING
        finer = of_accelerations(run, h, before) if seen else at_first(run, h)[0]
        finer = min(finer, EASED * before)
        if finer < TOO_LONG * before:
            r.h = 0.3 * h
            solver, finer = restarted(run, finer)
            continue
        b.h, b.built, b.halved = h, 1, 0
        outcome = complete(s, r, b, setting, method)
        if outcome == WORTHLESS:
            status, reason = "failed", unshown(mechanism, s.out) or "a value is not finite"
            break
        if outcome in (STRAYED, WOUND):
            r.h = 0.3 * h
            solver, finer = restarted(run, finer, float(r.h))
            continue
        if outcome == AT_POLE or untrue(scenario, mechanism, r):
            status = "failed"
            break
        crawled = crawled + 1 if solver.step_size < rec.CRAWLING * setting.t_end else 0
        reason = CRAWLS if crawled > SLOWLY else runaway(mechanism, r)
        reason = reason or (beyond(mechanism, r) if limited else "")
        if reason:
            status = "failed"
            break
        changed = s
        if r.weak:
            s = anew(mechanism, s, r, b, setting)
            run = run._replace(s=s)
        if outcome == SMOOTH_STEP and s is changed:
            of_what_is_stiff(s, r, b, solver, h)
            nudge(solver, r)
            r.h = h
            solver.max_step = min(LONGER * solver.max_step, longest(setting, b))
            if r.speed_cap > 0.0:
                solver.atol = allowed(run, finer)
            solver.atol[books(s)] = unit_of_works(r, setting)
        elif r.t < setting.t_end:
            solver, finer = restarted(run, finer)
        if r.steps >= limit and r.t < setting.t_end:
            status, reason = "failed", f"more than {limit} steps"
            break
        if crowded(r, b) or r.steps % 2000 == 0:
            yield emptied(r, b)
    yield emptied(r, b)
    cpu = time.process_time() - clock0
    numbers = statistics(r, s, begun, cpu)
    if status == "failed":
        at = mechanism.in_stage(r.stage, r.left_out)
        whose, text = undecided(mechanism, s)
        if whose is not None:
            entry = scenario.entry(whose.section, whose.name)
            status, reason = "painleve", f"{entry}: from t = {r.t:.6g} s on {text}"
        else:
            reason = untrue(scenario, mechanism, r) or why(scenario, at, r) or reason
    bends = Bends(mechanism)
    bends.look(float(r.t), r.y)
    return Outcome(status, reason, float(r.t), numbers, r.peak.T.copy(), r, begun,
                   bent=bends.states)  # fmt: skip


def beyond(mechanism: Mechanism, r: Record) -> str:
    """What a step has taken beyond what it can do; looked at where steps end."""
    for event in exceeded(mechanism, float(r.t), r.y):
        return f"{event.when} {event.said} ({event.value:g} {event.unit})"
    return ""


@np.errstate(over="ignore", invalid="ignore")  # what is not finite is told as such
def stopped(solver: Any) -> str:
    """Make a step; why it could not be made."""
    try:
        message = solver.step()
    except ValueError as error:
        if "infs or NaNs" not in str(error):
            raise
        return "a force or an acceleration is not finite"  # met when factorising a Jacobian
    return f"scipy stopped: {message}" if solver.status == "failed" else ""


def longest(setting: Settings, b: Buffers) -> float:
    """The longest step that may be asked for, s."""
    return float(min(setting.h_max, (b.rows.shape[0] // 2 - 2) * setting.every))


def restarted(run: Run, finer: float, most: float = np.inf) -> tuple[Any, float]:
    """A scipy solver at the state of the record, with the error units in force there, and the part
    of these that they are: its first steps see little of what vibrates."""
    import scipy.integrate

    method, s, r, b, setting = run

    def right_hand_side(t: float, y: Array) -> Array:
        yd = np.empty(y.shape)
        derivative(s, t, y if y.flags.c_contiguous else y.copy(), yd)
        return yd

    part, w = at_first(run, float(r.h))
    finer = min(finer, part)
    atol = allowed(run, finer)
    # scipy's own differences begin at 1e-8 of an entry or of its error: far below rounding where
    # a body is 50 m from the origin and entries of its quaternion are zero
    step = PART / np.where(b.weight > 0.0, b.weight * setting.step_error, PART)

    def jacobian(t: float, y: Array) -> Array:
        J, f = np.zeros((y.size, y.size)), right_hand_side(t, y)
        for c in np.delete(np.arange(y.size), books(s)):  # on works nothing depends
            x = y.copy()
            x[c] += step[c]
            J[:, c] = (right_hand_side(t, x) - f) / (x[c] - y[c])
        return J

    make = getattr(scipy.integrate, method.split(":", 1)[1])
    more = {} if METHODS[method].explicit else {"jac": jacobian}
    t = float(r.t)
    until = next_time(s, t, setting.t_end)
    first = min(float(r.h), until - t)
    if finer < 1.0 and w > 0.0:
        first = min(first, FIRST / w)
    most = min(most, longest(setting, b))
    made = make(right_hand_side, t, r.y.copy(), until, first_step=first or None,
                max_step=most, rtol=RELATIVE, atol=atol, **more)  # fmt: skip
    return made, finer


def allowed(run: Run, finer: float) -> Array:
    """The error allowed to every entry of y in the next step; finer: see of_accelerations."""
    method, s, r, b, setting = run
    weigh(s, r, b, setting)
    outside = 1e6 * setting.step_error * max(r.largest_energy, 1.0)
    absolute = np.where(b.weight > 0.0, 1.0 / np.maximum(b.weight, 1e-300), outside)
    absolute *= ADDING.get(method, 1.0) * finer
    absolute[books(s)] = unit_of_works(r, setting)
    return absolute


@np.errstate(over="ignore", invalid="ignore")  # what is not finite is told as such
def of_accelerations(run: Run, h: float, finer: float) -> float:
    """What part of the error allowed to places and velocities keeps accelerations to their share of
    the tolerance, 1 at most: see accelerations.py.

    w^2 of the fastest that is seen is |d3 v/dt3| / |d2 x/dt2|, by the polynomial of the step h in
    b.P; a solver outside keeps its estimates to itself.
    """
    method, s, r, b, setting = run
    if s.contact.size > 0 or not settles.python(s):  # units of contacts are enough here
        return 1.0
    places, rates = slice(0, s.n_q), slice(s.n_q, s.n_q + s.v_node)
    length, speed = float(r.length), float(r.speed)
    r.top_acceleration = most = float(largest.python(s, r.yd, r.top_acceleration))
    weight = b.weight * setting.step_error
    x = length * size_of(SECOND @ b.P[:, places] * weight[places])
    third = speed * size_of(THIRD @ b.P[:, rates] * weight[rates])
    allowed = ADDING.get(method, 1.0) * finer * setting.step_error
    mine = float(share.python(s, setting, h, ONE)) * most

    def made(unseen: float) -> tuple[float, float]:
        """How far an error turns in the step, and what it makes of accelerations."""
        v = h * max(third - SHOWN * speed * allowed - unseen, 0.0)
        turns = min(sqrt(v / max(x, BLIND * s.size)), WIDEST)
        return turns, made_at(run, turns / h)

    if made(0.0)[1] <= mine:
        return 1.0
    # neither steps nor Newton's method of scipy end on what is rounding
    rounding = of_rounding(run)
    turns, off = made(NOISE * h * rounding)
    mine = max(mine, max(turns, 1.0) * rounding)
    return part_of(run, mine, off)


def made_at(run: Run, w: float) -> float:
    """What the error allowed to places and velocities makes of accelerations at a frequency w; all
    of a mean over the bodies may be of one."""
    r, speed = run.r, float(run.r.speed)
    off = w * hypot(w * float(r.length), speed) * sqrt(run.s.n_r - 1)
    most = float(r.top_acceleration)
    return off * most / max(most, w * speed / FURTHEST) if off > 0.0 else 0.0


def at_first(run: Run, h: float) -> tuple[float, float]:
    """The same before a step, or behind one whose polynomial has no third derivative, by what
    vibrates in the motion; and the frequency of that, 0 where nothing does."""
    s, r, setting = run.s, run.r, run.setting
    if s.contact.size > 0 or not settles.python(s):
        return 1.0, 0.0
    w = float(swings(s, r, run.b))
    if w == 0.0:
        return 1.0, 0.0
    r.top_acceleration = most = float(largest.python(s, r.yd, r.top_acceleration))
    mine = float(share.python(s, setting, h, ONE)) * most
    return part_of(run, mine, made_at(run, min(w, WIDEST / h))), w


def part_of(run: Run, mine: float, off: float) -> float:
    """Of the error allowed, what makes no more than `mine` of accelerations where all of it makes
    `off`; below the finest only rounding is left."""
    finest = RELATIVE / run.setting.step_error
    return min(1.0, max(finest, mine / off)) if off > 0.0 else 1.0


@compiled(float64(SCENE, RECORD, BUFFERS))
def swings(s, r, b):
    """w, rad/s, of what vibrates fastest of the motion: w^2 = |K K d| / |K d|, K d the change of
    accelerations with a displacement d along velocities and accelerations."""
    swing, speed = r.swing[0], max(r.speed, r.speed_cap)
    v, a = r.y[s.n_q : s.n_q + s.n_v], r.yd[s.n_q : s.n_q + s.n_v]
    sizes = size_of_swing(s, v, speed, s.n_v), size_of_swing(s, a, speed, s.n_v)
    for k in range(s.n_v):
        swing[k] = a[k] + (v[k] * sizes[1] / sizes[0] if sizes[0] > 0.0 else 0.0)
    if not size_of_swing(s, swing, speed, s.n_v) > 0.0 or turned(s, r, b, 0) == 0.0:
        return 0.0
    ww = turned(s, r, b, 0)
    evaluate(s, r.t, r.y, b.rough[1])
    return sqrt(ww)


def of_rounding(run: Run) -> float:
    """What rounding makes of accelerations, m/s^2."""
    return float(rounded(run.s, run.r, run.b, run.setting))


@compiled(float64(SCENE, RECORD, BUFFERS, SETTINGS))
def rounded(s, r, b, setting):
    """MARGIN times the largest acceleration in f(y + d) + f(y - d) - 2 f(y), as rounding.py."""
    y, both, rate = b.rough[0], b.rough[1], b.rough[2]
    for side in range(2):
        for c in range(y.size):
            weight = b.weight[c] * setting.step_error
            moved = EPS * max(abs(r.y[c]), 1.0 / weight if weight > 0.0 else 0.0)
            y[c] = r.y[c] + moved * (1.0 if c % 2 == side else -1.0)
        evaluate(s, r.t, y, rate)
        for c in range(y.size):
            both[c] = rate[c] if side == 0 else both[c] + rate[c]
    evaluate(s, r.t, r.y, rate)
    return MARGIN * apart(s, both, 2.0, rate)


def of_what_is_stiff(s: Scene, r: Record, b: Buffers, solver: Any, h: float) -> None:
    """Note what accelerations are off by at the end of a step, as what is stiff answers to what
    Newton's method and projection leave of places: R - mu (mu - J)^-1 R, as in settle.py."""
    J = getattr(solver, "J", None)
    if J is None or not settles.python(s):
        return
    rates, mu = slice(s.n_q, s.n_q + s.v_node), OWN / h
    left, scale = np.asarray(r.yd) - LEAVING @ b.P / h, np.asarray(s.scale)[rates]
    left[: s.n_q] = left[books(s)] = 0.0
    r.top_acceleration = largest.python(s, r.yd, r.top_acceleration)
    allowed = ALLOWED * s.tolerance * float(r.top_acceleration)
    if np.abs(scale * left[rates]).max(initial=0.0) <= allowed:
        return
    slow = mu * np.linalg.solve(mu * np.eye(r.y.size) - J, left)
    off = float(np.abs(scale * (left - slow)[rates]).max())
    if off > max(allowed, float(r.blurred)):
        r.blurred, r.blurred_h, r.blurred_w = off, h, 0.0


def books(s: Scene) -> slice:
    """The works in y."""
    return slice(s.n_q + s.n_v, s.n_q + s.n_v + N_BOOK)


def unit_of_works(r: Record, setting: Settings) -> float:
    """The error allowed to a work, J; see works.py."""
    allowed = setting.step_error * r.exchanged
    return max(float(allowed), ROUNDING * float(r.largest_energy), 1e-300)


def hand_over(solver: Any, b: Buffers) -> None:
    """End of the step into b.y1, values at the nodes into b.P."""
    h = solver.t - solver.t_old
    b.y1[:] = solver.y
    b.P[:] = solver.dense_output()(solver.t_old + NODES * h).T


def nudge(solver: Any, r: Record) -> None:
    """Let scipy go on from the projected state; the change is below its tolerance."""
    solver.y = r.y.copy()
    if hasattr(solver, "f"):
        solver.f = r.yd.copy()
    if hasattr(solver, "D"):
        solver.D[0] = r.y
