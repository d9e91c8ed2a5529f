"""Stiff chains of n rods, 50 ms: Radau with sparse systems (ggl) against dense ones (index1)."""

from benchmarks.measure import run
from benchmarks.problems import stiff_chain
from trsim.assemble.assemble import assemble
from trsim.scenario import text
from trsim.scenario.load import loads

SIZES = (40, 160, 640)
DENSE_UP_TO = 40  # rods: 160 take minutes
CROSSOVER = (3, 4, 6, 8, 12, 20, 40)
VALUES = 10**5  # of a scenario; 640 rods are longer than what a person writes


def told(n: int, formulation: str, planar: bool = True) -> dict[str, float]:
    """Statistics of a run."""
    limits = "limits={bodies: 1000, rows: 10000, entries: 5000}"
    scenario = loads(stiff_chain(n, planar), [f"solver.formulation={formulation}", limits])
    statistics: dict[str, float] = run(scenario, assemble(scenario)).outcome.statistics
    return statistics


def each(found: dict[str, float], n: int) -> float:
    """Microseconds per rod and Newton iteration, everything counted."""
    return 1e6 * found["integration_cpu"] / found["newton_iterations"] / n


def growth() -> None:
    """What a Newton iteration costs as the chain grows."""
    cost: dict[int, float] = {}
    print(
        f"  {'rods':>6} {'':10} {'CPU s':>9} {'steps':>6} {'Jacobians':>9} {'us/rod/iteration':>17}"
    )
    for n in SIZES:
        for formulation in ("index1", "ggl") if n <= DENSE_UP_TO else ("ggl",):
            found = told(n, formulation)
            cost[n] = each(found, n)
            print(f"  {n:6} {formulation:10} {found['integration_cpu']:9.3f} {found['steps']:6.0f} "
                  f"{found['jacobians']:9.0f} {cost[n]:17.2f}")  # fmt: skip
    first, *larger = SIZES
    ratios = ", ".join(f"{n}: {cost[n] / cost[first]:.2f}" for n in larger)
    print(f"  per rod, times that of {first} rods: {ratios}")


def crossover() -> None:
    """From how many bodies on sparse systems are cheaper."""
    for planar in (True, False):
        kind = "planar" if planar else "spatial"
        for n in CROSSOVER if planar else CROSSOVER[:-1]:
            dense, sparse = (
                sorted(told(n, f, planar)["integration_cpu"] for _ in range(3))[1]
                for f in ("index1", "ggl")
            )
            print(f"  {kind} {n:3} rods: index1 takes {dense / sparse:.2f} times the CPU of ggl")


def main() -> None:
    text.MOST = VALUES
    growth()
    print()
    crossover()


if __name__ == "__main__":
    main()
