"""Bodies so small that one unit of error for all lets them turn as they like.

The error norm has one length L, the reach of the largest body or what a contact presses in, and
lets a turn of a body with arm a be off by tolerance L / a in every step: solve/march/norm.py.
"""

from collections.abc import Iterator
from typing import Any

import numpy as np

from trsim.assemble.mechanism import Mechanism
from trsim.elements.scene import RATE
from trsim.scenario.methods import METHODS
from trsim.solve.outcome import Outcome, whose

COARSE = 1e-2  # rad in a step
HELD = 1e-3  # what is asked for


def of_sizes(scenario: Any, mechanism: Mechanism, outcome: Outcome) -> Iterator[str]:
    """The body whose turns are held least of those that turn."""
    r, model, solver = outcome.record, mechanism.model, scenario.solver
    if not METHODS[solver.method].adaptive:
        return
    rates = np.arange(model.n_q, model.n_q + model.v_node)
    y0 = outcome.start.y
    turns = (model.scale_kind[rates] == RATE) & ((y0[rates] != 0.0) | (r.y[rates] != 0.0))
    if not turns.any():
        return
    at = rates[turns][np.argmin(model.scale[rates[turns]])]
    arm, length = float(model.scale[at]), r.length
    off = solver.tolerance * length / arm
    if off > COARSE:
        body = whose(mechanism, int(at)).rpartition(" of ")[2]
        yield (
            f"solver.tolerance: {solver.tolerance:.3g} of {length:.2g} m, the unit here, "
            f"lets {body} with an arm of {arm:.2g} m turn by {off:.1g} rad too far in a step; "
            f"{solver.tolerance * HELD / off:.1g} holds it to {HELD:g} rad"
        )
