"""Screw joint: body j advances along an axis of body i as it turns about it.

    Phi_1, 2 = u_i . d = 0,  w_i . d = 0          d from the point on i to the point on j
    Phi_3, 4 = u_i . a_j = 0,  w_i . a_j = 0
    Phi_5    = a_i . d - h (theta - theta_0) = 0,    h = pitch/(2 pi)      [Nikravesh1988]

theta is the angle of the axes of body j minus that of body i, about a, unwrapped over any number of
turns, and theta_0 its value as drawn, where the stroke a_i . d is zero.  A positive pitch is a
right-handed thread.  reaction and reaction_moment act on body j at its point; along the axis they
are F and M = -h F, because the thread has no friction:  2 pi M + pitch F = 0.
"""

from math import pi
from typing import Annotated, ClassVar

from trsim.elements.contract import Row
from trsim.elements.frames import along_row, arm, cross, dot, points, relative_spin, spin
from trsim.elements.joint import Joint, joint, of_triad
from trsim.elements.rows import ACROSS, TILTS, Axes, JointRow
from trsim.errors import ScenarioError, described
from trsim.fields import Unit, vector
from trsim.kernels.columns import f8
from trsim.kernels.lazy import internal
from trsim.numbers import angular, written
from trsim.units import unit

PER_ANGLE = unit("m/rad")[1]


class Pitch(Unit):
    """Marks an advance per turn, which may be written as one per angle: 5 mm is 5 mm/turn."""

    def convert(self, value, context, words=()):
        parameters = context.get("parameters") or {}
        found = written(value, parameters) if isinstance(value, str) else None
        number = super().convert(value, context, words)
        if (
            isinstance(value, str)
            and (found is None or not found[1])
            and angular(value, parameters)
        ):
            raise ScenarioError(
                f"{described(value)} is computed of parameters with an angle in their units, so it "
                "does not tell whether it is the advance of a turn or of a radian",
                "name a parameter alone that has its unit: `parameters: {p: 5 mm/turn}`",
            )
        per_angle = found and found[1] and unit(found[1])[1] == PER_ANGLE
        return 2.0 * pi * number if per_angle else number


class Screw(Joint):
    """A nut on the second body and a screw on the first, or a screw on the second in a nut.

    axis   direction, as drawn; of any length. The stroke is positive along it, and the angle about
           it
    pitch  advance in one turn; positive right-handed, negative left-handed. A plain number or a
           length is the advance per turn; `0.8 mm/rad` and `5 mm/turn` are possible too
    """

    type: ClassVar[str] = "screw"
    axis: vector("-")
    pitch: Annotated[float, Pitch("m", "m/rad")]


class Own(Axes):
    """Of one instance."""

    advance: f8  # h, m/rad


def pack(name, spec, at):
    if spec.pitch == 0.0:
        hint = "give the advance in one turn, or take a `revolute`, which has none"
        raise ScenarioError("a pitch must not be zero", hint, ("pitch",))
    i, j = at.bodies(spec.bodies, spec.at)
    at.coordinate(f"{name}.angle")  # its row counts the turns
    axes = of_triad(i, j, spec, at)
    return Row(*Own.packed(**points(at, i, j, spec.at, spec.at), **axes,
                           advance=spec.pitch / (2.0 * pi)))  # fmt: skip


@internal
def lead(scene, e, k):
    """The stroke less the advance of the turn, as row k."""
    V, J, own = scene.V, scene.J, Own(scene, e)
    i, j, h = own.i, own.j, own.advance
    a, l = arm(scene.X, i, own.a_i), scene.row_start[k]
    along_row(scene, e, a, k)
    scene.phi[k] -= h * (scene.S[own.coordinate, 0] - own.drawn)
    scene.gamma[k] += h * dot(cross(spin(V, i), a), relative_spin(V, i, j))
    for c in range(3):
        J[l, 3 + c] += h * a[c]
        J[l + 1, 3 + c] -= h * a[c]


ELEMENT = joint(
    key="screw",
    spec=Screw,
    rows=(*ACROSS, *TILTS, JointRow("lead", "h", fill=lead)),
    coordinates=("angle", "stroke"),
    pack=pack,
    picture="thread",
    example="""
planar: false
bodies:
  nut: {mass: 2 kg, inertia: [0.01, 0.01, 0.02]}
joints:
  thread: {type: screw, bodies: [ground, nut], at: [0, 0, 0], axis: [0, 0, 1], pitch: 20 mm}
sensors:
  turn: {joint: thread.angle}
  height: {joint: thread.stroke}
gravity: [0, 0, -9.81]
solver: {end: 1 s}
""",
)
