"""Curves of bodies as plates, slots or wires, and the pins, rollers and faces on them."""

from collections.abc import Iterator

import numpy as np

from trsim.report.animation import solids, turns
from trsim.report.animation.drawing import Array, Guide
from trsim.report.animation.guides import left, outline, plated
from trsim.report.animation.motion import Motion
from trsim.report.animation.plates import annulus, anticlockwise, plate
from trsim.report.animation.solids import Mesh
from trsim.report.animation.things import PIN, STOP, Look, Thing, colours, origin, pose
from trsim.report.animation.wires import wire

TURN = 0.13  # rad, by which the tangent turns from one drawn place of a curve to the next
PIN_SIZE, WALL = 0.5, 0.45  # half widths of a link: radius of a pin, thickness of a wall
WIRE = 0.2  # the same: radius of the wire a curve is where there is no room for walls
SHARE = 0.6  # of the radius a curve turns with: how far beside it a wall may reach


def curves(moved: Motion, look: Look) -> Iterator[Thing]:
    """Every curve on its body, and what stays on it."""
    for guide in moved.drawn.guides:
        colour = colours(moved.drawn)
        mesh = drawn_curve(moved, look, guide).moved(look.lift(guide.i))
        mesh = mesh.moved(-origin(moved.drawn, guide.i))
        yield Thing(f"{guide.name} curve", ((mesh, colour[guide.i]),), *pose(moved, guide.i))
        yield follower(moved, look, guide, colour[guide.j])


# --- the curve -------------------------------------------------------------------------------


def drawn_curve(moved: Motion, look: Look, guide: Guide) -> Mesh:
    """A plate where the follower is outside of a closed curve; a slot, or what it runs along."""
    flat = outline(guide, TURN)
    side = left(guide)
    if plated(guide):
        return on_plane(guide, plate(flat, look.thick, guide.axes))
    if guide.picture == "lobe":
        wide = beside(guide, -side, WALL * look.radius)
        return on_plane(guide, strip(guide, flat, 0.0, -side * wide, look))
    room = (PIN_SIZE + WALL) * look.radius
    if look.normal is None or min(beside(guide, way, room) for way in (-1.0, 1.0)) < room:
        line = guide.placed(flat)
        return wire(line, WIRE * look.radius, guide.axes[2], guide.curve.closed)
    return on_plane(guide, slot(guide, flat, look))


def on_plane(guide: Guide, mesh: Mesh) -> Mesh:
    """What is about the origin of the curve, in its place as drawn."""
    return mesh.moved(guide.origin)


def beside(guide: Guide, side: float, wanted: float) -> float:
    """How far a wall may reach to a side, of what is wanted."""
    sharp = float((side * guide.curve.bend).max())
    return min(wanted, SHARE / sharp) if sharp > 0.0 else wanted


def offset(guide: Guide, flat: Array, by: float) -> Array:
    """Places of the curve moved to its left."""
    curve = guide.curve
    near = [int(np.sum((curve.place - p) ** 2, axis=1).argmin()) for p in flat]
    t = curve.tangent[near]
    return flat + by * np.stack([-t[:, 1], t[:, 0]], axis=1)


def strip(guide: Guide, flat: Array, low: float, high: float, look: Look) -> Mesh:
    """What lies between two distances to the left of a curve."""
    a, b = offset(guide, flat, low), offset(guide, flat, high)
    if guide.curve.closed:
        ring = anticlockwise(a) is a
        outer, inner = (b, a) if (high > low) != ring else (a, b)
        if not ring:
            outer, inner = outer[::-1], inner[::-1]
        return annulus(outer, inner, look.thick, guide.axes)
    return plate(np.concatenate([a, b[::-1]]), look.thick, guide.axes)


def slot(guide: Guide, flat: Array, look: Look) -> Mesh:
    """Walls on both sides of a pin, around the ends of an open curve as well."""
    low, high = PIN_SIZE * look.radius, (PIN_SIZE + WALL) * look.radius
    if guide.curve.closed:
        return solids.joined(
            strip(guide, flat, low, high, look), strip(guide, flat, -high, -low, look)
        )
    outer, inner = (around(guide, flat, by) for by in (high, low))
    return annulus(outer, inner, look.thick, guide.axes)


def around(guide: Guide, flat: Array, by: float) -> Array:
    """An outline at a distance from an open curve, anticlockwise."""
    t = guide.curve.tangent
    ends = []
    for place, way in ((flat[-1], t[-1]), (flat[0], -t[0])):
        angle = np.arctan2(way[1], way[0]) + np.linspace(-0.5 * np.pi, 0.5 * np.pi, 13)[1:-1]
        ends.append(place + by * np.stack([np.cos(angle), np.sin(angle)], axis=1))
    return np.concatenate([offset(guide, flat, -by), ends[0],
                           offset(guide, flat, by)[::-1], ends[1]])  # fmt: skip


# --- what stays on it ------------------------------------------------------------------------


def follower(moved: Motion, look: Look, guide: Guide, colour: str) -> Thing:
    """A pin, a roller with its axle, or a face, with the second body."""
    place, turn = moved.point(guide.j, guide.at), moved.turn(guide.j)
    axis, lift = guide.axes[2], look.lift(guide.i)
    if guide.face is not None:
        mesh = face(moved, look, guide, guide.face).moved(lift)
        return Thing(f"{guide.name} face", ((mesh, colour),), place, turn, label=guide.name)
    if look.normal is None and guide.radius == 0.0:
        ball = solids.ball(1.2 * look.radius)
        return Thing(f"{guide.name} pin", ((ball, PIN),), place, turn, label=guide.name)
    middle = 0.5 * (lift + look.lift(guide.j))
    long = 1.3 * look.pitch + float(np.linalg.norm(lift - look.lift(guide.j)))
    size = PIN_SIZE * look.radius
    size = min(size, 0.5 * guide.radius) if guide.radius else size
    pieces = [(solids.cylinder(size, long, axis).moved(middle), PIN)]
    if guide.radius:
        disc = solids.prism(solids.circle(guide.radius, 48), look.thick, axis, smooth=True)
        pieces.insert(0, (disc.moved(lift), STOP))
    word = "roller" if guide.radius else "pin"
    return Thing(f"{guide.name} {word}", tuple(pieces), place, turn, label=guide.name)


def face(moved: Motion, look: Look, guide: Guide, normal: Array) -> Mesh:
    """A bar whose side towards the curve is the face; as long as the touch goes along it."""
    along = np.cross(guide.axes[2], normal)
    flat = moved.touches[guide.name].place @ guide.axes[:2]
    touched = moved.point(guide.i, guide.origin) + turns.turned(moved.turn(guide.i), flat)
    way = (moved.on(guide.j, touched) - guide.at) @ along
    low, high = min(way.min(), 0.0) - 2.0 * look.radius, max(way.max(), 0.0) + 2.0 * look.radius
    thick = 1.2 * look.radius
    axes = np.stack([along, -normal, guide.axes[2]])
    middle = 0.5 * (low + high) * along + 0.5 * thick * normal
    return solids.box(np.array([high - low, thick, look.thick]), axes).moved(middle)
