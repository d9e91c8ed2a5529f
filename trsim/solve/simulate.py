"""One run: from a mechanism and its start to blocks of results, and an outcome."""

import time
from collections.abc import Generator, Sequence
from importlib import import_module
from typing import Any

import numpy as np
from numpy.typing import NDArray

from trsim.assemble.mechanism import Mechanism
from trsim.assemble.switches import UserEvent
from trsim.elements.scene import Scene, scene
from trsim.errors import ScenarioError
from trsim.scenario.methods import GGL, INDEX_1, METHODS
from trsim.solve.diagnose.blame import on_a_corner, on_a_jump, undecided, why
from trsim.solve.diagnose.crossed import examine
from trsim.solve.diagnose.mesh_error import Bends
from trsim.solve.diagnose.no_number import refuse_no_number, unshown
from trsim.solve.diagnose.strained import collapsed
from trsim.solve.diagnose.unended import left
from trsim.solve.march import record as rec
from trsim.solve.march.act import act
from trsim.solve.march.anew import anew, begun_with, resumed, stuck
from trsim.solve.march.calls import FIELDS
from trsim.solve.march.checkpoint import State, begun_at, put_back, state
from trsim.solve.march.load_steps import clocks_of
from trsim.solve.march.loop import begin, march, method_table
from trsim.solve.march.record import Record, Settings, fresh_buffers
from trsim.solve.outcome import (
    CRAWLS,
    Block,
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
from trsim.solve.start.consistent import Start, start
from trsim.statuses import Ended

Array = NDArray[np.float64]

UNUSED = ("dop853",)  # of a run without motion: it only lends its sizes
SPARSE_FROM = 30  # velocities: ten planar bodies, five spatial ones; measured on stiff chains
# what the multipliers of a tighter one are rounded to looks like its error, as it does in the first
# moments of a hard touch, whose error is judged by depths of nanometres
SPARSE_UNTIL = 1e-11  # tolerance
NO_STEP_FOUND = (rec.NOT_FINITE, rec.STEP_TOO_SMALL)
GO_ON = (rec.FULL, rec.PAUSE, rec.LOAD, rec.ACT)  # the march is called again after these
VISIT, LIGHT = 5000, 30  # steps between two looks at the outside world, of so many velocities
BARS = 100  # steps, where flexible bars may collapse

NO_STEPS_LEFT, STEP_TOO_LARGE, CONTRADICTORY, STUCK = -1, -2, -3, -4
REASONS = {
    NO_STEPS_LEFT: "more than {} steps",
    STEP_TOO_LARGE: "a value is not finite, or grew beyond bounds: the fixed step is too large for "
    "the stiffest contact, or the mechanism jams",
    CONTRADICTORY: "no position or acceleration meets all constraints here: a mechanism that jams, "
    "or masses and inertias so unequal that the arithmetic cannot tell the constraints apart, "
    "or a body without mass or inertia that nothing with mass moves any more",
    STUCK: "wherever the mechanism goes from here rows of its joints depend on each other, and no "
    "choice of rows lets it go on: it jams",
    rec.STEP_TOO_SMALL: "the step size fell below the resolution of time: a force that grows "
    "without bound, or jumps",
    rec.CRAWL: CRAWLS,
    rec.NOT_FINITE: "a force or an acceleration is not finite",
    rec.WINDS: "a fixed step turns a joint in space by a third of a turn or more, so that its "
    "turns cannot be counted: take a shorter `step`",
    rec.CHATTER: "contacts open and close without time passing (chatter)",
}


def simulate(
    scenario: Any, mechanism: Mechanism, checkpoint: State | None = None
) -> Generator[Block, None, Outcome]:
    """March from the start to `end`; yields blocks and returns the outcome.

    With a checkpoint, the `state` of a block, it goes on after that block instead, and yields what
    an unbroken run would have yielded from there.  Methods of scipy know no checkpoints.

    Raises ModelError where there is no consistent start.
    """
    if METHODS[scenario.solver.method].rests and not mechanism.stages.switches.phases:
        from trsim.solve.path.follow import simulate as along_path

        return along_path(scenario, mechanism)
    used = [import_module(f"trsim.solve.methods.{name}") for name in files(scenario, mechanism)]
    if not used:
        from trsim.solve.methods.scipy_ivp import simulate as by_scipy

        return by_scipy(scenario, mechanism)
    return compiled(scenario, mechanism, used, checkpoint)


def files(scenario: Any, mechanism: Mechanism) -> tuple[str, ...]:
    """The methods (solve/methods) that make the steps of a run; none for a method of scipy."""
    solver = scenario.solver
    if METHODS[solver.method].rests:  # all phases are static: no method makes a step
        return UNUSED
    known, formulation = METHODS[solver.method].files, solver.formulation or INDEX_1
    if solver.formulation is None and GGL in known:
        large, touches = mechanism.model.n_v >= SPARSE_FROM, len(mechanism.model.contact) > 0
        held = solver.stabilisation == "baumgarte"  # whose terms belong to the accelerations
        light = len(mechanism.model.light) > 0  # which are solved for with the accelerations
        if large and not touches and not held and not light and solver.tolerance >= SPARSE_UNTIL:
            formulation = GGL
    if solver.formulation == GGL and len(mechanism.model.light):
        hint = "leave `formulation` out, or give every body a mass and an inertia"
        what = "ggl is not solved for with bodies without mass or inertia"
        raise ScenarioError(what, hint, ("solver", "formulation"))
    return known.get(formulation, known.get(INDEX_1, ()))


def check_step(scenario: Any, found: Any) -> None:
    """Refuse a fixed step that is not stable at the Scales of the start, unless it is forced.

    Raises ScenarioError with the bound and what sets it.
    """
    step, method = scenario.solver.step, scenario.solver.method
    fixed = not METHODS[method].adaptive and not scenario.solver.force
    if fixed and step > found.explicit_step:
        raise ScenarioError(
            f"a step of {step:g} s is not stable: {method} needs at most "
            f"{found.explicit_step:.3g} s, for {found.fastest_is} ({found.fastest:.3g}/s)",
            f"`step: {0.5 * found.explicit_step:.2g} s`, or `method: auto`; "
            "`force: true` tries it all the same",
            ("solver", "step"),
        )


def compiled(
    scenario: Any, mechanism: Mechanism, used: list[Any], checkpoint: State | None
) -> Generator[Block, None, Outcome]:
    """The march of march.py with a compiled method, or an explicit and an implicit one."""
    setting = settings(scenario, mechanism)
    located, driven = setting.locate > 0, METHODS[scenario.solver.method].driven
    if driven:
        from trsim.solve.start.driven import check_driven

        check_driven(scenario, mechanism)
    static = mechanism.stages.switches.static
    begun = begun_by(scenario, mechanism, located, checkpoint)
    work, left_out = begun_with(mechanism, begun)
    spanned = int(np.ceil(setting.fixed_step / setting.every))
    if setting.fixed_step > 0.0 and not scenario.solver.force and not checkpoint:
        from trsim.solve.diagnose.scales import scales

        check_step(scenario, scales(scenario, mechanism, begun))
    stages, dense_rows = (max(getattr(m, k) for m in used) for k in ("STAGES", "DENSE_ROWS"))
    implicit = any(method.IMPLICIT for method in used)
    switches = mechanism.stages.switches
    sparse = next((m.SPARSE for m in used if hasattr(m, "SPARSE")), None)
    past_rows = dense_rows if implicit and not sparse else 0
    rows = max(m.DENSE_ROWS if m.IMPLICIT else max(m.STAGES, m.DENSE_ROWS) for m in used)
    r = new_record(work, begun, left_out, rows, past_rows, len(switches.names))
    room = most_points(mechanism, setting)
    b = fresh_buffers(work, r.y.size, stages, dense_rows, spanned, room)
    if driven:
        from trsim.solve.march.sides import keep_side, with_room

        r, b = with_room(r, b, work)
    if sparse:
        r = sparse.record(r, mechanism, dense_rows)
        b = sparse.buffers(b, mechanism, work)
    methods = np.zeros((len(used), len(FIELDS)), np.int64)
    called = called_by(mechanism, setting)
    if len(r.passed):
        from trsim.solve.march.passes import note_passes

        called["passes"] = note_passes.address()
    if not all(static) or not static:
        methods[0] = method_table(used[0], **called)
    clock0 = time.process_time()
    if checkpoint:
        clock0 -= put_back(checkpoint, r, work)
        work = resumed(mechanism, work, r)
        b = sparse.buffers(b, mechanism, work) if sparse else b
        work.tab[work.held] = r.held  # functions, as the record says
        clocks_of(work, r, switches.events)
    else:
        begin(work, r, b, setting)
        refuse_no_number(mechanism, b.rows[0, 1:])
        r.h = first_step(scenario, r)
        if static and static[0]:  # its first row, and all that is told, is that of the path
            r.rows = r.next_row = 0
            r.peak[rec.PEAK_MAX], r.peak[rec.PEAK_MIN] = -1e300, 1e300
    if driven and not keep_side(work, r, b):
        from trsim.solve.diagnose.singular import singular_start

        raise singular_start(mechanism, r)
    limit = scenario.solver.max_steps or 2**62
    visit = max(1, VISIT * LIGHT // max(LIGHT, mechanism.model.n_v))
    visit = min(visit, BARS) if mechanism.beams else visit
    bends = Bends(mechanism)
    bends.look(float(r.t), r.y)
    ended = None  # by a user event
    if any(static):
        from trsim.solve.path.phase import Walks

        walks = Walks(scenario, mechanism, located)
        if checkpoint:
            walks.put_back(checkpoint)
    begins = bool(switches.phases) and not checkpoint
    if begins:
        r.watch[first_phase(switches.events), rec.JUST_NOW] = 1.0
    while True:
        most = min(visit, limit - int(r.steps))
        if begins:
            reason = rec.ACT
        elif any(static) and walks.on_path(r):
            reason, ended = yield from walks.walk(work, r, b)
        else:
            reason = march(work, r, b, setting, methods, most)
        begins = False
        examine(work, r, other_rows=reason == rec.ACT)
        recorded = jump = None
        if reason == rec.ACT and ended is None:
            before, (work, recorded, ended, jump) = work, act(mechanism, work, r, b, setting)
            if work is not before:  # other equations
                r.h = min(r.h, first_step(scenario, r))
            if r.weak and ended is None:
                work = anew(mechanism, work, r, b, setting, acted=work is not before)
                if driven:
                    keep_side(work, r, b)
                reason = STUCK if stuck(r, setting) else reason
            if work is not before:
                b = sparse.buffers(b, mechanism, work) if sparse else b
        if driven and r.crossings and ended is None:
            from trsim.solve.diagnose.singular import crossed

            ended = "failed", crossed(mechanism, r)
        bends.look(float(r.t), r.y)
        if reason in GO_ON and ended is None and mechanism.beams:
            text = collapsed(scenario, mechanism, float(r.t), r.y)
            ended = ("failed", text) if text else None
        cpu, paused = time.process_time() - clock0, reason in GO_ON and ended is None
        if reason == rec.LOAD:  # what no scene needed so far is not loaded, or compiled
            methods[:] = [method_table(method, **called) for method in used]
            clock0 = time.process_time() - cpu
        block = emptied(r, b, recorded, jump)
        if paused:
            of_walks = walks.kept() if any(static) else {}
            block = block._replace(state=state(r, work, begun, cpu) | of_walks)
        yield block
        if not paused:
            break
        if r.steps >= limit:
            reason = NO_STEPS_LEFT
            break
    status, text = ended or ending(reason, setting, scenario, mechanism, work, r)
    times = zip(switches.events, r.watch[:, rec.TIMES].astype(int).tolist(), strict=True)
    fired = {event.name: n for event, n in times if event.kind != "limit" and not event.role}
    found = statistics(r, work, begun, cpu)
    if many := left(mechanism, r, ended is not None):
        found["phases_left"] = many
    said: tuple[str, ...] = ()
    if any(static):
        said, found = walks.said, found | walks.numbers
    return Outcome(status, text, float(r.t), found,
                   r.peak.T.copy(), r, begun, fired, bends.states, said)  # fmt: skip


def begun_by(
    scenario: Any, mechanism: Mechanism, located: bool, checkpoint: State | None = None
) -> Start:
    """The start: of a checkpoint, of a motion, or of a static phase."""
    if checkpoint:
        return begun_at(checkpoint, mechanism, scene(mechanism.model))
    if (static := mechanism.stages.switches.static) and static[0]:
        from trsim.solve.path.begin import begin as begin_path

        return begin_path(scenario, mechanism)
    return start(scenario, mechanism, located)


def first_phase(events: Sequence[UserEvent]) -> int:
    """The event with which the first phase begins."""
    return next(k for k, event in enumerate(events) if event.role == "begin")


def ending(
    reason: int, setting: Settings, scenario: Any, mechanism: Mechanism, work: Scene, r: Record
) -> tuple[Ended, str]:
    """Status and reason of a run that no event ended."""
    if reason == rec.DONE:
        text = collapsed(scenario, mechanism, float(r.t), r.y)
        return ("failed", text) if text else ("done", "")
    if reason in (rec.OPEN, rec.ADRIFT, rec.LEAPT, rec.SLIDES, rec.POLE):
        return "failed", untrue(scenario, mechanism, r)
    whose, text = undecided(mechanism, work)
    if whose is not None and reason != NO_STEPS_LEFT:
        entry = scenario.entry(whose.section, whose.name)
        return "painleve", f"{entry}: from t = {r.t:.6g} s on {text}"
    if reason in NO_STEP_FOUND and (text := unshown(mechanism, work.out)):
        return "failed", text
    if reason in (rec.NOT_FINITE, rec.TOO_FAST) and setting.fixed_step > 0.0:
        reason = STEP_TOO_LARGE
    elif reason == rec.NOT_FINITE and work.status[3] > 0:
        reason = CONTRADICTORY
    limit = scenario.solver.max_steps
    text = REASONS[reason].format(limit) if reason in REASONS else runaway(mechanism, r)
    at = mechanism.in_stage(r.stage, r.left_out)
    if reason != NO_STEPS_LEFT:
        held = on_a_corner(at, work) if reason in (rec.STEP_TOO_SMALL, rec.CRAWL) else ""
        text = why(scenario, at, r) or held or text
    elif jump := on_a_jump(scenario, at, r.y) or on_a_corner(at, work):
        text = f"{text}; {jump}"
    return "failed", text
