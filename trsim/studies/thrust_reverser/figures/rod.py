"""Figures 18 to 21: rigid and flexible rods, 0.3 mm at B."""

from typing import Any

from trsim.report.display import Shown
from trsim.report.orbits import square
from trsim.report.style import panels
from trsim.studies.drawing import Drawn
from trsim.studies.thrust_reverser.cases import fine
from trsim.studies.thrust_reverser.figures.drawing import (
    DOOR,
    ONSET,
    ROOM,
    orbit,
    section,
    with_onset,
)
from trsim.studies.thrust_reverser.figures.place import door

LIGHT = (("rigid, 0.5 kg", "b_03"), ("flexible, 0.5 kg", "b_03_flexible_light"))
HEAVY = (("rigid, 3.454 kg", "b_03_rigid_heavy"), ("flexible, 3.454 kg", "b_03_flexible_heavy"))
UNDAMPED = ("flexible, 3.454 kg, undamped", "b_03_flexible_undamped")
TABLES = (LIGHT[0], UNDAMPED)
ALL = (*LIGHT, *HEAVY, UNDAMPED)


def figure_18(shown: list[Shown]) -> Any:
    """The five panels of the study over time; beside them the touch of the lug."""
    return with_onset(shown, (*DOOR, "B", "actuator.force"), ONSET)


def figure_19(shown: list[Shown]) -> Any:
    """Orbits at B; (a) with the rigid rod, (b) with flexible ones."""
    figure, (axes,) = panels(1, len(shown), height=2.9, width=3.0 + 2.0 * len(shown))
    for a, one, letter in zip(axes, shown, "abb", strict=False):
        shade = orbit(a, one, "B", letter, one.label.replace(", undamped", ",\nundamped"))
    square(axes, ROOM * 0.3)
    for a in axes[1:]:
        a.set_ylabel("")
    figure.colorbar(shade, ax=list(axes), label="time (s)", aspect=30)
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
    Drawn("18", "abcde", "Rigid and flexible rod of the same mass, 0.5 kg.", fine(LIGHT),
          figure_18),
    Drawn("18 with the mass of the section", "abcde",
          "Rigid and flexible rod of the same mass, 3.454 kg, that of the section in steel.",
          fine(HEAVY), figure_18),
    Drawn("18 with the tables as they stand", "abcde",
          "A rigid rod of 0.5 kg and a flexible one of 3.454 kg, without damping.",
          fine(TABLES), figure_18),
    Drawn("19", "ab", "Orbits of the journal at B with a rigid and a flexible rod of 0.5 kg; (a) "
          "is that of figure 12 (c).", LIGHT, figure_19),
    Drawn("19 with the mass of the section", "ab",
          "Orbits of the journal at B with rods of 3.454 kg.", (*HEAVY, UNDAMPED), figure_19),
    Drawn("20", "ab", "Phase diagrams of the door with a rigid and a flexible rod of 0.5 kg; below "
          "them its acceleration; (a) is that of figure 13 (b).", fine(LIGHT), door),
    Drawn("20 with the mass of the section", "ab", "As figure 20, with rods of 3.454 kg.",
          fine(HEAVY), door),
    Drawn("21", "", "Poincar\u00e9 sections at B with five rods.", ALL, figure_21),
)  # fmt: skip
