"""python -m tests.portable.hashes: content hashes of ten scenarios under every arithmetic."""

import json
import subprocess
import sys
import tempfile
from pathlib import Path

import h5py

from trsim.assemble.assemble import assemble
from trsim.scenario.load import load
from trsim.solve.simulate import simulate
from trsim.store.hdf5 import write

from .arithmetics import ARITHMETICS

FOLDER = Path(__file__).parents[2] / "scenarios"
SCENARIOS = {
    "validation/pendulum_a01": (),
    "validation/pendulum_3d": (),
    "validation/slider_crank_friction": (),
    "validation/slider_crank_3d": (),
    "validation/four_bar_3d": (),
    "validation/andrews": (),
    "validation/windows_2": (),
    "validation/beam_pendulum": (),
    "thrust_reverser/clearance_b_0.3mm": ("solver.end=0.3",),
    "thrust_reverser/spatial_synchronous": ("solver.end=0.1",),
}


def hashes() -> dict[str, str]:
    """Those of this process."""
    found = {}
    with tempfile.TemporaryDirectory() as folder:
        for name, sets in SCENARIOS.items():
            scenario = load(FOLDER / f"{name}.yaml", list(sets))
            mechanism = assemble(scenario)
            path = Path(folder) / "run.h5"
            write(path, scenario, mechanism, simulate(scenario, mechanism))
            with h5py.File(path) as file:
                found[name] = str(file.attrs["content_sha256"])
            path.unlink()
    return found


def main() -> None:
    if sys.argv[1:] == ["--here"]:
        print(json.dumps(hashes()))
        return
    letters: dict[str, dict[str, str]] = {name: {} for name in SCENARIOS}
    print(f"{'':34}{' '.join(str(k + 1) for k in range(len(SCENARIOS)))}")
    for one in ARITHMETICS:
        if one.missing:
            print(f"{one.name:34}not here: {one.missing}")
            continue
        command = [sys.executable, "-m", "tests.portable.hashes", "--here"]
        done = subprocess.run(command, env=one.surroundings(), check=True, capture_output=True)  # noqa: S603
        row = []
        for name, found in json.loads(done.stdout).items():
            known = letters[name]
            row.append(known.setdefault(found, chr(ord("a") + len(known))))
        print(f"{one.name:34}{' '.join(row)}", flush=True)
    for k, name in enumerate(SCENARIOS):
        print(f"{k + 1:3} {name}")


if __name__ == "__main__":
    main()
