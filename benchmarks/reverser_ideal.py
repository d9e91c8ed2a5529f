"""Thrust reverser with ideal joints at 0.5 m/s: angle and forces over the stroke."""

import numpy as np

from benchmarks.measure import SCENARIOS, run

STROKES = (0.200, 0.250, 0.300, 0.350, 0.400, 0.450, 0.475, 0.500)  # m
HEADS = ("stroke m", "time s", "door deg", "gas N", "drive N (hold-back +)",
         "y of the door's force at B N", "Q N", "lug N")  # fmt: skip


def main() -> None:
    from trsim.assemble.assemble import assemble
    from trsim.scenario.load import load

    scenario = load(SCENARIOS / "thrust_reverser" / "ideal.yaml", ())
    result = run(scenario, assemble(scenario))
    stroke = result.channel("stroke")
    q = result.columns["Q.reaction"] + 1
    over = {
        "time": result.rows[:, 0],
        "door": np.degrees(result.channel("door_angle")),
        "gas": result.channel("air.magnitude"),
        "drive": result.channel("actuator.force"),
        "B": -result.rows[:, result.columns["B.reaction"] + 2],  # on the fairing
        "Q": np.hypot(result.rows[:, q], result.rows[:, q + 1]),
        "lug": result.channel("lug.normal_force"),
    }
    print("|", " | ".join(HEADS), "|")
    print("|---" * len(HEADS) + "|")
    for at in STROKES:
        time, door, gas, *forces = (float(np.interp(at, stroke, y)) for y in over.values())
        cells = [f"{at:.3f}", f"{time:.2f}", f"{door:.1f}", f"{gas:.0f}"]
        print("|", " | ".join([*cells, *(f"{force:.1f}" for force in forces)]), "|")


if __name__ == "__main__":
    main()
