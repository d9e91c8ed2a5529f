"""The figures of a run, of whatever it contains; of several runs, overlaid or side by side."""

from collections.abc import Callable, Iterator
from functools import partial
from pathlib import Path
from typing import Any

import numpy as np

from trsim.arrays import Array
from trsim.report import bars, components, style
from trsim.report.display import Shown, short
from trsim.report.marks import happened, heading, spaced
from trsim.report.orbits import impact_map, orbit, section
from trsim.report.style import colour, finished, look, panels, save, thinned, titled
from trsim.store.peaks import Peak

QUANTITY = {
    "rad/s": "angular velocity",
    "rad/s^2": "angular acceleration",
    "m/s": "velocity",
    "m/s^2": "acceleration",
}


FORCES = ("contact_force", "normal_force")  # of a contact, the first there is


def draw(runs: list[Shown], folder: Path) -> list[Path]:
    """All figures, as PNG."""
    with look():
        return [save(figure, folder / f"{name}.png") for name, figure in everything(runs)]


def everything(runs: list[Shown]) -> Iterator[tuple[str, Any]]:
    """File names and figures."""
    return ((name, make()) for name, make in planned(runs))


def planned(runs: list[Shown]) -> Iterator[tuple[str, Callable[[], Any]]]:
    """File names, and what makes the figures."""
    for sensor in parts(runs, "sensors"):
        yield f"motion_{sensor}", partial(motion, runs, sensor)
    for body in parts(runs, "bodies"):
        yield from components.body(runs, body)
    for bar in parts(runs, "bodies"):
        if some(runs, f"{bar}.deflection", f"{bar}.node0.position"):
            yield f"bar_{bar}", partial(bars.forces, runs, bar)
            yield f"shapes_{bar}", partial(bars.shapes, runs, bar)
    for drive in parts(runs, "drives"):
        if some(runs, f"{drive}.force"):
            yield f"drive_{drive}", partial(drive_force, runs, drive)
    for force in parts(runs, "forces"):
        if force not in contacts(runs):
            yield from components.force(runs, force)
    for joint in parts(runs, "joints"):
        if joint not in contacts(runs):
            yield from components.pull(runs, joint)
    for name in contacts(runs):
        yield f"contact_{name}", partial(contact_force, runs, name)
        if some(runs, f"{name}.eccentricity_x", f"{name}.eccentricity_y"):
            yield f"orbit_{name}", partial(orbit, runs, name)
            there = [shown for shown in runs if name in shown.run.contacts]
            if any(len(shown.run.impacts(name).time) for shown in there):
                yield f"impact_{name}", partial(impact_map, there, name)
    for name in dict.fromkeys(n for shown in runs for n in shown.run.phase):
        yield f"phase_{name}", partial(portrait, runs, name)
    for name in dict.fromkeys(n for shown in runs for n in shown.run.poincare):
        yield f"poincare_{name}", partial(section, runs, name)
    if some(runs, "energy.kinetic", "energy.residual"):
        yield "energy", partial(energy, runs)


def some(runs: list[Shown], *channels: str) -> list[Shown]:
    """The runs that have these channels."""
    return [shown for shown in runs if shown.has(*channels)]


def parts(runs: list[Shown], section: str) -> list[str]:
    """Names of the elements of a section, in any of the runs."""
    found = [n for s in runs for n, part in s.run.parts.items() if part.section == section]
    return list(dict.fromkeys(found))


def contacts(runs: list[Shown]) -> list[str]:
    return list(dict.fromkeys(name for shown in runs for name in shown.run.contacts))


