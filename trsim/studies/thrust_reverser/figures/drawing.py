"""What the figures of the study are put together from: panels with a letter, on common scales."""

from collections.abc import Callable, Sequence
from typing import Any, NamedTuple

import numpy as np

from trsim.arrays import Array
from trsim.report.display import DEFAULT, Shown, display_units
from trsim.report.figures import contact_history
from trsim.report.orbits import circle, coloured, path
from trsim.report.style import colour, thinned
from trsim.studies.thrust_reverser.runs import Runs

UNITS = display_units(DEFAULT)
ACCELERATION, VELOCITY = "angular acceleration", "angular velocity"
QUANTITIES = {
    "door_angle": "door angle",
    "door_angle.rate": VELOCITY,
    "door_angle.acceleration": ACCELERATION,
    "actuator.force": "driving force",
    "air.magnitude": "load",
}
MOST = 100_000  # points of a path
Cases = tuple[tuple[str, str], ...]  # (label, case)
KILO = {"deg/s\u00b2": (1e-3, "10\u00b3 deg/s\u00b2")}  # of numbers too long for an axis


class Drawn(NamedTuple):
    """A figure of the study, and what it is drawn from."""

    number: str  # of the study, with a letter of ours where it has several versions
    panels: str  # the letters of the study
    caption: str
    cases: tuple[str, ...]
    draw: Callable[[Runs], Any]

    @property
    def anchor(self) -> str:
        """Its name as a file and as a place on the page."""
        return f"figure_{self.number.replace(' ', '_')}"


def names(cases: Cases) -> tuple[str, ...]:
    return tuple(case for _, case in cases)


def those(runs: Runs, *cases: tuple[str, str]) -> list[Shown]:
    """The runs as stated, (label, case)."""
    return [Shown(runs.stated(case).run, label, UNITS) for label, case in cases]


def lettered(axes: Any, letter: str, text: str) -> None:
    axes.set_title(f"({letter}) {text}" if letter else text, loc="left")


def scale(unit: str) -> tuple[float, str]:
    return KILO.get(unit, (1.0, unit))


def values(shown: Shown, channel: str) -> tuple[Array, str]:
    """A channel in the unit of its axis."""
    factor, unit = scale(shown.unit(channel))
    return factor * shown.values(channel), unit


def curves(axes: Any, runs: Sequence[Shown], channel: str, letter: str, text: str = "") -> None:
    """One channel of all runs over time; the widest behind the others."""
    found = [values(shown, channel) for shown in runs]
    order = np.argsort([-fluctuates(x) for x, _ in found], kind="stable")
    for k in order.tolist():
        axes.plot(*thinned(runs[k].time, found[k][0]), color=colour(k), lw=0.7,
                  label=runs[k].label)  # fmt: skip
    quantity = QUANTITIES.get(channel, channel)
    axes.set_ylabel(f"{quantity}\n({found[0][1]})")
    axes.margins(x=0.01)
    lettered(axes, letter, text or quantity)


def fluctuates(x: Array) -> float:
    """How far a curve jumps from row to row."""
    return float(np.max(np.abs(np.diff(x)), initial=0.0))


def forces(axes: Any, runs: Sequence[Shown], joint: str, letter: str, text: str = "") -> None:
    """The force in a contact at accepted steps, zero in flight."""
    found = [contact_history(shown, joint) for shown in runs]
    order = np.argsort([-np.max(force) for _, force in found], kind="stable")
    for k in order.tolist():
        time, force = found[k]
        axes.plot(*thinned(time, force), color=colour(k), lw=0.7, label=runs[k].label)
    axes.set_ylabel("contact force\n(N)")
    axes.margins(x=0.01)
    axes.set_ylim(bottom=0.0)
    lettered(axes, letter, text or f"contact force at {joint}")


def plane(
    axes: Any, runs: Sequence[Shown], x: str, y: str, named: tuple[str, str],
    colours: Sequence[int] = (),
) -> None:  # fmt: skip
    """One channel over another; the widest behind the others."""
    found = [(values(shown, x), values(shown, y)) for shown in runs]
    paths = [(one[0][0], one[1][0]) for one in found]
    portrayed(axes, runs, paths, colours)
    axes.set_xlabel(f"{named[0]} ({found[0][0][1]})")
    axes.set_ylabel(f"{named[1]}\n({found[0][1][1]})")


def portrayed(
    axes: Any, runs: Sequence[Shown], paths: Sequence[tuple[Array, Array]], colours: Sequence[int]
) -> None:
    """Paths in a plane."""
    order = np.argsort([-np.ptp(y) for _, y in paths], kind="stable")
    for k in order.tolist():
        axes.plot(*paths[k], lw=0.45, alpha=0.85, color=colour(colours[k] if colours else k),
                  label=runs[k].label, rasterized=True)  # fmt: skip


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
    steps, names = shown.run.steps(joint), ("eccentricity_x", "eccentricity_x_rate")
    time = np.concatenate([shown.run.time, steps["time"]])
    both = [np.concatenate([shown.run.channel(f"{joint}.{n}"), steps[n]]) for n in names]
    order = np.argsort(time, kind="stable")
    order = order[:: max(1, -(-len(order) // MOST))]
    return 1e3 * both[0][order], 1e3 * both[1][order]


def section(
    axes: Any, runs: Sequence[Shown], name: str, letter: str, text: str,
    colours: Sequence[int] = (),
) -> None:  # fmt: skip
    """Points of a Poincare section in the bearing, with the circles of clearance."""
    marks, reach = "os^Dv", 0.0
    for k, shown in enumerate(runs):
        points, shade = shown.run.poincare[name], colour(colours[k] if colours else k)
        joint = str(points.definition["x"]).partition(".")[0]
        c = shown.scaled(shown.run.parts[joint].clearance, "m")
        axes.plot(shown.scaled(points.x, "m"), shown.scaled(points.y, "m"), marks[k % 5], ms=3,
                  mew=0.5, mfc="none", color=shade, label=shown.label)  # fmt: skip
        circle(axes, c)
        axes.patches[-1].set_edgecolor(shade)
        reach = max(reach, c)
    framed([axes], reach)
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


def framed(axes: Sequence[Any], radius: float) -> None:
    """Equal scales around a circle of a radius."""
    for a in axes:
        a.set_aspect("equal")
        a.set_xlim(-1.15 * radius, 1.15 * radius)
        a.set_ylim(-1.15 * radius, 1.15 * radius)


def timed(axes: Sequence[Any]) -> None:
    for a in axes:
        a.set_xlabel("time (s)")


def with_legend(figure: Any, axes: Any, runs: Sequence[Shown], most: int = 3) -> Any:
    """The figure, with its legend below, in the order of the runs, `most` to a line."""
    lines, names = axes.get_legend_handles_labels()
    found = dict(zip(names, lines, strict=True))
    labels = [shown.label for shown in runs if shown.label in found]
    columns = 1 if max(map(len, labels)) > 34 else min(most, len(labels))
    shown = figure.legend([found[n] for n in labels], labels, loc="outside lower center",
                          ncols=columns)  # fmt: skip
    for line in shown.get_lines():
        line.set_linewidth(1.6)
    return figure


def alike(rows: Sequence[Sequence[Any]], x: bool = True) -> None:
    """One scale along each row of panels."""
    for row in rows:
        for axis in ("x", "y") if x else ("y",):
            limits = [getattr(a, f"get_{axis}lim")() for a in row]
            low, high = min(one[0] for one in limits), max(one[1] for one in limits)
            for a in row:
                getattr(a, f"set_{axis}lim")(low, high)
