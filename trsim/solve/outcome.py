"""What a run needs around its march, whatever makes the steps: settings, record, outcome."""

from collections.abc import Mapping
from math import sqrt
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from trsim.assemble.equations import largest_wrench, poses
from trsim.assemble.features import READS
from trsim.assemble.mechanism import Mechanism
from trsim.assemble.reduce import largest_reaction
from trsim.elements.contract import DRIVES, N_BOOK
from trsim.elements.scene import N_STORED, PROJECTION, Scene
from trsim.errors import ScenarioError
from trsim.scenario.methods import METHODS
from trsim.solve.diagnose.adrift import lost_its_way
from trsim.solve.diagnose.blame import RESTS, on_a_jump
from trsim.solve.diagnose.poles import at_pole
from trsim.solve.march import record as rec
from trsim.solve.march.impulses import Jump, no_jump
from trsim.solve.march.openings import held_to, look, opened
from trsim.solve.march.record import Record, Settings
from trsim.solve.march.sampled import MOST_PARTS
from trsim.solve.march.works import LEAST
from trsim.solve.start.consistent import Start
from trsim.statuses import Ended

Array = NDArray[np.float64]


class Block(NamedTuple):
    """Results of a stretch of the run; arrays are only valid until the next block."""

    rows: Array  # (n, 1 + n_out) time, channels
    steps: Array  # (n, 2 + n) time, row of the contact, its channels
    events: Array  # (n, N_EVENT) see record.py
    time: float
    step: float
    n_events: int
    recorded: Array  # (n, 2 + n_out) time, user event, channels
    points: Array  # (n, N_POINT) of Poincare sections, see record.py
    jump: Jump = no_jump()  # of velocities at user events, see impulses.py
    state: dict[str, NDArray[Any]] | None = None  # after it, see checkpoint.py; None: cannot go on


class Outcome(NamedTuple):
    """How the run ended, and what it says of its own accuracy."""

    status: Ended
    reason: str
    time: float
    statistics: dict[str, float]
    peaks: Array  # (n_out, 4) largest, its time, smallest, its time
    record: Record
    start: Start
    fired: Mapping[str, int] = {}  # user event -> how often it happened
    bent: Mapping[str, tuple[float, Array]] = {}  # bar -> time and y where it was bent most
    said: tuple[str, ...] = ()  # by the method itself, see doubts.py


CRAWLS = (
    "thousands of steps in a row were shorter than 1e-11 of the run, which would need 1e11 of "
    "them: a force that grows without bound, or a tolerance below the rounding of the state"
)
SPEEDS = ("the velocity", "the angular velocity")
SHARE, EASY, PROPORTION = 0.5, 1e-2, 8.0 / 7.0  # see `settings`
MISSED = 0.3  # of the tolerance: what may be missed of an extreme
LOOKS = 200  # of a run, at least: steps while something depends on time explicitly
LOOK_ROWS = 5.0  # and never longer than this many output intervals
# h times the fastest rate of Baumgarte's feedback, inside the stability of explicit methods.  In
# longer steps what rounding opens rows by grows from stage to stage, and the dense output is made
# of stages
FEEDBACK = 3.0
FEWEST_ROWS = 1024  # of the buffer of rows, see record.py
MOST_POINTS = 1e6
ROUNDING = 1e-14  # of the unit of a channel: what no extreme of it is told by
CROSSINGS = 2.0 * MOST_PARTS  # of a step, at most
NOTHING = 1e-20  # of the energy at the speeds a run expects: rounding of what is at rest
CLOSED = 1e-7  # of the largest energy: forces are not asked for where what is open is less
ROUNDED = 1e-12  # of forces that balance, times the size: an energy that rounding of them makes
AT_REST = 1e-9  # of the energy that goes with its forces: kinetic energy of what rounding moves
FINEST = 1e-14  # of the run: the last of shorter steps would hardly move the time, or not at all
MOST_ROWS = 10_000  # output rows one fixed step may span