def curve(axes: Any, shown: Shown, k: int, x: Array, y: Array) -> None:
    """One run's curve."""
    axes.plot(*thinned(x, y), color=colour(k), ls=style.DASHES[k // len(style.COLOURS) % 4],
              label=shown.label)  # fmt: skip


# --- over time -------------------------------------------------------------------------------


def motion(runs: list[Shown], sensor: str) -> Any:
    """A sensor, its rate and its acceleration."""
    there = [s for s in ("", ".rate", ".acceleration") if some(runs, sensor + s)]
    figure, axes = panels(max(len(there), 1), height=1.7, sharex=True)
    noise = 0.0
    for row, suffix in enumerate(there):
        channel = sensor + suffix
        a = axes[row, 0]
        for k, shown in enumerate(runs):
            if shown.has(channel):
                curve(a, shown, k, shown.time, shown.values(channel))
        one = some(runs, channel)[0]
        quantity = QUANTITY.get(one.run.unit(channel), "") if suffix else ""
        a.set_ylabel(f"{quantity or spaced(channel)}\n({one.unit(channel)})")
        a.margins(x=0.01)
        largest = max(float(np.max(np.abs(s.values(channel)))) for s in some(runs, channel))
        style.apart(a, noise)
        happened(a, runs)
        # what rounding of this value over the length of the run may look like in its rate
        noise = 1e-9 * largest / max(one.run.reached, 1e-300)
    axes[-1, 0].set_xlabel(runs[0].time_label)
    return finished(figure, axes[0, 0], runs, heading(sensor))


def drive_force(runs: list[Shown], drive: str) -> Any:
    """The force of a drive, its largest value marked."""
    channel = f"{drive}.force"
    figure, axes = panels(1, height=2.9)
    a = axes[0, 0]
    happened(a, runs)
    for k, shown in enumerate(runs):
        if not shown.has(channel):
            continue
        curve(a, shown, k, shown.time, shown.values(channel))
        for peak in shown.run.peaks:
            if peak.channel == channel:
                mark(a, shown, peak, k, told=len(runs) == 1)
    a.axhline(0.0, color="0.5", lw=0.6)
    one = some(runs, channel)[0]
    word = "torque" if one.run.unit(channel) == "N*m" else "force"
    a.set_ylabel(f"{word} of {spaced(drive)} ({one.unit(channel)})")
    a.set_xlabel(one.time_label)
    a.margins(x=0.01, y=0.12)
    style.apart(a)
    return finished(figure, a, runs, f"Drive {spaced(drive)}")


def mark(axes: Any, shown: Shown, peak: Peak, k: int, told: bool = True) -> None:
    """A peak: a dot, and its value and time beside it where there is room."""
    time, value = shown.scaled(peak.time, "s"), shown.scaled(peak.value, peak.unit)
    axes.plot([time], [value], "o", ms=3.5, color=colour(k), mec="white", mew=0.5, zorder=5)
    if not told:
        return
    low, high = axes.get_xlim()
    right = time > 0.5 * (low + high)
    unit, second = shown.display(peak.unit)[1], shown.display("s")[1]
    axes.annotate(
        f"{short(value)} {unit} at {short(time)} {second}",
        (time, value),
        xytext=(-6 if right else 6, 3 if peak.extreme == "largest" else -3),
        textcoords="offset points",
        ha="right" if right else "left",
        va="bottom" if peak.extreme == "largest" else "top",
        fontsize=8,
        color=colour(k),
    )


def contact_force(runs: list[Shown], name: str) -> Any:
    """The force in a contact at every accepted step, zero in flight; a panel per run."""
    there = [shown for shown in runs if name in shown.run.contacts]
    figure, axes = panels(len(there), height=2.9 if len(there) == 1 else 1.8,
                          sharex=True, sharey=True)  # fmt: skip
    si = there[0].run.contact_unit(name, *FORCES)
    unit, word = there[0].display(si)[1], "torque" if si == "N*m" else "force"
    for a, shown in zip(axes[:, 0], there, strict=True):
        time, force = contact_history(shown, name)
        k = runs.index(shown)
        force = shown.scaled(force, si)
        a.plot(*thinned(shown.scaled(time, "s"), force), color=colour(k))
        a.set_ylabel(f"contact {word} ({unit})" if len(there) < 3 else f"{word} ({unit})")
        a.margins(x=0.01, y=0.12)
        if shown.label:
            a.set_title(shown.label, loc="left")
    for a, shown in zip(axes[:, 0], there, strict=True):  # once the limits are known
        channels = tuple(f"{name}.{force}" for force in FORCES)
        found = [p for p in shown.run.peaks if p.channel in channels and p.extreme == "largest"]
        for peak in sorted(found, key=lambda p: channels.index(p.channel))[:1]:
            mark(a, shown, peak, runs.index(shown))
    axes[-1, 0].set_xlabel(runs[0].time_label)
    axes[0, 0].set_ylim(bottom=0.0)
    figure.align_ylabels()
    titled(figure, runs, f"Contact {word} at {name}")
    return figure


def contact_history(shown: Shown, name: str) -> tuple[Array, Array]:
    """Times and force (N, N*m) of a contact, from its steps and its events."""
    steps, events = shown.run.steps(name), shown.run.events
    force = steps["contact_force" if "contact_force" in steps else "normal_force"]
    at = events.time[events.element == name]
    run = shown.run
    ends = np.array([run.time[0], run.reached]) if run.rows else np.zeros(0)
    times = np.concatenate([steps["time"], at, ends])
    values = np.concatenate([force, np.zeros(len(at) + len(ends))])
    # a closed contact at the start or at the end has no zero there
    order = np.argsort(times, kind="stable")
    times, values = times[order], values[order]
    first = np.append(True, np.diff(times) > 0.0)[: len(times)]
    group = np.cumsum(first) - 1
    largest = np.zeros(int(group[-1]) + 1 if len(group) else 0)
    np.maximum.at(largest, group, values)
    return times[first], largest


# --- the energy book -------------------------------------------------------------------------


def energy(runs: list[Shown]) -> Any:
    """Where the energy is and where it came from; what the book misses."""
    figure, axes = panels(2, len(runs), height=2.3, sharex=True, sharey="row",
                          height_ratios=(2, 1))  # fmt: skip
    names = entries(runs)
    for column, shown in enumerate(runs):
        if not shown.has("energy.kinetic", "energy.residual"):
            continue
        upper, lower = axes[:, column]
        time = shown.time
        for k, n in enumerate(names):
            if not shown.has(n):
                continue
            label = n.removeprefix("energy.").replace(".", ": ")
            upper.plot(*thinned(time, shown.values(n)), color=colour(k), ls=style.DASHES[k // 7],
                       label=label)  # fmt: skip
        lower.plot(*thinned(time, shown.values("energy.residual")), color="black")
        lower.set_xlabel(runs[0].time_label)
        if shown.label:
            upper.set_title(shown.label, loc="left")
        upper.margins(x=0.01)
    axes[0, 0].set_ylabel("energy, work (J)")
    axes[1, 0].set_ylabel("residual (J)")
    figure.align_ylabels()
    titled(figure, runs, "Energy book")
    lines = {n: h for a in axes[0] for h, n in zip(*a.get_legend_handles_labels(), strict=True)}
    figure.legend(lines.values(), lines.keys(), loc="outside lower center", ncols=4)
    return figure


def entries(runs: list[Shown]) -> list[str]:
    """The entries of the energy book that matter in any of the runs."""
    size: dict[str, float] = {}
    for shown in runs:
        for n in shown.run.names:
            if n.startswith("energy.") and n != "energy.residual" and shown.has(n):
                size[n] = max(size.get(n, 0.0), float(np.max(np.abs(shown.values(n)))))
    return [n for n in size if size[n] > 1e-6 * max(size.values())]


# --- phase plane -----------------------------------------------------------------------------


def portrait(runs: list[Shown], name: str) -> Any:
    """A phase portrait of every run that has it."""
    figure, axes = panels(1, height=3.6, width=4.8)
    a = axes[0, 0]
    for k, shown in enumerate(runs):
        points = shown.run.phase.get(name)
        if points is None or not len(points.x):
            continue
        x = shown.scaled(points.x, points.x_unit)
        y = shown.scaled(points.y, points.y_unit)
        a.plot(x, y, color=colour(k), lw=0.6, alpha=0.9 if len(runs) == 1 else 0.7,
               label=shown.label, rasterized=True)  # fmt: skip
        a.plot(x[:1], y[:1], "o", ms=4, color=colour(k), mec="white", mew=0.6, zorder=5)
        a.set_xlabel(f"{spaced(points.definition['x'])} ({shown.display(points.x_unit)[1]})")
        a.set_ylabel(f"{spaced(points.definition['y'])} ({shown.display(points.y_unit)[1]})")
    return finished(figure, a, runs, f"Phase portrait {name}, dot: start")
