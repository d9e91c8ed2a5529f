"""Belt: two pulleys on one carrier whose rims move at equal speeds.

    r_1 w_1 = r_2 w_2          open: both turn the same way
    r_1 w_1 = -r_2 w_2         crossed

w are the angular velocities of the pulleys relative to their carrier, about a common direction.
The belt neither slips nor stretches, and either strand may pull.  Its torques come from the
difference between the forces in the strands; the tension that both have in common loads no joint
here.
"""

from typing import Annotated, ClassVar

from annotated_types import Gt

from trsim.elements.transmission import (
    PARALLEL,
    Transmission,
    aside,
    carried,
    product,
    relation,
    size,
    transmission,
)
from trsim.errors import ScenarioError
from trsim.fields import Flag, Unit
from trsim.frame import across


class Belt(Transmission):
    """A belt, a chain or a closed rope over two pulleys on one carrier, without slip or stretch.

    joints   hinges of both pulleys, with parallel axes; they share the carrier, which may be the
             ground
    radii    radii of both pulleys, to the middle of the belt
    crossed  whether its strands cross, so that the pulleys turn in opposite directions
    """

    type: ClassVar[str] = "belt"
    joints: tuple[str, str]
    radii: Annotated[tuple[Annotated[float, Gt(0)], Annotated[float, Gt(0)]], Unit("m")]
    crossed: Flag = False


def pack(name, spec, at):
    found = carried(spec, ("angle", "angle"), at)
    x, y = found.x, found.y
    if size(across(x.axis, y.axis)) > PARALLEL:
        raise ScenarioError(
            f"the axes of '{x.joint}' and '{y.joint}' are not parallel, and a belt lies in a plane",
            "draw them parallel, or use a `coupler` of the two angles",
            ("joints",),
        )
    check_distance(x, y, spec)
    alike = (product(x.axis, y.axis) > 0.0) != spec.crossed
    first, second = spec.radii
    way = 1.0 if alike else -1.0
    return relation((x, y), (found.of_x * first, -way * found.of_y * second))


def check_distance(x, y, spec):
    """Refuse pulleys around which no such belt goes."""
    distance, whole_way = aside(x, y)
    first, second = spec.radii
    least = first + second if spec.crossed else abs(first - second)
    if distance <= max(least, PARALLEL * whole_way):
        how = "crossed" if spec.crossed else "open"
        raise ScenarioError(
            f"the axes are {distance:.6g} m apart, and an {how} belt over pulleys of these radii "
            f"needs more than {least:.6g} m".replace("an crossed", "a crossed"),
            "correct the radii, or `at` of the joints",
            ("radii",),
        )


ELEMENT = transmission(
    key="belt",
    spec=Belt,
    pack=pack,
    picture="band",
    units=("N*m", "N*m"),
    example="""
bodies:
  motor: {mass: 1 kg, inertia: 0.002 kg*m^2, at: [0, 0], angular_velocity: [0, 0, 10]}
  fan: {mass: 2 kg, inertia: 0.01 kg*m^2, at: [0.4, 0.1]}
joints:
  shaft: {type: revolute, bodies: [ground, motor], at: [0, 0]}
  axle: {type: revolute, bodies: [ground, fan], at: [0.4, 0.1]}
  drive: {type: belt, joints: [shaft, axle], radii: [5 cm, 12 cm]}
solver: {end: 0.5 s}
""",
)
