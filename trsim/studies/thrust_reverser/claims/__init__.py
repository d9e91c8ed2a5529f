"""What the study of the thrust reverser claims, section by section."""

from trsim.studies.claim import Claim
from trsim.studies.thrust_reverser.claims import (
    clearance,
    conclusions,
    model,
    place,
    rod,
    spatial,
    speed,
)

IN_ORDER = (model, clearance, place, speed, rod, spatial, conclusions)
CLAIMS: tuple[Claim, ...] = (
    *(claim for module in IN_ORDER for claim in module.CLAIMS),
    *spatial.CONCLUSIONS,
)
