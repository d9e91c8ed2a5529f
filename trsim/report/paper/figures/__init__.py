"""The figures of the study, by the numbers they have there."""

from trsim.report.paper.figures import (
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
from trsim.report.paper.figures.drawing import Drawn

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
