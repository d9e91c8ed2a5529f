"""User events packed: what each watches, and the switches it turns.

Whatever events may change has a switch, one whole number in the record of a run:

    drives   0 the motion of the file, k the k-th motion an event sets, -1 let go
    joints   0 held together, -1 apart
    locks    0 free, 1 held
    parks    0 free, 1 held: of bodies
    forces   0 as at the start, 1 acts, -1 does not
    phase    k, the k-th phase is in force: its events count, those of other phases do not

Locks are drives of velocity 0 that stand among the instances from the beginning, with their rows
left out while they are open; so do the rows of bodies that are ever parked (elements/parked.py).
"""

from collections.abc import Iterable, Mapping
from dataclasses import dataclass, field
from typing import Any

from trsim import elements
from trsim.assemble.addresses import UNITS, Addresses
from trsim.assemble.hanging import hanging
from trsim.assemble.instances import Instance
from trsim.assemble.outputs import energy_columns
from trsim.elements.coordinates import called, named, of_joint
from trsim.elements.prescribed import AnyDrive
from trsim.elements.rows import ARC
from trsim.elements.scene import COMPONENTS
from trsim.errors import ScenarioError, known
from trsim.scenario.event import DIRECTIONS, Event
from trsim.scenario.methods import METHODS
from trsim.scenario.phases import OfPhase, forces_in, is_static, path_of
from trsim.statuses import Ended
from trsim.units import fits

BAND = 1e-9  # of the mechanism's size, and rad: how far a value must be left to count again
ALWAYS = 2**62
OF_RUN = ("energy.residual", "energy.work.projection")
LOOSE, AS_DRAWN, HELD = -1, 0, 1
PHASE = ("phase", "")  # the switch of the phases
FAR = 1e300  # s: when a clock that does not run comes to its end
# column of a model's `watch`: how often an event happens (tables.py, solve/march/watch.py)
MOST = 2
# what is watched that is no entry of S: t, and the gap of row e as LIMITS - e
TIME, LIMITS = -1, -2
CHANNEL = "channel"  # kind of what is watched: anything that is recorded, see solve/march/heard.py
SECTION = "events"  # of the instances of locks


@dataclass(frozen=True)
class UserEvent:
    """An event of the scenario, as the solver needs it."""

    name: str
    entry: int  # of S; TIME; LIMITS - e for what row e limits
    value: float
    kind: str  # angle, stroke, time, limit or channel
    direction: int
    most: int
    turned: tuple[tuple[int, int], ...]  # switch, what it is put to
    record: bool
    end: bool
    said: str
    when: str  # what is watched
    status: Ended = "done"  # of the run where it ends here
    unit: str = ""  # of the value, where the kind does not tell
    coordinate: str = ""  # of a joint, if one is watched
    phase: int = -1  # in which it counts; -1: in all
    role: str = ""  # of a phase: begin, until, for, stall, taut
    leads: int = -1  # the phase that begins with it
    lasts: float = 0.0  # s, of a clock that phases start
    energy: float = 0.0  # J, of what counts as moving

    @property
    def rate(self) -> str:
        """The unit of the rate of what is watched."""
        return f"{self.shown}/s" if self.shown != "s" else "-"

    @property
    def shown(self) -> str:
        """The unit of what is watched."""
        return UNITS.get(self.kind, self.unit)

    def sampled(self) -> str:
        """That it is not certain to be found, and how it is looked for; of others nothing."""
        if self.kind != CHANNEL:
            return ""
        where = "phases" if self.role else "events"
        return (
            f"{where}.{self.name}: '{self.when}' is sampled, not bounded: every step is looked at "
            "in 8 parts, and 8 more for each 0.5 rad that a body turns or 2 rad of a sine or a "
            "pulse in a load; what passes the value and comes back between two of them may be "
            "passed over"
        )

    def in_words(self) -> str:
        """When it happens and what it does, in words."""
        if self.kind == "limit":
            return f"{self.when} {self.said} ({self.value:g} {self.unit}): the run is {self.status}"
        if self.role == "begin":
            return f"at the start: {self.said}"
        if self.lasts:
            since = "the phase began" if self.role == "for" else "nothing moved"
            return f"{self.lasts:g} s after {since}: {self.said}"
        often = "" if self.most == ALWAYS else f", {self.most} times" if self.most > 1 else ", once"
        return f"{self.falls()}{often}: {self.said}"

    def falls(self) -> str:
        """What is watched, and which way it passes which value."""
        way = {1: "rises through", -1: "falls through", 0: "passes"}[self.direction]
        return f"{self.when} {way} {self.value:g} {self.shown}"


