"""Links, slides, and flexible bars as solids."""

from collections.abc import Iterator
from itertools import pairwise

import numpy as np

from trsim.report.animation import solids, turns
from trsim.report.animation.drawing import SLIDES, Array, Drawing, Joint, Line
from trsim.report.animation.guides import plated
from trsim.report.animation.motion import Motion
from trsim.report.animation.shapes import edges, mesh, nearest
from trsim.report.animation.solids import Mesh
from trsim.report.animation.things import PIN, SUPPORT, Look, Thing, colours, origin, points, pose
from trsim.report.animation.wires import wire

LINE = 0.12  # half widths of a link: radius of the lines of holes
LONG = 4.5  # half widths of a link: what a rail is longer than the stroke, at each end
MANY = 4  # points of a body, of which a star is still understood
SEGMENTS = 48  # of a bar that is shown: more nodes than that are passed over


def links(moved: Motion, look: Look) -> Iterator[Thing]:
    """Every rigid body as it is made, or as a solid between its joints and lines."""
    drawn = moved.drawn
    colour = colours(drawn)
    for body in drawn.bodies:
        if drawn.shape(body):
            yield made_of_solids(moved, look, body, colour[body])
            continue
        parts = shapes(drawn, look, body)
        if parts:
            yield Thing(body, ((solids.joined(*parts), colour[body]),), *pose(moved, body))


def made_of_solids(moved: Motion, look: Look, body: str, colour: str) -> Thing:
    """Its solids, thin links to what it holds outside of them, and lines for its holes."""
    drawn = moved.drawn
    centre, solid = drawn.bodies[body], drawn.shape(body)
    parts = [mesh(one).moved(-centre) for one in solid if not one.hole]
    for at in points(drawn, body):
        foot = nearest(solid, at)
        if np.linalg.norm(at - foot) > 0.5 * look.radius:
            parts.append(link(foot - centre, at - centre, 0.4 * look.radius, look))
    pieces = [(solids.joined(*parts).moved(look.lift(body)), colour)]
    rings = [wire(line - centre, LINE * look.radius, across, closed=True)
             for one in solid if one.hole for line, across in edges(one)]  # fmt: skip
    if rings:
        pieces.append((solids.joined(*rings).moved(look.lift(body)), PIN))
    return Thing(body, tuple(pieces), *pose(moved, body))


def shapes(drawn: Drawing, look: Look, body: str) -> list[Mesh]:
    """The solids of a body about its centre of mass; what slides has a block where it does."""
    centre = drawn.bodies[body]
    parts = [link(a - centre, b - centre, look.radius, look)
             for a, b in skeleton(drawn, look, body)]  # fmt: skip
    parts += [slider(joint, look).moved(joint.at - centre) for joint in slides(drawn, body)
              if not slid(drawn, joint)]  # fmt: skip
    if not parts and not has_own(drawn, body):
        parts = [block(np.zeros(3), np.array([1.0, 0.0, 0.0]), look)]
    return [lifted(part, look, body) for part in parts]


def has_own(drawn: Drawing, body: str) -> bool:
    """Whether a body is seen by a wheel, a rack, a thread, the plate of a cam, or a sheave."""
    moving = drawn.moving
    seen = {wheel.body for wheel in moving.wheels} | {rack.body for rack in moving.racks}
    seen |= {worm.body for worm in moving.worms}
    seen |= {guide.i for guide in drawn.guides if plated(guide)}
    seen |= {place.body for rope in drawn.ropes for place in rope.places if place.bend}
    return body in seen or any(slid(drawn, joint) for joint in slides(drawn, body))


def slid(drawn: Drawing, joint: Joint) -> bool:
    """Whether something else is drawn in the place of a block: a rack, a thread."""
    return joint.picture == "thread" or joint.name in {rack.joint for rack in drawn.moving.racks}


def slides(drawn: Drawing, body: str) -> list[Joint]:
    return [joint for joint in drawn.joints if joint.picture in SLIDES and joint.j == body]


def skeleton(drawn: Drawing, look: Look, body: str) -> list[tuple[Array, Array]]:
    """Where the links of a body begin and end, as drawn.

    Two points: one between them; more: from their middle to each; one: to the centre of mass.  Of
    many points a star is a web: they are joined from neighbour to neighbour, as along a shell.
    What turns about the line of its two points, as a door does, reaches to its centre of mass, too.
    """
    held = points(drawn, body)
    if len(held) == 2:
        foot, centre = held[0] + on_line(drawn, body, *held), drawn.bodies[body]
        leaf = hung(drawn, body, *held) and np.linalg.norm(centre - foot) > look.radius
        return [(held[0], held[1]), *([(foot, centre)] if leaf else [])]
    if len(held) == 1:
        centre = drawn.bodies[body]
        far = np.linalg.norm(held[0] - centre) > look.radius
        seen = slides(drawn, body) or has_own(drawn, body)
        return [(held[0], centre)] if far or not seen else []
    if len(held) > MANY:
        return tree(held)
    return [(np.mean(held, axis=0), point) for point in held]


def on_line(drawn: Drawing, body: str, first: Array, second: Array) -> Array:
    """From the first of two points to the place between them that is nearest to the centre."""
    d = second - first
    share = float((drawn.bodies[body] - first) @ d) / max(float(d @ d), 1e-300)
    return min(max(share, 0.0), 1.0) * d


def hung(drawn: Drawing, body: str, first: Array, second: Array) -> bool:
    """Whether a hinge of a body has the line through two points as its axis."""
    d = second - first
    return any(
        joint.picture in ("pin", "journal")
        and body in (joint.i, joint.j)
        and np.linalg.norm(np.cross(joint.axis, d)) < 1e-6 * np.linalg.norm(d)
        for joint in drawn.joints
    )


