"""python -m benchmarks [NAME ...]: run the measurements and print their tables.

python -m benchmarks beside [WHAT ...]: words after `beside` say what of it (beside.py).
"""

import sys
from importlib import import_module

NAMES = (
    *("startup", "memory", "reverser", "reverser_ideal", "reverser_steps", "reverser_table"),
    *("beside", "rods", "skipping", "sweeps", "thousands", "dask"),
    *("slider_crank", "andrews", "pendulum", "windows", "chain", "stiff_chain", "chains"),
    "contacts",
    *("flexible_pendulum", "spatial", "turns"),
    *("norm", "works", "kinematic", "beams", "user_events", "sections", "symmetry", "certify"),
    *("lyapunov", "jam"),
)
LONG = ("tolerances", "verdicts")  # ten minutes and more: run by their names only


def main() -> None:
    names, words = sys.argv[1:], []
    if names and names[0] == "beside":
        names, words = names[:1], [names[1:]]
    for name in names or NAMES:
        module = import_module(f"benchmarks.{name}")
        print(f"\n{module.__doc__.splitlines()[0]}\n")
        module.main(*words)


if __name__ == "__main__":
    main()
