"""Events: what happens in a run when a sensor, or the time, crosses a value.

    g = sensor - value,  g = t - value          an event is a root of g, from the side asked for

The step ends on the root.  All actions of the event happen there, at one instant: the constraints
become those of the new stage, and the velocities change to the nearest ones that satisfy them,

    v+ = v- - M^-1 J^T (J M^-1 J^T)^-1 (J v- + Phi_t)          conserves momentum, may lose energy

The change of kinetic and stored energy is the `work` of the event.  The sum over all events is the
channel `energy.work.events`.  Several events at one instant happen in the order of the file.

An event can happen again after g has left the value by 1e-9 of the mechanism's size, or 1e-9 rad.
A start on the value does not count, nor a touch that turns back.

    events:
      lug_reached: {when: stroke, value: 120 mm, times: 1, do: {lock: [guide], record: true}}
      let_go:      {when: door_angle, value: 58 deg, do: {release: [actuator]}}
      late:        {when: t, value: 2 s, do: {set: {actuator: {velocity: "0.3*smoothstep(t/0.1)"}}}}
      shut:        {when: stroke, crosses: down, do: {end: true}}
"""

from typing import Annotated, Any, ClassVar, Literal

from annotated_types import Gt, Le
from pydantic import BeforeValidator, model_validator

from trsim.errors import ScenarioError, closest, described
from trsim.fields import EMPTY, Flag, Spec, Unit
from trsim.varying import Function

EXAMPLE = """
bodies:
  rod: {mass: 2 kg, inertia: 0.05 kg*m^2, at: [0.2, 0]}
joints:
  hinge: {type: revolute, bodies: [ground, rod], at: [0, 0]}
sensors:
  angle: {joint: hinge}
events:
  jettison: {when: angle, value: -60 deg, crosses: down, do: {release: [hinge], record: true}}
  over: {when: t, value: 0.6 s, do: {end: true}}
gravity: [0, -9.81, 0]
solver: {end: 1 s}
"""

# units of what may be watched
WATCHED = ("rad", "m", "s", "rad/s", "m/s", "rad/s^2", "m/s^2", "N", "N*m", "J", "W", "N/m", "-")
Crosses = Literal["up", "down", "both"]
DIRECTIONS = {"up": 1, "down": -1, "both": 0}
Ending = Literal["done", "stalled", "slack", "released"]
ENDINGS = ("done", "stalled", "slack", "released")
# of actions: what names things, in the order in which it is told
NAMING = ("release", "lock", "unlock", "park", "unpark", "apply", "remove")
AGAINST = (*(("set", "release"), ("lock", "unlock"), ("park", "unpark"), ("apply", "remove")),)


def _ending(value: Any) -> Any:
    if isinstance(value, bool) or value in ENDINGS:
        return value
    close = closest(str(value), ENDINGS)
    hint = f"Did you mean '{close}'?" if close else ""
    what = f"must be true, false or one of {', '.join(ENDINGS)}, got {described(value)}"
    raise ScenarioError(what, hint)


class Motion(Spec):
    """The new motion of a drive; in it `t` is the time since the event.

    position  prescribed coordinate; for a rigid drive it must begin at the position of the joint
    velocity  prescribed rate; the motion starts at the position prescribed until then, or else at
              that of the joint
    """

    type: ClassVar[str] = "motion"
    position: Function("m", "rad") | None = None
    velocity: Function("m/s", "rad/s") | None = None

    @model_validator(mode="after")
    def one_motion(self):
        if (self.position is None) == (self.velocity is None):
            raise ValueError("give either `position` or `velocity`")
        return self


class Actions(Spec):
    """What happens at an event, all of it at once.

    record   writes a row of all channels to the table `recorded`, with the values before the event
    set      drives that get another motion; a released drive engages again
    release  ideal joints that come apart, and drives that release their joint
    lock     joints to hold at their coordinate from then on; the force is NAME.lock.force
    unlock   joints that an event has locked
    park     bodies to hold in place, together with bodies connected only to them
    unpark   parked bodies to set free
    apply    forces and load sets that act from then on; before the first `apply` they do not act
    remove   forces and load sets that stop acting
    end      ends the run: true with status `done`, otherwise with the named status
    """

    type: ClassVar[str] = "actions"
    record: Flag = False
    set: dict[str, Motion] = EMPTY
    release: tuple[str, ...] = ()
    lock: tuple[str, ...] = ()
    unlock: tuple[str, ...] = ()
    park: tuple[str, ...] = ()
    unpark: tuple[str, ...] = ()
    apply: tuple[str, ...] = ()
    remove: tuple[str, ...] = ()
    end: Annotated[bool | Ending, BeforeValidator(_ending)] = False

    @model_validator(mode="after")
    def something(self):
        if not any(getattr(self, key) for key in type(self).model_fields):
            keys = ", ".join(type(self).model_fields)
            raise ScenarioError("nothing to do", f"Give one or more of {keys}.")
        for one, other in AGAINST:
            both = sorted({*getattr(self, one)} & {*getattr(self, other)})
            if both:
                raise ScenarioError(f"'{both[0]}' stands under {one} and under {other}")
        return self

    def said(self) -> str:
        """The event in words, for the table of events."""
        told = [f"set {name}" for name in self.set]
        for key in NAMING:
            told += [f"{key} {name}" for name in getattr(self, key)]
        told += ["record"] if self.record else []
        told += [f"end {self.status}" if self.status != "done" else "end"] if self.end else []
        return ", ".join(told)

    @property
    def status(self) -> Ending:
        """Of a run that ends here."""
        return "done" if isinstance(self.end, bool) else self.end


class Event(Spec):
    """What happens when a sensor, or the time, crosses a value.

    when     a sensor or t; or any other channel, whose crossings are found by sampling
    value    the value to cross
    crosses  the direction of crossing
    times    largest number of times it can happen; no limit unless given
    do       the actions of the event
    """

    type: ClassVar[str] = "event"
    when: str
    value: Annotated[float, Unit(*WATCHED)] = 0.0
    crosses: Crosses = "up"
    times: Annotated[int, Gt(0), Le(1_000_000_000)] | None = None
    do: Actions