@dataclass(frozen=True)
class Switches:
    """All there is to switch, and the events that do."""

    names: tuple[tuple[str, str], ...] = ()  # (what is switched; name)
    # drive -> (state of z or -1, function in tab) of each motion that is set
    motions: Mapping[str, tuple[tuple[int, int], ...]] = field(default_factory=dict)
    events: tuple[UserEvent, ...] = ()
    jumps: int = -1  # entry of z with the work of the events
    phases: tuple[str, ...] = ()  # their names
    static: tuple[bool, ...] = ()  # which of them are static paths
    silent: Mapping[str, tuple[int, ...]] = field(default_factory=dict)  # columns of forces

    @property
    def phase(self) -> int:
        """The switch of the phases; -1 where there are none."""
        return self.names.index(PHASE) if self.phases else -1


def park_name(body: str) -> str:
    """The name of the instance that parks a body; no name a user can write."""
    return f"{body}.park"


def lock_name(coordinate: str) -> str:
    """The name of the instance that holds a joint; no name a user can write."""
    return f"{coordinate}.lock"


def locks(scenario: Any) -> dict[str, Any]:
    """A drive for every coordinate of a joint that some event locks."""
    found = {}
    for name, event in scenario.events.items():
        for k, joint in enumerate(event.do.lock):
            path = path_of(scenario, event, (SECTION, name, "do", "lock", k))
            own, *_ = named(joint, scenario.joints, path=path)
            found[lock_name(own)] = hold(own)
    return found


def parks(scenario: Any) -> dict[str, Any]:
    """What parks each rigid body, where some event parks one: others may hang on that."""
    named = any(event.do.park for event in scenario.events.values())
    spec: Any = elements.load(elements.PARKED).spec
    rigid = [name for name, body in scenario.bodies.items() if body.flexible is None]
    return {park_name(body): spec(body=body) for body in rigid} if named else {}


def hold(joint: str) -> Any:
    """The spec of a drive that keeps a joint where it is."""
    spec: Any = elements.load(elements.DEFAULT["drives"]).spec
    return spec.model_validate({"joint": joint, "velocity": 0.0}, context={"parameters": {}})


def check(name: str, there: Any, kind: str, path: tuple) -> None:
    """Raises ScenarioError for a name that does not exist."""
    if name not in there:
        raise ScenarioError(f"no {kind} named '{name}'", known(name, there), path)


def switches(scenario: Any, at: Addresses, instances: list[Instance]) -> Switches:
    """The events of a scenario.  Raises ScenarioError for names and units that do not fit."""
    method, limited = scenario.solver.method, limits(instances)
    follows = METHODS[method].marches or METHODS[method].rests
    if not follows:  # it looks itself at what makes a run fail
        limited = tuple(event for event in limited if event.status != "failed")
    if not scenario.events and not limited:
        return Switches()
    if not follows:
        what = f"{method} knows no events: it keeps a state of its own"
        hint = f"take one of {', '.join(name for name in METHODS if METHODS[name].marches)}"
        raise ScenarioError(what, hint, ("solver", "method"))
    of = _Packing(scenario, at, instances)
    events = tuple(of.event(name, spec) for name, spec in scenario.events.items())
    motions = {name: tuple(found) for name, found in of.motions.items()}
    jumps = at.state(0.0) if events else -1
    phases = tuple(phase.name or f"phase_{k + 1}" for k, phase in enumerate(scenario.phases))
    static = tuple(is_static(scenario, k) for k in range(len(phases)))
    return Switches(tuple(of.names), motions, (*events, *limited), jumps, phases, static)


def limits(instances: Iterable[Instance]) -> tuple[UserEvent, ...]:
    """The limits of elements, as events that end the run."""
    return tuple(
        UserEvent(
            f"{instance.name}.{limit.name}", LIMITS - e, limit.value, "limit", DIRECTIONS["up"],
            1, (), True, True, limit.said, instance.name, limit.status, limit.unit,
        )
        for e, instance in enumerate(instances)
        for limit in instance.row.limits
    )  # fmt: skip


