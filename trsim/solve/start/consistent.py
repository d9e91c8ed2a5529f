"""Where a run starts: consistent positions and velocities, contacts at rest where asked for.

Positions: as drawn, moved to the joint values of `initial` in small steps, and to the static
equilibrium of the joints named there.  Velocities: those of the mechanism with all clearances ideal
and the drives at speed - with bodies' velocities given, the nearest that the joints allow; closed
stops stay closed, and what is then still free of the named joints has zero rate.
"""

from collections.abc import Callable
from dataclasses import dataclass, replace
from itertools import product
from typing import Any

import numpy as np
from numpy.typing import NDArray

from trsim import elements
from trsim.assemble.assemble import assemble
from trsim.assemble.equations import derivative, gaps
from trsim.assemble.light import check_determined
from trsim.assemble.mechanism import Mechanism
from trsim.assemble.reduce import closest, jacobian, largest_reaction
from trsim.assemble.switches import LIMITS, UserEvent, hold, limits
from trsim.elements.contract import (
    BRANCH,
    CONTACT,
    FLIGHT,
    IMPACT_SPEED,
    N_BOOK,
    PHASE,
    UNLOCATED,
    WHOLE,
    ContactNumbers,
)
from trsim.elements.coordinates import called, of_joint, split
from trsim.elements.scene import Model, workspace
from trsim.errors import ModelError
from trsim.solve.diagnose.blame import refuse_no_number, undecided
from trsim.solve.march.openings import check_closed
from trsim.solve.start.angles import (
    as_of,
    follow,
    on_turns_of_drives,
    posed,
    remember,
    strained,
    with_scene,
)
from trsim.solve.start.bars import as_flexible, as_rigid
from trsim.solve.start.softening import softened
from trsim.solve.start.statics import equilibrium
from trsim.solve.start.velocities import velocities

Array = NDArray[np.float64]

HOLD = "hold "  # before a joint: the drive that puts it where `initial` wants it
CREEP = 1e-2  # of a body's reach: motion over less in a whole run counts as none
FARTHEST = 1.0  # rad: what a joint is turned by in a step of the way to its initial position
COUNTED = 2.5  # rad: the same of joints that are moved along, as a thread: half a turn is 3.14
SETBACKS = 25  # steps of the way to an initial position that may fail, one after the other or not


@dataclass(frozen=True)
class Start:
    """A consistent start of a run."""

    y: Array
    mem: Array
    branch: Array  # (n_s) the turn every angle is on
    moved: float  # m or rad: largest constraint residual the projection removed
    residual: float  # N: static force left by the equilibrium, 0 where none was asked for
    length: float  # m, first unit of the error norm
    speed: float  # m/s, the most its unit for velocities may be
    moving: float  # m/s, the first
    depth: Array  # (n_contacts) penetration expected at the forces of the start, m


def start(
    scenario: Any, mechanism: Any, located: bool, judge: Callable[..., None] | None = None
) -> Start:
    """The start of a run; raises ModelError where there is none.

    judge: of an equilibrium, see start/statics.py.
    """
    initial = scenario.initial
    check_names(scenario, initial)
    mechanism = with_scene(mechanism)
    y, residual, angles, ahead = positions(scenario, mechanism, initial, judge)
    mechanism = replace(mechanism, ahead=ahead)
    model = mechanism.model
    for name, x in mechanism.coordinates.items():
        model.branch[x.entry] = angles.get(name, x.drawn)
    y = on_turns_of_drives(mechanism, y)
    refuse_no_number(mechanism, follow(mechanism, y), np.zeros((len(model.con), model.n_mem)))
    phi = jacobian(model, 0.0, follow(mechanism, y))[0]
    moved = float(np.max(np.abs(phi), initial=0.0))
    y, left = closest(model, 0.0, follow(mechanism, y))
    if left > 1e-9 * model.size:
        raise not_closed(scenario, mechanism, np.abs(jacobian(model, 0.0, y)[0]))
    check_values(mechanism, initial, y)
    check_closed(mechanism, y, scenario.solver.tolerance)
    check_determined(mechanism, model, workspace(model), y)
    y = velocities(scenario, mechanism, y, tuple(initial.equilibrium))
    mem = phases(model, y, located)
    check_finite(mechanism, y, mem)
    check_limits(mechanism, y)
    length, moving, speed, depth = units(model, y, mem, scenario)
    remember(mechanism.model, y)
    return Start(y, mem, mechanism.model.branch, moved, residual, length, speed, moving, depth)


