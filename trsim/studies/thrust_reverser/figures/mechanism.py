"""Figure 22: the spatial mechanism as a run has it, before it moves and at its end."""

from collections.abc import Iterator
from itertools import pairwise
from typing import Any

import numpy as np
from numpy.typing import NDArray

from trsim.report.animation import solids
from trsim.report.animation.motion import Motion, motion
from trsim.report.display import Shown
from trsim.report.style import panels
from trsim.studies.drawing import Drawn, alike
from trsim.studies.thrust_reverser.figures.canvas import Canvas, view
from trsim.studies.thrust_reverser.figures.spatial import ACTUATORS

Array = NDArray[np.float64]

CHAINS = (1, 2, 3, 4, 5)
SEEN = (-153.0, 24.0)  # deg: azimuth, elevation
WIDE, CHORD = 0.42, 0.195  # m, of a door
SHELL, BACK, FRONT = 0.78, -0.272, 0.528  # m: radius of the fairing, its edges as drawn
AROUND = np.radians(np.linspace(-90.0, 90.0, 49))
THICK = {"large_rod": 0.018, "transfer": 0.016}  # m, radii drawn
COWL, DOOR, ROD, LINK = "#9fb4c9", "#e07b28", "#2f7fc1", "#2a9d78"
HOUSING, PISTON, RAIL, GROUND, NUMBER = "#b3202a", "#d9d9d9", "#6b7079", "#555a63", "#222222"
SHAFT = "#7a3fa0"


def figure_22(shown: list[Shown]) -> Any:
    """Fairing, rails, actuators and chains, seen obliquely."""
    moved = motion(shown[0].run)
    figure, (axes,) = panels(1, 2, height=2.75, width=7.6)
    for a, k, text in ((axes[0], 0, "before the stroke"), (axes[1], -1, "at its end, 0.5 m")):
        draw(a, moved, k)
        a.set_title(text, loc="center")
    alike([list(axes)])
    return figure


def draw(axes: Any, moved: Motion, k: int) -> None:
    """One frame."""
    canvas = Canvas(view(*SEEN))
    for sheet, colour, alpha in sheets(moved, k):
        canvas.sheet(sheet, colour, alpha)
    for mesh, colour in parts(moved, k):
        canvas.solid(mesh, colour)
    canvas.paint(axes)
    for x in (BACK, FRONT):
        canvas.line(axes, shell(moved, k, x), color="#5f7387", lw=0.9)
    numbers(axes, canvas, moved)


def place(moved: Motion, k: int, body: str, at: Array) -> Array:
    """Where a point of a body as drawn is in a frame."""
    found = moved.point(body, at)
    return found[k] if len(found) > 1 else found[0]


def shell(moved: Motion, k: int, x: float) -> Array:
    """An arc of the fairing at some x as drawn."""
    ring = np.stack([np.full(len(AROUND), x), SHELL * np.sin(AROUND), SHELL * np.cos(AROUND)], 1)
    return np.array([place(moved, k, "fairing", at) for at in ring])


def sheets(moved: Motion, k: int) -> Iterator[tuple[Array, str, float]]:
    """The fairing, through which one sees, and the doors."""
    yield np.stack([shell(moved, k, x) for x in np.linspace(BACK, FRONT, 9)]), COWL, 0.22
    joints = {joint.name: joint for joint in moved.drawn.joints}
    for n in CHAINS:
        hinge, far = joints[f"chain_{n}_B"], joints[f"chain_{n}_Q"].at
        chord = (far - hinge.at) / np.linalg.norm(far - hinge.at) * CHORD
        grid = np.array([[place(moved, k, f"chain_{n}_door", hinge.at + u * chord + v * hinge.axis)
                          for v in np.linspace(-0.5, 0.5, 9) * WIDE]
                         for u in np.linspace(0.0, 1.0, 5)])  # fmt: skip
        yield grid, DOOR, 1.0


