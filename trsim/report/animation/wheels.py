"""Gear wheels, pulleys and racks: discs, rings and cones of the size of their pitch circles.

Teeth are triangles half inside and half outside of the pitch circle; a dark mark shows the turning.
Wheels that are alike share one mesh, made about z and turned to where it belongs.
"""

from collections.abc import Iterator

import numpy as np

from trsim.report.animation import solids, turns
from trsim.report.animation.drawing import Array, Rack, Wheel
from trsim.report.animation.motion import Motion
from trsim.report.animation.plates import annulus, plate
from trsim.report.animation.solids import Mesh, frame, joined, quads
from trsim.report.animation.things import PIN, Look, Thing, colours, pose

SMOOTH = 48  # corners of a wheel without teeth
STANDS_OUT = 0.8  # of the module 2 r/z
BORE, RIM = 0.5, 1.12  # half widths of a link; of the pitch circle, the outside of a ring
DEEP = 0.3  # of a cone: the width of its teeth
FACE = 0.22  # of its radius: width of a wheel in space
LARGE, SPOKES, RIM_INSIDE = 4.0, 5, 0.76  # half widths of a link; of the radius
BACK = 1.6  # half widths of a link: depth of a rack
BEYOND = 0.9  # of the radius of the wheel: a rack goes on so far


def wheels(moved: Motion, look: Look) -> Iterator[Thing]:
    """Every wheel, with its body, in the layer of its train."""
    colour, made = colours(moved.drawn), {}
    for k, wheel in enumerate(moved.drawn.moving.wheels):
        key = alike(wheel)
        if key not in made:
            made[key] = shape(wheel, look), mark(wheel, look)
        mesh, dark = made[key]
        place = moved.point(wheel.body, wheel.at) + look.level(wheel.train)
        turn = turns.product(moved.turn(wheel.body), stance(wheel))
        yield Thing(f"{wheel.joint} wheel {k}", ((mesh, colour[wheel.body]), (dark, PIN)), place,
                    turn)  # fmt: skip


def alike(wheel: Wheel) -> tuple[float, ...]:
    """What the mesh of a wheel depends on."""
    return (float(f"{wheel.radius:.9g}"), float(f"{cone(wheel):.6g}"), wheel.teeth, wheel.hollow)


def heading(wheel: Wheel) -> Array:
    """What of a mesh about z is along: the axis, of a cone away from its apex."""
    if wheel.apex is None or (wheel.at - wheel.apex) @ wheel.axis >= 0.0:
        return wheel.axis
    return -wheel.axis


def stance(wheel: Wheel) -> Array:
    """The turn, (4), that brings a mesh about z to its axis, with a tooth where one is."""
    x, y, _ = frame(wheel.axis)
    tooth = np.cos(wheel.phase) * x + np.sin(wheel.phase) * y
    z = heading(wheel)
    R = np.stack([tooth, np.cross(z, tooth), z], axis=1)
    return turns.of_matrices(R[None])


def cone(wheel: Wheel) -> float:
    """From the pitch circle to its apex along the axis, m; 0 of a disc."""
    return 0.0 if wheel.apex is None else float(np.linalg.norm(wheel.at - wheel.apex))


def width(wheel: Wheel, look: Look) -> float:
    """Of a disc: that of a layer in a flat mechanism."""
    if look.normal is not None:
        return look.thick
    return max(look.thick, FACE * wheel.radius)


def outline(wheel: Wheel, radius: float, scale: float = 1.0) -> Array:
    """A pitch circle with teeth, (n, 2), the first of which is along x; or smooth."""
    if not wheel.teeth:
        return scale * solids.circle(radius, SMOOTH)
    out = STANDS_OUT * 2.0 * radius / wheel.teeth
    ring = solids.circle(1.0, 2 * wheel.teeth)
    ring[0::2] *= radius + out
    ring[1::2] *= radius - out
    return scale * ring


def shape(wheel: Wheel, look: Look) -> Mesh:
    """A wheel about its middle and z."""
    teeth = outline(wheel, wheel.radius)
    corners, deep = len(teeth), width(wheel, look)
    if wheel.hollow:
        out = solids.circle(max(RIM * wheel.radius, wheel.radius + 1.5 * look.radius), corners)
        return annulus(out, teeth, deep, np.eye(3))
    bore = min(BORE * look.radius, 0.4 * wheel.radius)
    if wheel.apex is None or cone(wheel) < 0.05 * wheel.radius:
        if wheel.radius > LARGE * look.radius:
            return spoked(wheel.radius, teeth, bore, deep)
        return annulus(teeth, solids.circle(bore, corners), deep, np.eye(3))
    return bevelled(wheel, teeth, bore)


