"""Section: the force and the moment in a rigid body at a station, without a joint there.

    F = m (a_c - g) - sum F_k
    M = I alpha + omega x I omega + (c - p) x m (a_c - g) - sum M_k       about the station p

F and M are the force and the moment of the rest of the body on the part beyond the section: the
reaction and reaction_moment that a `fixed` joint between the two would show.  m, c and I are those
of the part beyond, and a_c is the acceleration of c.  F_k and M_k are the loads of joints, drives
and forces on that part, with the moment about p.  For a joint they come from its constraint rows,
-J^T lambda.

Components are in axes that turn with the body: x and y in the section, z along its normal, which
points to the part beyond.  In a planar scene, forces along the world z axis and moments about other
axes are zero, as for joints.
"""

from math import sqrt
from typing import Annotated, ClassVar, NamedTuple

from annotated_types import Ge
from pydantic import model_validator

from trsim.elements.acted import Acted, acting, whole, wrench
from trsim.elements.contract import (
    Channel,
    Element,
    Row,
    Turning,
    measured,
)
from trsim.elements.frames import (
    arm,
    centripetal,
    cross,
    dot,
    inside,
    minus,
    plus,
    scaled,
    spin,
    times,
    velocity,
)
from trsim.elements.inertia import Inertia, tensor_of
from trsim.elements.joint import triad
from trsim.errors import ScenarioError, known
from trsim.fields import Spec, Unit, point, vector
from trsim.kernels.columns import V3, f8, run
from trsim.kernels.lazy import internal

IN_PLANE = 1e-9  # of the size of a body: so near to the section nobody knows the side
ROUNDED = 1e-12  # of a place: rounding
LEAST = -1e-9  # of its inertia: what rounding may leave of the rest of a body


class BodySection(Spec):
    """Internal loads of a rigid body at a station: normal and shear force, torsion and bending.

    body     the rigid body that is cut
    at       the station, as drawn
    axis     normal of the section, as drawn; it points to the part beyond
    x_axis   direction of the x components, as drawn; made perpendicular to the normal
    mass     mass of the part beyond the section; for a body with a `shape` it follows from the
             shape unless given
    centre   centre of mass of the part beyond, as drawn
    inertia  inertia of the part beyond about its centre of mass, given like that of a body and in
             the same axes
    beyond   joints, drives and forces that act on the part beyond. Forces and drives along the
             coordinate of a joint go with that joint. Unless given: those that act on that side of
             the section
    """

    type: ClassVar[str] = "section"
    body: str
    at: point("m")
    axis: vector("-")
    x_axis: vector("-") | None = None
    mass: Annotated[float, Ge(0), Unit("kg")] | None = None
    centre: point("m") | None = None
    inertia: Inertia | None = None
    beyond: tuple[str, ...] | None = None

    @model_validator(mode="after")
    def whole(self):
        given = self.centre is not None or self.inertia is not None
        if self.mass is None and given:
            what = "`centre` and `inertia` go with the `mass` of the part beyond"
            raise ScenarioError(what, "give all three, or none of a body with a `shape`")
        if self.mass and (self.centre is None or self.inertia is None):
            raise ValueError("a part with mass needs its `centre` and its `inertia`")
        return self


class Part(NamedTuple):
    """What lies beyond a section."""

    mass: float
    centre: tuple[float, ...]  # m, as drawn
    tensor: tuple[float, ...]  # kg m^2, row by row, about the centre in the axes of the body
    whole: bool  # whether the tensor is known in all directions
    origin: str  # where these are from


class Own(Acted):
    """Of one instance; what acts is what acts on the part beyond."""

    station: V3  # m, from the centre of mass, in the axes of the body
    x: V3  # axes of the section, in those of the body
    y: V3
    z: V3
    centre: V3  # m
    weight: V3  # N, of the part beyond, world axes
    mass: f8  # kg
    inertia: run(f8, 9)


def pack(name, spec, at):
    if spec.body == "ground":
        raise ScenarioError("the ground is no body that can be cut", "name a body", ("body",))
    if at.bar(spec.body) is not None:
        hint = "record `node3.bending_moment` of the bar and the like, or make it rigid"
        raise ScenarioError(f"'{spec.body}' is flexible", hint, ("body",))
    i = at.body(spec.body, "body")
    u, w, a = triad(spec)
    part = given(spec) if spec.mass is not None else of_shape(spec, at, a)
    check_part(spec, at, i, part)
    acts = beyond(spec, at, i, a)
    own = Own.packed(
        i=i, j=i, coordinate=-1, **acting(acts),
        station=at.looked_at(i, spec.at), x=at.axes(i, u), y=at.axes(i, w), z=at.axes(i, a),
        centre=at.looked_at(i, part.centre), weight=[part.mass * g for g in at.scenario.gravity],
        mass=part.mass, inertia=part.tensor,
    )  # fmt: skip
    return Row(*own, said=said(spec, part, acts))