def parts(moved: Motion, k: int) -> Iterator[tuple[solids.Mesh, str]]:
    """Rods, actuators, rails and what stands still."""
    joints = {joint.name: joint.at for joint in moved.drawn.joints}
    for n in CHAINS:
        a, p, q = (joints[f"chain_{n}_{name}"] for name in "APQ")
        rods = ((f"chain_{n}_large_rod", a, p, ROD), (f"chain_{n}_transfer", p, q, LINK))
        for body, one, other, colour in rods:
            a_end, b_end = place(moved, k, body, one), place(moved, k, body, other)
            yield solids.rod(a_end, b_end, THICK[body.removeprefix(f"chain_{n}_")]), colour
        yield solids.ball(0.026).moved(a), GROUND
    supports = [joints[f"chain_{n}_A"] for n in CHAINS]
    for one, other in pairwise(arc(supports)):
        yield solids.rod(one, other, 0.012), GROUND
    yield from shaft(moved)
    for n in ACTUATORS:
        back, eye = ends(moved, n)
        front = place(moved, k, "fairing", eye)
        yield solids.rod(back, back + (eye - back) * 0.9, 0.03), HOUSING
        yield solids.rod(back + (eye - back) * 0.9, front, 0.015), PISTON
        yield solids.ball(0.034).moved(front), HOUSING
    for name, force in moved.drawn.scenario.forces.items():
        if name.startswith("rail_"):
            at = place(moved, k, "fairing", np.array(force.at))
            yield solids.box(np.array([0.09, 0.05, 0.07]), np.eye(3)).moved(at), GROUND
            if name.endswith("front"):
                beam = np.array([0.05, force.at[1], 0.0])
                yield solids.box(np.array([1.0, 0.03, 0.04]), np.eye(3)).moved(beam), RAIL


def ends(moved: Motion, n: int) -> tuple[Array, Array]:
    """Where an actuator is mounted, and its eye on the fairing, as drawn."""
    back, eye = moved.drawn.scenario.drives[f"actuator_{n}"].points
    return np.array(back), np.array(eye)


def shaft(moved: Motion) -> Iterator[tuple[solids.Mesh, str]]:
    """The soft shaft from gear to gear of the actuators, round behind the cascade."""
    backs = [ends(moved, n)[0] for n in ACTUATORS]
    for one, other in pairwise(arc(backs)):
        yield solids.rod(one, other, 0.011), SHAFT
    for back in backs:
        yield solids.ball(0.042).moved(back), SHAFT


def arc(points: list[Array]) -> Array:
    """A round line through points about the x axis."""
    angle = [float(np.arctan2(p[1], p[2])) for p in points]
    x, radius = points[0][0], float(np.hypot(*points[0][1:]))
    around = np.linspace(angle[0], angle[-1], 33)
    return np.stack([np.full(33, x), radius * np.sin(around), radius * np.cos(around)], axis=1)


def numbers(axes: Any, canvas: Canvas, moved: Motion) -> None:
    """The numbers of the actuators, and of the chains at their supports."""
    joints = {joint.name: joint.at for joint in moved.drawn.joints}
    for n in ACTUATORS:
        back, eye = ends(moved, n)
        canvas.number(axes, 0.85 * back + 0.15 * eye, f"{n}", HOUSING)
    for n in CHAINS:
        canvas.number(axes, joints[f"chain_{n}_A"] * (1.0, 0.82, 0.82), f"{n}", NUMBER)


FIGURES = (
    Drawn("22", "", "The mechanism in space: fairing (grey, one sees through it) on rails at its "
          "edges, pushed by actuators 1 to 3 (red), which a soft shaft (violet) joins, "
          "and five chains with their doors (orange), large rods (blue) and transfer rods (green). "
          "Doors are drawn as the plates they are in our data, 0.42 m wide, which meet as they "
          "turn.",
          (("", "spatial_420"),), figure_22),
)  # fmt: skip
