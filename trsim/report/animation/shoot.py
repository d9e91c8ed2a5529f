"""From a run to its animation: the motion, the solids that follow it, the file."""

from itertools import product

import numpy as np

from trsim.errors import UsageError
from trsim.report.animation import Film, bodies, fittings
from trsim.report.animation.bodies import LONG
from trsim.report.animation.drawing import GROUND, Array
from trsim.report.animation.forces import arrows
from trsim.report.animation.glb import glb
from trsim.report.animation.motion import Motion, motion
from trsim.report.animation.things import Look, colours, look
from trsim.store.read import Run

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
        *fittings.stops(moved, sizes),
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
    if sizes.normal is not None:
        extras["normal"] = sizes.normal.tolist()
    playing = any(joint.type == "clearance_joint" for joint in moved.drawn.joints)
    return Film(
        glb([*things, *forces], moved.time, extras),
        title,
        float(moved.time[0]),
        scale,
        magnified if playing else 1.0,
        moved.open,
        {name: colour for name, colour in colours(moved.drawn).items() if name != GROUND},
        moved.warnings,
    )


def outermost(moved: Motion, sizes: Look) -> Array:
    """Places of joints, slides, centres and nodes that are farthest out, ever, (n, 3)."""
    places = [*moved.places.values(), *(line.reshape(-1, 3) for line in moved.nodes.values())]
    for joint in moved.drawn.joints:
        places += [moved.point(body, joint.at) for body in (joint.i, joint.j)]
        if joint.type == "prismatic":
            ahead = LONG * sizes.radius * joint.axis
            places += [moved.point(joint.j, joint.at) + side * ahead for side in (-1.0, 1.0)]
    every = np.concatenate(places)
    ways = np.array(list(product((-1.0, 0.0, 1.0), repeat=3)))
    return every[np.unique(np.argmax(every @ ways.T, axis=0))]
