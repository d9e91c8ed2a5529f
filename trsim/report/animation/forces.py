"""Contact forces as arrows whose tip is at the contact and whose length tells the force.

What is shown at a frame is the largest force since the frame before: an impact is shorter than the
time between two of them.  Without contact there is no arrow.
"""

from collections.abc import Iterator
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from trsim import elements
from trsim.elements.coordinates import split
from trsim.report.animation import solids, turns
from trsim.report.animation.drawing import Array, Joint
from trsim.report.animation.fittings import journal
from trsim.report.animation.motion import Motion
from trsim.report.animation.things import FORCE, Look, Thing
from trsim.store.read import Run

LONGEST = 0.55  # of the size of the mechanism
TYPICAL, USUAL = 90, 0.25  # percentile of the forces in contact, and its length
LONG_ENOUGH = 0.1  # for the largest force
HEAD = 0.8  # radius of an arrow's head, of the half width of a link; less where it is short


class Force(NamedTuple):
    """One contact over the frames."""

    name: str
    at: Array  # (n, 3) m
    vector: Array  # (n, 3) N, on the second body


def arrows(run: Run, moved: Motion, look: Look, magnified: float) -> tuple[list[Thing], float]:
    """An arrow for every contact that there was, and their scale, m/N; 0 where there was none."""
    found = [force for force in forces(run, moved, look, magnified) if force.vector.any()]
    sizes = [np.linalg.norm(force.vector, axis=1) for force in found]
    scale = metres_per_newton(np.concatenate(sizes), moved.drawn.size) if found else 0.0
    mesh, x = solids.arrow(), np.array([1.0, 0.0, 0.0])
    things = []
    for force, size in zip(found, sizes, strict=True):
        length = scale * size
        wide = np.minimum(HEAD * look.radius, 0.3 * length)
        vector = held(force.vector)
        turn = turns.steady(turns.shortest(x, vector))
        things.append(Thing(f"{force.name} force", ((mesh, FORCE),), force.at, turn,
                            np.stack([length, wide, wide], axis=1)))  # fmt: skip
    return things, scale


def metres_per_newton(sizes: Array, extent: float) -> float:
    """A round scale: the largest force fits beside the mechanism, usual ones are seen."""
    acting = sizes[sizes > 0.0]
    usual = USUAL / np.percentile(acting, TYPICAL)
    wanted = min(LONGEST / acting.max(), max(usual, LONG_ENOUGH / acting.max()))
    newtons = 1.0 / (wanted * extent)  # for a metre
    power = 10.0 ** np.floor(np.log10(newtons))
    return float(1.0 / (power * min(m for m in (1, 2, 5, 10) if m * power >= newtons)))


def forces(run: Run, moved: Motion, look: Look, magnified: float) -> Iterator[Force]:
    for joint in moved.drawn.joints:
        if joint.picture == "journal" and f"{joint.name}.force" in run.units:
            vector = largest(run.channel(f"{joint.name}.force"), moved.rows)
            yield Force(joint.name, contact(moved, joint, look, magnified), vector)
    for name, spec in moved.drawn.scenario.forces.items():
        channel = f"{name}.force"
        picture = elements.load(spec.type).picture
        if picture not in ("stop", "touch") or run.units.get(channel) != "N":
            continue  # that of an angle is a torque
        touches = picture == "touch"
        body, at = (spec.ball.body, np.array(spec.ball.at)) if touches else stop_point(moved, spec)
        if moved.drawn.has(body):
            place = moved.point(body, at)
            if look.normal is not None:
                place = place + look.height(body) * look.normal
            place = np.broadcast_to(place, (len(moved.time), 3))
            yield Force(name, place, largest(run.channel(channel), moved.rows))


def stop_point(moved: Motion, spec: object) -> tuple[str, Array]:
    """Body and point, as drawn, that a stop pushes."""
    point, name = spec.point, spec.joint  # type: ignore[attr-defined]
    if point is not None:
        return point.body, np.array(point.at)
    name, _ = split(name, moved.drawn.scenario.joints)
    joint = next((one for one in moved.drawn.joints if one.name == name), None)
    return (joint.j, joint.at) if joint is not None else ("", np.zeros(3))


def contact(moved: Motion, joint: Joint, look: Look, magnified: float) -> Array:
    """Where the journal touches its bearing, as both are drawn, (n, 3)."""
    play = moved.plays[joint.name]
    size = np.linalg.norm(play, axis=1, keepdims=True)
    out = play / np.where(size > 0.0, size, 1.0)
    lift = np.zeros(3) if look.normal is None else look.front(joint.i, joint.j) * look.normal
    radius = journal(joint, look)
    return moved.point(joint.i, joint.at) + magnified * play + radius * out + lift


def largest(vectors: Array, rows: NDArray[np.int64]) -> Array:
    """The longest vector of the rows since the frame before; (frames, 3)."""
    sizes = np.sum(vectors**2, axis=1)
    first = np.concatenate([[0], rows[:-1] + 1])
    return np.stack([vectors[a + int(sizes[a : b + 1].argmax())]
                     for a, b in zip(first, rows, strict=True)])  # fmt: skip


def held(vectors: Array) -> Array:
    """The vectors (n, 3), and where they are zero the last or the next that is not."""
    acting = np.flatnonzero(vectors.any(axis=1))
    before = np.searchsorted(acting, np.arange(len(vectors)), side="right") - 1
    return vectors[acting[np.maximum(before, 0)]]
