"""Where all bodies of a run are, frame by frame, from its result file alone.

Attitudes are those recorded, or the integral of the recorded angular velocities from the start
(start.py).  How far ideal joints come apart in what was found is measured: that is the error of
the integral, for the centres of mass are recorded.
"""

from collections.abc import Mapping
from dataclasses import dataclass, field, replace

import numpy as np
from numpy.typing import NDArray

from trsim.errors import UsageError
from trsim.report.animation import turns
from trsim.report.animation.drawing import (
    GROUND,
    IDEAL_POINTS,
    Array,
    Drawing,
    Guide,
    Joint,
    Touch,
)
from trsim.report.animation.guides import touch
from trsim.report.animation.reading import drawing
from trsim.report.animation.start import attitudes
from trsim.store.read import Run

FRAMES = 600
BEGAN = 1e-6  # of that size: what is farther from its place as drawn began elsewhere
OPEN = 0.01  # of the size of the mechanism: joints that are seen to be apart
FASTEST = 1.6  # rad between two frames: more looks slower than it is


@dataclass(frozen=True)
class Motion:
    """Poses at the frames; `turns` are those since the bodies were drawn, world axes."""

    drawn: Drawing
    rows: NDArray[np.int64]  # (n) of the result file
    time: Array  # (n) s
    places: Mapping[str, Array]  # rigid body -> centre of mass (n, 3)
    turns: Mapping[str, Array]  # rigid body -> (n, 4)
    nodes: Mapping[str, Array]  # bar -> (n, nodes, 3)
    plays: Mapping[str, Array] = field(default_factory=dict)  # joint -> journal from bearing (n, 3)
    touches: Mapping[str, Touch] = field(default_factory=dict)  # of guides
    recorded: bool = True  # whether all attitudes were
    begun: bool = False  # whether hinges are known to have been turned at the start
    open: float = 0.0  # m: what ideal joints come apart by
    warnings: tuple[str, ...] = ()

    def turn(self, body: str) -> Array:
        """(n, 4), or (1, 4) of the ground and of bars."""
        return self.turns.get(body, turns.STILL[None])

    def point(self, body: str, at: Array) -> Array:
        """Places of a point of a body as drawn, (n, 3), or (1, 3) of the ground."""
        if body == GROUND:
            return np.asarray(at)[None]
        if body in self.nodes:
            away = np.linalg.norm(self.drawn.bars[body] - at, axis=1)
            return self.nodes[body][:, int(away.argmin())]
        return self.places[body] + turns.turned(self.turns[body], at - self.drawn.bodies[body])

    def on(self, body: str, place: Array) -> Array:
        """Where on a rigid body, as drawn, it has places (n, 3): the way back of `point`."""
        if body not in self.places:
            return place
        own = turns.turned(turns.back(self.turns[body]), place - self.places[body])
        return self.drawn.bodies[body] + own


def motion(run: Run, even: bool = False) -> Motion:
    """The frames of a run; even: those of `even_frames`.

    Raises UsageError where nothing can be drawn.
    """
    drawn = drawing(run)
    if run.rows == 0 or not (drawn.bodies or drawn.bars):
        what = "it has no rows" if run.rows == 0 else "it holds the position of no body"
        raise UsageError(f"{run.path}: nothing to animate: {what}", "Record positions of bodies.")
    time = run.time
    rows = even_frames(time) if even else frames(time)
    places = {name: run.channel(f"{name}.position") for name in drawn.bodies}
    nodes = {name: np.stack([run.channel(f"{name}.node{k}.position")[rows]
                             for k in range(len(line))], axis=1)
             for name, line in drawn.bars.items()}  # fmt: skip
    recorded = eccentricities(run, drawn)
    first = {name: place[0] for name, place in places.items()}
    start, left = attitudes(drawn, first, {name: play[0] for name, play in recorded.items()},
                            {name: line[0] for name, line in nodes.items()},
                            angles(run, drawn))  # fmt: skip
    found, unknown = attitudes_over_time(run, drawn, time, start)
    moved = Motion(
        drawn,
        rows,
        time[rows],
        {name: place[rows] for name, place in places.items()},
        {name: q[rows] for name, q in found.items()},
        nodes,
    )
    plays = {joint.name: play(moved, joint, recorded) for joint in drawn.joints
             if joint.picture == "journal"}  # fmt: skip
    touches = {guide.name: touched(moved, guide) for guide in drawn.guides}
    moved = replace(
        moved,
        plays=plays,
        touches=touches,
        recorded=turning(run, drawn),
        begun=any(abs(angle) > BEGAN for angle in angles(run, drawn).values()),
    )
    apart = opened(moved)
    return replace(moved, open=apart, warnings=warnings(moved, left, apart, unknown))


