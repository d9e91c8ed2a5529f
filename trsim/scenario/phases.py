"""Phases: load steps in order, each with its changes at the start and the condition that ends it.

    phases:
      - {name: lift, drive: {handle: {velocity: 5 deg/s}}, until: {when: latch, value: 60 deg}}
      - {name: swing, release: [rod], park: [arm], until: {when: latch, value: 110 deg}}
      - {name: fall, lock: [latch], release: [handle], until: {when: door, value: 113 deg}}
      - {name: away, release: [hinge], for: 0.5 s}

trsim turns phases into events.  Each condition that ends a phase is an event that counts in this
phase only, and its actions begin the next phase.  In the last phase it ends the run.
"""

from typing import Annotated, Any, ClassVar

from annotated_types import Gt
from pydantic import create_model, model_validator

from trsim.errors import ScenarioError, described, known
from trsim.fields import EMPTY, Flag, Spec, Unit
from trsim.scenario.event import WATCHED, Actions, Crosses, Ending, Event, Motion
from trsim.scenario.methods import METHODS

EXAMPLE = """
bodies:
  rod: {mass: 2 kg, inertia: 0.05 kg*m^2, at: [0.2, 0]}
joints:
  hinge: {type: revolute, bodies: [ground, rod], at: [0, 0]}
drives:
  motor: {joint: hinge, velocity: 0}
sensors:
  angle: {joint: hinge}
phases:
  - {name: lift, drive: {motor: {velocity: 2 rad/s}}, until: {when: angle, value: 30 deg}}
  - {name: swing, release: [motor], until: {when: angle, value: -90 deg, crosses: down}}
  - {name: fall, release: [hinge], for: 0.2 s}
gravity: [0, -9.81, 0]
solver: {end: 5 s}
"""

Seconds = Annotated[float, Gt(0), Unit("s")]


def _lasting(about: str, default: Any) -> Any:
    """A spec with the key `for`, which is no name of Python's."""
    make: Any = create_model
    kind = Seconds if default is ... else Seconds | None
    return make("_Lasting", __base__=Spec, __doc__=about, **{"for": (kind, default)})


class Until(Spec):
    """What ends a phase: a sensor, the time or any channel that crosses a value.

    when     a sensor or t; or any other channel, whose crossings are found by sampling
    value    the value to cross
    crosses  the direction of crossing; if the value is already passed, the phase ends at once
    """

    type: ClassVar[str] = "until"
    when: str
    value: Annotated[float, Unit(*WATCHED)] = 0.0
    crosses: Crosses = "up"


class Stall(_lasting("for  time for which both energies must stay below `energy`", ...)):  # type: ignore[misc]
    """When the mechanism counts as at rest, so that the phase would never end.

    energy  limit of the kinetic energy in 17 samples in a row, and of the energy that the
            accelerations would produce from rest until the next sample
    """

    type: ClassVar[str] = "stall"
    energy: Annotated[float, Gt(0), Unit("J")]


class Phase(_lasting("for  time after which the phase ends", None)):  # type: ignore[misc]
    """A load step: its changes happen when it begins, and last until another phase changes them.

    name     its name; phase_1, phase_2 and so on unless given
    static   a static path: a sequence of equilibria as the drives advance; otherwise the phase is a
             motion over time
    drive    new motions of drives, in which `t` is the time since the phase began
    release  ideal joints that come apart, and drives that release their joint
    lock     joints to hold at their coordinate
    unlock   locked joints to set free
    park     bodies to hold in place, together with bodies connected only to them
    unpark   parked bodies to set free
    apply    forces and load sets that act in this phase, and only in phases that name them
    remove   forces and load sets that stop acting
    record   writes a row of all channels to the table `recorded` when the phase begins
    taut     ropes that must not go slack in this phase; otherwise the run ends with status `slack`
    stall    ends the run with status `stalled` when the mechanism is at rest
    until    what ends the phase; the first of several counts
    end      status of the run if it ends with this phase, the last one
    """

    type: ClassVar[str] = "phase"
    name: str = ""
    static: Flag = False
    drive: dict[str, Motion] = EMPTY
    release: tuple[str, ...] = ()
    lock: tuple[str, ...] = ()
    unlock: tuple[str, ...] = ()
    park: tuple[str, ...] = ()
    unpark: tuple[str, ...] = ()
    apply: tuple[str, ...] = ()
    remove: tuple[str, ...] = ()
    record: Flag = False
    taut: tuple[str, ...] = ()
    stall: Stall | None = None
    until: Until | tuple[Until, ...] = ()
    end: Ending | None = None

    @property
    def ends(self) -> tuple[Until, ...]:
        """All that ends it, but for its time."""
        return self.until if isinstance(self.until, tuple) else (self.until,)

    @property
    def time(self) -> float | None:
        """How long it lasts at most, s."""
        return getattr(self, "for")

    @property
    def is_ended(self) -> bool:
        """Whether anything ends it but the end of the run."""
        return bool(self.ends) or self.time is not None

    @model_validator(mode="after")
    def consistent(self) -> "Phase":
        for one, other in (("drive", "release"), ("lock", "unlock"), ("park", "unpark"),
                           ("apply", "remove")):  # fmt: skip
            both = sorted({*getattr(self, one)} & {*getattr(self, other)})
            if both:
                raise ScenarioError(f"'{both[0]}' stands under {one} and under {other}")
        return self


