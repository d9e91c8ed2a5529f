"""The published study of a crew entrance door: its figures, and a verdict on each statement."""

from trsim.studies.crew_door import checks, content
from trsim.studies.crew_door.claims import CLAIMS
from trsim.studies.crew_door.figures import FIGURES
from trsim.studies.study import Moving, Study

SECTIONS = {
    "3.1": "Sections 3 and 5.2: how contacts are modelled",
    "3.2": "Section 3.2: loads of the hand",
    "4.1": "Section 4.1: lifting",
    "4.2": "Section 4.2: jams",
    "4.3": "Section 4.3: opening",
    "4.4": "Section 4.4: the opened door",
    "4.5": "Section 4.5: jettison",
}

STUDY = Study(
    title=content.TITLE,
    lead=content.LEAD,
    verdicts=content.VERDICTS,
    assumptions=content.ASSUMPTIONS,
    contradictions=content.CONTRADICTIONS,
    sections=SECTIONS,
    claims=CLAIMS,
    figures=FIGURES,
    moving=Moving("lift_inner"),
    grids=("running",),
    book=0.1,  # of 800 J; static paths integrate their works over the rows
    references={
        "lift_inner": "path_inner",
        "lift_inner_op": "path_inner_op",
        "lift_inner_gap": "path_inner_gap",
        "lift_inner_tight": "lift_inner",
    },
    write=checks.write,
    more=checks.sections,
)
