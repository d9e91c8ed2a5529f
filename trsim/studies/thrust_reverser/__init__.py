"""The published study of the thrust reverser: its figures, and a verdict on each of its claims."""

from trsim.studies.study import Moving, Study
from trsim.studies.thrust_reverser import content, peaks
from trsim.studies.thrust_reverser.claims import CLAIMS
from trsim.studies.thrust_reverser.figures import FIGURES, laws

SECTIONS = {
    "2": "Section 2: the mechanism",
    "3.1": "Section 3: contact and friction laws",
    "3.2": "Section 3: contact and friction laws",
    "6.2": "Section 6.2: verification",
    "7.1.1": "Section 7.1.1: value of the clearance",
    "7.1.2": "Section 7.1.2: place of the clearance",
    "7.1.3": "Section 7.1.3: driving speed",
    "7.1.4": "Section 7.1.4: flexible rod",
    "7.2": "Section 7.2: five doors and three actuators",
    "8": "Section 8: conclusions beyond section 7",
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
    moving=Moving("ab_03", 30.0),
    grids=("spatial_jam",),
    references={
        "pendulum_8": "pendulum_16",  # which is no chain
        **{f"{less}_kicked": less for less in ("no_spring", "no_lug", "neither")},
    },
    reference="ideal",
    law=laws.number,
    write=peaks.write,
    more=peaks.sections,
)
