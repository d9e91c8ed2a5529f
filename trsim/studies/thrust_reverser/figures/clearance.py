"""Figures 8 to 10: the load; clearances of 0.1, 0.3 and 0.5 mm at A and B, 0.5 m/s."""

from typing import Any

from trsim.report.display import Shown
from trsim.report.style import panels
from trsim.studies.drawing import Drawn, with_legend
from trsim.studies.thrust_reverser.cases import AB, GIVES, SOFT, fine
from trsim.studies.thrust_reverser.figures.drawing import (
    DOOR,
    ONSET,
    curves,
    journal,
    over_time,
    section,
    timed,
    with_onset,
)

ALL = (*DOOR, "actuator.force", "A", "B")


def figure_8(shown: list[Shown]) -> Any:
    """The load on the door."""
    figure, axes = panels(1, height=2.4, width=4.6)
    curves(axes[0, 0], shown, "air.magnitude", "", "aerodynamic load on the door")
    timed(axes[0])
    return figure


def figure_9(shown: list[Shown]) -> Any:
    """Motion of the door, driving force and contact forces; beside them the touch of the lug."""
    return with_onset(shown, ALL, ONSET)


def variant_9(shown: list[Shown]) -> Any:
    """The same over the whole stroke."""
    return over_time(shown, ALL, sharex=True)[0]


def figure_10(shown: list[Shown]) -> Any:
    """Phase diagrams and Poincare sections at both pins."""
    figure, axes = panels(2, 2, height=3.0, width=7.2)
    for row, joint, letters in zip(axes, "AB", ("ab", "cd"), strict=True):
        journal(row[0], shown, joint, letters[0], f"phase diagram at {joint}")
        section(row[1], shown, f"{joint}_orbit", letters[1], f"Poincar\u00e9 section at {joint}")
    return with_legend(figure, axes[0, 0], shown)


FIGURES = (
    Drawn("8", "", "Load on the door.", (("", "ideal"),), figure_8),
    Drawn("9", "abcdef", "Clearance at A and B, 0.5 m/s: motion of the door, driving force, "
          "contact forces; on the right the touch of the lug.", fine(AB), figure_9),
    Drawn("10", "abcd", "Clearance at A and B, 0.5 m/s: the journals. Circles: clearance. "
          "Section: the eccentricity in x turns from falling to rising.", fine(AB), figure_10),
    Drawn("9 with an actuator that gives way", "abcdef",
          "As figure 9, with an actuator of 1e7 N/m and 10 % damping (ours).", GIVES, variant_9),
    Drawn("9 with the printed stiffness", "abcdef",
          "As figure 9, with R_i + R_j in the contact stiffness, as printed in the study.", SOFT,
          variant_9),
)  # fmt: skip
