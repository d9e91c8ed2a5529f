"""Figures 11 to 13: clearance of 0.3 mm at A alone and at B alone, 0.5 m/s."""

from typing import Any

from trsim.report.display import Shown
from trsim.report.orbits import square
from trsim.report.style import panels
from trsim.studies.drawing import Drawn, alike, lettered
from trsim.studies.thrust_reverser.figures.drawing import (
    ACCELERATION,
    DOOR,
    ROOM,
    VELOCITY,
    journal,
    orbit,
    over_time,
    plane,
)

CASES = (("0.3 mm at A", "a_03"), ("0.3 mm at B", "b_03"))


def figure_11(shown: list[Shown]) -> Any:
    """Motion of the door and driving force."""
    return over_time(shown, (*DOOR, "actuator.force"), sharex=True)[0]


def figure_12(shown: list[Shown]) -> Any:
    """Orbits and phase diagrams of the journals, on the same scales."""
    figure, axes = panels(2, 2, height=3.0, width=7.2)
    for k, (row, joint, letters) in enumerate(zip(axes, "AB", ("ab", "cd"), strict=True)):
        shade = orbit(row[0], shown[k], joint, letters[0], f"orbit at {joint}")
        journal(row[1], shown[k : k + 1], joint, letters[1], f"phase diagram at {joint}", (k,))
    square(axes[:, 0], ROOM * 0.3)
    alike([axes[:, 1]])
    figure.colorbar(shade, ax=list(axes[:, 0]), label="time (s)", location="left", aspect=60)
    return figure


def door(shown: list[Shown]) -> Any:
    """Velocity over angle, and below acceleration over velocity, side by side on one scale."""
    figure, axes = panels(2, len(shown), height=2.3, width=7.2, sharex="row", sharey="row")
    angle, rate, acceleration = DOOR
    for k, (one, letter) in enumerate(zip(shown, "abcd", strict=False)):
        plane(axes[0, k], [one], angle, rate, ("door angle", VELOCITY), (k,))
        plane(axes[1, k], [one], rate, acceleration, (VELOCITY, ACCELERATION), (k,))
        lettered(axes[0, k], letter, one.label)
    for a in axes[:, 1:].flat:
        a.set_ylabel("")
    figure.align_ylabels()
    return figure


FIGURES = (
    Drawn("11", "abcd", "Clearance at one pin, 0.5 m/s: motion of the door and driving force.",
          CASES, figure_11),
    Drawn("12", "abcd", "Clearance at one pin, 0.5 m/s: the journals.", CASES, figure_12),
    Drawn("13", "ab", "Clearance at one pin, 0.5 m/s: phase diagrams of the door; below them its "
          "acceleration, by which the study judges.", CASES, door),
)  # fmt: skip
