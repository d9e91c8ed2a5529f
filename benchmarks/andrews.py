"""P3 and A03: Andrews' squeezing mechanism, largest error of seven angles at 30 ms (rad).

Against the recomputed reference: the published one is 1.4e-9 rad off (tests/data/p3_andrews.json).
"""

import json

import numpy as np

from benchmarks.measure import ROOT, Run
from benchmarks.problems import VALIDATION
from benchmarks.work_precision import TOLERANCES, Problem, at_bounds, of_file, table

ANGLES = ("Beta", "Theta", "Gamma", "Phi", "Delta", "Omega", "Epsilon")
DATA = ROOT / "tests" / "data"


def error(r: Run) -> float:
    known = json.loads((DATA / "p3_andrews.json").read_text())["recomputed_angles"]
    return float(np.max(np.abs([r.channel(name)[-1] for name in ANGLES] - np.array(known))))


def energy_error(r: Run) -> float:
    """A03: largest difference between the energy gained and the work of the motor, J."""
    beta = r.channel("Beta")
    gained = r.channel("energy.kinetic") + r.channel("energy.stored.springs")
    return float(np.max(np.abs(gained - gained[0] - 0.033 * (beta - beta[0]))))


def main() -> None:
    from benchmarks.peers import compare

    sensors = 'output.channels=["Beta*", "Theta*", "Gamma*", "Phi*", "Delta*", "Omega*", "Eps*"]'
    source = of_file(VALIDATION / "andrews.yaml")
    problem = Problem(source, error, ("output.every=0.03", sensors))
    found = table(problem, "rad", tolerances=(*TOLERANCES, 1e-11))
    at_bounds(found, (1e-6, 1e-9), "rad")
    compare("andrews", found, "rad")
    print("\n  A03: 50 ms from the round angle, largest energy error (J)")
    source = of_file(VALIDATION / "andrews_iftomm.yaml")
    problem = Problem(source, energy_error, ('output.channels=["Beta", "energy.*"]',))
    found = table(problem, "J", tolerances=(*TOLERANCES, 1e-11))
    at_bounds(found, (1e-9,), "J")