def fastest_feedback(model: Any) -> float:
    """The fastest rate of Phi'' + 2 alpha Phi' + beta^2 Phi = 0, 1/s."""
    alpha, beta = float(model.alpha), float(model.beta)
    return alpha + sqrt(alpha**2 - beta**2) if alpha > beta else beta


def settings(scenario: Any, mechanism: Mechanism) -> Settings:
    """The constants of the march.

    The error of a run grows like tolerance^0.75..0.88 where each step keeps to the tolerance.  So
    that ten times the tolerance means about ten times the error, and smooth motion of some tens of
    steps keeps to it at its end, steps are held to SHARE EASY (tolerance / EASY)^PROPORTION.
    """
    solver, output = scenario.solver, scenario.output
    method = METHODS[solver.method]
    check_impacts(solver, mechanism)
    if solver.end is None:
        raise ScenarioError(
            "a run needs `solver: {end: ...}`", "for example `end: 1 s`", ("solver", "end")
        )
    every = output.every or solver.end / 1000.0 or 1.0
    longest = solver.max_step or solver.end or 1.0
    # where rows alone tell places nothing is missed but what lies between two rows
    told = method.driven and mechanism.model.n_z == N_BOOK
    if mechanism.timed and not solver.max_step and not told:
        # what is smooth and short between two stages of a long step would not be seen at all
        longest = min(longest, max(solver.end / LOOKS, 1e-300), LOOK_ROWS * every)
    if solver.stabilisation == "baumgarte" and method.explicit and method.adaptive:
        longest = min(longest, FEEDBACK / max(fastest_feedback(mechanism.model), 1e-300))
    fixed = 0.0 if method.adaptive else solver.step
    check_given_steps(solver, "max_step" if method.adaptive else "step")
    if fixed > MOST_ROWS * every:
        raise ScenarioError(
            f"a step of {solver.step:g} s spans more than {MOST_ROWS} output rows",
            "make `output: {every: ...}` longer or the step shorter",
            ("output", "every"),
        )
    if every < 1e-9 * solver.end:
        raise ScenarioError(
            f"{solver.end / every:.0e} output rows",
            "`every` is the time between two rows; at most 1e9 rows are written",
            ("output", "every"),
        )
    return Settings(
        t_end=solver.end,
        step_error=SHARE * EASY * (solver.tolerance / EASY) ** PROPORTION,
        h_max=longest,
        every=every,
        fixed_step=fixed,
        locate=int(solver.locates and len(mechanism.model.contact) > 0),
        chooses=int(method.chooses),
        missed=MISSED * solver.tolerance,
        held_to=held_to(solver.tolerance),
        tolerance=solver.tolerance,
        at_rows=int(method.driven),
    )


def check_impacts(solver: Any, mechanism: Mechanism) -> None:
    """Refuse touches that take no time where none is located; raises ScenarioError."""
    method = METHODS[solver.method]
    if method.rests or (solver.locates and method.marches):
        return
    for e in mechanism.model.contact[mechanism.model.contact_impact > 0].tolist():
        there = mechanism.instances[e]
        raise ScenarioError(
            f"{there.section}.{there.name} has touches that take no time, which are none unless "
            "each is located",
            "leave out `method`, or give `locate_events: true`",
            ("solver", "method" if solver.locates else "locate_events"),
        )


def check_given_steps(solver: Any, key: str) -> None:
    """Refuse steps that are given and cannot come to the end; raises ScenarioError."""
    given, least = getattr(solver, key), FINEST * solver.end
    if given and given < least:
        raise ScenarioError(
            f"steps of {given:.3g} s would be {solver.end / given:.0e} in {solver.end:g} s",
            f"make it {least:.1g} s or longer, the run shorter, or check the unit",
            ("solver", key),
        )


