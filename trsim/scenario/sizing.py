"""The key `sizing`: a load that replaces the force of a drive."""

from typing import Annotated, ClassVar

from annotated_types import Ge, Gt, Le

from trsim.fields import Spec, Unit


class Sizing(Spec):
    """Find the load that leaves a drive without force along its motion.

    drive   the drive whose force the load replaces
    load    the key to find, such as forces.hand.force; it becomes a table
    of      sensor on which the table depends; it must rise or fall throughout the motion
    below   the force left in the drive, relative to its largest force without the load
    passes  the largest number of passes
    """

    type: ClassVar[str] = "sizing"
    drive: str
    load: str
    of: str
    below: Annotated[float, Gt(0), Le(1), Unit("-")] = 1e-6
    passes: Annotated[int, Ge(1)] = 20
