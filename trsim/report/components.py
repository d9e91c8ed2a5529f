"""Figures of channels with components: motions of bodies, and forces of springs and the like."""

from collections.abc import Callable, Iterator
from functools import partial
from typing import Any

import numpy as np

from trsim import elements
from trsim.report import style
from trsim.report.display import Shown
from trsim.report.marks import happened, heading
from trsim.report.style import DASHES, colour, panels, thinned, titled

MOTIONS = ("position", "velocity", "angular_velocity")
FORCES, STRETCHES = ("N", "N*m"), ("m", "rad")  # units of what acts, and of what is deformed
AXES = "xyz"
Figures = Iterator[tuple[str, Callable[[], Any]]]  # names, and what makes them


def body(runs: list[Shown], name: str) -> Figures:
    """Position and velocities of a body, the components that change."""
    channels = [f"{name}.{motion}" for motion in MOTIONS]
    there = [channel for channel in channels if any(s.has(channel) for s in runs)]
    moving = [channel for channel in there if changes(runs, channel)] or there[:1]
    if moving:
        yield f"body_{name}", partial(drawn, runs, moving, name)


def force(runs: list[Shown], name: str) -> Figures:
    """What a spring, a damper, a bushing or a rope pulls with, and how far it is deformed.

    A load has no figure: it is what the scenario says.
    """
    shown = next(one for one in runs if name in one.run.parts)
    words = elements.load(shown.run.parts[name].type).loads.values()
    if any("load" in word.split() for word in words):
        return
    own = [c for c in shown.run.names if c.rpartition(".")[0] == name and shown.has(c)]
    channels = [
        channel
        for units in (FORCES, STRETCHES)
        for unit in units
        for channel in own
        if shown.run.unit(channel) == unit and shown.run.sizes[channel] in (1, 3)
    ]
    if any(shown.run.unit(channel) in FORCES for channel in channels):
        yield f"force_{name}", partial(drawn, runs, channels, name)


def pull(runs: list[Shown], name: str) -> Figures:
    """The force along a rod or a rope, or between teeth: of joints that are told by one number."""
    shown = next(one for one in runs if name in one.run.parts)
    words = elements.load(shown.run.parts[name].type).loads
    channels = [f"{name}.{word}" for word in words if shown.has(f"{name}.{word}")]
    if channels:
        yield f"force_{name}", partial(drawn, runs, channels, name)


def changes(runs: list[Shown], channel: str) -> bool:
    there = [shown.run.channel(channel) for shown in runs if shown.has(channel)]
    return any(np.any(np.ptp(values, axis=0) > 0.0) for values in there)


def drawn(runs: list[Shown], channels: list[str], name: str) -> Any:
    """A panel for each channel: numbers, or the components of vectors that change."""
    height = 2.9 if len(channels) == 1 else 1.8
    figure, axes = panels(len(channels), height=height, sharex=True)
    for a, channel in zip(axes[:, 0], channels, strict=True):
        there = [(k, shown) for k, shown in enumerate(runs) if shown.has(channel)]
        for k, shown in there:
            lines(a, shown, k, channel, several=len(runs) > 1)
        what = channel.rpartition(".")[2].replace("_", " ")
        a.set_ylabel(f"{what}\n({there[0][1].unit(channel)})")
        a.margins(x=0.01)
        style.apart(a)
        happened(a, runs)
    axes[-1, 0].set_xlabel(runs[0].time_label)
    figure.align_ylabels()
    titled(figure, runs, heading(name))
    labels = {text: line for a in axes[:, 0]
              for line, text in zip(*a.get_legend_handles_labels(), strict=True)}  # fmt: skip
    if labels:
        figure.legend(labels.values(), labels.keys(), loc="outside lower center",
                      ncols=1 if max(map(len, labels)) > 34 else 3)  # fmt: skip
    return figure


def lines(axes: Any, shown: Shown, k: int, channel: str, several: bool) -> None:
    """The curves of a run: its colour is that of a component, or of several runs its own."""
    values = shown.values(channel)
    if values.ndim == 1:
        axes.plot(*thinned(shown.time, values), color=colour(k), label=shown.label or None)
        return
    moving = np.flatnonzero(np.ptp(values, axis=0) > 0.0).tolist()
    for c in moving or [0]:
        text = f"{AXES[c]}, {shown.label}" if shown.label else AXES[c]
        way = {"color": colour(k), "ls": DASHES[c]} if several else {"color": colour(c)}
        axes.plot(*thinned(shown.time, values[:, c]), label=text, **way)
