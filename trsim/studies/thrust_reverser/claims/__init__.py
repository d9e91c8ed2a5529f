"""What the study of the thrust reverser claims, section by section."""

from trsim.studies.thrust_reverser.claims import (
    clearance,
    conclusions,
    model,
    place,
    rod,
    spatial,
    speed,
)
from trsim.studies.thrust_reverser.claims.claim import Claim

CLAIMS: tuple[Claim, ...] = (
    *model.CLAIMS,
    *clearance.CLAIMS,
    *place.CLAIMS,
    *speed.CLAIMS,
    *rod.CLAIMS,
    *spatial.CLAIMS,
    *conclusions.CLAIMS,
    *spatial.CONCLUSIONS,
)
