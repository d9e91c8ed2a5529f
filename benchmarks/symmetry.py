"""The thrust reverser in space: quantities that must be equal, over their largest value.

Equal gas loads; mechanisms of tests/linkages.py.
"""

from collections.abc import Iterable

import numpy as np

from benchmarks.tables import head, power, row
from tests.linkages import spatial
from tests.runs import Run
from tests.solve.test_spatial_reverser import DOOR, EQUAL, FIXED, MIRROR, apart
from tests.spatial import done

BOUND = "1e-9"
WAYS = {"rk4, 0.1 ms": FIXED} | {
    f"auto {tolerance}" if tolerance == "1e-6" else tolerance: (f"solver.tolerance={tolerance}",)
    for tolerance in ("1e-6", "1e-9", "1e-11")
}


def largest(pairs: Iterable[tuple[np.ndarray, np.ndarray]]) -> float:
    return float(max(apart(one, other) for one, other in pairs))


def of_chains(r: Run) -> float:
    """Doors of mirrored chains."""
    mirrored = ((1, 5), (2, 4))
    return largest(
        (r[f"chain_{i}_{name}"], r[f"chain_{j}_{name}"]) for i, j in mirrored for name in DOOR
    )


def guided(ways: tuple[str, ...]) -> float:
    """Doors of all chains on an ideal guide."""
    text = spatial("drives: {actuator_1: null, actuator_3: null}", guided=True)
    r = done(text, EQUAL, *ways)
    return largest(
        (r[f"chain_{i}_{name}"], r[f"chain_3_{name}"]) for i in (1, 2, 4, 5) for name in DOOR
    )


def cases(ways: tuple[str, ...]) -> tuple[float, float, float]:
    """Actuator 3 slow against actuator 1 slow: forces, rates of the doors, loads of the lugs."""
    one, three = (done(spatial(), EQUAL, *ways, f"parameters.speed_{k}=418 mm/s") for k in (1, 3))
    return (
        largest((one[f"actuator_{k}.force"], three[f"actuator_{4 - k}.force"]) for k in (1, 2, 3)),
        *(
            largest((one[f"chain_{i}_{name}"], three[f"chain_{j}_{name}"])
                    for i, j in MIRROR.items())
            for name in ("door_angle.rate", "lug.normal_force")
        ),
    )  # fmt: skip


def main() -> None:
    """Print the table."""
    head("", "bound", *WAYS)
    alike = [of_chains(done(spatial(), EQUAL, *way)) for way in WAYS.values()]
    row("mirrored chains, angle and rate of the doors", BOUND, *(power(x, 0) for x in alike))
    alike = [guided(way) for way in WAYS.values()]
    row("all chains on an ideal guide, the same", BOUND, *(power(x, 0) for x in alike))
    names = (
        "actuator 3 slow against 1 slow, mirrored: forces of the actuators",
        "the same, rates of the doors",
        "the same, loads of the lugs",
    )
    found = zip(*(cases(way) for way in WAYS.values()), strict=True)
    for name, several in zip(names, found, strict=True):
        row(name, BOUND, *(power(x, 0) for x in several))


if __name__ == "__main__":
    main()
