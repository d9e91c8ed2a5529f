"""Figures 11 to 13: clearance of 0.3 mm at A alone and at B alone, 0.5 m/s."""

from typing import Any

from trsim.report.style import panels
from trsim.studies.thrust_reverser.figures.drawing import (
    ACCELERATION,
    VELOCITY,
    Cases,
    Drawn,
    alike,
    curves,
    framed,
    journal,
    lettered,
    names,
    orbit,
    plane,
    those,
    timed,
    with_legend,
)
from trsim.studies.thrust_reverser.runs import Runs

CASES = (("0.3 mm at A", "a_03"), ("0.3 mm at B", "b_03"))
NAMES = names(CASES)


def figure_11(runs: Runs) -> Any:
    """Motion of the door and driving force."""
    shown = those(runs, *CASES)
    figure, axes = panels(2, 2, height=2.1, width=7.2, sharex=True)
    channels = ("door_angle", "door_angle.rate", "door_angle.acceleration", "actuator.force")
    for a, channel, letter in zip(axes.flat, channels, "abcd", strict=True):
        curves(a, shown, channel, letter)
    timed(axes[1])
    figure.align_ylabels()
    return with_legend(figure, axes[0, 0], shown)


def figure_12(runs: Runs) -> Any:
    """Orbits and phase diagrams of the journals, on the same scales."""
    shown = those(runs, *CASES)
    figure, axes = panels(2, 2, height=3.0, width=7.2)
    for k, (row, joint) in enumerate(zip(axes, "AB", strict=True)):
        letters = "abcd"[2 * k : 2 * k + 2]
        shade = orbit(row[0], shown[k], joint, letters[0], f"orbit at {joint}")
        journal(row[1], shown[k : k + 1], joint, letters[1], f"phase diagram at {joint}", (k,))
    framed(axes[:, 0], 0.3)
    alike([axes[:, 1]])
    figure.colorbar(shade, ax=list(axes[:, 0]), label="time (s)", location="left", aspect=60)
    return figure


def figure_13(runs: Runs) -> Any:
    """Phase diagrams of the door."""
    return door(runs, CASES, "ab")


def door(runs: Runs, cases: Cases, letters: str) -> Any:
    """Velocity over angle, and below acceleration over velocity, side by side on one scale."""
    shown = those(runs, *cases)
    figure, axes = panels(2, len(shown), height=2.3, width=7.2, sharex="row", sharey="row")
    for k, one in enumerate(shown):
        plane(axes[0, k], [one], "door_angle", "door_angle.rate", ("door angle", VELOCITY), (k,))
        plane(axes[1, k], [one], "door_angle.rate", "door_angle.acceleration",
              (VELOCITY, ACCELERATION), (k,))  # fmt: skip
        lettered(axes[0, k], letters[k], one.label)
    for a in axes[:, 1:].flat:
        a.set_ylabel("")
    figure.align_ylabels()
    return figure


FIGURES = (
    Drawn("11", "abcd", "Clearance at one pin, 0.5 m/s: motion of the door and driving force.",
          NAMES, figure_11),
    Drawn("12", "abcd", "Clearance at one pin, 0.5 m/s: the journals.", NAMES, figure_12),
    Drawn("13", "ab", "Clearance at one pin, 0.5 m/s: phase diagrams of the door; below them its "
          "acceleration, by which the study judges.", NAMES, figure_13),
)  # fmt: skip
