"""How a static path ended, and its numbers."""

from typing import Any

import numpy as np

from trsim.elements.scene import scene
from trsim.solve.march import record as rec
from trsim.solve.outcome import Outcome, new_record, statistics


def numbers(path: Any) -> dict[str, float]:
    """What statistics tell of it: its lowest eigenvalue, its largest ratio of inertia."""
    found = {}
    if np.isfinite(path.lowest[0]):
        found["lowest_eigenvalue"], found["lowest_eigenvalue_time"] = path.lowest
    if ratios := path.results.ratios():
        _, ratio, when = max(ratios, key=lambda one: one[1])
        found["inertia_ratio"], found["inertia_ratio_time"] = ratio, when
    return found


def outcome(path: Any, cpu: float) -> Outcome:
    """How it ended, and what is told of it."""
    work, kept = scene(path.mechanism.model), path.results
    r = new_record(work, path.begun, (), 1)
    r.steps, r.rejected, r.events = path.steps, path.rejected, path.log.count
    r.t = kept.last.t if kept.last else 0.0
    r.largest_energy, r.largest_residual = kept.largest_energy, kept.largest_residual
    for k in range(rec.N_PEAK):
        r.peak[k] = kept.peak[k]
    found = statistics(r, work, path.begun, cpu)
    found["evaluations"] = int(path.eq.work.status[1])
    found |= numbers(path)
    return Outcome(path.log.status, path.log.reason, float(r.t), found, kept.peak.T.copy(),
                   r, path.begun, path.log.fired, said=tuple(path.log.said()))  # fmt: skip
