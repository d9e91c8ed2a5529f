"""The growing tables of a run besides its rows: steps in contact, and events."""

from typing import Any

import numpy as np

from trsim.store.grow import Field, Growing
from trsim.store.made import Book

EVENT_COLUMNS = 7  # of a line of events, see solve/march/record.py
EXPECTED = 256  # rows of the tables whose length nobody knows
# groups of tables of user events -> their words
AT_EVENTS = {
    "recorded": ("event",),
    "impulses": ("event", "row", "body"),
    "velocity_jumps": ("event", "body"),
}
MAY_BE_NAN = {"angle"}  # of an event: a stop has none
# of events, by their numbers in solve/march/record.py: ONSET = 1.0 and so on
KINDS = (
    *("", "onset", "separation", "to implicit", "to explicit", "user", "jump", "corner", "turns"),
    "impact",
)
AXES = ("normal", "friction_1", "friction_2")  # of an impact, in the order of its impulses


def steps(book: Book, instance: Any, time_field: Field) -> Growing:
    """The table of one contact: its channels at every accepted step in touch."""
    fields = step_fields(instance)
    width = 2 + sum(field.size for field in fields)
    path = book.group(f"steps/{instance.name}")
    return Growing(book, path, [time_field, *fields], (width, EXPECTED))


def step_fields(instance: Any) -> list[Field]:
    """The channels of a contact in a line of steps, behind its time and its row."""
    fields, start = [], 2
    for c in instance.channels:
        fields.append(Field(c.name, c.unit, c.meaning, start, c.size))
        start += c.size
    return fields


def touching(mechanism: Any) -> dict[int, Any]:
    """The instances that are contacts, by their rows."""
    every = enumerate(mechanism.instances)
    return {e: instance for e, instance in every if instance.row.contact is not None}


class Touches:
    """Shares the lines of steps out among the contacts of a mechanism."""

    def __init__(self, mechanism: Any) -> None:
        self.width, self.force = dict[int, int](), dict[int, int]()
        for e, instance in touching(mechanism).items():
            fields = step_fields(instance)
            start = {field.name: field.start for field in fields}
            self.width[e] = 2 + sum(field.size for field in fields)
            # the column of a line that holds the contact force
            self.force[e] = start.get("contact_force", start.get("normal_force", 1))

    def take(self, steps: Any, into: Any, impacts: Any) -> None:
        """Append lines to what takes those of each contact, by its row, and note their forces."""
        if len(steps):
            of = steps[:, 1]
            for e, width in self.width.items():
                lines = steps[of == e][:, :width]
                into[e].append(lines)
                impacts.press(e, lines, self.force[e])


def events(book: Book, mechanism: Any, time_field: Field) -> Growing:
    """The table of onsets and separations, of changes of method, and of user events."""
    if user := mechanism.stages.switches.events:
        asked = [event.name for event in user if event.role not in ("stall", "taut")]
        book.attribute("events", "user", asked)
    fields = [time_field, *event_fields(mechanism)]
    return Growing(book, "events", fields, (EVENT_COLUMNS, EXPECTED))


def event_fields(mechanism: Any) -> list[Field]:
    """What a line of events tells behind its time."""
    user = mechanism.stages.switches.events
    names = (*(instance.name or "-" for instance in mechanism.instances), "solver")
    did = ("-",) * len(names) + tuple(event.said for event in user)
    names += tuple(event.name for event in user)
    speed = speed_unit(mechanism)
    fields = [
        Field("kind", "", "what happened", 1, words=KINDS),
        Field("element", "", "where", 2, words=names),
        Field(
            "speed", speed, "rate of penetration; of the solver: rate of what is stiffest, 1/s", 3
        ),
        Field("angle", "rad", "of the contact point around the bearing", 4),
    ]
    if user:
        fields.append(Field("did", "", "what a user event did", 2, words=did))
    strikes = bool(mechanism.model.contact_impact.any())
    if user or mechanism.stages.switches.jumps >= 0 or strikes:
        fields.append(Field("work", "J", "done by it: change of kinetic and stored energy", 5))
    if np.any(mechanism.model.jump) or strikes:
        meant = "along the normal, of an impact" if strikes else "of a drive whose rate jumps"
        fields.append(Field("impulse", impulse_unit(mechanism), meant, 6))
    return fields


