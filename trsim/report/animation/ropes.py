"""Ropes: straight parts, arcs on wheels, the wheels themselves, eyes, and ends."""

from collections.abc import Iterator
from itertools import pairwise

import numpy as np

from trsim.report.animation import solids, turns
from trsim.report.animation.drawing import GROUND, Array, Place, Rope
from trsim.report.animation.fittings import stand
from trsim.report.animation.motion import Motion
from trsim.report.animation.solids import Mesh
from trsim.report.animation.strands import Part, parts, wraps
from trsim.report.animation.things import PIN, SUPPORT, Look, Thing, colours
from trsim.report.animation.wires import arc, wire

X, Z = np.array([1.0, 0.0, 0.0]), np.array([0.0, 0.0, 1.0])
HEMP = "#8a6a3b"
THICK = 0.22  # half widths of a link: radius of a rope
STEP = 0.17  # rad, from one drawn place on a wheel to the next
SHORT = 0.35  # rad: of what may become shorter than that, no piece is kept as it is


def ropes(moved: Motion, look: Look) -> Iterator[Thing]:
    """Every rope in front of all its bodies, with what it goes over."""
    for rope in moved.drawn.ropes:
        lift = front(look, rope)
        centres = [np.broadcast_to(moved.point(place.body, place.at), (len(moved.time), 3)) + lift
                   for place in rope.places]  # fmt: skip
        bends = [place.bend for place in rope.places]
        found = parts(bends, centres)
        for k, part in enumerate(found):
            yield straight(f"{rope.name} part {k}", part, look, rope.name if k == 0 else "")
        for k, wrap in enumerate(wraps(bends, found), start=1):
            if bends[k]:
                yield from wound(f"{rope.name} arc {k}", look, bends[k], centres[k],
                                 found[k - 1], wrap)  # fmt: skip
        for k, place in enumerate(rope.places):
            last = k in (0, len(rope.places) - 1)
            yield from fitting(moved, look, f"{rope.name} place {k}", place, last, lift)


def front(look: Look, rope: Rope) -> Array:
    """Height of a rope over the plane of a flat mechanism, (3)."""
    if look.normal is None:
        return np.zeros(3)
    highest = max(look.height(place.body) for place in rope.places)
    return (highest + look.pitch) * look.normal


def straight(name: str, part: Part, look: Look, label: str) -> Thing:
    """A straight part, as long as it is."""
    d = part.end - part.begin
    length, thick = np.linalg.norm(d, axis=1), np.full(len(d), THICK * look.radius)
    turn = turns.steady(turns.shortest(X, d))
    scale = np.stack([length, thick, thick], axis=1)
    return Thing(name, ((solids.tube(), HEMP),), part.begin, turn, scale, label=label)


def wound(name: str, look: Look, bend: float, centre: Array, before: Part, wrap: Array
          ) -> Iterator[Thing]:  # fmt: skip
    """What lies along a wheel: pieces that keep their length, side by side and over each other."""
    least, most = float(wrap.min()), float(wrap.max())
    if most <= 0.0:
        return
    if least < SHORT:
        yield from chords(name, look, bend, centre, before, np.maximum(wrap, 0.0))
        return
    piece, sense = min(least, 2.0 * np.pi), np.sign(bend)
    count = int(np.ceil(most / piece - 1e-9))
    mesh = bow(look, abs(bend), piece)
    begin = before.angle - sense * 0.5 * np.pi  # where the rope comes on
    for k in range(count):
        ahead = (wrap - piece) * (k / max(count - 1, 1))
        # a mesh runs anticlockwise from x
        angle = begin + ahead if sense > 0.0 else begin - ahead - piece
        yield Thing(f"{name} {k}", ((mesh, HEMP),), centre, turns.of_vector(angle[:, None] * Z))


def bow(look: Look, radius: float, angle: float) -> Mesh:
    """A piece of a rope around z, anticlockwise from x."""
    if angle > 2.0 * np.pi - 1e-6:
        line = np.insert(solids.circle(radius, 48), 2, 0.0, axis=1)
        return wire(line, THICK * look.radius, Z, closed=True)
    line = arc(np.zeros(3), radius, 0.0, angle, np.eye(3), STEP)
    return wire(line, THICK * look.radius, Z)


def chords(name: str, look: Look, bend: float, centre: Array, before: Part, wrap: Array
           ) -> Iterator[Thing]:  # fmt: skip
    """The same where it may lie along next to nothing: straight pieces that grow."""
    count = max(int(np.ceil(wrap.max() / (2.0 * STEP))), 1)
    sense, radius = np.sign(bend), abs(bend)
    begin = before.angle - sense * 0.5 * np.pi
    places = []
    for k in range(count + 1):
        angle = begin + sense * k / count * wrap
        out = np.stack([np.cos(angle), np.sin(angle), np.zeros_like(angle)], axis=1)
        places.append(centre + radius * out)
    for k, (begins, ends) in enumerate(pairwise(places)):
        yield straight(f"{name} {k}", Part(begins, ends, before.angle), look, "")


def fitting(moved: Motion, look: Look, name: str, place: Place, last: bool, lift: Array
            ) -> Iterator[Thing]:  # fmt: skip
    """A wheel or a drum, an eye, or what an end is fast to."""
    at, turn = moved.point(place.body, place.at), moved.turn(place.body)
    colour, r = colours(moved.drawn)[place.body], look.radius
    reach = float(np.linalg.norm(lift)) - look.height(place.body) + 0.6 * look.pitch
    middle = lift - (0.5 * reach - 0.6 * look.pitch) * (
        look.normal if look.normal is not None else Z
    )
    if place.body == GROUND and look.normal is not None and (place.bend or last):
        yield Thing(f"{name} support", ((stand(look, look.normal), SUPPORT),), at, turn)
    axle = solids.cylinder(0.5 * r, max(reach, r), Z if look.normal is None else look.normal)
    if not place.bend:
        ring = solids.ball(0.6 * r) if last else solids.ring(0.35 * r, 0.75 * r, 0.5 * r, X)
        yield Thing(name, ((ring.moved(lift), PIN),), at, turn)
        return
    pieces = [(sheave(look, abs(place.bend)).moved(lift), colour), (axle.moved(middle), PIN)]
    if last:
        pieces.append((bow(look, abs(place.bend), 2.0 * np.pi).moved(lift), HEMP))
    yield Thing(name, tuple(pieces), at, turn)


def sheave(look: Look, radius: float) -> Mesh:
    """A wheel whose groove holds a rope with this radius to its middle."""
    rope, half = THICK * look.radius, 0.5 * look.thick
    low, high = radius - rope, radius + 1.3 * rope
    profile = np.array([
        [0.0, half, 0.0, 1.0], [high, half, 0.0, 1.0],
        [high, half, 1.0, 0.0], [high, 0.7 * half, 1.0, 0.0],
        [high, 0.7 * half, 0.0, -1.0], [low, 0.3 * half, 0.0, -1.0],
        [low, 0.3 * half, 1.0, 0.0], [low, -0.3 * half, 1.0, 0.0],
        [low, -0.3 * half, 0.0, 1.0], [high, -0.7 * half, 0.0, 1.0],
        [high, -0.7 * half, 1.0, 0.0], [high, -half, 1.0, 0.0],
        [high, -half, 0.0, -1.0], [0.0, -half, 0.0, -1.0],
    ])  # fmt: skip
    return solids.turned_profile(profile[::-1], Z, 48)
