"""What the study of the crew door states, section by section."""

from trsim.studies.claim import Claim
from trsim.studies.crew_door.claims import jams, jettison, lifting, model, opened, opening

IN_ORDER = (model, lifting, jams, opening, opened, jettison)
CLAIMS: tuple[Claim, ...] = tuple(claim for module in IN_ORDER for claim in module.CLAIMS)
