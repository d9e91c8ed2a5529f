"""Belts over two pulleys: a band on the carrier, and marks that go around with it."""

from collections.abc import Iterator
from typing import NamedTuple

import numpy as np

from trsim.report.animation import solids, turns
from trsim.report.animation.drawing import Array, Belt, Wheel
from trsim.report.animation.motion import Motion
from trsim.report.animation.plates import annulus
from trsim.report.animation.solids import frame
from trsim.report.animation.strands import parts
from trsim.report.animation.things import PIN, STOP, Look, Thing, origin, pose
from trsim.report.animation.wheels import width

STEP = 0.13  # rad, from one drawn place on a pulley to the next
MARKS = 3
THICK = 0.25  # half widths of a link


class Path(NamedTuple):
    """The middle of a belt in a plane across the axis of its first pulley; closed."""

    place: Array  # (n, 2) m, from the middle of the first pulley
    left: Array  # (n, 2) unit vectors to the left of it
    way: Array  # (n) m, from the first place
    length: float  # m


def belts(moved: Motion, look: Look) -> Iterator[Thing]:
    """Every belt, and what shows that it moves."""
    drawn = moved.drawn
    for belt in drawn.moving.belts:
        first = drawn.moving.wheels[belt.first]
        axes, path = frame(first.axis), course(belt, *pulleys(moved, belt))
        half, wide = THICK * look.radius, 0.8 * width(first, look)
        at = first.at - origin(drawn, belt.carrier) + look.level(first.train)
        mesh = annulus(path.place - half * path.left, path.place + half * path.left, wide, axes)
        yield Thing(f"{belt.name} belt", ((mesh.moved(at), STOP),), *pose(moved, belt.carrier))
        mark = solids.box(np.array([4.0 * half, 3.0 * half, 1.05 * wide]), np.eye(3))
        for k in range(MARKS):
            here = travel(moved, first) + path.length * k / MARKS
            place, turn = along(path, here, axes)
            carrier = moved.turn(belt.carrier)
            middle = moved.point(belt.carrier, first.at) + turns.turned(carrier, place)
            middle = middle + look.level(first.train)
            whole = turns.steady(turns.product(np.broadcast_to(carrier, turn.shape), turn))
            yield Thing(f"{belt.name} mark {k}", ((mark, PIN),), middle, whole)


def pulleys(moved: Motion, belt: Belt) -> tuple[Wheel, Wheel]:
    wheels = moved.drawn.moving.wheels
    return wheels[belt.first], wheels[belt.second]


def course(belt: Belt, first: Wheel, second: Wheel) -> Path:
    """Anticlockwise around the first pulley: two straight parts, two arcs."""
    middle = np.array([0.0, 0.0, 0.0]), frame(first.axis) @ (second.at - first.at)
    centres = [middle[0][None], np.array([[*middle[1][:2], 0.0]])]
    bends = [first.radius, -second.radius if belt.crossed else second.radius]
    (go,), (come,) = parts(bends, centres), parts(bends[::-1], centres[::-1])
    places, lefts, steps = [], [], [0.0]
    for bend, centre, begin, end in (
        (bends[0], centres[0], come, go),
        (bends[1], centres[1], go, come),
    ):
        sense = np.sign(bend)
        sweep = float(sense * (end.angle[0] - begin.angle[0])) % (2.0 * np.pi)
        start = begin.angle[0] - sense * 0.5 * np.pi  # of the place on the pulley
        angle = start + sense * np.linspace(0.0, sweep, max(int(np.ceil(sweep / STEP)), 1) + 1)
        out = np.stack([np.cos(angle), np.sin(angle)], axis=1)
        places.append(centre[0, :2] + abs(bend) * out)
        lefts.append(-sense * out)
        length = float(np.linalg.norm(end.end[0] - end.begin[0]))
        steps += [*np.full(len(angle) - 1, abs(bend) * sweep / (len(angle) - 1)), length]
    way = np.cumsum(steps)
    return Path(np.concatenate(places), np.concatenate(lefts), way[:-1], float(way[-1]))


def travel(moved: Motion, wheel: Wheel) -> Array:
    """How far the rim of a pulley has gone against its carrier since it was drawn, (n) m."""
    return wheel.radius * angle(moved, wheel)


def angle(moved: Motion, wheel: Wheel) -> Array:
    """How far a wheel has turned against its carrier since it was drawn, (n) rad."""
    q = turns.product(turns.back(moved.turn(wheel.carrier)), moved.turn(wheel.body))
    half = np.arctan2(q[:, :3] @ wheel.axis, q[:, 3])
    return np.asarray(np.unwrap(2.0 * half, period=2.0 * np.pi))


def along(path: Path, way: Array, axes: Array) -> tuple[Array, Array]:
    """Places on a belt, from the middle of its first pulley, and turns there, as drawn."""
    closed = np.append(path.way, path.length)
    at = np.mod(way, path.length)
    k = np.clip(np.searchsorted(closed, at, side="right") - 1, 0, len(path.way) - 1)
    part = ((at - closed[k]) / np.maximum(closed[k + 1] - closed[k], 1e-300))[:, None]
    n = (k + 1) % len(path.way)
    place = (1.0 - part) * path.place[k] + part * path.place[n]
    left = (1.0 - part) * path.left[k] + part * path.left[n]
    left /= np.linalg.norm(left, axis=1, keepdims=True)
    ahead = np.stack([left[:, 1], -left[:, 0]], axis=1) @ axes[:2]
    R = np.stack([ahead, left @ axes[:2], np.broadcast_to(axes[2], ahead.shape)], axis=2)
    return place @ axes[:2], turns.of_matrices(R)
