"""The door drawn from the side, as runs have it: closed, lifted, half open and opened."""

from typing import Any, NamedTuple

import numpy as np

from trsim.arrays import Array
from trsim.report.animation.motion import Motion, motion
from trsim.report.display import Shown
from trsim.report.style import panels
from trsim.studies.drawing import Drawn, lettered

LEAN = np.radians(15.0)  # of the door, from upright
BLADE, MECHANISM, HAND, COUNTER, ROPE = "#9fb4c9", "#2f7fc1", "#e07b28", "#2a9d78", "#b3202a"
GROUND = "#555a63"
GUIDE = ((7.002e-3, 1.78205), (-79.777e-3, 1.810246), (-63.721e-3, 1.706209))  # its corners
LINE, FILL = 1.6, 0.45


class Part(NamedTuple):
    """A line through points (y, z) of a body as drawn, or a filled outline."""

    body: str
    points: tuple[tuple[float, float], ...]
    colour: str
    filled: bool = False


PARTS = (
    Part("door", ((-0.03, 0.05), (-0.03, 1.93), (-0.12, 1.93), (-0.12, 0.05)), BLADE, True),
    Part("yoke", ((0, 0), (0.10, 0.16), (0.10, 0.44), (-0.02, 0.36), (0, 0)), MECHANISM),
    Part("link_upper", ((0.10, 0.44), (-0.055247, 0.401293)), MECHANISM),
    Part("link_low_fwd", ((0.10, 0.16), (-0.055247, 0.121293)), MECHANISM),
    Part("latch", ((-0.04, 0.62), (-0.04, 0.682)), HAND),
    Part("lift_rod", ((-0.04, 0.682), (-0.02, 0.36)), MECHANISM),
    Part("gearbox_in", ((-0.03, 0.74), (0.03818, 0.68924)), HAND),
    Part("rod_P7P10", ((0.03818, 0.68924), (0.05304, 1.05075)), MECHANISM),
    Part("inner_handle", ((0.05304, 1.05075), (-0.01, 1.10), (0.04209, 0.80456)), HAND),
    Part("rod_P2P6", ((0.04745, 1.05179), (-0.01484, 1.2769)), MECHANISM),
    Part("outer_handle", ((-0.01484, 1.2769), (-0.07, 1.32), (-0.11341, 1.5662)), HAND),
    Part("cb_arm", ((0.345, 0.84), (-0.00763, 1.558089)), COUNTER),
    Part("cb_rod", ((-0.00763, 1.558089), (0.05, 0.69)), COUNTER),
    Part("jett_handle", ((0.0102, 1.0376), (0.14, 1.09), (0.265, 0.87349)), HAND),
    Part("jett_shaft", ((-0.01, 1.10), (0.03596, 1.06143)), HAND),
)
LINES = (  # between a point of a body and one of the fuselage
    ("cb_arm", (0.32501, 0.97452), (0.90, 1.415), COUNTER, ":"),
    ("door", (0.05, 0.69), (0.02, 1.30), ROPE, "--"),
)
ROLLER = (0.0, 1.75)
STATES = (("closed and locked", 0, 0.0), ("lifted, before it opens", 1, 0.0),
          ("half open", 1, 0.5), ("opened", 1, 1.0))  # fmt: skip


def figure(shown: list[Shown]) -> Any:
    """Side views, seen from aft: outboard is on the left."""
    moves = [motion(one.run) for one in shown]
    drawn, axes = panels(2, 2, height=3.1, width=6.8)
    for a, (text, of, share), letter in zip(axes.flat, STATES, "abcd", strict=True):
        k = round(share * (len(shown[of].run.time) - 1))
        view(a, moves[of], k)
        lettered(a, letter, text)
    return drawn


def world(points: Any) -> Array:
    """Points (y, z) of the drawing, in the world, with x = 0."""
    y, z = np.atleast_2d(np.asarray(points)).T
    c, s = np.cos(LEAN), np.sin(LEAN)
    return np.stack([np.zeros_like(y), c * y - s * z, s * y + c * z], axis=1)


def placed(moved: Motion, k: int, body: str, points: Any) -> Array:
    """Where points of a body are in a frame, (n, 2)."""
    found = [moved.point(body, at) for at in world(points)]
    return np.array([(p[k] if len(p) > 1 else p[0])[1:] for p in found])


def view(axes: Any, moved: Motion, k: int) -> None:
    """One frame."""
    for part in PARTS:
        y, z = placed(moved, k, part.body, part.points).T
        if part.filled:
            axes.fill(y, z, color=part.colour, alpha=FILL, lw=0)
        else:
            axes.plot(y, z, color=part.colour, lw=LINE, solid_capstyle="round")
    for body, there, fuselage, colour, dash in LINES:
        y, z = np.vstack([placed(moved, k, body, [there]), world([fuselage])[:, 1:]]).T
        axes.plot(y, z, dash, color=colour, lw=1.0)
    y, z = placed(moved, k, "door", [ROLLER])[0]
    axes.plot(y, z, "o", ms=3, color=BLADE, mec=GROUND, mew=0.6)
    axes.fill(*world(GUIDE)[:, 1:].T, color=GROUND, lw=0)
    for at in ((0.0, 0.0), (0.345, 0.84), (0.14, 1.09), (0.90, 1.415), (0.02, 1.30)):
        y, z = world([at])[0, 1:]
        axes.plot(y, z, "^", ms=4, color=GROUND)
    axes.set_aspect("equal")
    axes.set_xlim(-2.15, 0.75)
    axes.set_ylim(-0.95, 1.95)
    axes.set_xlabel("outboard   y (m)   inboard")
    axes.set_ylabel("z (m)")


FIGURE = Drawn("of the door", "abcd", "The mechanism from the side: blade grey, handles and latch "
               "orange, links and rods blue, counterbalance green, wire dashed, the cam and places "
               "on the fuselage dark.",
               (("lifting", "lift_inner"), ("opening", "open")), figure)  # fmt: skip