def called_by(mechanism: Mechanism, setting: Settings) -> dict[str, int]:
    """The addresses of what only some runs need, by its field of a row of methods (calls.py).

    What a run does not need is not compiled.
    """
    model, found = mechanism.model, {}
    if mechanism.sections:
        from trsim.solve.march.sections import sections

        found["sections"] = sections.address()
    if len(model.feature):
        from trsim.solve.march.features import meet

        found["meet"] = meet.address()
    if model.stabilisation != PROJECTION and model.m > 0:
        from trsim.solve.diagnose.adrift import look_at_drift

        found["look"] = look_at_drift.address()
    elif len(model.redundant) or mechanism.stages.switches.names:  # of a stage, too
        found["look"] = look.address()
    if setting.locate > 0 or len(model.watch):
        from trsim.solve.march.search import search

        found["search"] = search.address()
    if model.hear:
        from trsim.solve.march.heard import sound

        found["sound"] = sound.address()
    if len(model.pole):
        from trsim.solve.march.poles import poles_ahead

        found["poles"] = poles_ahead.address()
    if model.feature[:, READS].any():
        from trsim.solve.march.sensed import beyond, corners_ahead, turn

        found["turn"] = turn.address()
        if len(model.sensed):
            found["corners"], found["beyond"] = corners_ahead.address(), beyond.address()
    return found


def most_points(mechanism: Mechanism, setting: Settings) -> int:
    """How many points of sections one step may add; a step spans a buffer of rows at most.

    Raises ScenarioError where that is no buffer any more.
    """
    spanned = FEWEST_ROWS + setting.fixed_step / setting.every
    longest = min(setting.t_end, spanned * setting.every)
    most = 0
    for section in mechanism.sections:
        own = longest / section.every + 2.0 if section.every else CROSSINGS
        if own > MOST_POINTS:
            raise ScenarioError(
                f"{own:.0e} points may fall into one step",
                "make the period longer, or the time between two output rows shorter",
                ("poincare", section.name, "every"),
            )
        most += int(own)
    return most


def first_step(scenario: Any, record: Record) -> float:
    """The first step of a run, s: as given, or from the units of the error norm."""
    if scenario.solver.first_step:
        return float(scenario.solver.first_step)
    length, speed = record.length, max(record.speed, record.speed_cap)
    return step_of(length, speed, scenario.solver.tolerance, scenario.solver.end)


def step_of(length: float, speed: float, tolerance: float, end: float) -> float:
    """A first step in a run of `end`, s: 0.3 l / v tolerance^(1/8), by the units of the error norm
    l (m) and v (m/s); steps of smooth motion become ten times as long and more."""
    return float(min(0.3 * (length / max(speed, 1e-300)) * tolerance ** (1 / 8), end))


def new_record(
    model: Scene, begun: Start, left_out: Any, rows: int, past_rows: int = 0, switches: int = 0
) -> Record:
    """A record at the start; memory and branches are the scene's own arrays.

    left_out: which rows are, see assemble/stages.py.

    rows: stages of a step, or of its dense output: what there are more of.
    past_rows: of the dense output an implicit method draws on; 0 for explicit ones.
    switches: what user events can switch, see assemble/stages.py.
    """
    n_v = model.n_v if past_rows else 0
    n_w = n_v + model.n_z - N_BOOK if past_rows else 0
    passes = rec.PASSES_KEPT if model.near_rows > 0.0 else 0
    model.mem[:] = begun.mem
    model.branch[:] = begun.branch
    n_y, extremes = begun.y.size, len(model.kin) > 0
    sizes = {
        "n_y": n_y,
        "gaps": len(model.contact) + len(model.watch),
        "channels": model.n_out + len(model.vector),
        "ends": 4 if extremes else 0,
        "rows": rows if extremes else 0,
        "n_w": n_w,
        "n_dx": n_v,
        "past_rows": past_rows,
        "switches": switches,
        "passes": passes,
        "way": 2 + 2 * n_y + len(model.branch),
        "meetings": rec.MEETINGS_KEPT if passes else 0,
        "n_x": model.n_v + model.n_z - N_BOOK,
    }
    record = Record(
        y=begun.y.copy(),
        mem=model.mem,
        branch=model.branch,
        firm=np.ones((2, sizes["channels"])),
        impact=begun.depth.copy(),
        left_out=np.array(left_out, np.int64),
        **rec.zeros(Record, model, sizes),
    )
    for kind, powers in enumerate(model.natural):
        if powers.any():
            mass, size, speed = np.array([np.sum(model.mass), model.size, begun.moving]) ** powers
            record.faint[kind] = ROUNDING * mass * size * speed
    record.weakest = 1.0
    record.length, record.speed_cap = begun.length, begun.speed
    record.speed = record.top_speed = begun.moving
    record.exchanged = LEAST * float(np.sum(model.mass)) * begun.speed**2
    return record


