"""From a run to its animation: the motion, the solids that follow it, the file."""

from itertools import product

import numpy as np

from trsim.errors import UsageError
from trsim.report.animation import (
    belts,
    bodies,
    curves,
    fittings,
    lines,
    ropes,
    threads,
    touched,
    wheels,
)
from trsim.report.animation.bodies import LONG
from trsim.report.animation.drawing import SLIDES, Array, Drawing
from trsim.report.animation.forces import arrows
from trsim.report.animation.glb import glb
from trsim.report.animation.motion import Motion, motion
from trsim.report.animation.reel import Film
from trsim.report.animation.things import Look, colours, kinds, look
from trsim.store.read import Run

AROUND, ABOVE = 50.0, 28.0  # deg, of the first view in space
MOST = 1e4  # times its size


def shoot(run: Run, magnified: float) -> Film:
    """The animation of a run; clearances `magnified` times their size."""
    if not 1.0 <= magnified <= MOST:
        raise UsageError(
            f"a clearance cannot be drawn {magnified:g} times its size",
            f"Give a number from 1 to {MOST:g}.",
        )
    moved = motion(run)
    sizes = look(moved.drawn)
    things = [
        *bodies.rails(moved, sizes),
        *fittings.supports(moved, sizes),
        *bodies.links(moved, sizes),
        *bodies.bars(moved, sizes),
        *lines.lines(moved, sizes),
        *curves.curves(moved, sizes),
        *wheels.wheels(moved, sizes),
        *wheels.racks(moved, sizes),
        *threads.worms(moved, sizes),
        *threads.screws(moved, sizes),
        *belts.belts(moved, sizes),
        *ropes.ropes(moved, sizes),
        *fittings.stops(moved, sizes),
        *touched.touched(moved, sizes),
        *fittings.pins(moved, sizes),
        *fittings.bearings(moved, sizes, magnified),
    ]
    forces, scale = arrows(run, moved, sizes, magnified)
    title = run.attributes["title"] or run.path.stem
    extras = {
        "title": title,
        "outermost": outermost(moved, sizes).tolist(),
        "margin": 2.5 * sizes.radius,
    }
    extras |= sight(sizes)
    playing = any(joint.picture == "journal" for joint in moved.drawn.joints)
    return Film(
        glb([*things, *forces], moved.time, extras),
        title,
        float(moved.time[0]),
        scale,
        magnified if playing else 1.0,
        moved.open,
        legend(moved.drawn),
        moved.warnings,
    )


def legend(drawn: Drawing) -> dict[str, str]:
    """Kind of body -> colour."""
    known = colours(drawn)
    return {kind: known[name] for name, kind in kinds(drawn).items()}


def sight(sizes: Look) -> dict[str, list[float]]:
    """Where the first view is from: the normal of a flat mechanism, or upwards and to who looks.

    In space it is oblique: no two of the axes fall together on the screen, and none is a point.
    """
    if sizes.normal is not None:
        return {"normal": sizes.normal.tolist()}
    up = sizes.up
    right = np.eye(3)[0] if abs(up[0]) < 0.9 else np.eye(3)[1]
    right = right - (right @ up) * up
    right /= np.linalg.norm(right)
    front, around, above = np.cross(right, up), np.deg2rad(AROUND), np.deg2rad(ABOVE)
    level = np.cos(around) * front + np.sin(around) * right
    back = np.cos(above) * level + np.sin(above) * up
    return {"up": up.tolist(), "back": back.tolist()}


def outermost(moved: Motion, sizes: Look) -> Array:
    """Places of joints, slides, centres and nodes that are farthest out, ever, (n, 3)."""
    places = [*moved.places.values(), *(line.reshape(-1, 3) for line in moved.nodes.values())]
    for joint in moved.drawn.joints:
        places += [moved.point(body, joint.at) for body in (joint.i, joint.j)]
        if joint.picture in SLIDES:
            places += beyond(moved.point(joint.j, joint.at), joint.axis, sizes)
    for line in moved.drawn.lines:
        first, second = moved.point(line.i, line.ends[0]), moved.point(line.j, line.ends[1])
        places += [first, second]
        if line.slide is not None:
            places += beyond(second, line.axes[line.slide], sizes)
    places += [moved.point(body, at) for body, at in moved.drawn.corners]
    for rack in moved.drawn.moving.racks:
        along = np.cross(moved.drawn.moving.wheels[rack.wheel].axis, rack.out)
        places += [moved.point(rack.body, rack.at + way * along)
                   for way in wheels.ends(moved, rack)]  # fmt: skip
    every = np.concatenate(places)
    ways = np.array(list(product((-1.0, 0.0, 1.0), repeat=3)))
    return every[np.unique(np.argmax(every @ ways.T, axis=0))]


def beyond(places: Array, axis: Array, sizes: Look) -> list[Array]:
    """The ends of a rail around places on it."""
    return [places + side * LONG * sizes.radius * axis for side in (-1.0, 1.0)]
