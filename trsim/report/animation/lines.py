"""Actuators, springs, bushings and links as solids between the bodies they act on."""

from collections.abc import Iterator

import numpy as np

from trsim.report.animation import solids, turns
from trsim.report.animation.drawing import GROUND, Array, Line
from trsim.report.animation.motion import Motion
from trsim.report.animation.things import PIN, STOP, SUPPORT, Look, Thing

X = np.array([1.0, 0.0, 0.0])
PULLED_IN = 0.85  # length of a cylinder, of the actuator where it is shortest
COILS = 8
STEEL = "#7f8790"


def lines(moved: Motion, look: Look) -> Iterator[Thing]:
    """Every line of the mechanism; in a flat one in front of the bodies it acts on."""
    kinds = {"cylinder": actuator, "coil": spring, "block": bushing, "rod": link}
    for line in moved.drawn.lines:
        yield from kinds[line.picture](moved, look, line)


def course(moved: Motion, look: Look, line: Line) -> tuple[Array, Array, Array, Array]:
    """First end, vector to the second, the turn of x along it, its length; (n, .)."""
    a, b = (moved.point(body, at) for body, at in zip((line.i, line.j), line.ends, strict=True))
    if look.normal is not None:
        a = a + look.front(line.i, line.j) * look.normal
        b = b + look.front(line.i, line.j) * look.normal
    along = b - a
    turn = turns.steady(turns.shortest(X, along))
    return np.broadcast_to(a, along.shape), along, turn, np.linalg.norm(along, axis=1)


def actuator(moved: Motion, look: Look, line: Line) -> Iterator[Thing]:
    """A cylinder on the first body, a rod out of it, and a ball at each end."""
    a, along, turn, length = course(moved, look, line)
    r, inside = look.radius, PULLED_IN * length.min()
    cylinder = solids.cylinder(1.2 * r, inside, X).moved(0.5 * inside * X)
    foot, head = solids.ball(1.3 * r), solids.ball(r)
    grey = SUPPORT if line.i == GROUND else PIN
    yield Thing(line.name, ((cylinder, STOP), (foot, grey)), a, turn, label=line.name)
    # what of the rod is in the cylinder is not seen
    size = np.stack([length, *[np.full(len(length), 0.6 * r)] * 2], axis=1)
    yield Thing(f"{line.name} rod", ((solids.tube(), SUPPORT),), a, turn, size)
    yield Thing(f"{line.name} head", ((head, PIN),), a + along, turns.STILL[None])


def spring(moved: Motion, look: Look, line: Line) -> Iterator[Thing]:
    """A coil that is stretched; none between points that never part."""
    a, _, turn, length = course(moved, look, line)
    r, usual = look.radius, float(length.max())
    if usual < 0.1 * r:  # its ends are in one place, and rounding gives their direction
        return
    coil = solids.coil(usual, 0.8 * r, 0.15 * r, COILS)
    size = np.stack([length / usual, *[np.ones(len(length))] * 2], axis=1)
    yield Thing(line.name, ((coil, STEEL),), a, turn, size, label=line.name)


def link(moved: Motion, look: Look, line: Line) -> Iterator[Thing]:
    """A rod with a ball at each end."""
    a, along, turn, length = course(moved, look, line)
    r, ball = look.radius, solids.ball(look.radius)
    yield Thing(line.name, ((ball, PIN),), a, turn, label=line.name)
    size = np.stack([length, *[np.full(len(length), 0.5 * r)] * 2], axis=1)
    yield Thing(f"{line.name} rod", ((solids.tube(), SUPPORT),), a, turn, size)
    yield Thing(f"{line.name} head", ((ball, PIN),), a + along, turns.STILL[None])


def bushing(moved: Motion, look: Look, line: Line) -> Iterator[Thing]:
    """A block on the second body, long where it slides."""
    sides = np.full(3, 2.6 * look.radius)
    if line.slide is not None:
        sides[line.slide] *= 2.0
    place, turn = moved.point(line.j, line.ends[1]), moved.turn(line.j)
    if look.normal is not None:
        place = place + look.height(line.j) * look.normal
    block = solids.box(sides, line.axes)
    yield Thing(line.name, ((block, STOP),), place, turn, label=line.name)
