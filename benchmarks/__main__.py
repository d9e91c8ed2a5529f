"""python -m benchmarks [NAME ...]: run the measurements and print their tables."""

import sys
from importlib import import_module

NAMES = (
    *("startup", "memory", "reverser", "reverser_ideal", "reverser_steps", "reverser_table"),
    *("rods", "skipping", "sweeps", "thousands", "dask"),
    *("slider_crank", "andrews", "pendulum", "windows", "chain", "stiff_chain", "chains"),
    "contacts",
    *("flexible_pendulum", "spatial", "turns"),
    *("norm", "works", "kinematic", "beams", "user_events", "sections", "symmetry", "certify"),
    *("lyapunov", "jam"),
)
LONG = ("tolerances", "verdicts")  # ten minutes and more: run by their names only


def main() -> None:
    for name in sys.argv[1:] or NAMES:
        module = import_module(f"benchmarks.{name}")
        print(f"\n{module.__doc__.splitlines()[0]}\n")
        module.main()


if __name__ == "__main__":
    main()
