"""Thrust reverser, 1 s, method auto: steps, evaluations and peaks of runs that write every row."""

import numpy as np

from benchmarks.measure import SCENARIOS, Run, run

CASES = {
    "ideal": ("1e-6",),
    "clearance_b_0.3mm": ("1e-4", "1e-5", "1e-6", "1e-8"),
    "clearance_a_0.3mm": ("1e-4", "1e-5", "1e-6", "1e-8"),
    "clearance_ab_0.3mm": ("1e-4", "1e-5", "1e-6", "1e-8"),
    "clearance_ap_0.1mm": ("1e-4", "1e-5"),
    "clearance_abpq_0.1mm": ("1e-4", "1e-5"),
}
CHAOTIC = ("clearance_ap_0.1mm", "clearance_abpq_0.1mm")  # one run proves nothing of their peaks
HEADS = ("scenario", "tolerance", "steps", "evaluations", "peak at A N", "peak at B N",
         "largest energy residual J")  # fmt: skip


def main() -> None:
    from trsim.assemble.assemble import assemble
    from trsim.scenario.load import load

    print("|", " | ".join(HEADS), "|")
    print("|---" * len(HEADS) + "|")
    for name, tolerances in CASES.items():
        for tolerance in tolerances:
            file = SCENARIOS / "thrust_reverser" / f"{name}.yaml"
            scenario = load(file, [f"solver.tolerance={tolerance}"])
            result = run(scenario, assemble(scenario))
            numbers = result.outcome.statistics
            left = f"{np.abs(result.channel('energy.residual')).max():.0e}".replace("e-0", "e-")
            cells = [name if tolerance == tolerances[0] else "", tolerance,
                     *(f"{numbers[key]:,}".replace(",", " ") for key in ("steps", "evaluations")),
                     *(peak(result, pin, name) for pin in "AB"), left]  # fmt: skip
            print(f"| {' | '.join(cells)} |".replace("|  ", "| "), flush=True)


def peak(result: Run, pin: str, name: str) -> str:
    if f"{pin}.contact_force" not in result.columns:
        return ""
    return "chaotic" if name in CHAOTIC else f"{result.peak(f'{pin}.contact_force'):.1f}"


if __name__ == "__main__":
    main()