def emptied(
    r: Record, b: rec.Buffers, recorded: Array | None = None, jump: Jump | None = None
) -> Block:
    """What the buffers hold, and what user events recorded and did; they count as empty
    afterwards."""
    block = Block(
        b.rows[: r.rows],
        b.steps[: r.step_rows],
        b.events[: r.event_rows],
        float(r.t),
        float(r.h),
        int(r.events),
        np.zeros((0, 1 + b.rows.shape[1])) if recorded is None else recorded,
        b.points[: r.point_rows],
        jump or no_jump(),
    )
    r.rows = r.step_rows = r.event_rows = r.point_rows = 0
    return block


def runaway(mechanism: Mechanism, r: Record) -> str:
    """Which body is faster than anything is, if one is: the reason such a run is ended."""
    model = mechanism.model
    speeds = np.abs(r.y[model.n_q : model.n_q + model.n_v])
    if not np.max(speeds, initial=0.0) > rec.FASTEST:
        return ""
    body = whose(mechanism, model.n_q + int(np.argmax(speeds))).split(" of ")[1]
    return (
        f"{body} is faster than {rec.FASTEST:.0e} m/s or rad/s: does a load run away, "
        "is a stiffness or a damping negative?"
    )


def leapt(mechanism: Mechanism, r: Record) -> str:
    """Which drive would have taken the mechanism to another place in no time."""
    instance = mechanism.instances[int(r.torn) - 1]
    unit = "rad" if instance.row.turns else "m"
    by, t = r.torn_by, r.t
    return (
        f"drives.{instance.name}: the prescribed position jumps by {by:.6g} {unit} at t = {t:.9g} "
        "s, which no mechanism can follow: let it go there in a time of its own, as "
        "`step5(t, t0, x0, t1, x1)` does, or give the drive a compliance"
    )


def slid(mechanism: Mechanism, r: Record) -> str:
    """Which function would hold a rate, or a place, where it jumps."""
    name = next(f.name for f in mechanism.functions if f.offset == abs(int(r.slid)) - 1)
    if r.slid < 0:
        return f"{name}: at t = {float(r.t):.9g} s {RESTS}"
    return (
        f"{name}: at t = {float(r.t):.9g} s a rate reaches a value at which this jumps, and is "
        "driven back to it from both sides: it would stay there with a force that no function "
        "tells, as dry friction does.  Take a law of friction, or let the force pass through the "
        "value in a band of rates, as `rate/sqrt(rate**2 + v0**2)` does"
    )


def untrue(scenario: Any, mechanism: Mechanism, r: Record) -> str:
    """Why what a run comes to is no motion of the mechanism, in words; empty where it is one."""
    if r.torn:
        return leapt(mechanism, r)
    if r.slid:
        return (on_a_jump(scenario, mechanism, r.y) if r.slid < 0 else "") or slid(mechanism, r)
    if r.pole:
        return at_pole(scenario, mechanism, int(r.pole) - 1, float(r.pole_t))
    if r.opened:
        return opened(scenario, mechanism, r)
    return lost_its_way(scenario, mechanism, r) if r.lost else ""


def whose(mechanism: Mechanism, c: int) -> str:
    """What entry c of y tells of which body, or node of a bar; nothing for states of elements."""
    model, k = mechanism.model, c
    d, bars, kinds = 3 if model.d == 3 else 7, model.q_node, ("the place", "the attitude")
    if c >= model.n_q:
        k, d, bars, kinds = c - model.n_q, model.d, model.v_node, SPEEDS
    if c >= model.n_q + model.n_v:
        return ""
    turns = k < bars and k % d >= (2 if model.d == 3 else 3)
    frame = 1 + k // d if k < bars else model.n_r + (k - bars) // model.d_node
    body = next(name for name, f in mechanism.frames.items() if f == frame)
    return f"{kinds[turns]} of '{body}'"


