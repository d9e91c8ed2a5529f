"""Pins, journals in their bearings, supports and stops as solids."""

from collections.abc import Iterator

import numpy as np

from trsim import elements
from trsim.fields import direction
from trsim.report.animation import solids, turns
from trsim.report.animation.bodies import arm, lifted
from trsim.report.animation.drawing import GROUND, SLIDES, SPATIAL, Array, Joint
from trsim.report.animation.motion import Motion
from trsim.report.animation.solids import Mesh
from trsim.report.animation.things import (
    JOURNAL,
    PIN,
    STOP,
    SUPPORT,
    Look,
    Thing,
    colours,
    origin,
    pose,
)

PLAUSIBLE = 0.35, 1.6  # radii of bearings that are drawn to scale, of the half width of links


def pins(moved: Motion, look: Look) -> Iterator[Thing]:
    """What holds bodies together at ideal joints."""
    for joint in moved.drawn.joints:
        if joint.picture in (*SLIDES, "journal"):
            continue
        holder = joint.j if joint.j in moved.turns else joint.i
        place, turn = moved.point(holder, joint.at), moved.turn(holder)
        if joint.picture == "ball":
            mesh = solids.ball(1.15 * look.radius)
        elif joint.picture == "cross":
            arms = [
                solids.cylinder(0.5 * look.radius, 2.6 * look.radius, a) for a in joint.axes[1:]
            ]
            mesh = solids.joined(*arms)
        elif joint.picture == "weld":
            mesh = solids.box(np.full(3, 1.3 * look.radius), np.eye(3))
        else:
            mesh = solids.cylinder(0.5 * look.radius, *spanned(joint, look))
        yield Thing(f"{joint.name} pin", ((mesh.moved(middle(joint, look)), PIN),), place, turn,
                    label=joint.name)  # fmt: skip


def spanned(joint: Joint, look: Look) -> tuple[float, Array]:
    """Length of a pin that reaches through both bodies, and its axis."""
    if look.normal is None:
        return 2.6 * look.radius, joint.axis
    return 2.0 * look.pitch + abs(look.height(joint.i) - look.height(joint.j)), look.normal


def middle(joint: Joint, look: Look) -> Array:
    """The middle of the layers of the two bodies, from the point of the joint."""
    if look.normal is None or joint.picture in SPATIAL:
        return np.zeros(3)
    return 0.5 * (look.height(joint.i) + look.height(joint.j)) * look.normal


def bearings(moved: Motion, look: Look, magnified: float) -> Iterator[Thing]:
    """Joints with clearance: a ring on the first body, and in it the journal of the second.

    The play between them is to scale, or magnified; the bodies stay where they are.
    """
    for joint in moved.drawn.joints:
        if joint.picture != "journal":
            continue
        radius = journal(joint, look)
        bore = radius + magnified * joint.clearance
        lift, length, axis, root = np.zeros(3), 2.0 * look.radius, joint.axis, 0.0
        if look.normal is not None:
            front = look.front(joint.i, joint.j)
            root = front - min(look.height(joint.i), look.height(joint.j))
            lift, length, axis = front * look.normal, look.thick, look.normal
        ring = solids.ring(bore, bore + 0.45 * look.radius, length, axis).moved(lift)
        yield Thing(f"{joint.name} bearing", ((ring, colours(moved.drawn)[joint.i]),),
                    moved.point(joint.i, joint.at), moved.turn(joint.i))  # fmt: skip
        # the journal reaches back to the body behind
        pin = solids.cylinder(radius, 1.3 * length + root, axis).moved(lift - 0.5 * root * axis)
        place = moved.point(joint.i, joint.at) + magnified * moved.plays[joint.name]
        yield Thing(f"{joint.name} journal", ((pin, JOURNAL),), place, moved.turn(joint.j),
                    label=joint.name)  # fmt: skip