def frames(time: Array) -> NDArray[np.int64]:
    """Rows of the frames: at most FRAMES of them, evenly in time, the first and the last."""
    if len(time) <= FRAMES:
        return np.arange(len(time))
    return nearest(time, np.linspace(time[0], time[-1], FRAMES))


def even_frames(time: Array) -> NDArray[np.int64]:
    """The same where nothing makes up for frames that are now a row apart, now two: every k-th row.

    Rows at events stand between the others, and are no frames.
    """
    steps = np.diff(time)
    if len(time) <= FRAMES or not steps.any():
        return frames(time)
    every, span = float(np.median(steps[steps > 0.0])), float(time[-1] - time[0])
    k = max(1.0, np.ceil(span / every / (FRAMES - 1) - 1e-9))
    wanted = np.arange(time[0], time[-1], k * every)
    return nearest(time, np.append(wanted, time[-1]))


def nearest(time: Array, wanted: Array) -> NDArray[np.int64]:
    """The rows that are nearest to some times, each once."""
    after = np.clip(np.searchsorted(time, wanted), 1, len(time) - 1)
    before = wanted - time[after - 1] < time[after] - wanted
    return np.unique(np.where(before, after - 1, after)).astype(np.int64)


def eccentricities(run: Run, drawn: Drawing) -> dict[str, Array]:
    """Journal from bearing, (rows, 3), in world axes as the bearing was drawn."""
    found = {}
    for joint in drawn.joints:
        names = [f"{joint.name}.eccentricity_{c}" for c in "xy"]
        if joint.picture == "journal" and all(name in run.units for name in names):
            x, y = (run.channel(name)[:, None] for name in names)
            found[joint.name] = x * joint.axes[0] + y * joint.axes[1]
    return found


def attitudes_over_time(
    run: Run, drawn: Drawing, time: Array, start: Mapping[str, Array]
) -> tuple[dict[str, Array], tuple[str, ...]]:
    """Turns of the rigid bodies since they were drawn, (rows, 4); those that nothing tells."""
    found, unknown = {}, []
    for name in drawn.bodies:
        if f"{name}.rotation" in run.units:
            back = drawn.axes[name] * (-1.0, -1.0, -1.0, 1.0)
            recorded = turns.of_matrices(run.channel(f"{name}.rotation").reshape(-1, 3, 3))
            found[name] = turns.product(recorded, np.broadcast_to(back, recorded.shape))
            continue
        if f"{name}.angular_velocity" not in run.units:
            found[name] = np.tile(start[name], (len(time), 1))
            unknown.append(name)
            continue
        omega = run.channel(f"{name}.angular_velocity")
        rate = f"{name}.angular_acceleration"
        alpha = run.channel(rate) if rate in run.units else None
        steps = turns.steps(time, omega, alpha)
        found[name] = turns.composed(np.concatenate([start[name][None], steps]))
    return found, tuple(unknown)


def angles(run: Run, drawn: Drawing) -> dict[str, float]:
    """How far hinges had turned at the start since they were drawn, where that is known, rad.

    Known are values that the scenario gives, and those of drives that are recorded.
    """
    scenario, found = drawn.scenario, {}
    given = dict(scenario.initial.values)
    for name, drive in scenario.drives.items():
        channel, rigid = f"{name}.position", getattr(drive, "compliance", None) is None
        if run.units.get(channel) == "rad" and rigid and getattr(drive, "joint", None):
            given[drive.joint] = float(run.channel(channel)[0])
    for joint in drawn.joints:
        value = given.get(joint.name, given.get(f"{joint.name}.angle"))
        if joint.picture == "pin" and value is not None:
            found[joint.name] = value - as_drawn(drawn, joint)
    return found


