"""Figure 7: the flexible pendulum on two meshes."""

from typing import Any

from trsim.report.display import Shown
from trsim.report.style import DASHES, colour, panels
from trsim.studies.drawing import Drawn, lettered, with_legend

MESHES = (("8 elements", "pendulum_8"), ("16 elements", "pendulum_16"))


def figure_7(shown: list[Shown]) -> Any:
    """The tip in the plane of x and z; the height of the middle over time."""
    figure, (axes,) = panels(1, 2, height=2.8)
    for k, one in enumerate(shown):
        tip, middle = one.run.channel("rod.tip"), one.run.channel("rod.middle")
        style = {"color": colour(k), "ls": DASHES[k], "lw": 1.2, "label": one.label}
        axes[0].plot(tip[:, 0], tip[:, 2], **style)
        axes[1].plot(one.time, middle[:, 1], **style)
    axes[0].set_xlabel("x (m)")
    axes[0].set_ylabel("z (m)")
    axes[0].set_aspect("equal", adjustable="datalim")
    axes[1].set_xlabel("time (s)")
    axes[1].set_ylabel("y (m)")
    lettered(axes[0], "a", "tip, z over x")
    lettered(axes[1], "b", "middle, y over time")
    return with_legend(figure, axes[0], shown)


FIGURES = (
    Drawn("7", "ab", "The flexible pendulum in space, on two meshes.", MESHES, figure_7),
)  # fmt: skip
