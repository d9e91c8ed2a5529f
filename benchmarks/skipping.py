"""What a scene does not have costs nothing: one reverser run, with more and less of it asked for.

A run with all channels in space does the most; each line leaves something out or adds it.  Steps
are those of the error control; us/rhs is the time of one look at the equations of motion.
"""

from statistics import median

from benchmarks.measure import SCENARIOS
from trsim.analyse.trajectory import marched
from trsim.assemble.assemble import assemble
from trsim.scenario.load import load

IDEAL = SCENARIOS / "thrust_reverser" / "ideal.yaml"
ONE = SCENARIOS / "thrust_reverser" / "clearance_b_0.3mm.yaml"
TWO = SCENARIOS / "thrust_reverser" / "clearance_ab_0.3mm.yaml"
FLEXIBLE = SCENARIOS / "thrust_reverser" / "flexible_rod_paper_damped.yaml"
NO_ROWS = ("output.channels=[]",)
BODIES = {"fairing": 2.667, "door": 1.584e-2, "large_rod": 2.017e-3, "transfer": 1.777e-4}
SPACE = ("planar=false", *(f"bodies.{name}.inertia=[{x}, {x}, {x}]" for name, x in BODIES.items()))
CASES = {
    "ideal joints": (IDEAL, ()),
    "ideal joints, no channels": (IDEAL, NO_ROWS),
    "ideal joints, in space": (IDEAL, SPACE),
    "clearance at B": (ONE, ()),
    "clearance at B, no channels": (ONE, NO_ROWS),
    "clearance at B, in space": (ONE, SPACE),
    "clearance at A and B": (TWO, ()),
    "clearance at A and B, no channels": (TWO, NO_ROWS),
    "clearance at B, rod flexible (1e-4)": (FLEXIBLE, ()),
    "clearance at B, rod flexible (1e-4), no channels": (FLEXIBLE, NO_ROWS),
}
REPEATS = 5


def main() -> None:
    """Print the table."""
    print("| | CPU s | right-hand sides | us each | unknowns | rows |")
    print("|---|---|---|---|---|---|")
    for label, (file, sets) in CASES.items():
        scenario = load(file, sets)
        mechanism = assemble(scenario)
        runs = [marched(scenario, mechanism)[1].statistics for _ in range(REPEATS + 1)][1:]
        cpu, looks = median(run["integration_cpu"] for run in runs), runs[0]["evaluations"]
        print(f"| {label} | {cpu:.3f} | {looks} | {1e6 * cpu / looks:.1f} | "
              f"{mechanism.model.n_v} | {mechanism.model.m} |", flush=True)  # fmt: skip