def not_closed(scenario: Any, mechanism: Mechanism, phi: Array) -> ModelError:
    """What stays open: the joint that is out of reach, and the drive that asks for it."""
    largest = float(phi.max())
    rows = [mechanism.rows[k] for k in np.argsort(-phi) if phi[k] > 0.1 * largest]
    joints = [row.split(".")[0] for row in rows if row.split(".")[0] in scenario.joints]
    what = f"{', '.join(rows)} {'stays' if len(rows) == 1 else 'stay'} open"
    return ModelError(
        f"the joints cannot be closed: {what} by up to {largest:.3g} m or rad",
        "check the points of the joints and the drives' positions at t = 0",
        ("joints", joints[0]) if joints else (),
    )


def check_names(scenario: Any, initial: Any) -> None:
    """Joints given a value under `initial` have a coordinate to set."""
    for name in initial.values:
        if not of_joint(split(name, scenario.joints)[0], scenario.joints):
            raise ModelError(
                f"joint '{name}' has no coordinate to set",
                "name a revolute or a prismatic joint",
                ("initial", name),
            )


def check_values(mechanism: Mechanism, initial: Any, y: Array) -> None:
    """No drive moved a joint away from where `initial` put it."""
    w = posed(mechanism.model, y)
    for name, value in initial.values.items():
        if name not in mechanism.coordinates:
            continue
        x = mechanism.coordinates[name]
        off = float(w.S[x.entry, 0]) - value
        if x.kind == "angle":
            off = (off + np.pi) % (2.0 * np.pi) - np.pi
        if abs(off) > 1e-6 * (mechanism.model.size if x.kind == "stroke" else 1.0):
            raise ModelError(
                f"a drive puts the joint {abs(off):.3g} {'rad' if x.kind == 'angle' else 'm'} "
                "away from this value",
                "drop the value, or prescribe the velocity of the drive",
                ("initial", name),
            )


def check_finite(mechanism: Mechanism, y: Array, mem: Array) -> None:
    """Every force at the start is a number; the element that gives none is named."""
    model = mechanism.model
    w = workspace(model)
    w.mem[:] = mem
    yd = np.zeros_like(y)
    derivative(w, 0.0, y, yd)
    if np.all(np.isfinite(yd)):
        return
    whose, text = undecided(mechanism, w)
    if whose is not None:
        raise ModelError(
            f"at t = 0 {text}",
            "is the coefficient meant, and the direction of the motion? what gives way between the "
            "bodies, a spring or a clearance, makes an answer",
            (whose.section, whose.name),
        )
    refuse_no_number(mechanism, y, mem)
    if w.status[3]:
        raise ModelError(
            "masses and inertias are so unequal that the arithmetic cannot tell the constraints of "
            "the joints apart",
            "give every body the mass and inertia it has, or join light bodies to heavy ones",
        )
    raise ModelError("an acceleration is not a finite number at t = 0", "check masses and inertias")


def check_limits(mechanism: Mechanism, y: Array) -> None:
    """No element starts beyond what it can do: such a run would have ended before it began."""
    for event in exceeded(mechanism, 0.0, y):
        raise ModelError(
            f"{event.said} before the run begins ({event.value:g} {event.unit})",
            "is the limit meant, and does the start balance? see `initial: {equilibrium: ...}`",
            (mechanism.instances[LIMITS - event.entry].section, event.when),
        )


def exceeded(mechanism: Mechanism, t: float, y: Array) -> list[UserEvent]:
    """The limits of elements that a state is beyond."""
    found = limits(mechanism.instances)
    if not found:
        return []
    w = posed(mechanism.model, y)
    gaps(w, t)
    return [event for event in found if w.gap[LIMITS - event.entry, 0] >= 0.0]


def positions(
    scenario: Any, mechanism: Mechanism, initial: Any, judge: Callable[..., None] | None = None
) -> tuple[Array, float, dict[str, float], dict[int, float]]:
    """q as drawn, at the given joint values, in equilibrium; the static force left, N; angles; how
    far states are ahead of the coordinates they follow."""
    if not initial.settles and not initial.values:
        return mechanism.y0, 0.0, {}, {}
    playing = {n for n, s in scenario.joints.items() if elements.load(s.type).ideal}
    ideal = frozenset(playing - set(initial.equilibrium))
    held = with_scene(held_still(scenario, initial, ideal, mechanism.planar))
    y = follow(held, carried(mechanism, held))
    residual = 0.0
    targets = {held.coordinates[name].entry: value for name, value in initial.values.items()}
    settle, rigid = initial.settles, not mechanism.beams
    there = None
    if settle and targets and playing:
        there = by_ideal_joints(scenario, initial, frozenset(playing), held, rigid)
    if settle:
        y, residual = equilibrium(held, y if there is None else there, rigid, judge)
    if targets and there is None:
        y, residual = approach(held, y, targets, settle, rigid)
    remember(held.model, y)
    if mechanism.beams:
        stiff, held = (
            held,
            with_scene(held_still(scenario, initial, ideal, mechanism.planar, False)),
        )
        y, residual = bent(stiff, held, y, settle)
        remember(held.model, y)
    angles = {name: float(held.model.S[x.entry, 0]) for name, x in held.coordinates.items()}
    ahead = strained(mechanism, held, y) if settle else {}
    out = mechanism.y0.copy()
    out[: mechanism.model.n_q] = y[: mechanism.model.n_q]
    return follow(mechanism, out), residual, angles, ahead