def journal(joint: Joint, look: Look) -> float:
    """Radius of the journal: its own where that can be seen, m."""
    low, high = PLAUSIBLE
    own = joint.bearing - joint.clearance
    return own if low < own / look.radius < high else 0.6 * look.radius


def supports(moved: Motion, look: Look) -> Iterator[Thing]:
    """The ground, where joints stand on it."""
    r = look.radius
    for joint in moved.drawn.joints:
        if GROUND not in (joint.i, joint.j) or joint.picture in SLIDES:
            continue
        if look.normal is not None:
            mesh = stand(look, look.normal)
        elif joint.picture in SPATIAL:
            post = solids.cylinder(0.9 * r, 3.0 * r, look.up).moved(-2.2 * r * look.up)
            foot = solids.cylinder(2.4 * r, 0.6 * r, look.up).moved(-3.8 * r * look.up)
            mesh = solids.joined(post, foot)
        else:
            mesh = solids.cylinder(1.3 * r, 1.6 * r, joint.axis)
        yield Thing(f"{joint.name} support", ((mesh, SUPPORT),), joint.at[None], turns.STILL[None])


def stand(look: Look, normal: Array) -> Mesh:
    """What carries a hinge of a flat mechanism, behind all bodies."""
    r = look.radius
    outline = r * np.array([[-2.0, -3.4], [2.0, -3.4], [0.8, 0.6], [-0.8, 0.6]])
    base = r * np.array([[-3.6, -4.2], [3.6, -4.2], [3.6, -3.4], [-3.6, -3.4]])
    parts = [solids.prism(shape, look.thick, normal) for shape in (outline, base)]
    return solids.joined(*parts).moved(-look.pitch * normal)


def stops(moved: Motion, look: Look) -> Iterator[Thing]:
    """Points that meet walls: a nose on the one, a plate on the other, where they are nearest."""
    drawn, r = moved.drawn, look.radius
    for name, spec in drawn.scenario.forces.items():
        if elements.load(spec.type).picture != "stop" or spec.point is None:
            continue
        i, j = spec.wall.body, spec.point.body
        if not {i, j} <= {GROUND, *drawn.bodies}:
            continue
        at, n = np.array(spec.point.at), np.array(direction(spec.wall.normal))
        there, k = nearest(moved, spec)
        # the way out of the wall as the point's body has it at that moment
        out = turns.turned(
            turns.back(row(moved.turn(j), k)), turns.turned(row(moved.turn(i), k), n)
        )
        nose = solids.ball(0.5 * r).moved(at + 0.5 * r * out - origin(drawn, j))
        across = look.normal if look.normal is not None else solids.frame(n)[0]
        axes = np.stack([n, np.cross(across, n), across])
        plate = solids.box(np.array([0.5 * r, 2.6 * r, look.thick]), axes)
        plate = plate.moved(there - origin(drawn, i) - 0.25 * r * n)
        for body, mesh, tip in ((j, nose, at + 0.5 * r * out), (i, plate, there - 0.5 * r * n)):
            arms = arm(drawn, look, body, tip) if body in drawn.bodies else []
            parts = [(part, colours(drawn)[body]) for part in arms]
            # the plate too is in the layer of what meets it
            parts.append((lifted(mesh, look, j), STOP))
            yield Thing(f"{name} {body}", tuple(parts), *pose(moved, body))


def nearest(moved: Motion, spec: object) -> tuple[Array, int]:
    """Where on the wall's body, as drawn, the point comes nearest to the wall, and the frame."""
    wall, point = spec.wall, spec.point  # type: ignore[attr-defined]
    n, at = np.array(direction(wall.normal)), moved.point(point.body, np.array(point.at))
    turn = moved.turn(wall.body)
    d = turns.turned(turns.back(turn), at - moved.point(wall.body, np.array(wall.at)))
    k = int((d @ n).argmin())
    return np.array(wall.at) + d[k] - (d[k] @ n) * n, k


def row(values: Array, k: int) -> Array:
    """Row k of what moves, the only row of what does not."""
    return values[min(k, len(values) - 1)]
