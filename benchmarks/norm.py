"""Accelerations beside a larger motion, and of a journal that rests: errors in tolerances.

Scenes of tests/solve/test_norm.py.
"""

import numpy as np

from benchmarks.tables import head, row
from tests.runs import run
from tests.solve.test_norm import BESIDE, rested

TURNS, LARGEST = 8, 13.0  # m/s^2
RATES = np.linspace(45.0, 75.0, 13)  # rad/s: of any one steps may happen to fit well or badly
TOLERANCES = ("2e-3", "1.1e-3", "5e-4", "1e-4", "1e-5", "1e-6")


def beside(method: str, tolerance: float) -> float:
    """Geometric mean over the rates of the largest error, in tolerances of the largest."""
    off = []
    for rate in RATES:
        end = 2 * np.pi * TURNS / rate
        r = run(BESIDE.format(bent=LARGEST / rate**2, stiffness=rate**2, end=end, method=method,
                              tolerance=tolerance))  # fmt: skip
        exact = -LARGEST * np.cos(rate * r.t)
        off.append(np.abs(r["bob.acceleration"][:, 0] - exact).max())
    return float(np.exp(np.mean(np.log(off)))) / LARGEST / tolerance


def settled(method: str, tolerance: float) -> float:
    """The largest error of the journal's rod, in tolerances of its largest acceleration."""
    tight = rested("radau", 1e-9)
    off = np.abs(rested(method, tolerance) - tight).max()
    return float(off / np.abs(tight).max() / tolerance)


def main() -> None:
    """Print the tables."""
    head("method", "1e-3", "1e-4")
    for method in ("dop853", "radau", "generalized_alpha"):
        row(method, *(f"{beside(method, tolerance):.2g}" for tolerance in (1e-3, 1e-4)))
    print()
    head("method", *TOLERANCES)
    for method in ("dop853", "auto", "radau"):
        row(method, *(f"{settled(method, float(told)):.2g}" for told in TOLERANCES))


if __name__ == "__main__":
    main()
