"""What user events do, between two calls of the march: switches turn, and the motion goes on.

The equations of the new stage are those of a model of its own (assemble/stages.py) with the memory,
the branches and the counters of the run; positions stay, velocities are projected once.
"""

from functools import partial
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from trsim.assemble.equations import kinetic, poses, stored_energy
from trsim.assemble.light import check_determined, given_back_in_own, nearest_in_mass
from trsim.assemble.projection import project_positions, project_velocities
from trsim.assemble.switches import (
    CHANNEL,
    HELD,
    LOOSE,
    SECTION,
    UserEvent,
    lock_name,
    park_name,
)
from trsim.elements.contract import Memory, Row
from trsim.elements.prescribed import AnyDrive, rates_at
from trsim.elements.scene import Scene, carried
from trsim.errors import ModelError
from trsim.solve.march import record as rec
from trsim.solve.march.impacts import strike
from trsim.solve.march.impulses import Jump, no_jump, together, told
from trsim.solve.march.load_steps import counts, fastest, look, standing, started
from trsim.solve.march.phases import settle
from trsim.solve.march.record import Buffers, Record, Settings, note_event
from trsim.statuses import Ended

Array = NDArray[np.float64]

TORN = 1e-6  # of the mechanism's size, rad: the most a drive may be away from its joint
CLOSED = 1e-10  # the same, left by the projection


class Acted(NamedTuple):
    """What came of the events of one instant."""

    work: Scene  # of the stage that follows
    recorded: Array  # (n, 2 + n_out) time, event, channels
    ended: tuple[Ended, str] | None  # status and reason, where the run ends here
    jump: Jump  # of velocities


def act(mechanism: Any, work: Scene, r: Record, b: Buffers, setting: Settings) -> Acted:
    """Do what the events at the end of the last step say, in the order of the file.

    Leaves a line for each among the events; the channels are those before anything changed.
    """
    run = _Acting(mechanism, work, r, b, setting)
    for k, event in enumerate(run.events):
        if not r.watch[k, rec.JUST_NOW]:
            continue
        r.watch[k, rec.JUST_NOW] = 0.0
        if event.phase >= 0 and (run.ended or not counts(mechanism, r, event)):
            r.watch[k, rec.TIMES] -= 1.0  # another one has ended its phase
            continue
        while k >= 0 and not run.failed:
            k = run.happen(k)
        if run.failed:
            break
    r.fired = 0
    run.strike()
    found = np.array(run.recorded).reshape(-1, 2 + run.work.n_out)
    return Acted(run.work, found, run.ended, together(run.jumps))


class _Acting:
    """What comes of the events of one instant, while it comes."""

    def __init__(
        self, mechanism: Any, work: Scene, r: Record, b: Buffers, setting: Settings
    ) -> None:
        self.mechanism, self.work, self.r, self.b, self.setting = mechanism, work, r, b, setting
        self.events = mechanism.stages.switches.events
        self.recorded: list[Array] = []
        self.jumps: list[Jump] = []
        self.ended: tuple[Ended, str] | None = None
        self.failed = False

    def happen(self, k: int) -> int:
        """Do what event k says; the event that ends at once the phase it begins, or -1."""
        r, b, work, event = self.r, self.b, self.work, self.events[k]
        if event.role == "stall" and not look(work, r, k, event):
            return -1
        row, t = len(self.mechanism.instances) + 1 + k, float(r.t)
        speed = r.watch[k, rec.SLOPE] if event.kind == CHANNEL else r.gap[len(work.contact) + k, 1]
        note_event.python(r, b, t, rec.USER, row, speed)
        if event.record:
            self.recorded.append(np.array([t, k, *b.out[: work.n_out]]))
        if event.end and self.ended is None:
            self.ended = event.status, why_ended(self.mechanism, work, r, b, event)
        try:
            self.work, b.events[r.event_rows - 1, rec.EVENT_WORK], jump = turned(
                self.mechanism, work, r, b, self.setting, k
            )
        except ModelError as error:
            self.failed, self.ended = True, ("failed", failure(event, error))
            return -1
        self.jumps.append(jump)
        if event.leads < 0 or self.ended:
            return -1
        over = started(self.work, r, self.events, event.leads, event)
        if over >= 0:
            r.watch[over, rec.TIMES] += 1.0
            r.watch[over, rec.AT_ONCE] = 1.0
            r.watch[over, rec.JUST_NOW] = 0.0
        return over

    def strike(self) -> None:
        """The impacts of this instant, with the velocities that events have left."""
        if self.failed:
            return
        try:
            self.jumps.append(strike(self.mechanism, self.work, self.r, self.b, self.setting))
        except ModelError as error:
            where = ".".join(map(str, error.path))
            self.failed, self.ended = True, ("failed", f"{where}: {error.what}")


