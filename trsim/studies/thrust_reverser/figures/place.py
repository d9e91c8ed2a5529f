"""Figures 11 to 13: clearance of 0.3 mm at A alone and at B alone, 0.5 m/s."""

from typing import Any

from trsim.report.display import Shown
from trsim.report.orbits import square
from trsim.report.style import panels
from trsim.studies.drawing import Drawn, alike, lettered
from trsim.studies.thrust_reverser.cases import fine
from trsim.studies.thrust_reverser.figures.drawing import (
    ACCELERATION,
    DOOR,
    ONSET,
    ROOM,
    VELOCITY,
    journal,
    orbit,
    plane,
    with_onset,
)

SLOW = 50.0  # mm/s, of a journal
FIRST = 2.5, 12.0  # deg, of the door
CASES = (("0.3 mm at A", "a_03"), ("0.3 mm at B", "b_03"))


def figure_11(shown: list[Shown]) -> Any:
    """Motion of the door and driving force; beside them the touch of the lug."""
    return with_onset(shown, (*DOOR, "actuator.force"), ONSET)


def figure_12(shown: list[Shown]) -> Any:
    """Orbits and phase diagrams of the journals, on the same scales; these enlarged."""
    figure, axes = panels(2, 3, height=2.7, width=8.2)
    for k, (row, joint, letters) in enumerate(zip(axes, "AB", ("ab", "cd"), strict=True)):
        shade = orbit(row[0], shown[k], joint, letters[0], f"orbit at {joint}")
        for a, letter, text in ((row[1], letters[1], f"phase diagram at {joint}"),
                                (row[2], "", "enlarged")):  # fmt: skip
            journal(a, shown[k : k + 1], joint, letter, text, (k,))
        row[2].set_ylim(-SLOW, SLOW)
        row[2].set_ylabel("")
    square(axes[:, 0], ROOM * 0.3)
    alike([axes[:, 1]])
    figure.colorbar(shade, ax=list(axes[:, 0]), label="time (s)", location="left", aspect=60)
    return figure


def door(shown: list[Shown]) -> Any:
    """Velocity over angle, its onset, and acceleration over velocity, side by side on one scale."""
    figure, axes = panels(3, len(shown), height=2.2, width=7.2, sharex="row", sharey="row")
    angle, rate, acceleration = DOOR
    for k, (one, column, letter) in enumerate(zip(shown, axes.T, "abcd", strict=False)):
        for a in column[:2]:
            plane(a, [one], angle, rate, ("door angle", VELOCITY), (k,))
        plane(column[2], [one], rate, acceleration, (VELOCITY, ACCELERATION), (k,))
        lettered(column[0], letter, one.label)
        lettered(column[1], "", "enlarged, from the touch of the lug")
    axes[1, 0].set_xlim(*FIRST)
    for a in axes[:, 1:].flat:
        a.set_ylabel("")
    figure.align_ylabels()
    return figure


FIGURES = (
    Drawn("11", "abcd", "Clearance at one pin, 0.5 m/s: motion of the door and driving force; "
          "on the right the touch of the lug.", fine(CASES), figure_11),
    Drawn("12", "abcd", "Clearance at one pin, 0.5 m/s: the journals; on the right the phase "
          "diagrams up to 50 mm/s.", fine(CASES), figure_12),
    Drawn("13", "ab", "Clearance at one pin, 0.5 m/s: phase diagrams of the door; below them its "
          "acceleration, by which the study judges.", fine(CASES), door),
)  # fmt: skip
