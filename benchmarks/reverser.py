"""Thrust reverser, 1 s: integration CPU time, peak contact forces and their convergence."""

from benchmarks.measure import SCENARIOS, median, run

CASES = ("ideal", "clearance_b_0.3mm", "clearance_a_0.3mm", "clearance_ab_0.3mm")
TOLERANCES = (1e-5, 1e-6, 1e-7, 1e-8)


def main() -> None:
    from trsim.assemble.assemble import assemble
    from trsim.spec.load import load

    print("  scenario             tolerance   CPU s   evaluations   peak at A N   peak at B N")
    for case in CASES:
        for tolerance in TOLERANCES:
            path = SCENARIOS / "thrust_reverser" / f"{case}.yaml"
            scenario = load(path, [f"solver.tolerance={tolerance}"])
            mechanism = assemble(scenario)
            result = run(scenario, mechanism)
            cpu = median(
                lambda s=scenario, m=mechanism: run(s, m).outcome.statistics["integration_cpu"], 3
            )
            peaks = [
                f"{result.peak(f'{joint}.contact_force'):11.1f}"
                if f"{joint}.contact_force" in result.columns
                else " " * 11
                for joint in "AB"
            ]
            count = result.outcome.statistics["evaluations"]
            print(f"  {case:20s} {tolerance:9.0e} {cpu:7.3f} {count:13d}   {'   '.join(peaks)}")
