"""Works of loads along a driven stroke of 1 m: error over the work, and steps.

Scenes of tests/solve/test_works.py, whose works are known.
"""

from benchmarks.tables import head, power, row
from tests.solve.test_works import LOADS, stroke

HEADS = {
    "triangle": "triangle, 100 mm wide",
    "bump": "bump, exp(-(x/20 mm)^2)",
    "periods": "25 periods of sin^2",
    "table": "table",
}
CASES = (
    ("dop853", "1e-4"), ("dop853", "1e-8"), ("dop853", "1e-10"), ("radau", "1e-4"),
    ("radau", "1e-8"), ("generalized_alpha", "1e-6"), ("scipy:RK45", "1e-6"),
)  # fmt: skip


def cell(load: str, method: str, tolerance: str) -> str:
    """Error and steps of one run."""
    r, work = stroke(load, method, tolerance)
    off = abs(r["energy.work.loads"][-1] - work) / abs(work)
    return f"{power(off, 0)}, {r.outcome.statistics['steps']}"


def main() -> None:
    """Print the table."""
    head("method", "tolerance", *(HEADS[load] for load in LOADS))
    for method, tolerance in CASES:
        row(method, tolerance, *(cell(load, method, tolerance) for load in LOADS))


if __name__ == "__main__":
    main()
