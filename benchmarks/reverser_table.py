"""Thrust reverser: fluctuation, peaks and orbits of the clearance cases, as tabled in the docs."""

import numpy as np

from benchmarks.measure import SCENARIOS, Run, run

CASES = {
    "ideal": (),
    "A 0.1": ("A=0.1",),
    "A 0.3": ("A=0.3",),
    "A 0.5": ("A=0.5",),
    "B 0.1": ("B=0.1",),
    "B 0.3": ("B=0.3",),
    "B 0.5": ("B=0.5",),
    "A+B 0.1": ("A=0.1", "B=0.1"),
    "A+B 0.3": ("A=0.3", "B=0.3"),
    "A+B 0.5": ("A=0.5", "B=0.5"),
}


def main() -> None:
    from trsim.analyse.fluctuation import fluctuation
    from trsim.assemble.assemble import assemble
    from trsim.scenario.load import load

    print("  case      door rate hp   drive hp N   drive max N at s     "
          "peak A N   peak B N   max |d angle| deg   flight B %   std e_x B mm")  # fmt: skip
    ideal = None
    for label, plays in CASES.items():
        joints = [part.split("=")[0] for part in plays]
        name = (
            "clearance_ab_0.1mm"
            if len(plays) == 2
            else f"clearance_{(joints or ['b'])[0].lower()}_0.3mm"
        )
        path = SCENARIOS / "thrust_reverser" / (f"{name}.yaml" if plays else "ideal.yaml")
        sets = [f"joints.{part.split('=')[0]}.clearance={part.split('=')[1]} mm" for part in plays]
        scenario = load(path, sets)
        mechanism = assemble(scenario)
        result = run(scenario, mechanism)
        t, angle = result.rows[:, 0], result.channel("door_angle")
        ideal = angle if ideal is None else ideal
        end = scenario.solver.end - 0.020
        rate = fluctuation(t, result.channel("door_angle.rate"), 0.3, end)
        force = fluctuation(t, result.channel("actuator.force"), 0.3, end)
        late = t > 0.5 * scenario.solver.end
        drive = result.channel("actuator.force")[late]
        at = t[late][np.argmax(drive)]
        print(f"  {label:8s} {rate:13.3f} {force:12.1f} {drive.max():11.1f} at {at:.3f}   "
              f"{of(result, 'A')} {of(result, 'B')} {np.degrees(np.abs(angle - ideal).max()):15.2f}"
              f"   {orbit(result)}")  # fmt: skip


def of(result: Run, joint: str) -> str:
    name = f"{joint}.contact_force"
    return f"{result.peak(name):10.0f}" if name in result.columns else " " * 10


def orbit(result: Run) -> str:
    """Free flight and spread of the section e_x' = 0 (upwards) at B after the turnover."""
    if "B.normal_force" not in result.columns:
        return ""
    t = result.rows[:, 0]
    after = t > 0.3
    flight = 100.0 * np.mean(result.channel("B.normal_force")[after] == 0.0)
    rate, x = result.channel("B.eccentricity_x_rate"), result.channel("B.eccentricity_x")
    crossing = after[1:] & (rate[:-1] < 0.0) & (rate[1:] >= 0.0)
    return f"{flight:9.0f} {1e3 * np.std(x[1:][crossing]):14.3f}"


if __name__ == "__main__":
    main()
