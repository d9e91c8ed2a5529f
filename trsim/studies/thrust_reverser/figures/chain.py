"""Figure 1: the chain from the side, as a run has it, and what spring and lug make of it."""

from typing import Any, NamedTuple

import numpy as np

from trsim.arrays import Array
from trsim.report.animation.motion import Motion, motion
from trsim.report.display import Shown
from trsim.report.style import colour, panels
from trsim.studies.drawing import Drawn, lettered
from trsim.studies.thrust_reverser.figures.mechanism import COWL, DOOR, GROUND, HOUSING, LINK, ROD

TIMES = (0.0, 0.3, 1.0)  # s: at the start, at the touch of the lug, at the end
HULL = np.array([[-0.272, 0.262], [0.528, 0.262], [0.528, 0.288], [-0.272, 0.288]])  # m, as drawn
LUG = np.array([-0.094784, 0.156003])  # m: its end, as drawn
NAMED = {"A": (-8, 6), "B": (-7, -8), "P": (-9, 4), "Q": (8, 5)}  # points, of the letters
BESIDE = 9.0  # points, of a number from its line
WITH = ("spring and lug", "no spring", "no lug", "neither")  # two cases each, at rest and swung
STARTS = (
    *((WITH[0], "ideal"), ("", "kicked"), (WITH[1], "no_spring"), ("", "no_spring_kicked")),
    *((WITH[2], "no_lug"), ("", "no_lug_kicked"), (WITH[3], "neither"), ("", "neither_kicked")),
)


class Part(NamedTuple):
    """A line between two joints or points of a body, with the number it has in the study."""

    body: str
    ends: tuple[str, str]
    number: str
    colour: str
    along: float = 0.5  # of the line, where the number stands


PARTS = (
    Part("door", ("B", "Q"), "8", DOOR),
    Part("large_rod", ("A", "P"), "2", ROD),
    Part("transfer", ("P", "Q"), "3", LINK),
    Part("transfer", ("P", "lug"), "7", LINK, 1.0),
)


def figure_1(shown: list[Shown]) -> Any:
    """The chain at three times; below, the door from two starts each, with and without them."""
    figure, grid = panels(2, 1, height=2.3, width=7.6, height_ratios=(0.8, 1.0))
    rows = [a.get_subplotspec() for a in grid[:, 0]]
    for a in grid[:, 0]:
        a.remove()
    upper = rows[0].subgridspec(1, len(TIMES)).subplots(sharex=True, sharey=True)
    moved = motion(shown[0].run)
    for k, (a, t) in enumerate(zip(upper, TIMES, strict=True)):
        side(a, moved, t)
        a.set_title(f"{t:g} s", loc="center")
        a.tick_params(labelleft=k == 0)
    upper[0].set_ylabel("y, outward (m)")
    upper[1].set_xlabel("x, aft (m)")
    starts(rows[1].subgridspec(1, len(WITH)).subplots(sharex=True, sharey=True), shown[1:])
    return figure


def side(axes: Any, moved: Motion, t: float) -> None:
    """The chain at one time."""
    k = int(np.argmin(np.abs(moved.time - t)))
    at = {joint.name: joint.at for joint in moved.drawn.joints} | {"lug": np.append(LUG, 0.0)}

    def where(body: str, point: Array) -> Array:
        found = moved.point(body, point)
        return np.asarray(found[min(k, len(found) - 1)][:2])

    hull = np.array([where("fairing", np.append(corner, 0.0)) for corner in HULL])
    axes.fill(*hull.T, color=COWL)
    label(axes, hull[0], "4", (12, 6), "#33475b")
    for part in PARTS:
        ends = np.array([where(part.body, at[name]) for name in part.ends])
        axes.plot(*ends.T, color=part.colour, lw=2.4, solid_capstyle="round", zorder=3)
        x, y = BESIDE * (ends[1] - ends[0]) / np.linalg.norm(ends[1] - ends[0])
        at_line = ends[0] + part.along * (ends[1] - ends[0])
        label(axes, at_line, part.number, (y, -x), part.colour)
    for name, body in (("A", "large_rod"), ("P", "large_rod"), ("Q", "door"), ("B", "door")):
        x, y = where(body, at[name])
        axes.plot(x, y, "o", ms=4, mfc="white", mec="black", mew=0.9, zorder=5)
        label(axes, (x, y), name, NAMED[name], "black", "normal")
    label(axes, where("door", at["B"]), "6", (-9, 4), HOUSING)
    axes.plot([-0.06, 0.06], [-0.012, -0.012], color=GROUND, lw=3)
    label(axes, (-0.06, -0.012), "1", (-8, 0), GROUND)
    axes.set_aspect("equal")
    axes.set_xlim(-0.31, 0.35)
    axes.set_ylim(-0.06, 0.32)


def label(
    axes: Any, at: Any, text: str, off: tuple[float, float], shade: str, weight: str = "bold"
) -> None:
    """A number or a letter beside a place."""
    axes.annotate(text, at, xytext=off, textcoords="offset points", ha="center", va="center",
                  fontsize=8, color=shade, fontweight=weight, zorder=6)  # fmt: skip


def starts(axes: Any, shown: list[Shown]) -> None:
    """The door over the stroke, begun at rest and with a swing."""
    for a, name, rest, swung, letter in zip(axes, WITH, shown[::2], shown[1::2], "abcd",
                                            strict=True):  # fmt: skip
        for k, (one, text) in enumerate(((rest, "begun at rest"), (swung, "begun by a swing"))):
            place, angle = one.values("stroke"), one.values("door_angle")
            a.plot(place, angle, color=colour(k), ls="--" if k else "-", lw=1.2, label=text)
        lettered(a, letter, name)
        a.set_xlabel(f"stroke ({rest.unit('stroke')})")
        a.set_ylim(-2.0, 60.0)
        a.set_xlim(0.0, rest.scaled(0.32, "m"))
        a.tick_params(labelleft=a is axes[0])
    axes[0].set_ylabel(f"door angle ({shown[0].unit('door_angle')})")
    axes[0].legend(loc="upper left", fontsize=7)


FIGURES = (
    Drawn("1", "", "The chain at three times, numbered as in the study: 1 fixed support, 2 large "
          "rod, 3 transfer rod, 4 fairing, 6 torsion spring at B, 7 lug, 8 door. Below, the turn "
          "of the door begun at rest and begun by a swing of 57 deg/s, with both, one and none of "
          "spring and lug.", (("", "ab_03"), *STARTS), figure_1),
)  # fmt: skip
