"""Flexible bars: bent far, vibrating, spun up, beside exact answers.

Scenes of tests/solve/test_beams_at_rest.py and test_beams_moving.py.
"""

from math import pi

import numpy as np

from benchmarks.tables import head, power, row
from tests.runs import run
from tests.solve.test_beams_at_rest import ROOTS, known, stretching, under, vibrations
from tests.solve.test_beams_moving import ahead
from tests.test_scenarios import VALIDATION
from trsim.scenario.load import load

LOAD = 10  # P L^2 / E I
ELEMENTS = (4, 8, 16, 32)
FINE = "bodies.beam.elements=64"
STIFFNESSES = ("1200", "1.2e5", "3e5", "1e6", "1e7")
EXACT = ("bodies.beam.curvature=exact", "bodies.beam.strain=green")
FULL = "bodies.beam.stretching=full"
SPIN_UP = (VALIDATION / "beam_spin_up.yaml").read_text(encoding="utf-8")
# of 16 elements of an independent computation
LAG, SHORTEST, LENGTHENED = 0.573776, -0.0188205, 5.1391e-4  # m


def bent(stiffness: str, *sets: str) -> list[float]:
    """Error of the tip for each mesh, over the length: of 1.2e5 and less beside the exact elastica
    of the same axial stiffness, else beside 64 elements."""
    of = (f"parameters.EA={stiffness}", *sets)
    exact = float(stiffness) <= 1.2e5 and not sets
    right = stretching(float(stiffness), LOAD) if exact else under(LOAD, *of, FINE)
    return [
        float(np.linalg.norm(under(LOAD, *of, f"bodies.beam.elements={n}") - right))
        for n in ELEMENTS
    ]


def tip_force() -> None:
    """Print the errors of a cantilever under a tip force."""
    head("E A L^2 / E I", "4 elements", *map(str, ELEMENTS[1:]))
    for stiffness in STIFFNESSES:
        ours, exact = bent(stiffness), bent(stiffness, *EXACT)
        row(stiffness, *(f"{power(a)} / {power(b)}" for a, b in zip(ours, exact, strict=True)))
    # beside the elastica that does not stretch, from which 1e7 is less than 1e-6 away
    stiff = ("parameters.EA=1e7", FULL)
    locked = (under(LOAD, *stiff, f"bodies.beam.elements={n}") - known(LOAD) for n in ELEMENTS)
    row("1e7, `stretching: full`", *(power(float(np.linalg.norm(off))) for off in locked))


def frequencies() -> None:
    """Print the errors of the first and the fifth frequency."""
    head("", "8 elements", "16", "32")
    for held, told in (("clamped", ""), ("free", ""), ("pinned", " at both ends")):
        cells = []
        for n in (8, 16, 32):
            read = load(VALIDATION / f"beam_{held}.yaml", [f"bodies.beam.elements={n}"])
            found = np.array([mode.frequency for mode in vibrations(read)[1][:5]])
            off = np.abs(found / (np.square(ROOTS[held]) / (2 * pi)) - 1.0)
            cells.append(f"{power(off[0], 0)} ... {power(off[-1])}")
        row(held + told, *cells)


def spun(*sets: str) -> tuple[float, float, float]:
    """Largest lag, shortest, and mean lengthening after 16 s of the tip, m."""
    r = run(SPIN_UP, *sets)
    longer, forwards = ahead(r)
    return -forwards.min(), longer.min(), longer[r.t > 16].mean()


def spin_up() -> None:
    """Print the spin-up of a bar of 10 m."""
    runs = [spun(f"bodies.bar.elements={n}", f"solver.tolerance={tolerance}")
            for n, tolerance in ((4, "1e-4"), (8, "1e-6"))]  # fmt: skip
    lags, shortest, lengthened = zip(*runs, strict=True)
    head("", "reference", "4 elements, 1e-4", "8 elements, 1e-6")
    row("largest lag, m, at 6.76 s", LAG, *(f"{x:.6f}" for x in lags))
    row("shortest, m", SHORTEST, *(f"{x:.6f}" for x in shortest))
    row("mean lengthening after 16 s, m", power(LENGTHENED, 4), *(power(x, 4) for x in lengthened))


def main() -> None:
    """Print the tables."""
    tip_force()
    print()
    frequencies()
    print()
    spin_up()


if __name__ == "__main__":
    main()