def why_ended(mechanism: Any, work: Scene, r: Record, b: Buffers, event: UserEvent) -> str:
    """Why an event ends the run, where and when; of a limit the forces of the actuators then."""
    t = float(r.t)
    if event.kind == "limit":
        return of_limit(mechanism, b, event, t)
    if event.phase < 0:
        when = "" if event.status == "done" else f" at t = {t:.6g} s: {event.in_words()}"
        return f"event '{event.name}' ended the run{when}"
    phase = f"phase '{mechanism.stages.switches.phases[event.phase]}'"
    if event.role == "taut":
        rope = event.when.rpartition(".")[0]
        return f"{phase}: '{rope}' went slack at t = {t:.6g} s: {event.falls()}"
    if event.role == "stall":
        began = t - event.lasts
        found = f"{phase}: nothing has moved since t = {began:.6g} s: the kinetic energy is "
        found += f"{kinetic(work, r.y):.3g} J, and {fastest(mechanism, work)}"
        return "; ".join(filter(None, (found, standing(mechanism, work, r))))
    how = f"{event.lasts:g} s after it began" if event.lasts else event.falls()
    return f"{phase}, the last one, ended at t = {t:.6g} s: {how}"


def of_limit(mechanism: Any, b: Buffers, event: UserEvent, t: float) -> str:
    """What a limit was, when, and the forces of the actuators then, where they are told."""
    there = {c.name: b.out[c.start] for c in mechanism.columns}
    forces = []
    for instance in mechanism.instances:
        if instance.row.length:  # an actuator: of a supply where there is one, that stalls
            of = (f"{instance.name}.{word}" for word in ("supply_force", "force"))
            forces += [f"{name} {there[name]:.4g} N" for name in of if name in there][:1]
    said = f"{event.when} {event.said} ({event.value:g} {event.unit}) at t = {t:.6g} s"
    return f"{said}: {', '.join(forces)}" if forces else said


def failure(event: UserEvent, error: ModelError) -> str:
    """Why an event could not be carried out."""
    section, name = error.path[:2] if len(error.path) > 1 else ("", "")
    if section == "drives" and len(error.path) == 2:
        fixed = "a coordinate that joints, locks or other drives fix"
        return f"event '{event.name}' ({event.said}): the drive '{name}' would move {fixed}"
    of = f"'{name}', " if section == "bodies" else ""
    return f"event '{event.name}' ({event.said}): {of}{error.what}"


def turned(
    mechanism: Any, work: Scene, r: Record, b: Buffers, setting: Settings, k: int
) -> tuple[Scene, float, Jump]:
    """The scene of the stage event k leads to, with the record brought to it; the work done, J; how
    velocities jumped.

    Raises ModelError where its constraints contradict each other or the positions, or leave the
    motion of a body without mass open.
    """
    before, stages = r.stage.copy(), mechanism.stages
    event = stages.switches.events[k]
    for switch, to in event.turned:
        r.stage[switch] = to
    driven = [n for n, to in event.turned if stages.switches.names[n][0] == "drives" and to > 0]
    if not driven and np.array_equal(before, r.stage):
        return work, 0.0, no_jump()
    t, y = float(r.t), r.y
    energy, twists = total_energy(work, t, y), work.V.copy()
    stored = float(stored_energy(work, t))
    model = stages.model(r.stage)
    for n in driven:
        take_hold(mechanism, work, model, r, n, int(before[n]))
    close_locks(mechanism, work, r, before)
    park(mechanism, work, r, before)
    r.left_out[:] = stages.left_out(r.stage)
    r.weak, r.weakest = 1, 1.0
    work = carried(work, model)
    project(mechanism, work, r)
    jump = told(mechanism, work, r, k, twists)
    check_determined(mechanism, model, work, y)
    done = total_energy(work, t, y) - energy
    y[work.n_q + work.n_v + work.jumps] += done
    settle(work, r, b, setting)
    if of_rest(mechanism, before, r):  # speeds along a path have no energy, and no momentum
        return work, float(stored_energy(work, t)) - stored, no_jump()
    return work, done, jump