def as_drawn(drawn: Drawing, joint: Joint) -> float:
    """The angle of a hinge as drawn: that of bodies whose axes are turned about its own."""
    bodies, spec = drawn.scenario.bodies, drawn.scenario.joints[joint.name]
    frame, axis = spec.drawn_in, joint.axis
    along = (frame.inside(tuple(axis)) if frame else axis)[2]
    if abs(along) <= 0.999:
        return 0.0
    own = [0.0, 0.0]
    for k, name in enumerate((joint.i, joint.j)):
        if name in drawn.bodies:
            spec = bodies[name]
            about = spec.drawn_in.about_z if spec.drawn_in is not None and frame is None else 0.0
            own[k] = spec.angle + about
    return float((own[1] - own[0]) * along)


def turning(run: Run, drawn: Drawing) -> bool:
    """Whether all attitudes were recorded."""
    return all(f"{name}.rotation" in run.units for name in drawn.bodies)


def elsewhere(moved: Motion) -> bool:
    """Whether a run did not begin as drawn, and how bodies were turned then is not recorded."""
    initial, drawn = moved.drawn.scenario.initial, moved.drawn
    went = max((float(np.linalg.norm(moved.places[name][0] - at))
                for name, at in drawn.bodies.items()), default=0.0)  # fmt: skip
    return not moved.recorded and (bool(initial.values) or initial.settles or moved.begun
                                   or went > BEGAN * drawn.size)  # fmt: skip


def play(moved: Motion, joint: Joint, recorded: Mapping[str, Array]) -> Array:
    """Journal from bearing, (n, 3): as recorded, which is exact, or from the poses."""
    if joint.name in recorded:
        return turns.turned(moved.turn(joint.i), recorded[joint.name][moved.rows])
    return moved.point(joint.j, joint.at) - moved.point(joint.i, joint.at)


def touched(moved: Motion, guide: Guide) -> Touch:
    """Where on its curve a follower is."""
    there = moved.on(guide.i, np.broadcast_to(moved.point(guide.j, guide.at),
                                              (len(moved.time), 3)))  # fmt: skip
    normals = None
    if guide.face is not None:
        turned = turns.turned(moved.turn(guide.j), guide.face)
        own = turns.turned(turns.back(moved.turn(guide.i)), turned)
        normals = np.broadcast_to(own, there.shape) @ guide.axes.T
    return touch(guide, guide.seen(there), normals)


def opened(moved: Motion) -> float:
    """The largest distance between what ideal joints hold together, m."""
    largest = 0.0
    for joint in moved.drawn.joints:
        if joint.comes_apart:
            continue
        d = moved.point(joint.j, joint.at) - moved.point(joint.i, joint.at)
        if joint.picture == "journal":
            d = d - moved.plays[joint.name]
        elif joint.picture not in IDEAL_POINTS:
            axis = turns.turned(moved.turn(joint.i), joint.axis)
            d = d - np.sum(d * axis, axis=-1, keepdims=True) * axis
        largest = max(largest, float(np.linalg.norm(d, axis=1).max()))
    for guide in moved.drawn.guides:
        if not guide.comes_apart:
            largest = max(largest, float(np.abs(moved.touches[guide.name].off).max()))
    return largest


def warnings(moved: Motion, left: float, apart: float, unknown: tuple[str, ...]) -> tuple[str, ...]:
    """What a viewer has to know, in words."""
    told, size = [f"not drawn: {what}" for what in moved.drawn.skipped], moved.drawn.size
    if moved.drawn.lost:
        names = ", ".join(moved.drawn.lost)
        told.append(f"not drawn, for their positions were not recorded: {names}")
    if unknown:
        told.append(f"drawn without turning, for that was not recorded: {', '.join(unknown)}")
    if left > OPEN * size:
        told.append(f"the attitudes at the start were not found: joints are {left:.2g} m apart")
    elif apart > OPEN * size:
        told.append(
            f"attitudes are integrals of recorded velocities, and joints come {apart:.2g} m "
            "apart: record more often, or `*.rotation`"
        )
    if moved.drawn.moving.wheels and elsewhere(moved):
        told.append(
            "teeth and marks of wheels stand as they were drawn at the start, though it began "
            "elsewhere: record `*.rotation`"
        )
    fast = {name: float(2.0 * np.arccos(np.clip(np.abs(np.sum(q[1:] * q[:-1], axis=1)), 0, 1))
                        .max(initial=0.0)) for name, q in moved.turns.items()}  # fmt: skip
    quick = [name for name, angle in fast.items() if angle > FASTEST]
    if quick:
        told.append(f"turning too fast for the frames to show: {', '.join(quick)}")
    return tuple(told)
