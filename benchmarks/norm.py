"""Accelerations beside a larger motion, and of a journal that rests: errors in tolerances.

Scenes of tests/solve/test_norm.py.
"""

from benchmarks.tables import head, row
from tests.solve.test_norm import beside, settled

TOLERANCES = ("2e-3", "1.1e-3", "5e-4", "1e-4", "1e-5", "1e-6")


def main() -> None:
    """Print the tables."""
    for off, methods, tolerances in (
        (beside, ("dop853", "radau", "generalized_alpha"), ("1e-3", "1e-4")),
        (settled, ("dop853", "auto", "radau"), TOLERANCES),
    ):
        head("method", *tolerances)
        for method in methods:
            found = (off(method, float(told)) / float(told) for told in tolerances)
            row(method, *(f"{x:.2g}" for x in found))
        print()


if __name__ == "__main__":
    main()
