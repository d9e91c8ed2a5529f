"""What a run says of itself: its twin, how long and how closely both agree, and the cost."""

import json
import subprocess
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import Any

from benchmarks.measure import ROOT, SCENARIOS, trsim
from benchmarks.startup import took
from benchmarks.tables import head, power, row

CASES = {
    "pendulum_a01": "validation",
    "slider_crank_friction": "validation",
    "clearance_b_0.3mm": "thrust_reverser",
    "clearance_ap_0.1mm": "thrust_reverser",
}


def certified(command: list[str]) -> dict[str, Any]:
    """The document of a certified run."""
    done = subprocess.run([*command, "--certify"], cwd=ROOT, check=True, capture_output=True)  # noqa: S603
    return json.loads(done.stdout)["runs"][0]


def main() -> None:
    """Print the table."""
    head("scenario", "twin", "evaluations: run, twin", "command: without, with, CPU s",
         "predictable until", "motion agrees within", "summary quantities within")  # fmt: skip
    with TemporaryDirectory() as folder:
        for name, of in CASES.items():
            file = str(SCENARIOS / of / f"{name}.yaml")
            command = trsim("run", file, "-q", "--json", "-o", str(Path(folder) / f"{name}.h5"))
            run = certified(command)
            twin = run["certificate"]
            parted = twin["apart"]
            looks = f"{run['statistics']['evaluations']}, {twin['evaluations']}"
            cpu = ", ".join(f"{took(one).cpu:.1f}" for one in (command, [*command, "--certify"]))
            row(name, f"{twin['method']}, {power(twin['tolerance'], 0)}", looks, cpu,
                f"the end, {run['time']:g} s" if parted is None else f"{parted:.3f} s",
                f"{power(twin['difference'])} ({twin['difference_channel']})",
                f"{power(twin['quantity_difference'])} ({twin['quantity']})")  # fmt: skip


if __name__ == "__main__":
    main()
