"""Runs of the thrust reverser in space, each made once, and what tests ask of them."""

from functools import cache

import numpy as np

from trsim.scenario.load import loads

from .linkages import REVERSER, spatial
from .runs import energy_error, run

NAMES = ("actuator_1", "actuator_2", "actuator_3")
FEW_ROWS = "output.every=0.5/0.42/100"  # in place of 1,000: extremes are found between them
RIGID = f"drives: {{{', '.join(f'{name}: {{stiffness: null, damping: 0}}' for name in NAMES)}}}"


@cache
def done(text, *sets):
    """A run whose energy book is closed and whose joints hold, made once."""
    r = run(loads(text, (FEW_ROWS, *sets), folder=REVERSER))
    assert energy_error(r) < (1e-6 if r.scenario.solver.method == "rk4" else 1e-8)
    assert r.outcome.statistics["position_residual"] < 1e-10
    return r


def at_speeds(**speeds):
    """Actuators at these speeds, mm/s, or at 420; as the scenarios are shipped but for
    their rows."""
    return done(spatial(), *(f"parameters.{k}={v} mm/s" for k, v in speeds.items()))


def peaks(*runs):
    """Largest forces of the actuators, N, over some runs."""
    return np.max([[r.largest(f"{name}.force")[0] for name in NAMES] for r in runs], axis=0)


def odd_peaks(j):
    """With actuator j slow and fast by 2 mm/s: all that the study tries lies between."""
    return peaks(*(at_speeds(**{f"speed_{j}": v}) for v in (418, 422)))
