"""Teeth of wheels that are drawn: how many, and where they stand so that they mesh.

All wheels of a train have one pitch p = 2 pi r/z.  Where no numbers of teeth are known they are
taken such that they are whole; where that cannot be, or there were too many, the wheels are smooth.

Two wheels that touch share their outline there: what stands out of the one is a gap of the other.
"""

from collections.abc import Sequence

import numpy as np

from trsim.report.animation.drawing import Array, Belt, Mesh, Wheel
from trsim.report.animation.solids import frame

MOST = 90  # teeth of a wheel that are drawn
USUAL = range(14, 31)  # of the smallest wheel where nobody gave any
WHOLE = 2e-3  # of a tooth


def toothed(wheels: Sequence[Wheel], meshes: Sequence[Mesh], belts: Sequence[Belt],
            counts: dict[int, int]) -> list[Wheel]:  # fmt: skip
    """The wheels with the number of their train, their teeth and where these stand.

    counts: wheel -> teeth, of those that are known.
    """
    made = list(wheels)
    pairs = [(mesh.first, mesh.second) for mesh in meshes if mesh.second >= 0]
    for members in together(len(wheels), pairs):
        found = numbers([wheels[k] for k in members], [counts.get(k, 0) for k in members])
        meshing = any(k in (mesh.first, mesh.second) for k in members for mesh in meshes)
        meshing = meshing or any(k in counts for k in members)  # with a worm
        for k, teeth in zip(members, found, strict=True):
            made[k] = wheels[k]._replace(teeth=teeth if meshing else 0)
    pairs += [(belt.first, belt.second) for belt in belts]
    for train, members in enumerate(together(len(wheels), pairs)):
        for k in members:
            made[k] = made[k]._replace(train=train)
    return phased(made, meshes)


def together(count: int, pairs: Sequence[tuple[int, int]]) -> list[list[int]]:
    """Numbers that pairs join one by one."""
    label = list(range(count))
    for first, second in pairs:
        old, new = label[second], label[first]
        label = [new if one == old else one for one in label]
    return [[k for k in range(count) if label[k] == one] for one in dict.fromkeys(label)]


def numbers(wheels: Sequence[Wheel], known: Sequence[int]) -> list[int]:
    """Numbers of teeth of one pitch; zeros where there are none."""
    radii = np.array([wheel.radius for wheel in wheels])
    given = [(count, wheel.radius) for count, wheel in zip(known, wheels, strict=True) if count]
    tried = [count / radius for count, radius in given] or [z / radii.min() for z in USUAL]
    for per_length in tried[:1] if given else tried:
        teeth = np.round(radii * per_length)
        if np.abs(radii * per_length - teeth).max() < WHOLE and teeth.min() >= 4:
            return [int(z) for z in teeth] if teeth.max() <= MOST else [0] * len(wheels)
    return [0] * len(wheels)


def phased(wheels: list[Wheel], meshes: Sequence[Mesh]) -> list[Wheel]:
    """The same with teeth that mesh as drawn, from the first wheel of each train on."""
    made, done = list(wheels), set()
    for start in range(len(made)):
        waiting = [] if start in done else [start]
        done.add(start)
        while waiting:
            k = waiting.pop()
            for mesh in meshes:
                other = {mesh.first: mesh.second, mesh.second: mesh.first}.get(k, -1)
                if other >= 0 and other not in done and made[k].teeth and made[other].teeth:
                    made[other] = beside(made[k], made[other], mesh.at)
                    done.add(other)
                    waiting.append(other)
    return made


def beside(one: Wheel, other: Wheel, at: Array) -> Wheel:
    """The other wheel with a gap where the first has a tooth, seen from their pitch point."""
    here, along = towards(one, at)
    there, onward = towards(other, at)
    ahead = (one.phase - here) * one.radius  # of the pitch point, to a tooth of the first
    if not (one.hollow or other.hollow):
        ahead += np.pi * one.radius / one.teeth
    sense = 1.0 if along @ onward > 0.0 else -1.0
    return other._replace(phase=there + sense * ahead / other.radius)


def towards(wheel: Wheel, at: Array) -> tuple[float, Array]:
    """The angle at which a wheel has a point, and the way its rim goes there."""
    x, y, axis = frame(wheel.axis)
    out = at - wheel.at
    return float(np.arctan2(out @ y, out @ x)), np.cross(axis, out)
