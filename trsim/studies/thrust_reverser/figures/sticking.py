"""When the spatial mechanism sticks: actuator 2 slower, over the stiffness of the shaft (ours)."""

from typing import Any

import numpy as np

from trsim.report.display import Shown
from trsim.report.maps import cells
from trsim.report.style import panels
from trsim.studies.drawing import Drawn

SPEEDS = (418, 416, 414, 412, 410, 408)  # mm/s, of actuator 2
STIFFNESSES = ("0", "0.176", "0.53", "1.76", "5.3")  # N m/rad, of the shaft


def case(speed: int, stiffness: str) -> str:
    """The name of a run of the grid."""
    return f"spatial_jam,speed_2={speed}mm_s,shaft={stiffness}N_m_rad"


CASES = tuple(case(speed, stiffness) for speed in SPEEDS for stiffness in STIFFNESSES)


def late(speed: int) -> str:
    return f"{420 - speed} mm/s"


def sticking(shown: list[Shown]) -> Any:
    """The time at which a run of the grid ends, and whether it is stuck."""
    grid = len(SPEEDS), len(STIFFNESSES)
    values = np.reshape([float(one.run.summary["time"]) for one in shown], grid)
    ends = np.reshape(["sticks" if one.run.attributes["status"] == "jammed" else "full stroke"
                       for one in shown], grid)  # fmt: skip
    figure, axes = panels(1, height=3.4)
    late = [str(420 - speed) for speed in SPEEDS]
    shade = cells(axes[0, 0], STIFFNESSES, late, values, ends.tolist())
    axes[0, 0].set_xlabel("stiffness of the shaft (N\u00b7m/rad)")
    axes[0, 0].set_ylabel("actuator 2 slower by (mm/s)")
    figure.colorbar(shade, label="end of the run (s)")
    return figure


FIGURES = (
    Drawn("25 until it sticks", "", "When an actuator stalls, its supply at 3 kN (ours): actuator "
          "2 slower than the others, over the stiffness of the synchronising shaft. A full stroke "
          "takes 1.19 s.", tuple(("", name) for name in CASES), sticking),
)  # fmt: skip
