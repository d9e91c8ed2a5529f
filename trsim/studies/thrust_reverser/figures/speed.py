"""Figures 14 to 17: 0.5 and 1.0 m/s with 0.5 mm, at B as in the text, and at A and B."""

from typing import Any

from trsim.report.style import panels
from trsim.studies.thrust_reverser.figures.drawing import (
    Cases,
    Drawn,
    alike,
    curves,
    forces,
    framed,
    journal,
    names,
    orbit,
    section,
    those,
    with_legend,
)
from trsim.studies.thrust_reverser.runs import Runs

B = (("0.5 m/s", "b_05"), ("1.0 m/s", "b_05_fast"))
AB = (("0.5 m/s", "ab_05"), ("1.0 m/s", "ab_05_fast"))


def side_by_side(runs: Runs, cases: Cases, joints: str) -> Any:
    """Velocity, acceleration, contact forces and driving force; a column for each speed."""
    shown = those(runs, *cases)
    figure, axes = panels(3 + len(joints), 2, height=1.8, width=7.2)
    letters = iter("abcdefghij")
    for row, channel in ((0, "door_angle.rate"), (1, "door_angle.acceleration")):
        for a, one in zip(axes[row], shown, strict=True):
            curves(a, [one], channel, next(letters), one.label)
    for row, joint in enumerate(joints, 2):
        for a, one in zip(axes[row], shown, strict=True):
            forces(a, [one], joint, next(letters), one.label)
            a.set_ylabel(f"force at {joint}\n(N)")
    for a, one in zip(axes[-1], shown, strict=True):
        curves(a, [one], "actuator.force", next(letters), one.label)
        a.set_xlabel("time (s)")
    alike(axes, x=False)
    for a in axes[:, 1]:
        a.set_ylabel("")
    figure.align_ylabels()
    return figure


def figure_15(runs: Runs) -> Any:
    """Orbits at A and B; a column for each speed."""
    shown = those(runs, *AB)
    figure, axes = panels(2, 2, height=2.9, width=6.3)
    for row, joint in zip(axes, "AB", strict=True):
        for a, one in zip(row, shown, strict=True):
            letter = "ab"["AB".index(joint)]
            orbit(a, one, joint, letter, f"{joint}, {one.label}")
    framed(list(axes.flat), 0.5)
    shade = axes[0, 0].collections[0]
    figure.colorbar(shade, ax=list(axes.flat), label="time (s), 0.5 m/s; half of it at 1.0 m/s",
                    location="right", aspect=50)  # fmt: skip
    return figure


def figure_16(runs: Runs) -> Any:
    """Phase diagrams at A and B; a column for each speed."""
    shown = those(runs, *AB)
    figure, axes = panels(2, 2, height=2.6, width=7.2)
    letters = iter("abcd")
    for row, joint in zip(axes, "AB", strict=True):
        for k, (a, one) in enumerate(zip(row, shown, strict=True)):
            journal(a, [one], joint, next(letters), f"{joint}, {one.label}", (k,))
    alike(axes)
    return figure


def figure_17(runs: Runs) -> Any:
    """Poincare sections at A and B, both speeds."""
    shown = those(runs, *AB)
    figure, (axes,) = panels(1, 2, height=3.3)
    for a, joint, letter in zip(axes, "AB", "ab", strict=True):
        section(a, shown, f"{joint}_orbit", letter, f"Poincar\u00e9 section at {joint}")
    return with_legend(figure, axes[0], shown)


FIGURES = (
    Drawn("14", "abcdefgh", "Two driving speeds, 0.5 mm at B.", names(B),
          lambda runs: side_by_side(runs, B, "B")),
    Drawn("14 with clearance at A and B", "abcdefgh", "Two driving speeds, 0.5 mm at A and B.",
          names(AB), lambda runs: side_by_side(runs, AB, "AB")),
    Drawn("15", "ab", "Orbits of the journals at two speeds, 0.5 mm at A and B.", names(AB),
          figure_15),
    Drawn("16", "abcd", "Phase diagrams of the journals at two speeds, 0.5 mm at A and B.",
          names(AB), figure_16),
    Drawn("17", "ab", "Poincar\u00e9 sections at two speeds, 0.5 mm at A and B.", names(AB),
          figure_17),
)  # fmt: skip