def statistics(r: Record, work: Scene, begun: Start, cpu: float) -> dict[str, float]:
    """Counts, residuals and the energy book's error."""
    book, least = float(r.largest_energy), NOTHING * natural(work, begun)
    scale = max(book, of_what_is_locked(r, work, begun), least, 1e-300)
    lost, projected = float(r.largest_residual), abs(float(r.work_projection))
    balance = of_what_balances(r, work) if max(lost, projected) > CLOSED * scale else 0.0

    def relative(energy: float) -> float:
        return energy / (scale if energy > ROUNDED * balance else max(scale, balance))

    redundant = float(r.worst_open)
    held = work.stabilisation == PROJECTION  # residuals are those before it, and gone after it
    unprojected = 0.0 if held else float(r.worst_phi) / work.size
    return {
        "steps": int(r.steps),
        "rejected_steps": int(r.rejected),
        "evaluations": int(work.status[1]),
        "factorisations": int(work.status[2]),
        "dense_outputs": int(r.dense_built),
        "events": int(r.events),
        "unproved_searches": int(r.unproved),
        "corners": int(r.corners_met),
        "method_switches": int(r.method_switches),
        "jacobians": int(r.jacobians),
        "newton_iterations": int(r.iterations),
        "position_residual": float(r.worst_phi),
        "velocity_residual": float(r.worst_phi_dot),
        "start_position_residual": begun.moved,
        "start_force_residual": begun.residual,
        "energy_residual": float(r.largest_residual),
        "energy_residual_relative": relative(lost),
        "work_error_relative": float(r.work_error / max(r.exchanged, 1e-300)),
        "work_of_projection": float(r.work_projection),
        "work_of_projection_relative": relative(projected),
        "joints_open_relative": max(redundant, unprojected),
        "redundant_open_relative": redundant,
        "redundant_open_rate": float(r.worst_open_rate),
        **rounding(r),
        **unproved(work),
        **unfollowed(r),
        "integration_cpu": cpu,
    }


def rounding(r: Record) -> dict[str, float]:
    """What rounding made of a step, of what the tolerance allows; where it was more."""
    rounded = float(r.rounded)
    return {"rounding_of_tolerance": rounded} if rounded > 1.0 else {}


def unproved(work: Scene) -> dict[str, float]:
    """How often the friction found in joints was not proved to be the only one; where it was so."""
    many = int(work.status[8])
    return {"unproved_frictions": many} if many else {}


def unfollowed(r: Record) -> dict[str, float]:
    """How often sections and events could not follow what happened in a step; where it was so."""
    many = int(r.unfollowed)
    return {"unfollowed_steps": many} if many else {}


def natural(work: Any, begun: Start) -> float:
    """The energy of all bodies at the speed that the run expects, J."""
    return float(np.sum(work.mass) * begun.speed**2)


def of_what_is_locked(r: Record, work: Scene, begun: Start) -> float:
    """An energy that goes with the forces on what cannot move, J; 0 where something can.

    Where nothing moves no energy is exchanged, and rounding is all that a book could be held to.
    """
    if work.n_v > work.m or work.column_energy < 0:
        return 0.0
    kinetic, drives = work.column_energy, work.column_energy + 1 + N_STORED + DRIVES
    force = np.abs(work.F[:, :3]).max(initial=0.0)
    force = max(force, largest_reaction(work))
    there = float(force * work.size) + natural(work, begun)
    driven = np.any(r.peak[[rec.PEAK_MAX, rec.PEAK_MIN], drives])
    still = r.peak[rec.PEAK_MAX, kinetic] <= AT_REST * there
    return there if still and not driven else 0.0


def of_what_balances(r: Record, work: Scene) -> float:
    """The energy of the largest force along the mechanism's size, J.  Of what rests on forces that
    balance each other, though it could move, rounding of them is all that moves."""
    poses(work, r.y)
    force = max(largest_reaction(work), largest_wrench(work, float(r.t)))
    return float(force * work.size)