def given(spec):
    """The part beyond as it is written."""
    tensor, whole = tensor_of(0.0 if spec.inertia is None else spec.inertia)
    centre = spec.at if spec.centre is None else spec.centre
    return Part(spec.mass, centre, tensor, whole or spec.inertia is None, "given")


def of_shape(spec, at, a):
    """The part of the shape of the body on that side of the station to which the normal points."""
    body = at.members[spec.body]
    if body.shape is None:
        what = "nothing tells what lies beyond the section"
        hint = f"give its `mass`, `centre` and `inertia`, or '{spec.body}' a `shape`"
        raise ScenarioError(what, hint)
    from trsim.elements.weighing import beyond, turned  # needs numpy

    found, differs = beyond(body, (spec.at, a))
    if differs:
        at.notes.append(
            f"body: {' and '.join(differs)} of '{spec.body}' are not those of its shape, from "
            "which the part beyond is cut: the other part has what is left"
        )
    tensor = turned(body, found.inertia, into_body=True).ravel().tolist()
    return Part(found.mass, tuple(found.centre.tolist()), tuple(tensor), True, "from its shape")


def said(spec, part, acts):
    """What lies beyond and what acts there, in words."""
    names = dict.fromkeys(instance.name for _, instance, _ in acts)
    least = ROUNDED * max(map(abs, part.centre))
    centre = ", ".join(f"{c:.6g}" if abs(c) > least else "0" for c in part.centre)
    what = f"{part.mass:.6g} kg of {spec.body} beyond it"
    what += f", centre at [{centre}] m, {part.origin}" if part.mass else ""
    return f"{what}; acted on by {', '.join(names) or 'nothing'}"


def check_part(spec, at, i, part):
    """Refuse what is no part of the body: what is left of that has a mass, and moments of inertia
    about its own centre of mass, which are not negative."""
    body = at.members[spec.body]
    if part.mass > body.mass:
        what = f"the part beyond has {part.mass:g} kg, and the body {body.mass:g} kg"
        raise ScenarioError(what, "give the mass beyond the section alone", ("mass",))
    total, known_whole = body.tensor
    if known_whole and not part.whole:
        what = "one moment of inertia is enough for a body in the plane only"
        raise ScenarioError(what, "give three or six numbers, as of the body", ("inertia",))
    if part.mass == 0.0:
        return
    import numpy as np  # checking text needs none

    I, own = np.array(total).reshape(3, 3), np.array(part.tensor).reshape(3, 3)
    c, rest = np.array(at.looked_at(i, part.centre)), body.mass - part.mass
    # both parts have their centres on a line through that of the body
    share = part.mass * body.mass / rest if rest > 0.0 else 0.0
    left = I - own - share * (c @ c * np.eye(3) - np.outer(c, c))
    if rest <= 0.0 and np.linalg.norm(c) > IN_PLANE * at.size_of(i):
        raise ScenarioError(
            "the part beyond has all the mass of the body, and its centre is elsewhere",
            "give the mass and the centre beyond the section alone",
            ("centre",),
        )
    left = left if known_whole else left[2:, 2:]
    least, largest = np.linalg.eigvalsh(left).min(), np.abs(I).max()
    if least < LEAST * largest:
        raise ScenarioError(
            f"beside the part beyond, the rest of '{spec.body}' would have a moment of inertia of "
            f"{least:.3g} kg*m^2",
            "give mass, centre and inertia of the part alone, the inertia about its own centre",
            ("inertia",),
        )