def of_rest(mechanism: Any, before: NDArray[np.int64], r: Record) -> bool:
    """Whether the phase before an event and the one behind it are both static."""
    switch, static = mechanism.stages.switches.phase, mechanism.stages.switches.static
    ones = (int(before[switch]), int(r.stage[switch])) if switch >= 0 else (-1,)
    return all(0 <= k < len(static) and static[k] for k in ones)


def total_energy(work: Scene, t: float, y: Array) -> float:
    """Kinetic and stored, J."""
    poses(work, y)
    return float(kinetic(work, y) + stored_energy(work, t))


def instance_of(mechanism: Any, section: str, name: str) -> tuple[int, Any]:
    """Row and instance of an element."""
    for e, instance in enumerate(mechanism.instances):
        if (instance.section, instance.name) == (section, name):
            return e, instance
    raise KeyError(name)


def take_hold(mechanism: Any, work: Scene, model: Any, r: Record, n: int, before: int) -> None:
    """Begin the motion of drive switch n: its time is zero now, its place that of the joint.

    A drive that held on goes on from the place it prescribed, and its piston, which has a mass, at
    the speed it has; `work` is the scene before.
    """
    name = mechanism.stages.switches.names[n][1]
    e, instance = instance_of(mechanism, "drives", name)
    t, first = float(r.t), work.n_q + work.n_v
    old, new = int(AnyDrive(work, e).state), int(AnyDrive(model, e).state)
    if new >= 0:
        if before == LOOSE:
            r.y[first + new] = work.S[AnyDrive(work, e).coordinate, 0]
        elif old < 0:
            since = t - Memory(r, e).since
            r.y[first + new] = rates_at(work.tab, int(AnyDrive(work, e).motion), since)[0]
    slip = instance.row.slip
    if slip >= 0:
        if before == LOOSE:
            take_along(work, r, instance.row)
        else:
            r.y[first + slip] += prescribed_rate(work, e, t - Memory(r, e).since)
        r.y[first + slip] -= prescribed_rate(model, e, 0.0)
    Memory(r, e).since = t


def take_along(work: Scene, r: Record, row: Row) -> None:
    """The piston of an actuator that takes hold again is where its end is, and as fast: its speed,
    not yet less that of the motion."""
    first = work.n_q + work.n_v
    r.y[first + row.piston], r.y[first + row.slip] = work.S[AnyDrive.of(row).coordinate]


def prescribed_rate(model: Any, e: int, since: float) -> float:
    """Of the motion drive e follows, that long after its begin."""
    own = AnyDrive(model, e)
    f, f_dot, _ = rates_at(model.tab, int(own.motion), since)
    return f if own.state >= 0 else f_dot


def close_locks(mechanism: Any, work: Scene, r: Record, before: NDArray[np.int64]) -> None:
    """Locks that close hold the coordinate where it is."""
    for n, (section, name) in enumerate(mechanism.stages.switches.names):
        if section == "locks" and r.stage[n] == HELD and before[n] != HELD:
            _, lock = instance_of(mechanism, SECTION, lock_name(name))
            own = AnyDrive.of(lock.row)
            r.y[work.n_q + work.n_v + own.state] = work.S[own.coordinate, 0]


def park(mechanism: Any, work: Scene, r: Record, before: NDArray[np.int64]) -> None:
    """Bodies that are parked stay where they are."""
    for n, (section, name) in enumerate(mechanism.stages.switches.names):
        if section == "parks" and r.stage[n] == HELD and before[n] != HELD:
            e, instance = instance_of(mechanism, SECTION, park_name(name))
            poses(work, r.y)
            instance.element.hold(work, e)


def project(mechanism: Any, work: Scene, r: Record) -> None:
    """Positions and velocities of the record to the constraints of a stage, nearest in M."""
    if work.m == 0:
        return
    t = float(r.t)
    for k in range(8):
        worst = project_positions(work, t, r.y)
        if k == 0 and worst > TORN * min(work.size, 1.0):
            row = mechanism.stages.rows(r.stage)[int(np.argmax(np.abs(work.phi[: work.m])))]
            raise ModelError(
                f"{row} would jump by {worst:.3g}; a position that is set begins where the joint is"
            )
        if worst <= CLOSED * work.size:
            break
    v = r.y[work.n_q : work.n_q + work.n_v]

    def nearest(wanted: Array) -> Array:
        v[:] = wanted
        poses(work, r.y)
        project_velocities(work, r.y)
        return v.copy()

    nearest_in_mass(len(work.light), v.copy(), nearest, partial(given_back_in_own, work))
