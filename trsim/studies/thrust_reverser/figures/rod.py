"""Figures 18 to 21: rigid and flexible rods, 0.3 mm at B."""

from typing import Any

from trsim.report.display import Shown
from trsim.report.orbits import square
from trsim.report.style import panels
from trsim.studies.drawing import Drawn
from trsim.studies.thrust_reverser.figures.drawing import (
    DOOR,
    ROOM,
    forces,
    orbit,
    over_time,
    section,
)
from trsim.studies.thrust_reverser.figures.place import door

LIGHT = (("rigid, 0.5 kg", "b_03"), ("flexible, 0.5 kg", "b_03_flexible_light"))
HEAVY = (("rigid, 3.454 kg", "b_03_rigid_heavy"), ("flexible, 3.454 kg", "b_03_flexible_heavy"))
UNDAMPED = ("flexible, 3.454 kg, undamped", "b_03_flexible_undamped")
TABLES = (LIGHT[0], UNDAMPED)
ALL = (*LIGHT, *HEAVY, UNDAMPED)
ENLARGED = 0.295, 0.365  # s


def figure_18(shown: list[Shown]) -> Any:
    """The five panels of the study over time, and a part of one."""
    figure, axes = over_time(shown, (*DOOR, "B", "actuator.force"))
    forces(axes[2, 1], shown, "B", "", "(d) enlarged")
    axes[2, 1].set_xlim(*ENLARGED)
    return figure


def figure_19(shown: list[Shown]) -> Any:
    """Orbits at B."""
    figure, axes = panels(2, 3, height=2.7, width=7.2)
    for a, one, letter in zip(axes.flat, shown, "abcde", strict=False):
        shade = orbit(a, one, "B", letter, one.label.replace(", undamped", ",\nundamped"))
    axes[1, 2].set_visible(False)
    square(axes.flat, ROOM * 0.3)
    for a in axes[:, 1:].flat:
        a.set_ylabel("")
    figure.colorbar(shade, ax=list(axes.flat), label="time (s)", aspect=50)
    return figure


def figure_21(shown: list[Shown]) -> Any:
    """Poincare sections at B, by mass."""
    figure, (axes,) = panels(1, 2, height=3.3)
    light = len(LIGHT)
    for a, of, mass in zip(
        axes, (shown[:light], shown[light:]), ("0.5 kg", "3.454 kg"), strict=True
    ):
        section(a, of, "B_orbit", "", f"section at B, {mass}")
        a.legend(loc="center")
    return figure


FIGURES = (
    Drawn("18", "abcde", "Rigid and flexible rod of the same mass, 0.5 kg.", LIGHT, figure_18),
    Drawn("18 with the mass of the section", "abcde",
          "Rigid and flexible rod of the same mass, 3.454 kg, that of the section in steel.",
          HEAVY, figure_18),
    Drawn("18 with the tables as they stand", "abcde",
          "A rigid rod of 0.5 kg and a flexible one of 3.454 kg, without damping.", TABLES,
          figure_18),
    Drawn("19", "ab", "Orbits of the journal at B with five rods.", ALL, figure_19),
    Drawn("20", "ab", "Phase diagrams of the door with rigid and flexible rods; below them its "
          "acceleration.", (*LIGHT, *HEAVY), door),
    Drawn("21", "", "Poincar\u00e9 sections at B with five rods.", ALL, figure_21),
)  # fmt: skip
