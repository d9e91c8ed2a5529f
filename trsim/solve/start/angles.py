"""What goes with positions: the turn every angle is on, and the states that follow a joint."""

from dataclasses import replace
from math import isfinite, pi
from typing import Any

import numpy as np
from numpy.typing import NDArray

from trsim.assemble.equations import poses
from trsim.assemble.mechanism import Mechanism
from trsim.elements.contract import N_BOOK
from trsim.elements.prescribed import AnyDrive, rates_at
from trsim.elements.scene import Model, Scene, scene, workspace

Array = NDArray[np.float64]


def with_scene(mechanism: Mechanism) -> Any:
    """The mechanism with a scene for its model: one workspace, and angles that keep their turn."""
    work = scene(mechanism.model)
    for x in mechanism.coordinates.values():
        work.branch[x.entry] = x.drawn
    return replace(mechanism, model=work)


def posed(model: Model, y: Array) -> Scene:
    """The workspace of a model, at the poses of y."""
    w = workspace(model)
    poses(w, y)
    return w


def as_of(mechanism: Mechanism, y: Array) -> Array:
    """Positions and velocities of y as those of a mechanism with the same bodies; its z zero."""
    moving = mechanism.model.n_q + mechanism.model.n_v
    return np.append(y[:moving], np.zeros(mechanism.model.n_z))


def remember(model: Any, y: Array) -> None:
    """Let angles unwrap from their values at y on."""
    poses(model, y)
    model.branch[:] = model.S[:, 0]


def on_turns_of_drives(mechanism: Mechanism, y: Array) -> Array:
    """y with every angle that a rigid drive holds at t = 0 on the turn on which it is held.

    Seen from another one a joint would be full turns away from its place, and nothing would bring
    it nearer.  In space that is the branch of the angle; in the plane the bodies behind the joint
    are turned round, as often as it takes.
    """
    model: Any = mechanism.model
    y = y.copy()
    sign_of = {int(entry): int(sign) for entry, _, _, sign in model.turn}
    for instance in mechanism.instances:
        if instance.section != "drives" or instance.row.is_force:
            continue
        own = AnyDrive.of(instance.row)
        if own.state >= 0:
            continue
        entry = own.coordinate
        place, _, _ = rates_at(model.tab, own.motion, 0.0)
        if not isfinite(place):
            continue  # refused where the drive is first evaluated
        if entry in model.wound:
            turns = round((place - float(posed(model, y).S[entry, 0])) / (2.0 * pi))
            model.branch[entry] = place
            carry_along(mechanism, own, turns)
        elif entry in sign_of:
            turns = (
                round((place - float(posed(model, y).S[entry, 0])) / (2.0 * pi)) * sign_of[entry]
            )
            frames, way = behind(mechanism, own.i, own.j)
            for f in frames if turns else ():
                y[3 * (f - 1) + 2] += way * turns * 2.0 * pi
    return y


def carry_along(mechanism: Mechanism, own: Any, turns: int) -> None:
    """Count the turns of a drive in the angles in space that no joint has, about the same axis:
    as in the plane, those of bodies behind the joint against others."""
    model: Any = mechanism.model
    angles = [x for x in mechanism.coordinates.values() if x.kind == "angle"]
    (driven,) = (x for x in angles if x.entry == own.coordinate)
    frames, way = behind(mechanism, own.i, own.j)
    for x in angles if turns else ():
        along = round(sum(a * b for a, b in zip(x.axis, driven.axis, strict=True)), 6)
        if x.joint == "" and abs(along) == 1.0:
            sides = (x.j in frames) - (x.i in frames)
            model.branch[x.entry] += sides * way * along * turns * 2.0 * pi


def behind(mechanism: Mechanism, i: int, j: int) -> tuple[frozenset[int], int]:
    """The frames that turn about frame i when the joint between i and j does, and their way; if
    they hang on the ground those on its other side, the other way; of a loop frame j only."""
    joints = [x.row.con[:2] for x in mechanism.instances if x.section == "joints"]
    for first, other, way in ((j, i, 1), (i, j, -1)):
        found = {first}
        while more := {
            b
            for pair in joints
            for a, b in (pair, pair[::-1])
            if a in found and b not in found and {a, b} != {i, j}
        }:
            found |= more
        if not found & {0, other}:
            return frozenset(found), way
    return (frozenset({j}), 1) if j > 0 else (frozenset({i}), -1)


def strained(mechanism: Mechanism, held: Mechanism, y: Array) -> dict[int, float]:
    """How far ahead of their coordinates drives that give way hold still in an equilibrium.

    held, y: the mechanism as it was balanced, and its state there.  Of an actuator with a supply
    that was one spring, of which its piston takes the part behind the second body.
    """
    model = held.model
    w = posed(model, y)
    resting = {i.name: i.row for i in held.instances if i.section == "drives"}
    found = {}
    for instance in mechanism.instances:
        row, rest = instance.row, resting.get(instance.name)
        if instance.section != "drives" or not row.is_force or rest is None:
            continue
        own, held_by = AnyDrive.of(row), AnyDrive.of(rest)
        if held_by.state >= 0:
            f = float(y[model.n_q + model.n_v + held_by.state])
        else:
            f, _, _ = rates_at(model.tab, held_by.motion, 0.0)
        gap = f - float(w.S[held_by.coordinate, 0])
        if own.state >= 0:
            found[own.state] = gap
        if row.piston >= 0:
            found[row.piston] = gap * held_by.stiffness / own.stiffness
    return found


def follow(mechanism: Mechanism, y: Array) -> Array:
    """y with the states that start at a joint coordinate set to its value, or ahead of it."""
    model = mechanism.model
    y = y.copy()
    w = posed(model, y)
    for k, s in enumerate(mechanism.follows):
        if s >= 0:
            y[model.n_q + model.n_v + N_BOOK + k] = w.S[s, 0] + mechanism.ahead.get(N_BOOK + k, 0.0)
    return y
