"""The figures of the study, by the numbers they have there."""

from trsim.studies.drawing import Drawn
from trsim.studies.thrust_reverser.figures import (
    chain,
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

IN_ORDER = (chain, laws, pendulum, clearance, place, speed, rod, mechanism, spatial, sticking)
FIGURES: tuple[Drawn, ...] = tuple(drawn for module in IN_ORDER for drawn in module.FIGURES)
