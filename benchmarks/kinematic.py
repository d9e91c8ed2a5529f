"""Kinematic analysis: evaluations of a row, of three turns with all channels at 1e-6.

Mechanisms of tests/solve/test_kinematic_counts.py.
"""

from benchmarks.tables import head, row
from tests.solve.test_kinematic_counts import TURNS, turned

ROWS = (160, 36, 16, 8)
HEADS = {
    "rssr": "RSSR, spatial",
    "four-bar": "four-bar",
    "slider-crank": "slider-crank",
    "arm": "arm of three joints",
}


def main() -> None:
    """Print the table."""
    head("rows a turn", *map(str, ROWS))
    for name, told in HEADS.items():
        taken = (turned(name, rows).outcome.statistics["evaluations"] for rows in ROWS)
        row(told, *(f"{count / (TURNS * rows + 1):.1f}"
                    for count, rows in zip(taken, ROWS, strict=True)))  # fmt: skip


if __name__ == "__main__":
    main()