class OfPhase(Event):
    """An event that phases are made into."""

    phase: int  # in which it counts
    role: str  # begin, until, for, stall, taut
    leads: int = -1  # the phase that begins with it
    lasts: float = 0.0  # s after the phase began, or since nothing moved
    energy: float = 0.0  # J, of what counts as moving
    path: tuple = ()  # where in the scenario what is watched stands


def named(phases: tuple[Phase, ...], taken: Any) -> tuple[str, ...]:
    """The names of phases.  Raises ScenarioError where one comes twice, or is another's."""
    names: list[str] = []
    for k, phase in enumerate(phases):
        name = phase.name or f"phase_{k + 1}"
        if phase.name and not phase.name.isidentifier():
            what = f"not a name: {described(phase.name)}"
            raise ScenarioError(
                what, "A name is letters, digits and _, a letter first.", ("phases", k, "name")
            )
        if name in names or name in taken:
            whose = "phase" if name in names else "event"
            what = f"the name '{name}' is that of another {whose}"
            raise ScenarioError(what, "Give it another `name`.", ("phases", k))
        names.append(name)
    return tuple(names)


def events_of(scenario: Any) -> dict[str, OfPhase]:
    """The events that the phases of a scenario are.  Raises ScenarioError."""
    phases = scenario.phases
    names = named(phases, scenario.events)
    found: dict[str, OfPhase] = {}

    def add(name: str, k: int, role: str, **keys: Any) -> None:
        own: Any = {"when": "t", "value": 0.0, "crosses": "up", "times": None} | keys
        found[name] = OfPhase.model_construct(phase=k, role=role, **own)

    for k, (phase, name) in enumerate(zip(phases, names, strict=True)):
        check(scenario, k)
        if k == 0:
            add(f"{name}.begin", 0, "begin", do=begun(scenario, 0), leads=0, path=("phases", 0))
        after = {"leads": k + 1, "do": begun(scenario, k + 1)}
        for n, until in enumerate(phase.ends):
            word = f"{name}.until" if len(phase.ends) == 1 else f"{name}.until_{n + 1}"
            own = {"when": until.when, "value": until.value, "crosses": until.crosses}
            add(word, k, "until", **own, **after, path=("phases", k, "until", n))
        if phase.time is not None:
            add(f"{name}.for", k, "for", lasts=phase.time, **after, path=("phases", k, "for"))
        for n, rope in enumerate(phase.taut):
            when, value = slack_of(scenario, rope, ("phases", k, "taut", n))
            do = Actions.model_construct(end="slack")
            add(f"{name}.taut_{rope}", k, "taut", when=when, value=value, crosses="down", do=do,
                path=("phases", k, "taut", n))  # fmt: skip
        if phase.stall is not None:
            do = Actions.model_construct(end="stalled")
            own = {"lasts": getattr(phase.stall, "for"), "energy": phase.stall.energy}
            add(f"{name}.stall", k, "stall", **own, do=do, path=("phases", k, "stall"))
    return found


def path_of(scenario: Any, spec: Any, path: tuple) -> tuple:
    """Where in the file stands what an event has at a path: what a phase is made into, there."""
    if not isinstance(spec, OfPhase) or path[:1] != ("events",):
        return path
    if path[2:3] == ("do",):
        key = {"set": "drive"}.get(path[3], path[3])
        return ("phases", spec.leads, key, *path[4:])
    # of one thing that ends a phase `until` need not be a list
    single = spec.path[2:3] == ("until",) and isinstance(scenario.raw(spec.path[:3]), dict)
    return (*(spec.path[:3] if single else spec.path), *path[2:])


def check(scenario: Any, k: int) -> None:
    """Refuse a phase that others never follow, and what is only said of the last one."""
    phase, last = scenario.phases[k], k == len(scenario.phases) - 1
    if not last and not phase.is_ended:
        what = "nothing ends this phase, and another one is to follow"
        raise ScenarioError(what, "give `until`, `for` or both", ("phases", k))
    if phase.stall is not None and is_static(scenario, k):
        what = "a static phase rests at each place, and knows no `stall`"
        raise ScenarioError(what, "end it with `until` or `for`", ("phases", k, "stall"))
    if phase.end is not None and not (last and phase.is_ended):
        what = "`end` is the status of a run that ends with its last phase"
        hint = "leave it out" if not last else "give `until` or `for`, which ends the phase"
        raise ScenarioError(what, hint, ("phases", k, "end"))


