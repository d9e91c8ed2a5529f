"""Figures 8 to 10: the load; clearances of 0.1, 0.3 and 0.5 mm at A and B, 0.5 m/s."""

from typing import Any

from trsim.report.style import panels
from trsim.studies.thrust_reverser.figures.drawing import (
    Cases,
    Drawn,
    curves,
    forces,
    journal,
    names,
    section,
    those,
    timed,
    with_legend,
)
from trsim.studies.thrust_reverser.runs import Runs

CASES = (("0.1 mm", "ab_01"), ("0.3 mm", "ab_03"), ("0.5 mm", "ab_05"))
NAMES = names(CASES)


def variant(name: str) -> Cases:
    """These clearances in a variant of the mechanism."""
    return tuple((label, f"{case}_{name}") for label, case in CASES)


def figure_8(runs: Runs) -> Any:
    """The load on the door."""
    shown = those(runs, ("", "ideal"))
    figure, axes = panels(1, height=2.4, width=4.6)
    curves(axes[0, 0], shown, "air.magnitude", "", "aerodynamic load on the door")
    timed(axes[0])
    return figure


def figure_9(runs: Runs) -> Any:
    """Motion of the door, driving force and contact forces."""
    return overview(runs, CASES)


def overview(runs: Runs, cases: Cases) -> Any:
    """The six panels of the study over time."""
    shown = those(runs, *cases)
    figure, axes = panels(3, 2, height=2.1, width=7.2, sharex=True)
    curves(axes[0, 0], shown, "door_angle", "a")
    curves(axes[0, 1], shown, "door_angle.rate", "b")
    curves(axes[1, 0], shown, "door_angle.acceleration", "c")
    curves(axes[1, 1], shown, "actuator.force", "d")
    forces(axes[2, 0], shown, "A", "e")
    forces(axes[2, 1], shown, "B", "f")
    timed(axes[2])
    figure.align_ylabels()
    return with_legend(figure, axes[0, 0], shown)


def figure_10(runs: Runs) -> Any:
    """Phase diagrams and Poincare sections at both pins."""
    shown = those(runs, *CASES)
    figure, axes = panels(2, 2, height=3.0, width=7.2)
    for row, joint in zip(axes, "AB", strict=True):
        letters = "ab" if joint == "A" else "cd"
        journal(row[0], shown, joint, letters[0], f"phase diagram at {joint}")
        section(row[1], shown, f"{joint}_orbit", letters[1], f"Poincar\u00e9 section at {joint}")
    return with_legend(figure, axes[0, 0], shown)


FIGURES = (
    Drawn("8", "", "Load on the door.", ("ideal",), figure_8),
    Drawn("9", "abcdef", "Clearance at A and B, 0.5 m/s: motion of the door, driving force, "
          "contact forces.", NAMES, figure_9),
    Drawn("10", "abcd", "Clearance at A and B, 0.5 m/s: the journals. Circles: clearance. "
          "Section: the eccentricity in x turns from falling to rising.", NAMES, figure_10),
    Drawn("9 with an actuator that gives way", "abcdef",
          "As figure 9, with an actuator of 1e7 N/m and 10 % damping (ours).",
          ("ab_01_compliant", "ab_03_compliant", "ab_05_compliant"),
          lambda runs: overview(runs, variant("compliant"))),
    Drawn("9 with the printed stiffness", "abcdef",
          "As figure 9, with R_i + R_j in the contact stiffness, as printed in the study.",
          ("ab_01_soft", "ab_03_soft", "ab_05_soft"),
          lambda runs: overview(runs, variant("soft"))),
)  # fmt: skip
