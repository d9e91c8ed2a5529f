"""Where a static path begins, and what it cannot tell.

It begins in equilibrium without friction, reached from the drawing or from values of joints; where
there is none as drawn, with friction that holds it there.
"""

from dataclasses import replace
from functools import partial
from typing import Any

from trsim.assemble.mechanism import Mechanism
from trsim.assemble.switches import LOOSE
from trsim.errors import ModelError, ScenarioError
from trsim.scenario.initial import Initial
from trsim.solve.rest import standing, without_rates
from trsim.solve.start.consistent import Start, positions, start
from trsim.solve.start.statics import check_stable

INSTEAD = "or let the motion be computed: leave `method` out"


def check(scenario: Any, mechanism: Mechanism) -> None:
    """Refuse what has no static path.  Raises ScenarioError."""
    phased = any(mechanism.stages.switches.static)
    method = "static phase" if phased else scenario.solver.method
    for instance in mechanism.instances:
        if instance.row.piston >= 0:
            raise ScenarioError(
                f"moves a piston with a mass, and a {method} knows no motion of its own",
                f"leave its `supply` out, {INSTEAD}",
                (instance.section, instance.name),
            )
    for event in mechanism.stages.switches.events:
        names = mechanism.stages.switches.names
        if not phased and any(names[n][0] != "drives" or to != LOOSE for n, to in event.turned):
            raise ScenarioError(
                f"{event.said}, and a {method} knows events that record, end a run or let a drive "
                "go",
                f"leave it out, {INSTEAD}",
                ("events", event.name),
            )
    if mechanism.beams:
        raise ScenarioError(
            f"bends, and a {method} is one of rigid bodies",
            f"make it rigid (`flexible: false`), {INSTEAD}",
            ("bodies", next(iter(mechanism.beams))),
        )
    if mechanism.sections:
        raise ScenarioError(
            f"is a section of a motion, and a {method} is none",
            f"leave it out, {INSTEAD}",
            ("poincare", mechanism.sections[0].name),
        )


def begin(scenario: Any, mechanism: Mechanism) -> Start:
    """The start of a path; raises ModelError where there is none."""
    still = standing(scenario, mechanism)
    if scenario.initial.values:
        y, *_ = positions(still, mechanism, Initial((), scenario.initial.values))
        mechanism = replace(mechanism, y0=y)
    whole = Initial(tuple(still.joints), {}, True)
    try:
        settled = still.model_copy(update={"initial": whole})
        begun = start(settled, mechanism, False, partial(judged, any_slides(mechanism)))
    except ModelError:
        if not any_slides(mechanism):
            raise
        begun = start(still, mechanism, False)
    return replace(begun, y=without_rates(mechanism, begun.y))


def any_slides(mechanism: Mechanism) -> bool:
    """Whether anything may rub, and so hold what nothing else does."""
    return any(instance.element.slides for instance in mechanism.instances)


def judged(rubs: bool, *found: Any) -> None:
    """Refuse an equilibrium in which nothing holds a motion; one that is unstable is told later."""
    try:
        check_stable(*found)
    except ModelError as error:
        if not rubs and "indifferent" in error.what:
            hint = "add a spring, a stop, a drive or friction"
            raise ModelError(error.what, hint, ("solver", "method")) from None
