"""The key `sizing`: a load that takes over what a drive gives."""

from typing import Annotated, ClassVar

from annotated_types import Ge, Gt, Le

from trsim.fields import Spec, Unit


class Sizing(Spec):
    """A load that is found, so that a drive is left with no force along its motion.

    drive   whose force it takes over
    load    the key that becomes a table, as forces.hand.force
    of      the sensor it becomes a table of; it rises or falls throughout the motion
    below   what may be left of the force of the drive, of its largest without the load
    passes  the most that are made
    """

    type: ClassVar[str] = "sizing"
    drive: str
    load: str
    of: str
    below: Annotated[float, Gt(0), Le(1), Unit("-")] = 1e-6
    passes: Annotated[int, Ge(1)] = 20