def tree(points: list[Array]) -> list[tuple[Array, Array]]:
    """The shortest links that hold all points together (Prim)."""
    inside, outside, found = points[:1], points[1:], []
    while outside:
        away = np.array([[np.linalg.norm(p - q) for q in outside] for p in inside])
        a, b = np.unravel_index(away.argmin(), away.shape)
        found.append((inside[a], outside[b]))
        inside.append(outside.pop(b))
    return found


def arm(drawn: Drawing, look: Look, body: str, at: Array) -> list[Mesh]:
    """A thin link from a body to a point outside it, about its centre of mass; none inside."""
    centre, feet = drawn.bodies[body], [drawn.bodies[body]]
    for a, b in skeleton(drawn, look, body):
        along = b - a
        share = float((at - a) @ along) / max(float(along @ along), 1e-300)
        feet.append(a + min(max(share, 0.0), 1.0) * along)
    foot = min(feet, key=lambda p: float(np.linalg.norm(p - at)))
    if np.linalg.norm(at - foot) < look.radius:
        return []
    return [lifted(link(foot - centre, at - centre, 0.5 * look.radius, look), look, body)]


def link(a: Array, b: Array, radius: float, look: Look) -> Mesh:
    """A plate in a flat mechanism, a round rod in space."""
    if look.normal is None:
        return solids.rod(a, b, 0.6 * radius)
    return solids.bar(a, b, radius, look.thick, look.normal)


def slider(joint: Joint, look: Look) -> Mesh:
    """What slides: a bead turns all ways on its wire, and a block would not."""
    if joint.picture == "bead":
        return solids.ball(1.2 * look.radius)
    return block(np.zeros(3), joint.axis, look)


def block(at: Array, axis: Array, look: Look) -> Mesh:
    """A block that is long along the axis it slides on."""
    if look.normal is None:
        axes = np.roll(solids.frame(axis), 1, axis=0)
        return solids.box(look.radius * np.array([5.0, 2.4, 2.4]), axes).moved(at)
    axes = np.stack([axis, np.cross(look.normal, axis), look.normal])
    sides = np.array([6.0 * look.radius, 3.2 * look.radius, look.thick])
    return solids.box(sides, axes).moved(at)


def lifted(mesh: Mesh, look: Look, body: str) -> Mesh:
    """The mesh in the layer of its body."""
    return mesh.moved(look.lift(body))


def rails(moved: Motion, look: Look) -> Iterator[Thing]:
    """What slides run on, and bushings that are free along one axis."""
    for joint in moved.drawn.joints:
        if joint.picture in SLIDES and joint.picture != "thread":
            yield rail(moved, look, joint, joint.at, joint.axis)
    for line in moved.drawn.lines:
        axis = np.zeros(3) if line.slide is None else line.axes[line.slide]
        # stiffness across a flat mechanism says nothing
        if axis.any() and (look.normal is None or abs(axis @ look.normal) < 1e-9):
            yield rail(moved, look, line, line.ends[0], axis)


def rail(moved: Motion, look: Look, held: Joint | Line, at: Array, axis: Array) -> Thing:
    """A bar on the first body, as long as the stroke."""
    d = moved.point(held.j, at) - moved.point(held.i, at)
    stroke = np.sum(d * turns.turned(moved.turn(held.i), axis), axis=1)
    low, high = stroke.min() - LONG * look.radius, stroke.max() + LONG * look.radius
    middle = at - origin(moved.drawn, held.i) + 0.5 * (low + high) * axis
    if look.normal is None:
        axes, wide, deep = np.roll(solids.frame(axis), 1, axis=0), 0.7, 0.7
    else:
        axes = np.stack([axis, np.cross(look.normal, axis), look.normal])
        middle, wide, deep = middle - look.pitch * look.normal, 1.3, 0.9
    sides = np.array([high - low, wide * look.radius, deep * look.radius])
    mesh = solids.box(sides, axes).moved(middle)
    return Thing(f"{held.name} rail", ((mesh, SUPPORT),), *pose(moved, held.i))


def bars(moved: Motion, look: Look) -> Iterator[Thing]:
    """Flexible bars: a tube from node to node, and a ball at each that hides the kink.

    Tubes are as thick as the bar where that goes with the links: never thicker than these.
    """
    colour = colours(moved.drawn)
    tube, ball = solids.tube(), solids.ball(1.0)
    for name, nodes in moved.nodes.items():
        radius = np.clip(0.5 * moved.drawn.thickness[name], 0.45 * look.radius, look.radius)
        lift = 0.0 if look.normal is None else look.height(name) * look.normal
        count = nodes.shape[1]
        shown = np.unique(np.linspace(0, count - 1, min(count, SEGMENTS + 1)).astype(int))
        size = np.full((1, 3), radius)
        x = np.array([1.0, 0.0, 0.0])
        for k, (a, b) in enumerate(pairwise(shown)):
            place, along = nodes[:, a] + lift, nodes[:, b] - nodes[:, a]
            length = np.linalg.norm(along, axis=1)
            scale = np.stack([length, *[np.full(len(length), radius)] * 2], axis=1)
            turn = turns.steady(turns.shortest(x, along))
            yield Thing(f"{name} {k}", ((tube, colour[name]),), place, turn, scale)
            yield Thing(f"{name} node {a}", ((ball, colour[name]),), place, turns.STILL[None], size)
        last = nodes[:, -1] + lift
        yield Thing(f"{name} end", ((ball, colour[name]),), last, turns.STILL[None], size)
