"""Thrust reverser: fluctuation, peaks and orbits of the clearance cases, as tabled in the docs."""

import numpy as np

from benchmarks.measure import SCENARIOS, Run, run

HEADS = ("clearance mm", "door rate hp rad/s", "drive hp N", "drive max N at s", "peak A N",
         "peak B N", "door off by deg", "flight at B %", "spread of section at B mm")  # fmt: skip
CASES = {
    "none": (),
    "A 0.1": ("A=0.1",),
    "A 0.3": ("A=0.3",),
    "A 0.5": ("A=0.5",),
    "B 0.1": ("B=0.1",),
    "B 0.3": ("B=0.3",),
    "B 0.5": ("B=0.5",),
    "A and B 0.1": ("A=0.1", "B=0.1"),
    "A and B 0.3": ("A=0.3", "B=0.3"),
    "A and B 0.5": ("A=0.5", "B=0.5"),
}


def main() -> None:
    from trsim.analyse.fluctuation import fluctuation
    from trsim.assemble.assemble import assemble
    from trsim.scenario.load import load

    print("|", " | ".join(HEADS), "|")
    print("|---" * len(HEADS) + "|")
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
        off = f"{np.degrees(np.abs(angle - ideal).max()):.2f}" if plays else ""
        cells = [label, f"{rate:.3f}", f"{force:.1f}", f"{drive.max():.1f}, {at:.3f}",
                 of(result, "A"), of(result, "B"), off, *orbit(result)]  # fmt: skip
        print(f"| {' | '.join(cells)} |".replace("|  ", "| "), flush=True)


def of(result: Run, joint: str) -> str:
    name = f"{joint}.contact_force"
    return f"{result.peak(name):.0f}" if name in result.columns else ""


def orbit(result: Run) -> list[str]:
    """Free flight and spread of the section e_x' = 0 (upwards) at B after the turnover."""
    if "B.normal_force" not in result.columns:
        return ["", ""]
    t = result.rows[:, 0]
    after = t > 0.3
    flight = 100.0 * np.mean(result.channel("B.normal_force")[after] == 0.0)
    rate, x = result.channel("B.eccentricity_x_rate"), result.channel("B.eccentricity_x")
    crossing = after[1:] & (rate[:-1] < 0.0) & (rate[1:] >= 0.0)
    return [f"{flight:.0f}", f"{1e3 * np.std(x[1:][crossing]):.3f}"]


if __name__ == "__main__":
    main()
