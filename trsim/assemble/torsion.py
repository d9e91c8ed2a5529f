"""What flexible bars in space would need torsion for: refused by name, since they have none.

A bar passes no twist on: what is welded to it is held but for its turn about the tangent.  Welds to
rigid bodies (the ground is one) along a bar, or along bars welded end to end, are its holders.  The
torsion of the bar would act where two holders turn against each other about it,

    r = (omega_b - omega_a) . t          a, b holders; t the tangent as drawn

so it is missing unless r = 0 for every motion the joints allow: r is then a combination of their
rows.  Drives and locks do not count, since it is they who would feel the torsion.  It is not
missed either

    in a plane    where nothing reaches out of the plane of the drawing (planar.py)
    by what idles a holder whose turn about the bar nobody feels and nobody sees: round about the
                  bar's line, pushed on that line only, and not turning at the start
"""

from itertools import combinations
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from trsim.assemble.addresses import Addresses
from trsim.assemble.instances import Instance
from trsim.assemble.planar import in_plane_states, lasting, reaching_out
from trsim.assemble.reduce import Drawn
from trsim.elements.scene import Model
from trsim.errors import ModelError

Array = NDArray[np.float64]

FREE = 1e-6  # of a turn: what is left of it beside the rows of the joints
ROUND = 1e-9  # of an inertia, of a length


class Holder(NamedTuple):
    """A weld of a bar to a rigid body."""

    joint: str
    bar: str
    node: int
    body: int


def check_torsion(drawn: Drawn, at: Addresses, instances: list[Instance]) -> None:
    """Raises ModelError for a weld that only torsion of a bar would hold.

    drawn: with all rows of joints and drives.
    """
    full, rows = drawn.scene, drawn.rows
    bars = holders(at, instances)
    pairs = [pair for found in bars for pair in combinations(found, 2) if differ(*pair)]
    if not pairs or not reaching_out(drawn, in_plane_states(drawn), at, instances):
        return
    held = [k for k in lasting(instances, at, rows) if is_joint(instances[rows[k].instance])]
    J = (drawn.J[held] * drawn.scale).T
    for a, b in pairs:
        r = turn(full, a, b, np.array(at.tangent(a.node))) * drawn.scale
        left = r - J @ np.linalg.lstsq(J, r, rcond=1e-10)[0] if held else r
        if np.linalg.norm(left) <= FREE * np.linalg.norm(r):
            continue
        busy = [one for one in (a, b) if one.body and not idles(one, at, instances)]
        if busy and (len(busy) == 2 or a.body == 0 or b.body == 0):
            raise ModelError(*refusal(busy[-1], at), ("joints", busy[-1].joint))


def refusal(one: Holder, at: Addresses) -> tuple[str, str]:
    """What is wrong with a weld, and what to do about it."""
    body, bar = at.owners[one.body], one.bar
    return (
        f"does not hold the turn of '{body}' about '{bar}': a flexible bar in space has no "
        "torsion, and no joint stops this turn",
        f"guide '{body}' by a joint that holds it, join the bar by `spherical`, make the bar "
        "rigid (`flexible: false`), or draw the mechanism in the x-y plane",
    )


def is_joint(instance: Instance) -> bool:
    """Whether rows of an instance are those of a joint: no drive, no lock."""
    return instance.section == "joints"


def differ(a: Holder, b: Holder) -> bool:
    """Whether two holders can turn against each other at all."""
    return a.body != b.body


def holders(at: Addresses, instances: list[Instance]) -> list[list[Holder]]:
    """The holders of each bar, or of each line of bars that are welded to each other."""
    line = {name: name for name in at.beams}
    found = []
    for instance in instances:
        if not instance.element.welds:
            continue
        i, j = instance.row.con[:2]
        if at.is_node(i) and at.is_node(j):
            one, other = line[at.owners[i]], line[at.owners[j]]
            line = {name: one if first == other else first for name, first in line.items()}
        elif at.is_node(i) or at.is_node(j):
            node, body = (i, j) if at.is_node(i) else (j, i)
            found.append(Holder(instance.name, at.owners[node], node, body))
    return [[one for one in found if line[one.bar] == first] for first in set(line.values())]


def turn(full: Model, a: Holder, b: Holder, t: Array) -> Array:
    """r of two holders, against the world-axes rates of the moving frames (6 (n-1))."""
    r = np.zeros((full.n, 6))
    r[b.body, 3:] += t
    r[a.body, 3:] -= t
    return r[1:].ravel()


# --- whose turn nobody feels ---------------------------------------------------------------------


def idles(one: Holder, at: Addresses, instances: list[Instance]) -> bool:
    """Whether a turn of a holder about its bar changes nothing: see above."""
    place, t = at.at_start[one.node], np.array(at.tangent(one.node))
    welded = cluster(one.body, at, instances)
    if 0 in welded:
        return False
    return all(is_round(body, at, place, t) for body in welded) and not any(
        feels(instance, at, welded, place, t) for instance in instances
    )


def cluster(body: int, at: Addresses, instances: list[Instance]) -> set[int]:
    """A body and all rigid bodies that are welded to it."""
    found = {body}
    welds = [i.row.con[:2] for i in instances if i.element.welds]
    pairs = [pair for pair in welds if not at.is_node(pair[0]) and not at.is_node(pair[1])]
    for _ in pairs:
        found |= {other for pair in pairs if found & {*pair} for other in pair}
    return found


def is_round(body: int, at: Addresses, place: Array, t: Array) -> bool:
    """Whether a body is the same all around a line, and does not turn about it at the start."""
    spec = at.members[at.owners[body]]
    R = at.rotation[body]
    I = R @ np.array(spec.tensor[0]).reshape(3, 3) @ R.T
    along = t @ I @ t
    across = 0.5 * (np.trace(I) - along)
    like = along * np.outer(t, t) + across * (np.eye(3) - np.outer(t, t))
    return bool(
        np.abs(I - like).max() <= ROUND * np.abs(I).max()
        and on_line(at.at_start[body], place, t, at)
        and np.dot(spec.angular_velocity, t) == 0.0
    )


def on_line(point: Array, place: Array, t: Array, at: Addresses) -> bool:
    """Whether a point lies on a line, to what a drawing is rounded to."""
    d = np.asarray(point) - place
    size = max(float(np.abs(at.at_start).max()), float(np.linalg.norm(d)))
    return bool(np.linalg.norm(np.cross(d, t)) <= ROUND * size)


def feels(instance: Instance, at: Addresses, bodies: set[int], place: Array, t: Array) -> bool:
    """Whether an element depends on how bodies turn about a line, or turns them about it."""
    con, own = instance.row.con, instance.turning
    if instance.element.welds:
        node = next((f for f in con[:2] if at.is_node(f)), None)
        if node is None or not bodies & {*con[:2]}:
            return False
        straight = abs(np.dot(at.tangent(node), t)) > 1.0 - ROUND
        return not (straight and on_line(at.at_start[node], place, t, at))
    if bodies.intersection(own.frames) or any(frame in bodies for frame, _ in own.axes):
        return True
    return any(
        frame in bodies
        and not on_line(at.at_start[frame] + at.rotation[frame] @ np.array(s), place, t, at)
        for frame, s in own.points
    )
