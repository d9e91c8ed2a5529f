"""The figures of the study, by the numbers they have there."""

from trsim.studies.thrust_reverser.figures import (
    clearance,
    laws,
    mechanism,
    pendulum,
    place,
    rod,
    spatial,
    speed,
    sticking,
)
from trsim.studies.thrust_reverser.figures.drawing import Drawn

FIGURES: tuple[Drawn, ...] = (
    *laws.FIGURES,
    *pendulum.FIGURES,
    *clearance.FIGURES,
    *place.FIGURES,
    *speed.FIGURES,
    *rod.FIGURES,
    *mechanism.FIGURES,
    *spatial.FIGURES,
    *sticking.FIGURES,
)