def spec_lasts(spec: Event) -> bool:
    """Whether it is a clock that phases start."""
    return bool(getattr(spec, "lasts", 0.0))


class _Packing:
    """Switches while they are being collected."""

    def __init__(self, scenario: Any, at: Addresses, instances: list[Instance]) -> None:
        self.scenario, self.at = scenario, at
        self.instances = {(i.section, i.name): i for i in instances}
        self.names: dict[tuple[str, str], int] = {}
        self.motions: dict[str, list[tuple[int, int]]] = {}
        self.states: dict[str, int] = {}  # of drives that had none
        self.begun: dict[int, tuple[tuple[tuple[int, int], ...], str]] = {}  # of phases

    def event(self, name: str, spec: Event) -> UserEvent:
        """One event.  Raises ScenarioError with its place in the file."""
        try:
            return self.packed(name, spec)
        except ScenarioError as error:
            error.path = path_of(self.scenario, spec, error.path)
            raise

    def packed(self, name: str, spec: Event) -> UserEvent:
        entry, kind, unit = self.watched(name, spec)
        of: dict[str, Any] = {}
        if isinstance(spec, OfPhase):
            keys = ("phase", "role", "leads", "lasts", "energy")
            of = {key: getattr(spec, key) for key in keys}
        if of.get("role") == "begin":
            self.switch(*PHASE, 0)
            self.check_first()
        turned, said = self.actions(name, spec)
        most = 0 if of.get("role") == "begin" else spec.times or ALWAYS
        return UserEvent(
            name, entry, FAR if spec_lasts(spec) else spec.value, kind, DIRECTIONS[spec.crosses],
            most, turned, spec.do.record, bool(spec.do.end), said, spec.when,
            status=spec.do.status, unit=unit, coordinate=self.coordinate(spec.when), **of,
        )  # fmt: skip

    def actions(self, name: str, spec: Event) -> tuple[tuple[tuple[int, int], ...], str]:
        """The switches that an event turns, and what it does in words."""
        leads = getattr(spec, "leads", -1)
        if leads in self.begun:
            return self.begun[leads]
        turned = [self.motion(name, drive, motion) for drive, motion in spec.do.set.items()]
        turned += [x for k, one in enumerate(spec.do.release) for x in self.released(name, k, one)]
        turned += [
            self.switch("locks", called(x, self.scenario.joints), HELD) for x in spec.do.lock
        ]
        turned += [self.unlocked(name, k, one) for k, one in enumerate(spec.do.unlock)]
        parked = self.parked(name, spec)
        turned += [self.switch("parks", body, HELD) for body in parked]
        turned += [self.unparked(name, k, one) for k, one in enumerate(spec.do.unpark)]
        for key, to in (("apply", HELD), ("remove", LOOSE)):
            for k, one in enumerate(getattr(spec.do, key)):
                path = (SECTION, name, "do", key, k)
                turned += [self.force(force, to, path)
                           for force in forces_in(self.scenario, one, path)]  # fmt: skip
        said = spec.do.model_copy(update={"park": parked}).said()
        if leads >= 0:
            phases = self.scenario.phases
            own = [phase.name or f"phase_{k + 1}" for k, phase in enumerate(phases)]
            turned += [self.switch(*PHASE, leads)] if leads < len(own) else []
            begins = ""
            if leads < len(own):
                static = "static " if is_static(self.scenario, leads) else ""
                begins = f"{static}phase {own[leads]} begins"
            said = ": ".join(filter(None, (begins, said)))
            self.begun[leads] = (tuple(turned), said)
        return tuple(turned), said

    def check_first(self) -> None:
        """Refuse units that do not fit what drives of the first phase move."""
        for drive, motion in self.scenario.phases[0].drive.items():
            self.motion_of(("phases", 0, "drive", drive), drive, motion)

    def parked(self, name: str, spec: Event) -> tuple[str, ...]:
        """The bodies that an event parks, with those that hang on them."""
        frames = {}
        for body, f in self.at.frames.items():
            one = self.scenario.bodies.get(body)
            if f and one is not None and one.flexible is None:
                frames[body] = f
        for k, body in enumerate(spec.do.park):
            path = (SECTION, name, "do", "park", k)
            check(body, self.scenario.bodies, "body", path)
            if body not in frames:
                what = f"'{body}' bends, and only rigid bodies are parked"
                raise ScenarioError(what, "lock the joints that hold it", path)
        if not spec.do.park:
            return ()
        apart = {*spec.do.release}
        for before in self.scenario.phases[: max(getattr(spec, "leads", -1), 0)]:
            apart |= {*before.release}
        return hanging(spec.do.park, self.instances.values(), frames, apart)

    def unparked(self, name: str, k: int, body: str) -> tuple[int, int]:
        if (SECTION, park_name(body)) not in self.instances:
            path = (SECTION, name, "do", "unpark", k)
            raise ScenarioError(f"no event parks a body '{body}'", "", path)
        return self.switch("parks", body, AS_DRAWN)

    def force(self, name: str, to: int, path: tuple) -> tuple[int, int]:
        """Switch a force; refused where something of it lasts that a force alone has not."""
        row = self.instances["forces", name].row
        kernels = self.instances["forces", name].element.kernels
        if row.contact is not None or row.limits or row.rubs or "gaps" in kernels:
            what = f"'{name}' is a contact, a limit or a friction, which is not switched"
            hint = "release the joint it acts at, or keep it out of the way"
            raise ScenarioError(what, hint, path)
        return self.switch("forces", name, to)

    def watched(self, name: str, spec: Event) -> tuple[int, str, str]:
        """Entry of S, what kind of quantity it is, and its unit where that does not tell."""
        kind, unit = "time", ""
        if spec.when in self.scenario.sensors and self.is_bounded(spec.when):
            kind = self.at.sensor_kind(spec.when)
        elif spec.when != "t":
            kind, unit = CHANNEL, self.unit_of(spec.when, (SECTION, name, "when"))
        if kind != CHANNEL or unit:
            self.check_value(name, spec, UNITS.get(kind, unit))
        entry = TIME if kind in ("time", CHANNEL) else self.at.sensor(spec.when)
        return entry, kind, unit

    def is_bounded(self, sensor: str) -> bool:
        """Whether it is known how far a sensor may go inside a step."""
        return self.at.is_early(sensor) and bool(self.instances["sensors", sensor].row.travel)

    def unit_of(self, channel: str, path: tuple) -> str:
        """The unit of a channel.  Raises ScenarioError for what is none, or no single number.

        Nobody looks at the channels of a start, where bars are stiff and joints may be ideal.
        """
        if self.at.of_start:
            return ""
        there = {
            f"{i.name}.{c.name}" if c.name else i.name: (c.unit, c.size)
            for i in self.instances.values()
            for c in (*i.channels, *i.element.reactions)
        }
        there |= {f"energy.{name}": ("J", 1) for name in energy_columns(0)}
        stem = channel[:-2] if channel not in there and channel[-2:] in COMPONENTS else channel
        if stem not in there or (stem != channel and there[stem][1] != 3):
            what = f"no sensor named '{channel}', and no channel"
            raise ScenarioError(what, known(channel, [*self.scenario.sensors, "t", *there]), path)
        unit, size = there[stem]
        if stem == channel and size > 1:
            what = f"'{channel}' has {size} components"
            raise ScenarioError(what, f"Did you mean '{channel}.x'?", path)
        if channel in OF_RUN:
            what = f"'{channel}' is what a run is judged by, no quantity of the mechanism"
            raise ScenarioError(what, "watch another energy", path)
        return unit

    def coordinate(self, when: str) -> str:
        """The coordinate of a joint that a sensor is; empty for t, and for a displacement."""
        sensor = self.scenario.sensors.get(when)
        return called(getattr(sensor, "joint", ""), self.scenario.joints)

    def check_value(self, name: str, spec: Event, wanted: str) -> None:
        """Refuse a written unit that does not fit what is watched."""
        written = self.scenario.quantity(*path_of(self.scenario, spec, (SECTION, name, "value")))
        if written is not None and not fits(written[1], wanted):
            what = f"wrong unit: '{written[1]}'; '{spec.when}' is in {wanted}"
            raise ScenarioError(what, "", (SECTION, name, "value"))

    def switch(self, section: str, name: str, to: int) -> tuple[int, int]:
        return self.names.setdefault((section, name), len(self.names)), to

    def motion(self, name: str, drive: str, motion: Any) -> tuple[int, int]:
        """Store a motion of a drive."""
        path = (SECTION, name, "do", "set", drive)
        kind, entry, word, wanted = self.motion_of(path, drive, motion)
        by_velocity = word == "velocity"
        try:
            offset = self.at.function(getattr(motion, word), word, time_only=True, wanted=wanted)
        except ScenarioError as error:
            raise error.at(*path) from None
        state = self.state(drive, kind, entry) if by_velocity else -1
        found = self.motions.setdefault(drive, [])
        found.append((state, offset))
        return self.switch("drives", drive, len(found))

    def motion_of(self, path: tuple, drive: str, motion: Any) -> tuple[str, int, str, str]:
        """Kind and entry of what a drive moves, whether by position or velocity, and the unit.

        Raises ScenarioError where the motion does not fit the drive.
        """
        check(drive, self.scenario.drives, "drive", path)
        by_velocity = motion.position is None
        spec = self.scenario.drives[drive]
        if self.instances["drives", drive].row.length:  # of its own line, without a joint
            if by_velocity != (spec.position is None):
                raise ScenarioError(
                    "an actuator goes on with what it began with",
                    "set a velocity where it has a velocity, a position where it has a position",
                    path,
                )
            kind, entry = "stroke", AnyDrive.of(self.instances["drives", drive].row).coordinate
        else:
            x = self.at.coordinate(spec.joint)
            kind, entry = x.kind, x.entry
        word = "velocity" if by_velocity else "position"
        units = ("rad/s", "m/s") if by_velocity else ("rad", "m")
        written = self.path_of_motion(path, word)
        try:
            self.at.check_unit(kind, *units, *written)
        except ScenarioError as error:
            raise error.at(*written[:2]) from None
        return kind, entry, word, units[0 if kind == "angle" else 1]

    def path_of_motion(self, path: tuple, word: str) -> tuple:
        """Where a motion is written: that of a phase stands in `drive`."""
        spec = self.scenario.events.get(path[1])
        return (*(path_of(self.scenario, spec, path) if spec else path), word)

    def state(self, drive: str, kind: str, entry: int) -> int:
        """The entry of z that holds the place of a drive with a velocity."""
        own: int = AnyDrive.of(self.instances["drives", drive].row).state
        if own >= 0:
            return own
        if drive not in self.states:
            self.states[drive] = self.at.state(kind, follows=entry)
        return self.states[drive]

    def released(self, name: str, k: int, one: str) -> list[tuple[int, int]]:
        path = (SECTION, name, "do", "release", k)
        joints, drives = self.scenario.joints, self.scenario.drives
        if one in self.scenario.forces:
            what = f"'{one}' is a force, and joints and drives are released"
            raise ScenarioError(what, f"`remove: [{one}]` makes it act no more", path)
        check(one, [*joints, *drives], "joint or drive", path)
        if one in drives:
            return [self.switch("drives", one, LOOSE)]
        if self.instances["joints", one].element.ideal:
            raise ScenarioError(
                f"joint '{one}' has clearance and cannot come apart",
                "make it ideal with `clearance: 0`, or release a joint next to it",
                path,
            )
        own = self.at.coordinates.get(one)
        if own is not None and own.kind == ARC:
            self.check_no_stop(one, path)
        # what is apart has nothing to lock
        locked = [
            own for own in of_joint(one, joints) if (SECTION, lock_name(own)) in self.instances
        ]
        return [self.switch("joints", one, LOOSE),
                *(self.switch("locks", own, AS_DRAWN) for own in locked)]  # fmt: skip

    def check_no_stop(self, joint: str, path: tuple) -> None:
        """Refuse to take apart a joint on a curve whose stops would go on acting far from it."""
        for name, force in self.scenario.forces.items():
            if getattr(force, "joint", None) == joint:
                raise ScenarioError(
                    f"'{name}' stops '{joint}' along its curve: what has come off a curve is at no "
                    "place along it, and nothing could stop it there",
                    f"leave '{name}' out, or put it at a `point` and a `wall`",
                    path,
                )

    def unlocked(self, name: str, k: int, one: str) -> tuple[int, int]:
        path = (SECTION, name, "do", "unlock", k)
        own, *_ = named(one, self.scenario.joints, path=path)
        if (SECTION, lock_name(own)) not in self.instances:
            raise ScenarioError(f"no event locks the joint '{one}'", "", path)
        return self.switch("locks", own, AS_DRAWN)
