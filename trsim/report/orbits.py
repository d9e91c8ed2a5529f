"""Journals in their bearings: orbits with the clearance circle, sections, impact maps."""

from itertools import pairwise
from typing import Any

import numpy as np

from trsim.arrays import Array
from trsim.report.display import Shown, short
from trsim.report.marks import spaced
from trsim.report.style import WIDTH, colour, finished, panels, titled
from trsim.store.points import surface
from trsim.store.read import Points

SPARE = 1.12  # half width of the panel over the radius of the circle
PARTS = 200  # stretches of the orbit, each of one colour
MOST = 200_000  # points drawn


def orbit(runs: list[Shown], name: str) -> Any:
    """The path of the journal centre; side by side on one scale."""
    # a run that was broken off may have no point
    found = [(shown, path(shown, name)) for shown in runs if name in shown.run.contacts]
    there, paths = zip(*((s, points) for s, points in found if len(points[0])), strict=True)
    clearances = [shown.run.parts[name].clearance for shown in there]
    unit = there[0].display("m")[1]
    figure, axes = side_by_side(len(there))
    for a, shown, c, (time, x, y) in zip(axes, there, clearances, paths, strict=True):
        time, x, y = shown.scaled(time, "s"), shown.scaled(x, "m"), shown.scaled(y, "m")
        shade = coloured(a, time, x, y)
        circle(a, shown.scaled(c, "m"))
        a.plot(x[:1], y[:1], "o", ms=4, color="black", mec="white", mew=0.6, zorder=5)
        a.set_xlabel(f"eccentricity x ({unit})")
        note = deepest(shown, name)
        a.set_title(f"{shown.label}\n{note}" if shown.label else note, fontsize=8)
    reach = [
        c * SPARE + max(0.0, depth(s, name) - 0.05 * c)
        for s, c in zip(there, clearances, strict=True)
    ]
    square(axes, there[0].scaled(max(reach), "m"))
    axes[0].set_ylabel(f"eccentricity y ({unit})")
    figure.colorbar(shade, ax=list(axes), label=there[0].time_label, shrink=0.8, aspect=30)
    titled(figure, list(there), f"Journal at {name} (dot: start; dashed: clearance)")
    return figure


def section(runs: list[Shown], name: str) -> Any:
    """The points of a Poincare section of every run that has it."""
    there = [(shown, shown.run.poincare[name]) for shown in runs if name in shown.run.poincare]
    text = f"Poincar\u00e9 section {name}: {surface(there[0][1].definition)}"
    return scattered(runs, there, text)


def scattered(runs: list[Shown], there: list[tuple[Shown, Points]], text: str) -> Any:
    """Points side by side; with the clearance circle where they are in a bearing."""
    figure, axes = side_by_side(len(there))
    radii = []
    for a, (shown, points) in zip(axes, there, strict=True):
        x = shown.scaled(points.x, points.x_unit)
        y = shown.scaled(points.y, points.y_unit)
        a.plot(x, y, ".", ms=5, mew=0, color=colour(runs.index(shown)), alpha=0.8)
        definition = points.definition
        a.set_xlabel(words(definition["x"], shown, points.x_unit))
        if a is axes[0]:
            a.set_ylabel(words(definition["y"], shown, points.y_unit))
        a.set_title(f"{shown.label}\n{spread(shown, points)}".strip(), fontsize=8)
        joint = bearing(shown, definition)
        if joint:
            c = shown.scaled(shown.run.parts[joint].clearance, "m")
            circle(a, c)
            radii.append(c)
    if len(radii) == len(there):
        square(axes, SPARE * max(radii))
    titled(figure, [shown for shown, _ in there], text)
    return figure


def spread(shown: Shown, points: Points) -> str:
    """How many points there are, and how far they lie apart."""
    found = points.dispersion
    if not found.points:
        return "no points"
    number = "1 point" if found.points == 1 else f"{found.points} points"
    if found.radius == found.radius:
        radius = short(shown.scaled(found.radius, points.x_unit), 3)
        return f"{number}, dispersion {radius} {shown.display(points.x_unit)[1]}"
    each = [(found.x, points.x_unit), (found.y, points.y_unit)]
    told = [f"{short(shown.scaled(v, unit), 3)} {shown.display(unit)[1]}" for v, unit in each]
    return f"{number}, dispersion {told[0]}, {told[1]}"


