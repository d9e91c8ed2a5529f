"""Distance sensor: how far apart two points are.

    s = |d|,    s' = n . d',    s'' = n . d'' + (|d'|^2 - s'^2) / s        n = d / |d|

d goes from the point on the first body to the point on the second.  When the points meet, d has no
direction and the sensor turns back; its rate and acceleration are then those just after.  The same
holds if only rounding keeps the points apart.
"""

from math import sqrt
from typing import ClassVar

from trsim.elements.contract import Channel, Element, Row, kernel, measured
from trsim.elements.frames import (
    TwoPoints,
    apart,
    between_points,
    centripetal,
    dot,
    minus,
    plus,
    two_points,
    velocity,
)
from trsim.fields import Spec, point
from trsim.kernels.lazy import internal

ROUNDING = 1e-15  # of places: points that are nearer to each other meet


class Distance(Spec):
    """The distance between two points.

    bodies  the two bodies, or one body and the ground
    points  its ends, on the first and on the second body, as drawn
    """

    type: ClassVar[str] = "distance"
    bodies: tuple[str, str]
    points: tuple[point("m"), point("m")]


def pack(name, spec, at):
    p, q = spec.points
    i, j = at.bodies(spec.bodies, p, q)
    places = {"p_i": at.looked_at(i, p), "p_j": at.looked_at(j, q)}
    own = TwoPoints.packed(i=i, j=j, coordinate=at.sensor(name), **places)
    return Row(*own, travel="distance")


@internal
def length_and_rate(scene, e):
    """The distance and its rate, and whether the points meet."""
    _, _, d, d_dot = apart(scene, e)
    length = sqrt(dot(d, d))
    i, p_i, j, p_j = two_points(scene, e)
    if length <= ROUNDING * (far(scene.X, i, p_i) + far(scene.X, j, p_j)):
        return length, sqrt(dot(d_dot, d_dot)), True
    return length, dot(d, d_dot) / length, False


@internal
def far(X, f, p):
    """The size of the numbers that a place is the sum of."""
    place = abs(X[f, 0]) + abs(X[f, 1]) + abs(X[f, 2])
    return place + abs(p[0]) + abs(p[1]) + abs(p[2])


@kernel
def coordinate(t, scene, e):
    s = TwoPoints(scene, e).coordinate
    scene.S[s, 0], scene.S[s, 1], _ = length_and_rate(scene, e)


@measured
def measure(t, scene, e, o):
    V, A, out = scene.V, scene.A, scene.out
    i, p_i, j, p_j = two_points(scene, e)
    _, _, d, d_dot = apart(scene, e)
    length, rate, meet = length_and_rate(scene, e)
    a_i = plus(velocity(A, i, p_i), centripetal(V, i, p_i))
    d_ddot = minus(plus(velocity(A, j, p_j), centripetal(V, j, p_j)), a_i)
    if not meet:
        bend = (dot(d, d_ddot) + dot(d_dot, d_dot) - rate * rate) / length
    elif rate > 0.0:
        bend = dot(d_dot, d_ddot) / rate
    else:
        bend = sqrt(dot(d_ddot, d_ddot))
    out[o], out[o + 1], out[o + 2] = length, rate, bend


ELEMENT = Element(
    key="distance",
    section="sensors",
    spec=Distance,
    pack=pack,
    coordinates=("stroke",),
    channels=(
        Channel("", "m", "distance between the points", least=0.0),
        Channel("rate", "m/s", "its rate"),
        Channel("acceleration", "m/s^2", "its acceleration"),
    ),
    turning=between_points,
    kernels={"coordinate": coordinate, "measure": measure},
    example="""
bodies:
  bob: {mass: 2 kg, inertia: 0.01 kg*m^2, at: [0.5, 0]}
joints:
  hinge: {type: revolute, bodies: [ground, bob], at: [0, 0]}
sensors:
  gap: {type: distance, bodies: [ground, bob], points: [[0, -0.8], [0.5, 0]]}
gravity: [0, -9.81, 0]
solver: {end: 1 s}
""",
)
