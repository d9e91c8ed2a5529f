"""Marker: a named point of a body, or of the ground, with axes.

    p = r + R s        p' = r' + omega x R s        p'' = r'' + omega' x R s + omega x (omega x R s)

s is the point in the axes of the body, measured from its centre of mass.  The point is fixed in the
body, and its axes turn with it.  Other entries may use its name for a position, `at: tip`, and its
axes for a direction, `axis: tip.z`; both are taken as drawn.
"""

from typing import ClassVar

from trsim.elements.contract import Channel, Element, Memory, Row, Turning, measured
from trsim.elements.frames import arm, centripetal, plus, point, velocity
from trsim.elements.placed import Placed
from trsim.elements.rotations import triad
from trsim.fields import point as place
from trsim.kernels.columns import V3, i8


class Marker(Placed):
    """A point of a body, with axes.

    body  the body in which it is fixed, or `ground`
    at    the point, as drawn
    """

    type: ClassVar[str] = "marker"
    body: str
    at: place("m", named=False)


class Own(Memory):
    """Of one instance."""

    body: i8
    point: V3  # m, from the centre of mass in the axes of the body
    x: V3  # its axes, in those of the body
    y: V3
    z: V3


def pack(name, spec, at):
    i, frame = at.body(spec.body, "body", near=spec.at), spec.frame
    axes = {"x": at.axes(i, frame.x), "y": at.axes(i, frame.y), "z": at.axes(i, frame.z)}
    # a flexible bar does not say how it turns about itself
    shown = CHANNELS[:3] if at.is_node(i) else CHANNELS
    return Row(*Own.packed(body=i, point=at.looked_at(i, spec.at), **axes), channels=shown)


@measured
def measure(t, scene, e, o):
    X, V, A, out = scene.X, scene.V, scene.A, scene.out
    own = Own(scene, e)
    i = own.body
    p = arm(X, i, own.point)
    there, v = point(X, i, p), velocity(V, i, p)
    a = plus(velocity(A, i, p), centripetal(V, i, p))
    for c in range(3):
        out[o + c], out[o + 3 + c], out[o + 6 + c] = there[c], v[c], a[c]
    if scene.n_r <= i:
        return
    x, y, z = triad(X, i, own.x, own.y, own.z)
    for c in range(3):
        out[o + 9 + 3 * c], out[o + 10 + 3 * c], out[o + 11 + 3 * c] = x[c], y[c], z[c]


def turning(row):
    own = Own.of(row)
    return Turning(points=((own.body, own.point),))


CHANNELS = (
    Channel("position", "m", "of the point, world axes", 3),
    Channel("velocity", "m/s", "of the point, world axes", 3),
    Channel("acceleration", "m/s^2", "of the point, world axes", 3),
    Channel("rotation", "-", "rotation matrix of its axes, row by row", 9),
)

ELEMENT = Element(
    key="marker",
    section="points",
    spec=Marker,
    pack=pack,
    channels=CHANNELS,
    turning=turning,
    kernels={"measure": measure},
    example="""
points:
  hook: {body: beam, at: [0.8 m, 0]}
bodies:
  beam: {mass: 2 kg, inertia: 0.1 kg*m^2, at: [0.4 m, 0]}
joints:
  hinge: {type: revolute, bodies: [ground, beam], at: [0, 0]}
forces:
  weight: {type: applied_load, body: beam, at: hook, direction: [0, -1], force: 20 N}
solver: {end: 1 s}
""",
)
