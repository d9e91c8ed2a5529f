"""Panels of the figures of the reverser: curves over time, contact forces, journals, sections."""

from collections.abc import Sequence
from typing import Any

import numpy as np

from trsim.arrays import Array
from trsim.report.display import Shown
from trsim.report.figures import contact_history
from trsim.report.orbits import circle, coloured, path, square
from trsim.report.style import colour, panels
from trsim.studies.drawing import enlarged, fluctuates, lettered, overlaid, with_legend

ACCELERATION, VELOCITY = "angular acceleration", "angular velocity"
DOOR = ("door_angle", "door_angle.rate", "door_angle.acceleration")
QUANTITIES = {
    **dict(zip(DOOR, ("door angle", VELOCITY, ACCELERATION), strict=True)),
    "actuator.force": "driving force",
    "air.magnitude": "load",
}
ONSET = 0.298, 0.338  # s: the touch of the lug at 0.300 s and what follows, at 0.5 m/s
MOST = 400_000  # points of a path
ROOM = 1.15  # half width of a panel over the radius of the circle in it
KILO = {"deg/s\u00b2": (1e-3, "10\u00b3 deg/s\u00b2")}  # of numbers too long for an axis


def values(shown: Shown, channel: str) -> tuple[Array, str]:
    """A channel in the unit of its axis."""
    factor, unit = KILO.get(shown.unit(channel), (1.0, shown.unit(channel)))
    return factor * shown.values(channel), unit


def over_time(runs: Sequence[Shown], of: Sequence[str], **options: Any) -> tuple[Any, Any]:
    """A figure and its axes, in two columns: a panel for each channel, or joint with a contact."""
    figure, axes = panels(-(-len(of) // 2), 2, height=2.1, width=7.2, **options)
    for a, what, letter in zip(axes.flat, of, "abcdef", strict=False):
        panel(a, runs, what, letter)
    timed(axes[-1])
    figure.align_ylabels()
    return with_legend(figure, axes[0, 0], runs), axes


def with_onset(runs: Sequence[Shown], of: Sequence[str], onset: tuple[float, float]) -> Any:
    """A figure with a line of panels for each channel or contact: the stroke, and its onset, s."""
    figure, axes = panels(len(of), 2, height=1.65, width=7.2, width_ratios=(1.0, 1.25))
    for row, what, letter in zip(axes, of, "abcdef", strict=False):
        panel(row[0], runs, what, letter)
        panel(row[1], runs, what, "", f"enlarged, {1e3 * onset[0]:g} to {1e3 * onset[1]:g} ms")
        enlarged(row[1], *onset)
        row[1].set_ylabel("")
    timed(axes[-1])
    figure.align_ylabels()
    return with_legend(figure, axes[0, 0], runs)


def panel(axes: Any, runs: Sequence[Shown], of: str, letter: str, text: str = "") -> None:
    """A channel over time, or the contact force at a joint."""
    draw = curves if of in QUANTITIES else forces
    draw(axes, runs, of, letter, text)


def curves(axes: Any, runs: Sequence[Shown], channel: str, letter: str, text: str = "") -> None:
    """One channel of all runs over time."""
    found = [values(shown, channel) for shown in runs]
    paths = [(shown.time, x) for shown, (x, _) in zip(runs, found, strict=True)]
    overlaid(axes, runs, paths, [fluctuates(x) for x, _ in found], lw=0.7)
    quantity = QUANTITIES[channel]
    axes.set_ylabel(f"{quantity}\n({found[0][1]})")
    axes.margins(x=0.01)
    lettered(axes, letter, text or quantity)


def forces(axes: Any, runs: Sequence[Shown], joint: str, letter: str, text: str = "") -> None:
    """The force in a contact at accepted steps, zero in flight."""
    found = [contact_history(shown, joint) for shown in runs]
    overlaid(axes, runs, found, [np.max(f) for _, f in found], lw=0.7)
    axes.set_ylabel("contact force\n(N)")
    axes.margins(x=0.01)
    axes.set_ylim(bottom=0.0)
    lettered(axes, letter, text or f"contact force at {joint}")


def plane(
    axes: Any, runs: Sequence[Shown], x: str, y: str, named: tuple[str, str],
    colours: Sequence[int] = (),
) -> None:  # fmt: skip
    """One channel over another."""
    found = [(values(shown, x), values(shown, y)) for shown in runs]
    portrayed(axes, runs, [(one[0][0], one[1][0]) for one in found], colours)
    axes.set_xlabel(f"{named[0]} ({found[0][0][1]})")
    axes.set_ylabel(f"{named[1]}\n({found[0][1][1]})")


def portrayed(
    axes: Any, runs: Sequence[Shown], paths: Sequence[tuple[Array, Array]], colours: Sequence[int]
) -> None:
    """Paths in a plane."""
    widths = [np.ptp(y) for _, y in paths]
    overlaid(axes, runs, paths, widths, colours, lw=0.45, alpha=0.85, rasterized=True)


def journal(
    axes: Any, runs: Sequence[Shown], joint: str, letter: str, text: str,
    colours: Sequence[int] = (),
) -> None:  # fmt: skip
    """Phase diagram of a journal: its velocity over its place, in x."""
    portrayed(axes, runs, [phase(shown, joint) for shown in runs], colours)
    axes.set_xlabel("eccentricity x (mm)")
    axes.set_ylabel("its rate (mm/s)")
    lettered(axes, letter, text)


def phase(shown: Shown, joint: str) -> tuple[Array, Array]:
    """Place and velocity in x (mm, mm/s): the rows, and the steps in touch between them."""
    _, x, rate = path(shown, joint, y="eccentricity_x_rate", most=MOST)
    return 1e3 * x, 1e3 * rate


def section(axes: Any, runs: Sequence[Shown], name: str, letter: str, text: str) -> None:
    """Points of a Poincare section in the bearing, with the circles of clearance."""
    marks, reach = "os^Dv", 0.0
    for k, shown in enumerate(runs):
        points, shade = shown.run.poincare[name], colour(k)
        joint = str(points.definition["x"]).partition(".")[0]
        c = shown.scaled(shown.run.parts[joint].clearance, "m")
        axes.plot(shown.scaled(points.x, "m"), shown.scaled(points.y, "m"), marks[k % 5], ms=3,
                  mew=0.5, mfc="none", color=shade, label=shown.label)  # fmt: skip
        circle(axes, c)
        axes.patches[-1].set_edgecolor(shade)
        reach = max(reach, c)
    square([axes], ROOM * reach)
    axes.set_xlabel("eccentricity x (mm)")
    axes.set_ylabel("eccentricity y (mm)")
    lettered(axes, letter, text)


def orbit(axes: Any, shown: Shown, joint: str, letter: str, text: str) -> Any:
    """The path of a journal in its bearing, coloured by time; what tells the colours."""
    time, x, y = path(shown, joint)
    shade = coloured(axes, time, shown.scaled(x, "m"), shown.scaled(y, "m"))
    circle(axes, shown.scaled(shown.run.parts[joint].clearance, "m"))
    axes.set_xlabel("eccentricity x (mm)")
    axes.set_ylabel("eccentricity y (mm)")
    lettered(axes, letter, text)
    return shade


def timed(axes: Sequence[Any]) -> None:
    for a in axes:
        a.set_xlabel("time (s)")