def impact_map(runs: list[Shown], name: str) -> Any:
    """Where around its bearing a journal touches, and how fast it comes."""
    figure, axes = panels(1, height=3.2)
    a, (factor, unit) = axes[0, 0], runs[0].display("rad")
    for k, shown in enumerate(runs):
        _, angle, speed = shown.run.impacts(name)
        label = f"{shown.label} ({len(angle)})".strip() if shown.label else ""
        a.plot(factor * angle, speed, ".", ms=7, mew=0, color=colour(k), alpha=0.7, label=label)
    a.set_xlim(-factor * np.pi, factor * np.pi)
    if unit in ("deg", "\u00b0"):
        a.set_xticks(np.arange(-180, 181, 45))
    a.set_ylim(bottom=0.0)
    a.set_xlabel(f"angle of the touch around the bearing ({unit})")
    a.set_ylabel(f"speed of approach ({runs[0].display('m/s')[1]})")
    count = len(runs[0].run.impacts(name).time) if len(runs) == 1 else 0
    return finished(figure, a, runs, f"Impacts at {name}" + (f": {count}" if count else ""))


def side_by_side(n: int) -> tuple[Any, Any]:
    """n square panels in a row."""
    width = {1: 4.4, 2: WIDTH}.get(n, 2.6 * n)
    height = (width - 1.1) / n + 0.9
    figure, axes = panels(1, n, height=height, width=width, sharey=True)
    return figure, axes[0]


def path(
    shown: Shown, name: str, x: str = "eccentricity_x", y: str = "eccentricity_y", most: int = MOST
) -> tuple[Array, Array, Array]:
    """Time and two numbers of a journal, SI: the rows, and the steps in touch between them."""
    run, channels = shown.run, [f"{name}.{x}", f"{name}.{y}"]
    rows = [run.time, *map(run.channel, channels)] if shown.has(*channels) else []
    steps = run.steps(name)
    inner = [steps["time"], steps[x], steps[y]]
    merged = [np.concatenate(pair) for pair in zip(rows, inner, strict=True)] if rows else inner
    order = np.argsort(merged[0], kind="stable")
    order = order[:: max(1, -(-len(order) // most))]
    return merged[0][order], merged[1][order], merged[2][order]


def coloured(axes: Any, time: Array, x: Array, y: Array) -> Any:
    """A path whose colour tells the time."""
    from matplotlib.collections import LineCollection

    cuts = np.unique(np.linspace(0, max(len(x) - 1, 1), PARTS + 1).astype(int))
    points = np.stack([x, y], axis=1)
    pieces = [points[a : b + 1] for a, b in pairwise(cuts)]
    lines = LineCollection(pieces, cmap="viridis", linewidths=0.5, rasterized=True)
    lines.set_array(time[np.minimum(cuts[:-1], len(time) - 1)])
    axes.add_collection(lines)
    return lines


def circle(axes: Any, radius: float) -> None:
    """How far the journal can move before it touches."""
    from matplotlib.patches import Circle

    axes.add_patch(Circle((0.0, 0.0), radius, fill=False, ls="--", lw=0.8, ec="0.25", zorder=4))


def square(axes: Any, reach: float) -> None:
    for a in axes:
        a.set_aspect("equal")
        a.set_xlim(-reach, reach)
        a.set_ylim(-reach, reach)


def deepest(shown: Shown, name: str) -> str:
    """The scale of the penetration, which is drawn as it is."""
    largest = depth(shown, name)
    if largest <= 0.0:
        return "never in contact"
    return f"penetration to scale, at most {1e6 * largest:.3g} \u00b5m"


def depth(shown: Shown, name: str) -> float:
    """The largest penetration, m."""
    return float(np.max(shown.run.steps(name)["penetration"], initial=0.0))


def bearing(shown: Shown, definition: Any) -> str:
    """The joint whose eccentricity a section shows, or nothing."""
    for joint, part in shown.run.parts.items():
        channels = (f"{joint}.eccentricity_x", f"{joint}.eccentricity_y")
        if part.clearance > 0.0 and (definition["x"], definition["y"]) == channels:
            return joint
    return ""


def words(channel: str, shown: Shown, unit: str) -> str:
    return f"{spaced(channel)} ({shown.display(unit)[1]})"