def bent(stiff: Any, held: Any, y: Array, settle: bool) -> tuple[Array, float]:
    """The start found with stiff bars as that of flexible ones; their equilibrium where asked."""
    for name, x in held.coordinates.items():
        held.model.branch[x.entry] = stiff.model.S[stiff.coordinates[name].entry, 0]
    straight = follow(held, as_flexible(held, stiff, y))
    return softened(held, straight) if settle else (straight, 0.0)


def by_ideal_joints(
    scenario: Any, initial: Any, playing: frozenset[str], held: Any, rigid: bool
) -> Array | None:
    """y of `held` where all joints are ideal and `initial` is reached; None where it is not.

    A journal would leave its bearing with every step of the way, and be pressed back through it.
    """
    try:
        bare = with_scene(held_still(scenario, initial, playing, held.planar))
        y, _ = equilibrium(bare, follow(bare, carried(bare, bare)), rigid)
        targets = {bare.coordinates[name].entry: value for name, value in initial.values.items()}
        y, _ = approach(bare, y, targets, True, rigid)
    except ModelError:
        return None
    remember(bare.model, y)
    for name in held.coordinates.keys() & bare.coordinates.keys():
        angle = bare.model.S[bare.coordinates[name].entry, 0]
        held.model.branch[held.coordinates[name].entry] = angle
    there = carried(bare, held)
    there[: held.model.n_q] = y[: held.model.n_q]
    return follow(held, there)


def held_still(
    scenario: Any, initial: Any, ideal: frozenset[str], planar: bool, stiff: bool = True
) -> Mechanism:
    """The mechanism with its drives at rest, and rigid holds for the values of `initial`.

    Where a value leaves a drive with a velocity no place to hold, that drive is left out: its
    motion begins where the values put its joint.
    """
    free: set[str] = set()
    told = ""
    found = tried(scenario, initial, ideal, planar, free)
    while isinstance(found, str):
        told = told or found
        for name in giving_way(scenario, free):
            without = tried(scenario, initial, ideal, planar, {*free, name})
            if without != found:
                free.add(name)
                found = without
                break
        else:
            raise held_already(found)
    for name, other in product(sorted(free), giving_way(scenario, free)):
        if not isinstance(tried(scenario, initial, ideal, planar, {*free - {name}, other}), str):
            both = " and ".join(f"'{n}'" for n in scenario.drives if n in (name, other))
            raise ModelError(
                f"{both} could begin elsewhere for it, and nothing tells which of them does",
                "give a value of the joint of one of them, too",
                held_already(told).path,
            )
    if stiff:
        return found
    drives = holding_drives(scenario, initial, free)
    return assemble(scenario, ideal, drives, planar=planar)


def giving_way(scenario: Any, free: set[str]) -> list[str]:
    """The drives with a velocity, whose place may follow, but those that are left out already."""
    drives = scenario.drives.items()
    return [n for n, d in drives if n not in free and getattr(d, "velocity", None) is not None]


def held_already(conflict: str) -> ModelError:
    """What `tried` found, in words."""
    if not conflict.startswith(HOLD):
        return ModelError(
            "a value of `initial` fixes what this drive moves",
            "drop the value, or prescribe the velocity of the drive",
            ("drives", conflict),
        )
    return ModelError(
        "a drive, or another value of `initial`, fixes this joint already",
        "give one value for each degree of freedom",
        ("initial", conflict.removeprefix(HOLD)),
    )


def tried(
    scenario: Any, initial: Any, ideal: frozenset[str], planar: bool, free: set[str]
) -> Mechanism | str:
    """The mechanism without some drives; or the first hold or drive that moves what others fix
    already."""
    drives = holding_drives(scenario, initial, free)
    try:
        return assemble(scenario, ideal, drives, stiff=True, planar=planar)
    except ModelError as error:
        if error.path[:1] != ("drives",):
            raise
        return str(error.path[-1])


def holding_drives(scenario: Any, initial: Any, free: set[str]) -> dict[str, Any]:
    """The scenario's drives at rest, but those left out; those of the joints of `initial` replaced
    by rigid holds."""
    joints = scenario.joints
    moved = free | {
        n for n, d in scenario.drives.items()
        if called(getattr(d, "joint", ""), joints) in initial.values
    }  # fmt: skip
    drives = {n: d.at_rest() for n, d in scenario.drives.items() if n not in moved}
    return drives | {f"{HOLD}{name}": hold(name) for name in initial.values}


