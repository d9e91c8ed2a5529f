"""Phase after many turns, and small vibrations: errors in tolerances, and steps.

A disc on a torsion spring, theta = theta_0 cos(20 t): each turn adds the local errors of its steps.
"""

from math import pi

import numpy as np

from benchmarks.measure import run

RATE = 20.0  # rad/s: sqrt(2 / 5e-3)
METHODS = ("dop853", "radau", "generalized_alpha", "scipy:RK45", "scipy:Radau", "scipy:BDF")
TOLERANCES, TURNS = ("1e-2", "1e-3", "1e-4", "3e-5", "1e-6", "1e-8"), 16
AMPLITUDES, SHORT, LOOSE = (1.0, 1e-2, 1e-4), 8, "1e-3"
COARSE = 3e-5  # tolerance: generalized_alpha is of order 2 and not meant for a tighter one


def swung(method: str, tolerance: str, amplitude: float, turns: int) -> tuple[float, int]:
    """Largest error over tolerance and amplitude, and steps."""
    from trsim.assemble.assemble import assemble
    from trsim.scenario.load import loads

    scenario = loads(f"""
bodies: {{disc: {{mass: 2, inertia: 5e-3}}}}
joints: {{pin: {{type: revolute, bodies: [ground, disc], at: [0, 0]}}}}
sensors: {{angle: {{joint: pin, at_start: {amplitude}}}}}
forces: {{spring: {{type: torsion_spring, joint: pin, stiffness: 2, preload: {-2 * amplitude}}}}}
solver: {{end: {turns * 2 * pi / RATE}, method: '{method}', tolerance: {tolerance}}}
output: {{every: 0.01}}
""")
    r = run(scenario, assemble(scenario))
    off = np.abs(r.channel("angle") - amplitude * np.cos(RATE * r.rows[:, 0])).max()
    return off / amplitude / float(tolerance), int(r.outcome.statistics["steps"])


def main() -> None:
    print(f"error over tolerance after {TURNS} turns, steps of a turn")
    print("| method |", " | ".join(TOLERANCES), "|")
    print("|---|" + "---|" * len(TOLERANCES))
    for method in METHODS:
        cells = []
        for tolerance in TOLERANCES:
            if method == "generalized_alpha" and float(tolerance) < COARSE:
                cells.append("")
                continue
            off, steps = swung(method, tolerance, 1.0, TURNS)
            cells.append(f"{off:.2g}, {steps / TURNS:.3g}")
        print(f"| {method} |", " | ".join(cells), "|")
    print(f"\nerror over {LOOSE} and the amplitude after {SHORT} turns, steps of the run")
    print("| method |", " | ".join(f"{a:g} rad" for a in AMPLITUDES), "|")
    print("|---|" + "---|" * len(AMPLITUDES))
    for method in METHODS:
        found = [swung(method, LOOSE, a, SHORT) for a in AMPLITUDES]
        print(f"| {method} |", " | ".join(f"{off:.2g}, {steps}" for off, steps in found), "|")


if __name__ == "__main__":
    main()
