"""What kinematic analysis needs: a mechanism that is driven in all its freedoms; else a refusal.

Rows of joints and rigid drives are then as many as velocities (mobility 0), and J is square.  It is
regular but at singular positions: a turning point, behind which there is no position, or a place
where branches of the motion meet, and the drives do not say along which it goes on.
"""

from typing import Any

import numpy as np

from trsim.assemble.assemble import assemble
from trsim.assemble.dense import product
from trsim.assemble.mechanism import Mechanism
from trsim.assemble.reduce import jacobian, moves
from trsim.elements.scene import workspace
from trsim.errors import ModelError, ScenarioError, some
from trsim.solve.diagnose.singular import DYNAMIC, SHOWN
from trsim.solve.start.statics import free_motions, mass_matrix
from trsim.solve.start.velocities import rate_of_entry

MOVES = 1e-6  # of the largest rate: what is less does not move


def check_driven(scenario: Any, mechanism: Mechanism) -> None:
    """Refuse what kinematic analysis cannot tell.  Raises ScenarioError, ModelError."""
    method = scenario.solver.method
    for instance in mechanism.instances:
        if instance.section == "drives" and instance.row.is_force:
            raise ScenarioError(
                f"gives way, and {method} analysis knows no deflection that a force decides",
                f"make it rigid, {DYNAMIC}",
                ("drives", instance.name),
            )
        if instance.row.contact is not None:
            raise ScenarioError(
                f"is a contact, whose force depends on how it began: {method} analysis has no past",
                f"leave it out, {DYNAMIC}",
                (instance.section, instance.name),
            )
    if mechanism.stages.switches.phases:
        raise ScenarioError(
            f"{method} analysis knows no phases: what one lets go of would be free",
            f"leave `phases` out, {DYNAMIC}",
            ("phases",),
        )
    for event in mechanism.stages.switches.events:
        if event.turned:
            raise ScenarioError(
                f"{event.said}, and {method} analysis knows events that record or end a run alone: "
                "what others change may leave something free",
                f"leave it out, {DYNAMIC}",
                ("events", event.name),
            )
    if mechanism.beams:
        raise ScenarioError(
            f"bends as its forces say, and {method} analysis knows places alone",
            f"make it rigid (`flexible: false`), {DYNAMIC}",
            ("bodies", next(iter(mechanism.beams))),
        )
    if mechanism.mobility > 0:
        raise ModelError(
            f"{method} analysis needs a drive for every freedom, and {mechanism.mobility} "
            f"{'is' if mechanism.mobility == 1 else 'are'} left: {free(scenario, mechanism)}",
            f"add a rigid drive to one of the joints named, {DYNAMIC}",
            ("solver", "method"),
        )


def free(scenario: Any, mechanism: Mechanism) -> str:
    """What can still move as drawn: coordinates of joints, or bodies that no joint holds."""
    joints = tuple(scenario.joints)
    whole = assemble(scenario, coordinates=joints, planar=mechanism.planar)
    model, y = workspace(whole.model), whole.y0
    there = moves(model, model.d == 3)
    Z = free_motions(jacobian(model, 0.0, y)[2], there, mass_matrix(model, y))
    unit = np.tile([1.0] * 3 + [model.size] * 3, model.n - 1)
    most = float(np.abs(Z * unit[:, None]).max(initial=0.0))
    found = []
    for name, x in whole.coordinates.items():
        gradient = rate_of_entry(model, y, x.entry, (x.i, x.j))
        rate = float(np.abs(product(Z.T, gradient)).max(initial=0.0))
        if rate * (model.size if x.kind == "angle" else 1.0) > MOVES * most:
            found.append(f"{x.kind} of '{name}'")
    if found:
        return some(tuple(found), SHOWN)
    largest = np.abs(Z * unit[:, None]).reshape(-1, 6 * Z.shape[1]).max(axis=1, initial=0.0)
    bodies = [n for n, f in whole.frames.items() if f > 0 and largest[f - 1] > MOVES * most]
    return some(tuple(f"'{name}'" for name in bodies), SHOWN)
