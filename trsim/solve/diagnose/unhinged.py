"""Drives, locks and gears that hold nothing: a hinge of theirs in space came apart.

See assemble/stages.py.
"""

from collections.abc import Iterator

from trsim.assemble.mechanism import Mechanism
from trsim.solve.march.record import Record


def of_hinges(mechanism: Mechanism, r: Record) -> Iterator[str]:
    """Each of them as the run ended, and what to do."""
    if not len(r.stage):  # of a static path without phases: it lets go of drives alone
        return
    for (section, name), angle in mechanism.stages.without_hinge(r.stage):
        joint = angle.joint
        what = f"joints.{joint}: its lock" if section == "events" else f"{section}.{name}:"
        yield (
            f"{what} holds nothing once an event has released the hinge '{joint}': apart, it has "
            "no angle in space; a `bushing` between the bodies keeps them from turning further"
        )
