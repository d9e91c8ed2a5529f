"""The growing tables of a run besides its rows: steps in contact, and events."""

from typing import Any

import h5py

from trsim.store.grow import Field, Growing

EXPECTED = 256  # rows of the tables whose length nobody knows
MAY_BE_NAN = {"angle"}  # of an event: a stop has none
KINDS = ("", "onset", "separation", "to implicit", "to explicit")  # of events, by number


def steps(file: h5py.File, instance: Any, time_field: Field) -> Growing:
    """The table of one contact: its channels at every accepted step in touch."""
    fields, start = [time_field], 2
    for c in instance.element.channels:
        fields.append(Field(c.name, c.unit, c.meaning, start, c.size))
        start += c.size
    return Growing(file["steps"].create_group(instance.name), fields, start, EXPECTED)


def force_column(instance: Any) -> int:
    """The column of a line of steps that holds the contact force."""
    start = {}
    column = 2
    for c in instance.element.channels:
        start[c.name], column = column, column + c.size
    return start.get("contact_force", start.get("normal_force", 1))


def events(file: h5py.File, mechanism: Any, time_field: Field) -> Growing:
    """The table of onsets and separations, and of changes of method."""
    names = (*(instance.name or "-" for instance in mechanism.instances), "solver")
    fields = [
        time_field,
        Field("kind", "", "what happened", 1, words=KINDS),
        Field("element", "", "where", 2, words=names),
        Field("speed", "m/s", "rate of penetration; of the solver: largest eigenvalue, 1/s", 3),
        Field("angle", "rad", "of the contact point around the bearing", 4),
    ]
    return Growing(file["events"], fields, 5, EXPECTED)
