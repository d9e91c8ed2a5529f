"""Figures 14 to 17: 0.5 and 1.0 m/s with 0.5 mm, at B as in the text, and at A and B."""

from functools import partial
from typing import Any

from trsim.report.display import Shown
from trsim.report.orbits import square
from trsim.report.style import panels
from trsim.studies.drawing import Drawn, alike, with_legend
from trsim.studies.thrust_reverser.cases import SPEED_AB, SPEED_B, fine
from trsim.studies.thrust_reverser.figures.drawing import (
    DOOR,
    ROOM,
    journal,
    orbit,
    panel,
    section,
    timed,
)


def side_by_side(shown: list[Shown], joints: str) -> Any:
    """Velocity, acceleration, contact forces and driving force; a column for each speed."""
    figure, axes = panels(3 + len(joints), 2, height=1.8, width=7.2)
    letters = iter("abcdefgh")
    for row, of in zip(axes, (*DOOR[1:], *joints, "actuator.force"), strict=True):
        for a, one in zip(row, shown, strict=True):
            letter = "" if of == "A" else next(letters)  # the study has the force at B alone
            panel(a, [one], of, letter, one.label)
            if of in joints:
                a.set_ylabel(f"force at {of}\n(N)")
    timed(axes[-1])
    alike(axes, x=False)
    for a in axes[:, 1]:
        a.set_ylabel("")
    figure.align_ylabels()
    return figure


def figure_15(shown: list[Shown]) -> Any:
    """Orbits at A and B; a column for each speed."""
    figure, axes = panels(2, 2, height=2.9, width=6.3)
    for row, joint, letter in zip(axes, "AB", "ab", strict=True):
        for a, one in zip(row, shown, strict=True):
            orbit(a, one, joint, letter, f"{joint}, {one.label}")
    square(axes.flat, ROOM * 0.5)
    shade = axes[0, 0].collections[0]
    figure.colorbar(shade, ax=list(axes.flat), label="time (s), 0.5 m/s; half of it at 1.0 m/s",
                    location="right", aspect=50)  # fmt: skip
    return figure


def figure_16(shown: list[Shown]) -> Any:
    """Phase diagrams at A and B; a column for each speed."""
    figure, axes = panels(2, 2, height=2.6, width=7.2)
    letters = iter("abcd")
    for row, joint in zip(axes, "AB", strict=True):
        for k, (a, one) in enumerate(zip(row, shown, strict=True)):
            journal(a, [one], joint, next(letters), f"{joint}, {one.label}", (k,))
    alike(axes)
    return figure


def figure_17(shown: list[Shown]) -> Any:
    """Poincare sections at A and B, both speeds."""
    figure, (axes,) = panels(1, 2, height=3.3)
    for a, joint, letter in zip(axes, "AB", "ab", strict=True):
        section(a, shown, f"{joint}_orbit", letter, f"Poincar\u00e9 section at {joint}")
    return with_legend(figure, axes[0], shown)


FIGURES = (
    Drawn("14", "abcdefgh", "Two driving speeds, 0.5 mm at B.", SPEED_B,
          partial(side_by_side, joints="B")),
    Drawn("14 with clearance at A and B", "abcdefgh", "Two driving speeds, 0.5 mm at A and B.",
          SPEED_AB, partial(side_by_side, joints="AB")),
    Drawn("15", "ab", "Orbits of the journals at two speeds, 0.5 mm at A and B.", SPEED_AB,
          figure_15),
    Drawn("16", "abcd", "Phase diagrams of the journals at two speeds, 0.5 mm at A and B.",
          fine(SPEED_AB), figure_16),
    Drawn("17", "ab", "Poincar\u00e9 sections at two speeds, 0.5 mm at A and B.", SPEED_AB,
          figure_17),
)  # fmt: skip
