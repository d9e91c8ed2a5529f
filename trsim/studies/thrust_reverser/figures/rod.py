"""Figures 18 to 21: rigid and flexible rods, 0.3 mm at B."""

from typing import Any

from trsim.report.style import panels
from trsim.studies.thrust_reverser.figures.drawing import (
    Cases,
    Drawn,
    curves,
    forces,
    framed,
    names,
    orbit,
    section,
    those,
    timed,
    with_legend,
)
from trsim.studies.thrust_reverser.figures.place import door
from trsim.studies.thrust_reverser.runs import Runs

LIGHT = (("rigid, 0.5 kg", "b_03"), ("flexible, 0.5 kg", "b_03_flexible_light"))
HEAVY = (("rigid, 3.454 kg", "b_03_rigid_heavy"), ("flexible, 3.454 kg", "b_03_flexible_heavy"))
UNDAMPED = ("flexible, 3.454 kg, undamped", "b_03_flexible_undamped")
TABLES = (LIGHT[0], UNDAMPED)
ALL = (*LIGHT, *HEAVY, UNDAMPED)
ENLARGED = 0.295, 0.365  # s


def overview(runs: Runs, cases: Cases) -> Any:
    """The five panels of the study over time."""
    shown = those(runs, *cases)
    figure, axes = panels(3, 2, height=2.1, width=7.2)
    curves(axes[0, 0], shown, "door_angle", "a")
    curves(axes[0, 1], shown, "door_angle.rate", "b")
    curves(axes[1, 0], shown, "door_angle.acceleration", "c")
    forces(axes[1, 1], shown, "B", "d")
    curves(axes[2, 0], shown, "actuator.force", "e")
    forces(axes[2, 1], shown, "B", "", "(d) enlarged")
    axes[2, 1].set_xlim(*ENLARGED)
    timed(axes[2])
    figure.align_ylabels()
    return with_legend(figure, axes[0, 0], shown)


def figure_19(runs: Runs) -> Any:
    """Orbits at B."""
    shown = those(runs, *ALL)
    figure, axes = panels(2, 3, height=2.7, width=7.2)
    for a, one, letter in zip(axes.flat, shown, "abcde", strict=False):
        shade = orbit(a, one, "B", letter, one.label.replace(", undamped", ",\nundamped"))
    axes[1, 2].set_visible(False)
    framed(list(axes.flat), 0.3)
    for a in axes[:, 1:].flat:
        a.set_ylabel("")
    figure.colorbar(shade, ax=list(axes.flat), label="time (s)", aspect=50)
    return figure


def figure_21(runs: Runs) -> Any:
    """Poincare sections at B, by mass."""
    figure, (axes,) = panels(1, 2, height=3.3)
    groups = (LIGHT, (*HEAVY, UNDAMPED))
    for a, cases, mass in zip(axes, groups, ("0.5 kg", "3.454 kg"), strict=True):
        section(a, those(runs, *cases), "B_orbit", "", f"section at B, {mass}")
        a.legend(loc="center")
    return figure


FIGURES = (
    Drawn("18", "abcde", "Rigid and flexible rod of the same mass, 0.5 kg.", names(LIGHT),
          lambda runs: overview(runs, LIGHT)),
    Drawn("18 with the mass of the section", "abcde",
          "Rigid and flexible rod of the same mass, 3.454 kg, that of the section in steel.",
          names(HEAVY), lambda runs: overview(runs, HEAVY)),
    Drawn("18 with the tables as they stand", "abcde",
          "A rigid rod of 0.5 kg and a flexible one of 3.454 kg, without damping.",
          names(TABLES), lambda runs: overview(runs, TABLES)),
    Drawn("19", "ab", "Orbits of the journal at B with five rods.", names(ALL), figure_19),
    Drawn("20", "ab", "Phase diagrams of the door with rigid and flexible rods; below them its "
          "acceleration.", names((*LIGHT, *HEAVY)),
          lambda runs: door(runs, (*LIGHT, *HEAVY), "abcd")),
    Drawn("21", "", "Poincar\u00e9 sections at B with five rods.", names(ALL), figure_21),
)  # fmt: skip