def is_static(scenario: Any, k: int) -> bool:
    """Whether phase k is a static path: it says so, or all phases are."""
    return bool(scenario.phases[k].static) or METHODS[scenario.solver.method].rests


def begun(scenario: Any, k: int) -> Actions:
    """What happens as phase k begins; behind the last one the run ends."""
    phases = scenario.phases
    if k == len(phases):
        last = phases[-1]
        lets_go = last.release and not last.drive and not last.lock
        return Actions.model_construct(end=last.end or ("released" if lets_go else "done"))
    phase = phases[k]
    keys = ("release", "lock", "unlock", "park", "unpark", "record")
    own: dict[str, Any] = {key: getattr(phase, key) for key in keys}
    # drives move, and loads rest, from the very start: they are so in the scenario itself
    own["set"] = phase.drive if k else {}
    apply, remove = loads_of(scenario, k) if k else ((), ())
    return Actions.model_construct(apply=apply, remove=remove, **own)


def loads_of(scenario: Any, k: int) -> tuple[tuple[str, ...], tuple[str, ...]]:
    """What phase k applies, and what it removes: what other phases apply, too."""
    phase = scenario.phases[k]
    others = [name for other in scenario.phases for name in other.apply]
    gone = [name for name in others if name not in phase.apply]
    return phase.apply, tuple(dict.fromkeys([*gone, *phase.remove]))


def forces_in(scenario: Any, name: str, path: tuple) -> tuple[str, ...]:
    """The forces that a name under `apply` or `remove` means.  Raises ScenarioError."""
    if name in scenario.load_sets:
        if not (scenario.loads or {}).get(name):
            what = f"load set '{name}' does not act: `loads` gives it no factor"
            raise ScenarioError(what, f"for example `loads: {{{name}: limit}}`", path)
        own: tuple[str, ...] = scenario.load_sets[name].loads
        return own
    if name not in scenario.forces:
        what = f"no force or load set named {described(name)}"
        raise ScenarioError(what, known(name, [*scenario.forces, *scenario.load_sets]), path)
    return (name,)


def resting(scenario: Any) -> frozenset[str]:
    """The forces that do not act at the start: those of other phases than the first, and those
    that an event is first to apply."""
    found: dict[str, bool] = {}
    for name, event in scenario.events.items():
        if isinstance(event, OfPhase):
            continue
        for key in ("apply", "remove"):
            for n, one in enumerate(getattr(event.do, key)):
                for force in forces_in(scenario, one, ("events", name, "do", key, n)):
                    found.setdefault(force, key == "apply")
    for k in range(len(scenario.phases)):
        for key in ("apply", "remove"):
            for n, one in enumerate(getattr(scenario.phases[k], key)):
                for force in forces_in(scenario, one, ("phases", k, key, n)):
                    if key == "apply":
                        found.setdefault(force, True)
    if scenario.phases:
        apply, remove = loads_of(scenario, 0)
        for names, rests in ((apply, False), (remove, True)):
            for one in names:
                found |= dict.fromkeys(forces_in(scenario, one, ("phases", 0)), rests)
    return frozenset(name for name, rests in found.items() if rests)


def slack_of(scenario: Any, name: str, path: tuple) -> tuple[str, float]:
    """The channel of a rope that falls through a value where it goes slack, and the value."""
    spec = scenario.forces.get(name) or scenario.joints.get(name)
    found = getattr(spec, "goes_slack", None)
    if found is None:
        ropes = [n for of in (scenario.forces, scenario.joints) for n, one in of.items()
                 if getattr(one, "goes_slack", None)]  # fmt: skip
        what = f"'{name}' is no rope" if spec else f"no rope named {described(name)}"
        hint = known(name, ropes) if ropes else "a `spring` with `tension_only: true`, or a `rope`"
        raise ScenarioError(what, hint, path)
    word, value = found
    return f"{name}.{word}", value


def driven_first(scenario: Any) -> dict[str, Any]:
    """The drives that move in the first phase, with its motions.  Raises ScenarioError."""
    found = {}
    for name, motion in scenario.phases[0].drive.items() if scenario.phases else ():
        path = ("phases", 0, "drive", name)
        spec = scenario.drives.get(name)
        if spec is None:
            raise ScenarioError(f"no drive named '{name}'", known(name, scenario.drives), path)
        found[name] = spec.model_copy(
            update={"position": motion.position, "velocity": motion.velocity}
        )
    return found
