"""Worms and screws: a core with a wire wound about it, which turns with its body."""

from collections.abc import Iterator

import numpy as np

from trsim.report.animation import solids
from trsim.report.animation.drawing import Array, Joint, Wheel, Worm
from trsim.report.animation.motion import Motion
from trsim.report.animation.solids import Mesh, frame
from trsim.report.animation.teeth import towards
from trsim.report.animation.things import STOP, Look, Thing, colours, origin, pose
from trsim.report.animation.trains import LONG

X = np.array([1.0, 0.0, 0.0])
MOST = 24  # turns that are drawn; a screw has fewer where it is longer than that
WINDING, SIDES = 12, 4  # corners of a turn, of the wire
BEYOND = 3.0  # half widths of a link: a screw goes on so far at each end


def thread(length: float, radius: float, lead: float, wire: float) -> Mesh:
    """A core and its thread about their middle, along x; at x = 0 the thread is above y."""
    count = min(length / abs(lead), float(MOST))
    coil = solids.coil(count * abs(lead), radius, wire, count, WINDING, SIDES)
    # from the middle, where it has turned by half of all turns
    middle = np.pi * count
    c, s = np.cos(middle), np.sin(middle)
    back = np.array([[1.0, 0.0, 0.0], [0.0, c, -s], [0.0, s, c]])
    coil = Mesh(coil.points @ back, coil.normals @ back, coil.triangles)
    coil = coil.moved(-0.5 * count * abs(lead) * X)
    if lead < 0.0:
        mirror = np.array([1.0, 1.0, -1.0])
        coil = Mesh(coil.points * mirror, coil.normals * mirror, coil.triangles[:, ::-1])
    return solids.joined(solids.cylinder(radius, length, X), coil)


def placed(mesh: Mesh, axis: Array, above: Array) -> Mesh:
    """A mesh along x with what is above y there in a direction across the axis."""
    axes = np.stack([axis, above, np.cross(axis, above)])
    return Mesh(mesh.points @ axes, mesh.normals @ axes, mesh.triangles)


def worms(moved: Motion, look: Look) -> Iterator[Thing]:
    """The thread of every worm, in the teeth of its wheel."""
    drawn = moved.drawn
    for worm in drawn.moving.worms:
        wheel = drawn.moving.wheels[worm.wheel]
        wire = min(0.3 * abs(worm.lead), 0.2 * worm.radius)
        length = min(LONG * wheel.radius, MOST * abs(worm.lead))
        mesh = thread(length, worm.radius - wire, worm.lead, 1.5 * wire)
        mesh = placed(mesh, worm.axis, crest(worm, wheel))
        mesh = mesh.moved(worm.at - origin(drawn, worm.body))
        yield Thing(f"{worm.name} thread", ((mesh, colours(drawn)[worm.body]),),
                    *pose(moved, worm.body))  # fmt: skip


def crest(worm: Worm, wheel: Wheel) -> Array:
    """Where the thread is in the plane of the middle, so that it goes into gaps of the wheel."""
    out = wheel.at - worm.at
    out = out / np.linalg.norm(out)
    if not wheel.teeth:
        return np.asarray(out)
    here, onward = towards(wheel, worm.at)
    radius, teeth = wheel.radius, wheel.teeth
    gap = (wheel.phase - here) * radius + np.pi * radius / teeth
    ahead = gap * np.sign(onward @ worm.axis)
    # the thread comes out of `out` where it has gone that far along the axis
    angle = -2.0 * np.pi * ahead / worm.lead
    return np.asarray(np.cos(angle) * out + np.sin(angle) * np.cross(worm.axis, out))


def screws(moved: Motion, look: Look) -> Iterator[Thing]:
    """A screw on the one body of its joint, a nut on the other one.

    The screw is the one whose centre of mass lies nearer to the axis.
    """
    drawn = moved.drawn
    for joint in drawn.joints:
        if joint.picture != "thread":
            continue
        screw, nut = sorted((joint.i, joint.j), key=lambda body: aside(moved, joint, body))
        way = (moved.on(screw, np.broadcast_to(moved.point(nut, joint.at), (len(moved.time), 3)))
               - joint.at) @ joint.axis  # fmt: skip
        low, high = way.min() - BEYOND * look.radius, way.max() + BEYOND * look.radius
        core = 0.75 * look.radius
        mesh = thread(high - low, core, joint.pitch, min(0.3 * abs(joint.pitch), 0.35 * core))
        mesh = placed(mesh, joint.axis, frame(joint.axis)[0])
        mesh = mesh.moved(joint.at + 0.5 * (low + high) * joint.axis - origin(drawn, screw))
        yield Thing(f"{joint.name} screw", ((mesh, colours(drawn)[screw]),), *pose(moved, screw))
        ring = solids.ring(core, 1.6 * look.radius, 2.4 * look.radius, joint.axis)
        yield Thing(f"{joint.name} nut", ((ring, STOP),), moved.point(nut, joint.at),
                    moved.turn(nut), label=joint.name)  # fmt: skip


def aside(moved: Motion, joint: Joint, body: str) -> float:
    """How far the centre of mass of a body is from the axis, as drawn; of the ground far."""
    if body not in moved.drawn.bodies:
        return float("inf")
    return float(np.linalg.norm(np.cross(moved.drawn.bodies[body] - joint.at, joint.axis)))