def beyond(spec, at, i, a):
    """What acts on the part beyond, part by part, each with its number."""
    acting = [one for e, x in at.acting_on(i) for one in whole(e, x)]
    sides = [side_of(spec, at, i, a, part) for _, _, part in acting]
    split = [x.name for (_, x, _), side in zip(acting, sides, strict=True) if side == {1, -1}]
    if split:
        what = f"'{split[0]}' acts on the body on both sides of the section"
        raise ScenarioError(what, "cut the body elsewhere, or into two bodies", ("at",))
    if spec.beyond is None:
        for (_, x, _), side in zip(acting, sides, strict=True):
            if side not in ({1}, {-1}):
                what = f"on which side of the section '{x.name}' acts cannot be told from the "
                hint = "list under `beyond` all that acts on the part beyond, `[]` if nothing does"
                raise ScenarioError(f"{what}drawing", hint)
        return [one for one, side in zip(acting, sides, strict=True) if side == {1}]
    names = [x.name for _, x, _ in acting if x.section != "events"]
    for k, name in enumerate(spec.beyond):
        if name not in names:
            what = f"no joint, drive or force named '{name}' acts on '{spec.body}'"
            raise ScenarioError(what, known(name, names), ("beyond", k))
    # of a shaft with one bearing before the section that one stays there
    apart = {x.name for (_, x, _), side in zip(acting, sides, strict=True) if side != {-1}}
    return [
        one for one, side in zip(acting, sides, strict=True)
        if {one[1].name, at.joint_of(one[1])} & {*spec.beyond}
        and not (one[1].name in apart and side == {-1})
    ]  # fmt: skip


def side_of(spec, at, i, a, part):
    """On which sides of the section something acts on the body: 1 beyond, -1, 0: in its plane, or
    nobody can tell."""
    near, found = IN_PLANE * at.size_of(i), set()
    station = at.looked_at(i, spec.at)
    a = at.axes(i, a)
    for frame, place in part.places:
        if frame == i and place is None:
            found.add(0)
        elif frame == i:
            height = sum((p - s) * c for p, s, c in zip(place, station, a, strict=True))
            found.add(0 if abs(height) <= near else 1 if height > 0.0 else -1)
    return found


@internal
def of_inertia(scene, e):
    """I alpha + omega x I omega of the part beyond, world axes."""
    X, own = scene.X, Own(scene, e)
    i, I = own.i, own.inertia
    alpha, omega = inside(X, i, spin(scene.A, i)), inside(X, i, spin(scene.V, i))
    rate, turning = times(I, alpha), times(I, omega)
    return arm(X, i, plus(rate, cross(omega, turning)))


@measured
def measure(t, scene, e, o):
    X, out, own = scene.X, scene.out, Own(scene, e)
    i, p, c = own.i, arm(X, own.i, own.station), arm(X, own.i, own.centre)
    a_c = plus(velocity(scene.A, i, c), centripetal(scene.V, i, c))
    F = minus(scaled(own.mass, a_c), own.weight)
    M = plus(of_inertia(scene, e), cross(minus(c, p), F))
    f, m = wrench(t, scene, e)
    F, M = minus(F, f), minus(M, minus(m, cross(p, f)))
    if scene.d == 3:
        F, M = (F[0], F[1], 0.0), (0.0, 0.0, M[2])
    x, y, z = arm(X, i, own.x), arm(X, i, own.y), arm(X, i, own.z)
    out[o], out[o + 1], out[o + 2] = dot(x, F), dot(y, F), dot(z, F)
    out[o + 3], out[o + 4], out[o + 5] = dot(x, M), dot(y, M), dot(z, M)
    out[o + 6] = sqrt(out[o] * out[o] + out[o + 1] * out[o + 1])
    out[o + 7] = sqrt(out[o + 3] * out[o + 3] + out[o + 4] * out[o + 4])


def turning(row):
    return Turning(points=((Own.of(row).i, Own.of(row).station),))


ELEMENT = Element(
    key="section",
    section="sensors",
    spec=BodySection,
    pack=pack,
    channels=(
        Channel(
            "force",
            "N",
            "force on the part beyond, axes of the section: z is normal, < 0 is tension",
            3,
        ),
        Channel("moment", "N*m", "moment about the station, in the same axes: z is torsion", 3),
        Channel("shear", "N", "magnitude of the force in the plane of the section", least=0.0),
        Channel("bending", "N*m", "magnitude of the moment in that plane", least=0.0),
    ),
    turning=turning,
    kernels={"measure": measure},
    example="""
bodies:
  arm: {mass: 2 kg, inertia: 0.17 kg*m^2, at: [0.5, 0]}
joints:
  hinge: {type: revolute, bodies: [ground, arm], at: [0, 0]}
sensors:
  root: {type: section, body: arm, at: [0.2, 0], axis: [1, 0, 0], x_axis: [0, 1, 0],
         mass: 1.6 kg, centre: [0.6, 0], inertia: 0.086 kg*m^2}
gravity: [0, -9.81, 0]
solver: {end: 1 s}
""",
)