def spoked(radius: float, teeth: Array, bore: float, deep: float) -> Mesh:
    """A rim on spokes, between which one sees what is behind."""
    rim = annulus(teeth, solids.circle(RIM_INSIDE * radius, len(teeth)), deep, np.eye(3))
    hub = annulus(solids.circle(3.0 * bore), solids.circle(bore), deep, np.eye(3))
    low, high = 2.5 * bore, (RIM_INSIDE + 0.02) * radius
    parts = []
    for angle in 2.0 * np.pi * np.arange(SPOKES) / SPOKES:
        along = np.array([np.cos(angle), np.sin(angle), 0.0])
        axes = np.stack([along, np.cross([0.0, 0.0, 1.0], along), [0.0, 0.0, 1.0]])
        spoke = solids.box(np.array([high - low, 0.12 * radius, 0.8 * deep]), axes)
        parts.append(spoke.moved(0.5 * (low + high) * along))
    return joined(rim, hub, *parts)


def bevelled(wheel: Wheel, teeth: Array, bore: float) -> Mesh:
    """A cone, cut off, whose larger end is at the pitch circle."""
    far, near = cone(wheel), (1.0 - DEEP) * cone(wheel)
    hole = solids.circle(min(bore, 0.5 * (1.0 - DEEP) * wheel.radius), len(teeth))
    # tips and roots lie on cones of their own, with the same apex
    slope = (np.linalg.norm(teeth, axis=1) / wheel.radius - 1.0) * wheel.radius**2 / far
    loops = [np.insert(teeth, 2, -slope, axis=1)]
    apex = np.array([0.0, 0.0, -far])
    loops.append(apex + (1.0 - DEEP) * (loops[0] - apex))
    loops.append(np.insert(hole, 2, near - far, axis=1))
    loops.append(np.insert(hole, 2, 0.0, axis=1))
    parts = []
    for k in range(4):
        a, b = loops[k], loops[(k + 1) % 4]
        points = np.stack([a, b, np.roll(b, -1, axis=0), np.roll(a, -1, axis=0)], axis=1)
        normal = np.cross(points[:, 2] - points[:, 0], points[:, 3] - points[:, 1])
        normal /= np.linalg.norm(normal, axis=1, keepdims=True)
        parts.append(Mesh(points.reshape(-1, 3), np.repeat(normal, 4, axis=0), quads(len(a))))
    return joined(*parts)


def mark(wheel: Wheel, look: Look) -> Mesh:
    """A dark bar from the bore to the teeth, on both sides of a disc."""
    r, wide = wheel.radius, min(0.35 * look.radius, 0.08 * wheel.radius)
    low, high = (0.35 * r, 0.85 * r) if not wheel.hollow else (1.04 * r, 1.09 * r)
    if wheel.apex is None and not wheel.hollow and r > LARGE * look.radius:
        low = RIM_INSIDE * r
    deep = 1.12 * width(wheel, look)
    if wheel.apex is not None:
        # on the back of a cone
        deep = 0.06 * r
    sides = np.array([high - low, 2.0 * wide, deep])
    return solids.box(sides, np.eye(3)).moved(np.array([0.5 * (low + high), 0.0, 0.0]))


# --- racks -----------------------------------------------------------------------------------


def racks(moved: Motion, look: Look) -> Iterator[Thing]:
    """Bars with teeth, as long as their wheels roll on them."""
    colour = colours(moved.drawn)
    for rack in moved.drawn.moving.racks:
        wheel = moved.drawn.moving.wheels[rack.wheel]
        mesh = bar(moved, look, rack, wheel).moved(rack.at + look.level(wheel.train))
        mesh = mesh.moved(-moved.drawn.bodies.get(rack.body, np.zeros(3)))
        yield Thing(f"{rack.name} rack", ((mesh, colour[rack.body]),), *pose(moved, rack.body))


def ends(moved: Motion, rack: Rack) -> tuple[float, float]:
    """How far a rack goes from the pitch point as drawn, the way the rim of its wheel does."""
    wheel = moved.drawn.moving.wheels[rack.wheel]
    along = np.cross(wheel.axis, rack.out)
    there = np.broadcast_to(moved.point(rack.carrier, rack.at), (len(moved.time), 3))
    way = (moved.on(rack.body, there) - rack.at) @ along
    return float(way.min()) - BEYOND * wheel.radius, float(way.max()) + BEYOND * wheel.radius


def bar(moved: Motion, look: Look, rack: Rack, wheel: Wheel) -> Mesh:
    """The bar about the pitch point as drawn; its outline there is that of the wheel."""
    along = np.cross(wheel.axis, rack.out)
    low, high = ends(moved, rack)
    back = -BACK * look.radius
    line = np.array([[low, 0.0], [high, 0.0]])
    if wheel.teeth:
        x, y, _ = frame(wheel.axis)
        angle = np.arctan2(rack.out @ y, rack.out @ x)
        half = np.pi * wheel.radius / wheel.teeth
        start = (wheel.phase - angle) * wheel.radius
        k = np.arange(np.floor((low - start) / half), np.ceil((high - start) / half) + 1)
        out = STANDS_OUT * 2.0 * wheel.radius / wheel.teeth
        # where the wheel has a tooth, at even k, the rack has a gap
        line = np.stack([start + k * half, np.where(k % 2 == 0, -out, out)], axis=1)
        back -= out
    foot = np.array([[line[-1, 0], back], [line[0, 0], back]])
    axes = np.stack([along, -rack.out, wheel.axis])
    return plate(np.concatenate([line, foot]), width(wheel, look), axes)
