"""When the five doors stick: time and stroke at which an actuator that falls behind stalls."""

import trsim
from benchmarks.measure import ROOT, SCENARIOS
from benchmarks.tables import head, row

SCENARIO = SCENARIOS / "thrust_reverser" / "spatial_jam.yaml"
FOLDER = ROOT / "runs" / "spatial_jam"
SPEED, SHAFT = "parameters.speed_2", "parameters.shaft"  # m/s, N m/rad
TIME, STROKE = "summary:time", "final:stroke"
EVEN = 0.420  # m/s


def main() -> None:
    """Print the table; rerun it to resume."""
    found = trsim.sweep(SCENARIO, FOLDER, raises=False).frame(TIME, STROKE)
    shafts = list(found[SHAFT].unique())
    head("2 slower by", *(f"{x:g} N m/rad" if x else "no shaft" for x in shafts))
    for speed, cases in found.groupby(SPEED, sort=False):
        cells = ("full stroke" if status == "done" else f"{time:.3f} s, {1e3 * stroke:.0f} mm"
                 for status, time, stroke in zip(cases["status"], cases[TIME], cases[STROKE],
                                                 strict=True))  # fmt: skip
        row(f"{1e3 * (EVEN - float(speed)):.0f} mm/s", *cells)


if __name__ == "__main__":
    main()