def impulse_unit(mechanism: Any) -> str:
    """The unit of the impulses of drives and of impacts; both where there are both."""
    drives = [i for i in mechanism.instances if i.section == "drives" or struck(i)]
    return " or ".join(dict.fromkeys("N*m*s" if i.row.turns else "N*s" for i in drives))


def struck(instance: Any) -> bool:
    """Whether touches of an instance take no time."""
    contact = instance.row.contact
    return contact is not None and contact.impact is not None


def speed_unit(mechanism: Any) -> str:
    """The unit of the rates in the table of events; all of them where there are several."""
    touching = (mechanism.instances[e] for e in mechanism.model.contact.tolist())
    found = ["rad/s" if instance.row.turns else "m/s" for instance in touching]
    found += [event.rate for event in mechanism.stages.switches.events]
    if np.any(mechanism.model.jump):
        drives = (i for i in mechanism.instances if i.section == "drives")
        found += ["rad/s" if i.row.turns else "m/s" for i in drives]
    return " or ".join(dict.fromkeys(found)) or "m/s"


def recorded(book: Book, mechanism: Any, rows: list[Field]) -> Growing | None:
    """The table of the channels at user events that record them; None where none does.

    rows: the fields of the output rows, time first.
    """
    events = mechanism.stages.switches.events
    if not any(event.record for event in events):
        return None
    fields = [rows[0], Field("event", "", "which", 1, words=tuple(e.name for e in events))]
    fields += [field._replace(start=field.start + 1) for field in rows[1:]]
    width = 2 + max((c.start + c.size for c in mechanism.columns), default=0)
    return Growing(book, book.group("recorded"), fields, (width, EXPECTED))


def jumps(book: Book, mechanism: Any, time_field: Field) -> tuple[Growing, Growing] | None:
    """The tables of impulses and of velocities at impacts, and at user events that change what
    holds; None where there are none."""
    events, stages = mechanism.stages.switches.events, mechanism.stages
    touching = [mechanism.instances[e] for e in mechanism.model.contact.tolist()]
    if not any(event.turned for event in events) and not any(map(struck, touching)):
        return None
    whose = (*(event.name for event in events), *(i.name for i in touching))
    which = Field("event", "", "at which event, or the impact of which contact", 1, words=whose)
    acting = (*stages.every, *(f"{i.name}.{axis}" for i in touching for axis in AXES))
    bodies = [""] * (max(mechanism.frames.values(), default=0) + 1)
    for name, frame in mechanism.frames.items():
        bodies[frame] = bodies[frame] or name
    words = tuple(name or "-" for name in bodies)
    impulses = [
        time_field,
        which,
        Field("row", "", "the constraint row that acts", 2, words=acting or ("-",)),
        Field("body", "", "the body it acts on", 3, words=words),
        Field("impulse", "N*s or N*m*s", "Lambda of the row: M (v+ - v-) = J^T Lambda", 4),
        Field("force", "N*s", "impulse on the body, world axes", 5, 3),
        Field("moment", "N*m*s", "its moment about the centre of mass; of the ground, the origin",
              8, 3),
    ]  # fmt: skip
    velocities = [
        time_field,
        which,
        Field("body", "", "whose velocities they are", 2, words=words),
        Field("velocity", "m/s", "of the centre of mass just before", 3, 3),
        Field("velocity_after", "m/s", "the same just after", 6, 3),
        Field("angular_velocity", "rad/s", "just before, world axes", 9, 3),
        Field("angular_velocity_after", "rad/s", "the same just after", 12, 3),
    ]
    return (
        Growing(book, book.group("impulses"), impulses, (11, EXPECTED)),
        Growing(book, book.group("velocity_jumps"), velocities, (15, EXPECTED)),
    )
