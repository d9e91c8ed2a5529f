"""A scenario that runs in a few milliseconds and has everything a result file can hold."""

from functools import lru_cache
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import Any

from trsim.assemble.assemble import assemble
from trsim.scenario.load import loads
from trsim.solve.simulate import simulate
from trsim.store.hdf5 import Around, write

SLIDER_CRANK = """\
title: Slider-crank with play
bodies:
  crank: {mass: 0.3, inertia: 1e-4, at: [0.025, 0]}
  rod: {mass: 0.21, inertia: 2.5e-4, at: [0.11, 0]}
  slider: {mass: 0.14, inertia: 1e-4, at: [0.17, 0]}
joints:
  O: {type: revolute, bodies: [ground, crank], at: [0, 0]}
  A: {type: revolute, bodies: [crank, rod], at: [0.05, 0]}
  B: {type: revolute, bodies: [rod, slider], at: [0.17, 0], clearance: 0.5 mm, contact: pin}
  guide: {type: prismatic, bodies: [ground, slider], axis: [1, 0, 0]}
drives:
  motor: {joint: O, velocity: 5000 rpm}
sensors:
  stroke: {joint: guide}
  crank_angle: {joint: O}
contact_laws:
  pin: {normal: lankarani_nikravesh, stiffness: internal, bearing_radius: 10 mm,
        youngs_modulus: 207 GPa, poisson: 0.3, restitution: 0.9, slowest_impact: 0.01 m/s,
        friction: {law: none}}
solver: {method: dop853, end: 3 ms, tolerance: 1e-6}
output: {every: 0.01 ms}
poincare:
  journal: {when: B.eccentricity_x_rate, crosses: up, plot: [B.eccentricity_x, B.eccentricity_y]}
"""

# of a run whose report has a figure of each kind, in place of one of each body and sensor
FEW = ("output.channels=[stroke, crank.position, motor.force, B.contact_force, B.eccentricity_x, "
       "B.eccentricity_y, energy.kinetic, energy.residual]",)  # fmt: skip


def run(path: Path, *sets: str, text: str = SLIDER_CRANK) -> dict[str, Any]:
    """Simulate into a file; the summary."""
    scenario = loads(text, sets)
    mechanism = assemble(scenario)
    return write(path, scenario, mechanism, simulate(scenario, mechanism), Around("test"))


@lru_cache(maxsize=128)
def content(*sets: str, text: str = SLIDER_CRANK) -> bytes:
    """What stands in the file of such a run, which is made once in a process."""
    with TemporaryDirectory() as folder:
        run(Path(folder) / "run.h5", *sets, text=text)
        return (Path(folder) / "run.h5").read_bytes()


def copy(path: Path, *sets: str, text: str = SLIDER_CRANK) -> None:
    """A result file for those to whom it does not matter which process wrote it, and when."""
    path.parent.mkdir(parents=True, exist_ok=True)
    path.write_bytes(content(*sets, text=text))