def approach(
    held: Any, y: Array, targets: dict[int, float], settle: bool, rigid: bool
) -> tuple[Array, float]:
    """Move joint coordinates to their targets by quasi-static steps that keep the branch."""
    model = held.model
    place = {s: model.n_q + model.n_v + N_BOOK + k for k, s in enumerate(held.follows) if s >= 0}
    begin = {s: y[place[s]] for s in targets}
    angles = {x.entry for x in held.coordinates.values() if x.kind == "angle"}
    turn = max((abs(targets[s] - begin[s]) for s in angles & targets.keys()), default=0.0)
    most = min(1.0 / 16.0, FARTHEST / max(turn, 1e-300))
    done, step, residual, failed = 0.0, min(1.0 / 64.0, most), 0.0, 0
    while done < 1.0:
        ahead = min(1.0, done + step)
        trial = y.copy()
        for s, target in targets.items():
            trial[place[s]] = begin[s] + ahead * (target - begin[s])
        try:
            trial, left = closest(model, 0.0, trial)
            if left > 1e-9 * model.size:
                raise ModelError("the joints cannot be closed")
            if settle:
                trial, residual = equilibrium(held, trial, rigid)
        except ModelError as error:
            step *= 0.5
            failed += 1
            if step < 1e-4 * most or failed > SETBACKS:
                raise ModelError(
                    f"the mechanism cannot be moved to its initial position: {error.what} after "
                    f"{100 * done:.1f} % of the way",
                    "is the position within reach?",
                    ("initial",),
                ) from None
            continue
        before = model.branch[model.wound]
        remember(model, trial)
        turned = float(np.max(np.abs(model.branch[model.wound] - before), initial=0.0))
        longest = (ahead - done) * COUNTED / max(turned, 1e-300)
        y, done, step = trial, ahead, min(2.0 * step, most, longest)
    return y, residual


def carried(mechanism: Mechanism, other: Mechanism) -> Array:
    """y of one assembly as y of another with the same bodies, or with stiff bars."""
    if mechanism.beams and not other.beams:
        return as_rigid(mechanism, other, mechanism.y0)
    return on_turns_of_drives(other, as_of(other, mechanism.y0))


def phases(model: Model, y: Array, located: bool) -> Array:
    """Contact phases of the start; a closed contact takes the slowest impact as its speed."""
    mem = np.zeros((len(model.con), model.n_mem))
    mem[:, BRANCH] = WHOLE  # until the march has looked
    w = posed(model, y)
    gaps(w, 0.0)
    for c, e in enumerate(model.contact):
        closed = w.gap[e, 0] > 0.0
        mem[e, PHASE] = (CONTACT if closed else FLIGHT) if located else UNLOCATED
        slowest = ContactNumbers(model, c).slowest_impact
        mem[e, IMPACT_SPEED] = max(slowest, 0.0) if closed else 0.0
    return mem


def units(model: Model, y: Array, mem: Array, scenario: Any) -> tuple[float, float, float, Array]:
    """First units of the error norm, and the penetration each contact may expect.

    With contacts: what the largest force at the start (or an impact at the slowest speed) would
    press in.  Without: the reach of a body (not of the mechanism: a chain of many links would be
    held to less); the largest speed, or a part of that length per run; and the most it may be: the
    largest of its speeds, of the speed its accelerations give over that length, and of that length
    per run.
    """
    w, reach = workspace(model), model.reach
    yd = np.zeros_like(y)
    w.mem[:] = mem
    derivative(w, 0.0, y, yd)
    force = float(np.max(np.abs(w.F[:, :3]), initial=0.0))
    force = max(force, largest_reaction(w))
    end = max(scenario.solver.end, 1e-300)
    fastest, hardest = (fastest_of(model, x) for x in (y, yd))
    moving = max(fastest, CREEP * reach / end)
    speed = max(fastest, np.sqrt(hardest * reach), reach / end)
    depth = []
    for K, n, mass, c, slowest, arm, *_ in model.contact_par:
        approach = min(max(slowest, 1e-3), speed) / arm
        touch = ((n + 1.0) * mass * approach**2 / (2.0 * K)) ** (1.0 / (n + 1.0))
        depth.append(min(max((force * arm / K) ** (1.0 / n), touch), c))
    return reach, min(moving, speed), speed, np.array(depth)


def fastest_of(model: Model, y: Array) -> float:
    """The largest of the rates in y, or in y', of turns at the arm of what turns: that of another
    body is no measure of it."""
    rates = slice(model.n_q, model.n_q + model.n_v)
    return float(np.max(model.scale[rates] * np.abs(y[rates]), initial=0.0))
