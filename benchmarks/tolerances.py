"""Which tolerance of the pins decides what: total indices of Sobol, first orders in brackets.

With half of their 95 % intervals.
"""

from collections.abc import Sequence

import numpy as np

import trsim
from benchmarks.measure import ROOT, SCENARIOS
from benchmarks.tables import head, row
from trsim.analyse.cases import numbers
from trsim.analyse.sobol import Index, blocks, factors, indices, places
from trsim.sweeps.study import Study

SCENARIO = SCENARIOS / "thrust_reverser" / "tolerances.yaml"
FOLDER = ROOT / "runs" / "tolerances"
OUTPUTS = {
    "peak:B.contact_force": "largest force at B",
    "peak:A.contact_force@0.29..0.5": "largest impact at A, 0.29 to 0.5 s",
    "fluctuation:door_angle.rate@0.31..0.98": "fluctuation of the door's rate",
    "peak:actuator.force@0.5..1": "late maximum of the drive force",
}
KEYS = {
    "joints.A.clearance": "play at A",
    "joints.B.clearance": "play at B",
    "contact_laws.pin.friction.coefficient": "friction",
    "contact_laws.pin.restitution": "restitution",
    "parameters.noise": "chance",
}
ROWS = (8, 16, 32, 64, 128)
SETTLING = "fluctuation:door_angle.rate@0.31..0.98", "joints.B.clearance"


def told(one: Index) -> str:
    half = 0.5 * (one.total_high - one.total_low)
    if one.total < 0.01:
        return f"{one.total:.3f}"
    return f"{one.total:.2f} +- {half:.2f} ({one.first:.2f})"


def main() -> None:
    """Print the table, and how one index settles; rerun it to resume."""
    study = trsim.sweep(SCENARIO, FOLDER).study
    head("", *(KEYS[key] for key in factors(study, study.cases)))
    for word, name in OUTPUTS.items():
        keys, found = of(study, word)
        by_key = {one.key: one for one in found.indices}
        row(name, *(told(by_key[key]) for key in keys))
        if word == SETTLING[0]:
            at = list(keys).index(SETTLING[1])
            settling = [(rows, float(total[at])) for rows, _, total in found.convergence]
    print()
    head("rows", *(str(rows) for rows, _ in settling))
    row(f"{OUTPUTS[SETTLING[0]]}: total index of {KEYS[SETTLING[1]]}",
        *(f"{total:.2f}" for _, total in settling))  # fmt: skip


def of(study: Study, word: str) -> tuple[Sequence[str], trsim.analyse.sobol.Indices]:
    """Indices of a number, and their keys in order."""
    values = numbers(study, [word])[word].values
    table, keys = places(study, study.cases), factors(study, study.cases)
    taken, left_out = blocks(table, lambda case: values.get(case.name, np.nan))
    return keys, indices(keys, taken, word, left_out=left_out)


if __name__ == "__main__":
    main()
